//! Whether the samples of a cloud suffice for its shape: what can go wrong with a surface, found before anything is traced.

use glam::DVec3;

use crate::cloud::Samples;
use crate::cloud::neighbours::{Near, Neighbours};
use crate::num::eigen::symmetric3;
use crate::num::median::median;

/// A wall thinner than so many widths is not told apart: no sample's side of it is certain.
const THINNEST: f64 = 1.25;
/// Where samples weigh whichever way they face, the far side of a wall thinner than so many widths moves the near one: by
/// 0.5 % of a width at 2.5, 2.6 % at 2 (Gaussian). Else it has no weight: at 1.5 widths the wall keeps its thickness to 1e-9.
const THINNEST_MIXED: f64 = 2.5;
/// Noise above this share of the width shows in the surface's topology: 5 of 600 lines were wrong at 0.47.
const NOISIEST: f64 = 1.0 / 3.0;
/// A weight of usual width holds some twelve samples. Where it holds so many, five times as wide, every place of the surface costs as
/// much more.
const CROWDED: f64 = 300.0;
/// And where it holds so many nothing of the shape is left, while one ray takes seconds: such widths are refused.
const MOST_HELD: f64 = 2000.0;
/// Samples that are asked, where not all need to be.
const ASKED: usize = 5000;
/// A share of samples that is worth a word.
const NOTICED: f64 = 0.01;

/// How well samples carry a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitness {
    /// See [`super::survey::Survey::noise`].
    pub noise: f64,
    /// Share of samples with another sheet, facing away, nearer than the smallest wall behind them.
    pub thin: f64,
    /// The thinnest wall that the median width keeps apart.
    pub smallest_wall: f64,
    /// Step of single precision coordinates so far from the origin, where the file holds such.
    step: Option<f64>,
    spacing: f64,
    width: f64,
    /// Samples within a width of a sample: the median, and about the widest sample.
    held: [f64; 2],
    /// Share of the samples whose normal in the file was turned.
    turned: f64,
}

/// Something that may go wrong.
#[derive(Clone, Debug)]
pub(super) struct Concern {
    /// Its code.
    pub code: &'static str,
    /// One sentence.
    pub message: String,
    /// The way out.
    pub help: &'static str,
}

impl Fitness {
    /// Measures samples. `tree` is over their points; `single` as [`is_single`](crate::cloud::is_single) says, `mixed` as
    /// [`Options`](crate::solid::point_set::Options).
    pub fn new(samples: &Samples, tree: &Neighbours, single: bool, mixed: bool) -> Fitness {
        let thinnest = if mixed { THINNEST_MIXED } else { THINNEST };
        let bounds = samples.bounds();
        let farthest = bounds.farthest();
        let width = median(samples.widths.clone());
        Fitness {
            noise: noise(samples, tree),
            thin: thin(samples, tree, thinnest),
            smallest_wall: thinnest * width,
            step: single.then_some(farthest * f64::from(f32::EPSILON)),
            spacing: median(samples.spacing.clone()),
            width,
            held: held(samples),
            turned: samples.turned as f64 / samples.len().max(1) as f64,
        }
    }

    /// What the user should know; lengths in the cloud's own units.
    pub fn concerns(&self) -> Vec<Concern> {
        let mut out = Vec::new();
        let mut add = |code, message, help| out.push(Concern { code, message, help });
        if let Some(step) = self.step.filter(|step| 0.25 * self.spacing < *step) {
            let message = format!(
                "float32 coordinates are {step:.3e} apart so far from the origin: too coarse for this spacing"
            );
            add("W0103", message, "export the cloud in double precision or nearer to the origin");
        }
        let [usual, most] = self.held;
        if CROWDED < usual || MOST_HELD < most {
            let held = if CROWDED < usual { usual } else { most };
            let message = format!(
                "a weight holds up to {held:.0} samples, where 12 are usual: so much longer takes a ray"
            );
            add(
                "W0107",
                message,
                "lower `smoothing:` or `h:`, or leave out what is sparse beside dense samples",
            );
        }
        if NOISIEST * self.width < self.noise {
            let message = "the noise is more than a third of the width of the weights".to_owned();
            add("W0104", message, "raise `smoothing:`");
        }
        if NOTICED < self.thin {
            let (share, wall) = (100.0 * self.thin, self.smallest_wall);
            let message = format!(
                "{share:.1} % of samples lie on walls thinner than {wall:.4}, finer than the surface resolves"
            );
            add("W0105", message, "lower `smoothing:`, or scan more densely");
        }
        if NOTICED < self.turned {
            let message =
                format!("{:.1} % of normals contradicted the rest and were turned", 100.0 * self.turned);
            add("W0106", message, "try `normals: \"estimate\"`");
        }
        out
    }
}

