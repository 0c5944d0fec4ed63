//! Skies with pictures.

mod picture_common;

use std::fs;
use std::path::Path;

use glam::Vec3;
use picture_common::mean;
use pss::film::Film;
use pss::output::write_exr;
use pss::prepare::{self, Options};
use pss::source::SourceMap;

fn sky(size: [u32; 2], color: impl Fn(u32, u32) -> [f32; 3]) -> Vec<u8> {
    let mut film = Film::new(size, &[]).unwrap();
    for y in 0..size[1] {
        for x in 0..size[0] {
            let [r, g, b] = color(x, y);
            film.rgba[(y * size[0] + x) as usize] = [r, g, b, 1.0];
        }
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    write_exr(&film, &mut bytes).unwrap();
    bytes.into_inner()
}

fn film_in(folder: &Path, text: &str) -> Result<Film, String> {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", Some(folder.join("scene.pss")), text.to_owned());
    let told = |e: Vec<pss::diag::Diagnostic>| e[0].message.clone();
    let (scene, _) = pss::lang::read(&mut sources, file, &prepare::catalog(), &[]).map_err(told)?;
    let options = Options { scene_dir: folder.to_owned(), ..Options::default() };
    let shot = prepare::prepare(&scene, &options).map_err(told)?.shot;
    Ok(pss::render::render(&shot, &Default::default()).unwrap().film)
}

fn floor(light: &str, integrator: &str) -> String {
    format!(
        "camera(eye: [0, -4, 3], look_at: [0, 0, 0], fov: 0.1deg)
         {light}
         render(size: [32, 32], samples: 256, integrator: \"{integrator}\", tone: \"none\")
         draw plane(z: 0).with(matte(rgb(0.5, 0.5, 0.5)))"
    )
}

#[test]
fn a_floor_gets_the_cosine_weighed_light_of_its_half_of_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    // A dim sky with a small bright window, 20 degrees wide, and a bright ground that lights nothing above.
    let color = |x: u32, y: u32| match (x, y) {
        (40..44, 12..15) => [300.0, 200.0, 100.0],
        (_, 32..) => [5.0; 3],
        _ => [0.2, 0.3, 0.4],
    };
    fs::write(folder.path().join("sky.exr"), sky([128, 64], color)).unwrap();
    let map = pss::shot::Environment::new(
        [128, 64],
        (0..64).flat_map(|y| (0..128).map(move |x| Vec3::from_array(color(x, y)))).collect(),
    )
    .unwrap();
    // Midpoints over the upper half, none of the sampling's code but the lookup.
    let (n, mut sum) = (1500, 0.0);
    for i in 0..n {
        for j in 0..n {
            let z = (i as f64 + 0.5) / n as f64;
            let (sin, cos) = ((j as f64 + 0.5) / n as f64 * std::f64::consts::TAU).sin_cos();
            let level = (1.0 - z * z).sqrt();
            sum += f64::from(map.radiance(glam::DVec3::new(level * cos, level * sin, z)).x) * z;
        }
    }
    // The mean of L cos over the half, times 2 pi, over pi, times the colour.
    let wanted = 0.5 * 2.0 * sum / (n * n) as f64;
    for integrator in ["direct", "path"] {
        let film = film_in(folder.path(), &floor("light(image: \"sky.exr\")", integrator)).unwrap();
        let (seen, error) = mean(&film, 0);
        assert!(
            (seen - wanted).abs() < 4.0 * error + 1e-3 * wanted,
            "{integrator}: {seen} +- {error}, not {wanted}"
        );
        assert!(error < 0.01 * wanted, "the window is aimed at: {error}");
    }
}

#[test]
fn a_picture_of_one_colour_is_a_plain_sky_and_is_seen_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sky.exr"), sky([8, 4], |_, _| [0.5, 0.25, 1.0])).unwrap();
    let with = |light: &str| {
        let text = format!(
            "camera(eye: [0, -4, 1], look_at: [0, 0, 0], fov: 60deg)
             light({light})
             render(size: [32, 32], samples: 64, integrator: \"path\", tone: \"none\")
             draw sphere(r: 1).with(metal(rgb(0.9, 0.9, 0.9), roughness: 0.4))"
        );
        film_in(folder.path(), &text).unwrap()
    };
    let (image, plain) = (with("image: \"sky.exr\""), with("color: rgb(0.5, 0.25, 1)"));
    assert_eq!(image.pixel(0, 0), plain.pixel(0, 0));
    for c in 0..3 {
        let (a, b) = (mean(&image, c).0, mean(&plain, c).0);
        assert!((a - b).abs() < 5e-3 * b, "{c}: {a} {b}");
    }
    let double = with("image: \"sky.exr\", intensity: 2");
    assert_eq!(double.pixel(0, 0)[0], 1.0);
}

#[test]
fn what_a_spherical_camera_sees_can_be_a_sky() {
    let folder = tempfile::tempdir().unwrap();
    let seen = film_in(
        folder.path(),
        "camera(eye: [0, 0, 0], look_at: [0, 1, 0], kind: \"spherical\")
         light(color: #000)
         render(size: [128, 64], samples: 16, integrator: \"path\", tone: \"none\")
         draw sphere(r: 1, at: [0, 5, 0]).with(emissive(#f00))
         draw sphere(r: 1, at: [5, 0, 0]).with(emissive(#0f0))
         draw sphere(r: 1, at: [0, 0, 5]).with(emissive(#00f))",
    )
    .unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    write_exr(&seen, &mut bytes).unwrap();
    fs::write(folder.path().join("sky.exr"), bytes.into_inner()).unwrap();
    // The eye looks past a speck to where two of them were.
    for (eye, color) in [([0.0, -9.0, 0.0], 0), ([-9.0, 0.0, 0.0], 1)] {
        let text = format!(
            "camera(eye: {eye:?}, look_at: [0, 0, 0], fov: 3deg)
             light(image: \"sky.exr\")
             render(size: [4, 4], samples: 16, integrator: \"path\", tone: \"none\")
             draw sphere(r: 0.001, at: [0, 0, 50])"
        );
        let [r, g, b] = [0, 1, 2].map(|c| mean(&film_in(folder.path(), &text).unwrap(), c).0);
        let all = [r, g, b];
        assert!(0.9 < all[color] && r + g + b < 1.1, "{all:?}");
    }
}

#[test]
fn what_is_no_picture_of_a_sky_is_told() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("text.exr"), "no picture").unwrap();
    fs::write(folder.path().join("half.exr"), &sky([64, 32], |x, y| [x as f32, y as f32, 1.0])[..900])
        .unwrap();
    for (name, word) in
        [("text.exr", "neither"), ("half.exr", "whole"), ("none.exr", "none.exr"), ("../sky.exr", "..")]
    {
        let told = film_in(folder.path(), &floor(&format!("light(image: {name:?})"), "direct")).unwrap_err();
        assert!(told.contains(word), "{name}: {told}");
    }
    fs::write(folder.path().join("sky.exr"), sky([8, 4], |_, _| [0.5; 3])).unwrap();
    let told =
        film_in(folder.path(), &floor("light(image: \"sky.exr\", at: [1, 2, 3])", "direct")).unwrap_err();
    assert!(told.contains("`at`"), "{told}");
    // Black everywhere: dark, and no error.
    fs::write(folder.path().join("sky.exr"), sky([8, 4], |_, _| [0.0; 3])).unwrap();
    let film = film_in(folder.path(), &floor("light(image: \"sky.exr\")", "path")).unwrap();
    assert_eq!(mean(&film, 0).0, 0.0);
}
