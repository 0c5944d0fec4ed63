//! Faults of outputs, numbered as in the list of faults: whatever happens, the old picture stays or the new one is whole.
//! Renders that are stopped are in `output_stops`, files that are larger than memory in `output_streams`.

mod cli_common;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use cli_common::{Folder, png_size};
use pss::output::read_exr;

const BALL: &str = "draw sphere(r: 1)\nlight(direction: [-1, 2, -3], softness: 5deg)\n\
                    render(size: [64, 48], samples: 2, aov: [\"depth\", \"normal\"])\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.pss", BALL);
    folder
}

fn shell(folder: &Path, script: &str) -> (i32, String) {
    let program = env!("CARGO_BIN_EXE_pss");
    let output = Command::new("sh").args(["-c", script, program]).current_dir(folder).output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn o1_an_output_that_cannot_be_made_is_refused_before_rendering() {
    let folder = folder();
    for out in ["nowhere/b.png", "a.pss/b.png"] {
        let ran = folder.run(&["render", "a.pss", "-o", out, "--size", "16000x16000"]);
        assert_eq!(ran.code, 73, "{out}: {}", ran.stderr);
    }
    assert_eq!(folder.files(), ["a.pss"]);
}

#[cfg(unix)]
#[test]
fn o1_a_file_that_is_read_only_is_replaced_as_a_whole() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    folder.write("b.png", "old");
    fs::set_permissions(folder.path().join("b.png"), fs::Permissions::from_mode(0o444)).unwrap();
    assert_eq!(folder.run(&["render", "a.pss", "-o", "b.png"]).code, 0);
    assert_eq!(png_size(&folder.read("b.png")), [64, 48]);
}

#[test]
fn o2_no_clobber_leaves_what_is_there() {
    let folder = folder();
    folder.write("b.png", "old");
    let ran = folder.run(&["render", "a.pss", "-o", "b.png", "--no-clobber", "--size", "16000x16000"]);
    assert_eq!(ran.code, 73, "{}", ran.stderr);
    assert!(ran.stderr.contains("--no-clobber"), "{}", ran.stderr);
    assert_eq!(folder.read("b.png"), b"old");
    assert_eq!(folder.run(&["render", "a.pss", "-o", "c.png", "--no-clobber"]).code, 0);
    assert_eq!(folder.files(), ["a.pss", "b.png", "c.png"]);
    let others = folder.run(&["render", "a.pss", "-o", "d.png", "--no-clobber", "--deps", "b.png"]);
    assert_eq!((others.code, folder.read("b.png")), (73, b"old".to_vec()));
}

