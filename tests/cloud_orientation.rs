//! Normals of clouds that come without, against what is known.

mod cloud_common;
mod common;

use std::collections::HashMap;

use cloud_common::scan;
use common::Truth;
use glam::DVec3;
use pss::cloud::{Cloud, SampleOptions, Samples, ply};
use pss::num::hash::Stream;

/// Towards the scanner of each point of a raw scan: from the text beside it.
fn to_scanner(name: &str, count: usize) -> Vec<DVec3> {
    let text = std::fs::read_to_string(scan(&format!("{name}.scans.txt")).unwrap()).unwrap();
    let mut out = vec![DVec3::ZERO; count];
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| words[i].parse::<f64>().unwrap();
        let (first, length) = (number(1) as usize, number(2) as usize);
        out[first..first + length].fill(DVec3::new(number(3), number(4), number(5)));
    }
    out
}

/// What share of the samples seen well by their scanner face it: by our signs, and by the sign that most samples within
/// a few spacings agree on when each is asked its scanner.
struct Score {
    ours: f64,
    ideal: f64,
    judged: usize,
}

fn score(name: &str) -> Option<Score> {
    let cloud = ply::read_path(&scan(&format!("{name}.ply"))?).unwrap();
    let truth = to_scanner(name, cloud.points.len());
    let key = |p: &DVec3| p.to_array().map(f64::to_bits);
    let seen: HashMap<[u64; 3], DVec3> = cloud.points.iter().map(key).zip(truth).collect();
    let samples = Samples::new(cloud, &SampleOptions::default()).unwrap();
    let towards: Vec<Option<DVec3>> = samples.points.iter().map(|p| seen.get(&key(p)).copied()).collect();
    let tree = pss::cloud::neighbours::Neighbours::new(&samples.points);
    let mut near = Vec::new();
    let (mut ours, mut ideal, mut judged) = (0, 0, 0);
    for (i, n) in samples.normals.iter().enumerate() {
        let Some(cosine) = towards[i].map(|t| n.dot(t)).filter(|c| 0.3 < c.abs()) else { continue };
        judged += 1;
        ours += usize::from(0.0 < cosine);
        // An oracle that may choose one sign for each spot: every scan there votes with how well it saw it.
        tree.nearest(samples.points[i], 12, &mut near);
        let vote: f64 = near
            .iter()
            .filter_map(|x| {
                let j = x.index as usize;
                let m = samples.normals[j];
                let toward = towards[j]?.dot(m);
                Some(toward * m.dot(*n).signum() * m.dot(*n).abs())
            })
            .sum();
        ideal += usize::from(0.0 < vote * cosine);
    }
    let share = |k: usize| k as f64 / judged as f64;
    Some(Score { ours: share(ours), ideal: share(ideal), judged })
}

fn check(name: &str, least: f64) {
    let Some(Score { ours, ideal, judged }) = score(name) else { return };
    println!("{name}: {:.3} % right of {judged}, ideal signs {:.3} %", 100.0 * ours, 100.0 * ideal);
    assert!(least <= ours, "{name}: {ours}");
}

/// Samples of positions alone.
fn bare(points: Vec<DVec3>) -> Samples {
    Samples::new(Cloud { points, ..Cloud::default() }, &SampleOptions::default()).unwrap()
}

/// How many samples have a normal on the wrong side of the true one.
fn wrong(samples: &Samples, truth: impl Fn(DVec3) -> DVec3) -> usize {
    samples.points.iter().zip(&samples.normals).filter(|(p, n)| n.dot(truth(**p)) <= 0.0).count()
}

fn shaken(points: &[DVec3], by: f64) -> Vec<DVec3> {
    let mut stream = Stream::new(21);
    points.iter().map(|p| *p + by * DVec3::new(stream.normal(), stream.normal(), stream.normal())).collect()
}

#[test]
fn f20_normals_of_a_bare_sphere_torus_and_slab_all_point_outward_with_noise_or_without() {
    for truth in Truth::CLOSED {
        let (points, _) = truth.cloud(10_000);
        let spacing = (truth.area() / 10_000.0).sqrt();
        for noise in [0.0, 0.3] {
            let samples = bare(shaken(&points, noise * spacing));
            assert_eq!(wrong(&samples, |p| truth.gradient(p)), 0, "{truth:?}, noise {noise}");
        }
    }
}

#[test]
fn f20_the_inner_wall_of_a_hollow_ball_points_into_the_hollow() {
    let (points, _) = Truth::Sphere.cloud(8000);
    let inner = points.iter().step_by(4).map(|p| *p * 0.5);
    let samples = bare(points.iter().copied().chain(inner).collect());
    assert_eq!(wrong(&samples, |p| if p.length() < 0.75 { -p } else { p }), 0);
}

fn flipped(share: f64, all: bool) -> (Samples, usize) {
    let (points, normals) = Truth::Torus.cloud(10_000);
    let mut stream = Stream::new(5);
    let normals = normals.iter().map(|n| if all || stream.unit() < share { -*n } else { *n }).collect();
    let cloud = Cloud { points, normals: Some(normals), ..Cloud::default() };
    let samples = Samples::new(cloud, &SampleOptions::default()).unwrap();
    let wrong = wrong(&samples, |p| Truth::Torus.gradient(p));
    (samples, wrong)
}

