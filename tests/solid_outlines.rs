//! `extrude` and `revolve` against closed forms, and against the states of points told by another rule: the sum of
//! the angles under which a point sees an outline.

#[path = "csg_support/mod.rs"]
mod csg_support;
#[path = "outline_common/mod.rs"]
mod outline_common;
#[path = "spans_common/mod.rs"]
mod spans_common;

use std::f64::consts::TAU;

use csg_support::scene;
use glam::{DVec2, DVec3, dvec3};
use outline_common::{Loops, ell, outline, shapes, star, winds};
use pss::geom::{Aabb, Interval, Ray};
use pss::num::hash::Stream;
use pss::solid::block::Block;
use pss::solid::cylinder::Cylinder;
use pss::solid::extrude::Extrusion;
use pss::solid::revolve::Revolution;
use pss::solid::{Scratch, Solid};
use spans_common::{assert_is_box, crossings};

/// Every state along a ray is what the oracle says, but within a hair of a crossing. How many spans there were.
fn check(solid: &dyn Solid, inside: &dyn Fn(DVec3) -> bool, ray: &Ray, around: Interval) -> usize {
    let found = crossings(solid, ray);
    const STEPS: usize = 257;
    for i in 0..STEPS {
        let t = around.lo + around.length() * (i as f64 + 0.37) / STEPS as f64;
        let before = found.iter().filter(|c| c.t < t).count();
        if found.iter().any(|c| (c.t - t).abs() < 1e-9 * around.length()) {
            continue;
        }
        assert_eq!(before % 2 == 1, inside(ray.at(t)), "t = {t} of {found:?}\n{ray:?}\n{solid:?}");
    }
    for c in &found {
        let normal = solid.normal(ray, c, &mut Scratch::default());
        assert!((normal.length() - 1.0).abs() < 1e-12 && c.entering == (normal.dot(ray.dir) < 0.0));
        let step = 1e-6 * around.length() * ray.dir.length();
        let (front, back) = (inside(ray.at(c.t) + step * normal), inside(ray.at(c.t) - step * normal));
        // Near corners a step may leave the wall's own side; nearly all others tell out from in.
        let lone = found.iter().all(|o| o == c || 1e-3 * around.length() < (o.t - c.t).abs());
        if lone && normal.dot(ray.dir).abs() > 0.2 * ray.dir.length() {
            assert!(back || !front, "{c:?} {normal} {ray:?}\n{solid:?}");
        }
    }
    found.len() / 2
}

/// Rays through a ball about the middle of the bounds.
fn random_ray(stream: &mut Stream, bounds: &Aabb) -> (Ray, Interval) {
    let radius = 0.5 * bounds.diagonal();
    let chord = Ray::chord(stream, bounds.center(), radius);
    (chord, Interval::new(0.0, 1.0))
}

#[test]
fn an_extruded_square_is_a_box() {
    let made = Extrusion::new(
        outline(&vec![vec![[-1.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-1.0, 1.0]]]),
        3.0,
        0.0,
        DVec2::ONE,
    );
    let block = Block(Aabb { min: dvec3(-1.0, -1.0, 0.0), max: dvec3(2.0, 1.0, 3.0) });
    let radius = 0.5 * block.0.diagonal();
    assert_is_box(&made, &block, 20_000, radius, 8e-14, |ray, lattice, [a, b]| {
        let scratch = &mut Scratch::default();
        let normals = (made.normal(ray, a, scratch), block.normal(ray, b, scratch));
        // On an edge either face may be told.
        assert!(normals.0 == normals.1 || lattice, "{ray:?} {normals:?}");
    });
}

