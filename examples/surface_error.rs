//! Error of the crossings of a point set surface against the surface its samples were taken from, and what they cost:
//! `cargo run --release --example surface_error`. Prints one line for each shape, weight, degree and number of samples.
//!
//! Random chords of a ball around the shape; the distance of each crossing to the true surface is relative to the
//! diagonal of the shape's bounds. Times are of one thread, CPU time of the chords over their projections.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use common::{Truth, all, chord, surface};
use glam::DVec3;
use pss::solid::point_set::{Lead, Options};
use pss::solid::{Body, Scratch};

const CHORDS: u64 = 4000;

fn main() {
    println!(
        "shape   samples weight    degree  rms/diag  max/diag  projections/crossing  us/projection  odd"
    );
    for truth in Truth::ALL {
        for samples in [10_000, 40_000] {
            for (gaussian, degree) in [(false, 2), (false, 3), (false, 4), (true, 2), (true, 3), (true, 4)] {
                line(truth, samples, &Options { gaussian, degree, lead: Lead::Search, ..Options::default() });
            }
        }
    }
}

fn line(truth: Truth, samples: usize, options: &Options) {
    let (points, normals) = truth.cloud(samples);
    let set = surface(&points, &normals, options).with_body(Body::Solid);
    let mut scratch = Scratch::default();
    let (mut squares, mut worst, mut crossings, mut odd) = (0.0, 0.0f64, 0u32, 0);
    let start = Instant::now();
    for i in 0..CHORDS {
        let ray = chord(i, DVec3::ZERO, 2.0);
        let found = all(&set, &ray, &mut scratch);
        odd += found.len() % 2;
        for crossing in &found {
            let error = truth.distance(ray.at(crossing.t));
            squares += error * error;
            worst = worst.max(error);
            crossings += 1;
        }
    }
    let micros = start.elapsed().as_secs_f64() * 1e6;
    let diagonal = truth.diagonal();
    println!(
        "{:<7} {samples:>7} {:<9} {:>6}  {:>8.2e}  {:>8.2e}  {:>20.2}  {:>13.2}  {odd:>3}",
        format!("{truth:?}").to_lowercase(),
        if options.gaussian { "gaussian" } else { "compact" },
        options.degree,
        (squares / f64::from(crossings)).sqrt() / diagonal,
        worst / diagonal,
        scratch.counts.projections as f64 / f64::from(crossings),
        micros / scratch.counts.projections as f64,
    );
}
