//! The surface once more, by other means: all points, no tree, no cut, the plane by BFGS on gradients alone, the polynomial by
//! QR. Shares no code with the kernel; slow and plain on purpose.
#![allow(dead_code)]

use glam::DVec3;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// A plane farther than so many of the least widths from its point is fitted again with all points.
const SLACK: f64 = 1.0;

/// A cloud and how it is read.
pub struct Reference {
    pub points: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub widths: Vec<f64>,
    pub gaussian: bool,
    /// Whether samples that face another way weigh less.
    pub same_way: bool,
    pub degree: usize,
    /// Whether the plane is Levin's.
    pub levin: bool,
}

impl Reference {
    /// theta and its derivative by rho = |x|^2 / h^2.
    fn weight(&self, rho: f64) -> [f64; 2] {
        if self.gaussian {
            return [(-rho).exp(), -(-rho).exp()];
        }
        if 8.0 <= rho {
            return [0.0; 2];
        }
        let s = 1.0 - rho / 8.0;
        let s4 = s * s * s * s;
        [s4 * s4, -s4 * s * s * s]
    }

    /// The factor of a sample whose outward normal makes the cosine c with the plane's, and its derivative: one from
    /// c = 0.1 on, none below -0.6, the quintic smoothstep between.
    fn facing(&self, c: f64) -> [f64; 2] {
        let x = (c + 0.6) / 0.7;
        if !self.same_way || 1.0 <= x {
            return [1.0, 0.0];
        }
        if x <= 0.0 {
            return [0.0; 2];
        }
        [x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x), 30.0 * x * x * (1.0 - x) * (1.0 - x) / 0.7]
    }

    /// The sample nearest in its own widths, and the squared ratio.
    pub fn nearest(&self, r: DVec3) -> (usize, f64) {
        let ratio = |i: usize| (self.points[i] - r).length_squared() / (self.widths[i] * self.widths[i]);
        (0..self.points.len()).map(|i| (i, ratio(i))).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    }

    /// J and its gradient by (n, t), n free in space.
    fn energy(&self, r: DVec3, n: DVec3, t: f64) -> (f64, DVec3, f64) {
        let (mut energy, mut by_n, mut by_t) = (0.0, DVec3::ZERO, 0.0);
        for i in 0..self.points.len() {
            let d = self.points[i] - r;
            let ih2 = 1.0 / (self.widths[i] * self.widths[i]);
            let s = n.dot(d) - t;
            let [w, w1] = self.weight((d - t * n).length_squared() * ih2);
            if w == 0.0 {
                continue;
            }
            let [f, f1] = self.facing(-self.normals[i].dot(n));
            energy += f * w * s * s;
            // |d - t n|^2 = |d|^2 - 2 t n.d + t^2 on the unit sphere.
            by_n += f * (2.0 * w * s - 2.0 * t * s * s * w1 * ih2) * d - w * s * s * f1 * self.normals[i];
            by_t += f * (-2.0 * w * s + s * s * w1 * ih2 * 2.0 * (t - n.dot(d)));
        }
        (energy, by_n, by_t)
    }

    /// The start: the weighted mean of samples that face like the surface next to r, across their mean normal.
    fn start(&self, r: DVec3) -> Option<(DVec3, f64)> {
        let (nearest, ratio) = self.nearest(r);
        if 1.0 <= ratio {
            return None;
        }
        let means = |at: DVec3, narrow: f64, outward: Option<DVec3>| {
            let (mut total, mut place, mut normal) = (0.0, DVec3::ZERO, DVec3::ZERO);
            for i in 0..self.points.len() {
                let d = self.points[i] - at;
                let mut w = self.weight(narrow * d.length_squared() / self.widths[i].powi(2))[0];
                if let Some(outward) = outward {
                    w *= self.facing(self.normals[i].dot(outward))[0];
                }
                total += w;
                place += w * d;
                normal += w * self.normals[i];
            }
            (total, place, normal)
        };
        let mut outward = self.normals[nearest];
        let mut foot = r - outward * outward.dot(r - self.points[nearest]);
        // Half as wide: the nearer side of a thin wall decides.
        let (total, place, normal) = means(r, 4.0, None);
        if 0.2 * total < normal.length() {
            outward = normal.normalize();
            foot = r + outward * outward.dot(place / total);
        }
        let (total, place, normal) = means(foot, 1.0, Some(outward));
        let n = -(normal / total).try_normalize()?;
        Some((n, n.dot(foot + place / total - r)))
    }

    /// The local minimum of J by BFGS in (two turns of n, t), the frame renewed with n.
    fn plane(&self, r: DVec3) -> Option<(DVec3, f64)> {
        let (mut n, mut t) = self.start(r)?;
        let h = self.widths[self.nearest(r).0];
        let gradient = |n: DVec3, t: f64, e: [DVec3; 2]| {
            let (energy, by_n, by_t) = self.energy(r, n, t);
            (energy, Vector3::new(by_n.dot(e[0]), by_n.dot(e[1]), by_t * h))
        };
        let (e1, e2) = n.any_orthonormal_pair();
        let mut e = [e1, e2];
        let (mut energy, mut g) = gradient(n, t, e);
        let mut inverse = Matrix3::identity() * (0.1 * h * h / energy.max(1e-3 * h * h)) / (h * h);
        for _ in 0..200 {
            let mut step = -(inverse * g);
            if 0.3 < step.norm() {
                step *= 0.3 / step.norm();
            }
            let mut by = 1.0;
            let (next, next_t, next_e, next_energy, next_g) = loop {
                let m = (n + by * (step.x * e[0] + step.y * e[1])).normalize();
                let u = (e[0] - m * m.dot(e[0])).normalize();
                let frame = [u, m.cross(u) * m.cross(u).dot(e[1]).signum()];
                let tt = t + by * step.z * h;
                let (value, grad) = gradient(m, tt, frame);
                if value <= energy * (1.0 + 1e-14) || by < 1e-6 {
                    break (m, tt, frame, value, grad);
                }
                by *= 0.5;
            };
            let (s, y) = (step * by, next_g - g);
            (n, t, e, energy, g) = (next, next_t, next_e, next_energy, next_g);
            if s.norm() < 1e-13 {
                return Some((n, t));
            }
            let sy = s.dot(&y);
            if 0.0 < sy {
                let a = Matrix3::identity() - s * y.transpose() / sy;
                inverse = a * inverse * a.transpose() + s * s.transpose() / sy;
            }
        }
        Some((n, t))
    }

    /// Levin's plane from another one, by fixed point: n of least spread about q = r + t n, by an eigenvalue solver, and t a
    /// root of the derivative of the energy along n, by the secant method; in turn until neither moves. The factors of
    /// facing must be one.
    fn levin_plane(&self, r: DVec3, (mut n, mut t): (DVec3, f64)) -> Option<(DVec3, f64)> {
        let h = self.widths[self.nearest(r).0];
        for _ in 0..300 {
            let q = r + t * n;
            let mut spread = Matrix3::zeros();
            for (p, width) in self.points.iter().zip(&self.widths) {
                let x = (*p - q).to_array();
                let x = Vector3::from(x);
                spread += self.weight(x.norm_squared() / (width * width))[0] * x * x.transpose();
            }
            let eigen = spread.symmetric_eigen();
            let column = eigen.eigenvectors.column(eigen.eigenvalues.imin());
            let m = DVec3::new(column[0], column[1], column[2]);
            let m = if m.dot(n) < 0.0 { -m } else { m };
            let slope = |t: f64| self.energy(r, m, t).2;
            let (mut a, mut b) = (t, t + 1e-3 * h);
            let (mut fa, mut fb) = (slope(a), slope(b));
            for _ in 0..30 {
                if fa == fb || (b - a).abs() < 1e-16 * h {
                    break;
                }
                (a, b) = (b, b - fb * (b - a) / (fb - fa));
                (fa, fb) = (fb, slope(b));
            }
            let moved = (m - n).length().max((b - t).abs() / h);
            (n, t) = (m, b);
            if moved < 1e-15 {
                break;
            }
            if t.is_nan() || 2.0 * h <= t.abs() {
                return None;
            }
        }
        Some((n, t))
    }

    /// The same with only the points whose compact weight a plane within SLACK least widths of r can make positive: leaves out
    /// nothing but zeros.
    fn around(&self, r: DVec3) -> Reference {
        let reach = if self.gaussian { f64::INFINITY } else { 8f64.sqrt() + SLACK };
        let is_near = |i: &usize| (self.points[*i] - r).length_squared() < (reach * self.widths[*i]).powi(2);
        let near: Vec<usize> = (0..self.points.len()).filter(is_near).collect();
        Reference {
            points: near.iter().map(|i| self.points[*i]).collect(),
            normals: near.iter().map(|i| self.normals[*i]).collect(),
            widths: near.iter().map(|i| self.widths[*i]).collect(),
            ..*self
        }
    }

    /// F, where the start lies inside a trust sphere; positive outside.
    pub fn value(&self, r: DVec3) -> Option<f64> {
        let fit = self.around(r).fit(r)?;
        let least = self.widths.iter().copied().fold(f64::INFINITY, f64::min);
        let fit = if (fit.q - r).length() < SLACK * least { fit } else { self.fit(r)? };
        Some(fit.sign * ((fit.q - r).dot(fit.frame[2]) + fit.height([0.0; 2])))
    }

    /// Plane and polynomial at a point.
    pub fn fit(&self, r: DVec3) -> Option<Fit> {
        let mut plane = self.plane(r)?;
        if self.levin {
            plane = self.levin_plane(r, plane)?;
        }
        let (n, t) = plane;
        let h = self.widths[self.nearest(r).0];
        let q = r + t * n;
        let (e1, e2) = n.any_orthonormal_pair();
        let (mut rows, mut heights, mut vote) = (Vec::new(), Vec::new(), 0.0);
        for i in 0..self.points.len() {
            let x = self.points[i] - q;
            let w = self.weight(x.length_squared() / self.widths[i].powi(2))[0]
                * self.facing(-self.normals[i].dot(n))[0];
            if w == 0.0 {
                continue;
            }
            vote += w * self.normals[i].dot(n);
            let terms = monomials(self.degree, [x.dot(e1) / h, x.dot(e2) / h]);
            rows.extend(terms.into_iter().map(|m| w.sqrt() * m));
            heights.push(w.sqrt() * x.dot(n) / h);
        }
        let columns = (self.degree + 1) * (self.degree + 2) / 2;
        if heights.len() < columns {
            return None;
        }
        let qr = DMatrix::from_row_slice(heights.len(), columns, &rows).qr();
        let c = qr.r().solve_upper_triangular(&(qr.q().transpose() * DVector::from_vec(heights)))?;
        Some(Fit {
            q,
            frame: [e1, e2, n],
            h,
            degree: self.degree,
            c: c.as_slice().to_vec(),
            sign: -vote.signum(),
        })
    }
}

