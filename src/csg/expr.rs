//! Set expressions over leaves, as they are written.

use std::sync::Arc;

/// A set expression over leaves. It may be deeper than the stack: it is dropped without recursion.
#[derive(Clone, Debug)]
pub enum Expr {
    /// A leaf, by its index.
    Leaf(u32),
    /// Points not in it.
    Not(Box<Expr>),
    /// Points in any; nothing where there are none.
    Or(Vec<Expr>),
    /// Points in all; must not be empty.
    And(Vec<Expr>),
    /// Points in an odd number.
    Xor(Vec<Expr>),
    /// What stands in several places of the whole: asked once.
    Shared(Arc<Expr>),
}

impl Expr {
    /// Moves what stands right below into `out`.
    fn take_children(&mut self, out: &mut Vec<Expr>) {
        match self {
            Expr::Leaf(_) => {}
            Expr::Not(inner) => out.push(std::mem::replace(inner, Expr::Leaf(0))),
            Expr::Or(list) | Expr::And(list) | Expr::Xor(list) => out.append(list),
            Expr::Shared(inner) => {
                if let Some(inner) = Arc::get_mut(inner) {
                    out.push(std::mem::replace(inner, Expr::Leaf(0)));
                }
            }
        }
    }

    fn is_flat(&self) -> bool {
        match self {
            Expr::Leaf(_) => true,
            Expr::Or(list) | Expr::And(list) | Expr::Xor(list) => list.is_empty(),
            Expr::Not(_) | Expr::Shared(_) => false,
        }
    }
}

impl Drop for Expr {
    fn drop(&mut self) {
        if self.is_flat() {
            return;
        }
        let mut open = Vec::new();
        self.take_children(&mut open);
        while let Some(mut expr) = open.pop() {
            expr.take_children(&mut open);
        }
    }
}
