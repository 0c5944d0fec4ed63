//! Every primitive under every operator: beside a fixed ball its union, intersection, difference, symmetric difference, complement
//! (in a box, cut open) and clip, side by side, with a number that a formula knows.

use std::f64::consts::PI;

use super::{Golden, LIGHT};

const CAMERA: &str = "camera(eye: [4, -20, 8], look_at: [0, 0, 0], height: 7, kind: \"orthographic\")\n";

/// The box around each, in which complements and what has no end are shown.
const SIZE: f64 = 2.6;

/// A primitive as it is drawn.
pub struct Subject {
    /// The scene's name: the primitive's word first.
    pub name: &'static str,
    /// The primitive, about the origin, within the box where it has an end.
    pub text: String,
    /// Whether it has an end.
    pub bounded: bool,
    /// Lines that say what a formula knows of `p`, which is the primitive, `b`, the ball, and `c`, the box.
    pub expects: String,
}

fn subject(name: &'static str, text: &str, volume: f64) -> Subject {
    let expects = format!("expect volume(p & b) + volume(p - b) ~= {volume} within 0.1%\n");
    Subject { name, text: text.to_owned(), bounded: true, expects }
}

fn unbounded(name: &'static str, text: &str, volume: f64) -> Subject {
    let expects = format!("expect volume(p & c) ~= {volume} within 0.1%\n");
    Subject { name, text: text.to_owned(), bounded: false, expects }
}

/// One whose volume takes long to find: it is held by where lines along x at y and z go in and out.
fn slow(name: &'static str, text: &str, chords: &[[f64; 3]], within: f64) -> Subject {
    let chord = |[y, z, half]: &[f64; 3]| {
        let hits = format!("raycast(p, from: [-3, {y}, {z}], dir: [1, 0, 0])");
        format!(
            "expect {hits}[0].t ~= {} within {within}\nexpect {hits}[1].t ~= {} within {within}\n",
            3.0 - half,
            3.0 + half
        )
    };
    Subject { name, text: text.to_owned(), bounded: true, expects: chords.iter().map(chord).collect() }
}

/// The volume of an outline's points (distance from the axis, height) turned about it: frusta, signed.
fn turned(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let frustum = |([r, a], [s, b]): (&[f64; 2], &[f64; 2])| (r * r + r * s + s * s) * (b - a);
    (PI / 3.0 * outline.iter().zip(next).map(frustum).sum::<f64>()).abs()
}

/// The beta function.
fn beta(x: f64, y: f64) -> f64 {
    libm::tgamma(x) * libm::tgamma(y) / libm::tgamma(x + y)
}

/// A superellipsoid of unit reach (A. Jaklič and others, Segmentation and Recovery of Superquadrics, 2.4, whose exponents are named
/// the other way round): `e1` across z, `e2` along it.
fn superellipsoid(e1: f64, e2: f64) -> f64 {
    2.0 * e1 * e2 * beta(0.5 * e2 + 1.0, e2) * beta(0.5 * e1, 0.5 * e1)
}

/// The part of a cube of side s about the origin where n . x < d: an average over eight corners, by the inclusion and exclusion of
/// the parts cut off beyond each.
fn cut_cube(s: f64, n: [f64; 3], d: f64) -> f64 {
    let corner = |bits: u32| {
        let at = |i: usize| if bits >> i & 1 == 0 { -0.5 * s } else { 0.5 * s };
        let below = d - (0..3).map(|i| n[i] * at(i)).sum::<f64>();
        let sign = if bits.count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * below.max(0.0).powi(3)
    };
    (0..8).map(corner).sum::<f64>() / (6.0 * n[0] * n[1] * n[2])
}

/// Greys of the height field's columns, of 255; all rows are alike, so that its volume is that of trapezoids.
const GREYS: [u8; 6] = [40, 200, 120, 255, 90, 160];

/// A PNG of the greys, four rows of them.
pub fn hills() -> Vec<u8> {
    let mut png = std::io::Cursor::new(Vec::new());
    let image = image::GrayImage::from_raw(6, 4, GREYS.repeat(4)).unwrap();
    image.write_to(&mut png, image::ImageFormat::Png).unwrap();
    png.into_inner()
}

/// An octahedron of unit reach, a little out of true.
pub const OCTAHEDRON: &str = "\
v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0.2 0.1 1\nv 0 0 -1
f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6
";

