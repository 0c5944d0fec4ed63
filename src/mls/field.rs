//! The scalar field F and its gradient at a point, or the reason why there is none.

use glam::DVec3;

use super::blocks::{Blocks, Near};
use super::gradient::{Answers, gradient};
use super::levin;
use super::neighbours::Neighbours;
use super::plane::{Jet, Plane, SLACK, Straightness, settle, start, weighing};
use super::polynomial::fit;
use super::weight::OneWay;
use super::{Facing, MAX_DEGREE, Weight};

/// Why a point has no projection. A failure that belongs to the method, not an error of the program.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
pub enum Stray {
    /// No samples weigh here.
    #[error("too few neighbours")]
    Sparse,
    /// The samples do not determine a plane or a polynomial.
    #[error("ill-conditioned")]
    IllConditioned,
    /// The plane lies too far away, or the polynomial leaves it too steeply: outside the tube around the surface.
    #[error("outside the tube")]
    Outside,
    /// The plane found is no strict local minimum.
    #[error("not a minimum")]
    Saddle,
    /// The search for the plane did not end.
    #[error("not settled")]
    Unsettled,
    /// The normals of the samples do not say which side is out.
    #[error("sides undecided")]
    Undecided,
    /// The samples end before this point.
    #[error("past the end of the samples")]
    Ended,
    /// The neighbours gathered do not reach far enough: gather wider and ask again.
    #[error("neighbours out of reach")]
    OutOfReach,
}

/// F at a point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sample {
    /// F, world length; positive outside.
    pub value: f64,
    /// grad F, of length near 1; outward.
    pub gradient: DVec3,
    /// Unit normal of the reference plane, outward.
    pub plane_normal: DVec3,
    /// Unit normal of the polynomial over q, outward: the paper's, less exact than the gradient.
    pub fit_normal: DVec3,
    /// q, the origin of the reference plane's frame, world position.
    pub foot: DVec3,
    /// Unit vector in the plane away from the weighted mean of the samples: over an edge, if there is one.
    pub away: DVec3,
    /// How far the weighted mean of the samples lies from q within the plane, in local units: near zero inside
    /// a sampled surface, 0.51 (compact weight) or 0.56 (Gaussian) widths at its straight edge.
    pub drift: f64,
    /// The share of the weight that is left after samples facing another way are left out.
    pub kept: f64,
    /// The degree that the samples allowed; terms fade before they go.
    pub degree: usize,
}

/// What is known near a point before its plane is searched: functions of the point alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// A point near the surface, world position.
    pub foot: DVec3,
    /// The outward unit normal there, nearly.
    pub outward: DVec3,
    /// The local width, world length.
    pub width: f64,
}

/// Which plane is the reference.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Form {
    /// Form A: a local minimum of J over n and t, as in the paper.
    #[default]
    Free,
    /// Form B, Levin's: n of least spread about q, q critical along n. A true projection; the surface moves by less than
    /// 2e-6 widths at up to three spacings a width.
    Levin,
}

/// Evaluates F for one weight, facing and degree.
#[derive(Clone, Copy, Debug)]
pub struct Evaluator<W, A> {
    /// The weight.
    pub weight: W,
    /// Which samples weigh, by the way they face.
    pub facing: A,
    /// The degree of the polynomial, at most [`MAX_DEGREE`].
    pub degree: usize,
    /// Which plane.
    pub form: Form,
}

/// How far q may lie from the point that the samples were weighed about, in widths at r, at the second attempt.
const FAR_SLACK: f64 = 1.0;
/// The plane must lie within this many local units of the point: past sqrt 2 the energy of a flat neighbourhood
/// has no minimum left, and noise adds a little.
const TUBE: f64 = 1.5;
/// The polynomial must stay within this many local units of its plane at q.
const HIGHEST: f64 = 1.0;
/// And must not be steeper there: past 45 degrees another plane should have been found.
const STEEPEST: f64 = 1.0;
/// The mean normal must agree at least this much with the plane's: normals of two sheets cancel.
const VOTE: f64 = 0.1;

/// Cosines of 60 and of 24 degrees, which together are the 84 within which [`super::SameWay`] is one.
const ALIGNED: f64 = 0.5;
const STRAIGHT: f64 = 0.913_545_457_642_600_9;

impl<W: Weight, A: Facing> Evaluator<W, A> {
    /// F and its gradient at a world point.
    ///
    /// The search for the plane starts from the samples' own normals about `foot`, a point near the surface that is a
    /// function of `at` alone, as is the outward normal there; so the branch of the local minimum depends on the point
    /// alone, never on an earlier search. The local width bounds the tube. `near` must hold every block with a sample
    /// whose support reaches the point, the foot, or q: where one lies beyond, the answer is [`Stray::OutOfReach`].
    pub fn sample(
        &self,
        blocks: &Blocks,
        near: &mut Neighbours,
        at: DVec3,
        guess: &Guess,
    ) -> Result<Sample, Stray> {
        if A::VARIES && ALIGNED <= near.least {
            // All normals lie within 60 degrees of one direction: while the plane's stays within 24 of it too, from the
            // start of the search to its end, every factor of facing is exactly one, and need not be computed. Where it
            // leaves, the whole search is made again, so that its end does not depend on what was gathered.
            let Evaluator { weight, degree, form, .. } = *self;
            let plain = Evaluator { weight, facing: OneWay, degree, form };
            let mut straight = Straightness { outward: near.outward, least: 1.0 };
            let answer = plain.search(blocks, near, at, guess, &mut straight);
            if STRAIGHT <= straight.least || answer == Err(Stray::OutOfReach) {
                return answer;
            }
        }
        self.search(blocks, near, at, guess, &mut Straightness { outward: near.outward, least: 1.0 })
    }

