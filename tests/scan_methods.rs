//! `.thicken`, `.inset`, `.offset` and `.clip`: exact where the shape allows it, measured on clouds of known shapes.

mod common;
mod csg_support;

use common::{Truth, all_of, chord};
use csg_support::scene::{errors, prepared, shot, spans};
use glam::DVec3;
use pss::cloud::{Cloud, SampleOptions, Samples};
use pss::csg::Scratch;
use pss::geom::Ray;
use pss::solid::point_set::{Options, PointSet};
use pss::solid::{self, Body, Solid};

fn surface(points: Vec<DVec3>, normals: Vec<DVec3>, width: Option<f64>) -> (PointSet, f64) {
    let cloud = Cloud { points, normals: Some(normals), ..Cloud::default() };
    let samples = Samples::new(cloud, &SampleOptions { width, ..SampleOptions::default() }).unwrap();
    let mut widths = samples.widths.clone();
    widths.sort_by(f64::total_cmp);
    let width = widths[widths.len() / 2];
    (PointSet::new(&samples.points, &samples.normals, &samples.widths, &Options::default()), width)
}

fn hemisphere(n: usize) -> (PointSet, f64) {
    let (points, normals) = Truth::Sphere.cloud(n);
    let (points, normals) = points.into_iter().zip(normals).filter(|(p, _)| 0.0 < p.z).unzip();
    surface(points, normals, None)
}

/// A square grid in the plane z = 0 over [-1, 1]^2.
fn grid(n: i32, width: Option<f64>) -> (PointSet, f64) {
    let at = |i: i32| f64::from(2 * i - (n - 1)) / f64::from(n - 1);
    let points: Vec<DVec3> = (0..n * n).map(|i| DVec3::new(at(i % n), at(i / n), 0.0)).collect();
    let normals = vec![DVec3::Z; points.len()];
    surface(points, normals, width)
}

/// F6: residual 0, and the edge where the samples end.
#[test]
fn f6_a_thickened_plane_is_a_slab_that_ends_where_the_samples_end() {
    // Automatic widths are 1.4 times wider at the edge and let the surface go on a little further.
    slab_ends(None, 0.26);
    slab_ends(Some(0.1), 0.1);
}

fn slab_ends(width: Option<f64>, most: f64) {
    let (set, h) = grid(41, width);
    let spacing = 2.0 / 40.0;
    for d in [0.1 * h, h, 4.0 * h, 1.0] {
        let thick = set.thickened(d);
        assert_eq!(thick.body(), Body::Solid);
        let mut scratch = solid::Scratch::default();
        let mut worst = 0.0f64;
        for i in 0..100 {
            let (x, y) = (f64::from(i % 10) * 0.16 - 0.71, f64::from(i / 10) * 0.16 - 0.73);
            let ray = Ray::new(DVec3::new(x, y, 3.0), DVec3::new(0.03, -0.02, -1.0));
            let found = all_of(&thick, &ray, &mut scratch);
            assert_eq!(found.len(), 2, "d {d} at {x} {y}");
            assert!(found[0].entering && !found[1].entering);
            for (c, want) in found.iter().zip([0.5 * d, -0.5 * d]) {
                worst = worst.max((ray.at(c.t).z - want).abs());
                let normal = thick.normal(&ray, c, &mut scratch);
                assert!((normal - DVec3::Z * want.signum()).length() < 1e-9, "{normal}");
            }
        }
        // In the plane itself, along an axis: the edge.
        let mut edges = Vec::new();
        for i in 0..20 {
            let y = f64::from(i) * 0.07 - 0.7;
            let ray = Ray::new(DVec3::new(-3.0, y, 0.2 * d), DVec3::X);
            let found = all_of(&thick, &ray, &mut scratch);
            assert_eq!(found.len(), 2, "d {d} at {y}");
            edges.extend(found.iter().map(|c| ray.at(c.t).x.abs() - 1.0));
            let normal = thick.normal(&ray, &found[0], &mut scratch);
            assert!(normal.x < -0.99, "{normal}");
        }
        let (low, high) = edges.iter().fold((f64::MAX, f64::MIN), |(l, h), e| (l.min(*e), h.max(*e)));
        println!(
            "d/h {:.1}: faces off by {worst:.1e}, edge at {:.3}..{:.3} h past the last sample",
            d / h,
            low / h,
            high / h
        );
        assert!(worst < 1e-9, "{worst:e}");
        // The last row stands for half a spacing beyond it.
        let off = [low, high].map(|e| (e - 0.5 * spacing).abs() / h);
        assert!(off[0].max(off[1]) < most, "{off:?}");
        assert!((high - low) / h < 0.1);
    }
}

