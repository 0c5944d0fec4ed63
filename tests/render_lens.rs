//! Depth of field: cameras with a thin lens.

mod cli_common;

use std::f64::consts::PI;

use cli_common::Folder;
use pss::film::Film;
use pss::prepare::{self, Options};
use pss::shot::Shot;
use pss::source::SourceMap;

fn shot(text: &str) -> Shot {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text.to_owned());
    let (scene, _) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]).unwrap();
    prepare::prepare(&scene, &Options::default()).unwrap().shot
}

fn film(text: &str) -> Film {
    pss::render::render(&shot(text), &Default::default()).unwrap().film
}

#[test]
fn all_rays_of_a_place_meet_in_the_plane_of_focus_and_start_evenly_on_the_disc() {
    for view in ["fov: 50deg", "height: 3"] {
        let text = format!(
            "camera(eye: [1, 2, 3], look_at: [5, -2, 1], {view}, aperture: 0.6, focus: 4)\ndraw sphere(r: 1)"
        );
        let camera = shot(&text).camera;
        let size = [40, 30];
        let pinhole = camera.ray(7.5, 21.0, size);
        let forward = camera.ray(20.0, 15.0, size).dir.normalize();
        let met = pinhole.at(4.0);
        let mut squares = 0.0;
        for i in 0..400 {
            let on_lens = [(f64::from(i % 20) + 0.5) / 20.0, (f64::from(i / 20) + 0.5) / 20.0];
            let ray = camera.ray_through(7.5, 21.0, size, || on_lens);
            assert!(ray.at(4.0).distance(met) < 1e-14, "{view}");
            let aside = ray.origin - pinhole.origin;
            assert!(aside.length() <= 0.3 && aside.dot(forward).abs() < 1e-15);
            squares += aside.length_squared();
        }
        // Of an even disc the mean square is half that of the radius.
        assert!((squares / 400.0 - 0.5 * 0.09).abs() < 1e-12, "{squares}");
    }
}

/// A wall at distance 10, its left half black, its right half white, and what of it an eye with a lens sees.
fn edge(lens: &str) -> Film {
    film(&format!(
        "camera(eye: [0, 0, 10], look_at: [0, 0, 0], up: [0, 1, 0], height: 0.4{lens})
         render(size: [40, 4], samples: 16384, integrator: \"flat\")
         draw box([0, -9, -1], [9, 9, 0]).with(matte(rgb(1, 1, 1)))
         draw box([-9, -9, -1], [0, 9, 0]).with(matte(rgb(0, 0, 0)))"
    ))
}

#[test]
fn what_is_in_focus_is_sharp_and_an_edge_elsewhere_is_spread_over_the_circle_of_confusion() {
    let sharp = edge("");
    for lens in [", aperture: 0", ", aperture: 2, focus: 10", ", aperture: 2"] {
        let film = edge(lens);
        for (a, b) in sharp.rgba.iter().zip(&film.rgba) {
            assert!((a[0] - b[0]).abs() < 1e-6, "{lens}: {a:?} {b:?}");
        }
    }
    // Focused at 8, the lens of radius 1 throws a circle of radius 1 * |10 - 8| / 8 on the wall.
    let blurred = edge(", aperture: 2, focus: 8");
    let radius = 0.25;
    for x in 0..40_u32 {
        // Pixels are a tenth: the mean over each of the share of the circle right of the edge.
        let share = |at: f64| {
            let q = (at / radius).clamp(-1.0, 1.0);
            0.5 + (q * (1.0 - q * q).sqrt() + q.asin()) / PI
        };
        let mean =
            (0..100).map(|k| share((f64::from(x) + (f64::from(k) + 0.5) / 100.0) * 0.1 - 2.0)).sum::<f64>()
                / 100.0;
        let seen = f64::from(blurred.rgba[40 + x as usize][0]);
        assert!((seen - mean).abs() < 0.01, "{x}: {seen} {mean}");
    }
}

#[test]
fn a_single_sample_and_the_layers_see_through_the_middle_of_the_lens() {
    let with = |lens: &str| {
        film(&format!(
            "camera(eye: [0, -6, 1], look_at: [0, 0, 0]{lens})
             render(size: [30, 20], samples: 1, aov: [\"depth\", \"normal\"])
             draw sphere(r: 1) - box([0, -2, 0], [2, 2, 2])"
        ))
    };
    assert_eq!(with(""), with(", aperture: 1, focus: 2"));
}

#[test]
fn a_lens_that_is_none_is_refused() {
    let folder = Folder::new();
    for (camera, told) in [
        ("aperture: -1", "negative"),
        ("aperture: 1, focus: 0", "`focus` is 0"),
        ("aperture: 1, focus: -3", "`focus` is -3"),
        ("focus: 3", "everything is in focus"),
        ("kind: \"spherical\", aperture: 1", "no lens"),
    ] {
        folder.write(
            "s.pss",
            format!(
                "camera(eye: [0, 0, 9], look_at: [0, 0, 0], up: [0, 1, 0], {camera})\ndraw sphere(r: 1)\n"
            ),
        );
        let ran = folder.run(&["render", "s.pss", "--size", "8x8"]);
        assert!(ran.code == 65 && ran.stderr.contains(told), "{camera}: {}", ran.stderr);
    }
}
