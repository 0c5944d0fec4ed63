//! The reference plane: a local minimum (n, t) of J by Newton's method, form A of the definition.
//!
//! With d = p - r, s = n.d - t, x = d - t n, theta' and theta'' the derivatives of the weight with respect to
//! |x|^2 (everything in local units):
//!
//! ```text
//! J_n  = sum (2 s theta - 2 t s^2 theta') d          J_t  = sum -2 s theta - 2 s^3 theta'
//! J_nn = sum (2 theta - 8 t s theta' + 4 t^2 s^2 theta'') d d^T
//! J_nt = sum (-2 theta - 6 s^2 theta' + 4 t s theta' + 4 t s^3 theta'') d
//! J_tt = sum 2 theta + 10 s^2 theta' + 4 s^4 theta''
//! ```
//!
//! A sample with outward normal m may carry a factor phi(c), c = -m.n, of the way it faces; it multiplies all of the
//! above and adds, with phi' and phi'',
//!
//! ```text
//! J_n  -= theta s^2 phi' m
//! J_nn -= (2 s theta - 2 t s^2 theta') phi' (d m^T + m d^T) - theta s^2 phi'' m m^T
//! J_nt -= (-2 s theta - 2 s^3 theta') phi' m
//! ```
//!
//! On the unit sphere with the tangent basis B the Riemannian Hessian is B^T J_nn B - (n . J_n) I. For the Gaussian
//! these are the formulas of the literature; here theta is any weight. Checked against finite differences.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use glam::{DMat3, DVec3};

use super::blocks::Near;
use super::{AnyWay, Facing, Guess, Stray, Weight};
use crate::num::cholesky::Cholesky;
use crate::num::eigen::symmetric3;
use crate::num::lanes::{Lanes, Lanes3, sum};

/// A plane in the frame of the point r, local units: q = r + t n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Unit normal, into the solid.
    pub n: DVec3,
    /// Signed distance of the plane from r along n.
    pub t: f64,
}

/// J and its derivatives at some (n, t), in the tangent basis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    /// The energy.
    pub energy: f64,
    /// The sum of the weights.
    pub weight: f64,
    /// Tangent basis of the sphere of normals at n.
    pub basis: [DVec3; 2],
    /// The gradient in (basis, t).
    pub gradient: [f64; 3],
    /// The Hessian in (basis, t).
    pub hessian: [[f64; 3]; 3],
}

/// Newton's steps are halved until the energy falls; more halvings than this mean that rounding decides.
const MAX_HALVINGS: usize = 12;
/// Two to four steps are usual; more than this means that there is no minimum to settle in.
const MAX_STEPS: usize = 24;
/// A step below this many local units (radians) leaves an error of its square in F, below rounding, and of this size in
/// the Hessian that the gradient of F is made with.
const LAST_STEP: f64 = 1e-6;
/// The largest single step, radians and widths at the point: the quadratic model is good for no more.
const LONGEST_STEP: f64 = 0.5;

/// How near a search stays to the outward normal that its neighbours were gathered with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Straightness {
    pub outward: DVec3,
    /// The least cosine so far.
    pub least: f64,
}

impl Straightness {
    /// The search compares samples with this outward unit normal.
    #[inline(always)]
    pub fn pass(&mut self, outward: DVec3) {
        self.least = self.least.min(outward.dot(self.outward));
    }
}

/// The weight that decides which side r belongs to is so much narrower, as a factor on squared distances: its support
/// still holds the whole trust sphere's radius.
const NARROW: f64 = 4.0;
/// Normals that cancel to less than this share do not say which side.
const CLEAR: f64 = 0.2;

