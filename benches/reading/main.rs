//! What it takes to read scenes: `cargo bench --bench reading`. Each text is read, which is parsed, checked and evaluated to
//! shapes, in a process of its own, whose memory is told too.

#[path = "../csg/table.rs"]
mod table;

use std::fmt::Write;
use std::process::Command;
use std::time::Instant;

use pss::source::SourceMap;
use table::{Part, Row};

/// A scene, by a number, and a name for the table.
struct Scene {
    what: &'static str,
    text: fn() -> String,
    /// Seconds and megabytes asked for.
    asked: [&'static str; 2],
    /// Whether it is refused.
    refused: bool,
}

const SCENES: [Scene; 4] = [
    Scene {
        what: "100,000 objects written out, 6 MB",
        text: objects,
        asked: ["<= 2", "<= 256"],
        refused: false,
    },
    Scene { what: "100,000 objects of a loop", text: looped, asked: ["", ""], refused: false },
    Scene { what: "16 MiB of objects", text: huge, asked: ["<= 10", ""], refused: false },
    Scene { what: "100,000 parentheses, refused", text: nest, asked: ["at once", ""], refused: true },
];

/// Rounds of each, of which the middle one is told.
const ROUNDS: usize = 3;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    if let [_, word, which] = &args[..]
        && word == "child"
    {
        return child(&SCENES[which.parse::<usize>().unwrap_or(0)]);
    }
    let parts: [Part; 1] = [("reading", |rows| {
        for (which, scene) in SCENES.iter().enumerate() {
            measure(which, scene, rows);
        }
    })];
    table::run(&parts);
}

fn measure(which: usize, scene: &Scene, rows: &mut Vec<Row>) {
    let program = std::env::current_exe().expect("the name of this program");
    let mut runs: Vec<[f64; 2]> = (0..ROUNDS)
        .map(|_| {
            let output = Command::new(&program).args(["child", &which.to_string()]).output().expect("a run");
            let text = String::from_utf8(output.stdout).expect("numbers");
            let numbers: Vec<f64> = text.split_whitespace().filter_map(|n| n.parse().ok()).collect();
            [numbers[0], numbers[1]]
        })
        .collect();
    runs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let [seconds, bytes] = runs[ROUNDS / 2];
    rows.push(Row::new(format!("{}: time", scene.what), seconds, "s", scene.asked[0]));
    if !scene.refused {
        rows.push(Row::new(format!("{}: memory", scene.what), 1e-6 * bytes, "MB", scene.asked[1]));
    }
}

/// Reads a scene and prints processor seconds and the most memory that the process had, bytes, its text among it.
fn child(scene: &Scene) {
    let text = (scene.text)();
    let (start, before) = (Instant::now(), processor_seconds());
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    let read = pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]);
    let seconds =
        processor_seconds().zip(before).map_or(start.elapsed().as_secs_f64(), |(now, then)| now - then);
    assert_eq!(read.is_err(), scene.refused, "{}", scene.what);
    println!("{seconds} {}", peak_bytes());
}

/// Of this thread, which is the only one that reads; `None` where the system does not tell.
fn processor_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * text.split_whitespace().next()?.parse::<f64>().ok()?)
}

fn peak_bytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    1024.0 * kib.unwrap_or(f64::NAN)
}

fn rows_of(count: usize) -> String {
    let mut text = String::new();
    for i in 0..count {
        let place = |k: usize| (i * k % 99_991) as f64 * 1e-3;
        let (r, x, y, z) = (0.1 + place(7), place(1_009), place(2_003), place(4_001));
        let _ = writeln!(text, "draw sphere(r: {r:.4}, at: [{x:.3}, {y:.3}, {z:.3}]) // {i}");
    }
    text
}

fn objects() -> String {
    rows_of(100_000)
}

fn huge() -> String {
    let mut text = rows_of((16 << 20) / 50);
    text.truncate(text[..text.len().min(16 << 20)].rfind('\n').map_or(0, |end| end + 1));
    text
}

fn looped() -> String {
    "draw for i in 0..100000 { sphere(r: 1, at: [3 * i, rand(i), 0]) }\n".to_owned()
}

fn nest() -> String {
    format!("draw {}sphere(r: 1){}\n", "(".repeat(100_000), ")".repeat(100_000))
}
