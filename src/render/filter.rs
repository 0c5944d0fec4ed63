//! Where samples lie around their pixel. They are spread as the filter weighs them, so each pixel needs its own samples alone
//! (filter importance sampling; Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006): tiles stay apart.

use crate::shot::settings::Filter;

/// Steps of the table on each axis, over the whole width.
const STEPS: usize = 512;

/// A filter made ready.
#[derive(Clone, Debug)]
pub struct Spread {
    /// How far it reaches from the pixel's middle, pixels.
    pub radius: f64,
    /// Sums of its size on one axis up to each step, over the sum of all; empty for a box.
    shares: Vec<f64>,
    /// Its sign in each step, times the integral of its size.
    weights: Vec<f64>,
}

/// The filter on one axis, `x` pixels from the middle: any scale.
fn value(filter: Filter, x: f64) -> f64 {
    let x = x.abs();
    match filter {
        Filter::Box => 1.0,
        Filter::Tent => 1.0 - x,
        Filter::Gauss => libm::exp(-2.0 * x * x),
        // B = C = 1/3.
        Filter::Mitchell if x < 1.0 => (7.0 * x - 12.0) * x * x + 16.0 / 3.0,
        Filter::Mitchell => ((-7.0 / 3.0 * x + 12.0) * x - 20.0) * x + 32.0 / 3.0,
    }
}

impl Spread {
    /// Gets ready.
    pub fn new(filter: Filter) -> Spread {
        let radius = match filter {
            Filter::Box => 0.5,
            Filter::Tent => 1.0,
            Filter::Gauss => 1.5,
            Filter::Mitchell => 2.0,
        };
        if filter == Filter::Box {
            return Spread { radius, shares: Vec::new(), weights: Vec::new() };
        }
        let at = |i: usize| value(filter, radius * (2.0 * (i as f64 + 0.5) / STEPS as f64 - 1.0));
        let (sizes, whole): (f64, f64) =
            (0..STEPS).map(at).fold((0.0, 0.0), |(sizes, whole), f| (sizes + f.abs(), whole + f));
        let mut sum = 0.0;
        let share = |i| {
            sum += at(i).abs() / sizes;
            sum
        };
        let shares = (0..STEPS).map(share).collect();
        let weights = (0..STEPS).map(|i| at(i).signum() * sizes / whole).collect();
        Spread { radius, shares, weights }
    }

    /// How far beyond its pixel it reaches, pixels.
    pub fn margin(&self) -> f64 {
        self.radius - 0.5
    }

    /// A place by two numbers in [0, 1): pixels from the pixel's upper left corner, and the weight of a sample there, one on
    /// the mean.
    pub fn place(&self, uv: [f64; 2]) -> ([f64; 2], f64) {
        if self.shares.is_empty() {
            return (uv, 1.0);
        }
        let [(x, a), (y, b)] = uv.map(|u| {
            let i = self.shares.partition_point(|s| *s <= u).min(STEPS - 1);
            let below = if i == 0 { 0.0 } else { self.shares[i - 1] };
            let within = ((u - below) / (self.shares[i] - below)).clamp(0.0, 1.0);
            (0.5 + self.radius * (2.0 * (i as f64 + within) / STEPS as f64 - 1.0), self.weights[i])
        });
        ([x, y], a * b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments by samples against those of the formulas: zeroth one, first none, second of a tent 1/6, of the bell cut at
    /// three deviations 0.25 less what is cut, of Mitchell's none but 1/18 (its B).
    #[test]
    fn places_follow_the_filter() {
        let cut = {
            let (mut mass, mut second) = (0.0, 0.0);
            for i in 0..30_000 {
                let x = -1.5 + (f64::from(i) + 0.5) / 10_000.0;
                mass += (-2.0 * x * x).exp();
                second += x * x * (-2.0 * x * x).exp();
            }
            second / mass
        };
        // The integral of x^2 k(x) of Mitchell's cubic with B = C = 1/3.
        let wanted = [
            (Filter::Box, 1.0 / 12.0),
            (Filter::Tent, 1.0 / 6.0),
            (Filter::Gauss, cut),
            (Filter::Mitchell, 1.0 / 9.0),
        ];
        for (filter, second) in wanted {
            let spread = Spread::new(filter);
            let n = 256;
            let (mut mass, mut first, mut moment) = (0.0, 0.0, 0.0);
            for i in 0..n * n {
                let uv = [(i / n) as f64 + 0.5, (i % n) as f64 + 0.5].map(|u| u / n as f64);
                let ([x, _], weight) = spread.place(uv);
                let weight = weight / (n * n) as f64;
                mass += weight;
                first += weight * (x - 0.5);
                moment += weight * (x - 0.5).powi(2);
            }
            assert!((mass - 1.0).abs() < 0.01 && first.abs() < 1e-3, "{filter:?}: {mass} {first}");
            assert!((moment - second).abs() < 0.01, "{filter:?}: {moment}, not {second}");
        }
    }
}
