//! Golden dumps and pictures of every operator, on analytic solids and on scans.
//!
//! Each scene has a number that a formula knows, so that a wrong golden cannot be blessed unseen, and goldens are shown
//! to fail where an operator is another. `PSS_BLESS=1 cargo test --test goldens` rewrites them.

mod csg_support;

use std::f64::consts::PI;
use std::fs;
use std::sync::LazyLock;

use csg_support::golden::{blessing, dump, path, picture, volume};
use csg_support::scene::shot;
use pss::shot::Shot;

const VIEW: &str = "
material red(color: #c04030)
material blue(color: #3060c0)
camera(eye: [3, -4, 2.5], look_at: [0, 0, 0], height: 3.2, kind: \"orthographic\")
light(direction: [-1, 2, -3], intensity: 2)
light(color: #8090a0, intensity: 0.5)
render(size: [72, 54], samples: 4, integrator: \"direct\", tone: \"none\")
";

/// The operands: two balls, one apart, or scans of them; a third ball within both. A half-space cuts the view open in
/// [`text`], so that what is inside is seen.
fn balls(scans: bool) -> String {
    let of = |x: f64, r: f64| {
        let ball = format!("sphere(r: {r}, at: [{x}, 0, 0])");
        if scans { format!("points({ball}, samples: 1500)") } else { ball }
    };
    let [a, b, c] = [of(-0.5, 0.9), of(0.5, 0.9), of(0.0, 0.3)];
    format!("let a = {a}.with(red)\nlet b = {b}.with(blue)\nlet c = {c}\n")
}

/// The text of a golden's scene.
fn text(expr: &str, scans: bool) -> String {
    format!("{}{}let shown = {expr}\ndraw shown & half_space(y > 0)\n", VIEW.trim_start(), balls(scans))
}

fn ball(r: f64) -> f64 {
    4.0 / 3.0 * PI * r * r * r
}

/// What two balls of radius r at distance one have in common.
fn lens(r: f64) -> f64 {
    PI * (4.0 * r + 1.0) * (2.0 * r - 1.0).powi(2) / 12.0
}

/// Names, expressions over a, b, c, and their volumes in the box of side three, both halves.
fn scenes() -> Vec<(&'static str, &'static str, f64)> {
    let (one, common, small) = (ball(0.9), lens(0.9), ball(0.3));
    vec![
        ("union", "a | b", 2.0 * one - common),
        ("intersection", "a & b", common),
        ("difference", "a - b", one - common),
        ("xor", "a ^ b", 2.0 * (one - common)),
        ("complement", "!a & b", one - common),
        ("union-list", "union([a, b, c])", 2.0 * one - common),
        ("intersection-list", "intersection([a, b, c])", small),
        ("difference-list", "difference(a, [b, c])", one - common),
        ("xor-list", "xor([a, b, c])", 2.0 * (one - common) + small),
        ("outside", "(!a) & box(size: 3)", 27.0 - one),
        ("drilled", "(a | b) - cylinder(r: 0.3, from: [0, 0, -2], to: [0, 0, 2])", f64::NAN),
        ("halved", "(a | b) & half_space(z < 0)", one - 0.5 * common),
    ]
}

/// A scene of the goldens.
struct Golden {
    name: String,
    text: String,
    shot: Shot,
    volume: f64,
    scans: bool,
}

/// All scenes, prepared once: scans take their time.
static GOLDENS: LazyLock<Vec<Golden>> = LazyLock::new(|| {
    let mut all = Vec::new();
    for scans in [false, true] {
        for (name, expr, volume) in scenes() {
            if scans && !["union", "intersection", "difference", "xor", "difference-list"].contains(&name) {
                continue;
            }
            let name = format!("{name}{}", if scans { "-scans" } else { "" });
            let text = text(expr, scans);
            all.push(Golden { name, shot: shot(&text), text, volume: 0.5 * volume, scans });
        }
    }
    all
});

fn named(name: &str) -> &'static Golden {
    GOLDENS.iter().find(|g| g.name == name).unwrap()
}

/// The volume that the formula knows, by rays: analytic to the grid's own error, scans to theirs beside it.
#[test]
fn each_scene_has_the_volume_of_its_formula() {
    for Golden { name, shot, volume: want, scans, .. } in GOLDENS.iter().filter(|g| !g.volume.is_nan()) {
        let have = volume(shot, if *scans { 50 } else { 240 });
        let bound = if *scans { 0.02 } else { 0.004 };
        assert!((have - want).abs() <= bound * want, "{name}: {have}, by the formula {want}");
    }
}

/// Compares a golden with what is, or writes it.
fn golden(name: &str, suffix: &str, have: &[u8], wrong: &mut Vec<String>) {
    let path = path(name, suffix);
    if blessing() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, have).unwrap();
    } else if fs::read(&path).ok().as_deref() != Some(have) {
        wrong.push(format!("{name}.{suffix}"));
    }
}

const RAYS: usize = 120;

#[test]
fn spans_are_those_of_the_goldens() {
    let mut wrong = Vec::new();
    for Golden { name, text, shot, .. } in GOLDENS.iter() {
        golden(name, "pss", text.as_bytes(), &mut wrong);
        golden(name, "txt", dump(shot, RAYS).as_bytes(), &mut wrong);
    }
    assert!(wrong.is_empty(), "not as they were: {wrong:?}");
}

#[test]
fn pictures_are_those_of_the_goldens() {
    let mut wrong = Vec::new();
    for Golden { name, shot, .. } in GOLDENS.iter() {
        let (have, path) = (picture(shot), path(name, "png"));
        let [w, h] = shot.settings.size;
        if blessing() {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            image::save_buffer(&path, &have, w, h, image::ColorType::Rgb8).unwrap();
            continue;
        }
        let want = image::open(&path).map(|i| i.to_rgb8().into_raw()).unwrap_or_default();
        if have != want {
            wrong.push(name.clone());
        }
    }
    assert!(wrong.is_empty(), "not as they were: {wrong:?}");
}

/// Another operator is another dump and another picture: a golden can fail.
#[test]
fn every_swap_of_two_operators_changes_dump_and_picture() {
    for suffix in ["", "-scans"] {
        let names = ["union", "intersection", "difference", "xor"].map(|n| named(&format!("{n}{suffix}")));
        let made = names.map(|g| (&g.name, dump(&g.shot, RAYS), picture(&g.shot)));
        for (i, (name, spans, pixels)) in made.iter().enumerate() {
            for (other, other_spans, other_pixels) in &made[..i] {
                assert_ne!(spans, other_spans, "dumps of {name} and {other}");
                assert_ne!(pixels, other_pixels, "pictures of {name} and {other}");
            }
        }
    }
}
