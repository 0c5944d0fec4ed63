//! Every solid in closed form against its implicit function, written another way: what is inside along random rays, and
//! how near to the surface each crossing lies.

mod solid_support;

use glam::{DVec3, dvec3};
use pss::num::hash::Stream;
use solid_support::{EPS, Subject, holds, line, slope};

/// Below zero inside; above its own rounding a sign that can be trusted. On the scale of a length.
type Implicit = fn(DVec3) -> f64;

fn segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let ab = b - a;
    let s = if ab == DVec3::ZERO { 0.0 } else { ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0) };
    p.distance(a + s * ab)
}

fn frustum(p: DVec3, r1: f64, r2: f64, a: DVec3, b: DVec3) -> f64 {
    let axis = (b - a).normalize();
    let (z, h) = ((p - a).dot(axis), a.distance(b));
    let rho = (p - a - z * axis).length();
    (rho - (r1 + (r2 - r1) * z / h)).max(-z).max(z - h)
}

fn torus(p: DVec3, major: f64, minor: f64) -> f64 {
    (p.truncate().length() - major).hypot(p.z) - minor
}

fn super_norm(p: DVec3, r: DVec3, e1: f64, e2: f64) -> f64 {
    let p = (p / r).abs();
    let across = (p.x.powf(2.0 / e1) + p.y.powf(2.0 / e1)).powf(e1 / e2);
    ((across + p.z.powf(2.0 / e2)).powf(0.5 * e2) - 1.0) * r.min_element()
}

fn rounded(p: DVec3, min: DVec3, max: DVec3, r: f64) -> f64 {
    let core = p.clamp(min + r, (max - r).max(min + r));
    p.distance(core) - r
}

const CASES: &[(&str, Implicit)] = &[
    ("sphere(r: 2, at: [1, 0, 3])", |p| p.distance(dvec3(1.0, 0.0, 3.0)) - 2.0),
    ("sphere(r: [3, 1, 0.1])", |p| 0.1 * ((p / dvec3(3.0, 1.0, 0.1)).length() - 1.0)),
    ("box([0, 0, 0], [2, 1, 3])", |p| {
        (p - dvec3(1.0, 0.5, 1.5)).abs().max_element_past(dvec3(1.0, 0.5, 1.5))
    }),
    ("box([0, 0, 0], [2, 1, 3], round: 0.2)", |p| rounded(p, DVec3::ZERO, dvec3(2.0, 1.0, 3.0), 0.2)),
    ("box(size: [2, 2, 6], round: 1)", |p| segment(p, dvec3(0.0, 0.0, -2.0), dvec3(0.0, 0.0, 2.0)) - 1.0),
    ("cylinder(r: 0.5, from: [1, 2, 3], to: [-1, 0, 2])", |p| {
        frustum(p, 0.5, 0.5, dvec3(1.0, 2.0, 3.0), dvec3(-1.0, 0.0, 2.0))
    }),
    ("cone(r1: 1, r2: 0, h: 2)", |p| frustum(p, 1.0, 0.0, DVec3::ZERO, dvec3(0.0, 0.0, 2.0))),
    ("cone(r1: 0, r2: 3, h: 1)", |p| frustum(p, 0.0, 3.0, DVec3::ZERO, DVec3::Z)),
    ("cone(r1: 1, r2: 1, h: 1)", |p| frustum(p, 1.0, 1.0, DVec3::ZERO, DVec3::Z)),
    ("cone(r1: 0.2, r2: 1.5, from: [1, 1, 0], to: [0, 2, 3])", |p| {
        frustum(p, 0.2, 1.5, dvec3(1.0, 1.0, 0.0), dvec3(0.0, 2.0, 3.0))
    }),
    ("capsule(r: 0.5, from: [1, 2, 3], to: [-1, 0, 2])", |p| {
        segment(p, dvec3(1.0, 2.0, 3.0), dvec3(-1.0, 0.0, 2.0)) - 0.5
    }),
    ("tube([[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 1, 0], [0, 1, 0.5]], r: 0.4)", |p| {
        let points =
            [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.5]].map(DVec3::from_array);
        points.windows(2).map(|w| segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min) - 0.4
    }),
    ("torus(major: 1, minor: 0.25)", |p| torus(p, 1.0, 0.25)),
    ("torus(major: 1, minor: 1)", |p| torus(p, 1.0, 1.0)),
    ("torus(major: 0.5, minor: 1)", |p| torus(p, 0.5, 1.0)),
    ("torus(major: 1, minor: 0.001)", |p| torus(p, 1.0, 0.001)),
    ("superellipsoid(r: 1, e1: 0.4, e2: 0.6)", |p| super_norm(p, DVec3::ONE, 0.4, 0.6)),
    ("superellipsoid(r: [1, 2, 0.5], e1: 2, e2: 1.3)", |p| super_norm(p, dvec3(1.0, 2.0, 0.5), 2.0, 1.3)),
    ("superellipsoid(r: 1, e1: 1, e2: 0.1)", |p| super_norm(p, DVec3::ONE, 1.0, 0.1)),
    ("quadric(squares: [1, 1, -1], constant: -0.25)", |p| p.x * p.x + p.y * p.y - p.z * p.z - 0.25),
    ("quadric(squares: [1, 1, -1], constant: 0.25)", |p| p.x * p.x + p.y * p.y - p.z * p.z + 0.25),
    ("quadric(squares: [-1, 1, 0], products: [1, 2, -1], linear: [0, 1, 3], constant: 0.3)", |p| {
        p.y * p.y - p.x * p.x + p.x * p.y + 2.0 * p.y * p.z - p.z * p.x + p.y + 3.0 * p.z + 0.3
    }),
];

