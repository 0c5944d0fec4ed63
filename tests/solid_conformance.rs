//! What every primitive owes a ray. The table of primitives is walked, each built from its own example through the
//! language: one that is added is tested here without another line.

mod csg_support;
mod solid_support;

use csg_support::scene::{shot, spans};
use glam::{DAffine3, DMat3, DVec3};
use pss::csg::Scratch as CsgScratch;
use pss::geom::{Interval, Placement, Ray};
use pss::num::hash::Stream;
use pss::scene::{Call, Kind, Value};
use pss::solid::table::{self, Build, PRIMITIVES};
use pss::solid::{Body, Crossing, Scratch, Solid};
use solid_support::{
    EPS, MORE, Subject, built, call, cube, grown, holds, inside, line, normal, slope, subjects, ts,
};

const RAYS: usize = 2000;

fn each(seed: u64, mut check: impl FnMut(&Subject, &mut Stream)) {
    for subject in subjects() {
        check(&subject, &mut Stream::new(seed));
    }
}

fn solids(seed: u64, mut check: impl FnMut(&Subject, &mut Stream)) {
    each(seed, |s, stream| {
        if s.solid.body() == Body::Solid {
            check(s, stream);
        }
    });
}

#[test]
fn every_primitive_is_tested_here_or_with_the_scans() {
    for p in PRIMITIVES {
        let call = call(p.decl.example);
        assert_eq!(call.word, p.decl.word, "the example shows the primitive");
        match p.build {
            Build::Exact(_) => assert!(subjects().iter().any(|s| s.call.word == p.decl.word)),
            // Made from files or samples: on the level of scenes, below.
            _ => assert!(built(&call).is_none()),
        }
    }
    assert!(MORE.iter().all(|text| table::find(&call(text).word).is_some()));
}

/// Finite, ascending, alternating; a bounded solid is entered first and left last.
#[test]
fn crossings_are_finite_ascending_and_alternate() {
    each(1, |s, stream| {
        let mut hits = 0;
        for _ in 0..RAYS {
            let ray = s.ray(stream);
            if s.solid.body() == Body::Sheet {
                let mut out = Vec::new();
                s.solid.crossings(&ray, Interval::ALL, &mut Scratch::default(), &mut out);
                assert!(out.windows(2).all(|w| w[0].t < w[1].t) && out.iter().all(|c| c.t.is_finite()));
                hits += out.len();
                continue;
            }
            let (crossings, mut inside) = line(&*s.solid, &ray);
            hits += crossings.len();
            let bounded = s.solid.bounds().is_finite();
            assert!(
                !bounded || (!inside && crossings.len().is_multiple_of(2)),
                "{} {ray:?} {crossings:?}",
                s.text
            );
            for (i, c) in crossings.iter().enumerate() {
                assert!(c.t.is_finite() && c.entering != inside, "{} {ray:?} {crossings:?}", s.text);
                assert!(i == 0 || crossings[i - 1].t < c.t, "{} {ray:?} {crossings:?}", s.text);
                inside = c.entering;
            }
        }
        assert!(RAYS / 20 < hits, "{}: {hits} crossings", s.text);
    });
}

/// Membership of a point does not depend on the line that asks; nor on the side that it comes from.
#[test]
fn lines_of_all_directions_agree_on_what_is_inside() {
    solids(2, |s, stream| {
        let mut seen = [0; 2];
        for _ in 0..RAYS {
            // Off the places that are neither inside nor outside.
            let p = s.target(stream) + 1e-5 * s.size * cube(stream);
            let dirs = [DVec3::X, DVec3::NEG_X, DVec3::Z, stream.direction(), stream.direction()];
            let margin = 1e3 * EPS * s.scale(&Ray::new(p, DVec3::X));
            let near = dirs.iter().any(|d| {
                let ray = Ray::new(p, *d);
                line(&*s.solid, &ray).0.iter().any(|c| c.t.abs() * slope(&*s.solid, &ray, c) <= margin)
            });
            if near {
                continue;
            }
            let all = dirs.map(|d| inside(&*s.solid, p, d));
            assert!(all.iter().all(|x| *x == all[0]), "{} {p} {all:?}", s.text);
            seen[usize::from(all[0])] += 1;
        }
        assert!(20 < seen[0] + seen[1], "{} {seen:?}", s.text);
    });
}

