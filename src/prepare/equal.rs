//! Calls that say the same: they make one solid, however often they are written.

use crate::scene::{Call, Value};

/// All that a call of numbers says, to the bit.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) struct Likeness {
    /// The word and the names of the arguments.
    words: String,
    numbers: Vec<u64>,
}

impl Likeness {
    /// `None` where an argument is more than numbers: a file, a shape, a formula.
    pub fn of(call: &Call) -> Option<Likeness> {
        // Room for what most calls say.
        let mut like = Likeness { words: String::with_capacity(32), numbers: Vec::with_capacity(16) };
        like.words.push_str(&call.word);
        for (name, arg) in &call.args {
            like.words.push(' ');
            like.words.push_str(name);
            like.add(&arg.value)?;
        }
        Some(like)
    }

    fn add(&mut self, value: &Value) -> Option<()> {
        // Each list after its length, so that no two values are written alike.
        match value {
            Value::Number(x) | Value::Angle(x) => self.list(&[*x]),
            Value::Bool(yes) => self.list(&[f64::from(u8::from(*yes))]),
            Value::Vector(all) => self.list(all),
            Value::HalfSpace { normal, offset } => self.list(&[normal.x, normal.y, normal.z, *offset]),
            Value::Points(all) => {
                self.numbers.push(all.len() as u64);
                all.iter().for_each(|p| self.list(&p.to_array()));
            }
            Value::Loops(all) => {
                self.numbers.push(all.len() as u64);
                all.iter().for_each(|points| self.list(points.as_flattened()));
            }
            _ => return None,
        }
        Some(())
    }

    fn list(&mut self, all: &[f64]) {
        self.numbers.push(all.len() as u64);
        self.numbers.extend(all.iter().map(|x| x.to_bits()));
    }
}
