//! What the evaluation of a scene may cost. Steps bound its time: each part of an expression that is evaluated is one, and so
//! is each element that a builtin goes through. Bytes bound its memory: lists give theirs back, shapes, materials and
//! functions are taken to stay.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::value::{Eval, Located, Val};
use crate::diag::Diagnostic;
use crate::scene::{Arg, Call, Value};
use crate::source::Span;

/// Steps, at most.
const MAX_STEPS: usize = 20_000_000;

/// Names that are compared with unknown ones in messages, at most: of twenty thousand names those of the first twenty errors,
/// and more are not shown.
const MAX_LOOKS: usize = 400_000;

/// Comparisons of names that make a step.
pub const CHEAP: usize = 8;

/// What some values take, bytes with what the allocator adds; measured, not exact.
pub const NODE: usize = 240;
pub const OPERAND: usize = 32;
pub const CLOSURE: usize = 300;
pub const RECORD: usize = 1200;
const CALL: usize = 400;
const ARGUMENT: usize = 32 + size_of::<(String, Arg)>();

/// What is left for an evaluation.
#[derive(Debug)]
pub struct Budget {
    steps: Cell<usize>,
    looks: Cell<usize>,
    held: Arc<AtomicU64>,
    memory: u64,
}

/// Bytes that are given back when this is dropped.
#[derive(Debug)]
pub struct Held {
    bytes: u64,
    of: Arc<AtomicU64>,
}

impl Drop for Held {
    fn drop(&mut self) {
        self.of.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

impl Budget {
    /// A budget of so many bytes.
    pub fn new(memory: u64) -> Budget {
        Budget { steps: Cell::new(0), looks: Cell::new(0), held: Arc::default(), memory }
    }

    /// Counts steps.
    pub fn spend(&self, steps: usize, at: Span) -> Eval<()> {
        let spent = self.steps.get().saturating_add(steps);
        self.steps.set(spent);
        if spent <= MAX_STEPS {
            return Ok(());
        }
        Err(Diagnostic::error("E0709", format!("the scene takes more than {MAX_STEPS} steps"))
            .at(at, "here it is given up")
            .help("does a loop or a recursion come to an end?")
            .into())
    }

    /// Whether a message may look through so many names; counts them.
    pub fn may_look(&self, names: usize) -> bool {
        let looks = self.looks.get().saturating_add(names);
        if looks <= MAX_LOOKS {
            self.looks.set(looks);
        }
        looks <= MAX_LOOKS
    }

    /// Takes bytes for good.
    pub fn keep(&self, bytes: usize, at: Span) -> Eval<()> {
        let held = self.held.fetch_add(bytes as u64, Ordering::Relaxed) + bytes as u64;
        if held <= self.memory {
            return Ok(());
        }
        let told = format!("the scene takes more than {} MiB of memory", self.memory >> 20);
        Err(Diagnostic::error("E0710", told)
            .at(at, "here it is given up")
            .help("make fewer or shorter lists, or use one shape many times: `shape.array(list)`")
            .into())
    }

    /// Nothing yet.
    pub fn hold(&self) -> Held {
        Held { bytes: 0, of: self.held.clone() }
    }

    /// Takes bytes more.
    pub fn grow(&self, held: &mut Held, bytes: usize, at: Span) -> Eval<()> {
        held.bytes += bytes as u64;
        self.keep(bytes, at)
    }
}

/// What an element of a list takes; shared texts count each time.
pub fn weight(item: &Located) -> usize {
    size_of::<Located>()
        + match &item.value {
            Val::Text(text, _) => text.len() + 32,
            // Vectors are not counted where they are made.
            Val::List(list) if list.items.len() <= 4 => 64 + list.items.len() * size_of::<Located>(),
            _ => 0,
        }
}

/// What a builtin made, beside lists and operands.
pub fn made(value: &Val) -> usize {
    match value {
        Val::Shape(_) => NODE,
        Val::Record(_) => RECORD,
        _ => 0,
    }
}

/// What the call of a declared thing takes.
pub fn call(call: &Call) -> usize {
    let args = call.args.values().map(|arg| match &arg.value {
        Value::Points(points) => 24 * points.len(),
        Value::Loops(loops) => loops.iter().map(|l| 24 + 16 * l.len()).sum(),
        Value::Texts(texts) => texts.iter().map(|t| 40 + t.len()).sum(),
        Value::Text(text) => text.len(),
        Value::Path { text, base, .. } => text.len() + base.as_os_str().len(),
        Value::Formula(formula) => size_of_val(formula.steps.as_slice()),
        _ => 32,
    });
    CALL + args.sum::<usize>() + call.args.len() * ARGUMENT
}
