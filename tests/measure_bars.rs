//! Bars of what is measured against closed forms: small features in large shapes, shapes far apart, thin walls, and random boxes
//! whose union is known from their coordinates.

use std::f64::consts::PI;

use glam::DVec3;
use measure_support::answers;
use pss::lang::{Geometry, Measured};
use pss::num::hash::Stream;

mod measure_support;

fn volume(shape: &str, level: usize) -> Measured {
    answers(shape, &[level], |m, asked| m.volume(asked).unwrap()).remove(0)
}

fn area(shape: &str, level: usize) -> Measured {
    answers(shape, &[level], |m, asked| m.area(asked).unwrap()).remove(0)
}

/// How many bars a value is from the truth; the bar is no wider than a share of the value.
fn bars(found: Measured, truth: f64, share: f64) -> f64 {
    assert!(found.err <= share * found.value.abs(), "{found:?} {truth}");
    (found.value - truth).abs() / found.err
}

const BALL: f64 = 4.0 / 3.0 * PI;

#[test]
fn small_features_and_far_shapes_are_not_missed() {
    let plate = |x: f64, y: f64, r: f64| {
        format!("box(size: [200, 100, 3]) - cylinder(r: {r}, from: [{x}, {y}, -5], to: [{x}, {y}, 5])")
    };
    for (x, y, r) in [(0.0, 0.0, 0.5), (33.0, 21.0, 0.5), (33.0, 21.0, 0.2), (-77.3, 11.9, 0.1)] {
        let hole = 3.0 * PI * r * r;
        // In the plate its hole is as well seen as if it were alone.
        let found = volume(&plate(x, y, r), 4);
        assert!((found.value - 60000.0 + hole).abs() <= found.err, "{found:?}");
        assert!(found.err < hole, "{found:?} {hole}");
        let around = 2.0 * (20000.0 + 600.0 + 300.0) - 2.0 * PI * r * r + 6.0 * PI * r;
        assert!(bars(area(&plate(x, y, r), 0), around, 1e-3) <= 1.0);
    }
    for (shape, balls, r) in [
        ("sphere(r: 1) | sphere(r: 1, at: [1000, 700, 300])", 2.0, 1.0_f64),
        ("union(for i in 0..8 { sphere(r: 0.05, at: [10 * i, 7 * i, 3 * i]) })", 8.0, 0.05),
        ("union(for i in 0..3, j in 0..3 { sphere(r: 1, at: [300 * i, 300 * j, 100 * i]) })", 9.0, 1.0),
        ("(box(size: 1000) | sphere(r: 1, at: [900, 900, 900])) - box(size: 1000)", 1.0, 1.0),
    ] {
        assert!(bars(volume(shape, 0), balls * BALL * r.powi(3), 1e-4) <= 1.0, "{shape}");
        assert!(bars(area(shape, 0), balls * 4.0 * PI * r * r, 1e-3) <= 1.0, "{shape}");
    }
}

#[test]
fn what_is_thin_is_measured_too() {
    // A tube across the diagonal of its box, a wall of a thousandth, a needle.
    let length = 300f64.sqrt();
    let tube = PI * 1e-4 * length + BALL * 1e-6;
    assert!(bars(volume("tube([[0, 0, 0], [10, 10, 10]], r: 0.01)", 0), tube, 6e-3) <= 1.0);
    let shell = BALL * (1.0 - 0.999f64.powi(3));
    assert!(bars(volume("sphere(r: 1) - sphere(r: 0.999)", 0), shell, 1e-3) <= 1.0);
    let needle = "cylinder(r: 0.001, from: [-1, -1, -1], to: [1, 1, 1])";
    assert!(bars(volume(needle, 0), PI * 1e-6 * 12f64.sqrt(), 1e-2) <= 1.0);
}

#[test]
fn nothing_is_nothing() {
    for shape in ["sphere(r: 1) - sphere(r: 1)", "sphere(r: 1) & sphere(r: 1, at: [3, 0, 0])", "union([])"] {
        let (v, a) = (volume(shape, 0), area(shape, 0));
        assert!(v.value == 0.0 && v.err < 1e-12 && a.value == 0.0 && a.err < 1e-12, "{v:?} {a:?}");
    }
}

/// Boxes with corners on a grid, joined, some taken away: volume and area by counting the grid's cells.
struct Blocks {
    text: String,
    volume: f64,
    area: f64,
}

fn blocks(seed: u64) -> Blocks {
    const N: usize = 12;
    let mut stream = Stream::new(seed);
    let mut filled = vec![false; N * N * N];
    let mut text = "union([])".to_owned();
    for i in 0..6 {
        let corner = |stream: &mut Stream| [0; 3].map(|_| (stream.unit() * 9.0) as usize + 1);
        let (lo, taken) = (corner(&mut stream), i % 3 == 2);
        let hi = lo.map(|x| (x + 1 + (stream.unit() * 4.0) as usize).min(N - 1));
        text = format!("({text} {} box({lo:?}, {hi:?}))", if taken { "-" } else { "|" });
        for (at, filled) in filled.iter_mut().enumerate() {
            let p = [at / N / N, at / N % N, at % N];
            if (0..3).all(|k| lo[k] <= p[k] && p[k] < hi[k]) {
                *filled = !taken;
            }
        }
    }
    let mut area = 0.0;
    for step in [N * N, N, 1] {
        area += (0..filled.len() - step).filter(|at| filled[*at] != filled[at + step]).count() as f64;
    }
    let axis = stream.direction().to_array();
    let text = format!("{text}.rotate(axis: {axis:?}, by: {}deg)", 360.0 * stream.unit());
    Blocks { text, volume: filled.iter().filter(|f| **f).count() as f64, area }
}