/// Where the search starts: the plane through the weighted centroid of the samples about the foot that face like the
/// surface next to r, across their mean normal. Which way that is a narrower weight about r itself decides, so that the
/// nearer side of a thin wall wins and at its rim both sides together; where normals cancel, `outward` decides.
///
/// Returned with the point about which the samples were weighed; `active` gets the blocks that weigh about it, or within
/// [`SLACK`] of it.
pub(super) fn start<W: Weight, A: Facing>(
    weight: W,
    _: A,
    near: Near,
    r: DVec3,
    Guess { foot, outward, width }: Guess,
    straight: &mut Straightness,
    active: &mut Vec<u32>,
) -> Result<(Plane, DVec3), Stray> {
    let narrow = About { point: r, narrow: NARROW, slack: 0.0, outward };
    let (sum, centroid, normal) =
        dispatch!(Level::new(), simd => means::<_, W, AnyWay>(simd, weight, near, narrow, |_| ()));
    let (foot, outward) = if CLEAR * sum < normal.length() {
        let outward = normal.normalize();
        (r + outward * outward.dot(centroid / sum), outward)
    } else {
        (foot, outward)
    };
    straight.pass(outward);
    active.clear();
    let listed = |block| active.push(near.list[block]);
    let wide = About { point: foot, narrow: 1.0, slack: SLACK * width, outward };
    let (sum, centroid, normal) =
        dispatch!(Level::new(), simd => means::<_, W, A>(simd, weight, near, wide, listed));
    let near = Near { list: active, ..near };
    // Below this share of one full sample nothing is near: the foot lies outside every support.
    const NOTHING: f64 = 1e-6;
    if sum < NOTHING {
        return Err(Stray::Sparse);
    }
    let (centroid, mean) = (centroid / sum, normal / sum);
    // Normals that cancel to less than this are those of two sheets, or of none.
    const COHERENT: f64 = 0.3;
    let n = if COHERENT < mean.length() {
        -mean.normalize()
    } else {
        principal(weight, near, foot, centroid, mean)
    };
    Ok((Plane { n, t: n.dot(foot + centroid - r) }, foot))
}

/// How far from the point about which blocks were listed they may be asked, in widths at the point r: nearly always enough.
pub(super) const SLACK: f64 = 0.15;
/// A share d by which the squared support grows, so that (support h + slack)^2 <= (1 + d) support^2 h^2 + (1 + 1/d) slack^2
/// can be asked without a root.
const WIDER: f64 = 0.1;

/// How samples are weighed.
#[derive(Clone, Copy)]
struct About {
    point: DVec3,
    /// Times the squared distances.
    narrow: f64,
    slack: f64,
    /// What they are compared with.
    outward: DVec3,
}

/// The sum of the weights about a point, and of the weighted positions from it and normals. Shows the blocks of which a
/// sample may weigh about a point at most `slack` away.
#[inline(always)]
fn means<S: Simd, W: Weight, A: Facing>(
    simd: S,
    weight: W,
    near: Near,
    About { point, narrow, slack, outward }: About,
    mut weighs: impl FnMut(usize),
) -> (f64, DVec3, DVec3) {
    let reach = Lanes::splat(simd, weight.support() * (1.0 + WIDER));
    let slack = slack * slack * (1.0 + 1.0 / WIDER);
    let mut total = Lanes::splat(simd, 0.0);
    let (mut centroid, mut normal) = (Lanes3::zero(simd), Lanes3::zero(simd));
    for block in 0..near.len() {
        let (p, ih2) = near.block(simd, block);
        let m = near.normals(simd, block);
        let d = p.minus(point);
        let square = d.length_squared();
        let rho = square * ih2;
        if !((square - slack) * ih2).simd_lt(reach).any_true() {
            continue;
        }
        weighs(block);
        let mut w = weight.value(simd, rho * narrow);
        if A::VARIES {
            w *= A::jet(simd, m.dot(outward))[0];
        }
        total += w;
        d.add_to(w, &mut centroid);
        m.add_to(w, &mut normal);
    }
    (sum(total), centroid.sum(), normal.sum())
}

/// The blocks of which a sample may weigh about a point at most `slack` away.
pub(super) fn weighing<W: Weight>(weight: W, near: Near, about: DVec3, slack: f64, active: &mut Vec<u32>) {
    active.clear();
    let listed = |block| active.push(near.list[block]);
    let about = About { point: about, narrow: 1.0, slack, outward: DVec3::ZERO };
    dispatch!(Level::new(), simd => means::<_, W, AnyWay>(simd, weight, near, about, listed));
}

/// The direction of least spread of the weighted samples about their centroid, turned against `outward`.
fn principal(weight: impl Weight, near: Near, r: DVec3, centroid: DVec3, outward: DVec3) -> DVec3 {
    let m = dispatch!(Level::new(), simd => spread(simd, weight, near, r, centroid));
    let (_, vectors) = symmetric3(m);
    let n = vectors.x_axis;
    if n.dot(outward) <= 0.0 { n } else { -n }
}

