//! STRESS.md, section G: rays that start on surfaces. G1 stands in `solid_conformance.rs` for every primitive, G7 in
//! `render_glass.rs`.

mod picture_common;

use glam::DVec3;
use picture_common::{film, shot};
use pss::csg::Scratch;
use pss::geom::{Interval, Ray};
use pss::num::hash::Stream;
use pss::shot::Shot;

/// A ray toward a shot from outside: between two places of its bounds.
fn aimed(shot: &Shot, stream: &mut Stream) -> Ray {
    let bounds = shot.world.bounds();
    let (middle, size) = (bounds.center(), bounds.diagonal());
    let mut within = || {
        middle + (bounds.size() * DVec3::new(stream.unit() - 0.5, stream.unit() - 0.5, stream.unit() - 0.5))
    };
    let (a, b) = (within(), within());
    let dir = (b - a).normalize_or(DVec3::X);
    Ray::new(a - 2.0 * size * dir, dir)
}

/// Bodies at sizes from 1e-6 to 1e6, and ten million away.
fn places() -> Vec<(f64, f64)> {
    let mut places: Vec<(f64, f64)> = [1e-6, 1e-3, 1.0, 1e3, 1e6].map(|size| (size, 0.0)).into();
    places.push((1.0, 1e7));
    places
}

/// G2: where the cosine to a light is above 0.01 a convex body is lit, and so is each point of a torus and a scan that sees the
/// light by another way of asking.
#[test]
fn g2_no_surface_shadows_itself() {
    let solids = [
        ("sphere(r: 1)", true),
        ("box(size: 1)", true),
        ("torus(major: 1, minor: 0.4)", false),
        ("points(sphere(r: 1), samples: 2000)", false),
    ];
    for (solid, convex) in solids {
        for (size, away) in places() {
            let text = format!("draw {solid}.scale({size:e}).move([{away:e}, {:e}, {away:e}])", -away);
            let shot = shot(&text);
            let (mut stream, mut scratch) = (Stream::new(2), Scratch::default());
            let rays = if convex { 20_000 } else { 2_000 };
            let (mut lit, mut dark) = (0, 0);
            for _ in 0..rays {
                let ray = aimed(&shot, &mut stream);
                let Some(hit) = shot.world.first(&ray, Interval::AHEAD, &mut scratch) else { continue };
                let surface = shot.world.surface(&ray, &hit);
                let to_light = stream.direction();
                if to_light.dot(surface.normal) <= 0.01 {
                    continue;
                }
                let from = Ray::new(surface.point + surface.offset * surface.normal, to_light);
                let blocked = shot.world.blocked(&from, Interval::AHEAD, &mut scratch);
                // Of a body that bends inward the last crossing of the whole line tells: past it there is nothing.
                let covered = !convex && {
                    let first =
                        shot.world.first(&from, Interval::new(1e-3 * size, f64::INFINITY), &mut scratch);
                    first.is_some()
                };
                lit += u32::from(!blocked);
                dark += u32::from(blocked && !covered);
            }
            assert!(rays / 8 < lit, "{text}: {lit}");
            assert_eq!(dark, 0, "{text}: of {lit}");
        }
    }
}

/// G3: nothing outside a closed hull is lit from within, however thin the wall.
#[test]
fn g3_closed_hulls_let_no_light_out() {
    let hulls = [
        "box(size: 2) - box(size: 1.9)",
        "box(size: 2) - box(size: 1.999999)",
        "sphere(r: 1) - sphere(r: 0.99)",
        "(box(size: 2) | sphere(r: 1.2)) - (box(size: 1.9) | sphere(r: 1.1))",
        "points(sphere(r: 1), samples: 2000) - sphere(r: 0.5)",
    ];
    for hull in hulls {
        let shot = shot(&format!("draw {hull}"));
        let (mut stream, mut scratch) = (Stream::new(3), Scratch::default());
        for _ in 0..if hull.contains("points") { 5_000 } else { 100_000 } {
            let from = 0.2 * DVec3::new(stream.unit() - 0.5, stream.unit() - 0.5, stream.unit() - 0.5);
            let ray = Ray::new(from, stream.direction());
            assert!(shot.world.blocked(&ray, Interval::AHEAD, &mut scratch), "{hull} {ray:?}");
            // And from outside, to the light.
            let start = ray.at(5.0);
            let back = Ray::new(start, from - start);
            assert!(shot.world.blocked(&back, Interval::new(0.0, 1.0), &mut scratch), "{hull} {back:?}");
        }
    }
}

