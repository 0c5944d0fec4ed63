//! One evaluation of F and grad F.

use std::hint::black_box;

use pss::mls::{Compact, Evaluator, Form, Guess, Neighbours, SameWay, Weight};
use pss::solid::point_set::{Hierarchy, Options};

use crate::clock::median_seconds;
use crate::common::{Truth, surface};
use crate::table::Row;

/// Samples asked, every so many.
const EVERY: usize = 397;
/// Places about each.
const PLACES: usize = 10;

pub fn rows(rows: &mut Vec<Row>) {
    let (points, normals) = Truth::Torus.cloud(100_000);
    let usual = surface(&points, &normals, &Options::default());
    for (factor, degree) in [(0.69, 2), (0.69, 3), (1.0, 2), (1.0, 3), (1.0, 4)] {
        let usual = usual.samples();
        let widths: Vec<f64> = usual.widths.iter().map(|h| factor * h).collect();
        let samples = Hierarchy::new(&usual.points, &usual.normals(), &widths);
        let [gathered, with] = [false, true].map(|again| seconds(&samples, degree, again));
        let name = format!("F and grad F, degree {degree}, {:.0} neighbours", neighbours(&samples));
        let asked = if factor < 1.0 && degree == 2 { "<= 1 with AVX-512, 1.5 with AVX2" } else { "" };
        rows.push(Row::new(format!("{name}, gathered"), 1e6 * gathered, "us", asked));
        rows.push(Row::new(format!("{name}, with its gather"), 1e6 * with, "us", ""));
    }
}

/// Seconds an evaluation, on average over places near the surface, from the samples' own normals on.
fn seconds(samples: &Hierarchy, degree: usize, gather: bool) -> f64 {
    let evaluator = Evaluator { weight: Compact, facing: SameWay, degree, form: Form::Free };
    let asked: Vec<usize> = (0..samples.points.len()).step_by(EVERY).collect();
    let lists: Vec<Neighbours> = asked.iter().map(|&i| gathered(samples, i)).collect();
    let mut lists = lists;
    let all = median_seconds(5, || {
        for (&i, near) in asked.iter().zip(&mut lists) {
            let guess = guess(samples, i);
            for k in 0..PLACES {
                if gather {
                    *near = gathered(samples, i);
                }
                let at = guess.foot + 1e-3 * (k as f64) * guess.width * guess.outward;
                let _ = black_box(evaluator.sample(samples.blocks(), near, at, &guess));
            }
        }
    });
    all / (asked.len() * PLACES) as f64
}

fn guess(samples: &Hierarchy, i: usize) -> Guess {
    Guess { foot: samples.points[i], outward: samples.normal(i), width: samples.widths[i] }
}

fn gathered(samples: &Hierarchy, i: usize) -> Neighbours {
    let mut near = Neighbours::default();
    let Guess { foot, outward, width } = guess(samples, i);
    samples.gather(foot, 0.4 * width, Compact.support(), outward, &mut near);
    near
}

/// How many samples weigh at a sample, on average.
fn neighbours(samples: &Hierarchy) -> f64 {
    let asked: Vec<usize> = (0..samples.points.len()).step_by(EVERY).collect();
    let mut count = 0;
    for &i in &asked {
        samples.visit(samples.points[i], 0.0, Compact.support().sqrt(), |_| count += 1);
    }
    f64::from(count) / asked.len() as f64
}