/// Samples spread over the cloud.
pub(super) fn asked(samples: &Samples) -> impl Iterator<Item = usize> {
    let (n, count) = (samples.len(), samples.len().min(ASKED));
    (0..count).map(move |k| k * n / count)
}

/// Why widths that were asked for are too wide to be of use, if they are.
pub(super) fn too_wide(samples: &Samples) -> Option<String> {
    let (width, diagonal) = (median(samples.widths.clone()), samples.bounds().diagonal());
    if diagonal <= width {
        return Some(format!("a width of {width:.4} is more than the whole cloud, {diagonal:.4} across"));
    }
    let held = held(samples)[0];
    (MOST_HELD < held)
        .then(|| format!("a weight {width:.4} wide holds some {held:.0} samples, where 12 are usual"))
}

/// The number of samples within a width of a sample, estimated from at most 2000: the median over 64 samples, and that of the widest
/// one.
fn held(samples: &Samples) -> [f64; 2] {
    const SOME: usize = 2000;
    let (n, some) = (samples.len(), samples.len().min(SOME));
    let around = |i: usize| {
        let (p, square) = (samples.points[i], samples.widths[i] * samples.widths[i]);
        let near = (0..some).filter(|k| samples.points[k * n / some].distance_squared(p) <= square).count();
        near as f64 * n as f64 / some as f64
    };
    let asked = n.min(64);
    let widest = (0..n).max_by(|&i, &j| samples.widths[i].total_cmp(&samples.widths[j]));
    [median((0..asked).map(|k| around(k * n / asked)).collect()), widest.map_or(0.0, around)]
}

/// Root mean square distance of the samples of the same sheet within two widths from their plane; the median. A disc so
/// wide on a sphere of radius R shows 0.6 h^2 / R besides: a sixth of a width where h is a third of R.
fn noise(samples: &Samples, tree: &Neighbours) -> f64 {
    let mut near: Vec<Near> = Vec::new();
    let distances = asked(samples).map(|i| {
        tree.within(samples.points[i], 2.0 * samples.widths[i], &mut near);
        let same = |n: &&Near| 0.5 < samples.normals[n.index as usize].dot(samples.normals[i]);
        let off = |n: &Near| samples.points[n.index as usize] - samples.points[i];
        let sheet: Vec<DVec3> = near.iter().filter(same).map(off).collect();
        let count = sheet.len() as f64;
        let mean = sheet.iter().sum::<DVec3>() / count;
        let outer = |d: DVec3| glam::DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        let all = sheet.iter().map(|d| outer(*d - mean)).fold(glam::DMat3::ZERO, |a, b| a + b);
        (symmetric3(all).0[0].max(0.0) / count).sqrt()
    });
    median(distances.collect())
}

/// The share of samples behind which, nearer than the smallest wall of their width, another sheet faces away.
fn thin(samples: &Samples, tree: &Neighbours, thinnest: f64) -> f64 {
    let mut near: Vec<Near> = Vec::new();
    let is_thin = |i: usize| {
        let (p, n) = (samples.points[i], samples.normals[i]);
        tree.within(p, thinnest * samples.widths[i], &mut near);
        near.iter().any(|x| {
            let d = samples.points[x.index as usize] - p;
            // Behind, within 30 degrees of straight, and facing away.
            samples.normals[x.index as usize].dot(n) < -0.5 && d.dot(n) < -0.866 * d.length()
        })
    };
    let count = samples.len().clamp(1, ASKED);
    asked(samples).map(is_thin).filter(|t| *t).count() as f64 / count as f64
}
