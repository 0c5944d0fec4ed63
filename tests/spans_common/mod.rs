//! The crossings of bounded solids, checked, and held against those of a box.
#![allow(dead_code, missing_docs)]

use glam::{DVec3, dvec3};
use pss::geom::{Interval, Ray};
use pss::num::hash::Stream;
use pss::solid::block::Block;
use pss::solid::{Crossing, Scratch, Solid};

/// All crossings of the ray's line: finite, ascending, in and out in turn, without a repair.
pub fn crossings(solid: &dyn Solid, ray: &Ray) -> Vec<Crossing> {
    let (mut out, mut scratch) = (Vec::new(), Scratch::default());
    let answer = solid.crossings(ray, Interval::ALL, &mut scratch, &mut out);
    assert_eq!((answer.inside, answer.range), (false, Interval::ALL));
    assert_eq!(scratch.counts.parity_repairs, 0, "an odd line: {out:?} {ray:?}");
    for (i, c) in out.iter().enumerate() {
        assert!(c.t.is_finite() && c.entering == (i % 2 == 0), "{out:?} {ray:?}");
    }
    assert!(out.len().is_multiple_of(2), "{out:?} {ray:?}");
    assert!(out.windows(2).all(|w| w[0].t < w[1].t), "{out:?} {ray:?}");
    out
}

/// Through corners, along edges, in faces: from a lattice along one of 26 ways.
fn lattice_ray(stream: &mut Stream) -> Option<Ray> {
    let mut whole = || (stream.unit() * 5.0).floor() - 2.0;
    let origin = dvec3(whole(), whole(), whole());
    let step = |x: f64| x.rem_euclid(3.0) - 1.0;
    let dir = dvec3(step(whole()), step(whole()), step(whole()));
    (dir != DVec3::ZERO).then(|| Ray::new(origin, dir))
}

/// Holds a solid against the box that it is, on chords of a ball about it and on rays of a lattice in turn; `also` may ask
/// more of each pair of crossings, and is told whether the ray is one of a lattice.
pub fn assert_is_box(
    solid: &dyn Solid,
    block: &Block,
    rays: usize,
    radius: f64,
    tolerance: f64,
    also: impl Fn(&Ray, bool, [&Crossing; 2]),
) {
    let mut stream = Stream::new(1);
    let mut hits = 0;
    for i in 0..rays {
        let lattice = i % 2 == 1;
        let chord = |stream: &mut Stream| Some(Ray::chord(stream, block.0.center(), radius));
        let ray = if lattice { lattice_ray(&mut stream) } else { chord(&mut stream) };
        let Some(ray) = ray else { continue };
        let (have, want) = (crossings(solid, &ray), crossings(block, &ray));
        assert_eq!(have.len(), want.len(), "{ray:?} {have:?} {want:?}");
        hits += want.len();
        for (a, b) in have.iter().zip(&want) {
            assert!((a.t - b.t).abs() <= tolerance * (1.0 + b.t.abs()), "{ray:?} {a:?} {b:?}");
            also(&ray, lattice, [a, b]);
        }
    }
    assert!(10_000 < hits);
}
