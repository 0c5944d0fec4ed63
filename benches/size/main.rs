//! Cost against size: `cargo bench --bench size` renders scenes that grow in one way at a time (points of a scan, leaves, pixels,
//! samples a pixel, threads), each by a run of the program of its own, and writes `benches/size/results.csv` and the plots beside
//! it. Words after `--` choose series by name; `large` takes points to ten million, `quick` leaves the largest sizes out and
//! writes nothing.

mod plot;
mod scenes;
#[path = "../../tests/common/mod.rs"]
mod truth;

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// What a series is called, the unit of its sizes, its sizes, and the scene of each.
pub struct Series {
    /// Its name.
    pub name: &'static str,
    /// What its size counts.
    pub of: &'static str,
    /// Ascending.
    pub sizes: Vec<u64>,
    /// Writes the scene of a size, and says with what options to render it.
    pub scene: fn(u64) -> scenes::Job,
}

/// What one run cost.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// Size.
    pub size: u64,
    /// Processor seconds, all threads.
    pub cpu: f64,
    /// Seconds on the wall.
    pub wall: f64,
    /// Seconds on the wall until the first ray, and from there to the last.
    pub stages: [f64; 2],
    /// Most memory held, MB.
    pub peak: f64,
}

/// Runs of each size; the one of median processor time counts.
const RUNS: usize = 3;
/// Runs that take longer than this are done once.
const LONG: f64 = 10.0;

fn run(job: &scenes::Job, size: u64) -> Option<Cost> {
    let stats = scenes::folder().join("stats.json");
    let out = scenes::folder().join("out.png");
    let mut command = Command::new(env!("CARGO_BIN_EXE_pss"));
    command.arg("render").arg(&job.scene).arg("-o").arg(&out).args(&job.options);
    let done = command.arg("--quiet").arg("--stats-json").arg(&stats).status().ok()?;
    let text = std::fs::read_to_string(&stats).ok().filter(|_| done.success())?;
    let told: serde_json::Value = serde_json::from_str(&text).ok()?;
    let stage = |name: &str| told["stages"][name].as_f64().unwrap_or(0.0);
    Some(Cost {
        size,
        cpu: told["cpu_s"].as_f64()?,
        wall: told["wall_s"].as_f64()?,
        stages: [stage("parse") + stage("load") + stage("prepare"), stage("render")],
        peak: 1e-6 * told["peak_bytes"].as_f64()?,
    })
}

fn median(job: &scenes::Job, size: u64) -> Option<Cost> {
    let mut runs = vec![run(job, size)?];
    while runs.len() < RUNS && runs[0].cpu < LONG {
        runs.push(run(job, size)?);
    }
    runs.sort_by(|a, b| a.cpu.total_cmp(&b.cpu));
    Some(runs[runs.len() / 2])
}

/// By what power of the size something grew since the size before.
fn power(before: Option<&Cost>, now: &Cost, of: impl Fn(&Cost) -> f64) -> f64 {
    before.map_or(f64::NAN, |b| (of(now) / of(b)).ln() / (now.size as f64 / b.size as f64).ln())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let has = |word: &str| words.iter().any(|w| w == word);
    let chosen: Vec<&String> = words.iter().filter(|w| *w != "quick" && *w != "large").collect();
    let mut csv = String::from("series,size,cpu_s,wall_s,before_first_ray_s,rays_s,peak_mb\n");
    let mut all: Vec<(Series, Vec<Cost>)> = Vec::new();
    for mut series in scenes::all(has("large")) {
        if !chosen.is_empty() && !chosen.iter().any(|w| series.name.contains(w.as_str())) {
            continue;
        }
        if has("quick") {
            series.sizes.truncate(2);
        }
        eprintln!("{}: {}", series.name, series.of);
        let mut costs: Vec<Cost> = Vec::new();
        for &size in &series.sizes {
            let Some(cost) = median(&(series.scene)(size), size) else {
                return Err(format!("{} of size {size} could not be rendered", series.name).into());
            };
            let Cost { cpu, wall, stages: [before, rays], peak, .. } = cost;
            let grown = [|c: &Cost| c.cpu, |c: &Cost| c.peak].map(|of| power(costs.last(), &cost, of));
            eprintln!(
                "{size:>10} {cpu:>9.3} CPU s  {before:>9.3} + {rays:.3} s  {peak:>8.1} MB   powers {:.2} {:.2}",
                grown[0], grown[1]
            );
            writeln!(csv, "{},{size},{cpu:.3},{wall:.3},{before:.4},{rays:.4},{peak:.1}", series.name)?;
            costs.push(cost);
        }
        all.push((series, costs));
    }
    if !has("quick") {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/size");
        std::fs::write(folder.join("results.csv"), csv)?;
        plot::write(&all, &folder.join("growth"))?;
    }
    Ok(())
}
