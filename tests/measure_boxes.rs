//! Boxes and emptiness of what is clipped, turned, or given by a formula, against closed forms.

use glam::{DVec3, dvec3};
use measure_support::answers;
use pss::geom::Aabb;
use pss::lang::{Extent, Geometry, Measured};

mod measure_support;

fn bounds(shape: &str) -> Extent {
    answers(shape, &[0], |m, asked| m.bounds(asked).unwrap()).remove(0)
}

fn is_empty(shape: &str) -> bool {
    answers(shape, &[0], |m, asked| m.is_empty(asked).unwrap()).remove(0)
}

fn volume(shape: &str) -> Measured {
    answers(shape, &[0], |m, asked| m.volume(asked).unwrap()).remove(0)
}

/// How far the sides of a box are off.
fn off(found: &Aabb, min: DVec3, max: DVec3) -> f64 {
    (found.min - min).abs().max((found.max - max).abs()).max_element()
}

#[test]
fn boxes_of_formulas_are_around_them_and_as_tight_as_their_bars_say() {
    let one = DVec3::ONE;
    let far = dvec3(3.3, 1.7, 2.1);
    let third = 1.0f64 / 3.0;
    for (formula, size, min, max, share) in [
        ("x**2 + y**2 + z**2 <= 1", 100, -one, one, 1e-7),
        ("x**2 + y**2 + z**2 <= 1", 60, -one, one, 1e-7),
        ("(x - 3.3)**2 + (y - 1.7)**2 + (z - 2.1)**2 <= 1", 100, far - one, far + one, 1e-7),
        (
            "(x - 12.3)**2 + (y - 4.5)**2 + (z - 6.7)**2 <= 0.0001",
            90,
            dvec3(12.29, 4.49, 6.69),
            dvec3(12.31, 4.51, 6.71),
            1e-7,
        ),
        // Terms that share coordinates, and an edge: of x^2 + x y + y^2 <= 1 x reaches 2 / sqrt 3. Intervals tell it less well.
        (
            "max(x**2 + x*y + y**2 - 1, abs(z) - 1) <= 0",
            50,
            dvec3(-2.0 * third.sqrt(), -2.0 * third.sqrt(), -1.0),
            dvec3(2.0 * third.sqrt(), 2.0 * third.sqrt(), 1.0),
            2e-3,
        ),
        // It fills its box to some sides.
        ("x + y + z <= 0", 2, -one, one, 1e-7),
    ] {
        let shape = format!("implicit({formula}, inside: box(size: {size}))");
        let Extent { bounds, err } = bounds(&shape);
        assert!(err < share && off(&bounds, min, max) <= err + 1e-14, "{shape} {bounds:?} {err}");
        let around = bounds.min.cmple(min + 1e-15).all() && bounds.max.cmpge(max - 1e-15).all();
        assert!(around, "{shape} {bounds:?}");
    }
    let turned = "implicit(4*x**2 + y**2 + z**2 <= 1, inside: box(size: 10)).rotate_z(30deg)";
    let Extent { bounds, err } = bounds(turned);
    // The image of the unit ball reaches the length of a row.
    let (s, c) = 30f64.to_radians().sin_cos();
    let reach = dvec3((0.5 * c).hypot(s), (0.5 * s).hypot(c), 1.0);
    assert!(err < 1e-6 && off(&bounds, -reach, reach) <= err + 1e-14, "{bounds:?} {err}");
}

#[test]
fn what_is_small_in_its_box_is_not_nothing() {
    let ball = volume("implicit(x**2 + y**2 + z**2 <= 0.01, inside: box(size: 100))");
    let truth = 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
    assert!((ball.value - truth).abs() <= ball.err && ball.err < 1e-3 * truth, "{ball:?}");
    let pore = "implicit((x-12.3)**2 + (y-4.5)**2 + (z-6.7)**2 <= 0.0001, inside: box(size: 90))";
    let whole = "box(size: 100)";
    assert!(!is_empty(&format!("({whole} - ({whole} - {pore}))")));
    assert!(!is_empty(&format!("({whole} ^ ({whole} - {pore}))")));
    // Two balls far apart in one box: no line of a grid sees either, and the bar says so.
    let two = "implicit(min((x+40.3)**2 + (y-31)**2 + (z+33)**2, (x-39)**2 + (y+34)**2 + (z-35)**2) <= 0.0001, inside: box(size: 100))";
    let found = volume(two);
    assert!((found.value - 2.0 * truth * 1e-3).abs() <= found.err, "{found:?}");
}

