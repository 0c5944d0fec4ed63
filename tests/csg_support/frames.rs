//! Frames that scenes are moved to: 64 rotations at four distances from the origin.

use glam::{DAffine3, DVec3};
use pss::geom::Ray;

use super::draws::Draws;

/// How many rotations there are.
pub const TURNS: u64 = 64;

/// Distances from the origin, about.
pub const OFFSETS: [f64; 4] = [0.0, 1e3, 1e5, 1e7];

/// One of the rotations and an offset, as a method chain of the language and as a map.
pub fn frame(i: u64, offset: f64) -> (String, DAffine3) {
    let mut draws = Draws::new(i + 1);
    let (mut axis, mut degrees) = (draws.direction(), draws.between(0.0, 180.0));
    if i < 8 {
        (axis, degrees) = (DVec3::AXES[i as usize % 3], [0.0, 90.0, 45.0, 30.0][i as usize / 2]);
    }
    let to = offset * DVec3::new(1.0, -0.7, 0.3);
    let text = format!(
        ".rotate(axis: [{}, {}, {}], by: {degrees:?}deg).move([{:?}, {:?}, {:?}])",
        axis.x, axis.y, axis.z, to.x, to.y, to.z
    );
    (text, DAffine3::from_translation(to) * DAffine3::from_axis_angle(axis, degrees.to_radians()))
}

/// Runs a check in every frame.
pub fn each_frame(mut check: impl FnMut(&str, &DAffine3)) {
    for i in 0..TURNS {
        for offset in OFFSETS {
            let (text, map) = frame(i, offset);
            check(&text, &map);
        }
    }
}

/// A ray through two points of the scene's own frame.
pub fn through(map: &DAffine3, a: DVec3, b: DVec3) -> Ray {
    let [a, b] = [a, b].map(|p| map.transform_point3(p));
    Ray::new(a, b - a)
}
