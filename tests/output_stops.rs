//! Renders that are stopped, numbered as in the list of faults: what they keep, and that going on ends on the same bytes.
#![cfg(unix)]

mod cli_common;

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use cli_common::{Folder, png_size};

/// Some ten seconds of a core.
const SLOW: [&str; 4] = ["--size", "400x300", "--spp", "400"];

/// A scan, cut, in soft light: everything that is random or built lazily.
const SCAN: &str = "draw points(sphere(r: 1), samples: 1500, noise: 0.003, seed: 4) - box([0, -2, 0], [2, 0, 2])\n\
                    draw plane(z: -1)\nlight(direction: [-1, 2, -3], softness: 9deg)\nlight(color: #88aaff)\n\
                    render(size: [160, 130], samples: 6, aov: [\"depth\", \"normal\", \"albedo\"])\n";

/// A microsecond a ray.
const QUICK: &str = "param r = 1\ndraw sphere(r: r)\ndraw plane(z: -1)\nlight(direction: [-1, 2, -3], softness: 9deg)\n\
                     light(color: #88aaff)\nrender(size: [160, 130], samples: 6, aov: [\"depth\", \"normal\"])\n";

const STATE: &str = ".b.png.pss-state";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.pss", SCAN).write("slow.pss", SCAN).write("quick.pss", QUICK);
    folder
}

fn start(folder: &Folder, args: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pss"));
    command.args(args).current_dir(folder.path()).stdin(Stdio::null()).stdout(Stdio::piped());
    command.stderr(Stdio::piped()).spawn().unwrap()
}

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