#[test]
fn every_crossing_lies_in_the_box() {
    each(3, |s, stream| {
        for _ in 0..RAYS {
            let ray = s.ray(stream);
            let bounds = grown(&s.solid.bounds(), s.scale(&ray));
            for t in all(s, &ray).iter().map(|c| c.t) {
                // Rounding of t along a grazing ray moves the point along the surface, out of the box by no more.
                assert!(bounds.contains(ray.at(t)), "{} {ray:?} {t}", s.text);
            }
        }
    });
}

/// All crossings of a solid or a sheet.
fn all(s: &Subject, ray: &Ray) -> Vec<Crossing> {
    let mut out = Vec::new();
    s.solid.crossings(ray, Interval::ALL, &mut Scratch::default(), &mut out);
    out
}

#[test]
fn a_range_changes_nothing_of_what_is_reported() {
    each(4, |s, stream| {
        for _ in 0..RAYS {
            let ray = s.ray(stream);
            let whole = all(s, &ray);
            let (shift, _) = ray.nearest_to(s.center);
            let mut at = || shift + (4.0 * stream.unit() - 2.0) * s.size / ray.dir.length();
            let (a, b) = (at(), at());
            let range = Interval::new(a.min(b), a.max(b));
            let mut part = Vec::new();
            let answer = s.solid.crossings(&ray, range, &mut Scratch::default(), &mut part);
            assert!(answer.range.lo <= range.lo && range.lo <= answer.range.hi, "{}", s.text);
            let cut = answer.range.intersect(range);
            let within = |c: &&Crossing| cut.lo < c.t && c.t <= cut.hi;
            let (want, have): (Vec<_>, Vec<_>) =
                (whole.iter().filter(within).collect(), part.iter().filter(within).collect());
            assert_eq!(want, have, "{} {ray:?}", s.text);
        }
    });
}

/// Crossings without pairs nearer to each other than `least`, in t: at an edge a line may see both faces or none.
fn without_films(list: Vec<Crossing>, least: f64) -> Vec<Crossing> {
    let mut kept: Vec<Crossing> = Vec::new();
    for c in list {
        match kept.last() {
            Some(last) if c.t - last.t <= least => {
                kept.pop();
            }
            _ => kept.push(c),
        }
    }
    kept
}

/// The same places from the other end, along the normal to a few ulps; a pair that one of both does not see is thin.
#[test]
fn a_reversed_ray_finds_the_same_places() {
    each(5, |s, stream| {
        let mut unlike = 0;
        for _ in 0..RAYS {
            let ray = s.ray(stream);
            let thick = |list| without_films(list, 64.0 * EPS * s.scale(&ray) / ray.dir.length());
            let forth = thick(all(s, &ray));
            let back = thick(all(s, &Ray::new(ray.origin, -ray.dir)));
            if forth.len() != back.len() {
                unlike += 1;
                continue;
            }
            for (a, b) in forth.iter().zip(back.iter().rev()) {
                let far = (a.t + b.t).abs() * slope(&*s.solid, &ray, a);
                assert!(far <= 8.0 * EPS * s.scale(&ray), "{} {ray:?} {a:?} {b:?}", s.text);
                assert!(a.entering != b.entering || s.solid.body() == Body::Sheet, "{}", s.text);
            }
        }
        assert!(unlike <= RAYS / 200, "{}: {unlike}", s.text);
    });
}

/// The same call with every length doubled `k` times; `None` where an argument is a bare number, whose unit only the
/// primitive knows.
fn doubled(call: &Call, k: i32) -> Option<Call> {
    let mut call = call.clone();
    let by = 2f64.powi(k);
    let params = table::find(&call.word)?.decl.params;
    if params.iter().any(|p| p.kind == Kind::Number) {
        return None;
    }
    for p in params {
        let Some(arg) = call.args.get_mut(p.name) else { continue };
        match (&mut arg.value, p.kind) {
            (Value::Number(x), Kind::Length | Kind::Size | Kind::SizeOrVector) => *x *= by,
            (Value::Vector(v), _) => v.iter_mut().for_each(|x| *x *= by),
            (Value::Points(v), _) => v.iter_mut().for_each(|x| *x *= by),
            (Value::Loops(v), _) => v.iter_mut().flatten().flatten().for_each(|x| *x *= by),
            (Value::HalfSpace { offset, .. }, _) => *offset *= by,
            _ => {}
        }
    }
    Some(call)
}