#[test]
fn c18_along_every_axis_both_zeros_give_the_same_bits() {
    let made = [
        Box::new(Extrusion::new(outline(&ell()), 1.5, 0.0, DVec2::ONE)) as Box<dyn Solid>,
        Box::new(Extrusion::new(outline(&ell()), 1.5, 1.0, DVec2::splat(0.5))),
        Box::new(Revolution::new(outline(&ell()), TAU)),
        Box::new(Revolution::new(outline(&ell()), 4.0)),
    ];
    for solid in &made {
        let middle = solid.bounds().center();
        for i in (0..27).filter(|i| *i != 13) {
            let dir = dvec3(f64::from(i % 3 - 1), f64::from(i / 3 % 3 - 1), f64::from(i / 9 - 1));
            for origin in [middle - 3.0 * dir, DVec3::ZERO, dvec3(1.0, 1.0, 1.0), dvec3(0.25, 0.25, 0.5)] {
                let plain = crossings(&**solid, &Ray::new(origin, dir));
                let minus = Ray {
                    origin: origin.map(|x| if x == 0.0 { -0.0 } else { x }),
                    dir: dir.map(|x| if x == 0.0 { -0.0 } else { x }),
                };
                assert_eq!(crossings(&**solid, &minus), plain, "{origin} {dir}");
            }
        }
    }
}

#[test]
fn c17_rays_in_faces_follow_the_half_open_rule() {
    let made = Extrusion::new(outline(&ell()), 1.0, 0.0, DVec2::ONE);
    let spans = |o: [f64; 3], d: [f64; 3]| -> Vec<f64> {
        crossings(&made, &Ray::new(o.into(), d.into())).iter().map(|c| c.t).collect()
    };
    for sign in [1.0, -1.0] {
        let ends = |a: f64, b: f64| if sign > 0.0 { vec![a, b] } else { vec![-b, -a] };
        // In the low face, in the high one.
        assert_eq!(spans([0.5, -5.0, 0.0], [0.0, sign, 0.0]).len(), 4);
        assert!(spans([0.5, -5.0, 1.0], [0.0, sign, 0.0]).is_empty());
        // In the wall x = 0, in x = 2, in y = 1 which is a wall for x in 1..2 only, in a wall of the hole.
        assert_eq!(spans([0.0, 0.0, 0.5], [0.0, sign, 0.0]), ends(0.0, 2.0));
        assert!(spans([2.0, 0.0, 0.5], [0.0, sign, 0.0]).is_empty());
        assert_eq!(spans([0.0, 1.0, 0.5], [sign, 0.0, 0.0]), ends(0.0, 1.0));
        assert_eq!(spans([0.25, 0.0, 0.5], [0.0, sign, 0.0]).len(), 4);
        assert_eq!(spans([0.75, 0.0, 0.5], [0.0, sign, 0.0]), ends(0.0, 2.0));
        // Down along walls.
        assert_eq!(spans([0.0, 0.5, 0.0], [0.0, 0.0, sign]), ends(0.0, 1.0));
        assert!(spans([2.0, 0.5, 0.0], [0.0, 0.0, sign]).is_empty());
        assert!(spans([0.25, 0.5, 0.0], [0.0, 0.0, sign]).is_empty());
        assert_eq!(spans([0.75, 0.5, 0.0], [0.0, 0.0, sign]), ends(0.0, 1.0));
    }
}

#[test]
fn a_revolved_rectangle_is_a_cylinder() {
    let made = Revolution::new(outline(&vec![vec![[0.0, 0.0], [1.25, 0.0], [1.25, 2.0], [0.0, 2.0]]]), TAU);
    let cylinder = Cylinder::new(1.25, DVec3::ZERO, 2.0 * DVec3::Z);
    let mut stream = Stream::new(2);
    let mut hits = 0;
    for i in 0..20_000 {
        let ray = match i % 3 {
            0 => random_ray(&mut stream, &cylinder.bounds()).0,
            // At the axis, level, and along the axis.
            1 => Ray::new(4.0 * stream.direction(), DVec3::ZERO),
            _ => Ray::new(dvec3(2.0 * stream.unit(), 0.0, -1.0), DVec3::Z),
        };
        let ray =
            if i % 3 == 1 { Ray::new(ray.origin, 2.0 * stream.unit() * DVec3::Z - ray.origin) } else { ray };
        let (have, want) = (crossings(&made, &ray), crossings(&cylinder, &ray));
        assert_eq!(have.len(), want.len(), "{ray:?} {have:?} {want:?}");
        hits += want.len();
        for (a, b) in have.iter().zip(&want) {
            assert!((a.t - b.t).abs() * ray.dir.length() < 1e-13, "{ray:?} {a:?} {b:?}");
        }
    }
    assert!(10_000 < hits);
    // Level rays in the caps, and rays down the wall.
    let has = |o: DVec3, d: DVec3| !crossings(&made, &Ray::new(o, d)).is_empty();
    assert!(has(DVec3::ZERO, DVec3::X) && !has(2.0 * DVec3::Z, DVec3::X));
    assert!(!has(1.25 * DVec3::X, DVec3::Z) && has(1.2499 * DVec3::X, DVec3::Z));
}

