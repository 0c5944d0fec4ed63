//! Leaves that are one and the same: one solid of one call, at one place, used twice. A ray asks it once.

use std::collections::HashMap;
use std::sync::Arc;

use super::leaf::Leaf;

/// For each leaf the first that is the same.
pub(super) fn first_of_same(leaves: &[Leaf]) -> Vec<u32> {
    let mut known = HashMap::with_capacity(leaves.len());
    leaves.iter().zip(0..).map(|(leaf, i)| *known.entry(identity(leaf)).or_insert(i)).collect()
}

/// All that makes an answer of a leaf, and how it counts among those that share a face.
fn identity(leaf: &Leaf) -> impl Eq + std::hash::Hash + use<'_> {
    // Instances share the object, each in a solid of its own.
    let solid = match &leaf.group {
        Some(group) => group.0.address(),
        None => Arc::as_ptr(&leaf.solid).cast::<()>(),
    };
    let place = leaf.place.world_from_local.to_cols_array().map(f64::to_bits);
    (solid, place, &*leaf.name, leaf.material, leaf.cutter, leaf.rank)
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
}
