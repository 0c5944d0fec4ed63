//! Scans as operands: open, closed, cut, moved, dirty, doubled. Numbers are those of the list of boolean cases.

mod common;
mod csg_support;
mod scans_common;

use std::path::PathBuf;

use common::{Truth, chord};
use csg_support::draws::Draws;
use csg_support::scene::{errors_in, prepared_in, spans};
use glam::DVec3;
use pss::csg::{Scratch, Span};
use pss::geom::{Interval, Ray};
use pss::prepare::Prepared;
use scans_common::{ball_where, cast, down, ends, folder, open_hemisphere, prepared};

/// The folder of real scans, if it is there.
fn scans(name: &str) -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/scans");
    if !folder.join(name).exists() {
        println!("skipped: {} is not here", folder.join(name).display());
        return None;
    }
    Some(folder)
}

#[test]
fn case_72_an_open_scan_as_cutter_is_refused_with_numbers() {
    let folder = open_hemisphere();
    let found = errors_in("draw box(size: 4) - points(\"a.ply\")", folder.path());
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].code, "E0301");
    let told = format!("{:?}", found[0]);
    assert!(told.contains("% of test lines cross it an odd number of times"), "{told}");
    let help = found[0].help.as_deref().unwrap();
    assert!(help.contains(".close(") && help.contains(".thicken("), "{help}");
}

#[test]
fn case_73_the_same_scan_closed_cuts() {
    let folder = open_hemisphere();
    let scene = prepared_in("draw box(size: 4) - points(\"a.ply\").close()", folder.path());
    let spacing = (4.0 * std::f64::consts::PI / 10_000.0f64).sqrt();
    for (x, y) in [(0.0, 0.0), (0.3, 0.2), (-0.5, 0.4), (0.1, -0.7)] {
        let ends = ends(&cast(&scene, &down(x, y)));
        assert_eq!(ends.len(), 4, "{x} {y}: {ends:?}");
        let z: Vec<f64> = ends.iter().map(|t| 5.0 - t).collect();
        let top = (1.0 - x * x - y * y).sqrt();
        assert!((z[0] - 2.0).abs() < 1e-12 && (z[3] + 2.0).abs() < 1e-12, "{z:?}");
        assert!((z[1] - top).abs() < 1e-4, "{z:?} {top}");
        assert!(z[2].abs() < spacing, "the cap: {z:?}");
    }
}

#[test]
fn case_74_a_plane_caps_a_scan_flat() {
    let mut worst = 0.0f64;
    let mut check = |scene: &Prepared, center: DVec3, reach: f64| {
        let mut met = 0;
        for i in 0..400 {
            let (x, y) = (f64::from(i % 20) / 10.0 - 0.95, f64::from(i / 20) / 10.0 - 0.95);
            let from = center + reach * DVec3::new(x, y, 5.0);
            let found = cast(scene, &Ray::new(from, -DVec3::Z));
            let Some(first) = found.first().and_then(|s| s.enter) else { continue };
            if 0.999 < first.normal.z {
                met += 1;
                worst = worst.max((from.z - first.t - center.z).abs() / reach);
                assert!((first.normal - DVec3::Z).length() < 1e-12);
            }
        }
        assert!(50 < met, "{met}");
    };
    let text = "draw points(sphere(r: 1), samples: 8000) & half_space(z < 0.3)";
    check(&prepared(text), DVec3::new(0.0, 0.0, 0.3), 1.0);
    if let Some(folder) = scans("igea.ply") {
        let center = prepared_in("draw points(\"igea.ply\")", &folder).shot.world.bounds().center();
        let text = format!("draw points(\"igea.ply\") & half_space(z < {:?})", center.z);
        check(&prepared_in(&text, &folder), center, 0.08);
    }
    println!("caps are flat to {worst:.1e} of the size");
    assert!(worst < 1e-6, "{worst:e}");
}

