//! Clouds damaged at random: case P20 of the list of faults of input. By itself, since it measures the memory of its process.

mod cloud_common;

use std::fmt::Write as _;

use cloud_common::fibonacci_sphere;
use pss::cloud::ply;
use pss::num::hash::Stream;

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

/// The same sixty points as text and in both byte orders.
fn small_files() -> Vec<Vec<u8>> {
    let rows: Vec<[f32; 3]> = fibonacci_sphere(60).iter().map(|p| p.as_vec3().to_array()).collect();
    let head = |format: &str| format!("ply\nformat {format} 1.0\nelement vertex 60\n{XYZ}end_header\n");
    let mut text = head("ascii");
    rows.iter().for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").unwrap());
    let bytes = |format, to: fn(f32) -> [u8; 4]| {
        let body = rows.iter().flatten().flat_map(|x| to(*x));
        head(format).into_bytes().into_iter().chain(body).collect()
    };
    let little = bytes("binary_little_endian", f32::to_le_bytes);
    vec![text.into_bytes(), little, bytes("binary_big_endian", f32::to_be_bytes)]
}

/// Flips, overwrites, cuts out and repeats a few pieces.
fn damage(bytes: &mut Vec<u8>, stream: &mut Stream) {
    let mut draw = |n: usize| (stream.unit() * n as f64) as usize;
    for _ in 0..=draw(4) {
        if bytes.is_empty() {
            break;
        }
        let at = draw(bytes.len());
        match draw(4) {
            0 => bytes[at] = draw(256) as u8,
            1 => bytes[at] ^= 1 << draw(8),
            2 => drop(bytes.splice(at..(at + draw(40)).min(bytes.len()), std::iter::empty())),
            _ => {
                let from = draw(bytes.len());
                let piece = bytes[from..(from + draw(40)).min(bytes.len())].to_vec();
                bytes.splice(at..at, piece);
            }
        }
    }
}

/// The most memory this process has had, bytes; where the system tells.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(1024 * line.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}

#[test]
fn p20_a_hundred_thousand_mutations_never_panic_nor_take_more_than_4_times_the_file_and_64_mib() {
    let mut stream = Stream::new(11);
    let files = small_files();
    let largest = files.iter().map(Vec::len).max().unwrap() as u64;
    let mut read = 0;
    for k in 0..100_000 {
        let mut bytes = files[k % files.len()].clone();
        damage(&mut bytes, &mut stream);
        let cloud = ply::read(&bytes).unwrap_or_default();
        assert!(cloud.points.iter().all(|p| p.is_finite()) && cloud.points.len() < 1000);
        read += usize::from(!cloud.points.is_empty());
    }
    println!("{read} of 100000 could be read; peak memory {:?}", peak());
    assert!(peak().is_none_or(|bytes| bytes <= 4 * largest + (64 << 20)));
}