#[test]
fn a_thickened_hemisphere_is_a_shell_of_that_thickness() {
    let (set, h) = hemisphere(8000);
    for d in [0.2 * h, 1.0 * h, 4.0 * h, 0.6] {
        let thick = set.thickened(d);
        let mut scratch = solid::Scratch::default();
        let mut worst = 0.0f64;
        let (mut odd, mut crossings) = (0, 0);
        for i in 0..400 {
            // From the centre outward, well above the rim.
            let to = chord(i, DVec3::ZERO, 1.0).origin;
            let to = DVec3::new(to.x, to.y, to.z.abs() + 0.2).normalize();
            let ray = Ray::new(DVec3::ZERO, to);
            let found: Vec<_> =
                all_of(&thick, &ray, &mut scratch).into_iter().filter(|c| 0.0 < c.t).collect();
            assert_eq!(found.len(), 2, "d/h {} along {to}", d / h);
            worst = worst.max((found[1].t - found[0].t - d).abs() / d);
            let normal = thick.normal(&ray, &found[1], &mut scratch);
            assert!((normal - to).length() < 1e-3, "{normal} {to}");
        }
        for i in 0..800 {
            let found = all_of(&thick, &chord(i, DVec3::ZERO, 1.0 + d), &mut scratch);
            odd += found.len() % 2;
            crossings += found.len();
            assert!(found.iter().enumerate().all(|(k, c)| c.entering == (k % 2 == 0)), "chord {i}");
        }
        let per = scratch.counts.projections as f64 / 1900.0;
        println!(
            "d/h {:.1}: thickness off by {worst:.1e}, {odd} odd chords, {crossings} crossings, {per:.0} solves a line, {} undecided",
            d / h,
            scratch.counts.certificate_failures
        );
        assert!(worst < 0.01, "{worst:e}");
        assert_eq!(odd, 0);
    }
}

/// Chords of the shell against the closed form: a half shell that ends at the rim's plane.
#[test]
fn every_wall_of_a_thickened_hemisphere_is_found() {
    let (set, h) = hemisphere(4000);
    for d in [0.5 * h, 3.0 * h] {
        let thick = set.thickened(d);
        let mut scratch = solid::Scratch::default();
        let mut wrong = 0;
        for i in 0..1000 {
            let ray = chord(i, DVec3::ZERO, 1.5);
            let found = all_of(&thick, &ray, &mut scratch);
            // Points that are clearly in or out by the closed form.
            for k in 0..64 {
                let t = (f64::from(k) + 0.5) / 64.0;
                let p = ray.at(t);
                let (off, up) = ((p.length() - 1.0).abs() - 0.5 * d, p.z / p.length());
                let margin = 0.02 * h;
                if off.abs() < margin || up.abs() < 0.5 * h {
                    continue;
                }
                let inside = found.iter().filter(|c| c.t < t).count() % 2 == 1;
                wrong += i32::from(inside != (off < 0.0 && 0.0 < up));
            }
        }
        assert_eq!(wrong, 0, "d/h {}", d / h);
    }
}