#[test]
fn a_power_of_two_changes_no_bit() {
    let mut tested = 0;
    each(6, |s, stream| {
        for k in [-20, 1, 20] {
            let by = 2f64.powi(k);
            let large = doubled(&s.call, k).and_then(|call| built(&call));
            tested += usize::from(large.is_some());
            for _ in 0..RAYS / 4 {
                let ray = s.ray(stream);
                let t = ts_of(&*s.solid, &ray);
                // A longer direction counts fewer of it.
                let longer = ts_of(&*s.solid, &Ray::new(ray.origin, by * ray.dir));
                assert!(t.iter().map(|t| t / by).eq(longer), "{} {ray:?}", s.text);
                if let Some(large) = &large {
                    let scaled = ts_of(&**large, &Ray::new(by * ray.origin, by * ray.dir));
                    assert_eq!(t, scaled, "{} {ray:?}", s.text);
                }
            }
        }
    });
    assert!(3 * PRIMITIVES.len() / 2 < tested);
}

fn ts_of(solid: &dyn Solid, ray: &Ray) -> Vec<f64> {
    let mut out = Vec::new();
    solid.crossings(ray, Interval::ALL, &mut Scratch::default(), &mut out);
    out.iter().map(|c| c.t).collect()
}

/// Through a placement t is kept, and normals stay outward, also in a mirror.
#[test]
fn affine_images_keep_t_and_outward_normals() {
    let shear = DMat3::from_cols_array(&[1.0, 0.2, 0.0, -0.4, 0.7, 0.1, 0.3, 0.0, 1.5]);
    let maps = [
        DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
        DAffine3::from_scale(DVec3::new(-1.0, -1.0, -1.0)),
        DAffine3::from_mat3_translation(shear, DVec3::new(3.0, -2.0, 1.0)),
        DAffine3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0),
    ];
    solids(7, |s, stream| {
        let (mut tried, mut inward) = (0, 0);
        for (i, map) in maps.iter().enumerate() {
            let place = Placement::new(*map).expect("invertible");
            for _ in 0..RAYS / 4 {
                let ray = s.ray(stream);
                let world = ray.transformed(map);
                let local = place.ray_to_local(&world);
                let (here, there) = (line(&*s.solid, &ray).0, line(&*s.solid, &local).0);
                if i < 2 {
                    assert_eq!(here, there, "{}", s.text);
                }
                for c in &there {
                    let n = place.normal_to_world(normal(&*s.solid, &local, c));
                    assert!((n.length() - 1.0).abs() < 1e-12, "{} {n}", s.text);
                    // Outward: a ray that enters runs against it. In a corner no one normal holds for every ray.
                    let along = world.dir.normalize().dot(n);
                    inward += usize::from(c.entering != (along < 0.0) && 1e-7 < along.abs());
                    tried += 1;
                }
                let same = here.len() == there.len();
                for (a, b) in here.iter().zip(&there).filter(|_| same) {
                    let steep = slope(&*s.solid, &ray, a).min(slope(&*s.solid, &local, b));
                    let far = (a.t - b.t).abs() * steep;
                    assert!(far <= 64.0 * EPS * s.scale(&ray).max(8.0), "{} {ray:?} {a:?} {b:?}", s.text);
                }
            }
        }
        assert!(100 < tried && 100 * inward <= tried, "{} {inward} of {tried}", s.text);
    });
}

/// Moved by 1e7 a crossing is displaced along the normal by at most 16 eps of that.
#[test]
fn an_offset_of_ten_million_costs_no_more_than_its_own_rounding() {
    solids(8, |s, stream| {
        let by = 1e7 * DVec3::new(1.0, -0.7, 0.3);
        let place = Placement::new(DAffine3::from_translation(by)).expect("invertible");
        for _ in 0..RAYS {
            let at = s.target(stream);
            let ray = Ray::new(at - 2.0 * s.size * stream.direction(), DVec3::ZERO);
            let ray = Ray::new(ray.origin, at - ray.origin);
            let moved = place.ray_to_local(&Ray::new(ray.origin + by, ray.dir));
            let (here, there) = (line(&*s.solid, &ray).0, line(&*s.solid, &moved).0);
            if here.len() != there.len() {
                let thin = |list: &[Crossing]| {
                    list.windows(2).any(|w| {
                        let steep = slope(&*s.solid, &ray, &w[0]).min(slope(&*s.solid, &ray, &w[1]));
                        (w[1].t - w[0].t) * steep < 64.0 * EPS * 1e7
                    })
                };
                assert!(thin(&here) || thin(&there), "{} {ray:?} {here:?} {there:?}", s.text);
                continue;
            }
            for (a, b) in here.iter().zip(&there) {
                let steep = slope(&*s.solid, &ray, a).min(slope(&*s.solid, &moved, b));
                assert!((a.t - b.t).abs() * steep <= 16.0 * EPS * 1e7, "{} {ray:?} {a:?} {b:?}", s.text);
            }
        }
    });
}

