//! Run time against error: this surface beside other ways to meet a cloud of points with a ray.
//!
//! `cargo run --release --example time_vs_error` writes `examples/time_vs_error/results.csv` and the plots beside it (SVG
//! and PNG); `-- quick` does a tenth of the rays and writes nothing.
//!
//! A cloud of the blob of the peers' measurements (star-shaped, known in closed form), clean or with noise of 0.1 % of its
//! diagonal, is looked at by 96 x 96 rays of one eye on one thread. The error is the distance of each first crossing from
//! the blob, root mean square over the diagonal; a ray that hits where the blob is not, or the other way round, is
//! missed. `views` is how far the point met moves along the normal, over the diagonal, when the same place is looked at
//! from 25 degrees beside. Times are wall seconds of one thread over the rays: cold, and warm, the same rays again.

#[path = "../../tests/common/mod.rs"]
mod common;
mod methods;
mod plot;
mod png;

use std::fmt::Write;
use std::time::Instant;

use common::{Truth, first_below, rays_of_eye, widths};
use glam::{DQuat, DVec3};
use pss::geom::Ray;
use pss::mls::Compact;
use pss::num::hash::Stream;
use pss::solid::Body;
use pss::solid::point_set::{Lead, Options, PointSet};

use methods::{Cylinder, Iteration, Marching, Means, Method, Surface, Triangles};

/// What was measured of one method with one set of parameters.
#[derive(Clone, Debug)]
pub struct Row {
    /// Which way.
    pub method: &'static str,
    /// With what.
    pub with: String,
    /// Samples.
    pub points: usize,
    /// Noise over the diagonal.
    pub noise: f64,
    /// Seconds a ray, first pass and second.
    pub cold: f64,
    /// The second pass.
    pub warm: f64,
    /// Root mean square distance from the truth, over the diagonal.
    pub rms: f64,
    /// Largest.
    pub max: f64,
    /// Rays that hit where they should not, or do not where they should.
    pub missed: usize,
    /// Movement with the view, over the diagonal.
    pub views: f64,
    /// Projections a ray, cold and warm.
    pub projections: [f64; 2],
}

/// What all methods are asked.
struct Bench {
    rays: Vec<Ray>,
    truth: Vec<Option<f64>>,
    diagonal: f64,
}

const SHAPE: Truth = Truth::Blob;

impl Bench {
    fn new(side: usize) -> Bench {
        let rays = rays_of_eye(side);
        let truth = rays.iter().map(first_of_truth).collect();
        Bench { rays, truth, diagonal: SHAPE.diagonal() }
    }

    fn row(
        &self,
        method: &'static str,
        with: String,
        cloud: &Cloud,
        make: impl FnOnce() -> Box<dyn Method>,
    ) -> Row {
        let mut made = make();
        let mut hits = Vec::new();
        let mut times = [0.0; 2];
        let mut projections = [0.0; 2];
        for pass in 0..2 {
            let before = made.projections();
            let start = Instant::now();
            hits = self.rays.iter().map(|ray| made.first(ray)).collect();
            times[pass] = start.elapsed().as_secs_f64() / self.rays.len() as f64;
            projections[pass] = (made.projections() - before) as f64 / self.rays.len() as f64;
        }
        let (mut squares, mut max, mut count, mut missed) = (0.0, 0.0f64, 0, 0);
        for ((ray, hit), truth) in self.rays.iter().zip(&hits).zip(&self.truth) {
            match (hit, truth) {
                (Some(s), Some(_)) => {
                    let error = SHAPE.distance(ray.at(*s)) / self.diagonal;
                    squares += error * error;
                    max = max.max(error);
                    count += 1;
                }
                (None, None) => {}
                _ => missed += 1,
            }
        }
        let rms = (squares / f64::from(count)).sqrt();
        let views = self.views(made.as_mut());
        let row = Row {
            method,
            with,
            points: cloud.points.len(),
            noise: cloud.noise,
            cold: times[0],
            warm: times[1],
            rms,
            max,
            missed,
            views,
            projections,
        };
        eprintln!(
            "{:<22} {:<34} {:>7} {:>6}  {:>8.2} {:>8.2} us  {:>8.2e} {:>8.2e} {:>4}  views {:>8.2e}  {:.2} {:.2}",
            row.method,
            row.with,
            row.points,
            row.noise,
            1e6 * row.cold,
            1e6 * row.warm,
            row.rms,
            row.max,
            row.missed,
            row.views,
            row.projections[0],
            row.projections[1]
        );
        row
    }

    /// How far the point met at a place moves along the normal when it is looked at from beside.
    fn views(&self, method: &mut dyn Method) -> f64 {
        let (mut squares, mut count) = (0.0, 0);
        let mut stream = Stream::new(11);
        for (ray, truth) in self.rays.iter().zip(&self.truth).step_by(7) {
            let Some(t) = truth else { continue };
            let place = ray.at(*t);
            let axis = DVec3::new(stream.unit() - 0.5, stream.unit() - 0.5, stream.unit() - 0.5).normalize();
            let dir = DQuat::from_axis_angle(axis, 25f64.to_radians()) * ray.dir;
            let normal = SHAPE.gradient(place).normalize();
            if normal.dot(ray.dir) < -0.4 && normal.dot(dir) < -0.4 {
                let beside = Ray::new(place - 2.0 * dir, dir);
                if let (Some(a), Some(b)) = (method.first(ray), method.first(&beside)) {
                    let height = |p: DVec3| (p - place).dot(normal);
                    let (a, b) = (ray.at(a), beside.at(b));
                    let moved = height(a) - height(b);
                    // What another sheet gave is no movement.
                    if moved.abs() < 0.02 * self.diagonal {
                        squares += moved * moved;
                        count += 1;
                    }
                }
            }
        }
        (squares / f64::from(count.max(1))).sqrt() / self.diagonal
    }
}

