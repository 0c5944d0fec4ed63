//! The scenes of each series.

use std::io::Write as _;
use std::path::PathBuf;

use glam::DVec3;
use pss::num::hash::Stream;

use crate::Series;
use crate::truth::Truth;

/// A scene to render.
pub struct Job {
    /// Where it is.
    pub scene: PathBuf,
    /// Options of the command.
    pub options: Vec<String>,
}

/// A folder for scenes, clouds and pictures.
pub fn folder() -> PathBuf {
    let folder = std::env::temp_dir().join("pss_size_bench");
    std::fs::create_dir_all(&folder).expect("a folder for temporary files");
    folder
}

fn job(name: &str, text: &str, options: &str) -> Job {
    let scene = folder().join(name);
    std::fs::write(&scene, text).expect("a file in the folder for temporary files");
    Job { scene, options: options.split_whitespace().map(String::from).collect() }
}

const EYE: &str = "camera eye(eye: [2.2, 1.8, 2.8], look_at: [0, 0, 0], up: [0, 1, 0], fov: 36deg)\n";
const LIGHT: &str = "light(at: [4, 5, 3], falloff: false)\n";

/// Samples of the blob of the peers' measurements, as a binary file that is kept for the next run. By golden angles: the R2
/// sequence of those measurements has holes for some numbers of samples, 316,000 among them.
fn cloud(points: u64) -> String {
    let name = format!("golden_{points}.ply");
    let path = folder().join(&name);
    if path.exists() {
        return name;
    }
    let properties: String =
        ["x", "y", "z", "nx", "ny", "nz"].map(|p| format!("property float {p}\n")).concat();
    let properties = properties.replacen("float", "double", 3);
    let head =
        format!("ply\nformat binary_little_endian 1.0\nelement vertex {points}\n{properties}end_header\n");
    let mut bytes = head.into_bytes();
    for i in 0..points {
        let (p, n) = sample(i, points);
        p.to_array().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        n.to_array().iter().for_each(|x| bytes.extend((*x as f32).to_le_bytes()));
    }
    // Under another name until it is whole: a file that is there is taken for done.
    let part = folder().join("part");
    let written = std::fs::File::create(&part).and_then(|mut file| file.write_all(&bytes));
    written.and_then(|()| std::fs::rename(&part, &path)).expect("a file in the folder for temporary files");
    name
}

/// The i-th of n samples, and the normal there.
fn sample(i: u64, n: u64) -> (DVec3, DVec3) {
    let z = 1.0 - (2 * i + 1) as f64 / n as f64;
    let turns = (i as f64 * 0.5 * (3.0 - 5f64.sqrt())).fract();
    let (sin, cos) = (std::f64::consts::TAU * turns).sin_cos();
    let across = (1.0 - z * z).sqrt();
    let d = DVec3::new(across * cos, across * sin, z);
    let p = (1.0 - Truth::Blob.implicit(d)) * d;
    (p, Truth::Blob.gradient(p).normalize())
}

/// A scan less a box, 256 x 256 first crossings, one thread.
fn points(size: u64) -> Job {
    let text = format!(
        "{EYE}render(size: [256, 256], samples: 1, integrator: \"depth\")
draw points(\"{}\", degree: 3, tolerance: 1e-7) - box([0.15, 0.2, 0.1], [3, 3, 3])\n",
        cloud(size)
    );
    job("points.pss", &text, "-t 1")
}

/// Balls strewn in a cube, their radius such that as much of it is full whatever their number, less one large ball.
fn leaves(size: u64) -> Job {
    let mut stream = Stream::new(size);
    let radius = 0.35 / (size as f64).cbrt();
    let mut ball = || {
        let mut axis = || 1.6 * stream.unit() - 0.8;
        format!("sphere(r: {radius:?}, at: [{:?}, {:?}, {:?}])", axis(), axis(), axis())
    };
    let balls: Vec<String> = (0..size).map(|_| ball()).collect();
    let text = format!(
        "{EYE}{LIGHT}render(size: [512, 512], samples: 1, integrator: \"direct\")
draw difference(union([{}]), [sphere(r: 0.5, at: [0.5, 0.5, 0.5])])\n",
        balls.join(", ")
    );
    job("leaves.pss", &text, "-t 1")
}

/// A scan of 100,000 points less a box, lit, of the given pixels and samples.
fn lit(name: &str, side: u64, samples: u64, threads: u64) -> Job {
    let text = format!(
        "{EYE}{LIGHT}render(size: [{side}, {side}], samples: {samples}, integrator: \"direct\")
draw points(\"{}\", degree: 3, tolerance: 1e-7) - box([0.15, 0.2, 0.1], [3, 3, 3])\n",
        cloud(100_000)
    );
    job(name, &text, &format!("-t {threads}"))
}

/// All series. `large`: up to ten million points.
pub fn all(large: bool) -> Vec<Series> {
    let mut many = vec![10_000, 31_600, 100_000, 316_000, 1_000_000];
    if large {
        many.extend([3_160_000, 10_000_000]);
    }
    let series = |name, of, sizes, scene| Series { name, of, sizes, scene };
    vec![
        series("points", "points of a scan", many, points),
        series("leaves", "leaves of an object", vec![1, 10, 100, 1000, 10_000], leaves),
        series("pixels", "pixels", [128, 256, 512, 1024].map(|side| side * side).to_vec(), |pixels| {
            lit("pixels.pss", pixels.isqrt(), 1, 1)
        }),
        series("samples", "samples a pixel", vec![1, 4, 16, 64], |samples| {
            lit("samples.pss", 128, samples, 1)
        }),
        series("threads", "threads", vec![1, 2], |threads| lit("threads.pss", 512, 4, threads)),
    ]
}