/// G4: the ray from a light to a point that it lights meets that point: by 4 tau, of a scan by twice its tolerance.
#[test]
fn g4_a_light_sees_what_it_lights() {
    for (solid, scan) in [
        ("sphere(r: 1)", false),
        ("box(size: 2) - cylinder(r: 0.4, from: [0, 0, -2], to: [0, 0, 2])", false),
        ("torus(major: 1, minor: 0.4)", false),
        ("points(sphere(r: 1), samples: 2000)", true),
    ] {
        let shot = shot(&format!("draw {solid}"));
        let (mut stream, mut scratch) = (Stream::new(4), Scratch::default());
        let light = DVec3::new(3.0, -5.0, 4.0);
        let mut seen = 0;
        for _ in 0..2_000 {
            let ray = aimed(&shot, &mut stream);
            let Some(hit) = shot.world.first(&ray, Interval::AHEAD, &mut scratch) else { continue };
            let surface = shot.world.surface(&ray, &hit);
            let start = surface.point + surface.offset * surface.normal;
            // Along a face the point of meeting slides; that is no error of either way.
            if (light - start).normalize().dot(surface.normal) < 0.05
                || shot.world.blocked(&Ray::new(start, light - start), Interval::new(0.0, 1.0), &mut scratch)
            {
                continue;
            }
            let back = Ray::new(light, surface.point - light);
            let Some(hit) = shot.world.first(&back, Interval::AHEAD, &mut scratch) else {
                panic!("{solid}: the light does not see {}", surface.point)
            };
            let there = shot.world.surface(&back, &hit);
            let apart = (there.point - surface.point).dot(surface.normal).abs();
            let size = shot.world.bounds().diagonal();
            let tau = pss::geom::tolerance::cleanup(light.length() + size);
            let allowed = if scan { 2.0 * pss::geom::tolerance::POINTS * size } else { 4.0 * tau };
            assert!(apart <= allowed, "{solid}: {apart:e}, not {allowed:e}");
            seen += 1;
        }
        assert!(300 < seen, "{solid}: {seen}");
    }
}

/// G5: the wall that a cutter leaves behaves like any other.
#[test]
fn g5_rays_leave_the_faces_of_cuts() {
    for (solid, within) in [
        ("box(size: 2) - sphere(r: 0.9)", 0.5),
        ("sphere(r: 1.5) - box([0, -2, -2], [2, 2, 2])", 0.5),
        (
            "difference(box(size: 2), for i in 0..4 { cylinder(r: 0.2, from: [0.4 * i - 0.6, 0, -2], to: [0.4 * i - 0.6, 0, 2]) })",
            0.0,
        ),
        ("sphere(r: 1) - points(sphere(r: 0.8), samples: 2000)", 0.4),
    ] {
        let shot = shot(&format!("draw {solid}"));
        let (mut stream, mut scratch) = (Stream::new(5), Scratch::default());
        let (mut tried, rays) = (0, if solid.contains("points") { 3_000 } else { 30_000 });
        for _ in 0..rays {
            // From within the hollow, and from outside.
            let ray = if within > 0.0 && stream.unit() < 0.5 {
                Ray::new(
                    within * DVec3::new(stream.unit(), stream.unit() - 0.5, stream.unit() - 0.5),
                    stream.direction(),
                )
            } else {
                aimed(&shot, &mut stream)
            };
            let Some(hit) = shot.world.first(&ray, Interval::AHEAD, &mut scratch) else { continue };
            if !hit.boundary.flipped || !hit.entering {
                continue;
            }
            let surface = shot.world.surface(&ray, &hit);
            assert!(surface.normal.dot(ray.dir) <= 0.0, "{solid}: a face seen from behind");
            let dir = stream.direction();
            let dir = dir * dir.dot(surface.normal).signum();
            if dir.dot(surface.normal) < 0.05 {
                continue;
            }
            tried += 1;
            let from = Ray::new(surface.point + surface.offset * surface.normal, dir);
            let near = Interval::new(0.0, 1e-3);
            assert!(!shot.world.blocked(&from, near, &mut scratch), "{solid} {ray:?} {from:?}");
        }
        assert!(rays / 60 < tried, "{solid}: {tried}");
    }
}

