//! Scenes through the whole program, from text to file, one thread: beside another program in the same run, where it and
//! the scenes for it are there.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::clock::{command_seconds, median, runs_a_round};
use crate::table::Row;

const ROUNDS: usize = 7;
/// A quotient of two short times needs more.
const ROUNDS_OF_SHORT: usize = 31;

/// Where files are written.
pub fn folder() -> PathBuf {
    let folder = std::env::temp_dir().join("pss_csg_bench");
    std::fs::create_dir_all(&folder).expect("a folder for temporary files");
    folder
}

/// Writes a scene; its path.
pub fn scene(name: &str, text: &str) -> PathBuf {
    let path = folder().join(name);
    std::fs::write(&path, text).expect("a file in the folder for temporary files");
    path
}

/// The command that renders a scene.
pub fn pss(scene: &Path, more: &str) -> String {
    let (program, out) = (env!("CARGO_BIN_EXE_pss"), folder().join("out.png"));
    format!("{program} render {} -o {} -t 1 --quiet {more}", scene.display(), out.display())
}

/// Medians of commands run in turns, so that what disturbs one disturbs all; `None` for one that fails.
fn seconds<const N: usize>(rounds: usize, commands: [&str; N]) -> [Option<f64>; N] {
    let runs = commands.map(runs_a_round);
    let round = || std::array::from_fn(|i| command_seconds(commands[i], runs[i]?));
    let rounds: Vec<[Option<f64>; N]> = (0..rounds).map(|_| round()).collect();
    std::array::from_fn(|i| {
        rounds[0][i]?;
        Some(median(rounds.iter().filter_map(|round| round[i])))
    })
}

/// A plate with `side` times `side` holes, seen from above at a slant; its size does not depend on their number.
fn plate(side: u32) -> PathBuf {
    let pitch = 8.0 / f64::from(side);
    let mut holes = String::new();
    for i in 0..side * side {
        let at = |k: u32| pitch * (f64::from(k) + 0.5) - 4.0;
        let (x, y) = (at(i % side), at(i / side));
        write!(holes, "cylinder(r: {:?}, from: [{x:?}, {y:?}, -1], to: [{x:?}, {y:?}, 1]), ", 0.35 * pitch)
            .expect("a string takes everything");
    }
    let text = format!(
        "camera eye(eye: [3, -7, 8], look_at: [0, 0, 0], fov: 45deg)
         light(at: [4, -9, 9], falloff: false)
         render(samples: 1, integrator: \"direct\", tone: \"none\")
         draw difference(box([-4.2, -4.2, -0.2], [4.2, 4.2, 0.2]), [{holes}])"
    );
    scene(&format!("plate_{}.pss", side * side), &text)
}

/// A plate with 256 and with 1,024 holes at 300 x 300.
pub fn plates(rows: &mut Vec<Row>) {
    let [few, many] = [16, 32].map(|side| pss(&plate(side), "--size 300x300"));
    let [few, many] = seconds(ROUNDS_OF_SHORT, [&few, &many]).map(|s| s.unwrap_or(f64::NAN));
    rows.push(Row::new("plate with 1,024 holes, 300 x 300", many, "CPU s", "<= 0.15"));
    rows.push(Row::new("the same with 256 holes", few, "CPU s", ""));
    rows.push(Row::new("growth from 256 to 1,024", many / few, "times", "< 1.6"));
}

/// Peak memory of a render, MB.
fn peak(scene: &Path) -> f64 {
    let stats = folder().join("stats.json");
    let command = pss(scene, &format!("--size 64x64 --stats-json {}", stats.display()));
    let done = Command::new("sh").args(["-c", &command]).status().is_ok_and(|s| s.success());
    let text = std::fs::read_to_string(&stats).unwrap_or_default();
    let number = |text: &str| {
        let digits: String =
            text.chars().skip_while(|c| !c.is_ascii_digit()).take_while(char::is_ascii_digit).collect();
        digits.parse::<f64>().ok()
    };
    let bytes = text.split("\"peak_bytes\"").nth(1).and_then(number);
    bytes.filter(|_| done).map_or(f64::NAN, |bytes| 1e-6 * bytes)
}

/// A thousand instances of a union of a thousand balls beside one of it.
pub fn instances(rows: &mut Vec<Row>) {
    let mut balls = String::new();
    for i in 0..1000 {
        let at = |k: u32| 0.1 * f64::from(k);
        write!(balls, "sphere(r: 0.04, at: [{:?}, {:?}, {:?}]), ", at(i % 10), at(i / 10 % 10), at(i / 100))
            .expect("a string takes everything");
    }
    let one = |place: &str| {
        format!(
            "camera eye(eye: [30, -40, 30], look_at: [6, 6, 6], fov: 40deg)
             let grid = union([{balls}])
             draw {place}"
        )
    };
    let mut many = String::new();
    for i in 0..1000 {
        let at = |k: u32| 1.3 * f64::from(k);
        write!(many, "grid.move([{:?}, {:?}, {:?}]), ", at(i % 10), at(i / 10 % 10), at(i / 100))
            .expect("a string takes everything");
    }
    let scenes = [("one.pss", "grid".to_owned()), ("many.pss", format!("union([{many}])"))];
    let [one, many] = scenes.map(|(name, place)| peak(&scene(name, &one(&place))));
    rows.push(Row::new(
        "a thousand instances of a thousand balls, memory over one",
        many - one,
        "MB",
        "<= 40",
    ));
}

/// Whether a program can be run.
pub fn is_there(program: &str) -> bool {
    Command::new("sh")
        .args(["-c", &format!("command -v {program}")])
        .output()
        .is_ok_and(|o| o.status.success())
}

/// Where scenes are kept for this program and others.
pub fn kit() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/peers")
}

/// One of them as a scene of this program; `None` where it is not there.
pub fn peer_scene(name: &str) -> Option<PathBuf> {
    let (kit, out) = (kit(), folder().join(format!("{name}.pss")));
    let convert = format!("python3 {0}/json2pss.py {0}/json/{name}.json > {1}", kit.display(), out.display());
    let converted =
        kit.is_dir() && Command::new("sh").args(["-c", &convert]).status().is_ok_and(|s| s.success());
    converted.then_some(out)
}

/// The scenes that are kept for both programs, beside POV-Ray.
pub fn peers(rows: &mut Vec<Row>) {
    let kit = kit();
    if !kit.is_dir() || !is_there("povray") || !is_there("python3") {
        eprintln!("skipped: POV-Ray, Python or ../shared/peers is not there");
        return;
    }
    for (name, asked) in
        [("s1_die", ">= 1.5"), ("s7a_coincident", ">= 1.5"), ("s2_plate", ">= 15"), ("s3_menger", ">= 15")]
    {
        let Some(out) = peer_scene(name) else {
            eprintln!("skipped: {name} could not be converted");
            continue;
        };
        let other = format!("povray +I{}/pov/{name}.pov +W800 +H600 -D -A +WT1 -F -GA", kit.display());
        let [ours, theirs] =
            seconds(ROUNDS, [&pss(&out, "--size 800x600"), &other]).map(|s| s.unwrap_or(f64::NAN));
        rows.push(Row::new(format!("{name}, 800 x 600"), ours, "CPU s", ""));
        rows.push(Row::new(format!("{name}, POV-Ray 3.7 over this"), theirs / ours, "times", asked));
    }
}
