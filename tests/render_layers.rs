//! Layers of facts, against closed forms.

mod picture_common;

use picture_common::shot;
use pss::film::{Aov, Film};

fn film_on(text: &str, threads: usize) -> Film {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| pss::render::render(&shot(text), &Default::default()).unwrap().film)
}

/// A hollow ball, a pair of slabs with one front and a floor, from in front.
const SCENE: &str = "
    camera(eye: [0, -9, 0], look_at: [0, 0, 0], height: 4, kind: \"orthographic\")
    render(size: [41, 41], samples: 4, integrator: \"flat\", filter: \"gauss\", aov: [
        \"owner\", \"leaf\", \"layers\", \"thickness\", \"wall\", \"ties\", \"parity_repairs\", \"projections\", \"cost\", \"variance\", \"samples\"])
    draw sphere(r: 1) - sphere(r: 0.5)
    draw [box([1.2, -1, -1], [1.8, 0, 1]), box([1.2, -1, -1], [1.8, 2, 1])]
    draw plane(z: -1.5)";

#[test]
fn layers_count_and_measure_what_lies_along_the_centre_ray() {
    let film = film_on(SCENE, 1);
    let at = |aov: Aov, x: u32, y: u32| film.layer(aov).unwrap().data[(41 * y + x) as usize];
    let near = |a: f32, b: f64| (f64::from(a) - b).abs() < 1e-6;
    // Through the middle: two walls of a half.
    assert_eq!(at(Aov::Layers, 20, 20), 2.0);
    assert!(near(at(Aov::Thickness, 20, 20), 1.0) && near(at(Aov::Wall, 20, 20), 0.5));
    assert_eq!((at(Aov::Owner, 20, 20), at(Aov::Leaf, 20, 20)), (1.0, 1.0));
    // 0.8 aside: a chord of the outer ball alone.
    let x = 20 + (0.78_f64 / (4.0 / 41.0)).round() as u32;
    let aside = f64::from(x - 20) * 4.0 / 41.0;
    assert_eq!(at(Aov::Layers, x, 20), 1.0);
    assert!(near(at(Aov::Thickness, x, 20), 2.0 * (1.0 - aside * aside).sqrt()));
    // The slabs are one solid to a ray; the face is that of the first.
    let x = 20 + (1.5_f64 / (4.0 / 41.0)).round() as u32;
    assert_eq!((at(Aov::Layers, x, 20), at(Aov::Owner, x, 20)), (1.0, 2.0));
    assert!(near(at(Aov::Thickness, x, 20), 3.0));
    assert!(0.0 < at(Aov::Ties, x, 20));
    // Above there is nothing.
    for aov in [Aov::Owner, Aov::Leaf, Aov::Layers, Aov::Thickness, Aov::Wall] {
        assert_eq!(at(aov, 2, 2), 0.0, "{aov:?}");
    }
    assert_eq!(at(Aov::Samples, 2, 2), 4.0);
    // Ids are never mixed, whatever the filter.
    assert!(film.layer(Aov::Owner).unwrap().data.iter().all(|id| id.fract() == 0.0));
}

#[test]
fn a_scan_drawn_alone_has_the_inside_that_it_was_measured_to_have() {
    let text = "
        camera(eye: [0, -10, 0], look_at: [0, 0, 0], height: 3, kind: \"orthographic\")
        render(size: [9, 9], samples: 1, integrator: \"flat\", aov: [\"layers\", \"thickness\", \"wall\"])
        draw points(sphere(r: 1), samples: 3000, seed: 1)";
    let film = film_on(text, 1);
    let at = |aov: Aov| f64::from(film.layer(aov).unwrap().data[9 * 4 + 4]);
    assert_eq!(at(Aov::Layers), 1.0);
    assert!((at(Aov::Thickness) - 2.0).abs() < 1e-2 && at(Aov::Wall) == at(Aov::Thickness));
}

#[test]
fn owners_are_numbered_as_written_and_no_two_leaves_have_one_number() {
    let text = "
        camera(eye: [0, -10, 0], look_at: [0, 0, 0], height: 8, kind: \"orthographic\")
        render(size: [8, 8], samples: 1, integrator: \"flat\", aov: [\"owner\", \"leaf\"])
        draw plane(y: 2).clip(box([-4, -9, -4], [-2, 9, 4]))
        draw box([-2, 0, -4], [0, 1, 4])
        draw plane(y: 2).clip(box([0, -9, -4], [2, 9, 4]))
        draw box([2, 0, -4], [4, 1, 4])";
    let film = film_on(text, 1);
    let row = |aov: Aov| [0, 2, 4, 6].map(|x| film.layer(aov).unwrap().data[8 * 4 + x]);
    assert_eq!(row(Aov::Owner), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(row(Aov::Leaf), [3.0, 1.0, 4.0, 2.0]);
}

#[test]
fn what_a_pixel_is_charged_for_is_the_same_on_any_number_of_threads() {
    let text = "
        camera(eye: [0, -4, 1], look_at: [0, 0, 0], fov: 30deg)
        render(size: [40, 40], samples: 16, aov: [\"projections\", \"cost\", \"parity_repairs\"])
        draw points(sphere(r: 1), samples: 2000) - box([0, -2, 0], [2, 2, 2])";
    let one = film_on(text, 1);
    assert!(one.layer(Aov::Cost).unwrap().data.iter().any(|c| 100.0 < *c));
    for threads in [2, 5] {
        assert_eq!(one, film_on(text, threads), "{threads}");
    }
}
