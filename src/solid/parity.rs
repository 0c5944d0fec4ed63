//! From places where a ray may cross a boundary to crossings that alternate: by counting, where every crossing was
//! found exactly once, or by asking for the state between neighbouring places, where some may be none.

use glam::DVec3;

use super::Crossing;
use crate::geom::Ray;

/// Puts what was appended from `start` on in order and lets it alternate, the first an entry unless `inside`. Of
/// several at one `t` an even number goes and of an odd number one stays: the ray passes through no thickness there.
pub fn alternate(out: &mut Vec<Crossing>, start: usize, mut inside: bool) {
    out[start..].sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.part.cmp(&b.part)));
    let mut kept = start;
    for i in start..out.len() {
        if start < kept && out[kept - 1].t == out[i].t {
            kept -= 1;
        } else {
            out[kept] = out[i];
            kept += 1;
        }
    }
    out.truncate(kept);
    for crossing in &mut out[start..] {
        inside = !inside;
        crossing.entering = inside;
    }
}

/// Keeps of the places appended from `start` on those where the state changes: `inside` is asked in the middle of each
/// gap between neighbours; before the first and after the last the ray is outside. Every change must be among the
/// places; places where nothing changes do no harm, nor do places that are no numbers.
pub fn where_it_changes(out: &mut Vec<Crossing>, start: usize, mut inside: impl FnMut(f64) -> bool) {
    out[start..].sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.part.cmp(&b.part)));
    let mut kept = start;
    let mut state = false;
    let count = out.len();
    for i in start..count {
        let here = out[i];
        if !here.t.is_finite() {
            continue;
        }
        let next = out[i + 1..count].first().map_or(f64::INFINITY, |c| c.t);
        let middle = 0.5 * (here.t + next);
        // No number lies between equal or neighbouring ones: the gap has no width.
        if next.is_finite() && (middle <= here.t || next <= middle) {
            continue;
        }
        let after = next.is_finite() && inside(middle);
        if after != state {
            state = after;
            out[kept] = Crossing { entering: after, ..here };
            kept += 1;
        }
    }
    out.truncate(kept);
}

/// Adds `by` to all `t` from `start` on; crossings that meet by that pass through no thickness and go.
pub fn shift(out: &mut Vec<Crossing>, start: usize, by: f64) {
    let inside = out[start..].first().is_some_and(|c| !c.entering);
    for crossing in &mut out[start..] {
        crossing.t += by;
    }
    alternate(out, start, inside);
}

/// A normal, either way round and of any length, turned so that it points out at a crossing; against the ray where
/// there is none.
pub fn outward(normal: DVec3, ray: &Ray, crossing: &Crossing) -> DVec3 {
    let back = if crossing.entering { -ray.dir } else { ray.dir };
    match normal.try_normalize() {
        Some(n) if n.dot(back) < 0.0 => -n,
        Some(n) => n,
        None => back.normalize_or_zero(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(ts: &[f64]) -> Vec<Crossing> {
        ts.iter().map(|t| Crossing::exact(*t, false, 0)).collect()
    }

    fn ends(list: &[Crossing]) -> Vec<(f64, bool)> {
        list.iter().map(|c| (c.t, c.entering)).collect()
    }

    #[test]
    fn pairs_at_one_t_go_and_the_rest_alternates() {
        let mut list = places(&[3.0, 1.0, 2.0, 2.0, 5.0, 3.0, 3.0, 4.0]);
        alternate(&mut list, 0, false);
        assert_eq!(ends(&list), [(1.0, true), (3.0, false), (4.0, true), (5.0, false)]);
    }

    #[test]
    fn places_without_a_change_and_no_numbers_go() {
        let mut list = places(&[f64::NAN, 2.0, 1.0, 2.5, f64::INFINITY, 3.0, 3.0, 7.0]);
        where_it_changes(&mut list, 0, |t| 1.0 < t && t < 3.0);
        assert_eq!(ends(&list), [(1.0, true), (3.0, false)]);
    }
}
