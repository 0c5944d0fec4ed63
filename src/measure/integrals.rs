//! Volumes, middles and areas as integrals over lines, with bars of error.
//!
//! The volume is the integral over the plane across an axis of how long the line along it is inside; the middle weighs the
//! middles of the spans by their lengths. The area is 2 pi R^2 times the mean number of crossings of lines through a ball of
//! radius R, uniform in direction and offset (Crofton's formula; Santalo, Integral Geometry and Geometric Probability, I.2).
//!
//! Lines are Owen-scrambled Sobol points (Burley, "Practical Hash-based Owen Scrambling", 2020) in [`REPLICATES`] independent
//! scramblings; the bar is Student's at one in a thousand over the replicates' means. Points are doubled until the bar is
//! small enough or they are many. Where all replicates agree to rounding the bar is that.

use glam::DVec3;
use rayon::prelude::*;

use crate::csg::{Scratch, Spans};
use crate::geom::{Aabb, Interval, Ray, tolerance};
use crate::lang::Measured;
use crate::shot::World;

/// Independent scramblings.
const REPLICATES: u32 = 16;
/// Student's t at 0.9995, one-sided, for 15 degrees of freedom: two-sided one in a thousand.
const STUDENT: f64 = 4.073;
/// Points of a replicate: at first, and at most.
const FIRST: u32 = 1 << 10;
const MOST: u32 = 1 << 15;
/// A bar so small, relative to the value, is small enough.
const ENOUGH: f64 = 1e-5;

/// The volume, the middle, and the bar of the middle's coordinates; zero for nothing.
pub fn volume(world: &World, bounds: &Aabb) -> (Measured, DVec3, f64) {
    if bounds.is_empty() || bounds.size().min_element() == 0.0 {
        return (Measured { value: 0.0, err: 0.0 }, DVec3::ZERO, 0.0);
    }
    // Along the shortest side: there the ends of spans are most of what a line sees.
    let axis = bounds.size().min_position();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let face = bounds.size()[u] * bounds.size()[v];
    let line = |at: [f64; 4], scratch: &mut Scratch, spans: &mut Spans| {
        let mut origin = bounds.center();
        origin[u] = bounds.min[u] + at[0] * bounds.size()[u];
        origin[v] = bounds.min[v] + at[1] * bounds.size()[v];
        world.spans(&Ray::new(origin, DVec3::AXES[axis]), Interval::ALL, scratch, spans);
        let mut sums = [0.0; 4];
        for span in spans.iter() {
            let ends = [span.enter, span.exit].map(|end| end.map(|end| end.t));
            let [Some(lo), Some(hi)] = ends else { continue };
            let mut middle = origin;
            middle[axis] += 0.5 * (lo + hi);
            let weight = face * (hi - lo);
            sums[0] += weight;
            (0..3).for_each(|i| sums[i + 1] += weight * (middle[i] - bounds.center()[i]));
        }
        sums
    };
    let (means, errs) = replicated(line, bounds.farthest());
    let value = means[0];
    let middle = DVec3::new(means[1], means[2], means[3]) / value;
    let bar = (1..4).map(|i| (errs[i] + errs[0] * middle[i - 1].abs()) / value).fold(0.0, f64::max);
    (Measured { value, err: errs[0] }, bounds.center() + middle, bar)
}

/// The area of the boundary; of sheets that of one side.
pub fn area(world: &World, bounds: &Aabb) -> Measured {
    if bounds.is_empty() {
        return Measured { value: 0.0, err: 0.0 };
    }
    let radius = 0.5 * bounds.diagonal() * (1.0 + tolerance::MARGIN);
    let line = |at: [f64; 4], scratch: &mut Scratch, spans: &mut Spans| {
        let dir = on_sphere(at[0], at[1]);
        let (u, v) = dir.any_orthonormal_pair();
        let (r, (sin, cos)) = (radius * at[2].sqrt(), (std::f64::consts::TAU * at[3]).sin_cos());
        let ray = Ray::new(bounds.center() + r * cos * u + r * sin * v, dir);
        world.spans(&ray, Interval::ALL, scratch, spans);
        let ends = spans.iter().map(|s| usize::from(s.enter.is_some()) + usize::from(s.exit.is_some()));
        let mut sheets = Vec::new();
        world.sheets(&ray, Interval::ALL, scratch, &mut sheets);
        [(ends.sum::<usize>() + sheets.len()) as f64, 0.0, 0.0, 0.0]
    };
    let (means, errs) = replicated(line, 0.0);
    let share = std::f64::consts::TAU * radius * radius;
    Measured { value: share * means[0], err: share * errs[0] }
}

/// A direction by two numbers from 0 to 1, uniform (Archimedes).
fn on_sphere(a: f64, b: f64) -> DVec3 {
    let z = 2.0 * a - 1.0;
    let (sin, cos) = (std::f64::consts::TAU * b).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos, r * sin, z)
}

/// Means over points, and their bars; `reach` is the largest length in play, whose roundings a bar holds.
fn replicated(
    line: impl Fn([f64; 4], &mut Scratch, &mut Spans) -> [f64; 4] + Sync,
    reach: f64,
) -> ([f64; 4], [f64; 4]) {
    let mut sums = [[0.0; 4]; REPLICATES as usize];
    let (mut done, mut until) = (0, FIRST);
    loop {
        sums.par_iter_mut().enumerate().for_each(|(seed, sum)| {
            let (mut scratch, mut spans) = (Scratch::default(), Spans::new());
            for i in done..until {
                let at = [0, 1, 2, 3].map(|dim| f64::from(sobol_burley::sample(i, dim, seed as u32)));
                spans.clear();
                let found = line(at, &mut scratch, &mut spans);
                sum.iter_mut().zip(found).for_each(|(sum, x)| *sum += x);
            }
        });
        done = until;
        let (means, errs) = told(&sums, f64::from(done), reach);
        if MOST <= done || errs[0] <= ENOUGH * means[0] {
            return (means, errs);
        }
        until *= 2;
    }
}

fn told(sums: &[[f64; 4]; REPLICATES as usize], count: f64, reach: f64) -> ([f64; 4], [f64; 4]) {
    let n = f64::from(REPLICATES);
    let mut out = ([0.0; 4], [0.0; 4]);
    for k in 0..4 {
        let mean = sums.iter().map(|s| s[k] / count).sum::<f64>() / n;
        let square = sums.iter().map(|s| (s[k] / count - mean).powi(2)).sum::<f64>() / (n - 1.0);
        out.0[k] = mean;
        out.1[k] = STUDENT * (square / n).sqrt() + tolerance::noise(mean.abs());
    }
    // The ends of spans are known to roundings of the scene's own size.
    if 0.0 < reach {
        out.1[0] += out.0[0] * tolerance::cleanup(1.0);
    }
    out
}