#[test]
fn f18_few_flipped_normals_are_turned_back_too() {
    for share in [0.0002, 0.001, 0.003, 0.01] {
        let (_, wrong) = flipped(share, false);
        assert_eq!(wrong, 0, "{share}");
    }
}

/// 100 to 1 in density from pole to pole, with noise of 0.3 local spacings.
#[test]
fn f12_f20_normals_of_a_bare_uneven_noisy_ball_point_outward() {
    let points = uneven_ball(20_000);
    for noise in [0.0, 0.1, 0.3] {
        let mut stream = Stream::new(8);
        let mut shake = |p: &(DVec3, f64)| {
            p.0 + noise * p.1 * DVec3::new(stream.normal(), stream.normal(), stream.normal())
        };
        let samples = bare(points.iter().map(&mut shake).collect());
        println!("noise {noise}: {} of {} wrong", wrong(&samples, |p| p), samples.len());
        assert_eq!(wrong(&samples, |p| p), 0, "noise {noise}");
    }
}

/// Points of the unit sphere with their local spacings, a hundred times denser at one pole than at the other.
fn uneven_ball(n: usize) -> Vec<(DVec3, f64)> {
    let mut stream = Stream::new(77);
    // Density e^(k z) with e^(2 k) = 100: the inverse of its integral, in z.
    let k = 0.5 * 100f64.ln();
    let (low, high) = ((-k).exp(), k.exp());
    let one = |i: usize| {
        let u = (i as f64 + stream.unit()) / n as f64;
        let z = ((low + u * (high - low)).ln() / k).clamp(-1.0, 1.0);
        let (sin, cos) = (std::f64::consts::PI * (3.0 - 5f64.sqrt()) * i as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        // Points on area: n k e^(k z) / ((high - low) 2 pi).
        let density = n as f64 * k * (k * z).exp() / ((high - low) * std::f64::consts::TAU);
        (DVec3::new(r * cos, r * sin, z), density.sqrt().recip())
    };
    (0..n).map(one).collect()
}

#[test]
fn f27_noisy_normals_are_the_same_bits_for_any_number_of_threads() {
    let (points, _) = Truth::Torus.cloud(6000);
    let points = shaken(&points, 0.3 * (Truth::Torus.area() / 6000.0).sqrt());
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bare(points.clone()))
    };
    let one = with(1);
    assert!(one.notes.iter().any(|n| n.starts_with("noisy")), "{:?}", one.notes);
    assert!(one == with(2) && one == with(5));
}

#[test]
fn f18_normals_flipped_at_random_are_turned_back_and_it_is_said() {
    let (clean, _) = flipped(0.0, false);
    for share in [0.05, 0.1, 0.2] {
        let (samples, wrong) = flipped(share, false);
        assert_eq!(wrong, 0, "{share}");
        // The same bits as those of the clean cloud: so is the surface, on every ray.
        assert!(samples.points == clean.points && samples.normals == clean.normals, "{share}");
        assert!(samples.notes.iter().any(|n| n.contains("opposed")), "{:?}", samples.notes);
    }
}

#[test]
fn f19_a_cloud_inside_out_is_turned() {
    let (samples, wrong) = flipped(0.0, true);
    assert_eq!(wrong, 0);
    assert!(samples.notes.iter().any(|n| n.contains("inward")), "{:?}", samples.notes);
}

#[test]
fn p16_zero_nan_and_long_normals_are_mended_and_counted() {
    let (points, mut normals) = Truth::Sphere.cloud(2000);
    for i in (0..2000).step_by(10) {
        normals[i] = DVec3::ZERO;
        normals[i + 1] = DVec3::splat(f64::NAN);
        normals[i + 2] *= 1e30;
    }
    let row = |(p, n): (&DVec3, &DVec3)| format!("{} {} {} {} {} {}\n", p.x, p.y, p.z, n.x, n.y, n.z);
    let rows: String = points.iter().zip(&normals).map(row).collect();
    let columns = ["x", "y", "z", "nx", "ny", "nz"].map(|c| format!("property double {c}\n")).concat();
    let text = format!("ply\nformat ascii 1.0\nelement vertex 2000\n{columns}end_header\n{rows}");
    let samples = Samples::new(ply::read(text.as_bytes()).unwrap(), &SampleOptions::default()).unwrap();
    assert_eq!(samples.len(), 2000);
    assert_eq!(wrong(&samples, |p| p), 0);
    assert!(samples.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-12));
    assert!(samples.notes.iter().any(|n| n.starts_with("400 missing normals")), "{:?}", samples.notes);
}

#[test]
fn normals_of_a_raw_scan_face_its_scanners() {
    check("bunny_raw", 0.998);
}

#[test]
fn normals_of_noisy_misregistered_scans_face_their_scanners() {
    check("happy_raw", 0.985);
}
