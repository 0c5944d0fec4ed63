//! Samples: to an error, by a filter, in patterns.

mod picture_common;

use picture_common::{film, mean, shot};
use pss::film::{Aov, Film};
use pss::num::srgb;

/// A ball half in the shade of a soft sun before nothing, and what else is said.
fn scene(render: &str) -> String {
    format!(
        "camera(eye: [2, -5, 3], look_at: [0, 0, 0.5], fov: 30deg)
         light sun(direction: [-1, 2, -3], softness: 20deg)
         light sky(color: #405060)
         render(size: [61, 47], integrator: \"path\", tone: \"none\", {render})
         draw sphere(r: 1).with(plastic(#c0a080))
         draw box([-3, -3, -1.2], [3, 3, -1])"
    )
}

fn shown(film: &Film) -> Vec<f64> {
    film.rgba
        .iter()
        .flat_map(|p| [p[0], p[1], p[2]])
        .map(|c| srgb::encode(f64::from(c).clamp(0.0, 1.0)))
        .collect()
}

fn rmse(a: &Film, b: &Film) -> f64 {
    let (a, b) = (shown(a), shown(b));
    (a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn samples_to_an_error_keep_it_and_go_where_the_noise_is() {
    let truth = film(&scene("samples: 4096, seed: 9"));
    for error in [0.03, 0.015] {
        let film = film(&scene(&format!("samples: 4096, error: {error}, aov: [\"samples\", \"variance\"]")));
        let apart = rmse(&film, &truth);
        assert!(apart < error, "{apart}, not {error}");
        let samples = &film.layer(Aov::Samples).unwrap().data;
        let mean = samples.iter().sum::<f32>() / samples.len() as f32;
        let most = samples.iter().fold(0.0_f32, |a, b| a.max(*b));
        // The corner shows nothing but the plain sky.
        assert_eq!(samples[0], 16.0);
        assert!(mean < 0.5 * most && 16.0 < most, "{mean} of {most}");
    }
}

#[test]
fn the_variance_that_is_told_is_that_of_pictures_with_other_seeds() {
    let one = |seed: u32| film(&scene(&format!("samples: 64, seed: {seed}, aov: [\"variance\"]")));
    let luminance = |p: &[f32; 4]| f64::from(0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
    let films: Vec<Film> = (0..24).map(one).collect();
    let n = films.len() as f64;
    let (mut told, mut true_) = (0.0, 0.0);
    for i in 0..films[0].rgba.len() {
        let values: Vec<f64> = films.iter().map(|f| luminance(&f.rgba[i])).collect();
        let mean = values.iter().sum::<f64>() / n;
        true_ += values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
        told += films.iter().map(|f| f64::from(f.layers[0].data[i])).sum::<f64>() / n;
    }
    // Quarters of a sequence, each by itself, are less even than the whole: what is told is on the safe side.
    assert!(0.9 * true_ < told && told < 6.0 * true_, "{told} {true_}");
}

#[test]
fn a_crop_of_a_picture_to_an_error_has_the_pixels_of_the_whole() {
    let text = scene("samples: 256, error: 0.02, filter: \"gauss\", aov: [\"samples\"]");
    let whole = film(&text);
    let mut shot = shot(&text);
    shot.settings.crop = Some([13, 9, 50, 38]);
    let part = pss::render::render(&shot, &Default::default()).unwrap().film;
    for y in 0..29 {
        for x in 0..37 {
            assert_eq!(part.pixel(x, y), whole.pixel(x + 13, y + 9), "{x} {y}");
            assert_eq!(
                part.layers[0].data[(37 * y + x) as usize],
                whole.layers[0].data[(61 * (y + 9) + x + 13) as usize]
            );
        }
    }
}

#[test]
fn an_even_light_is_even_through_every_filter_and_however_many_samples() {
    let lit = |rest: &str| {
        film(&format!(
            "camera(eye: [0, -5, 0], look_at: [0, 0, 0], height: 2, kind: \"orthographic\")
             light(color: #000)
             render(size: [6, 6], tone: \"none\", {rest})
             draw plane(z: 0).rotate_x(90deg).with(emissive(rgb(0.7, 0.2, 0.3)))"
        ))
    };
    for filter in ["box", "tent", "gauss", "mitchell"] {
        for samples in [1, 2, 4, 16, 61] {
            let film = lit(&format!("samples: {samples}, filter: \"{filter}\""));
            // Two samples of opposite weight leave a pixel to chance; whole sequences do not.
            let allowed = if filter == "mitchell" && samples < 16 { 2.0 } else { 1e-6 };
            for p in &film.rgba {
                assert!(
                    (p[0] - 0.7).abs() <= allowed && (p[3] - 1.0).abs() <= allowed,
                    "{filter} {samples} {p:?}"
                );
            }
        }
    }
    for p in &lit("samples: 65536").rgba {
        assert_eq!(p[..3], [0.7, 0.2, 0.3]);
    }
}

#[test]
fn every_filter_keeps_the_light_and_blurs_as_far_as_it_reaches() {
    // A bright slab's edge runs through the middle of the picture, at the border of two pixels.
    let edge = |filter: &str| {
        film(&format!(
            "camera(eye: [0, -5, 0], look_at: [0, 0, 0], height: 8, kind: \"orthographic\")
             render(size: [8, 8], samples: 4096, integrator: \"flat\", tone: \"none\", filter: \"{filter}\")
             draw box([0, 0, -9], [9, 1, 9]).with(matte(rgb(1, 1, 1)))"
        ))
    };
    for (filter, reach) in [("box", 0), ("tent", 1), ("gauss", 1), ("mitchell", 2)] {
        let film = edge(filter);
        assert!((mean(&film, 0).0 - 0.5).abs() < 2e-3, "{filter}");
        for x in 0..8 {
            let value = film.pixel(x, 4)[0];
            let far = if x < 4 { 3 - x } else { x - 4 };
            let flat = if x < 4 { 0.0 } else { 1.0 };
            assert_eq!((value - flat).abs() < 5e-3, reach <= far, "{filter} {x}: {value}");
        }
    }
}

#[test]
fn a_checker_is_where_it_is_said_to_be_also_on_cuts() {
    let film = film(
        "camera(eye: [0, 0, 5], look_at: [0, 0, 0], up: [0, 1, 0], height: 4, kind: \"orthographic\")
         render(size: [8, 8], samples: 1, integrator: \"flat\", tone: \"none\")
         draw (box([-2, -2, -1.5], [2, 2, 1]) - box([0, -2, 0.25], [2, 2, 2]))
             .with(matte(rgb(1, 1, 1), pattern: \"checker\", color2: rgb(0, 0, 0), grain: 1))",
    );
    for y in 0..8 {
        for x in 0..8 {
            // Two pixels a cell; the left half is at height 1, on the border of cells, the right at 0.25, the cell below.
            let (i, j) = ((x as i32) / 2 - 2, 1 - (y as i32) / 2);
            if x < 4 {
                continue;
            }
            assert_eq!(film.pixel(x, y)[0], if (i + j) % 2 == 0 { 1.0 } else { 0.0 }, "{x} {y}");
        }
    }
}