#[inline(always)]
fn spread<S: Simd>(simd: S, weight: impl Weight, near: Near, r: DVec3, centroid: DVec3) -> DMat3 {
    let mut columns = [Lanes3::zero(simd); 3];
    for block in 0..near.len() {
        let (p, ih2) = near.block(simd, block);
        let d = p.minus(r);
        let w = weight.value(simd, d.length_squared() * ih2);
        let e = d.minus(centroid);
        for (column, along) in columns.iter_mut().zip([e.x, e.y, e.z]) {
            e.add_to(w * along, column);
        }
    }
    let [x, y, z] = columns.map(Lanes3::sum);
    DMat3::from_cols(x, y, z)
}

/// J and its first two derivatives at a plane.
pub(super) fn jet<W: Weight, A: Facing>(weight: W, _: A, near: Near, r: DVec3, plane: &Plane) -> Jet {
    dispatch!(Level::new(), simd => jet_in::<_, W, A>(simd, weight, near, r, plane))
}

#[inline(always)]
fn jet_in<S: Simd, W: Weight, A: Facing>(simd: S, weight: W, near: Near, r: DVec3, plane: &Plane) -> Jet {
    let Plane { n, t } = *plane;
    let (e1, e2) = n.any_orthonormal_pair();
    let zero = Lanes::splat(simd, 0.0);
    let (mut total, mut energy, mut j_t, mut j_tt) = (zero, zero, zero, zero);
    let (mut g1, mut g2, mut gn) = (zero, zero, zero);
    let (mut h11, mut h12, mut h22, mut h1t, mut h2t) = (zero, zero, zero, zero, zero);
    for block in 0..near.len() {
        let (p, ih2) = near.block(simd, block);
        let d = p.minus(r);
        let (a, b, c) = (d.dot(e1), d.dot(e2), d.dot(n));
        let s = c - t;
        let [w, w1, w2] = weight.jet(simd, (a * a + b * b + s * s) * ih2);
        let (w1, w2) = (w1 * ih2, w2 * (ih2 * ih2));
        let s2 = s * s;
        let (ws, w1s2) = (w * s, w1 * s2);
        let mut first = (ws - w1s2 * t) * 2.0;
        let mut second = (w + w) - w1 * s * (8.0 * t) + w2 * s2 * (4.0 * t * t);
        let mut mixed = w1 * s * (4.0 * t) - (w + w) - w1s2 * 6.0 + w2 * (s2 * s) * (4.0 * t);
        let mut along = (ws + w1s2 * s) * -2.0;
        let mut twice = (w + w) + w1s2 * 10.0 + w2 * (s2 * s2) * 4.0;
        let (mut weight_here, mut energy_here) = (w, ws * s);
        if A::VARIES {
            let m = near.normals(simd, block);
            let (m1, m2, mn) = (m.dot(e1), m.dot(e2), m.dot(n));
            let [f, f1, f2] = A::jet(simd, -mn);
            // What turns n also changes who faces the same way.
            let (turn, cross, own) = (energy_here * f1, first * f1, energy_here * f2);
            g1 -= turn * m1;
            g2 -= turn * m2;
            gn -= turn * mn;
            h11 += m1 * (own * m1 - cross * (a + a));
            h12 += own * m1 * m2 - cross * (a * m2 + b * m1);
            h22 += m2 * (own * m2 - cross * (b + b));
            h1t -= along * f1 * m1;
            h2t -= along * f1 * m2;
            weight_here *= f;
            energy_here *= f;
            first *= f;
            second *= f;
            mixed *= f;
            along *= f;
            twice *= f;
        }
        total += weight_here;
        energy += energy_here;
        j_t += along;
        j_tt += twice;
        g1 += first * a;
        g2 += first * b;
        gn += first * c;
        let (sa, sb) = (second * a, second * b);
        h11 += sa * a;
        h12 += sa * b;
        h22 += sb * b;
        h1t += mixed * a;
        h2t += mixed * b;
    }
    let gn = sum(gn);
    let (h12, h1t, h2t) = (sum(h12), sum(h1t), sum(h2t));
    Jet {
        energy: sum(energy),
        weight: sum(total),
        basis: [e1, e2],
        gradient: [sum(g1), sum(g2), sum(j_t)],
        hessian: [[sum(h11) - gn, h12, h1t], [h12, sum(h22) - gn, h2t], [h1t, h2t, sum(j_tt)]],
    }
}