fn wait_for(what: &str, mut there: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !there() {
        assert!(begin.elapsed() < Duration::from_secs(60), "no {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Waits until the render has its temporary file, and then a little.
fn let_render(folder: &Folder) {
    wait_for("temporary file", || folder.files().iter().any(|name| name.ends_with(".tmp")));
    std::thread::sleep(Duration::from_millis(300));
}

fn ended(child: Child) -> (i32, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn slow(out: &'static str) -> Vec<&'static str> {
    [&["render", "slow.pss", "-o", out, "-t", "2"], &SLOW[..]].concat()
}

#[test]
fn o5_an_interrupt_leaves_the_picture_writes_what_there_is_and_keeps_it() {
    for name in ["-INT", "-TERM"] {
        let folder = folder();
        folder.write("b.png", "old");
        let child = start(&folder, &slow("b.png"));
        let_render(&folder);
        let begin = Instant::now();
        signal(&child, name);
        let (code, stderr) = ended(child);
        assert_eq!(code, 75, "{stderr}");
        assert!(begin.elapsed() < Duration::from_secs(4), "{:?}", begin.elapsed());
        assert_eq!(folder.read("b.png"), b"old");
        assert_eq!(png_size(&folder.read("b.partial.png")), [400, 300]);
        assert_eq!(folder.files(), [STATE, "a.pss", "b.partial.png", "b.png", "quick.pss", "slow.pss"]);
        assert!(stderr.contains("--resume") && stderr.contains("E0611"), "{stderr}");
    }
}

#[test]
fn o5_what_there_was_of_a_stopped_picture_goes_when_the_whole_is_there() {
    for resume in [&["--resume"][..], &[]] {
        let folder = folder();
        folder.write("c.partial.png", "of somebody");
        let args = ["render", "quick.pss", "-q", "-t", "2", "-o", "b.png", "-o", "b.exr"];
        assert_eq!(folder.run(&[&args[..], &["--time-limit", "0"]].concat()).code, 75);
        assert!(folder.files().contains(&"b.partial.exr".to_owned()), "{:?}", folder.files());
        assert_eq!(folder.run(&[&args[..], resume].concat()).code, 0);
        let others = ["a.pss", "b.exr", "b.png", "c.partial.png", "quick.pss", "slow.pss"];
        assert_eq!(folder.files(), others);
        // No run was stopped that made it.
        assert_eq!(folder.run(&["render", "quick.pss", "-q", "-o", "c.png"]).code, 0);
        assert_eq!(folder.read("c.partial.png"), b"of somebody");
    }
}

#[test]
fn o5_a_second_interrupt_ends_at_once() {
    for (name, wanted) in [("-INT", 130), ("-TERM", 143)] {
        let folder = folder();
        folder.write("b.png", "old");
        let child = start(&folder, &slow("b.png"));
        let_render(&folder);
        signal(&child, name);
        std::thread::sleep(Duration::from_millis(50));
        // The first may have done all there is to do.
        let _ = Command::new("kill").args([name, &child.id().to_string()]).status();
        let (code, stderr) = ended(child);
        assert!(code == wanted || code == 75, "{code}: {stderr}");
        assert_eq!(folder.read("b.png"), b"old");
        assert!(!folder.files().iter().any(|name| name.ends_with(".tmp")), "{:?}", folder.files());
    }
}

#[test]
fn o5_without_a_file_nothing_is_kept() {
    let folder = folder();
    let child = start(&folder, &slow("-"));
    std::thread::sleep(Duration::from_millis(1500));
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());
    assert_eq!(folder.files(), ["a.pss", "quick.pss", "slow.pss"]);
}

#[test]
fn o6_a_state_of_another_picture_is_refused_and_what_differs_is_said() {
    let folder = folder();
    folder.write("cloud.ply", cli_common::ply_with_normals(&cli_common::sphere(400, 2.0)));
    folder.write(
        "c.pss",
        "param r = 1\ndraw points(\"cloud.ply\")\ndraw sphere(r: r)\nrender(size: [64, 40])\n",
    );
    let stop = ["render", "c.pss", "-o", "b.png", "--time-limit", "0"];
    assert_eq!(folder.run(&stop).code, 75);
    let kept = folder.read(STATE);
    let refused = |args: &[&str], word: &str| {
        let ran = folder.run(&[&["render", "c.pss", "-o", "b.png", "--resume"], args].concat());
        assert_eq!(ran.code, 65, "{word}: {}", ran.stderr);
        assert!(
            ran.stderr.contains("E0610") && ran.stderr.contains(&format!("not the same: {word}")),
            "{}",
            ran.stderr
        );
        assert_eq!(folder.read(STATE), kept, "it is left as it was");
    };
    refused(&["--spp", "3"], "the settings");
    refused(&["--seed", "3"], "the settings");
    refused(&["-D", "r=2"], "the scene");
    folder.write("cloud.ply", cli_common::ply_with_normals(&cli_common::sphere(401, 2.0)));
    refused(&[], "a file that the scene reads");
    folder.write("cloud.ply", cli_common::ply_with_normals(&cli_common::sphere(400, 2.0)));
    // As another program leaves it: its hash is the last of the head.
    let mut other = kept.clone();
    other[12 + 3 * 32] ^= 1;
    let sum = crc32fast::hash(&other[..160]);
    other[160..164].copy_from_slice(&sum.to_le_bytes());
    folder.write(STATE, &other);
    let ran = folder.run(&["render", "c.pss", "-o", "b.png", "--resume"]);
    assert!(ran.code == 65 && ran.stderr.contains("not the same: the program"), "{}", ran.stderr);
    folder.write(STATE, &kept);
    assert_eq!(folder.run(&["render", "c.pss", "-o", "b.png", "--resume", "-t", "1"]).code, 0);
    assert!(!folder.files().contains(&STATE.to_owned()));
}

/// A state with some tiles in it, and the picture that they belong to.
fn stopped(folder: &Folder) -> (Vec<u8>, Vec<u8>) {
    let whole = folder.run(&["render", "quick.pss", "-o", "whole.png", "--spp", "150", "-t", "2"]);
    assert_eq!(whole.code, 0, "{}", whole.stderr);
    let child = start(folder, &["render", "quick.pss", "-o", "b.png", "--spp", "150", "-t", "2"]);
    let_render(folder);
    signal(&child, "-INT");
    let (code, stderr) = ended(child);
    assert_eq!(code, 75, "{stderr}");
    let state = folder.read(STATE);
    assert!(20_000 < state.len(), "{} bytes are kept", state.len());
    (state, folder.read("whole.png"))
}

#[test]
fn o7_a_damaged_state_loses_the_damaged_tile_and_those_after_it() {
    let folder = folder();
    let (state, whole) = stopped(&folder);
    let n = state.len();
    let resume = ["render", "quick.pss", "-o", "b.png", "--spp", "150", "--resume"];
    let mut flipped = Vec::new();
    for at in [100, 190, n / 2] {
        let mut bytes = state.clone();
        bytes[at] ^= 0x10;
        flipped.push((format!("byte {at} changed"), bytes));
    }
    for cut in [0, 10, n / 2, n - 1] {
        flipped.push((format!("{cut} bytes"), state[..cut].to_vec()));
    }
    flipped.push(("more".to_owned(), [&state[..], b"nonsense"].concat()));
    for (what, bytes) in flipped {
        folder.write(STATE, &bytes);
        let ran = folder.run(&resume);
        assert_eq!(ran.code, 0, "{what}: {}", ran.stderr);
        assert_eq!(folder.read("b.png"), whole, "{what}");
        // A head that is cut to nothing is no state.
        let said =
            ["are damaged", "cannot be read", "nothing is kept"].iter().any(|w| ran.stderr.contains(w));
        assert!(said, "{what}: {}", ran.stderr);
    }
    folder.write(STATE, &state);
    let ran = folder.run(&resume);
    assert!(ran.code == 0 && ran.stderr.contains("are kept from an earlier run"), "{}", ran.stderr);
    assert!(!ran.stderr.contains("damaged"), "{}", ran.stderr);
    assert_eq!(folder.read("b.png"), whole);
}

#[test]
fn o8_two_runs_do_not_make_one_picture() {
    let folder = folder();
    let child = start(&folder, &slow("b.png"));
    wait_for("state", || folder.files().contains(&STATE.to_owned()));
    let second = folder.run(&["render", "a.pss", "-o", "b.png"]);
    assert!(second.code == 73 && second.stderr.contains("E0612"), "{}: {}", second.code, second.stderr);
    let other = folder.run(&["render", "a.pss", "-o", "c.png"]);
    assert_eq!(other.code, 0, "{}", other.stderr);
    signal(&child, "-INT");
    assert_eq!(ended(child).0, 75);
    let after = folder.run(&["render", "a.pss", "-o", "b.png"]);
    assert_eq!(after.code, 0, "{}", after.stderr);
    assert!(after.stderr.contains("W0204"), "an old state is not overwritten silently: {}", after.stderr);
    assert_eq!(folder.read("b.png"), folder.read("c.png"));
    assert!(!folder.files().contains(&STATE.to_owned()));
}

#[test]
fn o14_a_time_limit_and_resuming_end_on_the_same_bytes() {
    let folder = folder();
    let outputs = |name: &str| [format!("{name}.exr"), format!("{name}.png")];
    let run = |name: &str, more: &[&str]| {
        let [exr, png] = outputs(name);
        let args = ["render", "a.pss", "-o", &exr, "-o", &png, "--spp", "5", "--quiet"];
        folder.run(&[&args[..], more].concat())
    };
    assert_eq!(run("whole", &["-t", "5"]).code, 0);
    for (name, threads, limit) in [("x", "1", "1.2"), ("y", "2", "0.9"), ("z", "5", "0.9")] {
        let mut stops = 0;
        // Each run reads the scene anew, for which the limit is no less than it takes on a busy machine.
        let mut limit: f64 = limit.parse().unwrap();
        loop {
            let s = limit.to_string();
            let ran = run(name, &["-t", threads, "--resume", "--time-limit", &s]);
            if ran.code == 0 {
                break;
            }
            assert_eq!(ran.code, 75, "{}", ran.stderr);
            stops += 1;
            limit *= 1.1;
        }
        for (whole, made) in outputs("whole").iter().zip(outputs(name)) {
            assert_eq!(folder.read(whole), folder.read(&made), "{made} after {stops} stops");
        }
    }
    assert!(!folder.files().iter().any(|name| name.ends_with("state") || name.ends_with("tmp")));
}

#[test]
fn o4_what_a_killed_render_kept_is_gone_on_with() {
    let folder = folder();
    let scene = ["render", "quick.pss", "--size", "640x520", "--spp", "50", "-t", "2", "-o"];
    let child = start(&folder, &[&scene[..], &["b.png"]].concat());
    let mut child = child;
    let state = folder.path().join(STATE);
    let size = || std::fs::metadata(&state).map_or(0, |meta| meta.len());
    wait_for("tiles", || 100_000 < size());
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success());
    let resumed = folder.run(&[&scene[..], &["b.png", "--resume"]].concat());
    assert_eq!(resumed.code, 0, "{}", resumed.stderr);
    assert!(resumed.stderr.contains("tiles are kept from an earlier run"), "{}", resumed.stderr);
    assert_eq!(folder.run(&[&scene[..], &["c.png"]].concat()).code, 0);
    assert_eq!(folder.read("b.png"), folder.read("c.png"));
}
