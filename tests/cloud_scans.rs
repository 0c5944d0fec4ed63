//! What real scans come to: strays, normals estimated against given, time of the winding number. Prints its
//! figures; `cargo test --release --test cloud_scans -- --nocapture`.

mod cloud_common;

use std::time::Instant;

use cloud_common::scan;
use glam::DVec3;
use pss::cloud::winding::Winding;
use pss::cloud::{Cloud, NormalSource, SampleOptions, Samples, ply};
use pss::num::hash::Stream;

fn read(name: &str) -> Option<Cloud> {
    scan(name).map(|path| ply::read_path(&path).unwrap())
}

fn samples(cloud: &Cloud, options: &SampleOptions) -> Samples {
    let start = Instant::now();
    let samples = Samples::new(cloud.clone(), options).unwrap();
    let time = start.elapsed().as_secs_f64();
    println!(
        "  {} of {} samples, opposed {:.5}, {time:.2} s; {:?}",
        samples.len(),
        cloud.points.len(),
        samples.opposed,
        samples.notes
    );
    samples
}

/// Share of the samples whose estimated normal is on the side of the given one.
fn same_side(cloud: &Cloud) -> f64 {
    let given = samples(cloud, &SampleOptions::default());
    let estimated =
        samples(cloud, &SampleOptions { normals: NormalSource::Estimate, ..SampleOptions::default() });
    assert_eq!(given.points, estimated.points);
    let same = given.normals.iter().zip(&estimated.normals).filter(|(a, b)| 0.0 < a.dot(**b)).count();
    same as f64 / given.len() as f64
}

fn winding_time(samples: &Samples) {
    let start = Instant::now();
    let winding = samples.winding(Winding::OPENING);
    let build = start.elapsed().as_secs_f64();
    let bounds = samples.bounds();
    let mut stream = Stream::new(2);
    let places: Vec<DVec3> = (0..20_000)
        .map(|_| bounds.min + bounds.size() * DVec3::new(stream.unit(), stream.unit(), stream.unit()))
        .collect();
    let near: Vec<DVec3> = (0..20_000)
        .map(|_| {
            let i = (stream.unit() * samples.len() as f64) as usize;
            samples.points[i] + stream.direction() * samples.widths[i]
        })
        .collect();
    for (what, places) in [("in the box", places), ("near the surface", near)] {
        let start = Instant::now();
        let inside = places.iter().filter(|x| 0.5 < winding.value(**x)).count();
        let value = start.elapsed().as_secs_f64() / places.len() as f64 * 1e6;
        let start = Instant::now();
        let slope: f64 = places.iter().map(|x| winding.value_and_gradient(*x).1.length()).sum();
        let both = start.elapsed().as_secs_f64() / places.len() as f64 * 1e6;
        println!(
            "  winding {what}: {value:.2} us, with gradient {both:.2} us ({inside} inside, {slope:.1e}), built in {build:.2} s"
        );
    }
}

#[test]
fn clean_scans_lose_nothing_and_their_normals_are_found_again() {
    for (name, least) in [("igea.ply", 0.9999), ("bunny.ply", 0.99), ("dragon.ply", 0.97)] {
        let Some(cloud) = read(name) else { return };
        println!("{name}");
        let same = same_side(&cloud);
        println!("  same side {same:.5}");
        winding_time(&samples(&cloud, &SampleOptions::default()));
        assert!(least < same, "{name}: {same}");
    }
}

/// `PSS_LONG=1` tries all of them.
#[test]
fn rough_scans_give_samples() {
    let all = ["cactus.ply", "lion.ply", "pump.ply", "bunny_raw.ply"];
    let long = std::env::var_os("PSS_LONG").is_some();
    for name in &all[..if long { all.len() } else { 1 }] {
        let Some(cloud) = read(name) else { return };
        println!("{name}");
        let samples = if cloud.normals.is_some() {
            println!("  same side {:.5}", same_side(&cloud));
            continue;
        } else {
            samples(&cloud, &SampleOptions::default())
        };
        assert!(samples.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-12));
    }
}