/// All primitives, some of them twice.
pub fn subjects() -> Vec<Subject> {
    let ball = |r: f64| 4.0 / 3.0 * PI * r.powi(3);
    // A box of 1.6 x 1.2 x 1 within the rounding, its faces moved out, quarter cylinders along its edges, a ball in its corners.
    let [a, b, c, r] = [1.6, 1.2, 1.0, 0.2f64];
    let rounded = a * b * c + 2.0 * r * (a * b + b * c + c * a) + PI * r * r * (a + b + c) + ball(r);
    // Two capsules of length l that meet at a right angle share the joint's ball but a quarter, in its place that of two cylinders'.
    let [l, s] = [1.4, 0.3f64];
    let bent = 2.0 * (PI * s * s * l + ball(s)) - PI * s.powi(3) - 4.0 / 3.0 * s.powi(3);
    let profile = [[0.0, -1.0], [0.9, -1.0], [0.3, 0.0], [0.6, 0.6], [0.0, 1.0]];
    let greys = GREYS.windows(2).map(|w| (f64::from(w[0]) + f64::from(w[1])) / 510.0).sum::<f64>();
    let quartic = |y: f64, z: f64| [y, z, (1.0 - y.powi(4) - z.powi(4)).powf(0.25)];
    let round = |y: f64, z: f64| [y, z, (0.81 - y * y - z * z).sqrt()];
    vec![
        subject("box", "box([-1, -0.8, -0.6], [1, 0.8, 0.6])", 3.84),
        subject("box-round", "box(size: [2, 1.6, 1.4], round: 0.2)", rounded),
        subject("sphere", "sphere(r: 0.9)", ball(0.9)),
        subject("sphere-ellipsoid", "sphere(r: [1, 0.8, 0.7])", ball(1.0) * 0.56),
        subject("cylinder", "cylinder(r: 0.7, from: [0, -0.6, -0.8], to: [0, 0.6, 0.8])", PI * 0.49 * 2.0),
        subject(
            "cone",
            "cone(r1: 1, r2: 0.4, from: [0, 0, -1], to: [0, 0, 1])",
            PI / 3.0 * 2.0 * (1.0 + 0.4 + 0.16),
        ),
        subject(
            "capsule",
            "capsule(r: 0.5, from: [-0.6, 0, -0.3], to: [0.6, 0, 0.2])",
            PI * 0.25 * 1.3 + ball(0.5),
        ),
        subject("tube", "tube([[-0.8, 0.6, 0], [0.6, 0.6, 0], [0.6, -0.8, 0]], r: 0.3)", bent),
        subject("torus", "torus(major: 0.7, minor: 0.3)", 2.0 * PI * PI * 0.7 * 0.09),
        Subject {
            expects: format!("expect volume(p) ~= {} within 0.1%\n", 0.72 * superellipsoid(0.4, 1.6)),
            ..subject("superellipsoid", "superellipsoid(r: [1, 0.8, 0.9], e1: 0.4, e2: 1.6)", 0.0)
        },
        // x^2 + y^2 < z^2 + 0.09 up to |z| of 0.9.
        Subject {
            bounded: true,
            ..subject(
                "quadric",
                "(quadric(squares: [1, 1, -1], constant: -0.09) & box(size: [2.4, 2.4, 1.8]))",
                2.0 * PI * (0.243 + 0.081),
            )
        },
        subject(
            "extrude",
            "extrude([[[-1, -1], [1, -1], [1, 0], [0, 0], [0, 1], [-1, 1]], \
             [[-0.7, -0.7], [-0.2, -0.7], [-0.2, -0.2], [-0.7, -0.2]]], h: 1.2, twist: 20deg).move([0, 0, -0.6])",
            1.2 * 2.75,
        ),
        unbounded("half_space", "half_space(x + 2*y + 3*z < 0.5)", cut_cube(SIZE, [1.0, 2.0, 3.0], 0.5)),
        subject(
            "heightfield",
            "heightfield(\"greys.png\", size: [2, 1.6, 1.2]).move([0, 0, -0.6])",
            greys * 0.4 * 1.6 * 1.2,
        ),
        // Two pyramids over a square of area 2, both one high.
        subject("mesh", "mesh(\"octahedron.obj\")", 4.0 / 3.0),
        slow(
            "implicit",
            "implicit(x**4 + y**4 + z**4 <= 1, inside: box(size: 2.2))",
            &[quartic(0.2, 0.1), quartic(-0.8, 0.7), quartic(0.3, -0.9)],
            1e-9,
        ),
        unbounded("plane-thick", "plane(z: 0.1).thicken(0.5)", 0.5 * SIZE * SIZE),
        slow(
            "points",
            "points(sphere(r: 0.9), samples: 1000)",
            &[round(0.2, 0.1), round(-0.5, 0.3), round(0.1, -0.6)],
            0.01,
        ),
        subject("revolve", "revolve([[0, -1], [0.9, -1], [0.3, 0], [0.6, 0.6], [0, 1]])", turned(&profile)),
    ]
}

fn scene(s: &Subject) -> String {
    let Subject { text, bounded, expects, .. } = s;
    let end = if *bounded { "" } else { " & c" };
    format!(
        "{CAMERA}{LIGHT}\
let p = {text}.with(red)
let b = sphere(r: 0.8, at: [0.4, -0.5, 0.3]).with(blue)
let c = box(size: {SIZE})
fn place(s, x, z) = s.move([3 * x, 0, 1.5 * z])
draw place((p | b){end}, -1, 1)
draw place((p & b){end}, 0, 1)
draw place((p - b){end}, 1, 1)
draw place((p ^ b){end}, -1, -1)
draw place(!p & c & half_space(y > 0), 0, -1)
draw place(p, 1, -1).clip(place(b, 1, -1))
{expects}"
    )
}

/// Sheets know unions and clips only.
fn sheets() -> Golden {
    let text = format!(
        "{CAMERA}{LIGHT}\
let b = sphere(r: 1, at: [0.4, -0.5, 0.3]).with(blue)
draw plane(z: -2)
draw (plane(z: 0.1).with(red) | plane(y: 0.2)).clip(b)
draw b.move([3, 0, 1]).clip(half_space(z < 1))
// A disc.
expect area(plane(z: 0.1).clip(b)) ~= {} within 1%
",
        PI * 0.96
    );
    Golden::new("primitives/plane", text)
}

/// All scenes.
pub fn scenes() -> Vec<Golden> {
    let scene = |s: &Subject| Golden::new(format!("primitives/{}", s.name), scene(s));
    let mut all: Vec<Golden> = subjects().iter().map(scene).collect();
    all.push(sheets());
    all
}

/// The files that scenes read, by their names in the folder.
pub fn assets() -> [(&'static str, Vec<u8>); 3] {
    [
        ("primitives/greys.png", hills()),
        ("primitives/octahedron.obj", OCTAHEDRON.as_bytes().to_vec()),
        ("cases/bowl.ply", super::cases::bowl()),
    ]
}