#[test]
fn a_thickened_plane_is_a_slab() {
    let scene = shot("draw plane(z: 1).thicken(0.5).rotate_x(90deg)");
    let found = spans(&scene, &Ray::new(DVec3::new(0.0, 3.0, 0.0), -DVec3::Y), &mut Scratch::default());
    let ends: Vec<f64> = found.iter().flat_map(|s| [s.interval().lo, s.interval().hi]).collect();
    assert_eq!(ends.len(), 2);
    assert!((ends[0] - 3.75).abs() < 1e-12 && (ends[1] - 4.25).abs() < 1e-12, "{ends:?}");
}

#[test]
fn insets_and_offsets_of_closed_forms_are_exact() {
    let cases = [
        ("sphere(r: 2).inset(0.5)", "sphere(r: 1.5)"),
        ("sphere(r: 2).offset(0.5)", "sphere(r: 2.5)"),
        ("box(size: 1).offset(0.25)", "box(size: 1.5, round: 0.25)"),
        ("sphere(r: 2).scale(2).inset(0.5)", "sphere(r: 3.5)"),
        ("sphere(r: 2).inset(0.5).scale(2)", "sphere(r: 3)"),
        (
            "box([0, 0, 0], [2, 3, 4]).rotate_z(30deg).inset(0.5)",
            "box([0.5, 0.5, 0.5], [1.5, 2.5, 3.5]).rotate_z(30deg)",
        ),
        ("cylinder(r: 2, h: 3).inset(0.5)", "cylinder(r: 1.5, from: [0, 0, 0.5], to: [0, 0, 2.5])"),
        ("half_space(z < 1).offset(0.5) & sphere(r: 2)", "half_space(z < 1.5) & sphere(r: 2)"),
        ("(sphere(r: 2) & half_space(z < 1)).inset(0.5)", "sphere(r: 1.5) & half_space(z < 0.5)"),
        ("(sphere(r: 2) - sphere(r: 1)).inset(0.25)", "sphere(r: 1.75) - sphere(r: 1.25)"),
        (
            "(sphere(r: 2) | sphere(r: 1, at: [2, 0, 0])).offset(0.25)",
            "sphere(r: 2.25) | sphere(r: 1.25, at: [2, 0, 0])",
        ),
    ];
    let mut scratch = Scratch::default();
    for (moved, want) in cases {
        let (moved_shot, want_shot) = (shot(&format!("draw {moved}")), shot(&format!("draw {want}")));
        for i in 0..200 {
            let ray = chord(i, DVec3::ZERO, 5.0);
            let ends = |shot, scratch: &mut Scratch| -> Vec<f64> {
                spans(shot, &ray, scratch).iter().flat_map(|s| [s.interval().lo, s.interval().hi]).collect()
            };
            let (have, want) = (ends(&moved_shot, &mut scratch), ends(&want_shot, &mut scratch));
            assert_eq!(have.len(), want.len(), "{moved}");
            for (a, b) in have.iter().zip(&want) {
                assert!(a == b || (a - b).abs() < 1e-12, "{moved}: {a} {b}");
            }
        }
    }
}

#[test]
fn what_has_no_exact_offset_says_so_at_its_place() {
    for (text, code, part) in [
        ("sphere(r: [1, 2, 3]).inset(0.1)", "E0307", "ellipsoid"),
        ("cylinder(r: 1, h: 1).offset(0.1)", "E0307", "rounded"),
        ("sphere(r: 1).scale([1, 2, 1]).inset(0.1)", "E0307", "different axes"),
        ("(sphere(r: 1) | box(size: 1)).inset(0.1)", "E0307", "combination"),
        ("sphere(r: 1).inset(1)", "E0309", "nothing is left"),
        ("box(size: 1).inset(0.5)", "E0309", "nothing is left"),
        ("points(sphere(r: 1), samples: 2000).inset(1.5)", "E0309", "nothing is left"),
        ("sphere(r: 1).thicken(0.1)", "E0308", "open surface"),
        ("sphere(r: 1).inset(-1)", "E0503", "above zero"),
        ("plane(z: 0).thicken(0)", "E0503", "above zero"),
        ("plane(z: 0).thicken(30deg)", "E0501", "a length"),
        ("sphere(r: 1).clip(plane(z: 0))", "E0301", "no inside"),
        ("plane(z: 0) & sphere(r: 1)", "E0301", "no inside"),
    ] {
        let found = errors(&format!("draw {text}"));
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert_eq!(found[0].code, code, "{text}: {found:?}");
        let told = format!("{found:?}");
        assert!(told.contains(part), "{text}: {told}");
        assert!(found[0].help.is_some() && !found[0].labels.is_empty(), "{text}: {told}");
    }
}