/// What a moved scan says of its distance: the error at 99 of 100 places, percent.
fn distance_error(scene: &Prepared) -> f64 {
    let mut notes = scene.scans.iter().flat_map(|s| &s.notes);
    let note = notes.rfind(|n| n.contains("off by")).expect("a moved scan reports its distance");
    println!("{note}");
    let at = note.find("at 99").unwrap();
    note[..at].split_whitespace().rev().nth(1).unwrap().parse().unwrap()
}

#[test]
fn case_75_a_scan_minus_its_own_inset_has_a_constant_wall() {
    let wall = 0.1;
    let scene =
        prepared(&format!("let ball = points(sphere(r: 1), samples: 8000)\ndraw ball - ball.inset({wall})"));
    assert!(distance_error(&scene) < 0.1);
    let mut worst = 0.0f64;
    for i in 0..500 {
        let found = cast(&scene, &Ray::new(DVec3::ZERO, chord(i, DVec3::ZERO, 1.0).origin));
        assert_eq!(found.len(), 2);
        found.iter().for_each(|s| worst = worst.max((s.interval().length() / wall - 1.0).abs()));
    }
    println!("the wall of a ball is off by {:.1e}", worst);
    assert!(worst < 1e-3, "{worst:e}");

    // A shape with hollows, by what the moved scan reports of itself.
    let (points, normals) = Truth::Blob.cloud(20_000);
    let folder = folder(&points, &normals);
    let text = format!("let blob = points(\"a.ply\")\ndraw blob - blob.inset({wall})");
    let scene = prepared_in(&text, folder.path());
    assert!(distance_error(&scene) < 1.0);
    for i in 0..500 {
        let found = cast(&scene, &Ray::new(DVec3::ZERO, chord(i, DVec3::ZERO, 1.0).origin));
        assert_eq!(found.len(), 2, "ray {i}");
    }
    if let Some(folder) = scans("bunny.ply") {
        let text = "let bunny = points(\"bunny.ply\").fit([0, 0, 0], height: 100).close()\ndraw bunny - bunny.inset(2)";
        let scene = prepared_in(text, &folder);
        println!("{:?}", scene.scans);
        // Ears two widths thick and a crease around the base: sharp ridges, of which samples tell little.
        assert!(distance_error(&scene) < 25.0);
        let bounds = scene.shot.world.bounds();
        for i in 0..1000 {
            let ray = chord(i, bounds.center(), 0.5 * bounds.diagonal());
            assert!(cast(&scene, &ray).iter().all(|s| s.enter.is_some() && s.exit.is_some()), "chord {i}");
        }
    }
}

#[test]
fn the_cap_of_a_closed_scan_moves_with_the_rest() {
    let (points, normals) = ball_where(10_000, |p| p.z < 0.5);
    let folder = folder(&points, &normals);
    let text = "let bowl = points(\"a.ply\").close()\ndraw bowl - bowl.inset(0.2)";
    let scene = prepared_in(text, folder.path());
    println!("{:?}", scene.scans);
    for (x, y) in [(0.0, 0.0), (0.3, 0.2), (-0.2, 0.3)] {
        let found = cast(&scene, &down(x, y));
        assert_eq!(found.len(), 2, "{x} {y}: {:?}", ends(&found));
        let cap = found[0].interval().length();
        assert!((cap - 0.2).abs() < 0.01, "the wall of the cap is {cap}");
        let below = |r: f64| (r * r - x * x - y * y).sqrt();
        let wall = found[1].interval().length();
        assert!((wall - (below(1.0) - below(0.8))).abs() < 1e-3, "the wall below is {wall}");
    }
}

