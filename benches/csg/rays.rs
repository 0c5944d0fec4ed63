//! Rays through objects made here, by the library, on this thread.

use std::sync::Arc;

use glam::DVec3;
use pss::csg::{Expr, Leaf, Object, Scratch, Spans};
use pss::geom::{Aabb, Interval, Placement, Ray};
use pss::num::hash::Stream;
use pss::solid::Solid;
use pss::solid::block::Block;
use pss::solid::half_space::HalfSpace;
use pss::solid::sphere::Sphere;

use crate::clock::median_seconds;
use crate::table::Row;

fn leaf(solid: impl Solid + 'static) -> Leaf {
    Leaf::new(Arc::new(solid), Placement::IDENTITY)
}

fn ball(center: DVec3, radius: f64) -> Leaf {
    leaf(Sphere { center, radii: DVec3::splat(radius) })
}

fn cube(min: DVec3, max: DVec3) -> Leaf {
    leaf(Block(Aabb { min, max }))
}

fn minus(base: Expr, cutters: Vec<Expr>) -> Expr {
    Expr::And(vec![base, Expr::Not(Box::new(Expr::Or(cutters)))])
}

fn leaves(range: std::ops::Range<u32>) -> Vec<Expr> {
    range.map(Expr::Leaf).collect()
}

/// Rays of a pinhole camera that looks at the origin, all of which meet a ball of this radius about it.
fn view(side: usize, radius: f64) -> Vec<Ray> {
    let eye = DVec3::new(3.0, 2.0, 2.5) * radius;
    let forward = -eye.normalize();
    let (u, v) = forward.any_orthonormal_pair();
    let at = |i: usize| 2.0 * (i as f64 + 0.5) / side as f64 - 1.0;
    let target = |x: usize, y: usize| radius * (at(x) * u + at(y) * v);
    let rays = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    let rays = rays.map(|(x, y)| target(x, y)).filter(|p| p.length() < 0.98 * radius);
    rays.map(|p| Ray::new(eye, p - eye)).collect()
}

/// Rays between random points of a ball of this radius, the ends pulled out to it.
fn strewn(count: usize, radius: f64) -> Vec<Ray> {
    let mut stream = Stream::new(7);
    let mut point = || {
        let mut axis = || 2.0 * stream.unit() - 1.0;
        DVec3::new(axis(), axis(), axis()).normalize() * radius
    };
    (0..count).map(|_| (point(), point())).map(|(a, b)| Ray::new(a, b - a)).collect()
}

/// Seconds a ray to its first boundary.
fn first(object: &Object, rays: &[Ray]) -> f64 {
    let mut scratch = Scratch::default();
    let all = || rays.iter().filter(|ray| object.first(ray, Interval::AHEAD, &mut scratch).is_some()).count();
    let mut all = all;
    median_seconds(7, || {
        std::hint::black_box(all());
    }) / rays.len() as f64
}

/// Seconds a ray to all spans.
fn whole(object: &Object, rays: &[Ray]) -> f64 {
    let (mut scratch, mut out) = (Scratch::default(), Spans::new());
    median_seconds(3, || {
        for ray in rays {
            out.clear();
            object.spans(ray, Interval::ALL, &mut scratch, &mut out);
            std::hint::black_box(&out);
        }
    }) / rays.len() as f64
}

/// Two leaves: the first boundary of rays that all meet the ball around them.
pub fn two_leaves(rows: &mut Vec<Row>) {
    let rays = view(1024, 1.0);
    let (a, b) = (ball(DVec3::ZERO, 0.9), cube(DVec3::splat(-0.2), DVec3::splat(1.1)));
    let two = || vec![Expr::Leaf(0), Expr::Leaf(1)];
    let cases = [
        ("ball - box", minus(Expr::Leaf(0), vec![Expr::Leaf(1)])),
        ("ball & box", Expr::And(two())),
        ("ball | box", Expr::Or(two())),
        ("ball ^ box", Expr::Xor(two())),
    ];
    for (what, expr) in cases {
        let object = Object::new(vec![a.clone(), b.clone()], &expr);
        let rate = 1e-6 / first(&object, &rays);
        rows.push(Row::new(format!("two leaves, {what}, first boundary"), rate, "Mray/s", ">= 8"));
    }
}

