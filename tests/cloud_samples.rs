//! Samples: their order, their normals with and without those of the file, strays, options.

mod cloud_common;

use cloud_common::{fibonacci_sphere, random_sphere, random_torus};
use glam::DVec3;
use pss::cloud::{Cloud, NormalSource, SampleOptions, Samples};
use pss::num::hash::Stream;

fn cloud(points: Vec<DVec3>, normals: Option<Vec<DVec3>>) -> Cloud {
    Cloud { points, normals, ..Cloud::default() }
}

fn samples(cloud: Cloud) -> Samples {
    Samples::new(cloud, &SampleOptions::default()).unwrap()
}

/// How many normals of the samples are on the wrong side of `truth`.
fn wrong(samples: &Samples, truth: impl Fn(DVec3) -> DVec3) -> usize {
    samples.points.iter().zip(&samples.normals).filter(|(p, n)| n.dot(truth(**p)) <= 0.0).count()
}

fn torus_normal(p: DVec3) -> DVec3 {
    let ring = DVec3::new(p.x, p.y, 0.0).normalize();
    (p - ring).normalize()
}

/// Two sheets, `gap` apart, closed at the edge; spacing about `1 / n`.
fn slab(n: usize, gap: f64) -> Vec<DVec3> {
    let mut stream = Stream::new(12);
    let mut points = Vec::new();
    for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
        for side in [-0.5, 0.5] {
            let mut jitter = || 0.5 * stream.unit();
            points.push(DVec3::new(
                (i as f64 + jitter()) / n as f64,
                (j as f64 + jitter()) / n as f64,
                side * gap,
            ));
        }
    }
    let rows = (gap * n as f64).round() as usize;
    for (row, k) in (1..rows).flat_map(|row| (0..n).map(move |k| (row, k))) {
        let (z, t) = (gap * (row as f64 / rows as f64 - 0.5), (k as f64 + 0.5 * stream.unit()) / n as f64);
        let end = 1.0 - 0.5 / n as f64;
        points.extend([[0.0, t], [end, t], [t, 0.0], [t, end]].map(|[x, y]| DVec3::new(x, y, z)));
    }
    points
}

#[test]
fn the_order_in_the_file_does_not_matter() {
    let (mut points, mut normals) = random_torus(3000, 2);
    // Equal points with unequal normals, missing normals, a stray.
    points.extend_from_within(..200);
    normals.extend(normals[200..400].to_vec());
    normals[700..750].fill(DVec3::ZERO);
    points.push(DVec3::splat(9.0));
    normals.push(DVec3::X);
    let mut order: Vec<usize> = (0..points.len()).collect();
    for source in [NormalSource::File, NormalSource::Estimate] {
        let options = SampleOptions { normals: source, ..SampleOptions::default() };
        let made = Samples::new(cloud(points.clone(), Some(normals.clone())), &options).unwrap();
        for seed in 0..3 {
            let mut stream = Stream::new(seed);
            for i in (1..order.len()).rev() {
                order.swap(i, (stream.unit() * (i + 1) as f64) as usize);
            }
            let pick = |from: &[DVec3]| order.iter().map(|&i| from[i]).collect::<Vec<_>>();
            let shuffled = Samples::new(cloud(pick(&points), Some(pick(&normals))), &options).unwrap();
            assert!(shuffled == made, "{source:?}");
        }
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let (points, _) = random_torus(5000, 7);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| samples(cloud(points.clone(), None)))
    };
    assert!(run(1) == run(3));
}

#[test]
fn estimated_normals_point_out() {
    for n in [200, 2000, 20_000] {
        let sphere = samples(cloud(random_sphere(n, 3), None));
        assert_eq!(wrong(&sphere, |p| p), 0, "sphere of {n}");
        let (points, _) = random_torus(n.max(1000), 5);
        assert_eq!(wrong(&samples(cloud(points, None)), torus_normal), 0, "torus of {n}");
    }
}