/// The first crossing of the blob itself: steps, then halving.
fn first_of_truth(ray: &Ray) -> Option<f64> {
    first_below(|t| SHAPE.implicit(ray.at(t)), 1.5, 6.0, 2000)
}

/// Samples of the blob.
struct Cloud {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    noise: f64,
}

impl Cloud {
    fn new(count: usize, noise: f64) -> Cloud {
        let (mut points, normals) = SHAPE.cloud(count);
        let mut stream = Stream::new(12345);
        let sigma = noise * SHAPE.diagonal();
        if 0.0 < noise {
            for p in &mut points {
                let mut normal = || {
                    let (a, b) = (1.0 - stream.unit(), stream.unit());
                    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
                };
                *p += sigma * DVec3::new(normal(), normal(), normal());
            }
        }
        Cloud { points, normals, noise }
    }

    fn surface(&self, smoothing: f64, options: &Options) -> PointSet {
        PointSet::new(&self.points, &self.normals, &widths(&self.points, smoothing), options)
            .with_body(Body::Solid)
    }
}

fn surfaces(bench: &Bench, cloud: &Cloud, rows: &mut Vec<Row>) {
    let mut add = |method, smoothing, options: Options| {
        let with = format!(
            "degree {} width {smoothing} {} tolerance {:e}",
            options.degree,
            if options.gaussian { "gaussian" } else { "compact" },
            options.tolerance
        );
        rows.push(
            bench.row(method, with, cloud, || Box::new(Surface::new(&cloud.surface(smoothing, &options)))),
        );
    };
    let base = Options { tolerance: 1e-7, ..Options::default() };
    add("this, F alone", 1.0, Options { degree: 3, lead: Lead::Search, ..base });
    for degree in [0, 1, 2, 3, 4] {
        add("this, guides", 1.0, Options { degree, ..base });
        add("this, patches", 1.0, Options { degree, lead: Lead::Patches, ..base });
    }
    for tolerance in [1e-5, 1e-6, 1e-8, 1e-9] {
        add("this, patches", 1.0, Options { degree: 3, tolerance, lead: Lead::Patches, ..base });
    }
    for smoothing in [0.7, 0.85, 1.3, 1.6] {
        add("this, patches", smoothing, Options { degree: 3, lead: Lead::Patches, ..base });
        add("this, patches", smoothing, Options { degree: 4, lead: Lead::Patches, ..base });
    }
    add("this, patches", 1.0, Options { degree: 3, gaussian: true, lead: Lead::Patches, ..base });
}

fn others(bench: &Bench, cloud: &Cloud, rows: &mut Vec<Row>) {
    let diagonal = bench.diagonal;
    let set = |degree| cloud.surface(1.0, &Options { degree, ..Options::default() });
    for degree in [2, 3] {
        for tolerance in [1e-4, 1e-6, 1e-9] {
            let with = format!("degree {degree} width 1 compact tolerance {tolerance:e}");
            rows.push(bench.row("paper's iteration", with, cloud, || {
                let scratch = Default::default();
                Box::new(Iteration { set: set(degree), tolerance: tolerance * diagonal, scratch })
            }));
        }
    }
    for (step, tolerance) in [(0.5, 1e-4), (0.25, 1e-6), (0.25, 1e-9)] {
        let with = format!("degree 2 step {step} tolerance {tolerance:e}");
        rows.push(bench.row("marching, bisection", with, cloud, || {
            let scratch = Default::default();
            Box::new(Marching { set: set(2), step, tolerance: tolerance * diagonal, scratch })
        }));
    }
    for width in [0.5, 1.0] {
        let with = format!("width {width} compact tolerance 1e-9");
        rows.push(bench.row("means of 2003", with, cloud, || {
            let set = cloud.surface(width, &Options::default());
            Box::new(Means { set, tolerance: 1e-9 * diagonal, weight: Compact })
        }));
    }
    for radius in [0.5, 1.0] {
        let with = format!("radius {radius} widths");
        rows.push(bench.row("cylinder average", with, cloud, || Box::new(Cylinder { set: set(2), radius })));
    }
    rows.push(
        bench.row("triangles", String::from("Delaunay"), cloud, || Box::new(Triangles::new(&cloud.points))),
    );
}

fn csv(rows: &[Row]) -> String {
    let mut out = String::from(
        "method,with,points,noise,cold_us,warm_us,rms,max,missed,views,projections_cold,projections_warm\n",
    );
    for r in rows {
        let _ = writeln!(
            out,
            "\"{}\",\"{}\",{},{},{:.3},{:.3},{:.3e},{:.3e},{},{:.3e},{:.3},{:.3}",
            r.method,
            r.with,
            r.points,
            r.noise,
            1e6 * r.cold,
            1e6 * r.warm,
            r.rms,
            r.max,
            r.missed,
            r.views,
            r.projections[0],
            r.projections[1]
        );
    }
    out
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::args().any(|a| a == "quick");
    let bench = Bench::new(if quick { 30 } else { 96 });
    let mut rows = Vec::new();
    let sizes: &[usize] = if quick { &[10_000] } else { &[10_000, 40_000, 160_000] };
    for noise in [0.0, 1e-3] {
        for &size in sizes {
            let cloud = Cloud::new(size, noise);
            surfaces(&bench, &cloud, &mut rows);
            others(&bench, &cloud, &mut rows);
        }
    }
    if !quick {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/time_vs_error");
        std::fs::write(format!("{folder}/results.csv"), csv(&rows))?;
        for (noise, name) in [(0.0, "clean"), (1e-3, "noisy")] {
            plot::write(&rows, noise, &format!("{folder}/{name}"))?;
        }
    }
    Ok(())
}
