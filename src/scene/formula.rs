//! A condition on x, y and z as it was written: which points a formula holds for. What it means along a ray is left to
//! those who trace it.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

/// One step of a formula. Operands are indices of earlier steps; angles are radians.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub enum Step {
    /// A coordinate: 0 for x, 1 for y, 2 for z.
    Coordinate(u8),
    /// A finite number.
    Number(f64),
    /// A function of one operand.
    One(One, u32),
    /// A function of two operands.
    Two(Two, u32, u32),
    /// A whole power; the exponent is not 0.
    Power(u32, i32),
}

/// Functions of one number.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum One {
    Negate,
    Sqrt,
    Abs,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Exp,
    Ln,
    Floor,
    Ceil,
    /// To the nearest whole number, halves away from zero.
    Round,
}

/// Functions of two numbers.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum Two {
    Add,
    Subtract,
    Multiply,
    Divide,
    Min,
    Max,
    /// The angle of the point (second, first).
    Atan2,
    /// The first to the power of the second.
    Power,
}

/// Points where the value of the last step is below zero, or is zero where `closed`.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Formula {
    /// The steps, each after its operands; equal ones are one.
    pub steps: Vec<Step>,
    /// Whether points of value zero belong to it (`<=`, not `<`).
    pub closed: bool,
}

/// Builds the steps of a formula; equal steps are found by their bits.
#[derive(Debug, Default)]
pub struct Builder {
    steps: Vec<Step>,
    known: HashMap<(u8, u8, u64, u64), u32>,
}

impl Builder {
    /// The index of a step, which is added where it is new.
    pub fn add(&mut self, step: Step) -> u32 {
        // x * x is a square: an interval that squares once knows that the result is not negative.
        let step = match step {
            Step::Two(Two::Multiply, a, b) if a == b => Step::Power(a, 2),
            // Sums and products do not change when their operands change places.
            Step::Two(op @ (Two::Add | Two::Multiply), a, b) if b < a => Step::Two(op, b, a),
            step => step,
        };
        let key = match step {
            Step::Coordinate(axis) => (0, axis, 0, 0),
            Step::Number(x) => (1, 0, x.to_bits(), 0),
            Step::One(op, a) => (2, op as u8, u64::from(a), 0),
            Step::Two(op, a, b) => (3, op as u8, u64::from(a), u64::from(b)),
            Step::Power(a, n) => (4, 0, u64::from(a), n as u64),
        };
        let steps = &mut self.steps;
        *self.known.entry(key).or_insert_with(|| {
            steps.push(step);
            steps.len() as u32 - 1
        })
    }

    /// The number that a step is, if it is one.
    pub fn constant(&self, index: u32) -> Option<f64> {
        match self.steps[index as usize] {
            Step::Number(x) => Some(x),
            _ => None,
        }
    }

    /// How many steps there are.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// The formula whose value is that of a step; steps that it does not need are left out.
    pub fn finish(self, last: u32, closed: bool) -> Formula {
        let mut needed = vec![false; self.steps.len()];
        needed[last as usize] = true;
        for i in (0..=last as usize).rev() {
            if needed[i] {
                operands(&self.steps[i]).into_iter().flatten().for_each(|j| needed[j as usize] = true);
            }
        }
        let mut place = vec![0u32; self.steps.len()];
        let mut steps = Vec::new();
        for (i, step) in self.steps.into_iter().enumerate().filter(|(i, _)| needed[*i]) {
            place[i] = steps.len() as u32;
            let at = |j: u32| place[j as usize];
            steps.push(match step {
                Step::One(op, a) => Step::One(op, at(a)),
                Step::Two(op, a, b) => Step::Two(op, at(a), at(b)),
                Step::Power(a, n) => Step::Power(at(a), n),
                plain => plain,
            });
        }
        Formula { steps, closed }
    }
}

fn operands(step: &Step) -> [Option<u32>; 2] {
    match step {
        Step::One(_, a) | Step::Power(a, _) => [Some(*a), None],
        Step::Two(_, a, b) => [Some(*a), Some(*b)],
        _ => [None, None],
    }
}
