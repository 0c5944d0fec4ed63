//! What loading makes of duplicates, gaps in the data, tiny clouds, outliers and far places; named by their numbers in the
//! list of numerical stress cases.

mod common;

use common::{Truth, all, chord};
use glam::DVec3;
use pss::cloud::{Cloud, SampleOptions, Samples, ply};
use pss::geom::Ray;
use pss::num::hash::Stream;
use pss::solid::point_set::{FieldScratch, Options, PointSet};
use pss::solid::{Crossing, Scratch, Solid};

fn samples(points: Vec<DVec3>) -> Samples {
    Samples::new(Cloud { points, ..Cloud::default() }, &SampleOptions::default()).unwrap()
}

fn crossings(s: &Samples, center: DVec3) -> Vec<Vec<Crossing>> {
    let set = PointSet::new(&s.points, &s.normals, &s.widths, &Options::default());
    let mut scratch = Scratch::default();
    (0..500).map(|i| all(&set, &chord(i, center, 1.4), &mut scratch)).collect()
}

fn farthest(a: &[Vec<Crossing>], b: &[Vec<Crossing>]) -> f64 {
    let mut worst: f64 = 0.0;
    for (a, b) in a.iter().zip(b) {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).for_each(|(a, b)| worst = worst.max((a.t - b.t).abs() - a.err - b.err));
    }
    worst
}

#[test]
fn f7_a_thousand_copies_of_a_point_weigh_as_one() {
    let (points, _) = Truth::Sphere.cloud(3000);
    let mut copied = points.clone();
    for p in points.iter().step_by(100) {
        copied.extend(std::iter::repeat_n(*p, 1000));
    }
    let (once, often) = (samples(points), samples(copied));
    assert_eq!(once.points, often.points);
    assert!(farthest(&crossings(&once, DVec3::ZERO), &crossings(&often, DVec3::ZERO)) <= 1e-12);
}

#[test]
fn f8_points_that_are_no_numbers_are_dropped_counted_and_change_nothing() {
    let (points, _) = Truth::Sphere.cloud(3000);
    let row = |p: &DVec3| format!("{} {} {}\n", p.x, p.y, p.z);
    let text = |bad: bool| {
        let mut rows: Vec<String> = points.iter().map(row).collect();
        if bad {
            rows.insert(700, "nan 0 0\n".to_owned());
            rows.insert(2000, "1 inf 0\n".to_owned());
        }
        let columns = ["x", "y", "z"].map(|c| format!("property double {c}\n")).concat();
        format!(
            "ply\nformat ascii 1.0\nelement vertex {}\n{columns}end_header\n{}",
            rows.len(),
            rows.concat()
        )
    };
    let [clean, bad] = [false, true].map(|bad| ply::read(text(bad).as_bytes()).unwrap());
    assert_eq!(clean.points, bad.points);
    assert!(bad.notes.iter().any(|n| n.contains('2') && n.contains("700")), "{:?}", bad.notes);
}

/// `n` samples of a shallow bowl, even from the middle out, with normals.
fn bowl(n: usize) -> Cloud {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let point = |i: usize| {
        let (r, (sin, cos)) = ((i as f64 + 0.5).sqrt(), (golden * i as f64).sin_cos());
        DVec3::new(r * cos, r * sin, 0.05 * r * r)
    };
    let points: Vec<DVec3> = (0..n).map(point).collect();
    let normals = points.iter().map(|p| DVec3::new(-0.1 * p.x, -0.1 * p.y, 1.0).normalize()).collect();
    Cloud { points, normals: Some(normals), ..Cloud::default() }
}

/// A quadric has six coefficients, and is only taken where 7.2 samples weigh in full: fewer determine it, but as badly as
/// an interpolation. So three to seven samples give a plane, and a quadric fades in from eight on, by how evenly they weigh.
#[test]
fn f9_clouds_of_one_to_ten_points_are_refused_or_have_the_degree_they_can_carry() {
    for n in 1..=12 {
        let made = Samples::new(bowl(n), &SampleOptions::default());
        if n < 3 {
            assert!(made.is_err(), "{n}");
            continue;
        }
        let s = made.unwrap();
        assert_eq!(s.len(), n);
        assert!(s.widths.iter().all(|w| w.is_finite() && 0.0 < *w), "{n}");
        let set = PointSet::new(&s.points, &s.normals, &s.widths, &Options::default());
        let mut field = FieldScratch::default();
        let degrees: Vec<usize> =
            s.points.iter().filter_map(|p| set.field(*p, &mut field).ok()).map(|f| f.degree).collect();
        println!("{n}: {degrees:?}");
        assert!(!degrees.is_empty(), "{n}: no sample has a surface");
        let (least, most) = (degrees.iter().min().unwrap(), degrees.iter().max().unwrap());
        assert!(if n < 8 { *most <= 1 } else { *least <= 2 && *most <= 2 }, "{n}: {degrees:?}");
        for hits in crossings(&s, DVec3::ZERO) {
            assert!(hits.iter().all(|c| c.t.is_finite() && c.err.is_finite()), "{n}");
        }
    }
}