#[test]
fn the_wall_of_a_cavity_points_into_it() {
    let inner = fibonacci_sphere(2000).into_iter().map(|p| 0.5 * p);
    let points: Vec<DVec3> = fibonacci_sphere(8000).into_iter().chain(inner).collect();
    let shell = samples(cloud(points, None));
    assert_eq!(wrong(&shell, |p| p * (p.length() - 0.75)), 0);
}

#[test]
fn the_sheets_of_a_thin_wall_face_away_from_each_other() {
    // A width is some two spacings.
    for spacings in [2.0, 3.0, 6.0] {
        let wall = samples(cloud(slab(60, spacings / 60.0), None));
        let rim = |p: &DVec3| p.x.min(p.y) < 0.05 || 0.95 < p.x.max(p.y);
        let inner = wall.points.iter().zip(&wall.normals).filter(|(p, _)| !rim(p));
        let wrong = inner.filter(|(p, n)| n.z * p.z <= 0.0).count();
        assert_eq!(wrong, 0, "{spacings} spacings");
    }
}

#[test]
fn flipped_normals_are_turned_back() {
    let mut stream = Stream::new(21);
    for (share, most) in [(0.05, 0), (0.2, 0), (0.3, 20)] {
        let (points, mut normals) = random_torus(20_000, 9);
        normals.iter_mut().for_each(|n| *n = if stream.unit() < share { -*n } else { *n });
        let made = samples(cloud(points, Some(normals)));
        let left = wrong(&made, torus_normal);
        assert!(left <= most, "{share}: {left} wrong, {:?}", made.notes);
        assert!(made.notes.iter().any(|n| n.contains("opposed")), "{:?}", made.notes);
    }
}

#[test]
fn normals_that_all_point_inward_are_turned() {
    let (points, normals) = random_torus(4000, 9);
    let outward = samples(cloud(points.clone(), Some(normals.clone())));
    let inward = samples(cloud(points, Some(normals.iter().map(|n| -*n).collect())));
    assert_eq!(outward.normals, inward.normals);
    assert_eq!(inward.notes, ["all normals point inward and were turned"]);
    assert!(outward.notes.is_empty());
}

#[test]
fn given_normals_are_kept_and_missing_ones_estimated() {
    let (points, normals) = random_torus(4000, 1);
    let mut some = normals.clone();
    some.iter_mut().step_by(3).for_each(|n| *n = DVec3::ZERO);
    let made = samples(cloud(points.clone(), Some(some.clone())));
    assert_eq!(wrong(&made, torus_normal), 0);
    let kept = some.iter().filter(|n| **n != DVec3::ZERO && made.normals.contains(n)).count();
    assert_eq!(kept, some.iter().filter(|n| **n != DVec3::ZERO).count());
    let none = samples(cloud(points.clone(), Some(vec![DVec3::ZERO; 4000])));
    assert_eq!(none.normals, samples(cloud(points, None)).normals);
}

#[test]
fn strays_are_dropped_and_can_be_kept() {
    let mut points = fibonacci_sphere(5000);
    let mut stream = Stream::new(3);
    points.extend((0..40).map(|_| 0.7 * stream.unit().cbrt() * stream.direction()));
    points.extend((0..5).map(|k| DVec3::new(5.0, f64::from(k) * 0.01, 0.0)));
    let clean = samples(cloud(points.clone(), None));
    assert_eq!(clean.len(), 5000, "{:?}", clean.notes);
    let options = SampleOptions { keep_strays: true, ..SampleOptions::default() };
    assert_eq!(Samples::new(cloud(points, None), &options).unwrap().len(), 5045);
    // Random samplings and very few points have no strays.
    assert_eq!(samples(cloud(random_sphere(20_000, 8), None)).len(), 20_000);
    assert_eq!(samples(cloud(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], None)).len(), 4);
}

/// Random samples of the cube from -1 to 1, each kept by a chance that depends on where it is.
fn random_cube(n: usize, chance: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut stream = Stream::new(31);
    let mut points = Vec::new();
    while points.len() < n {
        let mut p = [0; 3].map(|_| 2.0 * stream.unit() - 1.0);
        p[(3.0 * stream.unit()) as usize] = if stream.unit() < 0.5 { -1.0 } else { 1.0 };
        if stream.unit() < chance(p.into()) {
            points.push(p.into());
        }
    }
    points
}