    fn search(
        &self,
        blocks: &Blocks,
        neighbours: &mut Neighbours,
        at: DVec3,
        guess: &Guess,
        straight: &mut Straightness,
    ) -> Result<Sample, Stray> {
        if !neighbours.reaches(at) || !neighbours.reaches(guess.foot) {
            return Err(Stray::OutOfReach);
        }
        let mut active = std::mem::take(&mut neighbours.active);
        let near = neighbours.listed(blocks);
        let (unit, per_unit) = (blocks.unit(), blocks.per_unit());
        let (r, k) = (at * per_unit, guess.width * per_unit);
        let local = Guess { foot: guess.foot * per_unit, width: k, ..*guess };
        let answer = start(self.weight, self.facing, near, r, local, straight, &mut active).and_then(
            |(begin, about)| {
                let whole = |slack: f64| neighbours.reaches_ball(about * unit, slack * guess.width);
                if !whole(SLACK) {
                    return Err(Stray::OutOfReach);
                }
                let few = Near { list: &active, ..near };
                let answer = self.from(few, r, k, begin, straight);
                if answer.is_ok_and(|(q, _)| (q - about).length() <= SLACK * k) {
                    return answer.map(|(_, sample)| sample);
                }
                // The search went, or ended, where blocks were left out that weigh.
                if !whole(FAR_SLACK) {
                    return Err(Stray::OutOfReach);
                }
                weighing(self.weight, near, about, FAR_SLACK * k, &mut active);
                let (q, sample) = self.from(Near { list: &active, ..near }, r, k, begin, straight)?;
                if (q - about).length() <= FAR_SLACK * k { Ok(sample) } else { Err(Stray::Outside) }
            },
        );
        neighbours.active = active;
        answer
    }

    /// F from a first plane on; q too, in units.
    fn from(
        &self,
        near: Near,
        r: DVec3,
        k: f64,
        begin: Plane,
        straight: &mut Straightness,
    ) -> Result<(DVec3, Sample), Stray> {
        let (mut plane, jet) = settle(self.weight, self.facing, near, r, k, begin, straight)?;
        if self.form == Form::Levin {
            plane = levin::settle(self.weight, self.facing, near, r, &plane)?;
            straight.pass(-plane.n);
        }
        if TUBE * k < plane.t.abs() {
            return Err(Stray::Outside);
        }
        Ok((r + plane.t * plane.n, self.finish(near, r, k, &plane, &jet)?))
    }

    /// Polynomial, orientation and gradient at a settled plane; `k` is the width at the point, local units.
    fn finish(&self, near: Near, r: DVec3, k: f64, plane: &Plane, jet: &Jet) -> Result<Sample, Stray> {
        // The Hessian's basis, turned with the last step.
        let n = plane.n;
        let e1 = (jet.basis[0] - n * n.dot(jet.basis[0])).normalize();
        let e2 = n.cross(e1);
        let basis = [e1, if e2.dot(jet.basis[1]) < 0.0 { -e2 } else { e2 }];
        let fit = fit(self.weight, self.facing, near, r, plane, basis, self.degree.min(MAX_DEGREE))?;
        let steep = if fit.degree == 0 { 0.0 } else { (fit.c[1] * fit.c[1] + fit.c[2] * fit.c[2]).sqrt() };
        if HIGHEST * k < fit.c[0].abs() || STEEPEST < steep {
            return Err(Stray::Outside);
        }
        if fit.vote.abs() < VOTE {
            return Err(Stray::Undecided);
        }
        let answers = match self.form {
            Form::Free => Answers::Minimum(&jet.hessian),
            Form::Levin => {
                let system = levin::system::<W, A>(self.weight, near, r, plane, basis);
                Answers::Given(system.response().ok_or(Stray::Saddle)?)
            }
        };
        let inward = gradient(self.weight, self.facing, near, r, plane, answers, &fit)?;
        // n points into the solid where the outward normals stand against it.
        let sign = -fit.vote.signum();
        Ok(Sample {
            value: sign * (plane.t + fit.c[0]) * near.all.unit(),
            gradient: sign * inward,
            plane_normal: -sign * n,
            fit_normal: -sign * (n - fit.c[1] * basis[0] - fit.c[2] * basis[1]).normalize(),
            foot: (r + plane.t * n) * near.all.unit(),
            away: -(fit.drift[0] * basis[0] + fit.drift[1] * basis[1]).normalize_or_zero(),
            drift: (fit.drift[0] * fit.drift[0] + fit.drift[1] * fit.drift[1]).sqrt() / k,
            kept: fit.kept,
            degree: fit.degree,
        })
    }
}