#[test]
fn c13_c14_a_revolved_triangle_is_a_cone() {
    let made = Revolution::new(outline(&vec![vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]), TAU);
    let ends = |o: DVec3, d: DVec3| crossings(&made, &Ray::new(o, d)).iter().map(|c| c.t).collect::<Vec<_>>();
    assert_eq!(ends(-DVec3::Z, DVec3::Z), [1.0, 2.0]);
    assert!(ends(dvec3(-3.0, 0.0, 1.0), DVec3::X).is_empty());
    assert!(ends(dvec3(-3.0, 0.0, 1.5), DVec3::X).is_empty());
    // Beside a generator by 1e-9: from the base to the far wall at no finite height, so to the base alone.
    let beside = ends(dvec3(1.0 - 1e-9, 0.0, 0.0) - dvec3(-1.0, 0.0, 1.0), dvec3(-1.0, 0.0, 1.0));
    assert!(beside.len() == 2 && (beside[0] - 1.0).abs() < 1e-12 && 1.9 < beside[1], "{beside:?}");
    // Level at height z: a chord of the circle of radius 1 - z.
    let mut stream = Stream::new(3);
    for _ in 0..1000 {
        let (z, b) = (stream.unit(), stream.unit());
        let chord = ends(dvec3(0.0, b, z), DVec3::X);
        let half = ((1.0 - z - b) * (1.0 - z + b)).max(0.0).sqrt();
        assert!(if b < 1.0 - z {
            (chord[1] - half).abs() < 1e-13 && (chord[0] + half).abs() < 1e-13
        } else {
            chord.is_empty()
        });
    }
}

#[test]
fn every_state_along_random_rays_is_that_of_the_angles() {
    let mut stream = Stream::new(4);
    for (solid, inside) in &shapes() {
        let mut spans = 0;
        for _ in 0..60 {
            let (ray, around) = random_ray(&mut stream, &solid.bounds());
            spans += check(&**solid, inside, &ray, around);
        }
        assert!(5 < spans, "{spans} {solid:?}");
    }
}

#[test]
fn rays_at_corners_and_along_edges_keep_their_states() {
    let mut stream = Stream::new(5);
    for (solid, inside) in &shapes() {
        let bounds = solid.bounds();
        // Places on the boundary, and two of them joined: rays that touch, or meet two walls at once.
        let mut places = vec![DVec3::ZERO, dvec3(0.0, 0.0, 1.7), bounds.center()];
        for _ in 0..6 {
            let ray = random_ray(&mut stream, &bounds).0;
            places.extend(crossings(&**solid, &ray).iter().map(|c| ray.at(c.t)));
        }
        for loops in [ell(), vec![star(10, 0)]] {
            places.extend(loops.iter().flatten().map(|p| dvec3(p[0], p[1], 0.0)));
            places.extend(loops.iter().flatten().map(|p| dvec3(p[0] + 1.3, 0.0, p[1])));
        }
        for _ in 0..16 {
            let pick = |s: &mut Stream| places[(s.unit() * places.len() as f64) as usize];
            let (a, b) = (pick(&mut stream), pick(&mut stream));
            let dir = if a == b { stream.direction() } else { b - a };
            let ray = Ray::new(a - 2.0 * dir, dir);
            let found = crossings(&**solid, &ray);
            for pair in found.windows(2).filter(|w| 1e-6 < w[1].t - w[0].t) {
                let p = ray.at(0.5 * (pair[0].t + pair[1].t));
                // The middle of a long gap is where it says, unless the ray runs along a wall.
                let sure = (0..16).all(|_| inside(p + 1e-9 * stream.direction()) == inside(p));
                assert!(!sure || inside(p) == pair[0].entering, "{p} {found:?} {ray:?}\n{solid:?}");
            }
        }
    }
}

