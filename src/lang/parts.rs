//! What operators and functions of numbers act on: one, or each of a vector.

use super::value::Val;
use crate::source::Span;

/// One number or angle, or those of a vector.
#[derive(Clone, Debug)]
pub enum Parts<T> {
    /// One.
    One(T),
    /// Two to four.
    Many(Vec<T>),
}

impl<T: Copy> Parts<T> {
    /// A function of each.
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Parts<U> {
        match self {
            Parts::One(x) => Parts::One(f(x)),
            Parts::Many(v) => Parts::Many(v.into_iter().map(f).collect()),
        }
    }

    /// A function of each that may fail.
    pub fn try_map<U, E>(self, mut f: impl FnMut(T) -> Result<U, E>) -> Result<Parts<U>, E> {
        Ok(match self {
            Parts::One(x) => Parts::One(f(x)?),
            Parts::Many(v) => Parts::Many(v.into_iter().map(f).collect::<Result<_, E>>()?),
        })
    }

    /// Pairs: part by part, one number with each of the other; `None` for vectors of different sizes.
    pub fn zip(self, other: Parts<T>) -> Option<Parts<(T, T)>> {
        Some(match (self, other) {
            (Parts::One(a), b) => b.map(|b| (a, b)),
            (a, Parts::One(b)) => a.map(|a| (a, b)),
            (Parts::Many(u), Parts::Many(v)) if u.len() == v.len() => {
                Parts::Many(u.into_iter().zip(v).collect())
            }
            _ => return None,
        })
    }
}

impl Parts<f64> {
    /// The value that they make.
    pub fn value(self, of_angles: bool, at: Span) -> Val {
        match self {
            Parts::One(x) if of_angles => Val::Angle(x),
            Parts::One(x) => Val::Number(x),
            Parts::Many(v) => Val::row(v, of_angles, at),
        }
    }
}
