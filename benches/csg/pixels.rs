//! What pictures must not show: pixels that change with the scale of a scene, speckles far from the origin, and artefacts by
//! another program that knows the picture in closed form.

use std::process::Command;

use crate::commands::{folder, is_there, kit, peer_scene, pss, scene};
use crate::table::Row;

/// A die with dimples, a bored block and a torus on a floor, all lengths times `s`, all places moved by `to`.
fn still(s: f64, to: [f64; 3]) -> String {
    let at = |p: [f64; 3]| {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|i| s * p[i] + to[i]);
        format!("[{x:?}, {y:?}, {z:?}]")
    };
    let l = |x: f64| format!("{:?}", s * x);
    format!(
        "camera eye(eye: {}, look_at: {}, fov: 40deg)
         light(at: {}, falloff: false)
         render(size: [400, 300], samples: 1, integrator: \"direct\", tone: \"none\")
         draw (difference(box({}, {}) & sphere(r: {}, at: {}), [sphere(r: {}, at: {})])).with(matte(#c04030))
         draw (box({}, {}) - cylinder(r: {}, from: {}, to: {})).with(matte(#4060c0))
         draw torus(major: {}, minor: {}).move({}).with(matte(#d0a020))
         draw half_space(normal: [0, 0, 1], at: {}).with(matte(#808080))",
        at([5.0, -6.0, 4.0]),
        at([0.5, 0.0, 0.0]),
        at([3.0, -8.0, 9.0]),
        at([-1.0, -1.0, -1.0]),
        at([1.0, 1.0, 1.0]),
        l(1.35),
        at([0.0, 0.0, 0.0]),
        l(0.3),
        at([0.0, -1.0, 0.0]),
        at([1.5, -1.0, -1.0]),
        at([3.0, 1.0, 0.5]),
        l(0.4),
        at([2.25, 0.0, -1.0]),
        at([2.25, 0.0, 0.5]),
        l(0.6),
        l(0.2),
        at([-1.5, -1.6, -0.8]),
        at([0.0, 0.0, -1.0]),
    )
}

/// Its pixels, as bytes.
fn picture(s: f64, to: [f64; 3]) -> Option<Vec<u8>> {
    let path = scene("still.pss", &still(s, to));
    let done = Command::new("sh").args(["-c", &pss(&path, "")]).status().is_ok_and(|s| s.success());
    let image = image::open(folder().join("out.png")).ok().filter(|_| done)?;
    Some(image.to_rgb8().into_raw())
}

/// Pixels of which a channel differs by more than `most`.
fn differing(a: Option<&Vec<u8>>, b: Option<&Vec<u8>>, most: u8) -> f64 {
    let (Some(a), Some(b)) = (a, b) else { return f64::NAN };
    let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| most < a.abs_diff(*b));
    a.chunks(3).zip(b.chunks(3)).filter(differs).count() as f64
}

/// One scene at other scales and far from the origin.
pub fn scales(rows: &mut Vec<Row>) {
    let here = picture(1.0, [0.0; 3]);
    for power in [-30, 30] {
        let there = picture(2f64.powi(power), [0.0; 3]);
        let count = differing(here.as_ref(), there.as_ref(), 0);
        rows.push(Row::new(format!("pixels of 120,000 that differ at 2^{power}"), count, "pixels", "0"));
    }
    let far = picture(1.0, [1e7, -0.7e7, 0.3e7]);
    let count = differing(here.as_ref(), far.as_ref(), 2);
    let what = "the same at an offset of 1e7, by more than 2 of 255, edges included";
    rows.push(Row::new(what, count, "pixels", "no speckle"));
}

/// Artefact pixels of faces that coincide, as the kit's closed-form program counts them.
pub fn artefacts(rows: &mut Vec<Row>) {
    let name = "s7a_coincident";
    let ready = is_there("python3")
        && Command::new("python3").args(["-c", "import numpy, PIL"]).status().is_ok_and(|s| s.success());
    let Some(path) = peer_scene(name).filter(|_| ready) else {
        eprintln!("skipped: Python with numpy and Pillow or ../shared/peers is not there");
        return;
    };
    let rendered = Command::new("sh").args(["-c", &pss(&path, "--size 800x600")]).status();
    let count = |text: String| {
        let digits = text.split("ARTEFACT pixels ").nth(1)?.split_whitespace().next()?;
        digits.parse::<f64>().ok()
    };
    let oracle = Command::new("python3")
        .arg(kit().join("oracle.py"))
        .arg(kit().join(format!("json/{name}.json")))
        .arg(folder().join("out.png"))
        .arg("--srgb")
        .output();
    let told = oracle.ok().and_then(|o| count(String::from_utf8_lossy(&o.stdout).into_owned()));
    let told = told.filter(|_| rendered.is_ok_and(|s| s.success())).unwrap_or(f64::NAN);
    rows.push(Row::new(format!("{name}, artefact pixels of 480,000"), told, "pixels", "0 (POV-Ray: 31,441)"));
}
