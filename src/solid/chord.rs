//! Where a line is inside a convex solid.

use super::{Answer, Crossing};

/// The part of a ray's line inside a convex solid, known in closed form: from where it goes in to where it comes out.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Chord {
    /// In multiples of the ray's direction; an infinite one is no crossing.
    pub ends: [f64; 2],
    /// Which part of the boundary each end is on ([`Crossing::part`]).
    pub parts: [u32; 2],
}

impl Chord {
    /// Of a line that passes by.
    pub const NONE: Chord = Chord { ends: [f64::INFINITY, f64::NEG_INFINITY], parts: [0; 2] };

    /// Between two ends, each with its part; none where they do not enclose anything.
    #[inline]
    pub fn between(enter: (f64, u32), exit: (f64, u32)) -> Chord {
        if enter.0 < exit.0 {
            Chord { ends: [enter.0, exit.0], parts: [enter.1, exit.1] }
        } else {
            Chord::NONE
        }
    }

    /// Whether nothing of the line is inside, for a sound chord.
    #[inline]
    pub fn is_none(&self) -> bool {
        self.ends[0] == f64::INFINITY
    }

    /// Whether it is what a chord may be: its ends are numbers in order, and no crossing is infinitely far away.
    #[inline]
    pub fn is_sound(&self) -> bool {
        let [lo, hi] = self.ends;
        lo <= hi && lo < f64::INFINITY && f64::NEG_INFINITY < hi || *self == Chord::NONE
    }

    /// Whether the line comes from inside.
    #[inline]
    pub fn begins_inside(&self) -> bool {
        self.ends[0] == f64::NEG_INFINITY
    }

    /// The same as an answer for the whole line: appends the crossings. Ends that are not sound become crossings that are
    /// not.
    #[inline]
    pub fn answer(&self, out: &mut Vec<Crossing>) -> Answer {
        if *self != Chord::NONE {
            let [(lo, enter), (hi, exit)] = [0, 1].map(|end| (self.ends[end], self.parts[end]));
            if lo != f64::NEG_INFINITY {
                out.push(Crossing::exact(lo, true, enter));
            }
            if hi != f64::INFINITY {
                out.push(Crossing::exact(hi, false, exit));
            }
        }
        Answer::whole_line(self.begins_inside())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Body;

    const PARTS: [u32; 2] = [3, 5];

    #[test]
    fn a_chord_is_sound_exactly_where_the_crossings_it_stands_for_are() {
        let numbers = [f64::NEG_INFINITY, -1.0, 0.0, 2.0, f64::INFINITY, f64::NAN];
        for ends in numbers.iter().flat_map(|lo| numbers.map(|hi| [*lo, hi])) {
            let (chord, mut out) = (Chord { ends, parts: PARTS }, Vec::new());
            let answer = chord.answer(&mut out);
            assert_eq!(chord.is_sound(), answer.is_sound(&out, || Body::Solid), "{ends:?} {out:?}");
        }
    }

    #[test]
    fn finite_ends_are_crossings_with_their_parts() {
        let mut out = Vec::new();
        assert!(!Chord { ends: [1.0, 2.0], parts: PARTS }.answer(&mut out).inside);
        assert_eq!(out, [Crossing::exact(1.0, true, 3), Crossing::exact(2.0, false, 5)]);
        out.clear();
        assert!(Chord { ends: [f64::NEG_INFINITY, 2.0], parts: PARTS }.answer(&mut out).inside);
        assert_eq!(out, [Crossing::exact(2.0, false, 5)]);
        assert_eq!(Chord::between((2.0, 0), (2.0, 0)), Chord::NONE);
        assert!(Chord::NONE.is_sound() && Chord::NONE.is_none());
    }
}
