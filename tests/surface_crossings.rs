//! Crossings of point set surfaces against the surfaces that the clouds were sampled from.

mod common;

use common::{Truth, all, chord, surface};
use glam::DVec3;
use pss::geom::Ray;
use pss::solid::point_set::Options;
use pss::solid::{Body, Crossing, Scratch};
use rayon::prelude::*;

struct Figures {
    rms: f64,
    crossings: usize,
    projections: u64,
    odd: usize,
    failures: u64,
    turned: f64,
}

/// Chords through a solid: distances to the truth relative to the diagonal, and how far the reversed chord's
/// crossings lie from the same points.
fn measure(truth: Truth, n: usize, options: &Options, chords: u64) -> Figures {
    let (points, normals) = truth.cloud(n);
    let set = surface(&points, &normals, options).with_body(Body::Solid);
    let per_chord: Vec<_> = (0..chords)
        .into_par_iter()
        .map_init(Scratch::default, |scratch, i| {
            scratch.counts = Default::default();
            let ray = chord(i, DVec3::ZERO, 2.0);
            let forth = all(&set, &ray, scratch);
            let counts = scratch.counts;
            let back = all(&set, &Ray::new(ray.at(1.0), -ray.dir), scratch);
            let squares: f64 = forth.iter().map(|c| truth.distance(ray.at(c.t)).powi(2)).sum();
            let turned = if forth.len() == back.len() {
                let apart = |(a, b): (&Crossing, &Crossing)| (a.t + b.t - 1.0).abs() * ray.dir.length();
                // Along the ray a grazing crossing is as uncertain as its own bound says.
                let excess =
                    |(a, b): (&Crossing, &Crossing)| apart((a, b)) - (a.err + b.err) * ray.dir.length();
                forth.iter().zip(back.iter().rev()).map(excess).fold(0.0, f64::max)
            } else {
                f64::INFINITY
            };
            (squares, forth.len(), counts, turned)
        })
        .collect();
    let crossings: usize = per_chord.iter().map(|c| c.1).sum();
    let diagonal = truth.diagonal();
    Figures {
        rms: (per_chord.iter().map(|c| c.0).sum::<f64>() / crossings as f64).sqrt() / diagonal,
        crossings,
        projections: per_chord.iter().map(|c| c.2.projections).sum(),
        odd: per_chord.iter().filter(|c| c.1 % 2 == 1).count(),
        failures: per_chord.iter().map(|c| c.2.certificate_failures + c.2.parity_repairs).sum(),
        turned: per_chord.iter().map(|c| c.3).fold(0.0, f64::max) / diagonal,
    }
}

#[test]
fn four_times_the_samples_bring_the_crossings_nearer_to_the_truth_by_the_order_of_the_method() {
    for truth in Truth::ALL {
        for (degree, least) in [(2, 8.0), (3, 14.0)] {
            let options = Options { degree, ..Options::default() };
            let few = measure(truth, 10_000, &options, 10_000);
            let many = measure(truth, 40_000, &options, 10_000);
            let ratio = few.rms / many.rms;
            println!(
                "{truth:?} degree {degree}: rms {:.2e} -> {:.2e} (ratio {ratio:.1}), {:.2} projections a crossing, \
                 {} odd, {} undecided, from both ends within {:.1e}",
                few.rms,
                many.rms,
                many.projections as f64 / many.crossings as f64,
                few.odd + many.odd,
                few.failures + many.failures,
                few.turned.max(many.turned),
            );
            assert!(least <= ratio, "{truth:?} degree {degree}: only {ratio:.1} times nearer");
            assert!(many.rms < 3e-6, "{truth:?} degree {degree}: {:e}", many.rms);
            for figures in [few, many] {
                assert_eq!(figures.odd, 0);
                assert!(figures.turned < 1e-9, "{:e}", figures.turned);
            }
        }
    }
}