/// Newton's step, made a descent step where the Hessian is not positive definite by taking the absolute values of
/// its eigenvalues. Lengths are measured in the width `k` at the point, so that the walk, and with it the minimum that it
/// ends in, does not depend on the unit that the neighbours were gathered in.
fn step(jet: &Jet, k: f64) -> [f64; 3] {
    let [g0, g1, gt] = jet.gradient;
    let g = [-g0, -g1, -k * gt];
    let [a, b, c] = jet.hessian;
    let hessian = [[a[0], a[1], k * a[2]], [b[0], b[1], k * b[2]], [k * c[0], k * c[1], k * k * c[2]]];
    // A pivot this far below its diagonal has no correct digit left.
    const PIVOT: f64 = 1e-12;
    let y = match Cholesky::new(&hessian, PIVOT) {
        Some(factor) => factor.solve(&g),
        None => {
            let (values, v) = symmetric3(DMat3::from_cols_array_2d(&hessian));
            let largest = values[0].abs().max(values[2].abs());
            let g = DVec3::from_array(g);
            let scaled = |i: usize, axis: DVec3| {
                axis * (axis.dot(g) / values[i].abs().max(1e-6 * largest).max(f64::MIN_POSITIVE))
            };
            (scaled(0, v.x_axis) + scaled(1, v.y_axis) + scaled(2, v.z_axis)).to_array()
        }
    };
    let longest = (y[0] * y[0] + y[1] * y[1]).sqrt().max(y[2].abs());
    let by = if longest <= LONGEST_STEP { 1.0 } else { LONGEST_STEP / longest };
    [by * y[0], by * y[1], by * k * y[2]]
}

fn moved(plane: &Plane, jet: &Jet, y: [f64; 3], by: f64) -> Plane {
    let n = plane.n + by * (y[0] * jet.basis[0] + y[1] * jet.basis[1]);
    Plane { n: n.normalize(), t: plane.t + by * y[2] }
}

/// Walks from a start to the local minimum. The jet returned is that of the last step's beginning, at most
/// `LAST_STEP` away from the plane returned.
///
/// `k` is the width at the point, local units; `straight` is lowered to the least cosine of the normals passed.
///
/// Fails with [`Stray::Unsettled`] where the search does not end, and with [`Stray::Sparse`] where it leaves the
/// samples behind (the energy falls to nothing at infinity: the spurious minimum of the un-normalised problem).
pub(super) fn settle<W: Weight, A: Facing>(
    weight: W,
    facing: A,
    near: Near,
    r: DVec3,
    k: f64,
    start: Plane,
    straight: &mut Straightness,
) -> Result<(Plane, Jet), Stray> {
    let mut plane = start;
    let mut pass = |plane: &Plane| straight.pass(-plane.n);
    pass(&plane);
    let mut here = jet(weight, facing, near, r, &plane);
    for _ in 0..MAX_STEPS {
        if here.weight <= 0.0 {
            return Err(Stray::Sparse);
        }
        let y = step(&here, k);
        let size = (y[0] * y[0] + y[1] * y[1]).sqrt().max(y[2].abs());
        if size.is_nan() {
            return Err(Stray::IllConditioned);
        }
        if size <= LAST_STEP {
            plane = moved(&plane, &here, y, 1.0);
            pass(&plane);
            return Ok((plane, here));
        }
        let mut by = 1.0;
        let mut halvings = 0;
        loop {
            let next = moved(&plane, &here, y, by);
            pass(&next);
            let there = jet(weight, facing, near, r, &next);
            // Rounding of a sum of that many terms of this size must not refuse a step.
            let slack = 1e-12 * here.energy.abs() + 1e-28 * here.weight;
            if there.energy <= here.energy + slack || halvings == MAX_HALVINGS {
                plane = next;
                here = there;
                break;
            }
            by *= 0.5;
            halvings += 1;
        }
    }
    Err(Stray::Unsettled)
}
