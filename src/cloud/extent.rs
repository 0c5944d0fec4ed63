//! Whether points can carry a surface at all: not all equal, not all on a line, of a size that can be squared.

use glam::DVec3;

use super::CloudError;
use crate::geom::{Aabb, tolerance};

/// Clouds wider than this are refused: it is no length of this world (the observable universe has 1e27 m),
/// and its square, cube and fourth power, which the plane fit needs, stay finite below it.
const WIDEST: f64 = 1e30;

/// Points nearer to one line than this share of its length are on the line: a surface of that shape would
/// need 1e6 samples along its length for one across.
const LINE: f64 = 1e-6;

/// Whether all coordinates are those of single precision: what a file of floats holds, and what one of doubles may.
pub fn is_single(points: &[DVec3]) -> bool {
    points.iter().flat_map(|p| p.to_array()).all(|x| f64::from(x as f32) == x)
}

/// The distance between neighbouring coordinates of `points` where they are farthest from the origin, in the precision
/// they really have; world length.
pub fn coordinate_step(points: &[DVec3], bounds: &Aabb) -> f64 {
    let farthest = bounds.farthest();
    farthest * if is_single(points) { f64::from(f32::EPSILON) } else { tolerance::EPS }
}

/// Fails where the points have no surface: none at all, all equal, or all on a line.
pub fn check_extent(points: &[DVec3]) -> Result<(), CloudError> {
    let Some(&first) = points.first() else {
        return Err(CloudError::bad("no points").help("export the cloud again with its vertices"));
    };
    let bounds = Aabb::of_points(points.iter().copied());
    let diagonal = bounds.diagonal();
    if diagonal.is_nan() || WIDEST < diagonal {
        return Err(CloudError::bad(format!("the points span more than {WIDEST:e}"))
            .help("wrong byte order? compare the `format` line with the program that wrote the file"));
    }
    let farthest = |from: DVec3| {
        let far = |a: DVec3, b: DVec3| if from.distance(a) < from.distance(b) { b } else { a };
        points.iter().copied().fold(from, far)
    };
    let a = farthest(first);
    let b = farthest(a);
    let length = a.distance(b);
    if length == 0.0 {
        return Err(CloudError::bad("no surface: all points are equal")
            .help("the cloud needs points in two directions"));
    }
    let along = (b - a) / length;
    let off_line = |p: &DVec3| ((*p - a) - along * (*p - a).dot(along)).length();
    let widest = points.iter().map(off_line).fold(0.0, f64::max);
    let step = coordinate_step(points, &bounds);
    if widest <= LINE * length {
        return Err(CloudError::bad("no surface: all points are on a line")
            .help("the cloud needs points in two directions"));
    }
    // Rounding moves either end of a distance by half a step on each axis.
    if widest <= 2.0 * step {
        let message = format!("no surface: coordinates {step:.1e} apart put all points on a line");
        return Err(
            CloudError::bad(message).help("export the cloud in double precision, or nearer to the origin")
        );
    }
    Ok(())
}