/// Edges and corners, densities that change by a hundred to one, smoothly and at once, and noise of 0.3 spacings.
#[test]
fn no_sample_of_a_surface_is_a_stray() {
    let mut stream = Stream::new(32);
    let mut uneven = |base: f64| {
        let mut points = Vec::new();
        while points.len() < 20_000 {
            let d = stream.direction();
            if stream.unit() < base.powf(d.z - 1.0) {
                points.push(d);
            }
        }
        points
    };
    let [ten, hundred] = [10.0, 100.0].map(&mut uneven);
    let mut stream = Stream::new(33);
    let shaken = |p: DVec3| p + 0.3 * 0.035 * DVec3::new(stream.normal(), stream.normal(), stream.normal());
    for (name, points) in [
        ("torus", random_torus(10_000, 7).0),
        ("cube", random_cube(10_000, |_| 1.0)),
        ("cube with a dense half", random_cube(10_000, |p| if 0.0 < p.x { 1.0 } else { 0.1 })),
        ("ball, 100 to 1", ten),
        ("ball, 10,000 to 1", hundred),
        ("noisy ball", random_sphere(10_000, 9).into_iter().map(shaken).collect()),
    ] {
        let count = points.len();
        let s = samples(cloud(points, None));
        println!("{name}: {} of {count}", s.len());
        // Beside samples ten times as dense a few of the thin ones on an edge look strewn.
        // The thinnest end of the last ball is one spacing, the radius, from the next sample.
        let allowed = match name {
            "cube with a dense half" => count / 1000,
            "ball, 10,000 to 1" => 1,
            // The tail of the noise.
            "noisy ball" => count / 200,
            _ => 0,
        };
        assert!(count <= s.len() + allowed, "{name}");
    }
}

/// A thin sheet through a dense ball: both stay, and no weight is so wide that it holds thousands of samples.
#[test]
fn a_thin_sheet_in_a_dense_ball_has_no_weights_that_hold_the_ball() {
    let mut points = fibonacci_sphere(10_000);
    let row = |i: i32| f64::from(i) * 0.15 - 1.425;
    points.extend((0..400).map(|k| DVec3::new(row(k % 20), row(k / 20), 0.1)));
    let s = samples(cloud(points, None));
    assert!(10_300 < s.len(), "{}", s.len());
    let held = |(p, h): (&DVec3, &f64)| s.points.iter().filter(|q| q.distance(*p) <= *h).count();
    let most = s.points.iter().zip(&s.widths).map(held).max().unwrap();
    println!("{} samples, the widest weight holds {most}", s.len());
    assert!(most <= 150, "{most}");
}

#[test]
fn options_set_the_widths() {
    let points = fibonacci_sphere(1000);
    let with = |smoothing, width| SampleOptions { smoothing, width, ..SampleOptions::default() };
    let make = |options: &SampleOptions| Samples::new(cloud(points.clone(), None), options);
    let plain = make(&with(1.0, None)).unwrap();
    let wide = make(&with(1.5, None)).unwrap();
    assert!(plain.widths.iter().zip(&wide.widths).all(|(a, b)| 1.5 * a == *b));
    assert!(make(&with(2.0, Some(0.25))).unwrap().widths.iter().all(|h| *h == 0.5));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(make(&with(bad, None)).unwrap_err().message, "`smoothing` must be a positive number");
        assert_eq!(make(&with(1.0, Some(bad))).unwrap_err().message, "`h` must be a positive number");
    }
}

#[test]
fn scaling_by_a_power_of_two_scales_the_samples() {
    let (points, normals) = random_torus(2000, 1);
    let plain = samples(cloud(points.clone(), None));
    for power in [-90, 20, 90] {
        let scale = 2f64.powi(power);
        let scaled = samples(cloud(points.iter().map(|p| *p * scale).collect(), None));
        assert_eq!(scaled.normals, plain.normals, "{power}");
        assert!(scaled.widths.iter().zip(&plain.widths).all(|(a, b)| *a == b * scale));
    }
    drop(normals);
}