/// A plane with a polynomial over it.
pub struct Fit {
    pub q: DVec3,
    /// In the plane, in the plane, across it.
    pub frame: [DVec3; 3],
    h: f64,
    degree: usize,
    c: Vec<f64>,
    sign: f64,
}

impl Fit {
    /// The polynomial's height at a place of the plane.
    pub fn height(&self, [x, y]: [f64; 2]) -> f64 {
        let terms = monomials(self.degree, [x / self.h, y / self.h]);
        self.h * terms.iter().zip(&self.c).map(|(m, c)| m * c).sum::<f64>()
    }

    /// Where a line of unit direction meets the polynomial next to arc length `s`, by the secant method.
    pub fn meet(&self, origin: DVec3, dir: DVec3, s: f64) -> Option<f64> {
        let off = |s: f64| {
            let x = origin + dir * s - self.q;
            x.dot(self.frame[2]) - self.height([x.dot(self.frame[0]), x.dot(self.frame[1])])
        };
        let (mut a, mut b) = (s, s + 1e-3 * self.h);
        let (mut fa, mut fb) = (off(a), off(b));
        for _ in 0..60 {
            if fb == fa {
                break;
            }
            let c = b - (fb * (b - a) / (fb - fa)).clamp(-self.h, self.h);
            (a, fa, b, fb) = (b, fb, c, off(c));
            if (b - a).abs() < 1e-15 {
                break;
            }
        }
        (fb.abs() < 1e-12 * self.h).then_some(b)
    }
}

fn monomials(degree: usize, [u, v]: [f64; 2]) -> Vec<f64> {
    (0..=degree).flat_map(|a| (0..=degree - a).map(move |b| u.powi(a as i32) * v.powi(b as i32))).collect()
}