/// The scan keeps its body, its distance is right, and the distance is reported.
#[test]
fn an_inset_and_an_offset_scan_lie_at_their_distance() {
    for (by, word) in [(0.1, "inset"), (0.4, "inset"), (0.1, "offset"), (1.0, "offset")] {
        let text = format!("draw points(sphere(r: 1), samples: 8000).{word}({by}) & box(size: 9)");
        let prepared = prepared(&text);
        let radius = if word == "inset" { 1.0 - by } else { 1.0 + by };
        let (mut scratch, mut worst) = (Scratch::default(), 0.0f64);
        for i in 0..500 {
            let ray = Ray::new(DVec3::ZERO, chord(i, DVec3::ZERO, 1.0).origin);
            let found = spans(&prepared.shot, &ray, &mut scratch);
            assert_eq!(found.len(), 1, "{text}");
            let ends = found[0].interval();
            worst = worst.max((-ends.lo - radius).abs()).max((ends.hi - radius).abs());
        }
        println!("{word} {by}: off by {:.1e} of the distance; {:?}", worst / by, prepared.scans[1].notes);
        assert!(worst < 0.01 * by, "{text}: {worst:e}");
        assert!(prepared.scans[1].notes.iter().any(|n| n.contains("distance")), "{:?}", prepared.scans);
    }
}

/// Creases: an offset cube's edges and corners are round, an inset one's sharp and its samples dropped there.
#[test]
fn an_offset_of_a_cloud_with_creases_has_round_edges_and_no_gaps() {
    let cube = "points(box([-1, -1, -1], [1, 1, 1]), samples: 8000)";
    for (word, by) in [("offset", 0.5), ("inset", 0.3)] {
        let shot = shot(&format!("draw {cube}.{word}({by}) & box(size: 9)"));
        let (mut scratch, mut worst, mut missed) = (Scratch::default(), 0.0f64, 0);
        for i in 0..1000 {
            let dir = chord(i, DVec3::ZERO, 1.0).origin;
            let found = spans(&shot, &Ray::new(DVec3::ZERO, dir), &mut scratch);
            if found.len() != 1 {
                missed += 1;
                continue;
            }
            let p = (found[0].interval().hi * dir).abs();
            let distance = if word == "offset" {
                (p - 1.0).max(DVec3::ZERO).length() - by
            } else {
                p.max_element() - (1.0 - by)
            };
            worst = worst.max(distance.abs());
        }
        println!("{word} of a cube by {by}: off by {worst:.4} at most, {missed} of 1000 lines missed");
        // The cloud's own creases are round by a fraction of its width, 0.09.
        assert_eq!(missed, 0);
        assert!(worst < 0.06, "{worst}");
    }
}

#[test]
fn clip_keeps_the_surface_without_a_cap() {
    let shot = shot("draw sphere(r: 1).clip(half_space(z < 0.5))");
    let mut scratch = Scratch::default();
    let mut hits = Vec::new();
    for (x, want) in [(0.0, 1), (0.5, 1), (0.95, 2)] {
        hits.clear();
        let ray = Ray::new(DVec3::new(x, 0.0, 3.0), -DVec3::Z);
        shot.world.sheets(&ray, pss::geom::Interval::ALL, &mut scratch, &mut hits);
        assert_eq!(hits.len(), want, "{x}");
        assert!(spans(&shot, &ray, &mut scratch).is_empty());
        let p = ray.at(hits[hits.len() - 1].boundary.t);
        assert!((p.length() - 1.0).abs() < 1e-12 && p.z < 0.5);
    }
}
