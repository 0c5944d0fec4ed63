//! Frames of 512 x 512 rays of one eye on the blob, the same again in one process: cold and warm, one thread.

use glam::DVec3;
use pss::geom::{Interval, Ray};
use pss::solid::point_set::{Lead, Options, PointSet};
use pss::solid::{Body, Crossing, Scratch, Solid};

use crate::clock::median_seconds;
use crate::common::{Truth, rays_of_eye, surface};
use crate::table::Row;

/// Rays each way.
pub const SIDE: usize = 512;

/// What a frame found.
#[derive(Default)]
struct Frame {
    hits: usize,
    crossings: usize,
    /// The first hits.
    found: Vec<DVec3>,
}

impl Frame {
    /// The root mean square of their distances from the true surface, world length.
    fn rms(&self) -> f64 {
        let squares: f64 = self.found.iter().map(|at| Truth::Blob.distance(*at).powi(2)).sum();
        (squares / self.hits as f64).sqrt()
    }
}

fn frame(
    set: &PointSet,
    rays: &[Ray],
    whole: bool,
    scratch: &mut Scratch,
    found: &mut Vec<Crossing>,
) -> Frame {
    let mut frame = Frame::default();
    for ray in rays {
        found.clear();
        let mut lo = 0.0;
        while lo < f64::INFINITY && (whole || found.is_empty()) {
            lo = set.crossings(ray, Interval::new(lo, f64::INFINITY), scratch, found).range.hi;
        }
        frame.crossings += if whole { found.len() } else { found.len().min(1) };
        if let Some(first) = found.first() {
            frame.hits += 1;
            frame.found.push(ray.at(first.t));
        }
    }
    frame
}

/// 100,000 samples at several tolerances.
pub fn rows(rows: &mut Vec<Row>) {
    let (points, normals) = Truth::Blob.cloud(100_000);
    let (rays, diagonal) = (rays_of_eye(SIDE), Truth::Blob.diagonal());
    for tolerance in [1e-6, 1e-9] {
        let options = Options { degree: 3, tolerance, lead: Lead::Patches, ..Options::default() };
        let set = surface(&points, &normals, &options).with_body(Body::Solid);
        let (mut scratch, mut found) = (Scratch::default(), Vec::new());
        let name = format!("blob, 100,000 samples, degree 3, tolerance {tolerance:e}");
        let mut seconds = [0.0; 2];
        for (i, whole) in [false, true].into_iter().enumerate() {
            let what = if whole { "all crossings" } else { "first" };
            scratch.counts = Default::default();
            let cold = frame(&set, &rays, whole, &mut scratch, &mut found);
            let per =
                |scratch: &Scratch, frame: &Frame| scratch.counts.projections as f64 / frame.crossings as f64;
            if !whole {
                rows.push(Row::new(
                    format!("{name}: projections a crossing, {what}, cold"),
                    per(&scratch, &cold),
                    "",
                    "",
                ));
            }
            scratch.counts = Default::default();
            let warm = frame(&set, &rays, whole, &mut scratch, &mut found);
            let asked = if tolerance < 1e-6 { "< 1" } else { "< 0.1" };
            rows.push(Row::new(
                format!("{name}: projections a crossing, {what}, warm"),
                per(&scratch, &warm),
                "",
                asked,
            ));
            seconds[i] = median_seconds(3, || {
                frame(&set, &rays, whole, &mut scratch, &mut found);
            });
            if !whole {
                let asked = if tolerance == 1e-6 { ">= 2" } else { "" };
                let rate = 1e-6 * warm.hits as f64 / seconds[i];
                rows.push(Row::new(
                    format!("{name}: hits a second, warm, one thread"),
                    rate,
                    "million",
                    asked,
                ));
                let rms = warm.rms() / diagonal;
                rows.push(Row::new(format!("{name}: rms distance over the diagonal"), rms, "", ""));
            }
        }
        rows.push(Row::new(
            format!("{name}: time of all crossings over the first"),
            seconds[1] / seconds[0],
            "times",
            "< 2",
        ));
    }
}