#[test]
fn boxes_of_what_is_clipped_are_those_of_what_is_left() {
    for (shape, min, max, share) in [
        ("sphere(r: 1).clip(half_space(z < 0))", -DVec3::ONE, dvec3(1.0, 1.0, 0.0), 1e-6),
        ("plane(z: 0).clip(box([0, 0, -1], [1, 1, 2]))", DVec3::ZERO, dvec3(1.0, 1.0, 0.0), 0.0),
        (
            "points(sphere(r: 1), samples: 2000).clip(half_space(z < 0))",
            -DVec3::ONE,
            dvec3(1.0, 1.0, 0.0),
            1e-2,
        ),
        // What is left of the ball's face is a cap, and its rim is where both balls' faces meet.
        (
            "sphere(r: 1).clip(sphere(r: 1, at: [0, 0, 1]))",
            dvec3(-0.75f64.sqrt(), -0.75f64.sqrt(), 0.5),
            dvec3(0.75f64.sqrt(), 0.75f64.sqrt(), 1.0),
            1e-3,
        ),
        (
            "sphere(r: 1).clip(half_space(z < 0)).fit([0, 0, 0], height: 10)",
            dvec3(-10.0, -10.0, 0.0),
            dvec3(10.0, 10.0, 10.0),
            1e-6,
        ),
    ] {
        let found = bounds(shape);
        assert!(off(&found.bounds, min, max) <= share + found.err, "{shape} {found:?}");
        assert!(!is_empty(shape), "{shape}");
    }
    for shape in [
        "sphere(r: 1).clip(half_space(z > 2))",
        "sphere(r: 1).clip(box(size: 1))",
        "plane(z: 0).clip(box([0, 0, 1], [1, 1, 2]))",
    ] {
        assert!(is_empty(shape), "{shape}");
    }
    assert!(!is_empty("plane(z: 0)"));
}

#[test]
fn boxes_of_turned_extrusions_are_those_of_the_ways_of_their_corners() {
    let square = "[[-1, -1], [1, -1], [1, 1], [-1, 1]]";
    let root = 2f64.sqrt();
    for (shape, min, max) in [
        (format!("extrude({square}, h: 2, twist: 90deg)"), dvec3(-root, -root, 0.0), dvec3(root, root, 2.0)),
        (format!("extrude({square}, h: 2, twist: 300deg)"), dvec3(-root, -root, 0.0), dvec3(root, root, 2.0)),
        (
            "extrude([[0, 0], [1, 0], [0, 1]], h: 1, twist: 90deg)".to_owned(),
            dvec3(-1.0, 0.0, 0.0),
            dvec3(1.0, 1.0, 1.0),
        ),
        // Shrunk by a tenth on the way: (1 - z / 10) cos(pi z / 2 + pi / 4) and so on, at the ends and where slopes are zero.
        (
            format!("extrude({square}, h: 1, twist: 90deg, scale: 0.9)"),
            dvec3(-shrunk(0.25), -shrunk(0.25), 0.0),
            dvec3(shrunk(0.25), shrunk(0.25), 1.0),
        ),
    ] {
        let found = bounds(&shape);
        assert!(found.err == 0.0 && off(&found.bounds, min, max) < 1e-12, "{shape} {found:?} {max}");
    }
}

/// The largest (1 - z / 10) sqrt 2 cos(pi / 2 (z - 1 / 2)), by Newton's steps to where its slope is zero.
fn shrunk(mut z: f64) -> f64 {
    let w = std::f64::consts::FRAC_PI_2;
    for _ in 0..50 {
        let (s, c) = (w * (z - 0.5)).sin_cos();
        let slope = -0.1 * c - (1.0 - 0.1 * z) * w * s;
        z -= slope / (0.2 * w * s - (1.0 - 0.1 * z) * w * w * c);
    }
    (1.0 - 0.1 * z) * 2f64.sqrt() * (w * (z - 0.5)).cos()
}
