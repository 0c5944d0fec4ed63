//! Points at one and the same position become one sample; samples that are near in space lie near in memory.

use glam::DVec3;

use super::{Cloud, order};

/// Normals of one position whose sum is shorter than this share of their number cancel: their mean would be
/// more than 84 degrees from one of two, and points along the surface rather than out of it.
const CANCELLED: f64 = 0.1;

/// Merges points of equal position: their normals are summed (missing where they cancel), their colours
/// averaged. The points come back in Morton order, those of one cell by position, so that their order in the file is forgotten.
pub fn merge_duplicates(cloud: Cloud) -> Cloud {
    let Cloud { points, normals, colors, dropped, mut notes } = cloud;
    let key = |i: u32| {
        let i = i as usize;
        let n = normals.as_ref().map_or(DVec3::ZERO, |n| n[i]).to_array();
        let c = colors.as_ref().map_or([0.0; 3], |c| c[i]);
        (points[i].to_array(), n, c)
    };
    let mut order = order::morton(&points);
    for cell in order.chunk_by_mut(|a, b| a.0 == b.0).filter(|cell| 1 < cell.len()) {
        // By normal and colour too: sums of one position must not depend on the order of the file.
        cell.sort_unstable_by(|&(_, i), &(_, j)| {
            let (a, b) = (key(i), key(j));
            let position = compare(&a.0, &b.0, f64::total_cmp);
            position
                .then_with(|| compare(&a.1, &b.1, f64::total_cmp))
                .then_with(|| compare(&a.2, &b.2, f32::total_cmp))
        });
    }
    let order: Vec<u32> = order.into_iter().map(|(_, i)| i).collect();
    let mut merged = Cloud {
        points: Vec::with_capacity(points.len()),
        normals: normals.as_ref().map(|_| Vec::with_capacity(points.len())),
        colors: colors.as_ref().map(|_| Vec::with_capacity(points.len())),
        dropped,
        notes: Vec::new(),
    };
    let mut cancelled = 0;
    for group in order.chunk_by(|&i, &j| points[i as usize] == points[j as usize]) {
        merged.points.push(points[group[0] as usize]);
        if let (Some(from), Some(to)) = (&normals, &mut merged.normals) {
            let given = group.iter().map(|&i| from[i as usize]).filter(|n| *n != DVec3::ZERO);
            let (count, sum) = given.fold((0, DVec3::ZERO), |(count, sum), n| (count + 1, sum + n));
            let holds = CANCELLED * f64::from(count) < sum.length();
            cancelled += usize::from(0 < count && !holds);
            to.push(match count {
                // Stays as it was, to the bit.
                1 => sum,
                _ if holds => sum.normalize(),
                _ => DVec3::ZERO,
            });
        }
        if let (Some(from), Some(to)) = (&colors, &mut merged.colors) {
            let sum =
                group.iter().fold([0.0f32; 3], |s, &i| std::array::from_fn(|c| s[c] + from[i as usize][c]));
            to.push(sum.map(|s| s / group.len() as f32));
        }
    }
    let gone = points.len() - merged.points.len();
    if 0 < gone {
        notes.push(format!("{gone} points at the position of another were merged with it"));
    }
    if 0 < cancelled {
        notes.push(format!("{cancelled} positions have normals that cancel, which count as missing"));
    }
    Cloud { notes, ..merged }
}

fn compare<T>(a: &[T; 3], b: &[T; 3], by: fn(&T, &T) -> std::cmp::Ordering) -> std::cmp::Ordering {
    by(&a[0], &b[0]).then_with(|| by(&a[1], &b[1])).then_with(|| by(&a[2], &b[2]))
}
