//! Outlines, the solids made of them, and what these hold by the angles under which a point sees the edges.
#![allow(dead_code, missing_docs)]

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use pss::solid::Solid;
use pss::solid::extrude::Extrusion;
use pss::solid::outline::Outline;
use pss::solid::revolve::Revolution;

/// A solid and what it holds.
pub type Shape = (Box<dyn Solid>, Box<dyn Fn(DVec3) -> bool>);
pub type Loops = Vec<Vec<[f64; 2]>>;

pub fn outline(loops: &Loops) -> Outline {
    Outline::new(loops, "outline").unwrap()
}

/// Twice the number of loops around a point, by the angles under which it sees their edges; odd is inside.
pub fn winds(loops: &Loops, q: DVec2) -> bool {
    let mut count = 0;
    for points in loops {
        let corner = |i: usize| DVec2::from_array(points[i % points.len()]) - q;
        let sum: f64 = (0..points.len()).map(|i| corner(i).angle_to(corner(i + 1))).sum();
        count += (sum / TAU).round() as i64;
    }
    count % 2 != 0
}

/// What an extrusion holds.
pub fn extruded(loops: &Loops, h: f64, twist: f64, scale: DVec2, p: DVec3) -> bool {
    let part = p.z / h;
    let m = DVec2::ONE + part * (scale - 1.0);
    let (sin, cos) = (-twist * part).sin_cos();
    let q = DVec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y) / m;
    (0.0..h).contains(&p.z) && winds(loops, q)
}

pub fn revolved(loops: &Loops, angle: f64, p: DVec3) -> bool {
    let azimuth = p.y.atan2(p.x).rem_euclid(TAU);
    azimuth < angle && winds(loops, DVec2::new(p.x.hypot(p.y), p.z))
}

pub fn star(points: usize, wobble: u32) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let r = if i.is_multiple_of(2) { 1.0 } else { 0.55 } + 0.1 * f64::from(wobble) * (i as f64).sin();
        let (sin, cos) = (TAU * i as f64 / points as f64).sin_cos();
        [r * cos + 0.1, r * sin - 0.2]
    };
    (0..points).map(corner).collect()
}

pub fn ell() -> Loops {
    vec![
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]],
        vec![[0.25, 0.25], [0.25, 0.75], [0.75, 0.75], [0.75, 0.25]],
    ]
}

/// The shapes for the oracle tests: the solid and what it holds.
pub fn shapes() -> Vec<Shape> {
    let mut made: Vec<Shape> = Vec::new();
    let outlines = [ell(), vec![star(10, 0)], vec![star(200, 1)], vec![star(14, 1), star(6, 2)]];
    let ways = [
        (0.0, DVec2::ONE),
        (0.0, DVec2::splat(0.3)),
        (0.0, DVec2::splat(2.5)),
        (0.0, DVec2::ZERO),
        (0.0, DVec2::new(0.0, 1.5)),
        (0.7, DVec2::ONE),
        (-5.0, DVec2::new(0.4, 1.7)),
        (2.5 * TAU, DVec2::splat(0.6)),
    ];
    for loops in &outlines {
        for (twist, scale) in ways {
            let held = loops.clone();
            made.push((
                Box::new(Extrusion::new(outline(loops), 1.7, twist, scale)),
                Box::new(move |p| extruded(&held, 1.7, twist, scale, p)),
            ));
        }
        let moved: Loops = loops.iter().map(|l| l.iter().map(|p| [p[0] + 1.3, p[1]]).collect()).collect();
        for angle in [TAU, 0.5, PI, 1.5 * PI, 6.0] {
            let held = moved.clone();
            made.push((
                Box::new(Revolution::new(outline(&moved), angle)),
                Box::new(move |p| revolved(&held, angle, p)),
            ));
        }
    }
    made
}