/// A chain ((s0 - s1) | s2) - ... of 10,000 operators over balls strewn in a cube.
pub fn chain(rows: &mut Vec<Row>) {
    const COUNT: u32 = 10_001;
    let mut stream = Stream::new(3);
    let mut axis = || 2.0 * stream.unit() - 1.0;
    let balls: Vec<Leaf> = (0..COUNT).map(|_| ball(DVec3::new(axis(), axis(), axis()), 0.06)).collect();
    let expr = (1..COUNT).fold(Expr::Leaf(0), |left, i| match i % 2 {
        1 => minus(left, vec![Expr::Leaf(i)]),
        _ => Expr::Or(vec![left, Expr::Leaf(i)]),
    });
    let object = Object::new(balls, &expr);
    let rays = strewn(2000, 1.7);
    rows.push(Row::new(
        "chain of 10,000 operators, all spans",
        1e6 * whole(&object, &rays),
        "us/ray",
        "<= 100",
    ));
    rows.push(Row::new("chain of 10,000 operators, first", 1e6 * first(&object, &rays), "us/ray", ""));
}

/// A lattice of 47 x 47 x 47 balls of radius 1, apart, overlapping, and cut from a box.
pub fn lattice(rows: &mut Vec<Row>) {
    const SIDE: u32 = 47;
    let balls = |pitch: f64| -> Vec<Leaf> {
        let at = |i: u32| pitch * (f64::from(i) - 0.5 * f64::from(SIDE - 1));
        let cells = (0..SIDE.pow(3)).map(|i| (i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE));
        cells.map(|(x, y, z)| ball(DVec3::new(at(x), at(y), at(z)), 1.0)).collect()
    };
    let count = SIDE.pow(3);
    let rays = strewn(2000, 100.0);
    for (what, pitch) in [("apart", 2.5), ("overlapping", 1.5)] {
        let object = Object::new(balls(pitch), &Expr::Or(leaves(0..count)));
        rows.push(Row::new(
            format!("103,823 balls {what}, all spans"),
            1e6 * whole(&object, &rays),
            "us/ray",
            "<= 50",
        ));
        rows.push(Row::new(
            format!("103,823 balls {what}, first"),
            1e6 * first(&object, &rays),
            "us/ray",
            "",
        ));
    }
    let mut cut = balls(2.5);
    cut.push(cube(DVec3::splat(-60.0), DVec3::splat(60.0)));
    let object = Object::new(cut, &minus(Expr::Leaf(count), leaves(0..count)));
    rows.push(Row::new(
        "box - 103,823 balls, all spans",
        1e6 * whole(&object, &rays),
        "us/ray",
        "<= 2 x apart",
    ));
}

/// Ten thousand half-spaces that touch the unit ball.
pub fn polytope(rows: &mut Vec<Row>) {
    const COUNT: u32 = 10_000;
    let half = |i: u32| {
        // Even on the ball: heights in steps, turned by the golden angle (Fibonacci lattice).
        let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(COUNT);
        let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
        let r = (1.0 - z * z).sqrt();
        leaf(HalfSpace { normal: DVec3::new(r * cos, r * sin, z), offset: 1.0 })
    };
    let object = Object::new((0..COUNT).map(half).collect(), &Expr::And(leaves(0..COUNT)));
    let rays = strewn(32, 1.7);
    rows.push(Row::new(
        "polytope of 10,000 half-spaces, all spans",
        1e6 * whole(&object, &rays),
        "us/ray",
        "<= 1000",
    ));
    rows.push(Row::new("polytope of 10,000 half-spaces, first", 1e6 * first(&object, &rays), "us/ray", ""));
}