/// Just below the surface is inside, just above it outside, and so on any way that clearly leads in or out. Edges are
/// few: there the nearest face may be another.
#[test]
fn normals_point_from_the_inside_to_the_outside() {
    solids(9, |s, stream| {
        let (mut tried, mut wrong) = (0, 0);
        while tried < RAYS {
            // Any ray: one aimed at an edge has no normal.
            let at = s.center + 0.4 * s.size * cube(stream);
            let ray = Ray::new(at - s.size * stream.direction(), DVec3::ZERO);
            let ray = Ray::new(ray.origin, at - ray.origin);
            for c in line(&*s.solid, &ray).0 {
                let n = normal(&*s.solid, &ray, &c);
                assert!((n.length() - 1.0).abs() <= 4.0 * EPS, "{} {n}", s.text);
                let (at, step) = (ray.at(c.t), 1e-7 * s.size);
                let way = stream.direction();
                let way = if way.dot(n).abs() < 0.3 { n } else { way };
                let out = inside(&*s.solid, at + step * way, stream.direction());
                wrong += usize::from(out != (way.dot(n) < 0.0));
            }
            tried += 1;
        }
        assert!(wrong <= RAYS / 200, "{}: {wrong}", s.text);
    });
}

/// C19: from inside, the first thing met is a way out.
#[test]
fn c19_from_inside_the_first_crossing_leads_out() {
    let mut scratch = CsgScratch::default();
    solids(10, |s, stream| {
        let shot = shot(&format!("draw {}", s.text));
        let mut tried = 0;
        for _ in 0..20 * RAYS {
            if tried == 100 {
                break;
            }
            // The middle of what some ray has inside.
            let aimed = s.ray(stream);
            let (found, _) = line(&*s.solid, &aimed);
            let pair = found.windows(2).find(|w| w[0].entering);
            let p = match (pair, found.first()) {
                (Some(pair), _) => aimed.at(0.5 * (pair[0].t + pair[1].t)),
                (None, Some(c)) => aimed.at(c.t) - 0.1 * s.size * normal(&*s.solid, &aimed, c),
                _ => continue,
            };
            let ray = Ray::new(p, stream.direction());
            let whole = line(&*s.solid, &ray);
            let ahead = whole.0.iter().find(|c| 0.0 < c.t);
            let near = whole.0.iter().any(|c| c.t.abs() < 1e-9 * s.size);
            if !holds(&whole, 0.0) || near {
                continue;
            }
            tried += 1;
            assert!(ahead.is_none_or(|c| !c.entering), "{}", s.text);
            let hit = shot.world.first(&ray, Interval::AHEAD, &mut scratch);
            assert_eq!(hit.map(|h| h.entering), ahead.map(|_| false), "{} {ray:?}", s.text);
        }
        assert!(20 < tried, "{}: {tried}", s.text);
    });
}

/// G1: a ray that leaves a surface by its offset does not meet it again where it left; sizes from 1e-4 to 1e4, places up
/// to 1e8 away.
#[test]
fn g1_a_ray_that_leaves_a_surface_does_not_meet_it_again() {
    let mut scratch = CsgScratch::default();
    solids(11, |s, stream| {
        for (size, place) in [(1.0, 0.0), (1e-4, 1e-3), (1e4, 1e8), (1.0, 1e5)] {
            let to = place * DVec3::new(1.0, -0.7, 0.3);
            let text = format!("draw {}.scale({size:?}).move([{:?}, {:?}, {:?}])", s.text, to.x, to.y, to.z);
            let shot = shot(&text);
            let map =
                DAffine3::from_scale_rotation_translation(DVec3::splat(size), glam::DQuat::IDENTITY, to);
            let mut tried = 0;
            for _ in 0..RAYS / 4 {
                let (a, b) = (s.target(stream), s.target(stream));
                let ray = Ray::new(
                    a - 2.0 * s.size * (b - a).normalize_or(DVec3::X),
                    (b - a).normalize_or(DVec3::X),
                );
                let ray = ray.transformed(&map);
                let Some(hit) = shot.world.first(&ray, Interval::AHEAD, &mut scratch) else { continue };
                let surface = shot.world.surface(&ray, &hit);
                let mut dir = stream.direction();
                dir *= dir.dot(surface.normal).signum();
                if dir.dot(surface.normal) < 0.05 {
                    continue;
                }
                tried += 1;
                let from = Ray::new(surface.point + surface.offset * surface.normal, dir);
                // Where it bends inward a ray meets the solid farther on: here only what is near counts.
                let near = Interval::new(0.0, 1e-3 * size * s.size);
                assert!(!shot.world.blocked(&from, near, &mut scratch), "{text} {ray:?} {from:?}");
            }
            assert!(20 < tried, "{text}: {tried}");
        }
    });
}