#[test]
fn c13_a_ray_at_the_tip_of_a_pyramid_goes_on_inside() {
    let made = Extrusion::new(outline(&vec![star(10, 0)]), 2.0, 0.0, DVec2::ZERO);
    let tip = 2.0 * DVec3::Z;
    let mut stream = Stream::new(6);
    for i in 0..2000 {
        let q = DVec2::new(2.0 * stream.unit() - 1.0, 2.0 * stream.unit() - 1.0);
        let foot = q.extend(0.0);
        let stretch = 10f64.powi(i % 5 - 2);
        let (a, b) = (tip - stretch * (foot - tip), foot);
        let found = crossings(&made, &Ray::new(a, b - a));
        let long: f64 = found.chunks(2).map(|c| c[1].t - c[0].t).sum::<f64>() * (b - a).length();
        let want = if winds(&vec![star(10, 0)], q) { (foot - tip).length() } else { 0.0 };
        assert!((long - want).abs() < 1e-6, "{q} {long} {want}");
    }
}

#[test]
fn c2_rays_from_far_away_find_what_near_ones_find() {
    let mut stream = Stream::new(7);
    for (solid, _) in &shapes() {
        for _ in 0..20 {
            let (ray, _) = random_ray(&mut stream, &solid.bounds());
            let far = 1e7 / ray.dir.length();
            let near = crossings(&**solid, &ray);
            if near.windows(2).any(|w| (w[1].t - w[0].t) * ray.dir.length() < 1e-6) {
                continue;
            }
            let found = crossings(&**solid, &Ray::new(ray.origin - far * ray.dir, ray.dir));
            // The far origin is rounded by 1e-9, and so is what a slanted wall makes of it.
            let close =
                found.iter().zip(&near).all(|(a, b)| (a.t - far - b.t).abs() * ray.dir.length() < 1e-6);
            let slanted = near.iter().any(|c| {
                solid.normal(&ray, c, &mut Scratch::default()).dot(ray.dir).abs() < 1e-2 * ray.dir.length()
            });
            assert!(slanted || (found.len() == near.len() && close), "{found:?} {near:?} {ray:?}\n{solid:?}");
        }
    }
}

#[test]
fn d1_scaling_by_a_power_of_two_changes_no_bit() {
    let mut stream = Stream::new(8);
    for s in [2f64.powi(-20), 2f64.powi(20)] {
        for loops in [ell(), vec![star(14, 1)]] {
            let large: Loops =
                loops.iter().map(|l| l.iter().map(|p| [s * p[0], s * p[1]]).collect()).collect();
            for (twist, scale) in [(0.0, 1.0), (0.0, 0.3), (2.0, 0.5)] {
                let make = |l: &Loops, h: f64| Extrusion::new(outline(l), h, twist, DVec2::splat(scale));
                let (a, b) = (make(&loops, 1.5), make(&large, 1.5 * s));
                same_bits(&a, &b, s, &mut stream);
            }
            let moved = |l: &Loops, by: f64| -> Loops {
                l.iter().map(|l| l.iter().map(|p| [p[0] + by, p[1]]).collect()).collect()
            };
            let (a, b) = (moved(&loops, 2.0), moved(&large, 2.0 * s));
            same_bits(&Revolution::new(outline(&a), 4.0), &Revolution::new(outline(&b), 4.0), s, &mut stream);
        }
    }
}

fn same_bits(a: &dyn Solid, b: &dyn Solid, s: f64, stream: &mut Stream) {
    for _ in 0..200 {
        let ray = random_ray(stream, &a.bounds()).0;
        let scaled = Ray::new(s * ray.origin, s * ray.dir);
        assert_eq!(crossings(a, &ray), crossings(b, &scaled));
    }
}