#[test]
fn f10_points_on_a_line_or_nearly_are_no_surface() {
    let line = |noise: f64| -> Vec<DVec3> {
        let mut stream = Stream::new(10);
        let base = DVec3::new(-89.546, 4.03964, 450.883);
        let along = DVec3::new(0.3, 0.7, -0.2);
        (0..50).map(|i| base + along * f64::from(i) * 0.01 + noise * stream.direction()).collect()
    };
    for noise in [0.0, 1e-14] {
        let cloud = Cloud { points: line(noise), ..Cloud::default() };
        let error = Samples::new(cloud, &SampleOptions::default()).unwrap_err();
        assert!(error.message.contains("line"), "{}", error.message);
    }
}

/// Even points of the unit sphere and strays about them.
struct Dirty {
    points: Vec<DVec3>,
    strays: Vec<DVec3>,
}

impl Dirty {
    /// Uniform in radius between half and one and a half of the ball's.
    fn shell(share: f64, seed: u64) -> Dirty {
        Dirty::new(share, seed, |s| s.direction() * (0.5 + s.unit()))
    }

    /// Uniform in a box half as large again as the ball.
    fn boxed(share: f64, seed: u64) -> Dirty {
        Dirty::new(share, seed, |s| DVec3::new(s.unit(), s.unit(), s.unit()) * 3.0 - 1.5)
    }

    fn new(share: f64, seed: u64, draw: fn(&mut Stream) -> DVec3) -> Dirty {
        let points = fibonacci(10_000);
        let mut stream = Stream::new(seed);
        let strays = (0..(share * 10_000.0) as usize).map(|_| draw(&mut stream)).collect();
        Dirty { points, strays }
    }

    fn samples(&self) -> Samples {
        samples(self.points.iter().chain(&self.strays).copied().collect())
    }
}

fn fibonacci(n: usize) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let point = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / n as f64;
        let (sin, cos) = (golden * i as f64).sin_cos();
        DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    };
    (0..n).map(point).collect()
}

/// What strays that were kept do to the crossings of some chords and of lines through the middle.
#[derive(Debug, Default)]
struct Harm {
    odd: usize,
    /// Lines through the middle that do not meet the ball twice.
    middle: usize,
    /// Chords with another number of crossings than those of the clean cloud.
    other: usize,
    /// Chords none of whose crossings is within reach of a kept stray, and the most that one of them is moved along the normal.
    untouched: usize,
    moved: f64,
    /// The most that any crossing is moved.
    most: f64,
}

impl Harm {
    fn of(s: &Samples, clean: &Samples, kept: &[DVec3], chords: u64) -> Harm {
        let set = |s: &Samples| PointSet::new(&s.points, &s.normals, &s.widths, &Options::default());
        let (a, b) = (set(s), set(clean));
        let mut scratch = Scratch::default();
        // The sum of what a weight reaches: its support, about a foot that lies within one width.
        let reach = (8f64.sqrt() + 1.0) * s.widths.iter().fold(0.0f64, |a, b| a.max(*b));
        let mut harm = Harm::default();
        let mut stream = Stream::new(1515);
        for i in 0..chords {
            let d = stream.direction();
            let through = Ray::new(-3.0 * d, d);
            let ray = if i % 8 == 0 { through } else { chord(i, DVec3::ZERO, 1.4) };
            let (p, q) = (all(&a, &ray, &mut scratch), all(&b, &ray, &mut scratch));
            harm.odd += p.len() % 2;
            harm.other += usize::from(p.len() != q.len());
            if i % 8 == 0 && p.len() != 2 {
                println!("a line through the middle of the ball: {d:?} {p:?} {q:?}");
                harm.middle += 1;
            }
            let far = |c: &Crossing| kept.iter().all(|k| reach < k.distance(ray.at(c.t)));
            let untouched = p.iter().chain(&q).all(far);
            harm.untouched += usize::from(untouched);
            for (p, q) in p.iter().zip(&q).filter(|_| p.len() == q.len()) {
                let shift = (p.t - q.t).abs() * ray.dir.dot(ray.at(q.t).normalize()).abs();
                harm.most = harm.most.max(shift);
                harm.moved = harm.moved.max(if untouched { shift } else { 0.0 });
            }
        }
        harm
    }
}