/// A ball's samples against the ball: what one has and the other not is a shell within the surface's own error, and no
/// line changes sides within it.
#[test]
fn case_35_a_scan_less_the_ball_it_was_sampled_from_is_a_thin_shell() {
    let rays = if std::env::var_os("PSS_LONG").is_some() { 1_000_000 } else { 20_000 };
    let of = |op: &str| prepared(&format!("draw points(sphere(r: 1), samples: 8000) {op} sphere(r: 1)"));
    let [minus, xor] = ["-", "^"].map(of);
    // Degree 2 is of order h^4 on the sphere; at this spacing the shell is at most 1e-4 thick, as asserted.
    let (tol, mut volume, mut crossed, mut scratch) = (1e-4, 0.0, 0u64, Scratch::default());
    for i in 0..rays {
        let ray = chord(i, DVec3::ZERO, 1.2);
        let shell = |p: DVec3| (p.length() - 1.0).abs();
        for span in spans(&minus.shot, &ray, &mut scratch) {
            let (a, b) = (ray.at(span.interval().lo), ray.at(span.interval().hi));
            assert!(shell(a).max(shell(b)) < tol && shell(0.5 * (a + b)) < tol, "{ray:?} {span:?}");
            volume += (b - a).length();
        }
        // Where it goes through the ball it changes sides at most once by each face.
        let found = spans(&xor.shot, &ray, &mut scratch);
        let near = (ray.origin - ray.origin.dot(ray.dir) / ray.dir.length_squared() * ray.dir).length();
        crossed += u64::from(near < 0.99);
        assert!(0.99 < near || found.len() <= 2, "{ray:?} {found:?}");
    }
    println!("mean length {:.1e} on {rays} lines", volume / rays as f64);
    assert!(rays / 2 < crossed && volume / (rays as f64) < 2.0 * tol, "{crossed} {volume}");
}

#[test]
fn case_76_a_scan_xor_itself_shifted_is_that_of_the_balls() {
    let scan = prepared("let a = points(sphere(r: 1), samples: 8000)\ndraw a ^ a.move([0.3, 0.1, 0])");
    let exact = prepared("draw sphere(r: 1) ^ sphere(r: 1, at: [0.3, 0.1, 0])");
    let (mut other, mut worst) = (0, 0.0f64);
    for i in 0..2000 {
        let ray = chord(i, DVec3::ZERO, 1.5);
        let (have, want) = (ends(&cast(&scan, &ray)), ends(&cast(&exact, &ray)));
        if have.len() != want.len() {
            other += 1;
            continue;
        }
        have.iter().zip(&want).for_each(|(a, b)| worst = worst.max((a - b).abs()));
    }
    println!("{other} of 2000 lines differ in number, ends by {worst:.1e} at most");
    // Lines that touch a ball, or pass where both meet, within the surface's own error.
    assert!(other <= 2 && worst < 0.02, "{other} {worst}");
}

#[test]
fn case_77_clip_leaves_a_hole_where_an_intersection_has_a_cap() {
    let scan = "points(sphere(r: 1), samples: 8000)";
    let open = prepared(&format!("draw {scan}.clip(half_space(z < 0.5))"));
    let capped = prepared(&format!("draw {scan} & half_space(z < 0.5)"));
    for (x, y) in [(0.0, 0.0), (0.3, 0.2), (-0.5, 0.4)] {
        let ray = down(x, y);
        let mut hits = Vec::new();
        open.shot.world.sheets(&ray, Interval::ALL, &mut Scratch::default(), &mut hits);
        assert!(cast(&open, &ray).is_empty());
        assert_eq!(hits.len(), 1, "through the hole to the far side");
        assert!((ray.at(hits[0].boundary.t).length() - 1.0).abs() < 1e-4);
        let found = ends(&cast(&capped, &ray));
        assert_eq!(found.len(), 2);
        assert!((found[0] - 4.5).abs() < 1e-12 && (found[1] - hits[0].boundary.t).abs() < 1e-9);
    }
    let refused = errors_in(&format!("draw {scan}.clip(half_space(z < 0.5)) - sphere(r: 0.2)"), ".".as_ref());
    assert_eq!(refused[0].code, "E0301");
}

