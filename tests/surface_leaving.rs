//! A ray that leaves a surface point by the point's own bound does not meet the surface there again.

mod common;

use common::{Truth, all, chord, surface};
use glam::DVec3;
use pss::geom::{Interval, Ray};
use pss::num::hash::Stream;
use pss::solid::point_set::{FieldScratch, Options, PointSet};
use pss::solid::{Body, Scratch, Solid};
use rayon::prelude::*;

/// A direction on the unit sphere, often almost in the plane across `normal`.
fn direction(stream: &mut Stream, normal: DVec3) -> DVec3 {
    let d = DVec3::new(stream.normal(), stream.normal(), stream.normal()).normalize();
    if stream.unit() < 0.5 {
        return d;
    }
    let flat = (d - d.dot(normal) * normal).normalize();
    (flat + normal * d.dot(normal) * 10f64.powf(-9.0 * stream.unit())).normalize()
}

/// Of one chord's crossings: how many rays were tried, and how many met something they should not have.
fn leave(set: &PointSet, i: u64, convex: bool, room: &mut (Scratch, FieldScratch)) -> [u64; 2] {
    let (scratch, field) = room;
    let ray = chord(i, DVec3::ZERO, 2.0);
    let mut stream = Stream::new(i ^ 0x1ea);
    let mut out = [0; 2];
    for hit in all(set, &ray, scratch) {
        let normal = set.normal(&ray, &hit, scratch);
        let dir = direction(&mut stream, normal);
        let away = if 0.0 < dir.dot(normal) { normal } else { -normal };
        let from = Ray::new(ray.at(hit.t) + away * set.shift_bound(), dir);
        let mut met = Vec::new();
        let answer = set.crossings(&from, Interval::new(0.0, f64::INFINITY), scratch, &mut met);
        let outside = away == normal;
        // Out of a sphere nothing is met. Elsewhere what is met is the other kind, and on the way to it F has the sign
        // of the side that the ray left to: were it the place that was left, there would be no such way.
        let wrong = answer.inside == outside || (convex && outside && !met.is_empty());
        let wrong = wrong || met.first().is_some_and(|c| c.entering != outside);
        let wrong = wrong
            || met.first().is_some_and(|c| {
                let f = set.field(from.at(0.5 * c.t), field);
                f.is_ok_and(|f| (0.0 < f.value) != outside)
            });
        out[0] += 1;
        out[1] += u64::from(wrong);
    }
    out
}

/// `PSS_LONG=1` tries a million and more on each.
#[test]
fn a_ray_that_leaves_a_surface_by_its_bound_does_not_meet_it_there_again() {
    let chords = if std::env::var_os("PSS_LONG").is_some() { 2_000_000 } else { 1_500 };
    for truth in Truth::CLOSED {
        let (points, normals) = truth.cloud(10_000);
        for tolerance in [1e-9, 1e-6] {
            let options = Options { tolerance, ..Options::default() };
            let set = surface(&points, &normals, &options).with_body(Body::Solid);
            let [tried, wrong] = (0..chords)
                .into_par_iter()
                .map_init(Default::default, |room, i| leave(&set, i, truth == Truth::Sphere, room))
                .reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            println!("{truth:?}, tolerance {tolerance:e}: {tried} rays, {wrong} met the surface they left");
            assert!(chords / 8 < tried && wrong == 0);
        }
    }
}
