//! Implicit solids against closed forms and against dense sampling of the same set in another formulation.

mod csg_support;

use std::sync::Arc;

use csg_support::scene::{shot, spans};
use glam::DVec3;
use pss::csg::Scratch as Room;
use pss::geom::{Aabb, Interval, Ray};
use pss::num::hash::Stream;
use pss::scene::{Catalog, Formula, Value};
use pss::solid::implicit::Implicit;
use pss::solid::{Crossing, Scratch, Solid};
use pss::source::SourceMap;

/// No crossings.
const NOTHING: [f64; 0] = [];

/// The formula of a condition as the language reads it.
fn formula(condition: &str) -> Arc<Formula> {
    let mut sources = SourceMap::default();
    let text = format!("draw implicit({condition}, inside: box(size: 1))");
    let file = sources.add("test.pss", None, text.as_str());
    let catalog: Catalog = pss::prepare::catalog();
    let read = pss::lang::read(&mut sources, file, &catalog, &[]);
    let (scene, _) = read.unwrap_or_else(|e| panic!("{text}\n{e:?}"));
    match &scene.draws[0].shape.0.kind {
        pss::scene::ShapeKind::Leaf { call, .. } => match call.get("where") {
            Some(Value::Formula(formula)) => formula.clone(),
            other => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    }
}

/// The solid of a condition in a cube about the origin.
fn solid(condition: &str, half: f64) -> Implicit {
    Implicit::new(formula(condition), Aabb { min: DVec3::splat(-half), max: DVec3::splat(half) })
}

/// All crossings of a line, asked for until the answers reach its end.
fn crossings(solid: &dyn Solid, ray: &Ray) -> Vec<Crossing> {
    let mut scratch = Scratch::default();
    let mut out: Vec<Crossing> = Vec::new();
    let mut lo = f64::NEG_INFINITY;
    while lo < f64::INFINITY {
        let known = out.len();
        let answer = solid.crossings(ray, Interval::new(lo, f64::INFINITY), &mut scratch, &mut out);
        assert!(lo < answer.range.hi && answer.inside == (known % 2 == 1), "{ray:?} from {lo}: {answer:?}");
        lo = answer.range.hi;
    }
    for (i, c) in out.iter().enumerate() {
        assert!(c.t.is_finite() && c.entering == (i % 2 == 0), "{ray:?} {out:?}");
        assert!(i == 0 || out[i - 1].t < c.t, "{ray:?} {out:?}");
    }
    assert!(out.len().is_multiple_of(2), "{ray:?} {out:?}");
    out
}

fn ts(solid: &dyn Solid, ray: &Ray) -> Vec<f64> {
    crossings(solid, ray).iter().map(|c| c.t).collect()
}

fn along_x(y: f64, z: f64) -> Ray {
    Ray::new(DVec3::new(-5.0, y, z), DVec3::X)
}

/// Random chords of the ball around the cube of a solid, compared with the membership that a closure says, at `steps` places
/// each.
fn matches_sampling(solid: &Implicit, half: f64, rays: u64, steps: u32, inside: impl Fn(DVec3) -> bool) {
    // By so much of a chord the cube that is traced may be larger than the one asked for.
    const MARGIN: f64 = 1e-5;
    let mut seen = 0;
    for i in 0..rays {
        let ray = Ray::chord(&mut Stream::new(i ^ 0x1a91), DVec3::ZERO, half * 3f64.sqrt());
        let found = ts(solid, &ray);
        let mut brackets = Vec::new();
        let mut before = false;
        for k in 0..=steps {
            let t = f64::from(k) / f64::from(steps);
            let p = ray.at(t);
            let now = p.abs().max_element() <= half && inside(p);
            if now != before {
                brackets.push((t - 1.0 / f64::from(steps) - MARGIN, t + MARGIN));
            }
            before = now;
        }
        // Sampling may miss a pair nearer than a step, never find what is not there.
        let mut rest = found.iter();
        for (lo, hi) in &brackets {
            assert!(rest.any(|t| lo <= t && t <= hi), "ray {i}: no crossing in {lo}..{hi} among {found:?}");
        }
        assert!((found.len() - brackets.len()).is_multiple_of(2), "ray {i}");
        seen += found.len();
    }
    assert!(seen > rays as usize / 10, "too few crossings to tell: {seen}");
}

#[test]
fn a_sphere_has_the_crossings_of_the_closed_form() {
    let made = solid("x**2 + y**2 + z**2 <= 1", 1.25);
    let truth = pss::solid::sphere::Sphere { center: DVec3::ZERO, radii: DVec3::ONE };
    for i in 0..4000 {
        let ray = Ray::chord(&mut Stream::new(i), DVec3::ZERO, 2.0);
        let (found, known) = (crossings(&made, &ray), crossings(&truth, &ray));
        assert_eq!(found.len(), known.len(), "{ray:?}");
        for (a, b) in found.iter().zip(&known) {
            let (p, q) = (ray.at(a.t), ray.at(b.t));
            let n = made.normal(&ray, a, &mut Scratch::default());
            // Along the normal, as a grazing ray moves a crossing along itself.
            assert!((p - q).dot(q).abs() <= 4e-15 && (n - q).length() <= 1e-14 + (p - q).length(), "{ray:?}");
            assert!((a.t - b.t).abs() <= a.err + 4e-15 / ray.dir.dot(q).abs(), "{ray:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn a_torus_by_its_quartic_is_the_torus_by_its_distance() {
    let made = solid("(x**2 + y**2 + z**2 + 1 - 0.0625)**2 - 4*(x**2 + y**2) <= 0", 1.5);
    let inside = |p: DVec3| (p.truncate().length() - 1.0).hypot(p.z) <= 0.25;
    matches_sampling(&made, 1.5, 300, 4000, inside);
}

#[test]
fn a_capped_cylinder_is_a_maximum() {
    let made = solid("max(sqrt(x**2 + y**2) - 0.7, abs(z) - 0.5) <= 0", 1.0);
    matches_sampling(&made, 1.0, 300, 4000, |p| p.x * p.x + p.y * p.y <= 0.49 && p.z.abs() <= 0.5);
}

#[test]
fn a_gyroid_has_every_sheet() {
    let made = solid(
        "sin(x * 1rad)*cos(y * 1rad) + sin(y * 1rad)*cos(z * 1rad) + sin(z * 1rad)*cos(x * 1rad) <= 0.3",
        12.0,
    );
    let inside = |p: DVec3| {
        let (s, c) = (p.map(f64::sin), p.map(f64::cos));
        s.x * c.y + s.y * c.z + s.z * c.x <= 0.3
    };
    matches_sampling(&made, 12.0, 100, 100_000, inside);
}

#[test]
fn functions_and_domains_agree_with_dense_sampling() {
    type Inside = fn(DVec3) -> bool;
    let cases: &[(&str, Inside)] = &[
        ("exp(x) + y <= 1", |p| p.x.exp() + p.y <= 1.0),
        ("ln(x + 1) < y", |p| (p.x + 1.0).ln() < p.y),
        ("sqrt(x) - z <= 0.2", |p| p.x.sqrt() - p.z <= 0.2),
        ("1 / x <= y", |p| 1.0 / p.x - p.y <= 0.0),
        ("asin(x) + acos(y) <= 90deg", |p| p.x.asin() + p.y.acos() <= std::f64::consts::FRAC_PI_2),
        ("atan2(y, x) >= 60deg", |p| p.y.atan2(p.x) >= std::f64::consts::FRAC_PI_3),
        ("tan(3 * x * 1rad) <= y", |p| (3.0 * p.x).tan() <= p.y),
        ("abs(x)**1.5 + abs(y)**0.7 <= 0.8", |p| p.x.abs().powf(1.5) + p.y.abs().powf(0.7) <= 0.8),
        ("(x + 1.5)**y <= 1.2", |p| (p.x + 1.5).powf(p.y) <= 1.2),
        ("x**-2 >= 4 + z", |p| 1.0 / (p.x * p.x) >= 4.0 + p.z),
        ("clamp(x, -0.5, 0.5) + mix(y, z, 0.25) <= 0", |p| {
            p.x.clamp(-0.5, 0.5) + 0.75 * p.y + 0.25 * p.z <= 0.0
        }),
        ("length([x, y, z] - [0.1, 0.2, 0.3]) <= 1.5", |p| (p - DVec3::new(0.1, 0.2, 0.3)).length() <= 1.5),
        ("min(dot([x, y], [x, y]), z) - x <= -0.1", |p| (p.x * p.x + p.y * p.y).min(p.z) - p.x <= -0.1),
    ];
    for (condition, inside) in cases {
        matches_sampling(&solid(condition, 2.0), 2.0, 40, 5000, *inside);
    }
}

#[test]
fn what_jumps_agrees_with_dense_sampling() {
    type Inside = fn(DVec3) -> bool;
    let cases: &[(&str, Inside)] = &[
        ("floor(x) <= 0", |p| p.x < 1.0),
        ("ceil(y) < 1", |p| p.y <= 0.0),
        ("round(2 * x) / 2 + y <= 0.1", |p| (2.0 * p.x).round() / 2.0 + p.y <= 0.1),
        ("(floor(x) + floor(y) + floor(z)) % 2 < 1", |p| {
            (p.x.floor() + p.y.floor() + p.z.floor()).rem_euclid(2.0) < 1.0
        }),
        ("x % 0.7 <= 0.3", |p| p.x.rem_euclid(0.7) <= 0.3),
        ("x % -0.7 <= -0.3", |p| -(-p.x).rem_euclid(0.7) <= -0.3),
        ("(x * 1rad) % 1rad <= 20deg", |p| p.x.rem_euclid(1.0) <= 20f64.to_radians()),
        ("length([x, y, z] % 1 - [0.5, 0.5, 0.5]) <= 0.4", |p| {
            (p - p.floor() - DVec3::splat(0.5)).length() <= 0.4
        }),
        ("z <= round(4 * (1 - (x**2 + y**2) / 8)) / 4", |p| {
            p.z <= (4.0 * (1.0 - (p.x * p.x + p.y * p.y) / 8.0)).round() / 4.0
        }),
        ("floor(3 * sin(2 * x * 1rad)) + y <= -0.5", |p| (3.0 * (2.0 * p.x).sin()).floor() + p.y <= -0.5),
        ("floor(1 / x) <= y", |p| (1.0 / p.x).floor() <= p.y),
        ("atan2(y, x) <= 100deg", |p| p.y.atan2(p.x) <= 100f64.to_radians()),
    ];
    for (condition, inside) in cases {
        println!("{condition}");
        matches_sampling(&solid(condition, 2.0), 2.0, 100, 5000, *inside);
    }
}

#[test]
fn vectors_of_a_formula_are_multiplied_normalized_and_indexed() {
    let axis = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    let cylinder = solid("length(cross([x, y, z], [1/3, 2/3, 2/3])) <= 0.5", 2.0);
    matches_sampling(&cylinder, 2.0, 300, 5000, |p| p.cross(axis).length() <= 0.5);
    let cone = solid("dot(normalize([x, y, z]), [1/3, 2/3, 2/3]) >= 0.6", 2.0);
    matches_sampling(&cone, 2.0, 200, 5000, |p| p.normalize().dot(axis) >= 0.6);
    let third = solid("cross([x, y, z], [0, 0, 1])[1] + [x, y][0] * 3 <= 0.2", 2.0);
    matches_sampling(&third, 2.0, 300, 5000, |p| 2.0 * p.x <= 0.2);
}

#[test]
fn jumps_are_found_to_the_last_place_where_they_are_and_cost_few_looks() {
    let stairs = solid("floor(3 * x) % 2 <= 0.5", 2.0);
    let ray = Ray::new(DVec3::new(-5.0, 0.1, 0.2), DVec3::X);
    let found = crossings(&stairs, &ray);
    // Inside where floor(3 x) is even: [-2/3 k, -2/3 k + 1/3).
    let expected = (-6..=6).map(|k| f64::from(k) / 3.0).filter(|x| -2.0 < *x && *x < 2.0);
    let inner = found.iter().filter(|c| c.t > 3.0 + 1e-5 && c.t < 7.0 - 1e-5).collect::<Vec<_>>();
    assert_eq!(inner.len(), 11);
    for (c, x) in inner.iter().zip(expected) {
        assert!((c.t - 5.0 - x).abs() <= c.err + 16.0 * f64::EPSILON * 5.0, "{c:?} {x}");
        assert!(c.err < 1e-14, "{c:?}");
    }
    // Halving alone would stop at its limit of looks here and leave the rest in doubt.
    let fine = solid("floor(200 * x) % 2 <= 0.5", 2.0);
    // The cube that is traced is a little larger: one more span from 2 on.
    assert_eq!(crossings(&fine, &ray).len(), 802);
}

#[test]
fn the_normal_at_a_jump_is_that_of_what_jumps() {
    for (condition, normal) in [
        ("floor(x + 2 * y) <= 0", DVec3::new(1.0, 2.0, 0.0).normalize()),
        ("floor(x + 2 * y) + z / 1000 <= 0.5", DVec3::new(1.0, 2.0, 0.0).normalize()),
        ("ceil(x / 3) * (1 + y**2) <= 0.5", DVec3::X),
    ] {
        let (made, ray) = (solid(condition, 2.0), along_x(0.125, 0.25));
        let found = crossings(&made, &ray);
        let last = found.iter().rfind(|c| !c.entering).unwrap();
        let n = made.normal(&ray, last, &mut Scratch::default());
        assert!((n - normal).length() < 1e-9, "{condition}: {n}");
    }
}

#[test]
fn a_tangent_gives_no_span_and_is_counted() {
    let sphere = solid("x**2 + y**2 + z**2 <= 1", 1.25);
    let mut scratch = Scratch::default();
    for (y, z) in [(1.0, 0.0), (0.0, -1.0), (0.6, 0.8)] {
        let out = crossings(&sphere, &along_x(y, z));
        sphere.crossings(&along_x(y, z), Interval::ALL, &mut scratch, &mut Vec::new());
        let thin = out.chunks(2).all(|c| (c[1].t - c[0].t) < 1e-7);
        assert!(thin && out.len().is_multiple_of(2), "{y} {z} {out:?}");
    }
    assert_eq!(ts(&sphere, &along_x(1.0, 0.0)), NOTHING);
    assert!(0 < scratch.counts.certificate_failures);
    // C5 to C8: a torus met along its top, its inner rim, twice at once, and its outer rim.
    let torus = solid("(sqrt(x**2 + y**2) - 1)**2 + z**2 <= 0.0625", 1.5);
    assert_eq!(ts(&torus, &along_x(0.0, 0.25)), NOTHING);
    assert_eq!(ts(&torus, &along_x(1.25, 0.0)), NOTHING);
    let inner = ts(&torus, &along_x(0.75, 0.0));
    assert!(
        inner.len() == 2 && (inner[0] - 4.0).abs() < 1e-14 && (inner[1] - 6.0).abs() < 1e-14,
        "{inner:?}"
    );
}

#[test]
fn near_tangents_have_both_crossings() {
    let sphere = solid("x**2 + y**2 + z**2 <= 1", 1.25);
    for j in 1..45 {
        let b = 1.0 - 0.5f64.powi(j);
        let half = ((1.0 - b) * (1.0 + b)).sqrt();
        let found = crossings(&sphere, &along_x(b, 0.0));
        assert_eq!(found.len(), 2, "2^-{j}");
        let off = (found[0].t - (5.0 - half)).abs();
        // The surface is where it should be to rounding; along the ray that is divided by the slope.
        assert!(off <= 8.0 * f64::EPSILON / half + 4e-15 && off <= found[0].err + 4e-15, "2^-{j} {off:e}");
    }
}

#[test]
fn every_tiny_feature_in_a_large_box_is_found() {
    let dot = solid("(x - 0.3)**2 + (y + 0.2)**2 + (z - 0.1)**2 <= 1e-12", 0.5);
    let center = DVec3::new(0.3, -0.2, 0.1);
    for i in 0..500 {
        let mut stream = Stream::new(i);
        let (d, off) = (stream.direction(), stream.direction() * 0.9e-6 * stream.unit());
        let ray = Ray::new(center + off - 3.0 * d, d);
        let found = ts(&dot, &ray);
        let miss = off.reject_from(d).length();
        let half = (1e-12 - miss * miss).sqrt();
        assert_eq!(found.len(), 2, "{i}");
        assert!((found[1] - found[0] - 2.0 * half).abs() < 1e-14 + 1e-21 / half, "{i} {found:?} {half}");
    }
    // A thin shell: four crossings 1e-9 apart in pairs.
    let shell = solid("abs(sqrt(x**2 + y**2 + z**2) - 0.25) <= 5e-10", 0.5);
    let found = ts(&shell, &along_x(0.0, 0.0));
    let known = [-0.25 - 5e-10, -0.25 + 5e-10, 0.25 - 5e-10, 0.25 + 5e-10];
    assert!(
        found.len() == 4 && found.iter().zip(known).all(|(t, k)| (t - 5.0 - k).abs() < 2e-15),
        "{found:?}"
    );
}

#[test]
fn c9_far_origins_keep_both_crossings_of_a_torus() {
    let torus = solid("(sqrt(x**2 + y**2) - 1)**2 + z**2 <= 0.0625", 1.5);
    for exponent in 0..=7 {
        let far = 10f64.powi(exponent);
        for i in 0..200 {
            let mut stream = Stream::new(i * 8 + exponent as u64);
            let on = |stream: &mut Stream| {
                let (u, v) = (stream.unit() * std::f64::consts::TAU, stream.unit() * std::f64::consts::TAU);
                let r = 1.0 + 0.25 * v.cos();
                (
                    DVec3::new(r * u.cos(), r * u.sin(), 0.25 * v.sin()),
                    DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin()),
                )
            };
            let ((p, n), (q, _)) = (on(&mut stream), on(&mut stream));
            let d = (q - p).normalize();
            let slope = d.dot(n).abs();
            if slope < 0.1 || p.distance(q) < 0.1 {
                continue;
            }
            let ray = Ray::new(p - far * d, d);
            let near = ts(&torus, &ray).into_iter().map(|t| (t - far).abs()).fold(f64::INFINITY, f64::min);
            assert!(near <= 1e-14 + 4.0 * f64::EPSILON * far / slope, "{far:e} {i} {near:e}");
        }
    }
}

#[test]
fn c13_a_cone_has_one_nappe_under_its_apex() {
    let cone = solid("max(sqrt(x**2 + y**2) + z - 1, -z) <= 0", 2.0);
    let down = Ray::new(DVec3::new(0.0, 0.0, 5.0), -DVec3::Z);
    assert_eq!(ts(&cone, &down), [4.0, 5.0]);
    assert_eq!(ts(&cone, &along_x(0.0, 1.0)), NOTHING);
    assert_eq!(ts(&cone, &along_x(0.0, 1.5)), NOTHING);
    let near = ts(&cone, &along_x(0.0, 1.0 - 1e-9));
    assert!(near.len() == 2 && (near[1] - near[0] - 2e-9).abs() < 1e-15, "{near:?}");
}

#[test]
fn c21_what_holds_nowhere_is_nothing_and_what_holds_everywhere_is_the_box() {
    let none: &[&str] = &[
        "x**2 <= -1",
        "sqrt(-1 - x**2) <= 0",
        "ln(-abs(x) - 1) <= 0",
        "x**2 < 0",
        "exp(exp(x + 10)) <= 1",
        "x**2 + y**2 + z**2 <= 1e-310",
    ];
    for condition in none {
        let made = solid(condition, 1.0);
        for i in 0..50 {
            let ray = Ray::chord(&mut Stream::new(i), DVec3::ZERO, 2.0);
            assert_eq!(ts(&made, &ray), NOTHING, "{condition}");
        }
    }
    for condition in ["x**2 >= -1", "abs(x) >= 0", "max(0, x - 3) <= 0", "x - x <= 0"] {
        let made = solid(condition, 1.0);
        let found = ts(&made, &along_x(0.1, 0.2));
        assert!(
            found.len() == 2 && (found[0] - 4.0).abs() < 1e-5 && (found[1] - 6.0).abs() < 1e-5,
            "{condition}"
        );
    }
    assert_eq!(ts(&Implicit::new(formula("x <= 0"), Aabb::EMPTY), &along_x(0.0, 0.0)), NOTHING);
}

#[test]
fn a_plateau_at_zero_belongs_to_the_solid_iff_the_condition_says_so() {
    let (with, without) = (solid("max(0, x) <= 0", 1.0), solid("max(0, x) < 0", 1.0));
    let found = ts(&with, &along_x(0.1, 0.2));
    assert!(found.len() == 2 && found[1] == 5.0, "{found:?}");
    assert_eq!(ts(&without, &along_x(0.1, 0.2)), NOTHING);
}

#[test]
fn a_formula_that_is_zero_up_to_rounding_ends_and_is_counted() {
    let made = solid("sin(x * 1rad)**2 + cos(x * 1rad)**2 <= 1", 1.0);
    let mut scratch = Scratch::default();
    crossings(&made, &along_x(0.1, 0.2));
    made.crossings(&along_x(0.1, 0.2), Interval::ALL, &mut scratch, &mut Vec::new());
    assert!(0 < scratch.counts.certificate_failures);
}

#[test]
fn normals_point_out_at_kinks_poles_and_ends_of_the_domain() {
    // A pole's face stands across the axis along which the formula has it, however the ray comes.
    let pole = solid("1 / x <= y", 2.0);
    for dir in [DVec3::new(1.0, 0.1, 0.05), DVec3::new(1.0, -0.3, 0.2), DVec3::new(3.0, 0.03, 0.01)] {
        let ray = Ray::new(DVec3::new(-1.0, 0.5, 0.3), dir);
        let at_pole = crossings(&pole, &ray).into_iter().find(|c| ray.at(c.t).x.abs() < 1e-9).unwrap();
        let n = pole.normal(&ray, &at_pole, &mut Scratch::default());
        assert!((n - DVec3::X).length() < 1e-9, "{n}");
    }
    for condition in ["abs(x) <= 0.5", "sqrt(x + 0.5) <= 1", "1 / x <= 1", "sqrt(x**2 + y**2 + z**2) <= 0.5"]
    {
        let made = solid(condition, 2.0);
        for ray in [along_x(0.0, 0.0), Ray::new(DVec3::new(5.0, 0.0, 0.0), DVec3::new(-2.0, 0.0, 0.0))] {
            for c in crossings(&made, &ray) {
                let n = made.normal(&ray, &c, &mut Scratch::default());
                let out = if c.entering { -1.0 } else { 1.0 };
                assert!((n - out * ray.dir.normalize()).length() < 1e-14, "{condition} {c:?} {n}");
            }
        }
    }
}

#[test]
fn the_range_asked_and_the_length_of_the_direction_change_nothing() {
    let made = solid("sin(5 * x * 1rad) + y**2 <= z", 1.0);
    for i in 0..200 {
        let ray = Ray::chord(&mut Stream::new(i), DVec3::ZERO, 1.5);
        let all = crossings(&made, &ray);
        for k in 0..20 {
            // From everywhere, from crossings themselves too.
            let at = 0.05 * f64::from(k);
            let from = all.get(k as usize % 7).filter(|_| k % 2 == 1).map_or(at, |c| c.t);
            let mut part = Vec::new();
            let to = from.max(0.7);
            let answer = made.crossings(&ray, Interval::new(from, to), &mut Scratch::default(), &mut part);
            let before = all.iter().rfind(|c| c.t <= from);
            assert_eq!(answer.inside, before.is_some_and(|c| c.entering), "{i} from {from}");
            let told = all.iter().filter(|c| from < c.t && c.t <= answer.range.hi).copied();
            assert_eq!(part, told.collect::<Vec<_>>(), "{i} from {from}");
            let reached = to <= answer.range.hi || !part.is_empty();
            assert!(reached, "{i} from {from}: {answer:?}");
        }
        let long = Ray::new(ray.origin, ray.dir * 4.0);
        let quarter: Vec<f64> = ts(&made, &long).into_iter().map(|t| 4.0 * t).collect();
        assert_eq!(all.iter().map(|c| c.t).collect::<Vec<_>>(), quarter);
    }
}

#[test]
fn any_bounded_solid_bounds_a_formula() {
    let twins = [
        ("sphere(r: 1)", 1.0),
        ("cylinder(r: 0.8, h: 1).rotate_x(30deg)", 1.0),
        ("(sphere(r: 1) - sphere(r: 0.5))", 1.0),
    ];
    for (bound, radius) in twins {
        let made = shot(&format!("draw implicit(x + y**2 <= 0.2, inside: {bound}).move([0.3, 0, 0])"));
        let base = shot(&format!("draw {bound}.move([0.3, 0, 0])"));
        let mut scratch = Room::default();
        for i in 0..300 {
            let ray = Ray::chord(&mut Stream::new(i), DVec3::new(0.3, 0.0, 0.0), 1.3 * radius);
            let (cut, whole) = (spans(&made, &ray, &mut scratch), spans(&base, &ray, &mut scratch));
            for k in 0..500 {
                let t = (f64::from(k) + 0.5) / 500.0;
                let p = ray.at(t);
                let holds = p.x - 0.3 + p.y * p.y <= 0.2;
                let within = |list: &[pss::csg::Span]| list.iter().any(|s| s.interval().contains(t));
                assert_eq!(within(&cut), within(&whole) && holds, "{bound} ray {i} at {t}");
            }
        }
    }
}

#[test]
fn a_formula_twice_is_cleaned_away() {
    let text = "let g = implicit(x*y + y*z + sin(3 * z * 1rad) <= 0.1, inside: sphere(r: 1))
draw g.rotate_z(30deg).move([3, 0, 0]) - g.move([0, 0, 0]).rotate_z(30deg).move([3, 0, 0])";
    let made = shot(text);
    let mut scratch = Room::default();
    for i in 0..2000 {
        let ray = Ray::chord(&mut Stream::new(i), DVec3::new(3.0, 0.0, 0.0), 1.0);
        let found = spans(&made, &ray, &mut scratch);
        assert!(found.is_empty(), "ray {i}: {found:?}");
    }
}