/// A limit of the size of files fails as a full disk does.
#[cfg(target_os = "linux")]
#[test]
fn o3_a_file_that_grows_too_large_is_an_error_and_the_old_one_stays() {
    let folder = folder();
    // In blocks of 512 bytes, or of 1024 in other shells.
    for (blocks, out) in [(0, "b.png"), (0, "b.exr"), (1, "b.exr"), (3, "b.png"), (8, "b.exr")] {
        folder.write(out, "old");
        let script =
            format!("ulimit -f {blocks} && exec \"$0\" render a.pss -o {out} --size 400x300 --quiet");
        let (code, stderr) = shell(folder.path(), &script);
        assert_eq!(code, 74, "{blocks} {out}: {stderr}");
        assert_eq!(folder.read(out), b"old");
    }
    assert_eq!(folder.files(), ["a.pss", "b.exr", "b.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn o3_a_full_disk_is_an_error_and_the_old_picture_stays() {
    let folder = folder();
    let disk = folder.path().join("disk");
    fs::create_dir(&disk).unwrap();
    let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", "size=32k", "none"]).arg(&disk).output();
    if !mounted.is_ok_and(|m| m.status.success()) {
        eprintln!("skipped: no right to mount a small disk");
        return;
    }
    fs::write(disk.join("b.exr"), "old").unwrap();
    let ran = folder.run(&["render", "a.pss", "-o", "disk/b.exr", "--size", "300x200"]);
    let (old, names) = (fs::read(disk.join("b.exr")).unwrap(), fs::read_dir(&disk).unwrap().count());
    Command::new("umount").arg(&disk).status().unwrap();
    assert_eq!(ran.code, 74, "{}", ran.stderr);
    assert_eq!((old, names), (b"old".to_vec(), 1));
}

/// A number that looks random, of each round.
fn random(round: u64) -> f64 {
    pss::num::hash::unit(7, round)
}

#[cfg(unix)]
#[test]
fn o4_a_kill_at_any_instant_leaves_the_old_picture_or_the_whole_new_one() {
    let folder = folder();
    let args = ["render", "a.pss", "--quiet", "--size", "600x400", "-o", "b.png", "-o", "b.exr", "-t", "2"];
    let begin = std::time::Instant::now();
    assert_eq!(folder.run(&args).code, 0);
    let whole = begin.elapsed().as_secs_f64();
    let new = [folder.read("b.png"), folder.read("b.exr")];
    let kills = if std::env::var_os("PSS_LONG").is_some() { 200 } else { 30 };
    let mut cut = 0;
    for round in 0..kills {
        folder.write("b.png", "old").write("b.exr", "old");
        let mut child = Command::new(env!("CARGO_BIN_EXE_pss"))
            .args(args)
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_secs_f64(1.1 * whole * random(round)));
        child.kill().unwrap();
        cut += u32::from(!child.wait().unwrap().success());
        for (name, new) in ["b.png", "b.exr"].iter().zip(&new) {
            let found = folder.read(name);
            assert!(found == b"old" || found == *new, "{name} after kill {round}: {} bytes", found.len());
        }
    }
    assert!(kills / 4 < cut.into(), "{cut} of {kills} renders were killed before they ended");
    // A run after all of them is not in anybody's way, and clears up what they left.
    assert_eq!(folder.run(&args).code, 0);
    assert_eq!([folder.read("b.png"), folder.read("b.exr")], new);
    assert_eq!(folder.files(), ["a.pss", "b.exr", "b.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn o9_too_little_memory_is_said_with_what_is_wanted() {
    let folder = folder();
    folder.write("b.png", "old");
    // A row of tiles of a picture so wide takes 512 MB.
    let args = ["render", "a.pss", "-o", "b.png", "--size", "1000000x1000", "-t", "1"];
    for mib in [500, 400] {
        let ran = folder.run_within(mib << 20, &args);
        assert_eq!(ran.code, 71, "{mib} MiB: {}", ran.stderr);
        assert!(ran.stderr.contains("489 MiB are wanted"), "{}", ran.stderr);
    }
    for mib in [64, 128, 200] {
        let ran = folder.run_within(mib << 20, &["render", "a.pss", "-o", "b.png", "-t", "1"]);
        assert_eq!(ran.code, 71, "{mib} MiB: {}", ran.stderr);
        assert!(ran.stderr.contains("E0704") && ran.stderr.contains("256 MiB are wanted"), "{}", ran.stderr);
    }
    assert_eq!(folder.read("b.png"), b"old");
}

#[cfg(unix)]
#[test]
fn o11_a_render_completes_without_anybody_to_talk_to() {
    let folder = folder();
    let closed = [">&- 2>&-", "2>/dev/full", "2>&- <&-", "--progress json 2>/dev/full", "--stats 2>&-"];
    for (i, closed) in closed.into_iter().enumerate() {
        let script = format!("exec \"$0\" render a.pss -o b{i}.png {closed}");
        assert_eq!(shell(folder.path(), &script).0, 0, "{closed}");
        assert_eq!(folder.read(&format!("b{i}.png")), folder.read("b0.png"), "{closed}");
    }
    // The reader of messages goes away while the render is under way.
    let script = "\"$0\" render a.pss -o c.png --progress json --size 400x300 2>&1 | head -c 1 >/dev/null";
    assert_eq!(shell(folder.path(), script).0, 0);
    assert_eq!(png_size(&folder.read("c.png")), [400, 300]);
}

#[cfg(unix)]
#[test]
fn o12_devices_and_pipes_are_never_renamed_over() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    assert!(Command::new("mkfifo").arg(path("pipe.png")).status().unwrap().success());
    symlink("/dev/null", path("null.png")).unwrap();
    for out in ["pipe.png", "null.png"] {
        let ran = folder.run(&["render", "a.pss", "-o", out]);
        assert_eq!(ran.code, 73, "{out}: {}", ran.stderr);
    }
    assert!(fs::metadata(path("pipe.png")).unwrap().file_type().is_fifo());
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    // A link is followed: what it leads to is replaced, in its own folder.
    fs::create_dir(path("sub")).unwrap();
    folder.write("sub/real.png", "old");
    symlink("sub/real.png", path("link.png")).unwrap();
    assert_eq!(folder.run(&["render", "a.pss", "-o", "link.png"]).code, 0);
    assert!(fs::symlink_metadata(path("link.png")).unwrap().is_symlink());
    assert_eq!(png_size(&folder.read("sub/real.png")), [64, 48]);
    assert_eq!(fs::read_dir(path("sub")).unwrap().count(), 1, "nothing is left beside it");
    // So is one that leads nowhere yet, also over others; in a circle there is no file.
    symlink("sub/new.png", path("dangling.png")).unwrap();
    symlink("dangling.png", path("over.png")).unwrap();
    assert_eq!(folder.run(&["render", "a.pss", "-o", "over.png"]).code, 0);
    assert!(["dangling.png", "over.png"].iter().all(|n| fs::symlink_metadata(path(n)).unwrap().is_symlink()));
    assert_eq!(png_size(&folder.read("sub/new.png")), [64, 48]);
    symlink("other.png", path("circle.png")).unwrap();
    symlink("circle.png", path("other.png")).unwrap();
    let ran = folder.run(&["render", "a.pss", "-o", "circle.png"]);
    assert!(ran.code == 73 && ran.stderr.contains("in a circle"), "{} {}", ran.code, ran.stderr);
    assert!(fs::symlink_metadata(path("circle.png")).unwrap().is_symlink());
    // Standard output takes a pipe.
    let (code, _) = shell(folder.path(), "\"$0\" render a.pss -o - | cat > piped.png");
    assert_eq!((code, folder.read("piped.png")), (0, folder.read("sub/real.png")));
}

#[test]
fn o13_a_picture_that_no_format_holds_is_refused_at_once() {
    let folder = folder();
    for size in ["65536x65536", "4294967295x4294967295", "4294967295x1"] {
        let begin = std::time::Instant::now();
        let ran = folder.run(&["render", "a.pss", "-o", "b.exr", "--size", size]);
        assert_eq!(ran.code, 65, "{size}: {}", ran.stderr);
        assert!(begin.elapsed() < Duration::from_secs(5));
    }
    assert_eq!(folder.files(), ["a.pss"]);
}

#[test]
fn an_exr_says_what_it_was_made_of_and_nothing_of_how() {
    let folder = folder();
    fs::create_dir(folder.path().join("elsewhere")).unwrap();
    folder.write("elsewhere/other.pss", BALL).write("c.pss", format!("{BALL}// Said otherwise.\n"));
    for (scene, out, threads) in
        [("a.pss", "a.exr", "1"), ("elsewhere/other.pss", "b.exr", "5"), ("c.pss", "c.exr", "2")]
    {
        assert_eq!(folder.run(&["render", scene, "-o", out, "-t", threads]).code, 0);
    }
    let bytes = folder.read("a.exr");
    assert_eq!(bytes, folder.read("b.exr"), "neither names nor threads count");
    assert_ne!(bytes, folder.read("c.exr"), "the text of the scene does");
    let film = |name: &str| read_exr(&folder.path().join(name)).unwrap();
    assert_eq!(film("a.exr"), film("c.exr"));
    let says = |word: &str| bytes.windows(word.len()).any(|w| w == word.as_bytes());
    for word in [
        "pss.scene",
        "pss.settings",
        "size 64x48, samples 2, filter box, integrator ",
        ", bounces 16, exposure 0, tone agx, seed 0",
        "software",
        concat!("pss ", env!("CARGO_PKG_VERSION")),
    ] {
        assert!(says(word), "{word}");
    }
}
