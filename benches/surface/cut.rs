//! The blob cut by a box, from file to picture, one thread.

use std::path::PathBuf;

use pss::cloud::Cloud;
use pss::cloud::ply::{Encoding, write};
use pss::geom::{Aabb, Interval, Ray};
use pss::solid::point_set::{Lead, Options, PointSet};
use pss::solid::{Body, Crossing, Scratch, Solid};

use crate::clock::{command_seconds, median, runs_a_round};
use crate::common::{Truth, first_below, rays_of_eye, widths};
use crate::frames::SIDE;
use crate::table::Row;

const BOX: Aabb = Aabb { min: glam::DVec3::new(0.15, 0.2, 0.1), max: glam::DVec3::new(3.0, 3.0, 3.0) };
/// Narrower than usual, as the samples are exact: every figure here is for this degree and the width beside it. Of a million
/// samples some stand so unevenly that narrower weights hold too few of them.
const DEGREE: usize = 3;
const TOLERANCE: f64 = 1e-7;
/// Runs or groups of runs of which the middle one counts.
const ROUNDS: usize = 3;

pub fn rows(rows: &mut Vec<Row>) {
    let long = std::env::var_os("PSS_LONG").is_some();
    let sizes: &[(usize, f64, &str, &str)] = &[
        (100_000, 0.85, "<= 0.7", ""),
        (1_000_000, 1.1, "<= 6", "<= 600"),
        (10_000_000, 1.0, "", "<= 2500"),
    ];
    for &(count, smoothing, seconds, megabytes) in &sizes[..if long { 3 } else { 2 }] {
        let name = format!(
            "blob of {count} samples less a box, 512 x 512, degree {DEGREE}, width {smoothing}, tolerance {TOLERANCE:e}"
        );
        let (points, normals) = Truth::Blob.cloud(count);
        let (used, peak) = command(&points, &normals, smoothing);
        rows.push(Row::new(format!("{name}: from file to picture"), used, "CPU s", seconds));
        rows.push(Row::new(format!("{name}: peak memory"), peak, "MB", megabytes));
        if count <= 1_000_000 {
            let (rms, missed) = error(&points, &normals, smoothing);
            rows.push(Row::new(
                format!("{name}: rms along rays of cosine above 0.2, over the diagonal"),
                rms,
                "",
                "<= 1e-7",
            ));
            rows.push(Row::new(format!("{name}: rays that hit or miss wrongly"), missed, "", ""));
        }
    }
}

fn command(points: &[glam::DVec3], normals: &[glam::DVec3], smoothing: f64) -> (f64, f64) {
    let folder = std::env::temp_dir().join("pss_surface_bench");
    std::fs::create_dir_all(&folder).expect("a folder for temporary files");
    let path = |name: &str| -> PathBuf { folder.join(name) };
    let cloud = Cloud { points: points.to_vec(), normals: Some(normals.to_vec()), ..Cloud::default() };
    let mut file = std::io::BufWriter::new(std::fs::File::create(path("blob.ply")).expect("a file"));
    write(&cloud, Encoding::Binary, &mut file).expect("room for the cloud");
    drop((cloud, file));
    let scene = format!(
        "draw points(\"blob.ply\", degree: {DEGREE}, smoothing: {smoothing}, tolerance: {TOLERANCE:e}) \
         - box([0.15, 0.2, 0.1], [3, 3, 3])
         camera(eye: [2.2, 1.8, 2.8], look_at: [0, 0, 0], up: [0, 1, 0], fov: 36deg)
         render(size: [512, 512], samples: 1, integrator: \"depth\")"
    );
    std::fs::write(path("blob.pss"), scene).expect("a file");
    let stats = path("stats.json");
    let command = format!(
        "{} render {} -o {} -t 1 --quiet --stats-json {}",
        env!("CARGO_BIN_EXE_pss"),
        path("blob.pss").display(),
        path("out.exr").display(),
        stats.display()
    );
    let used = runs_a_round(&command)
        .map_or(f64::NAN, |runs| median((0..ROUNDS).filter_map(|_| command_seconds(&command, runs))));
    let text = std::fs::read_to_string(&stats).unwrap_or_default();
    let peak = text.split("\"peak_bytes\": ").nth(1).and_then(|t| t.split(',').next()?.parse::<f64>().ok());
    let _ = std::fs::remove_dir_all(&folder);
    (used, 1e-6 * peak.unwrap_or(f64::NAN))
}

/// The first boundary of the blob less the box.
fn first(crossings: &[Crossing], cut: Interval) -> Option<f64> {
    let outside_box = |t: f64| !(cut.lo <= t && t <= cut.hi);
    let mut spans = crossings.chunks_exact(2).map(|pair| (pair[0].t, pair[1].t));
    spans.find_map(|(enter, exit)| {
        if outside_box(enter) {
            return Some(enter);
        }
        (cut.hi < exit).then_some(cut.hi)
    })
}

/// The root mean square error along the rays, over the diagonal, and how many rays hit or miss wrongly.
fn error(points: &[glam::DVec3], normals: &[glam::DVec3], smoothing: f64) -> (f64, f64) {
    let options = Options { degree: DEGREE, tolerance: TOLERANCE, lead: Lead::Guides, ..Options::default() };
    let set = PointSet::new(points, normals, &widths(points, smoothing), &options).with_body(Body::Solid);
    let (mut scratch, mut found) = (Scratch::default(), Vec::new());
    let (mut squares, mut count, mut missed) = (0.0, 0u32, 0u32);
    for ray in rays_of_eye(SIDE).iter().step_by(7) {
        found.clear();
        let mut lo = 0.0;
        while lo < f64::INFINITY {
            lo = set.crossings(ray, Interval::new(lo, f64::INFINITY), &mut scratch, &mut found).range.hi;
        }
        let ours = first(&found, BOX.clip(ray).intersect(Interval::AHEAD));
        let truth = truth(ray);
        match (ours, truth) {
            (Some(a), Some((b, cosine))) if 0.2 < cosine => {
                squares += (a - b) * (a - b);
                count += 1;
            }
            (Some(_), Some(_)) | (None, None) => {}
            _ => missed += 1,
        }
    }
    ((squares / f64::from(count)).sqrt() / Truth::Blob.diagonal(), f64::from(missed))
}

/// The first boundary of the blob itself less the box, by steps and halving, and the cosine of incidence.
fn truth(ray: &Ray) -> Option<(f64, f64)> {
    let inside = |t: f64| {
        let p = ray.at(t);
        Truth::Blob.implicit(p).max(-beyond(p))
    };
    let t = first_below(inside, 2.0, 6.0, 600)?;
    let p = ray.at(t);
    let on_blob = Truth::Blob.implicit(p).abs() < beyond(p).abs();
    let normal = if on_blob { Truth::Blob.gradient(p).normalize() } else { face(p) };
    Some((t, normal.dot(ray.dir).abs()))
}

/// Above zero outside the box.
fn beyond(p: glam::DVec3) -> f64 {
    (BOX.min - p).max(p - BOX.max).max_element()
}

/// The normal of the nearest face of the box.
fn face(p: glam::DVec3) -> glam::DVec3 {
    glam::DVec3::AXES[(BOX.min - p).max(p - BOX.max).max_position()]
}
