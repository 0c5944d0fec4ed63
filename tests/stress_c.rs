//! Section C of the stress list: grazing rays, origins in awkward places, and each primitive's own hard cases.

mod csg_support;
mod solid_support;

use std::sync::Arc;
use std::time::Instant;

use csg_support::scene::{errors, prepared, shot, spans};
use glam::{DVec3, dvec3};
use pss::csg::{Expr, Leaf, Object, Scratch as CsgScratch};
use pss::geom::{Interval, Placement, Ray};
use pss::num::hash::Stream;
use pss::solid::half_space::HalfSpace;
use pss::solid::torus::Torus;
use solid_support::{EPS, cube, line, normal, solid, subjects, ts};

fn ray(o: [f64; 3], d: [f64; 3]) -> Ray {
    Ray::new(DVec3::from_array(o), DVec3::from_array(d))
}

fn near(have: &[f64], want: &[f64], tolerance: f64) {
    let close = have.iter().zip(want).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(have.len() == want.len() && close, "{have:?} {want:?}");
}

#[test]
fn c1_a_chord_near_the_rim_of_a_sphere_lies_on_it() {
    for r in [1.0, 1e-6, 1e6] {
        let ball = solid(&format!("sphere(r: {r:?})"));
        for (j, side) in (1..=52).flat_map(|j| [(j, -1.0), (j, 1.0)]) {
            let b = r * (1.0 + side * 2f64.powi(-j));
            for far in [0.0, 3.0, 100.0] {
                let (o, d) = (dvec3(-far * r, b, 0.0), DVec3::X);
                let turn = glam::DQuat::from_axis_angle(dvec3(0.6, 0.0, 0.8), 0.3 * f64::from(j));
                for turn in [glam::DQuat::IDENTITY, turn] {
                    let ray = Ray::new(turn * o, r * (turn * d));
                    let t = ts(&*ball, &ray);
                    let scale = r * far.max(1.0);
                    assert!(t.len().is_multiple_of(2));
                    for t in &t {
                        let off = (ray.at(*t).length() - r).abs();
                        assert!(off <= 16.0 * EPS * scale, "{r} {j} {off:e}");
                    }
                    if turn == glam::DQuat::IDENTITY {
                        assert_eq!(t.is_empty(), side == 1.0, "{r} {j}");
                        let want = 2.0 * ((r - b) * (r + b)).sqrt() / r;
                        let error = t.windows(2).map(|w| (w[1] - w[0] - want).abs()).fold(0.0, f64::max);
                        assert!(error <= 16.0 * EPS * far.max(1.0), "{r} {j} {error:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn c2_a_far_sphere_is_met_to_four_ulp_of_the_distance() {
    let ball = solid("sphere(r: 1)");
    let mut worst: f64 = 0.0;
    let mut stream = Stream::new(1);
    for j in 1..=7 {
        let far = 10f64.powi(j);
        for _ in 0..10_000 {
            let b = stream.unit();
            let t = ts(&*ball, &ray([-far, b, 0.0], [1.0, 0.0, 0.0]));
            let half = ((1.0 - b) * (1.0 + b)).sqrt();
            let ulp = far.next_up() - far;
            for (t, want) in t.iter().zip([far - half, far + half]) {
                worst = worst.max((t - want).abs() * half / ulp);
            }
            assert_eq!(t.len(), 2);
        }
    }
    println!("c2: {worst:.2} ulp(D) / cos");
    assert!(worst <= 4.0, "{worst}");
}

#[test]
fn c3_the_earth_half_a_metre_above_the_ground() {
    let r = 6.371e6;
    let earth = solid("sphere(r: 6371000)");
    let nadir = ts(&*earth, &ray([0.0, 0.0, r + 0.5], [0.0, 0.0, -1.0]));
    assert!((nadir[0] - 0.5).abs() <= 1e-15, "{nadir:?}");
    // |eye + t d| = r by the stable root: t = c / (-b + sqrt(b^2 - c)) with c = 0.5 (2 r + 0.5) and b = -(r + 0.5) cos.
    let mut worst: f64 = 0.0;
    for degrees in 0..=81 {
        let a = f64::from(degrees).to_radians();
        let d = dvec3(a.sin(), 0.0, -a.cos());
        let eye = r + 0.5;
        let c = 0.5 * (2.0 * r + 0.5) / d.length_squared();
        let half = -eye * d.z / d.length_squared();
        let want = c / (half + (half * half - c).sqrt());
        let t = ts(&*earth, &Ray::new(dvec3(0.0, 0.0, eye), d));
        worst = worst.max((t[0] - want).abs());
    }
    println!("c3: {worst:.2e}");
    assert!(worst <= 2.0 * (r.next_up() - r), "{worst:e}");
}

#[test]
fn c4_c5_c6_c7_c8_lines_that_touch_a_torus() {
    let ring = solid("torus(major: 1, minor: 0.25)");
    let x = [1.0, 0.0, 0.0];
    near(&ts(&*ring, &ray([-3.0, 0.0, 0.0], x)), &[1.75, 2.25, 3.75, 4.25], 1e-13);
    near(&ts(&*ring, &ray([0.0, 0.0, 0.0], x)), &[-1.25, -0.75, 0.75, 1.25], 1e-13);
    for from in [0.0, -7.5, 3.0] {
        assert!(ts(&*ring, &ray([from, 0.0, 0.25], x)).is_empty());
        assert!(ts(&*ring, &ray([from, 1.25, 0.0], x)).is_empty());
        near(&ts(&*ring, &ray([from, 0.75, 0.0], x)), &[-1.0 - from, 1.0 - from], 1e-13);
    }
    // Through the centre at sin = r / R: touches above and below.
    for (sin, length) in [(0.25f64, 1.0), (0.25, 1e-3)] {
        let d = length * dvec3((1.0 - sin * sin).sqrt(), 0.0, sin);
        for turn in 0..100 {
            let turn = glam::DQuat::from_rotation_z(0.1 * f64::from(turn));
            let t = ts(&*ring, &Ray::new(DVec3::ZERO, turn * d));
            let (pairs, odd) = t.as_chunks::<2>();
            assert!(odd.is_empty() && pairs.iter().all(|[a, b]| (b - a) * length <= 1e-7), "{t:?}");
        }
    }
}

/// Both roots of chords through two known points of the surface, from far away.
#[test]
fn c9_far_tori_keep_their_digits_and_their_parity() {
    let ring = Torus { center: DVec3::ZERO, major: 1.0, minor: 0.25 };
    let mut stream = Stream::new(9);
    let point = |stream: &mut Stream| {
        let (u, v) = (std::f64::consts::TAU * stream.unit(), std::f64::consts::TAU * stream.unit());
        let rho = 1.0 + 0.25 * v.cos();
        dvec3(rho * u.cos(), rho * u.sin(), 0.25 * v.sin())
    };
    for (j, limit) in [(0, 1e-8), (1, 1e-8), (2, 1e-8), (3, 1e-8), (4, 1e-6), (5, 1e-6)] {
        let far = 10f64.powi(j);
        let (mut worst, mut along, mut count): (f64, f64, u32) = (0.0, 0.0, 0);
        for _ in 0..50_000 {
            let (a, b) = (point(&mut stream), point(&mut stream));
            let apart = a.distance(b);
            let d = (b - a) / apart;
            let ray = Ray::new(a - far * d, d);
            let (found, inside) = line(&ring, &ray);
            assert!(found.len().is_multiple_of(2) && !inside, "odd {ray:?}");
            for want in [far, far + apart] {
                let error = |t: f64| (t - want).abs();
                let best = found.iter().min_by(|x, y| error(x.t).total_cmp(&error(y.t)));
                let n = |at: DVec3| {
                    let rho = at.truncate().length();
                    dvec3(at.x * (1.0 - 1.0 / rho), at.y * (1.0 - 1.0 / rho), at.z) / 0.25
                };
                let cos = n(if want == far { a } else { b }).dot(d).abs();
                // A point rounded to 1 ulp of the distance moves the root of a chord that grazes there without bound.
                if cos < 1e-3 {
                    continue;
                }
                let best = best.unwrap_or_else(|| panic!("lost {ray:?}"));
                (worst, along) = (worst.max(error(best.t)), along.max(error(best.t) * cos));
                count += 1;
            }
        }
        println!("c9: D = {far:e}: worst {worst:.2e}, along the normal {along:.2e}, of {count}");
        assert!(worst <= limit && along <= 16.0 * EPS * far.max(1.25), "{far} {worst:e} {along:e}");
    }
}

/// A million rays at tori of all proportions from all distances: none has an odd number of roots.
#[test]
fn c9_no_ray_meets_a_torus_an_odd_number_of_times() {
    let rays = 1_000_000;
    let mut stream = Stream::new(10);
    let began = Instant::now();
    let mut hits = 0;
    for _ in 0..rays {
        let minor = 10f64.powf(-2.0 * stream.unit()) * if stream.unit() < 0.2 { 2.0 } else { 1.0 };
        let ring = Torus { center: DVec3::ZERO, major: 1.0, minor };
        let at = (1.0 + minor) * cube(&mut stream) * dvec3(1.0, 1.0, minor);
        let d = stream.direction();
        let ray = Ray::new(at - 10f64.powf(5.0 * stream.unit()) * d, d);
        let (found, inside) = line(&ring, &ray);
        let alternate = found.iter().enumerate().all(|(i, c)| c.entering == i.is_multiple_of(2));
        assert!(
            found.len().is_multiple_of(2) && found.len() <= 4 && !inside && alternate,
            "{minor} {ray:?} {found:?}"
        );
        hits += found.len();
    }
    println!("c9: {:.0} ns a ray, {hits} crossings", began.elapsed().as_secs_f64() * 1e9 / f64::from(rays));
    assert!(hits > 500_000);
}

#[test]
fn c10_c11_horn_and_spindle_tori_are_filled() {
    let horn = solid("torus(major: 1, minor: 1)");
    assert_eq!(ts(&*horn, &ray([0.0; 3], [1.0, 0.0, 0.0])), [-2.0, 2.0]);
    assert!(ts(&*horn, &ray([0.0; 3], [0.0, 0.0, 1.0])).is_empty());
    let spindle = solid("torus(major: 0.5, minor: 1)");
    near(&ts(&*spindle, &ray([0.0; 3], [1.0, 0.0, 0.0])), &[-1.5, 1.5], 1e-15);
    let top = 0.75f64.sqrt();
    near(&ts(&*spindle, &ray([0.0; 3], [0.0, 0.0, 1.0])), &[-top, top], 2.0 * EPS);
}

#[test]
fn c12_a_thin_torus_is_a_wire_of_its_own_thickness() {
    let wire = solid("torus(major: 1, minor: 1e-6)");
    for from in [0.0, -5.0] {
        let t = ts(&*wire, &ray([from, 0.0, 0.0], [1.0, 0.0, 0.0]));
        assert_eq!(t.len(), 4);
        for pair in t.chunks(2) {
            assert!(((pair[1] - pair[0]) / 2e-6 - 1.0).abs() <= 1e-6, "{t:?}");
        }
    }
}

#[test]
fn c13_c14_the_apex_and_the_generators_of_a_cone() {
    let cone = solid("cone(r1: 1, r2: 0, h: 1)");
    assert_eq!(ts(&*cone, &ray([0.0, 0.0, -1.0], [0.0, 0.0, 1.0])), [1.0, 2.0]);
    for z in [1.0, 1.5] {
        assert!(ts(&*cone, &ray([-2.0, 0.0, z], [1.0, 0.0, 0.0])).is_empty());
    }
    // Along a generator, and inside of it by 1e-9: from the wall's far side to the base.
    let along = dvec3(1.0, 0.0, -1.0);
    assert!(ts(&*cone, &Ray::new(DVec3::Z, along)).is_empty());
    for by in [1e-9, 1e-6, 1e-3] {
        let t = ts(&*cone, &Ray::new(dvec3(-by, 0.0, 1.0), along));
        // x = t - by, z = 1 - t: on the wall |x| = 1 - z = t where by - t = t.
        assert!(t.len() == 2 && (t[0] / (0.5 * by) - 1.0).abs() < 1e-6, "{t:?}");
        assert!((t[1] - 1.0).abs() < 1e-12);
    }
}

#[test]
fn c15_rays_along_the_axis_of_a_cylinder() {
    let cylinder = solid("cylinder(r: 1, h: 2)");
    let up = |x: f64| ts(&*cylinder, &ray([x, 0.0, -1.0], [0.0, 0.0, 1.0]));
    for x in [0.0, 0.5, 1.0 - 0.5 * EPS, -0.999] {
        assert_eq!(up(x), [1.0, 3.0]);
    }
    assert!(up(1.0).is_empty() && up(-1.0).is_empty() && up(1.5).is_empty());
}

#[test]
fn c16_rays_at_rims_meet_one_span_or_none() {
    let solids =
        ["cylinder(r: 1, h: 2)", "cone(r1: 1, r2: 0.3, h: 2)", "cone(r1: 1, r2: 0, h: 2)"].map(solid);
    let mut stream = Stream::new(16);
    let mut met = 0;
    for i in 0..1_000_000 {
        let solid = &solids[i % 3];
        let (top, turn) = (stream.unit() < 0.5, std::f64::consts::TAU * stream.unit());
        let r = if top { [1.0, 0.3, 0.0][i % 3] } else { 1.0 };
        let rim = dvec3(r * turn.cos(), r * turn.sin(), if top { 2.0 } else { 0.0 });
        let d = stream.direction();
        let ray = Ray::new(rim - 10f64.powf(4.0 * stream.unit() - 1.0) * d, d);
        let (found, inside) = line(&**solid, &ray);
        assert!(!inside && (found.is_empty() || found.len() == 2), "{ray:?} {found:?}");
        met += found.len();
    }
    assert!(met > 400_000);
}

#[test]
fn c17_rays_in_a_cap_are_inside_the_low_cap_and_outside_the_high_one() {
    for text in ["cylinder(r: 1, h: 2)", "cone(r1: 1, r2: 1, h: 2)", "cone(r1: 1, r2: 0.5, h: 2)"] {
        let s = solid(text);
        near(&ts(&*s, &ray([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0])), &[2.0, 4.0], 1e-15);
        assert!(ts(&*s, &ray([-3.0, 0.0, 2.0], [1.0, 0.0, 0.0])).is_empty(), "{text}");
    }
    let rounded = solid("box([-1, -1, 0], [1, 1, 2], round: 0.25)");
    assert_eq!(ts(&*rounded, &ray([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0])), [2.25, 3.75]);
    assert!(ts(&*rounded, &ray([-3.0, 0.0, 2.0], [1.0, 0.0, 0.0])).is_empty());
}

#[test]
fn c18_rays_through_edges_and_corners_of_a_box_meet_one_span_or_none() {
    let mut stream = Stream::new(18);
    for text in ["box([-1, -1, -1], [1, 1, 1])", "box([-1, -1, -1], [1, 1, 1], round: 0.5)"] {
        let block = solid(text);
        for i in 0..100_000 {
            let sign = |k: usize| if i >> k & 1 == 0 { -1.0 } else { 1.0 };
            let mut at = dvec3(sign(0), sign(1), sign(2));
            let along = (i / 8) % 4;
            if along < 3 {
                at[along] = 2.0 * stream.unit() - 1.0;
            }
            let d = match (i / 32) % 3 {
                0 if along < 3 => DVec3::AXES[along],
                1 => (3.0 * cube(&mut stream)).round(),
                _ => stream.direction(),
            };
            if d == DVec3::ZERO {
                continue;
            }
            let ray = Ray::new(at - (8.0 * stream.unit()).round() * d, d);
            let (found, inside) = line(&*block, &ray);
            assert!(!inside && (found.is_empty() || found.len() == 2), "{text} {ray:?} {found:?}");
            assert!(found.iter().all(|c| c.t.is_finite()));
        }
    }
}

#[test]
fn c19_from_the_centre_and_from_a_hole_the_first_event_leads_out() {
    let mut scratch = CsgScratch::default();
    let shot = shot("draw sphere(r: 2) - sphere(r: 1)");
    let out = |ray: &Ray, scratch: &mut CsgScratch| {
        let mut spans = Vec::new();
        shot.world.spans(ray, Interval::AHEAD, scratch, &mut spans);
        spans
    };
    let hole = out(&ray([0.0; 3], [0.0, 0.6, 0.8]), &mut scratch);
    assert!(hole.len() == 1 && hole[0].enter.is_some_and(|b| b.flipped && (b.t - 1.0).abs() < 1e-15));
    let wall = out(&ray([1.5, 0.0, 0.0], [1.0, 0.0, 0.0]), &mut scratch);
    assert!(wall.len() == 1 && wall[0].enter.is_none() && wall[0].exit.is_some_and(|b| b.t == 0.5));
}

#[test]
fn c20_a_ray_that_begins_on_a_sphere() {
    let ball = solid("sphere(r: 1)");
    let mut stream = Stream::new(20);
    for _ in 0..100_000 {
        let (o, d) = (stream.direction(), stream.direction());
        let cos = o.dot(d);
        let tau = 16.0 * EPS / cos.abs();
        let ahead: Vec<f64> = ts(&*ball, &Ray::new(o, d)).into_iter().filter(|t| tau < *t).collect();
        if cos < 0.0 {
            let off = ahead.first().map_or(-2.0 * cos, |t| (t + 2.0 * cos).abs());
            assert!(off <= 2.0 * tau, "{o} {d} {ahead:?}");
        } else {
            assert!(ahead.is_empty(), "{o} {d} {ahead:?}");
        }
    }
}

#[test]
fn c21_sizes_of_zero_are_nothing_and_negative_ones_are_refused() {
    let shapes = [
        ("sphere(r: S)", "E0506"),
        ("cylinder(r: S, h: 1)", "E0506"),
        ("cylinder(r: 1, h: S)", "E0506"),
        ("cone(r1: 1, r2: 1, h: S)", "E0506"),
        ("capsule(r: S, from: [0, 0, 0], to: [1, 0, 0])", "E0506"),
        ("tube([[0, 0, 0], [1, 0, 0]], r: S)", "E0506"),
        ("torus(major: 1, minor: S)", "E0506"),
        ("torus(major: S, minor: 1)", "E0506"),
        ("superellipsoid(r: S)", "E0506"),
        ("box(size: S)", "E0506"),
    ];
    let mut scratch = CsgScratch::default();
    let mut stream = Stream::new(21);
    for (shape, code) in shapes {
        let of = |s: &str| format!("draw {}", shape.replace('S', s));
        let wrong = errors(&of("-1"));
        assert!(wrong.len() == 1 && wrong[0].code == code, "{shape}: {wrong:?}");
        for none in ["0", "0.0"] {
            let shot = prepared(&of(none)).shot;
            for _ in 0..100 {
                let ray = Ray::new(cube(&mut stream), stream.direction());
                assert!(spans(&shot, &ray, &mut scratch).is_empty(), "{shape}");
            }
        }
        // Sizes whose powers have no room are refused.
        for size in ["1e-310", "1e-80"] {
            let wrong = errors(&of(size));
            assert!(wrong.len() == 1 && wrong[0].code == "E0506", "{shape} {size}: {wrong:?}");
            assert!(wrong[0].message.contains("too small") && !wrong[0].labels.is_empty(), "{wrong:?}");
        }
        // The smallest that are taken are as good as any, on rays of their own size.
        let shot = shot(&of("1e-75"));
        let met = spans(&shot, &ray([0.1e-75, 0.05e-75, -3e-75], [0.0, 0.0, 1e-75]), &mut scratch);
        if shape.matches('S').count() == 1
            && ["sphere", "superellipsoid", "box"].iter().any(|s| shape.starts_with(s))
        {
            assert_eq!(met.len(), 1, "{shape}");
        }
    }
}

#[test]
fn c22_rays_that_are_none_meet_nothing() {
    let mut scratch = CsgScratch::default();
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let bad = [
        ray([nan, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ray([0.0; 3], [nan, 0.0, 1.0]),
        ray([inf, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ray([0.0; 3], [0.0, inf, 0.0]),
        ray([0.0; 3], [0.0; 3]),
        // So far away that its distance has no square.
        ray([-1e200, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ray([-1e100, 0.0, 0.0], [1e100, 0.0, 0.0]),
    ];
    for s in subjects() {
        let shot = shot(&format!("draw {}", s.text));
        for bad in &bad {
            assert!(!bad.is_valid());
            assert!(shot.world.first(bad, Interval::AHEAD, &mut scratch).is_none(), "{} {bad:?}", s.text);
            assert!(!shot.world.blocked(bad, Interval::AHEAD, &mut scratch));
            assert!(spans(&shot, bad, &mut scratch).is_empty(), "{} {bad:?}", s.text);
        }
    }
    assert_eq!(scratch.solid.counts.invalid_rays, 21 * subjects().len() as u64);
    // They cost no more than being looked at: no leaf is asked.
    assert_eq!(scratch.solid.counts.leaf_queries, 0);
}

/// All 26 directions along axes and diagonals, zeros of either sign: a mirrored ray meets a mirrored solid alike.
#[test]
fn c23_zeros_of_either_sign_and_mirrored_directions_give_the_same_bits() {
    for text in [
        "box([-1, -2, -3], [1, 2, 3])",
        "sphere(r: [1, 2, 3])",
        "torus(major: 2, minor: 0.5)",
        "superellipsoid(r: [1, 2, 3], e1: 0.5, e2: 0.7)",
        "cylinder(r: 1, from: [0, 0, -2], to: [0, 0, 2])",
        "capsule(r: 1, from: [0, 0, -2], to: [0, 0, 2])",
        "box([-1, -2, -3], [1, 2, 3], round: 0.5)",
        "quadric(squares: [1, 2, -1], constant: -1)",
        "cone(r1: 1, r2: 1, from: [0, 0, -2], to: [0, 0, 2])",
    ] {
        let s = solid(text);
        for i in 0..27 {
            let d = DVec3::from_array([i % 3, i / 3 % 3, i / 9].map(|k| f64::from(k) - 1.0));
            if d == DVec3::ZERO {
                continue;
            }
            for from in [DVec3::ZERO, dvec3(0.25, 0.5, 0.125)] {
                // About a mirror at each plane, the ray in the positive octant is the same.
                let t = ts(&*s, &Ray::new(from * d.signum(), d));
                let folded = ts(&*s, &Ray::new(from, d.abs()));
                let minus = DVec3::select(d.cmpeq(DVec3::ZERO), DVec3::splat(-0.0), d);
                let signed = ts(&*s, &Ray::new(from * d.signum(), minus));
                assert_eq!(t, signed, "{text} {d}");
                assert_eq!(t, folded, "{text} {d} {from}");
            }
        }
    }
}

#[test]
fn c24_rays_parallel_to_the_plane_of_a_half_space() {
    let s = solid("half_space(z < 2)");
    let along = |z: f64| line(&*s, &ray([5.0, 0.0, z], [1.0, -3.0, 0.0]));
    assert_eq!(along(1.0), (vec![], true));
    assert_eq!(along(3.0), (vec![], false));
    assert_eq!(along(2.0), (vec![], false));
    let down = line(&*s, &ray([0.0, 0.0, 7.0], [0.0, 0.0, -2.0]));
    assert!(down.0.len() == 1 && down.0[0].t == 2.5 && down.0[0].entering && !down.1);
}

#[test]
fn c25_a_polytope_of_ten_thousand_faces() {
    let mut stream = Stream::new(25);
    let normals: Vec<DVec3> = (0..10_000).map(|_| stream.direction()).collect();
    let leaf = |n: &DVec3| Leaf::new(Arc::new(HalfSpace { normal: *n, offset: 1.0 }), Placement::IDENTITY);
    let leaves: Vec<Leaf> = normals.iter().map(leaf).collect();
    let expr = Expr::And((0..leaves.len() as u32).map(Expr::Leaf).collect());
    let object = Object::new(leaves, &expr);
    let mut scratch = CsgScratch::default();
    let began = Instant::now();
    for n in &normals {
        let mut out = Vec::new();
        object.spans(&Ray::new(DVec3::ZERO, *n), Interval::AHEAD, &mut scratch, &mut out);
        assert!(out.len() == 1 && out[0].enter.is_none());
        assert!((out[0].interval().hi - 1.0).abs() <= 1e-12, "{:?}", out[0]);
    }
    println!("c25: {:.0} us a ray", began.elapsed().as_secs_f64() * 1e6 / normals.len() as f64);
}

/// Along the normal the moved boundary is met at its distance or, where another face is as near, later; mostly at it.
#[test]
fn moved_boundaries_lie_at_their_distance() {
    let mut moved = 0;
    for s in subjects() {
        for by in [0.02, -0.02] {
            let by = by * s.size;
            let Ok(Some(other)) = s.solid.moved(by) else { continue };
            moved += 1;
            let (mut stream, mut exact, mut tried) = (Stream::new(26), 0, 0);
            for _ in 0..300 {
                let r = s.ray(&mut stream);
                if 10.0 * s.size < r.origin.distance(s.center) {
                    continue;
                }
                for c in line(&*s.solid, &r).0 {
                    let out = by.signum() * normal(&*s.solid, &r, &c);
                    let met = ts(&*other, &Ray::new(r.at(c.t), out)).into_iter().find(|t| 0.0 < *t);
                    let late = met.map_or(f64::INFINITY, |t| t - by.abs());
                    assert!(-1e-9 * s.size <= late, "{} {by} {r:?} {late}", s.text);
                    tried += 1;
                    exact += i32::from(late <= 1e-9 * s.size);
                }
            }
            println!("{} by {by:.3}: {exact} of {tried}", s.text);
            assert!(50 < tried && tried < 3 * exact, "{} {by}: {exact} of {tried}", s.text);
        }
    }
    assert!(15 < moved, "{moved}");
}