/// B7: whatever way two copies take to their place, nothing is left of one without the other.
#[test]
fn b7_a_solid_less_itself_is_nothing_ten_million_away() {
    let routes = [
        (".rotate_z(30deg).rotate_z(60deg)", ".rotate_z(90deg)"),
        (".scale(3).scale(1 / 3)", ""),
        (".scale([2, 1, 0.5]).scale([0.5, 1, 2])", ""),
        (".move([3.7, -1.3, 0.9]).move([-3.7, 1.3, -0.9])", ""),
    ];
    let mut scratch = CsgScratch::default();
    solids(12, |s, stream| {
        for (one, other) in routes {
            for at in [0.0, 1e7] {
                let to = format!(".move([{:?}, {:?}, {:?}])", at, -0.7 * at, 0.3 * at);
                let text = format!("let a = {}{one}{to}\nlet b = {}{other}{to}\n", s.text, s.text);
                let shots = ["a - b", "a ^ b"].map(|e| shot(&format!("{text}draw {e}")));
                let whole = shot(&format!("{text}draw a"));
                let mut met = 0;
                for _ in 0..200 {
                    let target = s.target(stream);
                    let ray = Ray::new(target - s.size * stream.direction(), DVec3::ZERO);
                    let ray = Ray::new(ray.origin, target - ray.origin);
                    let ray = if one.contains("rotate") {
                        ray.transformed(&DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2))
                    } else {
                        ray
                    };
                    let ray = Ray::new(ray.origin + at * DVec3::new(1.0, -0.7, 0.3), ray.dir);
                    met += spans(&whole, &ray, &mut scratch).len();
                    for shot in &shots {
                        let left = spans(shot, &ray, &mut scratch);
                        assert!(left.is_empty(), "{text} {ray:?} {left:?}");
                    }
                }
                assert!(3 < met, "{text} {met}");
            }
        }
    });
}

/// Primitives made from files or samples, by the world that a scene makes of their example: order, range, the other end.
#[test]
fn primitives_made_of_samples_keep_the_same_rules() {
    let mut scratch = CsgScratch::default();
    for p in PRIMITIVES.iter().filter(|p| !matches!(p.build, Build::Exact(_))) {
        // An example that names a file is tested where the file is made.
        if p.decl.example.contains('"') {
            continue;
        }
        let shot = shot(&format!("draw {}", p.decl.example));
        let bounds = shot.world.bounds();
        let mut stream = Stream::new(13);
        let mut met = 0;
        for _ in 0..100 {
            let at = bounds.center() + 0.5 * bounds.size() * cube(&mut stream);
            let dir = stream.direction();
            let ray = Ray::new(at - bounds.diagonal() * dir, dir);
            let forth = spans(&shot, &ray, &mut scratch);
            let back = spans(&shot, &Ray::new(ray.origin, -dir), &mut scratch);
            met += forth.len();
            assert_eq!(forth.len(), back.len(), "{}", p.decl.word);
            for (a, b) in forth.iter().zip(back.iter().rev()) {
                let (a, b) = (a.interval(), b.interval());
                let far = (a.lo + b.hi).abs().max((a.hi + b.lo).abs());
                assert!(a.lo < a.hi && far <= 1e-6 * bounds.diagonal(), "{} {a:?} {b:?}", p.decl.word);
            }
            assert!(forth.windows(2).all(|w| w[0].interval().hi < w[1].interval().lo));
        }
        assert!(20 < met, "{}", p.decl.word);
    }
    assert!(ts(&*solid_support::solid("sphere(r: 1)"), &Ray::new(DVec3::ZERO, DVec3::X)).len() == 2);
}
