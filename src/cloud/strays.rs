//! Which samples are strays: too few and too far from the others to carry a surface.

use glam::DVec3;

use super::groups::Groups;
use super::neighbours::Table;

/// Groups of fewer samples are strays: twice the six coefficients of a quadratic polynomial, which is
/// how many samples a weight of ordinary width holds.
pub const LEAST_GROUP: usize = 12;

/// Whether each sample is a stray: a member of a group of fewer than [`LEAST_GROUP`] samples, where two samples
/// belong together if each lies within the other's width and one is among the other's nearest.
///
/// The rule is relative: a lone sample's own width reaches far, but those of the surface beside it do not
/// reach back. A cloud of fewer samples has no strays.
pub fn strays(points: &[DVec3], widths: &[f64], table: &Table) -> Vec<bool> {
    let mut groups = Groups::new(points.len());
    for (i, p) in points.iter().enumerate() {
        for &j in table.row(i) {
            let j = j as usize;
            if p.distance(points[j]) <= widths[i].min(widths[j]) {
                groups.join(i, j);
            }
        }
    }
    let labels = groups.labels();
    let mut sizes = vec![0usize; points.len()];
    labels.iter().for_each(|&l| sizes[l as usize] += 1);
    let largest = sizes.iter().copied().max().unwrap_or(0);
    labels.iter().map(|&l| sizes[l as usize] < LEAST_GROUP.min(largest)).collect()
}