/// Strays nearer than a quarter of a spacing to the surface cannot be told from its samples: they stay. All others go, and no
/// sample of the surface with them. `PSS_LONG=1` sends 100,000 chords through each cloud.
fn strays_do_no_harm(case: &str, seeds: u64, make: impl Fn(u64) -> Dirty) {
    let chords = if std::env::var_os("PSS_LONG").is_some() { 100_000 } else { 800 };
    let spacing = (4.0 * std::f64::consts::PI / 1e4).sqrt();
    let clean = samples(fibonacci(10_000));
    for seed in 0..seeds {
        let dirty = make(seed);
        let s = dirty.samples();
        let is_kept = |p: &&DVec3| s.points.contains(p);
        let kept: Vec<DVec3> = dirty.strays.iter().filter(is_kept).copied().collect();
        assert_eq!(s.len(), 10_000 + kept.len(), "{case} {seed}: samples of the ball were dropped");
        let height = |p: &DVec3| (p.length() - 1.0).abs() / spacing;
        let highest = kept.iter().map(height).fold(0.0, f64::max);
        let harm = Harm::of(&s, &clean, &kept, chords);
        let lost = dirty.strays.len() - kept.len();
        println!(
            "{case} {seed}: {lost} of {} dropped, the farthest kept {highest:.2} spacings off; {harm:?}",
            dirty.strays.len()
        );
        assert!(highest < 0.4);
        let widest = s.widths.iter().fold(0.0f64, |a, b| a.max(*b));
        assert!(widest < 3.0 * spacing, "{widest}");
        assert!(harm.odd + harm.middle == 0 && harm.moved <= 1e-6 && harm.most < 0.1 * spacing, "{harm:?}");
        assert!(chords < 4 * harm.untouched as u64);
    }
}

#[test]
fn f15_strays_about_a_ball_are_dropped_or_harmless() {
    strays_do_no_harm("0.1 %", 12, |seed| Dirty::shell(0.001, seed));
    strays_do_no_harm("1 %", 12, |seed| Dirty::shell(0.01, 100 + seed));
}

#[test]
fn case_78_a_ball_in_a_cloud_of_a_twentieth_of_strays_is_the_ball() {
    strays_do_no_harm("5 % in a shell", 6, |seed| Dirty::shell(0.05, 200 + seed));
    strays_do_no_harm("5 % in a box", 6, |seed| Dirty::boxed(0.05, 300 + seed));
}

/// A cloud that went through a PLY of doubles.
fn through_file(points: Vec<DVec3>, encoding: ply::Encoding) -> Cloud {
    let mut bytes = Vec::new();
    ply::write(&Cloud { points, ..Cloud::default() }, encoding, &mut bytes).unwrap();
    assert!(String::from_utf8_lossy(&bytes).contains("property double x"));
    ply::read(&bytes).unwrap()
}

#[test]
fn f23_a_far_cloud_in_a_file_of_doubles_equals_its_twin_at_the_origin() {
    let (points, _) = Truth::Torus.cloud(4000);
    let far = [[1e7, 1e7, 1e7], [1e7, -0.7e7, 0.3e7], [1e9, 1e9, 1e9], [5e5, 5e6, 100.0]];
    for (offset, encoding) in far.into_iter().zip([ply::Encoding::Binary, ply::Encoding::Text].repeat(2)) {
        let offset = DVec3::from_array(offset);
        // The twin gets the same rounding of coordinates.
        let far: Vec<DVec3> = points.iter().map(|p| *p + offset).collect();
        let near: Vec<DVec3> = far.iter().map(|p| *p - offset).collect();
        let set = |cloud: Cloud| {
            let s = Samples::new(cloud, &SampleOptions::default()).unwrap();
            assert_eq!(s.len(), points.len(), "{offset}");
            PointSet::new(&s.points, &s.normals, &s.widths, &Options::default())
        };
        let (a, b) = (set(Cloud { points: near, ..Cloud::default() }), set(through_file(far, encoding)));
        let mut scratch = Scratch::default();
        // A place on a ray is rounded so far from the origin: by 1.2e-7 at 1e9.
        let allowed = 1e-8f64.max(4.0 * f64::EPSILON * offset.abs().max_element());
        for i in 0..500 {
            let Ray { origin, dir, .. } = chord(i, DVec3::ZERO, 1.4);
            let there = Ray::new(origin + offset, dir);
            let here = Ray::new(there.origin - offset, dir);
            let (p, q) = (all(&a, &here, &mut scratch), all(&b, &there, &mut scratch));
            assert_eq!(p.len(), q.len(), "{offset}");
            for (p, q) in p.iter().zip(&q) {
                // Along the normal: a grazing line spreads it out.
                let normal = a.normal(&here, p, &mut scratch);
                let apart = (p.t - q.t).abs() * dir.dot(normal).abs();
                assert!(apart <= allowed, "{offset}: {apart:e}");
            }
        }
    }
}

#[test]
fn f22_floats_too_coarse_for_the_cloud_are_said_to_be_so() {
    // A step is 1 at 1e7: nothing of a unit ball is left.
    let (points, _) = Truth::Sphere.cloud(4000);
    let round = |p: &DVec3| (*p + 1e7).to_array().map(|x| f64::from(x as f32));
    let points = points.iter().map(|p| DVec3::from_array(round(p))).collect();
    let error = Samples::new(Cloud { points, ..Cloud::default() }, &SampleOptions::default()).unwrap_err();
    assert!(error.message.contains("apart"), "{}", error.message);
    assert!(error.help.unwrap().contains("double"));
}