#[test]
fn case_78_outliers_leave_no_specks() {
    let (mut points, mut normals) = Truth::Sphere.cloud(10_000);
    let mut draws = Draws::new(9);
    // Four spacings off at least; `cloud_loading` has them anywhere.
    while points.len() < 10_500 {
        let p = DVec3::from_array(std::array::from_fn(|_| draws.between(-1.5, 1.5)));
        if 0.15 < (p.length() - 1.0).abs() {
            points.push(p);
            normals.push(draws.direction());
        }
    }
    let folder = folder(&points, &normals);
    println!("{:?}", prepared_in("draw points(\"a.ply\")", folder.path()).scans);
    let scene = prepared_in("draw points(\"a.ply\") & box(size: 9)", folder.path());
    let (mut specks, mut more, mut none) = (0, 0, 0);
    for i in 0..5000 {
        let ray = chord(i, DVec3::ZERO, 1.6);
        let nearest = (ray.origin - ray.dir * ray.origin.dot(ray.dir) / ray.dir.length_squared()).length();
        let found = cast(&scene, &ray).len();
        specks += usize::from(1.15 < nearest && 0 < found);
        more += usize::from(nearest < 0.85 && 1 < found);
        none += usize::from(nearest < 0.85 && found == 0);
    }
    println!(
        "{:?}: {specks} specks, {more} lines with more than one span, {none} with none",
        scene.scans[0].notes
    );
    assert_eq!((specks, more, none), (0, 0, 0));
}

#[test]
fn case_79_duplicate_points_change_nothing() {
    let (points, normals) = Truth::Torus.cloud(6000);
    let plain = folder(&points, &normals);
    let thrice: Vec<usize> = (0..points.len()).flat_map(|i| [i; 3].into_iter().take(1 + i % 3)).collect();
    let pick = |from: &[DVec3]| thrice.iter().map(|i| from[*i]).collect::<Vec<_>>();
    let doubled = folder(&pick(&points), &pick(&normals));
    let text = "draw points(\"a.ply\") - box([0, -1, -2], [2, 1, 2])";
    let (a, b) = (prepared_in(text, plain.path()), prepared_in(text, doubled.path()));
    for i in 0..500 {
        let ray = chord(i, DVec3::ZERO, 1.5);
        let (a, b) = (ends(&cast(&a, &ray)), ends(&cast(&b, &ray)));
        assert_eq!(a.len(), b.len(), "chord {i}");
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12), "chord {i}: {a:?} {b:?}");
    }
}

#[test]
fn case_80_two_scans_that_overlap_have_no_wall_at_the_seam() {
    // Two samplings of one ball, and two balls that overlap.
    let one =
        prepared("draw points(sphere(r: 1), samples: 6000) | points(sphere(r: 1), samples: 7000, seed: 5)");
    let two = prepared(
        "draw points(sphere(r: 1), samples: 6000) | points(sphere(r: 1, at: [0.8, 0, 0]), samples: 6000)",
    );
    let exact = prepared("draw sphere(r: 1) | sphere(r: 1, at: [0.8, 0, 0])");
    let mut other = 0;
    for i in 0..1500 {
        let ray = chord(i, DVec3::ZERO, 1.0);
        if ray.dir.length() < 0.1 {
            continue;
        }
        assert!(cast(&one, &ray).len() <= 1, "chord {i}");
        let ray = chord(i, DVec3::new(0.4, 0.0, 0.0), 1.5);
        let (have, want) = (cast(&two, &ray), cast(&exact, &ray));
        other += i32::from(have.len() != want.len());
    }
    assert!(other <= 1, "{other} lines differ in number from the exact ones");
}

/// A scan and itself a little moved, nowhere coincident: the union of their spans on every ray.
#[test]
fn case_80_two_real_scans_that_overlap_are_the_union_of_both() {
    let Some(folder) = scans("igea.ply") else { return };
    let one = prepared_in("draw points(\"igea.ply\") & box(size: 9e9)", &folder);
    let bounds = one.shot.world.bounds();
    let by = 0.002 * bounds.diagonal();
    let text = format!("let s = points(\"igea.ply\")\ndraw s | s.move([{by:?}, 0, 0])");
    let both = prepared_in(&text, &folder);
    let long = std::env::var_os("PSS_LONG").is_some();
    let (mut more, mut apart, mut rays) = (0, 0.0f64, 0);
    for i in 0..if long { 100_000 } else { 2000 } {
        let ray = chord(i, bounds.center(), 0.5 * bounds.diagonal());
        let (alone, moved) = (cast(&one, &ray), cast(&one, &Ray::new(ray.origin - by * DVec3::X, ray.dir)));
        let (have, want) = (cast(&both, &ray), united(&alone, &moved));
        rays += usize::from(!want.is_empty());
        more += usize::from(have.len() != want.len());
        for (a, b) in have.iter().zip(&want).filter(|_| have.len() == want.len()) {
            apart = apart.max((a.interval().lo - b.lo).abs()).max((a.interval().hi - b.hi).abs());
        }
    }
    println!(
        "{more} of {rays} rays have another number of spans than the union of both, ends {apart:.1e} apart"
    );
    assert!(more == 0 && apart < 1e-9, "{more} {apart:e}");
}

