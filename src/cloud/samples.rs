//! What a surface is made from: distinct points with oriented normals and widths, in an order that keeps
//! neighbours together.

use glam::DVec3;

use super::neighbours::{Neighbours, Table};
use super::normals::{self, NORMAL_NEIGHBOURS, Oriented, Scene};
use super::winding::Winding;
use super::{
    AREA_REACH, Cloud, CloudError, areas_by, check_extent, merge_duplicates, order, spacing, strays,
};
use crate::geom::Aabb;

/// With a twentieth of the samples strewn through and about a ball the fifth round found none; a spike one sample high
/// loses no more samples of its end than this.
const STRAY_ROUNDS: usize = 6;
/// A round that finds fewer than one in so many samples is the last: large scans always have a few more.
const SETTLED: usize = 10_000;

/// Of more samples the nearest ones are not kept, but sought again where they are wanted: beside the surface they would make the
/// most memory that is ever held.
const KEPT: usize = 1 << 22;

/// What is known of the neighbours of samples.
#[derive(Clone, Debug)]
pub struct Known {
    /// The search tree of the points.
    pub tree: Neighbours,
    /// The nearest of each, of not too many.
    pub table: Option<Table>,
}

impl Known {
    /// Of some points the tree.
    pub fn of(points: &[DVec3]) -> Known {
        Known { tree: Neighbours::new(points), table: None }
    }
}

/// Where normals come from.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum NormalSource {
    /// The file, where it has them; else they are estimated.
    #[default]
    File,
    /// Always estimated.
    Estimate,
}

/// How samples are made.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SampleOptions {
    /// Multiplies the widths.
    pub smoothing: f64,
    /// Replaces the widths, world length.
    pub width: Option<f64>,
    /// Where normals come from.
    pub normals: NormalSource,
    /// Whether samples that carry no surface are kept.
    pub keep_strays: bool,
}

impl Default for SampleOptions {
    fn default() -> SampleOptions {
        SampleOptions { smoothing: 1.0, width: None, normals: NormalSource::File, keep_strays: false }
    }
}

/// Samples of a surface, in Morton order; no two at one position. All but `notes` is a function of the set
/// of points, not of their order in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Positions.
    pub points: Vec<DVec3>,
    /// Unit normals, outward.
    pub normals: Vec<DVec3>,
    /// Width of each sample's weight, world length.
    pub widths: Vec<f64>,
    /// Root of the area of each sample by its six nearest, world length.
    pub spacing: Vec<f64>,
    /// Linear colours, where the file has them.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Share of the pairs of near samples whose normals are opposed; above 0.01 the cloud is no solid to trust.
    pub opposed: f64,
    /// Normals of the file that were turned singly.
    pub turned: usize,
    /// Whether normals were estimated from the positions.
    pub estimated: bool,
    /// What was dropped or mended on the way, one sentence each.
    pub notes: Vec<String>,
}

impl Samples {
    /// Merges, sorts and measures the points of a cloud. Fails where they carry no surface, and where an option is
    /// no positive number.
    pub fn new(cloud: Cloud, options: &SampleOptions) -> Result<Samples, CloudError> {
        Ok(Samples::with_known(cloud, options)?.0)
    }

    /// The same, with what is known of the points' neighbours, for who asks on.
    pub fn with_known(cloud: Cloud, options: &SampleOptions) -> Result<(Samples, Known), CloudError> {
        check_options(options)?;
        check_extent(&cloud.points)?;
        let mut cloud = merge_duplicates(cloud);
        let mut measured = Measured::new(&cloud.points);
        if !options.keep_strays {
            (cloud, measured) = without_strays(cloud, measured)?;
        }
        let Cloud { points, normals, colors, mut notes, .. } = cloud;
        let Measured { tree, table, spacing, widths } = measured;
        let widths = spacing::capped(&points, &spacing, widths, &tree);
        let scene = Scene { points: &points, table: &table, widths: &widths };
        let given = normals.filter(|_| options.normals == NormalSource::File);
        let estimated = given.is_none();
        let oriented = given.map_or_else(|| normals::from_points(scene), |n| normals::from_file(scene, n));
        let Oriented { normals, opposed, turned, notes: more } = oriented;
        notes.extend(more);
        let widths = widths.iter().map(|h| options.width.unwrap_or(*h) * options.smoothing).collect();
        let samples = Samples { points, normals, widths, spacing, colors, opposed, turned, estimated, notes };
        let table = Some(table).filter(|_| samples.len() <= KEPT);
        Ok((samples, Known { tree, table }))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are none; never so for samples that [`Samples::new`] made.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The box around the points.
    pub fn bounds(&self) -> Aabb {
        Aabb::of_points(self.points.iter().copied())
    }

    /// The winding number of the samples; `opening` as for [`Winding::new`], such as [`Winding::OPENING`].
    pub fn winding(&self, opening: f64) -> Winding {
        let measured = Measured::new(&self.points);
        let reach: Vec<f64> = measured.widths.iter().map(|h| AREA_REACH * h).collect();
        let areas = areas_by(&self.points, &self.normals, &reach, &measured.table);
        Winding::new(&self.points, &self.normals, &areas, opening)
    }
}

/// A cloud less its strays, round by round: those that others hid come out in the next.
fn without_strays(mut cloud: Cloud, mut measured: Measured) -> Result<(Cloud, Measured), CloudError> {
    let before = cloud.points.len();
    for _ in 0..STRAY_ROUNDS {
        let Measured { tree, table, spacing, widths } = &measured;
        let stray = strays::strays(&cloud.points, spacing, widths, table, tree);
        let found = stray.iter().filter(|stray| **stray).count();
        if found == 0 {
            break;
        }
        let kept: Vec<u32> = (0..).zip(&stray).filter(|(_, stray)| !**stray).map(|(i, _)| i).collect();
        cloud = order::select(cloud, &kept);
        check_extent(&cloud.points)?;
        measured = Measured::new(&cloud.points);
        if found * SETTLED < before {
            break;
        }
    }
    let gone = before - cloud.points.len();
    if 0 < gone {
        cloud.notes.push(format!("{gone} stray points, which carry no surface, were dropped"));
    }
    Ok((cloud, measured))
}

/// What depends on positions alone.
struct Measured {
    tree: Neighbours,
    table: Table,
    spacing: Vec<f64>,
    widths: Vec<f64>,
}

impl Measured {
    fn new(points: &[DVec3]) -> Measured {
        let tree = Neighbours::new(points);
        let table = tree.table(NORMAL_NEIGHBOURS);
        let spacing = spacing::spacing(points, &table);
        let widths = spacing::widths(&spacing, &table);
        Measured { tree, table, spacing, widths }
    }
}

fn check_options(options: &SampleOptions) -> Result<(), CloudError> {
    for (name, value) in [("smoothing", Some(options.smoothing)), ("h", options.width)] {
        if value.is_some_and(|v| !v.is_finite() || v <= 0.0) {
            return Err(CloudError::bad(format!("`{name}` must be a positive number")));
        }
    }
    Ok(())
}
