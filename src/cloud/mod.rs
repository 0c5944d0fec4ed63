//! Points from files: reading, neighbours, spacing, normals, winding number, rims of holes; and [`Samples`],
//! which a surface is made from. Rays and the surface itself are left to the rooms below.

mod areas;
mod duplicates;
mod error;
mod extent;
mod groups;
pub mod holes;
mod loose;
mod magic;
pub mod neighbours;
pub mod normals;
mod open;
mod order;
mod peers;
pub mod ply;
mod samples;
pub mod scraps;
pub mod spacing;
mod strays;
mod tree;
pub mod winding;

use glam::DVec3;

pub use areas::{AREA_REACH, areas, areas_by};
pub use duplicates::merge_duplicates;
pub use error::{CloudError, CloudFault};
pub use extent::{check_extent, coordinate_step, is_single};
pub use open::open;
pub use samples::{Known, NormalSource, SampleOptions, Samples};

/// Points as a file gives them, in the file's own units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// Positions; finite.
    pub points: Vec<DVec3>,
    /// Unit normals, one a point, where the file has any; zero where this point's is missing.
    pub normals: Option<Vec<DVec3>>,
    /// Linear colours, one a point, components in 0..1.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Rows of the file that were no points, for a coordinate that is not finite.
    pub dropped: u64,
    /// What was dropped or mended on the way, one sentence each.
    pub notes: Vec<String>,
}
