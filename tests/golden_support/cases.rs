//! Known cases of booleans, with the volumes that books or a few lines of integration give: faces that coincide through other
//! transforms, tangencies, cavities, mirrors.

use std::f64::consts::PI;

use super::{Golden, LIGHT};

/// A cap of a scan's hole is no part of the ball: it is as flat as the rim lets it be.
const CAPPED: f64 = 0.02;

/// How far exact solids may be off their volumes, as lines measure them.
const EXACT: f64 = 0.001;

/// Points of the unit ball below z = 0.6, with normals: an open bowl.
pub fn bowl() -> Vec<u8> {
    const ALL: u32 = 1600;
    let place = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(ALL);
        // The golden angle: the points lie evenly (Fibonacci's lattice).
        let (sin, cos) = (f64::from(i) * PI * (3.0 - 5f64.sqrt())).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    };
    let points: Vec<[f64; 3]> = (0..ALL).map(place).filter(|p| p[2] < 0.6).collect();
    let names = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    let head =
        format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n{names}end_header\n", points.len());
    let mut ply = head.into_bytes();
    for p in points {
        [p, p].concat().iter().for_each(|x| ply.extend((*x as f32).to_le_bytes()));
    }
    ply
}

/// Names, the items that make `part`, and its volume.
fn cases() -> Vec<(&'static str, &'static str, f64)> {
    vec![
        // Flush at both ends, by another way to the same place: no film.
        (
            "flush-bore",
            "let cube = box(size: 2).rotate(axis: [1, 2, 3], by: 30deg)
let bore = cylinder(r: 0.5, from: [0, 0, -1], to: [0, 0, 1]).rotate(axis: [1, 2, 3], by: 10deg).rotate(axis: [1, 2, 3], by: 20deg)
let part = cube - bore",
            8.0 - 0.5 * PI,
        ),
        // Cubes that share their floors and ceilings, one taken from the other twice.
        (
            "coplanar",
            "let cube = box([0, 0, 0], [1, 1, 1]).rotate_z(30deg)
let other = box([0.3, 0.3, 0], [1.3, 1.3, 1]).rotate_z(10deg).rotate_z(20deg)
let third = box([-0.3, -0.3, 0], [0.7, 0.7, 1]).rotate_z(-330deg)
let part = cube - other - third",
            0.18,
        ),
        // No wall between: three boxes in a row, the middle one by another way, and a peg pressed into its hole.
        (
            "abutting",
            "let left = box([-1.5, -0.5, -0.5], [-0.5, 0.5, 0.5]).rotate_y(25deg)
let right = box([0, 0, 0], [1, 1, 1]).move([0.5, -0.5, -0.5]).rotate_y(12deg).rotate_y(13deg)
let hole = cylinder(r: 0.3, from: [0, 0, -0.5], to: [0, 0, 0.5]).rotate_y(25deg)
let peg = cylinder(r: 3, from: [0, 0, -5], to: [0, 0, 5]).scale(0.1).rotate_y(25deg)
let part = left | (box(size: 1).rotate_y(25deg) - hole) | peg | right",
            3.0,
        ),
        (
            "tricylinder",
            "let along_z = cylinder(r: 1, from: [0, 0, -2], to: [0, 0, 2])
let part = along_z & along_z.rotate_x(90deg) & along_z.rotate_y(90deg)",
            8.0 * (2.0 - 2f64.sqrt()),
        ),
        // A ball and a cylinder through its middle that touches it from inside.
        (
            "viviani",
            "let part = sphere(r: 1) & cylinder(r: 0.5, from: [0.5, 0, -2], to: [0.5, 0, 2])",
            2.0 * PI / 3.0 - 8.0 / 9.0,
        ),
        // Two balls that touch from inside.
        ("tangent", "let part = sphere(r: 1) - sphere(r: 0.5, at: [0.5, 0, 0])", 4.0 / 3.0 * PI * 0.875),
        (
            "napkin-ring",
            "let part = sphere(r: 1) - cylinder(r: 0.8, from: [0, 0, -2], to: [0, 0, 2])",
            PI * 1.2f64.powi(3) / 6.0,
        ),
        // A mirror turns no face inside out, and an onion has as many skins as it has.
        (
            "onion",
            "fn skin(r) = sphere(r: r) - sphere(r: r - 0.1)
let half = union(for i in 1..5 { skin(0.2 * i) }) & half_space(x + y < 0)
let part = half | half.mirror([1, 1, 0])",
            4.0 / 3.0 * PI * (1..5).map(|i| (0.2 * f64::from(i)).powi(3) - (0.2 * f64::from(i) - 0.1).powi(3)).sum::<f64>(),
        ),
        // A scan with a hole, closed by a cap and cut through both: a cap is a face as any other.
        (
            "capped",
            "let part = points(\"bowl.ply\").close(max_hole: 2) - half_space(y < 0)",
            (4.0 / 3.0 - 0.4 * 0.4 * (3.0 - 0.4) / 3.0) * PI / 2.0,
        ),
    ]
}

/// All scenes.
pub fn scenes() -> Vec<Golden> {
    let scene = |(name, items, volume): (&str, &str, f64)| {
        let view = "camera(eye: [3, -4, 2.5], look_at: [0, 0, 0], height: 4, kind: \"orthographic\")\n";
        let within = 100.0 * if name == "capped" { CAPPED } else { EXACT };
        let text = format!(
            "{view}{LIGHT}{items}\ndraw part.with(red)\nexpect volume(part) ~= {volume} within {within}%\n"
        );
        Golden::new(format!("cases/{name}"), text)
    };
    cases().into_iter().map(scene).collect()
}