/// The union of two lists of spans, by sorting.
fn united(a: &[Span], b: &[Span]) -> Vec<Interval> {
    let mut all: Vec<Interval> = a.iter().chain(b).map(|s| s.interval()).collect();
    all.sort_by(|a, b| a.lo.total_cmp(&b.lo));
    let mut out: Vec<Interval> = Vec::new();
    for next in all {
        match out.last_mut().filter(|last| next.lo <= last.hi) {
            Some(last) => last.hi = last.hi.max(next.hi),
            None => out.push(next),
        }
    }
    out
}

#[test]
fn case_81_a_scan_scaled_unevenly_is_the_affine_image() {
    let plain = prepared("draw points(sphere(r: 1), samples: 6000) & box(size: 9)");
    let scaled = prepared("draw (points(sphere(r: 1), samples: 6000)).scale([1, 2, 5]) & box(size: 90)");
    let by = DVec3::new(1.0, 2.0, 5.0);
    let mut worst = 0.0f64;
    for i in 0..1000 {
        let ray = chord(i, DVec3::ZERO, 1.3);
        let image = Ray::new(ray.origin * by, ray.dir * by);
        let (have, want) = (ends(&cast(&scaled, &image)), ends(&cast(&plain, &ray)));
        assert_eq!(have.len(), want.len(), "chord {i}");
        have.iter().zip(&want).for_each(|(a, b)| worst = worst.max((a - b).abs()));
        let (a, b) = (cast(&scaled, &image), cast(&plain, &ray));
        for (a, b) in a.iter().zip(&b) {
            let (a, b) = (a.enter.unwrap().normal, b.enter.unwrap().normal);
            assert!((a - (b / by).normalize()).length() < 1e-9, "{a} {b}");
        }
    }
    println!("t differs by {worst:.1e}");
    assert!(worst < 1e-12, "{worst:e}");
}

/// A scan that is closed in one place keeps, in another, the scraps that closing leaves out, whichever comes first.
#[test]
fn closing_a_scan_leaves_its_other_uses_alone() {
    let (mut points, mut normals) = Truth::Sphere.cloud(6000);
    // A scrap within the ball: it bounds nothing.
    let scrap = (0..225).map(|i| DVec3::new(f64::from(i % 15), f64::from(i / 15), 0.0) * 0.045);
    points.extend(scrap);
    normals.resize(points.len(), DVec3::Z);
    let folder = folder(&points, &normals);
    let through = |text: &str| {
        let world = prepared_in(text, folder.path()).shot.world;
        let ray = Ray::new(DVec3::new(0.3, 0.3, 5.0), -DVec3::Z);
        let mut hits = Vec::new();
        world.sheets(&ray, Interval::ALL, &mut Scratch::default(), &mut hits);
        hits.iter().map(|h| (h.boundary.t * 1e9).round()).collect::<Vec<_>>()
    };
    let scan = "let s = points(\"a.ply\")\n";
    let alone = through(&format!("{scan}draw s"));
    assert_eq!(alone.len(), 3);
    let closed = "draw s.close(max_hole: 9).move([9, 0, 0])";
    assert_eq!(through(&format!("{scan}draw s\n{closed}")), alone);
    assert_eq!(through(&format!("{scan}{closed}\ndraw s")), alone);
}
