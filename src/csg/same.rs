//! Leaves that are one and the same: one solid of one call, at one place, used twice; or equal solids at one place that stand
//! side by side in a union or an intersection. A ray asks them once.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::Arc;

use super::leaf::Leaf;

/// For each leaf the first that is the same.
pub(super) fn first_of_same(leaves: &[Leaf]) -> Vec<u32> {
    if !share_a_solid(leaves.iter()) {
        return (0..leaves.len() as u32).collect();
    }
    let mut known = HashMap::with_capacity(leaves.len());
    leaves.iter().zip(0..).map(|(leaf, i)| *known.entry(identity(leaf)).or_insert(i)).collect()
}

/// Of leaves that stand side by side in a union or an intersection, all in one sense and nowhere else, and are alike in all
/// but their names and ranks, keeps the one that owns what they share: whatever changes with one changes with the other.
/// `last` holds for each leaf the rank by which it fills: that of the last of those that it now stands for.
pub(super) fn keep_owners(leaves: &[Leaf], side_by_side: &mut Vec<u32>, last: &mut [u64]) {
    if !share_a_solid(side_by_side.iter().map(|leaf| &leaves[*leaf as usize])) {
        return;
    }
    let mut owners = HashMap::with_capacity(side_by_side.len());
    let owner_key = |leaf: u32| (leaves[leaf as usize].key(), leaf);
    for &leaf in side_by_side.iter() {
        let owner = owners.entry(likeness(&leaves[leaf as usize])).or_insert(leaf);
        if owner_key(leaf) < owner_key(*owner) {
            *owner = leaf;
        }
    }
    side_by_side.retain(|leaf| {
        let owner = owners[&likeness(&leaves[*leaf as usize])];
        last[owner as usize] = last[owner as usize].max(last[*leaf as usize]);
        owner == *leaf
    });
}

/// All that makes an answer of a leaf, and how it counts among those that share a face.
fn identity(leaf: &Leaf) -> impl Eq + Hash + use<'_> {
    (likeness(leaf), &*leaf.name, leaf.rank)
}

/// All that makes an answer of a leaf, and how it shows.
fn likeness(leaf: &Leaf) -> impl Eq + Hash + use<> {
    let place = leaf.place.world_from_local.to_cols_array().map(f64::to_bits);
    (solid(leaf), place, leaf.material, leaf.cutter)
}

/// The address of what a leaf places: instances share the object, each in a solid of its own.
fn solid(leaf: &Leaf) -> *const () {
    match &leaf.group {
        Some(group) => group.0.address(),
        None => Arc::as_ptr(&leaf.solid).cast::<()>(),
    }
}

/// Whether any two leaves place one solid; mostly none do, and nothing more needs to be compared.
fn share_a_solid<'a>(leaves: impl Iterator<Item = &'a Leaf>) -> bool {
    let mut solids: Vec<*const ()> = leaves.map(solid).collect();
    solids.sort_unstable();
    solids.windows(2).any(|pair| pair[0] == pair[1])
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::*;
    use crate::geom::Placement;
    use crate::solid::sphere::Sphere;

    #[test]
    fn leaves_are_the_same_by_solid_place_and_call() {
        let ball = || Arc::new(Sphere { center: DVec3::ZERO, radii: DVec3::ONE });
        let one = Leaf::new(ball(), Placement::IDENTITY);
        let moved = Placement::new(DAffine3::from_translation(DVec3::X)).unwrap();
        let mut ranked = one.clone();
        ranked.rank = 1;
        let leaves = [
            one.clone(),
            Leaf::new(ball(), Placement::IDENTITY),
            one.clone(),
            Leaf::new(one.solid.clone(), moved),
            ranked.clone(),
            ranked,
        ];
        assert_eq!(first_of_same(&leaves), [0, 1, 0, 3, 4, 4]);
    }

    #[test]
    fn of_leaves_alike_the_owner_is_kept() {
        let solid = Arc::new(Sphere { center: DVec3::ZERO, radii: DVec3::ONE });
        let ranked = |rank: u64| Leaf { rank, ..Leaf::new(solid.clone(), Placement::IDENTITY) };
        let leaves = [
            ranked(5),
            ranked(3),
            Leaf { material: Some(1), ..ranked(4) },
            Leaf { cutter: true, ..ranked(1) },
            Leaf { material: Some(1), ..ranked(2) },
        ];
        let (mut all, mut last) = (vec![0, 1, 2, 3, 4], [5, 3, 4, 1, 2]);
        keep_owners(&leaves, &mut all, &mut last);
        assert_eq!((all, [last[1], last[3], last[4]]), (vec![1, 3, 4], [5, 1, 4]));
    }
}
