//! The leaves that rays which go together may meet, found once for all of them.

use super::hierarchy::{Child, Hierarchy};
use super::object::{Core, Object};
use crate::geom::Beam;
use crate::solid::Cost;

/// Of more leaves than this each ray finds its own: most would be asked for nothing.
const MOST: usize = 8;

/// A beam is cut into finer ones: so many more are kept for them.
const MOST_OF_COARSE: usize = 32;

/// Leaves of an object that rays of a beam may meet.
#[derive(Clone, Debug)]
pub struct Bundle {
    /// `None` where they are too many to be kept.
    leaves: Option<Vec<u32>>,
    /// Which they are of an object that has a handful in all, as bits.
    pub(super) slots: u64,
}

impl Default for Bundle {
    fn default() -> Bundle {
        Bundle { leaves: None, slots: u64::MAX }
    }
}

impl Bundle {
    fn new(core: &Core, leaves: Option<Vec<u32>>) -> Bundle {
        let slots = core.handful.as_ref().zip(leaves.as_ref()).map(|(handful, list)| handful.slots_of(list));
        Bundle { leaves, slots: slots.unwrap_or(u64::MAX) }
    }

    /// Whether all leaves may be met, also behind the origin.
    pub(super) fn is_of_all(&self) -> bool {
        self.leaves.is_none()
    }

    /// They, where they are so few, all of closed form, that each ray shall ask them all.
    #[inline]
    pub(super) fn few(&self, core: &Core) -> Option<&[u32]> {
        let leaves = self.leaves.as_deref().filter(|leaves| leaves.len() <= MOST)?;
        leaves.iter().all(|leaf| core.costs[*leaf as usize] == Cost::Closed).then_some(leaves)
    }
}

impl Object {
    /// The leaves that rays of a beam may meet.
    pub fn bundle(&self, beam: &Beam) -> Bundle {
        Bundle::new(self.core(), touched(&self.core().hierarchy, beam))
    }

    /// The same for a beam within that of a bundle.
    pub fn part_of_bundle(&self, bundle: &Bundle, beam: &Beam) -> Bundle {
        let Some(leaves) = &bundle.leaves else { return Bundle::default() };
        let hierarchy = &self.core().hierarchy;
        let grow = hierarchy.grow(beam.origin);
        let met = |leaf: &u32| !beam.misses(&hierarchy.boxes[*leaf as usize], grow);
        Bundle::new(self.core(), Some(leaves.iter().copied().filter(met).collect()))
    }
}

/// The leaves whose boxes a beam touches; `None` where they are many.
fn touched(hierarchy: &Hierarchy, beam: &Beam) -> Option<Vec<u32>> {
    let grow = hierarchy.grow(beam.origin);
    let mut leaves = hierarchy.wide.clone();
    let mut open: Vec<u32> = (0..hierarchy.nodes.len().min(1) as u32).collect();
    while let Some(node) = open.pop() {
        for (child, bounds) in hierarchy.children(node) {
            match child {
                Child::Leaf(leaf) if !beam.misses(&hierarchy.boxes[leaf as usize], grow) => leaves.push(leaf),
                Child::Node(node) if !beam.misses(&bounds, grow) => open.push(node),
                _ => {}
            }
        }
        if MOST_OF_COARSE < leaves.len() {
            return None;
        }
    }
    Some(leaves)
}
