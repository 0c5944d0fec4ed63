//! Every operator, on two balls and a third within both: analytic, and scans of them. And films as thin as they can be kept.

use std::f64::consts::PI;

use super::{Golden, LIGHT};

const CAMERA: &str = "camera(eye: [3, -4, 2.5], look_at: [0, 0, 0], height: 3.2, kind: \"orthographic\")\n";

/// The radius of the two balls, which stand at half of one to either side of the origin; and that of the third, at the origin.
const R: f64 = 0.9;
const SMALL: f64 = 0.3;

fn balls(scans: bool) -> String {
    let of = |x: f64, r: f64| {
        let ball = format!("sphere(r: {r}, at: [{x}, 0, 0])");
        if scans { format!("points({ball}, samples: 1500)") } else { ball }
    };
    let [a, b, c] = [of(-0.5, R), of(0.5, R), of(0.0, SMALL)];
    format!("let a = {a}.with(red)\nlet b = {b}.with(blue)\nlet c = {c}\n")
}

fn ball(r: f64) -> f64 {
    4.0 / 3.0 * PI * r * r * r
}

/// What two balls of radius r at distance one have in common.
fn lens(r: f64) -> f64 {
    PI * (4.0 * r + 1.0) * (2.0 * r - 1.0).powi(2) / 12.0
}

/// What a bore of radius s along z takes from the two balls: four times the half chord of the right one over half of a disc.
fn bored(s: f64) -> f64 {
    const N: i32 = 400;
    let middle = |i: i32| (f64::from(i) + 0.5) / f64::from(N);
    let cell = |i, j| {
        let (r, angle) = (s * middle(i), PI * (middle(j) - 0.5));
        let (x, y) = (r * angle.cos(), r * angle.sin());
        r * (R * R - (x - 0.5).powi(2) - y * y).sqrt()
    };
    let sum: f64 = (0..N).flat_map(|i| (0..N).map(move |j| cell(i, j))).sum();
    4.0 * sum * s * PI / f64::from(N * N)
}

/// Names, expressions over a, b, c, their volumes, and what a line at y = 0.2 along x is inside of.
fn operators() -> Vec<(&'static str, &'static str, f64, Vec<f64>)> {
    let (one, common, small) = (ball(R), lens(R), ball(SMALL));
    let half = |r: f64| (r * r - 0.04).sqrt();
    let (h, k) = (half(R), half(SMALL));
    vec![
        ("union", "a | b", 2.0 * one - common, vec![-0.5 - h, 0.5 + h]),
        ("intersection", "a & b", common, vec![0.5 - h, h - 0.5]),
        ("difference", "a - b", one - common, vec![-0.5 - h, 0.5 - h]),
        ("xor", "a ^ b", 2.0 * (one - common), vec![-0.5 - h, 0.5 - h, h - 0.5, 0.5 + h]),
        ("complement", "!a & b", one - common, vec![h - 0.5, 0.5 + h]),
        ("union-list", "union([a, b, c])", 2.0 * one - common, vec![-0.5 - h, 0.5 + h]),
        ("intersection-list", "intersection([a, b, c])", small, vec![-k, k]),
        ("difference-list", "difference(a, [b, c])", one - common, vec![-0.5 - h, 0.5 - h]),
        (
            "xor-list",
            "xor([a, b, c])",
            2.0 * (one - common) + small,
            vec![-0.5 - h, 0.5 - h, -k, k, h - 0.5, 0.5 + h],
        ),
        ("outside", "(!a) & box(size: 3)", 27.0 - one, vec![-1.5, -0.5 - h, h - 0.5, 1.5]),
        (
            "drilled",
            "(a | b) - cylinder(r: 0.3, from: [0, 0, -2], to: [0, 0, 2])",
            2.0 * one - common - bored(0.3),
            vec![-0.5 - h, -k, k, 0.5 + h],
        ),
        (
            "halved",
            "(a | b) & half_space(z < 0.1)",
            // Half of it, and a slice as thick as 0.1 about the largest section.
            one - 0.5 * common + slice(0.1),
            vec![-0.5 - h, 0.5 + h],
        ),
    ]
}

/// The volume of both balls from z = 0 up to z: sections are two discs with their lens taken once.
fn slice(z: f64) -> f64 {
    const N: i32 = 1000;
    let section = |z: f64| {
        let r = (R * R - z * z).sqrt();
        2.0 * PI * r * r - (2.0 * r * r * (0.5 / r).acos() - 0.5 * (4.0 * r * r - 1.0).sqrt())
    };
    (0..N).map(|i| section(z * (f64::from(i) + 0.5) / f64::from(N))).sum::<f64>() * z / f64::from(N)
}

/// What scans are drawn under: the rest would show the same again.
const SCANNED: [&str; 5] = ["union", "intersection", "difference", "xor", "difference-list"];

fn scene(expr: &str, scans: bool, volume: f64, ends: &[f64]) -> String {
    let balls = balls(scans);
    let mut text = format!("{CAMERA}{LIGHT}{balls}let shown = {expr}\n");
    // What is inside shall be seen.
    text += "draw shown & half_space(y > 0)\n";
    if !scans {
        text += &format!("expect volume(shown) ~= {volume} within 0.1%\n");
    }
    // A scan's volume takes half a minute. Its ball is larger by what the fit bends over its spacing.
    let within = if scans { "0.01" } else { "0.000001" };
    text += "let hits = raycast(shown, from: [-5, 0.2, 0], dir: [1, 0, 0])\n";
    text += &format!("expect count(hits) is {}\n", ends.len());
    for (i, x) in ends.iter().enumerate() {
        text += &format!("expect hits[{i}].t ~= {} within {within}\n", x + 5.0);
    }
    text
}

/// Walls and slits a hundred times as thick as what is cleaned up: a clean-up that takes more takes them all. The rays come from
/// about two away, where 16 eps S is 7e-15.
fn films() -> String {
    let view = "camera(eye: [3, -4, 2.5], look_at: [0, 0, 0], height: 4, kind: \"orthographic\")\n";
    format!(
        "{view}{LIGHT}\
let film = 0.000000000001
let block = box([-1, -1, -0.5], [0, 1, 0.5]).with(red)
let wall = block - box([-2, -2, -1], [-film, 2, 1])
let slit = block.move([1.5, 0, 0]) - box([1, -2, -1], [1 + film, 2, 1])
draw wall
draw slit
expect volume(wall) ~= 0.000000000002 within 5%
let hits = raycast(slit, from: [-2, 0, 0], dir: [1, 0, 0])
expect count(hits) is 4
expect (hits[2].t - hits[1].t) ~= 0.000000000001 within 0.1%
"
    )
}

/// All scenes.
pub fn scenes() -> Vec<Golden> {
    let mut all = vec![Golden::new("films", films())];
    for (name, expr, volume, ends) in operators() {
        all.push(Golden::new(name, scene(expr, false, volume, &ends)));
        if SCANNED.contains(&name) {
            all.push(Golden::new(format!("{name}-scans"), scene(expr, true, volume, &ends)));
        }
    }
    all
}
