//! Signs for normals: along the edges that leave least doubt, then for each connected piece as a whole.

use glam::DVec3;

use super::contract::contract;
use super::{Scene, estimate};
use crate::cloud::groups::Groups;
use crate::cloud::neighbours::Table;
use crate::cloud::winding::Winding;

/// Neighbours of the graph: those around a sample even where it lies in rows, as scan lines do.
const GRAPH: usize = 10;

/// Neighbours that agreement is measured with.
const NEAREST: usize = 6;

/// Pieces that may hold other pieces have at least this many samples, and only so many of the largest are asked.
const HOLDER: usize = 100;
/// See [`HOLDER`].
const HOLDERS: usize = 32;

/// Samples of a piece that are asked whether they lie in another.
const PROBES: usize = 9;

/// A piece with less volume than this share of area times distance has no inside that volume could tell.
const FLAT: f64 = 0.02;

/// How much two samples speak for equal signs (1) or opposite ones (-1): `n_i . n_j'`, where `n_j'` is `n_j`
/// mirrored in the plane across the edge. On an arc between the two it is 1 (Koenig and Gumhold 2009);
/// for the two sides of a thin wall the edge runs along the normals and it is -1 for equal normals, so
/// that sheets back to back get opposite signs; where it is near 0 the edge says nothing.
///
/// The second value is how much the edge runs along the surface, 1 where it is tangent: noisy layers of one surface
/// look like a thin wall to an edge across them, so such edges are trusted last.
fn accord(p: DVec3, q: DVec3, n: DVec3, m: DVec3) -> (f64, f64) {
    let e = (q - p).normalize_or_zero();
    let (a, b) = (e.dot(n), e.dot(m));
    (n.dot(m) - 2.0 * a * b, (1.0 - (a * a).max(b * b)).max(0.0))
}

/// How signs spread over the graph of nearest neighbours.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Spread {
    /// Along a minimum spanning tree with the weight `1 - |accord| tangency` (Hoppe et al. 1992, whose weight is
    /// `1 - |n_i . n_j|`).
    Tree,
    /// By contraction, where single edges are not to be trusted; some ten times the time.
    Borders,
}

/// Gives signs to unit normals: spreads them over the graph of nearest neighbours, then turns each connected piece outward, and those inside an odd number of others inward, as the walls of a cavity.
pub fn orient(scene: Scene<'_>, areas: &[f64], normals: &mut [DVec3], spread: Spread) {
    let mut groups = match spread {
        Spread::Tree => spanning_tree(scene, normals),
        Spread::Borders => contracted(scene, normals),
    };
    for (i, normal) in normals.iter_mut().enumerate() {
        if groups.find(i).1 {
            *normal = -*normal;
        }
    }
    let labels = groups.labels();
    let mut order: Vec<u32> = (0..labels.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (labels[i as usize], i));
    let mut pieces: Vec<&[u32]> = order.chunk_by(|&i, &j| labels[i as usize] == labels[j as usize]).collect();
    pieces.sort_by_key(|piece| (std::cmp::Reverse(piece.len()), piece[0]));
    for piece in &pieces {
        if Shape::of(scene.points, normals, areas, piece).is_inward() {
            piece.iter().for_each(|&i| normals[i as usize] = -normals[i as usize]);
        }
    }
    turn_cavities(scene.points, areas, &pieces, normals);
}

/// Signs by the vote of whole borders between patches: see [`super::contract`].
fn contracted(scene: Scene<'_>, normals: &[DVec3]) -> Groups {
    let Scene { points, table, .. } = scene;
    let mut edges = Vec::with_capacity(points.len() * GRAPH);
    for i in 0..points.len() {
        for &j in table.row(i).iter().take(GRAPH) {
            let (a, b) = (i.min(j as usize), i.max(j as usize));
            let (accord, tangent) = accord(points[a], points[b], normals[a], normals[b]);
            edges.push((a as u32, b as u32, accord * tangent));
        }
    }
    contract(points.len(), &edges)
}

fn spanning_tree(scene: Scene<'_>, normals: &[DVec3]) -> Groups {
    let Scene { points, table, .. } = scene;
    let mut edges = Vec::with_capacity(points.len() * GRAPH);
    for i in 0..points.len() {
        for &j in table.row(i).iter().take(GRAPH) {
            let (a, b) = (i.min(j as usize), i.max(j as usize));
            let (accord, tangent) = accord(points[a], points[b], normals[a], normals[b]);
            // 2^-24 of the weight's range is finer than any estimate; integers sort fast and without surprise.
            let doubt = ((1.0 - accord.abs() * tangent).clamp(0.0, 1.0) * f64::from(1u32 << 24)) as u32;
            edges.push((doubt, a as u32, b as u32, accord < 0.0));
        }
    }
    edges.sort_unstable();
    let mut groups = Groups::new(points.len());
    for (_, a, b, opposed) in edges {
        groups.join_signed(a as usize, b as usize, opposed);
    }
    groups
}