/// G6: of two plates 100 tau apart each shadows the other, and a ray between them is free.
#[test]
fn g6_thin_gaps_are_neither_closed_nor_jumped() {
    let tau = pss::geom::tolerance::cleanup(2.0);
    for gap in [100.0 * tau, 1e-12, 1e-9, 1e-6] {
        let shot =
            shot(&format!("draw box([-1, -1, -1], [1, 1, 0])\ndraw box([-1, -1, {gap:e}], [1, 1, 1])"));
        let (mut stream, mut scratch) = (Stream::new(6), Scratch::default());
        for _ in 0..20_000 {
            let p = DVec3::new(1.8 * stream.unit() - 0.9, 1.8 * stream.unit() - 0.9, 0.5 * gap);
            let dir = stream.direction();
            let within = Ray::new(p, dir);
            // The plates lie on both sides of the gap.
            let hit = shot.world.first(&within, Interval::AHEAD, &mut scratch);
            if dir.z.abs() < 1e-3 {
                continue;
            }
            let hit = hit.unwrap_or_else(|| panic!("{gap:e}: free toward {dir}"));
            assert!(hit.entering, "{gap:e}: starts in a plate");
            let surface = shot.world.surface(&within, &hit);
            assert_eq!(surface.normal.z, -dir.z.signum());
            let from = Ray::new(surface.point + surface.offset * surface.normal, stream.direction());
            let up = Ray::new(from.origin, from.dir * from.dir.dot(surface.normal).signum());
            if 1e-3 < up.dir.z.abs() {
                assert!(shot.world.blocked(&up, Interval::AHEAD, &mut scratch), "{gap:e}: jumped {up:?}");
            }
        }
        let along = Ray::new(DVec3::new(-2.0, 0.1, 0.5 * gap), DVec3::X);
        assert!(!shot.world.blocked(&along, Interval::AHEAD, &mut scratch), "{gap:e}: closed");
    }
}

/// G8: one scene gives one picture, on however many threads and by whatever order of tiles (that is
/// `render::tests::the_order_of_tiles_changes_no_bit`), cropped and whole, run after run.
#[test]
fn g8_threads_and_runs_change_no_bit() {
    let text = |more: &str| {
        format!(
            "material clear(kind: \"glass\", color: #c0e0d0)
             camera(eye: [4, -5, 3], look_at: [0, 0, 0.5], fov: 34deg)
             light sun(direction: [-1, 2, -3], softness: 2deg)
             light sky(color: #8090a0)
             render(size: [70, 50], samples: 8, integrator: \"path\", aov: [\"depth\", \"normal\", \"leaf\"])
             draw plane(z: 0)
             draw (box(size: 1, at: [-0.6, 0, 0.5]) - sphere(r: 0.6, at: [-0.6, -0.5, 0.5])).with(plastic(#c04030))
             draw sphere(r: 0.5, at: [0.8, 0, 0.5]).with(clear)
             draw points(torus(major: 0.5, minor: 0.2), samples: 1500).move([0, -1.2, 0.2]).with(metal(#e0c080))
             {more}"
        )
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| film(&text("")))
    };
    let one = on(1);
    assert!(one.rgba.iter().any(|p| *p != one.rgba[0]), "one colour only");
    for threads in [2, 5, 64] {
        assert_eq!(one, on(threads), "{threads}");
    }
}
