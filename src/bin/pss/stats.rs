//! What a render took, as a table and as JSON. The names in the JSON are a contract.

use std::fmt::Write;
use std::time::Duration;

use pss::prepare::ScanReport;
use pss::render::Work;
use pss::solid::Body;
use serde::Serialize;

use crate::system;

/// Time spent by stage.
#[derive(Debug)]
pub struct Stages {
    /// Reading and understanding the text.
    pub parsing: Duration,
    /// Reading the files it names.
    pub loading: Duration,
    /// Building what it says.
    pub preparing: Duration,
    /// Tracing.
    pub rendering: Duration,
    /// Writing files.
    pub writing: Duration,
}

/// What a render took.
#[derive(Serialize, Debug)]
pub struct Stats {
    wall_s: f64,
    /// `None` where the system does not tell.
    cpu_s: Option<f64>,
    threads: usize,
    /// `None` where the system does not tell.
    peak_bytes: Option<u64>,
    stages: StageSeconds,
    rays: RayCounts,
    pss: PssCounts,
    csg: CsgCounts,
    /// Files opened beside the scene.
    files: usize,
    /// Layers kept beside the colour: those that the scene asks for and a file holds.
    layers: usize,
    scans: Vec<ScanNotes>,
}

#[derive(Serialize, Debug)]
struct ScanNotes {
    name: String,
    samples: usize,
    /// Normals estimated: none where the file has them.
    normals_estimated: usize,
    /// What was dropped or mended, one sentence each.
    notes: Vec<String>,
    /// `None` where nothing depends on it: of a scan drawn by itself, or closed.
    solidity: Option<SolidityNotes>,
}

/// Whether a scan bounds a solid, and the numbers that say so.
#[derive(Serialize, Debug)]
struct SolidityNotes {
    body: Body,
    chords: u32,
    odd_chords: u32,
    open_holes: u32,
    /// Area of these holes over that of the surface.
    missing: f64,
}

#[derive(Serialize, Debug)]
struct StageSeconds {
    parse: f64,
    load: f64,
    prepare: f64,
    render: f64,
    write: f64,
}

#[derive(Serialize, Debug)]
struct RayCounts {
    camera: u64,
    shadow: u64,
    bounce: u64,
}

#[derive(Serialize, Debug)]
struct PssCounts {
    projections: u64,
    degree_falls: u64,
    patch_hits: u64,
    /// Made, where rays came.
    guides: u64,
    patches: u64,
    crossings: u64,
    certificate_failures: u64,
    parity_repairs: u64,
    caps: u64,
}

#[derive(Serialize, Debug)]
struct CsgCounts {
    leaf_queries: u64,
    leaves_skipped: u64,
    ties: u64,
    bad_leaves: u64,
}

impl ScanNotes {
    fn new(scan: &ScanReport) -> ScanNotes {
        let solidity = scan.solidity.map(|s| SolidityNotes {
            body: s.body(),
            chords: s.chords,
            odd_chords: s.odd,
            open_holes: s.open_holes,
            missing: s.missing,
        });
        ScanNotes {
            name: scan.name.clone(),
            samples: scan.samples,
            normals_estimated: scan.estimated,
            notes: scan.notes.clone(),
            solidity,
        }
    }
}

impl Stats {
    /// Gathers what is known; `wall` is the time since the start, `layers` how many were kept, `files` how many were opened beside the scene.
    pub fn new(
        wall: Duration,
        stages: &Stages,
        (work, layers): (&Work, usize),
        (files, scans): (usize, &[ScanReport]),
    ) -> Stats {
        let Work { rays, counts } = *work;
        Stats {
            wall_s: wall.as_secs_f64(),
            cpu_s: system::cpu_seconds(),
            threads: rayon::current_num_threads(),
            peak_bytes: system::peak_bytes(),
            stages: StageSeconds {
                parse: stages.parsing.as_secs_f64(),
                load: stages.loading.as_secs_f64(),
                prepare: stages.preparing.as_secs_f64(),
                render: stages.rendering.as_secs_f64(),
                write: stages.writing.as_secs_f64(),
            },
            rays: RayCounts { camera: rays.camera, shadow: rays.shadow, bounce: rays.bounce },
            pss: PssCounts {
                projections: counts.projections,
                degree_falls: counts.degree_falls,
                patch_hits: counts.patch_hits,
                guides: counts.guides,
                patches: counts.patches,
                crossings: counts.crossings,
                certificate_failures: counts.certificate_failures,
                parity_repairs: counts.parity_repairs,
                caps: counts.caps,
            },
            csg: CsgCounts {
                leaf_queries: counts.leaf_queries,
                leaves_skipped: counts.leaves_skipped,
                ties: counts.ties,
                bad_leaves: counts.bad_leaves,
            },
            files,
            layers,
            scans: scans.iter().map(ScanNotes::new).collect(),
        }
    }

    /// One JSON object, a line end behind it.
    pub fn json(&self) -> String {
        // A struct of numbers and names always has a JSON form.
        let json = serde_json::to_string_pretty(self).unwrap_or_else(|e| format!("\"{e}\""));
        json + "\n"
    }

    /// A table for people: a line for each number, and what was found about each scan.
    pub fn table(&self) -> String {
        let mut table = String::new();
        if let Ok(serde_json::Value::Object(all)) = serde_json::to_value(self) {
            for (name, value) in &all {
                rows(&mut table, name, value);
            }
        }
        for scan in &self.scans {
            // Writing to a string cannot fail.
            let _ = writeln!(table, "{:<26} {:>15} samples", scan.name, scan.samples);
            scan.notes.iter().for_each(|note| {
                let _ = writeln!(table, "  {note}");
            });
        }
        table
    }
}

fn rows(table: &mut String, name: &str, value: &serde_json::Value) {
    match value {
        serde_json::Value::Object(group) => {
            group.iter().for_each(|(part, value)| rows(table, &format!("{name}.{part}"), value));
        }
        serde_json::Value::Number(n) if n.is_f64() => {
            let seconds = n.as_f64().unwrap_or_default();
            // Writing to a string cannot fail.
            let _ = writeln!(table, "{name:<26} {seconds:>15.3}");
        }
        serde_json::Value::Null | serde_json::Value::Array(_) => {}
        value => {
            let _ = writeln!(table, "{name:<26} {:>15}", value.to_string());
        }
    }
}