/// The largest excess of the coordinates over limits.
trait Past {
    fn max_element_past(self, limits: DVec3) -> f64;
}

impl Past for DVec3 {
    fn max_element_past(self, limits: DVec3) -> f64 {
        (self - limits).max_element()
    }
}

#[test]
fn what_is_inside_along_a_ray_is_what_the_implicit_function_says() {
    for (text, f) in CASES {
        let subject = Subject::new(text).unwrap();
        let mut stream = Stream::new(3);
        let (mut inside, mut thin) = (0, 0);
        for _ in 0..4000 {
            let ray = subject.ray(&mut stream);
            let line = line(&*subject.solid, &ray);
            let (shift, _) = ray.nearest_to(subject.center);
            let step = subject.size / ray.dir.length();
            // Rounding of the point itself, on the scale of the origin's distance.
            let noise = 64.0 * EPS * subject.scale(&ray) * subject.size.max(1.0);
            for k in 0..200 {
                let t = shift + (f64::from(k) + stream.unit() - 100.0) * 0.01 * step;
                let value = f(ray.at(t));
                if value.abs() <= noise {
                    thin += 1;
                    continue;
                }
                inside += i32::from(value < 0.0);
                assert_eq!(holds(&line, t), value < 0.0, "{text} {ray:?} t {t} value {value:e} {line:?}");
            }
        }
        assert!(10 < inside && thin < 40_000, "{text}: {inside} inside, {thin} too near");
    }
}

/// Crossings lie on the surface to 16 eps S, whatever the distance: S the largest length in play.
#[test]
fn every_crossing_lies_on_the_surface_to_rounding() {
    for (text, f) in CASES {
        let subject = Subject::new(text).unwrap();
        let mut stream = Stream::new(4);
        let mut worst: f64 = 0.0;
        for _ in 0..20_000 {
            let ray = subject.ray(&mut stream);
            for c in line(&*subject.solid, &ray).0 {
                let at = ray.at(c.t);
                // The function's own growth across the surface turns its value into a distance.
                let n = solid_support::normal(&*subject.solid, &ray, &c);
                let h = 1e-4 * subject.size;
                let growth = (f(at + h * n) - f(at - h * n)) / (2.0 * h);
                let far = f(at).abs() / growth.abs().max(0.05);
                let scale = subject.scale(&ray).max(at.length());
                worst = worst.max(far / (EPS * scale));
            }
        }
        println!("{text}: {worst:.2} eps S");
        assert!(worst <= 16.0, "{text}: {worst}");
    }
}

#[test]
fn crossings_at_a_grazing_incidence_come_in_pairs_or_not_at_all() {
    for (text, _) in CASES {
        let subject = Subject::new(text).unwrap();
        let mut stream = Stream::new(6);
        let mut pairs = 0;
        for _ in 0..3000 {
            let ray = subject.ray(&mut stream);
            let crossings = line(&*subject.solid, &ray).0;
            let Some(c) = crossings.first() else { continue };
            // Through the same point across the normal, and a little off it.
            let n = solid_support::normal(&*subject.solid, &ray, c);
            let across = n.cross(stream.direction());
            let off = [0.0, EPS, -EPS, 1e-12, -1e-12, 1e-8, -1e-8][(7.0 * stream.unit()) as usize];
            let at = ray.at(c.t) + off * subject.size * n;
            let grazing = pss::geom::Ray::new(at - across * subject.size * stream.unit(), across);
            let line = line(&*subject.solid, &grazing);
            assert!(line.0.windows(2).all(|w| w[0].t < w[1].t && w[0].entering != w[1].entering), "{text}");
            if subject.solid.bounds().is_finite() {
                assert!(line.0.len().is_multiple_of(2) && !line.1, "{text} {grazing:?} {line:?}");
            }
            pairs += line.0.len();
            let steep = |c| slope(&*subject.solid, &grazing, c);
            assert!(line.0.iter().all(|c| steep(c).is_finite()));
        }
        assert!(100 < pairs, "{text}: {pairs}");
    }
}
