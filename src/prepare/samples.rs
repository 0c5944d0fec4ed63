//! Samples of a solid, evenly by area, as a scanner would take them.
//!
//! Random lines, uniform in the measure of lines, cross any surface uniformly by its area (Crofton); so candidates are
//! the crossings of random chords of a sphere around the solid, several times as many as asked for. Of these the most
//! crowded are dropped one by one until the number is right (weighted sample elimination, Yuksel 2015), which
//! leaves them evenly spread. Works for every solid that answers rays.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;
use rayon::prelude::*;

use crate::cloud::Cloud;
use crate::cloud::neighbours::{Near, Neighbours};
use crate::csg::{Boundary, Object, Scratch, Spans};
use crate::geom::{Aabb, Interval, Ray};
use crate::num::hash::{Stream, mix};
use crate::shot::Material;

/// How samples are taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling {
    /// How many.
    pub count: usize,
    /// Standard deviation of each coordinate's error, world length.
    pub noise: f64,
    /// Seed of everything random.
    pub seed: u64,
}

/// Why there are no samples.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
pub(super) enum SampleError {
    /// Chords would never end.
    #[error("an unbounded solid cannot be sampled")]
    Unbounded,
    /// No chord meets it.
    #[error("there is nothing to sample: the solid is empty")]
    Empty,
}

/// Candidates for each sample kept; Yuksel finds no gain beyond five.
const CANDIDATES: usize = 5;
/// Chords a batch; the number of batches depends on the solid alone.
const BATCH: usize = 8192;
/// Without a crossing in so many chords the solid is taken for empty.
const PATIENCE: u64 = 64;

/// A place on the surface.
#[derive(Clone, Copy)]
struct Candidate {
    point: DVec3,
    normal: DVec3,
    /// Its colour, where asked for.
    color: [f32; 3],
}

/// Samples an object within a box around it; with the colours of these materials, if given.
pub(super) fn sample(
    object: &Object,
    bounds: &Aabb,
    sampling: &Sampling,
    materials: Option<&[Material]>,
) -> Result<Cloud, SampleError> {
    if !bounds.is_finite() {
        return Err(if bounds.is_empty() { SampleError::Empty } else { SampleError::Unbounded });
    }
    let (center, radius) = (bounds.center(), 0.5 * bounds.diagonal());
    let wanted = sampling.count * CANDIDATES;
    let mut candidates: Vec<Candidate> = Vec::with_capacity(wanted);
    let mut batch = 0;
    while candidates.len() < wanted {
        if (batch == PATIENCE && candidates.is_empty()) || radius == 0.0 {
            return Err(SampleError::Empty);
        }
        let first = batch * BATCH as u64;
        let found: Vec<Vec<Candidate>> = (0..BATCH)
            .into_par_iter()
            .with_min_len(64)
            .map_init(Scratch::default, |scratch, i| {
                crossings(
                    object,
                    &Ray::chord(&mut Stream::new(mix(sampling.seed) ^ (first + i as u64)), center, radius),
                    materials.unwrap_or_default(),
                    scratch,
                )
            })
            .collect();
        candidates.extend(found.into_iter().flatten());
        batch += 1;
    }
    // Cauchy and Crofton: a uniform chord of a sphere of area S crosses a surface of area A 2 A / S times.
    let chords = (batch * BATCH as u64) as f64;
    let sphere = 4.0 * std::f64::consts::PI * radius * radius;
    let area = 0.5 * sphere * candidates.len() as f64 / chords;
    // The radius at which discs of that number pack most densely.
    let packed = (area / (2.0 * 3f64.sqrt() * sampling.count as f64)).sqrt();
    candidates.truncate(wanted);
    let kept = eliminate(&candidates, sampling.count, packed);
    let mut cloud = noisy(kept.iter().map(|i| candidates[*i]), sampling);
    cloud.colors = materials.map(|_| kept.iter().map(|i| candidates[*i].color).collect());
    Ok(cloud)
}

