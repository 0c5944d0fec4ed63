//! The solids of a world by what fills them, for light that goes through some of them.

use std::mem;

use super::outline::Outline;
use crate::csg::{Expr, Leaf, Object};
use crate::shot::{Clear, Material, World};

/// Adds what light needs that goes through solids; a world without clear solids stays as it is.
pub(super) fn with_clear(world: World, outline: &mut Outline, materials: &[Material]) -> World {
    let leaves = world.solids().leaves();
    let fillings: Vec<Option<u32>> = outline.parts.iter().map(|part| part.clear).collect();
    let mut clear: Vec<u32> = fillings.iter().copied().flatten().collect();
    clear.sort_unstable_by(|a, b| {
        precedence(*b, materials).total_cmp(&precedence(*a, materials)).then(b.cmp(a))
    });
    clear.dedup();
    if clear.is_empty() {
        return world;
    }
    let shares = [None].into_iter().chain(clear.into_iter().map(Some));
    let object = |wanted: Option<u32>| {
        // Expressions may be deeper than the stack: they are lent, not copied.
        let chosen = || fillings.iter().enumerate().filter(|(_, f)| **f == wanted).map(|(i, _)| i);
        let mut lent = |i: usize| mem::replace(&mut outline.parts[i].expr, Expr::Or(Vec::new()));
        let mut whole = Expr::Or(chosen().map(&mut lent).collect());
        let object = Object::new(leaves.to_vec(), &whole);
        if let Expr::Or(list) = &mut whole {
            for (i, expr) in chosen().zip(mem::take(list)) {
                outline.parts[i].expr = expr;
            }
        }
        (wanted, object)
    };
    let shares: Vec<_> = shares.map(object).collect();
    world.with_clear(Clear::new(shares))
}

/// The clear material of what is drawn, made of some leaves; of several the one that wins.
pub(super) fn filling(leaves: &[Leaf], materials: &[Material]) -> Option<u32> {
    let mut worn = Vec::new();
    leaves.iter().for_each(|leaf| leaf.materials(&mut worn));
    let clear = worn.into_iter().filter(|i| Material::of(materials, *i).is_clear());
    clear.max_by(|a, b| precedence(*a, materials).total_cmp(&precedence(*b, materials)).then(a.cmp(b)))
}

fn precedence(material: u32, materials: &[Material]) -> f64 {
    Material::of(materials, material).finish.glass().map_or(0.0, |glass| glass.priority)
}
