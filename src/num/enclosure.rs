//! Interval arithmetic: every operation gives an interval that holds all results for all numbers of its operands,
//! rounding included.
//!
//! The four operations and the square root are rounded to nearest by IEEE 754, so one step outward from the rounded
//! result bounds the exact one. The functions are those of `libm` (a port of musl, the same bits everywhere), whose
//! errors are given there as below one unit in the last place, for `pow` 0.7, for `atan2` two; their results are moved
//! outward by [`tolerance::LIBM_ULPS`]. (Moore, Kearfott and Cloud 2009, chapters 2 and 3.)
//!
//! An operation that is undefined for some operands (a root of a negative number, a division by zero, an overflow) gives
//! the interval of its defined results and says so; one that jumps between results (`floor`, `atan2` across the negative x
//! axis) says that ([`Breaks`]). With no defined result the interval is empty. Oracle: the same in values at random points (`tests/num_enclosure.rs`).

mod functions;

use crate::geom::tolerance;

/// What may keep a function from being continuous over an interval.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Breaks(u8);

impl Breaks {
    /// Nothing: it is continuous.
    pub const NONE: Breaks = Breaks(0);
    /// It may jump, from one number of the enclosure to another.
    pub const JUMPS: Breaks = Breaks(1);
    /// It may have no value somewhere, and jump.
    pub const UNDEFINED: Breaks = Breaks(3);

    /// `UNDEFINED` where that may be so.
    fn undefined_if(it_may: bool) -> Breaks {
        if it_may { Breaks::UNDEFINED } else { Breaks::NONE }
    }

    /// Whether it may be discontinuous or undefined.
    pub fn any(self) -> bool {
        self != Breaks::NONE
    }

    /// Whether some value may be undefined.
    pub fn undefined(self) -> bool {
        self == Breaks::UNDEFINED
    }
}

impl std::ops::BitOr for Breaks {
    type Output = Breaks;
    fn bitor(self, o: Breaks) -> Breaks {
        Breaks(self.0 | o.0)
    }
}

/// Numbers from `lo` to `hi`; empty where `hi < lo`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Enclosure {
    /// No defined value is below.
    pub lo: f64,
    /// No defined value is above.
    pub hi: f64,
    /// What may keep the values from being those of a continuous function.
    pub breaks: Breaks,
}

impl Enclosure {
    /// No value at all.
    pub const EMPTY: Enclosure =
        Enclosure { lo: f64::INFINITY, hi: f64::NEG_INFINITY, breaks: Breaks::UNDEFINED };

    /// One number.
    pub fn point(x: f64) -> Enclosure {
        Enclosure { lo: x, hi: x, breaks: Breaks::NONE }
    }

    /// The numbers between two.
    pub fn new(lo: f64, hi: f64) -> Enclosure {
        Enclosure { lo, hi, breaks: Breaks::NONE }
    }

    /// Whether it holds nothing.
    pub fn is_empty(self) -> bool {
        self.hi < self.lo
    }

    /// Whether it holds a number.
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// From the lowest number to the highest.
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// The numbers of both.
    pub fn intersect(self, o: Enclosure) -> Enclosure {
        Enclosure { lo: self.lo.max(o.lo), hi: self.hi.min(o.hi), breaks: self.breaks | o.breaks }
    }

    /// The numbers of either and between.
    pub fn hull(self, o: Enclosure) -> Enclosure {
        Enclosure { lo: self.lo.min(o.lo), hi: self.hi.max(o.hi), breaks: self.breaks | o.breaks }
    }

    /// From bounds of correctly rounded results: one step outward. An overflow is undefined.
    fn rounded(lo: f64, hi: f64, breaks: Breaks) -> Enclosure {
        // NaN comes of infinite bounds alone: nothing is known then.
        let lo = if lo.is_nan() { f64::NEG_INFINITY } else { lo.next_down() };
        let hi = if hi.is_nan() { f64::INFINITY } else { hi.next_up() };
        let overflows = lo == f64::NEG_INFINITY || hi == f64::INFINITY;
        Enclosure { lo, hi, breaks: breaks | Breaks::undefined_if(overflows) }
    }

    fn unless_empty(self, o: Enclosure, f: impl FnOnce() -> Enclosure) -> Enclosure {
        if self.is_empty() || o.is_empty() { Enclosure::EMPTY } else { f() }
    }

