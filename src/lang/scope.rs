//! Names of blocks, loops and parameters: a list from the innermost outward, shared by what was made in it.

use std::sync::Arc;

use super::value::Val;

/// The names around an expression within an item; empty at its top.
#[derive(Clone, Debug, Default)]
pub struct Locals(Option<Arc<Binding>>);

#[derive(Debug)]
struct Binding {
    name: String,
    value: Val,
    outer: Locals,
}

impl Locals {
    /// One more name, which hides an outer one.
    pub fn with(&self, name: &str, value: Val) -> Locals {
        Locals(Some(Arc::new(Binding { name: name.to_owned(), value, outer: self.clone() })))
    }

    /// The value of the innermost of a name, and how many names were compared.
    pub fn get(&self, name: &str) -> (Option<&Val>, usize) {
        let mut seen = 0;
        let found = self.bindings().inspect(|_| seen += 1).find(|b| b.name == name);
        (found.map(|b| &b.value), seen)
    }

    /// All names, the innermost first.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bindings().map(|b| b.name.as_str())
    }

    fn bindings(&self) -> impl Iterator<Item = &Binding> {
        std::iter::successors(self.0.as_deref(), |b| b.outer.0.as_deref())
    }
}

/// Without recursion: a block may bind thousands of names.
impl Drop for Locals {
    fn drop(&mut self) {
        let mut next = self.0.take();
        while let Some(mut binding) = next.and_then(Arc::into_inner) {
            next = binding.outer.0.take();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inner_names_hide_outer_ones_and_long_lists_are_dropped() {
        let mut locals = Locals::default().with("a", Val::Number(1.0)).with("a", Val::Number(2.0));
        assert!(matches!(locals.get("a"), (Some(Val::Number(2.0)), 1)) && locals.get("b").0.is_none());
        for i in 0..1_000_000 {
            locals = locals.with("c", Val::Number(f64::from(i)));
        }
        assert_eq!(locals.names().last(), Some("a"));
    }
}
