//! Boxes around shapes made of unbounded ones: what a view without a camera fits, and `.fit` measures.

mod csg_support;

use csg_support::scene::prepared;
use glam::{DVec3, dvec3};
use pss::geom::Aabb;

fn bounds(shape: &str) -> Aabb {
    prepared(&format!("draw {shape}")).outline.parts[0].bounds
}

const CUBE: &str = "(half_space(x > 0) & half_space(x < 1) & half_space(y > 0) & half_space(y < 2) & half_space(z > 0) & half_space(z < 3))";

#[test]
fn half_spaces_along_the_axes_bound_what_they_make_together() {
    for (shape, min, max) in [
        (CUBE.to_owned(), [0.0, 0.0, 0.0], [1.0, 2.0, 3.0]),
        (format!("{CUBE}.move([100, 0, 0])"), [100.0, 0.0, 0.0], [101.0, 2.0, 3.0]),
        (format!("{CUBE}.scale([2, 1, -1])"), [0.0, 0.0, -3.0], [2.0, 2.0, 0.0]),
        (format!("{CUBE}.rotate_z(90deg)"), [-2.0, 0.0, 0.0], [0.0, 1.0, 3.0]),
        ("!(half_space(x < 5) | half_space(x > 6) | half_space(y < 0) | half_space(y > 1) | !(half_space(z < 1) & half_space(z > 0)))".to_owned(), [5.0, 0.0, 0.0], [6.0, 1.0, 1.0]),
        ("!(!box([100, 0, 0], [101, 1, 1]))".to_owned(), [100.0, 0.0, 0.0], [101.0, 1.0, 1.0]),
        ("half_space(x > 0) & half_space(y > 0) & half_space(z > 0) & sphere(r: 1)".to_owned(), [0.0; 3], [1.0; 3]),
        ("difference(half_space(x > 0), [half_space(x > 1), half_space(y < 0), half_space(y > 1), half_space(z < 0), half_space(z > 1)])".to_owned(), [0.0; 3], [1.0; 3]),
        (format!("implicit(x < 0.5, inside: {CUBE})"), [0.0; 3], [0.5, 2.0, 3.0]),
    ] {
        let have = bounds(&shape);
        let near = |a: DVec3, b: [f64; 3]| (a - DVec3::from_array(b)).abs().max_element() < 1e-12;
        assert!(near(have.min, min) && near(have.max, max), "{shape}: {have:?}");
    }
}

#[test]
fn what_has_no_end_has_none_on_that_side_alone() {
    let open = bounds("(half_space(x > 0) & half_space(y < 1)).move([1, 1, 1])");
    assert_eq!(
        (open.min, open.max),
        (dvec3(1.0, f64::NEG_INFINITY, f64::NEG_INFINITY), dvec3(f64::INFINITY, 2.0, f64::INFINITY))
    );
    for shape in [
        "half_space(normal: [1, 1, 0], at: [0, 0, 0])",
        "!sphere(r: 1)",
        "half_space(x > 0) ^ half_space(x > 1)",
    ] {
        assert!(!bounds(shape).is_finite(), "{shape}");
    }
    let turned = bounds("(half_space(x > 0) & half_space(x < 1)).rotate_z(45deg)");
    assert!(!turned.is_finite() && !turned.min.is_nan() && !turned.max.is_nan(), "{turned:?}");
}

/// One solid has one box, however its cut is written.
#[test]
fn a_difference_has_the_box_of_the_intersection_with_the_complement() {
    for cut in ["half_space(z < 0)", "half_space(x > 1) | half_space(y > 2)"] {
        let [a, b] = ["(sphere(r: 5) - (K))", "(sphere(r: 5) & !(K))"].map(|s| bounds(&s.replace('K', cut)));
        assert_eq!(a, b, "{cut}");
    }
    let half = bounds("(sphere(r: 5) - half_space(z < 0)).fit([100, 0, 0], height: 10)");
    assert!((half.min - dvec3(90.0, -10.0, 0.0)).length() < 1e-9, "{half:?}");
}