    /// Whether it holds one number alone.
    fn is_point(self) -> bool {
        self.lo == self.hi
    }

    /// One exact result of two numbers: where a function jumps at whole numbers, a step outward from one would leave
    /// undecided which side it is on. `lost` is what rounding took, as long as it does not underflow.
    fn exact(self, o: Enclosure, result: f64, lost: f64) -> Option<Enclosure> {
        let large = tolerance::SMALLEST < result.abs() && result.is_finite();
        let certain = self.lo == 0.0 || (lost == 0.0 && large);
        certain.then_some(Enclosure { lo: result, hi: result, breaks: self.breaks | o.breaks })
    }

    /// All products.
    pub fn times(self, o: Enclosure) -> Enclosure {
        if self.is_point() && o.is_point() {
            let product = self.lo * o.lo;
            if let Some(exact) = self.exact(o, product, self.lo.mul_add(o.lo, -product)) {
                return exact;
            }
        }
        self.unless_empty(o, || {
            let mut all = Enclosure { breaks: self.breaks | o.breaks, ..Enclosure::EMPTY };
            for (x, y) in [(self.lo, o.lo), (self.lo, o.hi), (self.hi, o.lo), (self.hi, o.hi)] {
                // Nothing is lost in a product with zero.
                let zero = x == 0.0 || y == 0.0;
                let product = Enclosure::rounded(x * y, x * y, Breaks::NONE);
                all = all.hull(if zero && (x * y) == 0.0 { Enclosure::point(0.0) } else { product });
            }
            all
        })
    }

    /// Any number, and perhaps none.
    const ALL_BROKEN: Enclosure =
        Enclosure { lo: f64::NEG_INFINITY, hi: f64::INFINITY, breaks: Breaks::UNDEFINED };

    /// All quotients; a divisor of zero gives none.
    pub fn over(self, o: Enclosure) -> Enclosure {
        if self.is_point() && o.is_point() && o.lo != 0.0 {
            let quotient = self.lo / o.lo;
            if let Some(exact) = self.exact(o, quotient, quotient.mul_add(-o.lo, self.lo)) {
                return exact;
            }
        }
        self.unless_empty(o, || match o.reciprocal_bounds() {
            None => Enclosure::EMPTY,
            Some((lo, hi)) if lo.is_finite() && hi.is_finite() => {
                let all = [self.lo / o.lo, self.lo / o.hi, self.hi / o.lo, self.hi / o.hi];
                let lo = all.into_iter().fold(f64::INFINITY, f64::min);
                let hi = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
                Enclosure::rounded(lo, hi, self.breaks | o.breaks)
            }
            Some(_) if self.lo == 0.0 && self.hi == 0.0 => {
                Enclosure { breaks: Breaks::UNDEFINED, ..Enclosure::point(0.0) }
            }
            Some((lo, hi)) => self.times_halfline(lo, hi),
        })
    }

