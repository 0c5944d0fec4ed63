//! How many projections a crossing takes: the paper's iteration on a ray beside this program's certificate.
//! `cargo run --release --example projections`; its output is kept in `examples/projections.md`.
//!
//! The paper's iteration projects the centre of the trust sphere nearest to the crossing, meets the polynomial found there with the
//! ray, projects the place met, and so on; it is run with the independent reference of the tests. A projection is one solve of
//! plane and polynomial, the sphere's own the first. It is counted until the place lies within the stated share of a width of
//! the surface's true crossing. The certificate's projections are all that the program solves for the line, ends of bands
//! and proofs of absence among them, over its crossings; a tolerance asked of it holds for all.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/reference/mod.rs"]
mod reference;

use common::{Truth, all, chord};
use glam::DVec3;
use pss::geom::Ray;
use pss::solid::point_set::{Options, PointSet};
use pss::solid::{Crossing, Scratch, Solid};
use rayon::prelude::*;
use reference::Reference;

const SAMPLES: usize = 6000;
const CHORDS: u64 = 700;
const SHARES: [f64; 3] = [1e-3, 1e-6, 1e-9];
const ANGLES: [(f64, f64); 3] = [(0.0, 0.2), (0.2, 0.6), (0.6, 1.0)];
/// Iterations that do not end by then have left.
const MOST: usize = 20;

/// What one crossing took: |cos|, the paper's projections for each share, ours.
type Row = (f64, [Option<usize>; 3], [f64; 3]);

fn main() {
    println!(
        "| h, degree, \\|cos\\| | crossings | paper, 1e-3 h | 1e-6 h | 1e-9 h | certificate, 1e-3 h | 1e-6 h | 1e-9 h |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let (points, normals) = Truth::Torus.cloud(SAMPLES);
    let spacing = (Truth::Torus.area() / SAMPLES as f64).sqrt();
    for (factor, degree) in [(2.0, 2), (2.0, 3), (2.4, 4), (3.0, 2), (3.0, 4)] {
        let rows = measure(&points, &normals, factor * spacing, degree);
        for (lo, hi) in ANGLES {
            let own: Vec<&Row> = rows.iter().filter(|r| lo <= r.0 && r.0 < hi + 1e-12).collect();
            print_row(&format!("{factor}, {degree}, {lo} to {hi}"), &own);
        }
    }
}

fn measure(points: &[DVec3], normals: &[DVec3], h: f64, degree: usize) -> Vec<Row> {
    let widths = vec![h; points.len()];
    let set = |tolerance: f64| {
        PointSet::new(
            points,
            normals,
            &widths,
            &Options { degree, mixed: true, tolerance, ..Options::default() },
        )
    };
    let exact = set(1e-14);
    let diagonal = Truth::Torus.diagonal();
    let ours: Vec<PointSet> = SHARES.iter().map(|share| set(share * h / diagonal)).collect();
    let paper = Reference {
        points: points.to_vec(),
        normals: normals.to_vec(),
        widths: widths.clone(),
        gaussian: false,
        same_way: false,
        degree,
        levin: false,
    };
    (0..CHORDS)
        .into_par_iter()
        .map_init(Scratch::default, |scratch, i| {
            let ray = chord(i, DVec3::ZERO, 1.5);
            let hits = all(&exact, &ray, scratch);
            let cost: Vec<f64> = ours
                .iter()
                .map(|set| {
                    scratch.counts = Default::default();
                    all(set, &ray, scratch);
                    scratch.counts.projections as f64 / hits.len().max(1) as f64
                })
                .collect();
            let row = |hit: &Crossing| {
                let cos = exact.normal(&ray, hit, scratch).dot(ray.dir.normalize()).abs();
                (cos, iterate(&paper, &ray, hit.t, h), [cost[0], cost[1], cost[2]])
            };
            hits.iter().map(row).collect::<Vec<Row>>()
        })
        .flatten()
        .collect()
}

/// The paper's iteration towards the crossing at `t`.
fn iterate(paper: &Reference, ray: &Ray, t: f64, h: f64) -> [Option<usize>; 3] {
    let length = ray.dir.length();
    let dir = ray.dir / length;
    let goal = t * length;
    let mut out = [None; 3];
    let centre = paper.points[paper.nearest(ray.at(t)).0];
    // The ray enters the sphere nearest to where it passes the centre.
    let (mut at, mut s) = (centre, (centre - ray.origin).dot(dir));
    for projections in 1..=MOST {
        let Some(next) = paper.fit(at).and_then(|fit| fit.meet(ray.origin, dir, s)) else { return out };
        s = next;
        at = ray.origin + dir * s;
        for (found, share) in out.iter_mut().zip(SHARES) {
            if found.is_none() && (s - goal).abs() < share * h {
                *found = Some(projections);
            }
        }
        if out[2].is_some() || h < (s - goal).abs() {
            break;
        }
    }
    out
}

fn print_row(name: &str, rows: &[&Row]) {
    let paper = |k: usize| {
        let found: Vec<usize> = rows.iter().filter_map(|r| r.1[k]).collect();
        let mean = found.iter().sum::<usize>() as f64 / found.len().max(1) as f64;
        let lost = rows.len() - found.len();
        let lost = if lost == 0 { String::new() } else { format!(", {lost} lost") };
        format!("{mean:.2} / {}{lost}", found.iter().max().unwrap_or(&0))
    };
    let ours = |k: usize| {
        let mean = rows.iter().map(|r| r.2[k]).sum::<f64>() / rows.len().max(1) as f64;
        format!("{mean:.2} / {:.0}", rows.iter().map(|r| r.2[k]).fold(0.0, f64::max))
    };
    let cells: Vec<String> = (0..3).map(paper).chain((0..3).map(ours)).collect();
    println!("| {name} | {} | {} |", rows.len(), cells.join(" | "));
}
