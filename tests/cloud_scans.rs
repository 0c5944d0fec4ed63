//! What real scans come to: strays, normals estimated against given, time of the winding number. Prints its
//! figures; `cargo test --release --test cloud_scans -- --nocapture`.

mod cloud_common;

use std::collections::HashMap;
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

#[test]
fn rough_scans_give_samples() {
    for name in ["lion.ply", "pump.ply", "cactus.ply", "bunny_raw.ply"] {
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

/// `bunny_raw.scans.txt`: for each range scan its name, first point, count, and the direction to its sensor.
#[test]
fn estimated_normals_face_the_sensors() {
    for (name, least) in [("bunny_raw", 0.98), ("happy_raw", 0.85)] {
        let (Some(cloud), Some(list)) = (read(&format!("{name}.ply")), scan(&format!("{name}.scans.txt")))
        else {
            return;
        };
        let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
        let mut sensor_of = HashMap::new();
        for line in std::fs::read_to_string(list).unwrap().lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let numbers: Vec<f64> = words.iter().skip(1).filter_map(|w| w.parse().ok()).collect();
            let [first, count, x, y, z] = numbers[..] else { continue };
            for p in &cloud.points[first as usize..(first + count) as usize] {
                sensor_of.insert(bits(p), DVec3::new(x, y, z));
            }
        }
        println!("{name}");
        let samples = samples(&cloud, &SampleOptions::default());
        let pairs = samples
            .points
            .iter()
            .zip(&samples.normals)
            .filter_map(|(p, n)| Some((sensor_of.get(&bits(p))?, n)));
        let (all, right) =
            pairs.fold((0usize, 0), |(all, right), (d, n)| (all + 1, right + usize::from(0.0 < d.dot(*n))));
        let share = right as f64 / all as f64;
        println!("  {share:.5} of {all} samples face their sensor");
        assert!(least < share && samples.len() / 2 < all, "{name}: {share}");
    }
}