/// Turns each piece that lies inside an odd number of other pieces, all pointing outward before.
fn turn_cavities(points: &[DVec3], areas: &[f64], pieces: &[&[u32]], normals: &mut [DVec3]) {
    if pieces.len() < 2 {
        return;
    }
    let pick = |piece: &[u32], from: &[DVec3]| piece.iter().map(|&i| from[i as usize]).collect::<Vec<_>>();
    let mut depth = vec![0; pieces.len()];
    for (holder, piece) in pieces.iter().enumerate().take(HOLDERS).filter(|(_, p)| HOLDER <= p.len()) {
        let own: Vec<f64> = piece.iter().map(|&i| areas[i as usize]).collect();
        let winding = Winding::new(&pick(piece, points), &pick(piece, normals), &own, Winding::OPENING);
        for (other, depth) in pieces.iter().zip(&mut depth).skip(holder + 1) {
            let probe = |k: usize| points[other[k * (other.len() - 1) / (PROBES - 1)] as usize];
            let inside = (0..PROBES).filter(|&k| 0.5 < winding.value(probe(k))).count();
            *depth += usize::from(PROBES < 2 * inside);
        }
    }
    for (piece, _) in pieces.iter().zip(depth).filter(|(_, depth)| depth % 2 == 1) {
        piece.iter().for_each(|&i| normals[i as usize] = -normals[i as usize]);
    }
}

/// Sums over a piece of surface.
pub struct Shape {
    /// Of all samples.
    pub area: f64,
    /// `sum a n`.
    pub vector_area: DVec3,
    /// `sum a (p - c).n / 3`, `c` the mean place.
    pub volume: f64,
    /// `sum a |p - c| / 3`, which the volume cannot exceed.
    most: f64,
}

impl Shape {
    /// Sums over the samples of a piece.
    pub fn of(points: &[DVec3], normals: &[DVec3], areas: &[f64], piece: &[u32]) -> Shape {
        let at = |i: u32| (points[i as usize], normals[i as usize], areas[i as usize]);
        let area: f64 = piece.iter().map(|&i| areas[i as usize]).sum();
        let moment = piece.iter().fold(DVec3::ZERO, |sum, &i| sum + at(i).0 * at(i).2);
        let center = if 0.0 < area { moment / area } else { points[piece[0] as usize] };
        let empty = Shape { area, vector_area: DVec3::ZERO, volume: 0.0, most: 0.0 };
        piece.iter().fold(empty, |sum, &i| {
            let (p, n, a) = at(i);
            Shape {
                area,
                vector_area: sum.vector_area + n * a,
                volume: sum.volume + a * (p - center).dot(n) / 3.0,
                most: sum.most + a * (p - center).length() / 3.0,
            }
        })
    }

    /// Whether the normals point inward by volume; for a flat sheet, whether they point against the axis
    /// nearest to them, so that terrain faces up.
    fn is_inward(&self) -> bool {
        if FLAT * self.most < self.volume.abs() {
            return self.volume < 0.0;
        }
        let axis = self.vector_area.abs().max_position();
        self.vector_area[axis] < 0.0
    }
}

/// The share of pairs of a sample and one of its nearest whose normals are opposed.
pub fn agreement(normals: &[DVec3], table: &Table) -> f64 {
    let k = table.k().min(NEAREST);
    let count: usize = (0..normals.len()).map(|i| opposed(normals, table, i)).sum();
    count as f64 / (normals.len() * k).max(1) as f64
}

/// Samples that all of their nearest but one or none are opposed to: turned by mistake, or on a sharp edge.
pub fn outvoted(normals: &[DVec3], table: &Table) -> Vec<u32> {
    let most = table.k().clamp(2, NEAREST) - 1;
    (0..normals.len() as u32).filter(|i| most <= opposed(normals, table, *i as usize)).collect()
}

/// How many of the nearest are opposed to a sample.
fn opposed(normals: &[DVec3], table: &Table, i: usize) -> usize {
    let nearest = &table.row(i)[..table.k().min(NEAREST)];
    nearest.iter().filter(|&&j| normals[i].dot(normals[j as usize]) < 0.0).count()
}

/// Estimates the normals that are zero, with the sign of their neighbours; returns how many.
pub fn fill_missing(scene: Scene<'_>, normals: &mut [DVec3]) -> usize {
    let Scene { points, table, .. } = scene;
    let mut open: Vec<usize> = (0..normals.len()).filter(|&i| normals[i] == DVec3::ZERO).collect();
    let missing = open.len();
    while !open.is_empty() {
        let vote = |i: usize| {
            let n = estimate::normal(points, i, table);
            let given = table.row(i).iter().map(|&j| j as usize).filter(|&j| normals[j] != DVec3::ZERO);
            let votes = given
                .map(|j| accord(points[i], points[j], n, normals[j]))
                .map(|(accord, tangent)| accord * tangent);
            votes.reduce(|a, b| a + b).map(|sum| if sum < 0.0 { -n } else { n })
        };
        // All of one round see the same neighbours, whatever their order.
        let found: Vec<Option<DVec3>> = open.iter().map(|&i| vote(i)).collect();
        let stuck = found.iter().all(Option::is_none);
        for (&i, n) in open.iter().zip(&found) {
            let alone = || if stuck { estimate::normal(points, i, table) } else { DVec3::ZERO };
            normals[i] = n.unwrap_or_else(alone);
        }
        open.retain(|&i| normals[i] == DVec3::ZERO);
    }
    missing
}