    /// The bounds of 1 / x over the interval, x = 0 left out; `None` where nothing else is in it.
    fn reciprocal_bounds(self) -> Option<(f64, f64)> {
        if self.lo == 0.0 && self.hi == 0.0 {
            return None;
        }
        if self.lo < 0.0 && 0.0 < self.hi {
            return Some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let lo = if self.hi == 0.0 { f64::NEG_INFINITY } else { 1.0 / self.hi };
        let hi = if self.lo == 0.0 { f64::INFINITY } else { 1.0 / self.lo };
        Some((lo, hi))
    }

    /// Products with the numbers between two bounds, of which at least one is infinite.
    fn times_halfline(self, lo: f64, hi: f64) -> Enclosure {
        let whole = lo == f64::NEG_INFINITY && hi == f64::INFINITY;
        if whole || (self.lo < 0.0 && 0.0 < self.hi) {
            return Enclosure::ALL_BROKEN;
        }
        let least = self.lo.abs().min(self.hi.abs());
        // |quotient| is at least this, and unbounded.
        let near = if hi == f64::INFINITY { least * lo } else { least * hi.abs() };
        let near = (near * (1.0 - 4.0 * tolerance::EPS)).next_down().max(0.0);
        let positive = (self.lo >= 0.0) == (hi == f64::INFINITY);
        if positive {
            Enclosure { lo: near, hi: f64::INFINITY, breaks: Breaks::UNDEFINED }
        } else {
            Enclosure { lo: f64::NEG_INFINITY, hi: -near, breaks: Breaks::UNDEFINED }
        }
    }

    /// A whole power, not zero.
    pub fn power(self, n: i32) -> Enclosure {
        if self.is_empty() {
            return self;
        }
        if n < 0 {
            return Enclosure::point(1.0).over(self.power(-n));
        }
        let even = n % 2 == 0;
        let of = |x: f64| integer_power(x, n);
        let (a, b) = (of(self.lo), of(self.hi));
        let (lo, hi) = if !even {
            (a, b)
        } else if self.lo <= 0.0 && 0.0 <= self.hi {
            (0.0, a.max(b))
        } else {
            (a.min(b), a.max(b))
        };
        // Whole numbers that a double holds lose nothing.
        let whole = self.is_point() && self.lo.fract() == 0.0 && lo.abs() <= 2.0 / tolerance::EPS;
        if whole {
            return Enclosure { lo, hi, breaks: self.breaks };
        }
        // n - 1 multiplications, each within half an ulp.
        let by = f64::from(n) * tolerance::EPS;
        let bound = Enclosure::rounded(lo - by * lo.abs(), hi + by * hi.abs(), self.breaks);
        if even { Enclosure { lo: bound.lo.max(0.0), ..bound } } else { bound }
    }

    /// All square roots.
    pub fn sqrt(self) -> Enclosure {
        if self.is_empty() || self.hi < 0.0 {
            return Enclosure::EMPTY;
        }
        let breaks = self.breaks | Breaks::undefined_if(self.lo < 0.0);
        let root = Enclosure::rounded(self.lo.max(0.0).sqrt(), self.hi.sqrt(), breaks);
        Enclosure { lo: root.lo.max(0.0), ..root }
    }

    /// All absolute values.
    pub fn abs(self) -> Enclosure {
        let inside = self.lo <= 0.0 && 0.0 <= self.hi;
        let least = if inside { 0.0 } else { self.lo.abs().min(self.hi.abs()) };
        let most = self.lo.abs().max(self.hi.abs());
        if self.is_empty() { self } else { Enclosure { lo: least, hi: most, ..self } }
    }

    /// The smaller of each pair.
    pub fn min(self, o: Enclosure) -> Enclosure {
        let (lo, hi) = (self.lo.min(o.lo), self.hi.min(o.hi));
        self.unless_empty(o, || Enclosure { lo, hi, breaks: self.breaks | o.breaks })
    }

    /// The larger of each pair.
    pub fn max(self, o: Enclosure) -> Enclosure {
        let (lo, hi) = (self.lo.max(o.lo), self.hi.max(o.hi));
        self.unless_empty(o, || Enclosure { lo, hi, breaks: self.breaks | o.breaks })
    }
}

impl std::ops::Neg for Enclosure {
    type Output = Enclosure;
    fn neg(self) -> Enclosure {
        if self.is_empty() { self } else { Enclosure { lo: -self.hi, hi: -self.lo, ..self } }
    }
}

impl std::ops::Add for Enclosure {
    type Output = Enclosure;
    fn add(self, o: Enclosure) -> Enclosure {
        self.unless_empty(o, || {
            let ((lo, below), (hi, above)) = (two_sum(self.lo, o.lo), two_sum(self.hi, o.hi));
            let bound = Enclosure::rounded(lo, hi, self.breaks | o.breaks);
            // What was rounded inward, or not at all, needs no step.
            let lo = if below >= 0.0 && lo.is_finite() { lo } else { bound.lo };
            let hi = if above <= 0.0 && hi.is_finite() { hi } else { bound.hi };
            Enclosure { lo, hi, breaks: bound.breaks }
        })
    }
}

impl std::ops::Sub for Enclosure {
    type Output = Enclosure;
    fn sub(self, o: Enclosure) -> Enclosure {
        self + -o
    }
}

/// The rounded sum and what rounding took from it (Knuth's TwoSum): their sum is exact.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// x to a positive whole power by squaring.
pub fn integer_power(x: f64, n: i32) -> f64 {
    let (mut result, mut square, mut left) = (1.0, x, n);
    while 0 < left {
        if left & 1 == 1 {
            result *= square;
        }
        square *= square;
        left >>= 1;
    }
    result
}