/// Bars of one in a thousand: of forty one miss has a chance of one in twenty-five, two of one in a thousand.
#[test]
fn the_truth_of_random_boxes_is_within_the_bars() {
    let mut missed = Vec::new();
    for seed in 0..12 {
        let Blocks { text, volume: v, area: a } = blocks(seed);
        for (found, truth) in [(volume(&text, 0), v), (volume(&text, 1), v), (area(&text, 0), a)] {
            if 1.0 < bars(found, truth, 2e-3) {
                missed.push((text.clone(), found, truth));
            }
        }
    }
    assert!(missed.len() <= 1, "{missed:?}");
}

/// Two balls that overlap: what both hold are two caps.
#[test]
fn the_truth_of_random_balls_is_within_the_bars() {
    let mut missed = Vec::new();
    for seed in 0..10 {
        let mut stream = Stream::new(1000 + seed);
        let (r, s) = (0.5 + stream.unit(), 0.5 + stream.unit());
        let d = (r - s).abs() + (r + s - (r - s).abs()) * (0.1 + 0.8 * stream.unit());
        let at = d * stream.direction();
        let cap = |r: f64, other: f64| {
            let h = r - (d * d + r * r - other * other) / (2.0 * d);
            PI * h * h * (3.0 * r - h) / 3.0
        };
        let both = cap(r, s) + cap(s, r);
        let at: [f64; 3] = at.to_array();
        for (op, truth) in
            [("|", BALL * (r.powi(3) + s.powi(3)) - both), ("&", both), ("-", BALL * r.powi(3) - both)]
        {
            let found = volume(&format!("sphere(r: {r}) {op} sphere(r: {s}, at: {at:?})"), 1);
            if 1.0 < bars(found, truth, 1e-4) {
                missed.push((op, r, s, found, truth));
            }
        }
    }
    assert!(missed.len() <= 1, "{missed:?}");
}

/// Balls and boxes against points thrown at random, which share nothing with lines.
#[test]
fn points_thrown_at_random_agree() {
    for seed in 0..4 {
        let mut stream = Stream::new(77 + seed);
        let mut point = |size: f64| size * DVec3::new(stream.unit(), stream.unit(), stream.unit());
        let balls: Vec<(DVec3, f64)> = (0..5).map(|_| (point(2.0), 0.2 + 0.6 * point(1.0).x)).collect();
        let cuts: Vec<(DVec3, DVec3)> = (0..2).map(|_| (point(1.0), point(1.0) + 1.0)).collect();
        let ball = |(c, r): &(DVec3, f64)| format!("sphere(r: {r}, at: {:?})", c.to_array());
        let cut = |(a, b): &(DVec3, DVec3)| format!("box({:?}, {:?})", a.to_array(), b.to_array());
        let [balls_text, cuts_text] =
            [balls.iter().map(ball).collect::<Vec<_>>(), cuts.iter().map(cut).collect::<Vec<_>>()];
        let text = format!("difference(union([{}]), [{}])", balls_text.join(", "), cuts_text.join(", "));
        let is_in = |p: DVec3| {
            balls.iter().any(|(c, r)| (p - c).length() < *r)
                && !cuts.iter().any(|(a, b)| a.cmplt(p).all() && p.cmplt(*b).all())
        };
        let count = 2_000_000;
        let hits = (0..count).filter(|_| is_in(point(4.0) - 1.0)).count() as f64;
        let share = hits / f64::from(count);
        let (thrown, sigma) = (64.0 * share, 64.0 * (share * (1.0 - share) / f64::from(count)).sqrt());
        let found = volume(&text, 0);
        assert!((found.value - thrown).abs() <= found.err + 4.0 * sigma, "{text} {found:?} {thrown} {sigma}");
    }
}

#[test]
fn boxes_of_what_is_cut_are_those_it_reaches() {
    let bounds = |shape: &str| answers(shape, &[0], |m, asked| m.bounds(asked).unwrap()).remove(0);
    let s = 0.75f64.sqrt();
    for (shape, min, max) in [
        ("sphere(r: 1) - box([0, -5, -5], [5, 5, 5])", [-1.0, -1.0, -1.0], [0.0, 1.0, 1.0]),
        ("implicit(x**2 + y**2 + z**2 <= 1, inside: box(size: 3))", [-1.0; 3], [1.0; 3]),
        ("sphere(r: 1) & sphere(r: 1, at: [1, 0, 0])", [0.0, -s, -s], [1.0, s, s]),
        // Half a cube on its corner: edges and corners that no axis runs along.
        (
            "box(size: 2).rotate_z(45deg) - half_space(x < 0.5)",
            [0.5, 0.5 - 2f64.sqrt(), -1.0],
            [2f64.sqrt(), 2f64.sqrt() - 0.5, 1.0],
        ),
    ] {
        let found = bounds(shape);
        let off = [(found.bounds.min, min), (found.bounds.max, max)];
        let off = off.map(|(a, b)| (a - DVec3::from_array(b)).abs().max_element());
        assert!(found.err < 1e-6 && off[0] <= found.err && off[1] <= found.err, "{shape} {found:?}");
    }
    assert_eq!(bounds("sphere(r: 1) | box([1, 2, 3], [2, 4, 7])").err, 0.0);
    assert!(bounds("box(size: 1) - box(size: 2)").bounds.is_empty());
}