#[test]
fn boxes_hold_every_crossing_and_touch_the_solid() {
    let mut stream = Stream::new(9);
    for (solid, _) in &shapes() {
        let bounds = solid.bounds();
        let slack = bounds.inflated(1e-9);
        let mut met = Aabb::EMPTY;
        for _ in 0..400 {
            let ray = random_ray(&mut stream, &bounds).0;
            for c in crossings(&**solid, &ray) {
                assert!(slack.contains(ray.at(c.t)), "{c:?} {ray:?} {solid:?}");
                met = met.including(ray.at(c.t));
            }
        }
        assert!((met.size() / bounds.size()).min_element() > 0.5, "{met:?} {bounds:?}");
    }
}

#[test]
fn scenes_make_outlines_with_holes_and_tell_what_is_wrong_with_them() {
    let lengths = |text: &str, o: [f64; 3], d: [f64; 3]| -> Vec<f64> {
        let shot = scene::shot(text);
        let spans = scene::spans(&shot, &Ray::new(o.into(), d.into()), &mut pss::csg::Scratch::default());
        spans.iter().map(|s| s.interval().length()).collect()
    };
    let holed =
        "draw extrude([[[0, 0], [4, 0], [4, 4], [0, 4]], [[1, 1], [3, 1], [3, 3], [1, 3]]], h: 2, scale: 1)";
    assert_eq!(lengths(holed, [-1.0, 2.0, 1.0], [1.0, 0.0, 0.0]), [1.0, 1.0]);
    let turned = "draw extrude([[-1, -1], [1, -1], [1, 1], [-1, 1]], h: 1, twist: 90deg, scale: [1, 0.5])";
    assert_eq!(lengths(turned, [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]), [1.0]);
    let half = "draw revolve([[1, 0], [2, 0], [2, 1], [1, 1]], angle: 180deg)";
    assert_eq!(lengths(half, [-3.0, 0.5, 0.5], [1.0, 0.0, 0.0]).len(), 2);
    assert!(lengths(half, [-3.0, -0.5, 0.5], [1.0, 0.0, 0.0]).is_empty());
    assert_eq!(
        lengths("draw revolve([[1, 0], [2, 0], [2, 1]], angle: 360deg)", [-3.0, -0.1, 0.25], [1.0, 0.0, 0.0])
            .len(),
        2
    );
    for (text, code, word) in [
        ("draw extrude([[0, 0], [1, 0]], h: 1)", "E0407", "three"),
        ("draw extrude([[0, 0], [1, 0], [1, 0], [0, 0]], h: 1)", "E0407", "three"),
        ("draw extrude([[0, 0], [1, 1], [2, 2]], h: 1)", "E0407", "one line"),
        ("draw extrude([], h: 1)", "E0407", "points"),
        ("draw extrude([[0, 0], [1, 0], [0, 1]], h: 1, scale: -1)", "E0407", "negative"),
        ("draw extrude([[0, 0], [1, 0], [0, 1]], h: 1, twist: 30)", "E0502", "angle"),
        ("draw extrude([[0, 0, 1], [1, 0], [0, 1]], h: 1)", "E0501", "2 numbers"),
        ("draw extrude(3, h: 1)", "E0501", "list of points"),
        ("draw extrude([[[0, 0], [1, 0], [0, 1]], 3], h: 1)", "E0501", "list of points"),
        ("draw revolve([[-1, 0], [1, 0], [1, 1]])", "E0407", "axis"),
        ("draw revolve([[0, 0], [1, 0], [1, 1]], angle: 0deg)", "E0407", "more than nothing"),
        ("draw revolve([[0, 0], [1, 0], [1, 1]], angle: 361deg)", "E0407", "full turn"),
        ("draw revolve()", "E0407", "outline"),
    ] {
        let told = scene::errors(text);
        let first = told.first().unwrap_or_else(|| panic!("{text}"));
        assert!(
            first.code == code && first.message.contains(word) && first.help.is_some(),
            "{text} {first:?}"
        );
    }
    // A zero height is nothing.
    assert!(
        lengths("draw extrude([[0, 0], [1, 0], [0, 1]], h: 0)", [0.2, 0.2, -1.0], [0.0, 0.0, 1.0]).is_empty()
    );
}
