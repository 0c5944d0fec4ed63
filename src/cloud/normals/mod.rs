//! Normals of the samples: kept from the file where it has them, else estimated and oriented; in both cases
//! checked by what neighbours and the winding number say.

mod coarse;
mod contract;
mod estimate;
mod improve;
mod orient;

use glam::DVec3;

use super::neighbours::Table;

pub use estimate::{NORMAL_NEIGHBOURS, estimate, roughness};
pub use improve::improve;
pub use orient::{Spread, agreement, orient, outvoted};

use super::spacing::spacing;
use coarse::Coarse;

/// Above this share of neighbours with opposed normals those of a file are improved by the winding number.
/// Scans made with care have below 0.3 %; thin walls and creases make some of it.
const DOUBTFUL: f64 = 0.01;

/// A surface counts as closed where the vector sum of its areas is below this share of their sum: it is
/// zero for a closed one (divergence theorem), one for a flat sheet, one half for a hemisphere.
const CLOSED: f64 = 0.1;

/// From this median roughness of the closest samples on a cloud is noisy. Clean scans have 0.0004 to 0.007, raw ones 0.045
/// and 0.09; on the noisier of these, signs spread over the samples themselves were right on 92 %, over means on 99.7 %.
const NOISY: f64 = 0.02;

/// Fewer means than this carry no shape.
const FEWEST: usize = 100;

/// Rounds of improvement at most; in tests with a fifth of the normals flipped three were enough.
const ROUNDS: usize = 6;

/// Unit normals with their sign, and what was done.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// One a sample.
    pub normals: Vec<DVec3>,
    /// Share of the pairs of near neighbours whose normals are opposed.
    pub opposed: f64,
    /// Given normals that were turned singly.
    pub turned: usize,
    /// What was mended, one sentence each.
    pub notes: Vec<String>,
}

/// What normals are made from.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// Positions.
    pub points: &'a [DVec3],
    /// Nearest samples of each, at least [`NORMAL_NEIGHBOURS`] where there are so many.
    pub table: &'a Table,
    /// Width of each sample, world length.
    pub widths: &'a [f64],
}

/// Estimates all normals and gives them signs. Those of a cloud so noisy that the planes of few neighbours mislead
/// are taken from a coarser cloud of means.
pub fn from_points(scene: Scene<'_>) -> Oriented {
    if median_roughness(scene) < NOISY {
        return estimated(scene, Spread::Tree);
    }
    let coarse = Coarse::new(scene);
    if coarse.points.len() < FEWEST {
        return estimated(scene, Spread::Tree);
    }
    let Oriented { normals, mut notes, .. } = estimated(coarse.scene(), Spread::Borders);
    let normals = coarse.spread(scene.points, &normals);
    notes.push(format!("noisy: normals are those of {} means of near samples", coarse.points.len()));
    let opposed = agreement(&normals, scene.table);
    Oriented { normals, opposed, turned: 0, notes }
}

fn estimated(scene: Scene<'_>, spread: Spread) -> Oriented {
    let mut normals = estimate(scene.points, scene.table);
    let areas = scene.areas(&normals);
    orient(scene, &areas, &mut normals, spread);
    let mut notes = Vec::new();
    let all = (0..normals.len() as u32).collect();
    let flips = improve(scene, &areas, &mut normals, all, ROUNDS);
    if 0 < flips {
        notes.push(format!("{flips} estimated normals were turned by the winding number"));
    }
    let opposed = agreement(&normals, scene.table);
    Oriented { normals, opposed, turned: 0, notes }
}

/// The median of the roughness of samples spread over the cloud.
fn median_roughness(scene: Scene<'_>) -> f64 {
    const ASKED: usize = 2000;
    // So few do not yet reach the other side of a thin wall.
    const CLOSEST: usize = 8;
    let n = scene.points.len();
    let asked = n.min(ASKED);
    let mut all: Vec<f64> =
        (0..asked).map(|k| roughness(scene.points, k * n / asked, CLOSEST, scene.table)).collect();
    all.sort_unstable_by(f64::total_cmp);
    all.get(asked / 2).copied().unwrap_or(0.0)
}

/// Keeps given unit normals (zero where missing), estimates the missing ones, turns single ones that contradict
/// the rest, and turns all where a closed cloud is inside out.
pub fn from_file(scene: Scene<'_>, given: Vec<DVec3>) -> Oriented {
    if given.iter().all(|n| *n == DVec3::ZERO) {
        return from_points(scene);
    }
    let mut normals = given;
    let mut notes = Vec::new();
    let missing = orient::fill_missing(scene, &mut normals);
    if 0 < missing {
        notes.push(format!("{missing} missing normals were estimated"));
    }
    let mut opposed = agreement(&normals, scene.table);
    let doubtful = DOUBTFUL < opposed;
    let asked = if doubtful { (0..normals.len() as u32).collect() } else { outvoted(&normals, scene.table) };
    // Where nothing is in doubt the area about each sample is near enough.
    let areas = if asked.is_empty() { scene.squares() } else { scene.areas(&normals) };
    let flips = improve(scene, &areas, &mut normals, asked, ROUNDS);
    if doubtful {
        let share = 100.0 * opposed;
        notes.push(format!(
            "{share:.1} % of near samples had opposed normals: {flips} were turned by the winding number"
        ));
    } else if 0 < flips {
        notes.push(format!("{flips} normals opposed to those around them were turned"));
    }
    if 0 < flips {
        opposed = agreement(&normals, scene.table);
    }
    if scene.is_inside_out(&areas, &normals) {
        normals.iter_mut().for_each(|n| *n = -*n);
        notes.push("all normals point inward and were turned".to_string());
    }
    Oriented { normals, opposed, turned: flips, notes }
}

impl Scene<'_> {
    fn areas(&self, normals: &[DVec3]) -> Vec<f64> {
        super::areas_by(self.points, normals, self.widths, self.table)
    }

    /// Squares of the spacing of each sample.
    fn squares(&self) -> Vec<f64> {
        spacing(self.points, self.table).iter().map(|s| s * s).collect()
    }

    /// Whether the cloud is closed and its signed volume `sum a p.n / 3` is negative.
    fn is_inside_out(&self, areas: &[f64], normals: &[DVec3]) -> bool {
        let all: Vec<u32> = (0..self.points.len() as u32).collect();
        let shape = orient::Shape::of(self.points, normals, areas, &all);
        shape.vector_area.length() < CLOSED * shape.area && shape.volume < 0.0
    }
}