fn noisy(kept: impl Iterator<Item = Candidate>, sampling: &Sampling) -> Cloud {
    let mut cloud = Cloud { normals: Some(Vec::new()), ..Cloud::default() };
    for (i, Candidate { point, normal, .. }) in kept.enumerate() {
        let mut stream = Stream::new(mix(sampling.seed ^ 0x4e01_5e00) ^ i as u64);
        let shake = DVec3::new(stream.normal(), stream.normal(), stream.normal());
        let shake = if sampling.noise == 0.0 { DVec3::ZERO } else { sampling.noise * shake };
        cloud.points.push(point + shake);
        cloud.normals.get_or_insert_default().push(normal);
    }
    cloud
}

fn crossings(object: &Object, ray: &Ray, materials: &[Material], scratch: &mut Scratch) -> Vec<Candidate> {
    if !ray.is_valid() {
        return Vec::new();
    }
    let mut spans = Spans::new();
    object.spans(ray, Interval::ALL, scratch, &mut spans);
    let ends = spans.iter().flat_map(|s| [s.enter, s.exit]).flatten();
    let color = |b: &Boundary| {
        let leaf = |i: u32| object.part(i).leaf.material;
        let material = leaf(b.leaf).or_else(|| leaf(b.filler?));
        Material::of(materials, material.unwrap_or(u32::MAX)).albedo(ray.at(b.t), None)
    };
    ends.map(|b| Candidate { point: ray.at(b.t), normal: b.normal, color: color(&b) }).collect()
}

/// A candidate by how crowded it is; the largest is dropped next.
#[derive(Clone, Copy, PartialEq)]
struct Crowded {
    weight: f64,
    index: u32,
}

impl Eq for Crowded {}

impl PartialOrd for Crowded {
    fn partial_cmp(&self, other: &Crowded) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Crowded {
    fn cmp(&self, other: &Crowded) -> Ordering {
        self.weight.total_cmp(&other.weight).then(other.index.cmp(&self.index))
    }
}

/// Keeps `count` of the candidates, ascending, as evenly spread as elimination makes them. `packed` is the radius of
/// discs of that number that pack most densely.
fn eliminate(candidates: &[Candidate], count: usize, packed: f64) -> Vec<usize> {
    let points: Vec<DVec3> = candidates.iter().map(|c| c.point).collect();
    let tree = Neighbours::new(&points);
    // Yuksel's weight (1 - d / 2 r)^8, d from below by a radius at which clusters count alike (his beta = 0.65,
    // gamma = 1.5). Two faces of a thin wall are not neighbours.
    let fewest = 2.0 * packed * 0.65 * (1.0 - (count as f64 / candidates.len() as f64).powf(1.5));
    let weigh = |d: f64| (1.0 - d.max(fewest) / (2.0 * packed)).max(0.0).powi(8);
    let near: Vec<Vec<(u32, f64)>> = (0..points.len())
        .into_par_iter()
        .map_init(Vec::new, |found: &mut Vec<Near>, i| {
            tree.within(points[i], 2.0 * packed, found);
            let facing = |j: usize| 0.0 < candidates[i].normal.dot(candidates[j].normal);
            let others = found.iter().filter(|n| n.index as usize != i && facing(n.index as usize));
            others.map(|n| (n.index, weigh(n.distance_squared.sqrt()))).collect()
        })
        .collect();
    let mut weights: Vec<f64> = near.iter().map(|n| n.iter().map(|x| x.1).sum()).collect();
    let mut heap: BinaryHeap<Crowded> =
        weights.iter().zip(0..).map(|(weight, index)| Crowded { weight: *weight, index }).collect();
    let mut gone = vec![false; points.len()];
    let mut left = points.len();
    while count < left {
        let Some(Crowded { weight, index }) = heap.pop() else { break };
        let i = index as usize;
        // An entry whose weight has changed since has a later one in the heap.
        if gone[i] || weight != weights[i] {
            continue;
        }
        gone[i] = true;
        left -= 1;
        for (j, share) in &near[i] {
            let j_index = *j as usize;
            if !gone[j_index] && 0.0 < *share {
                weights[j_index] -= share;
                heap.push(Crowded { weight: weights[j_index], index: *j });
            }
        }
    }
    (0..points.len()).filter(|i| !gone[*i]).collect()
}
