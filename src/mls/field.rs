//! The scalar field F and its gradient at a point, or the reason why there is none.

use glam::DVec3;

use super::gradient::gradient;
use super::neighbours::Neighbours;
use super::plane::{Plane, settle, start};
use super::polynomial::fit;
use super::{MAX_DEGREE, Weight};

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
    /// The neighbours gathered do not reach far enough: gather about the point itself and ask again.
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
    /// How far the weighted mean of the samples lies from q within the plane, in local units: near zero inside
    /// a sampled surface, 0.51 (compact weight) or 0.56 (Gaussian) widths at its straight edge.
    pub drift: f64,
    /// The degree that the samples allowed.
    pub degree: usize,
}

/// Evaluates F for one weight and degree.
#[derive(Clone, Copy, Debug)]
pub struct Evaluator<W> {
    /// The weight.
    pub weight: W,
    /// The degree of the polynomial, at most [`MAX_DEGREE`].
    pub degree: usize,
}

/// The plane must lie within this many local units of the point: past sqrt 2 the energy of a flat neighbourhood
/// has no minimum left, and noise adds a little.
const TUBE: f64 = 1.5;
/// The polynomial must stay within this many local units of its plane at q.
const HIGHEST: f64 = 1.0;
/// And must not be steeper there: past 45 degrees another plane should have been found.
const STEEPEST: f64 = 1.0;
/// How far q may move from where the search began before the list of samples is cut anew, local units. The list
/// stays short: its length grows with the square of support + this.
const ROAM: f64 = 0.3;
/// The mean normal must agree at least this much with the plane's: normals of two sheets cancel.
const VOTE: f64 = 0.1;

impl<W: Weight> Evaluator<W> {
    /// F and its gradient at a world point. `near` must hold all samples whose support reaches the ball of
    /// [`Neighbours::reach`] about its origin; `width` is the local width at the point, world length, which bounds
    /// the tube; `short` is room for the samples that weigh at q.
    ///
    /// Deterministic: the search starts from the samples' own normals about `at`, so the branch of the local
    /// minimum depends on the point alone.
    pub fn sample(
        &self,
        near: &Neighbours,
        at: DVec3,
        width: f64,
        short: &mut Neighbours,
    ) -> Result<Sample, Stray> {
        let r = (at - near.origin) / near.unit;
        let k = width / near.unit;
        if near.reach < r.length() {
            return Err(Stray::OutOfReach);
        }
        let mut plane = start(self.weight, near, r)?;
        let support = self.weight.support();
        // Twice suffices where the start was good; a search that keeps roaming has no minimum to settle in.
        for _ in 0..4 {
            if (TUBE + ROAM) * k < plane.t.abs() {
                return Err(Stray::Outside);
            }
            let q = r + plane.t * plane.n;
            if near.reach < q.length() + ROAM * k {
                return Err(Stray::OutOfReach);
            }
            near.near(q, ROAM * k, support, short);
            let (found, jet) = settle(self.weight, short, r, plane)?;
            if (r + found.t * found.n - q).length() <= ROAM * k {
                return self.finish(short, r, k, &found, &jet.basis, &jet.hessian);
            }
            plane = found;
        }
        Err(Stray::Unsettled)
    }

    /// Polynomial, orientation and gradient at a settled plane; `k` is the width at the point, local units.
    #[allow(clippy::too_many_arguments)] // One value each; a struct for one call would only rename them.
    fn finish(
        &self,
        near: &Neighbours,
        r: DVec3,
        k: f64,
        plane: &Plane,
        basis: &[DVec3; 2],
        hessian: &[[f64; 3]; 3],
    ) -> Result<Sample, Stray> {
        if TUBE * k < plane.t.abs() {
            return Err(Stray::Outside);
        }
        let n = plane.n;
        let e1 = (basis[0] - n * n.dot(basis[0])).normalize();
        let basis = [e1, n.cross(e1) * n.cross(e1).dot(basis[1]).signum()];
        let fit = fit(self.weight, near, r, plane, basis, self.degree.min(MAX_DEGREE))?;
        let steep = if fit.degree == 0 { 0.0 } else { fit.c[1].hypot(fit.c[2]) };
        if HIGHEST * k < fit.c[0].abs() || STEEPEST < steep {
            return Err(Stray::Outside);
        }
        if fit.vote.abs() < VOTE {
            return Err(Stray::Undecided);
        }
        let inward = gradient(self.weight, near, r, plane, basis, hessian, &fit)?;
        // n points into the solid where the outward normals stand against it.
        let sign = -fit.vote.signum();
        Ok(Sample {
            value: sign * (plane.t + fit.c[0]) * near.unit,
            gradient: sign * inward,
            plane_normal: -sign * n,
            drift: fit.drift[0].hypot(fit.drift[1]) / k,
            degree: fit.degree,
        })
    }
}
