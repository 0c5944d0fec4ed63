//! `pss render --watch`: a picture made again when what it is made from changes.

mod cli_common;

use std::io::{BufRead, BufReader};
use std::process::{Child, ChildStderr, Command, Stdio};

use cli_common::{Folder, png_size};

/// The program, waiting for changes in a folder.
struct Watching {
    child: Child,
    lines: std::io::Lines<BufReader<ChildStderr>>,
}

impl Watching {
    fn start(folder: &Folder, args: &[&str]) -> Watching {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pss"));
        command.args(["render", "--watch"]).args(args).current_dir(folder.path());
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        Watching { child, lines }
    }

    /// All that is said until it waits; it hangs where it never does, which the test's runner ends.
    fn until_it_waits(&mut self) -> String {
        let mut said = String::new();
        for line in &mut self.lines {
            let line = line.unwrap();
            if line.starts_with("waiting for a change of ") {
                return said;
            }
            said += &format!("{line}\n");
        }
        panic!("it ended: {said}");
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn scene(width: u32) -> String {
    format!("import \"part.pss\"\ndraw part\nrender(size: [{width}, 8], samples: 1)\n")
}

#[test]
fn the_picture_follows_the_scene_and_what_it_imports() {
    let folder = Folder::new();
    folder.write("a.pss", scene(8)).write("part.pss", "let part = sphere(r: 1)\n");
    let mut watching = Watching::start(&folder, &["a.pss", "-o", "a.png"]);
    watching.until_it_waits();
    assert_eq!(png_size(&folder.read("a.png")), [8, 8]);
    let first = folder.read("a.png");
    // Written in place.
    folder.write("a.pss", scene(16));
    watching.until_it_waits();
    assert_eq!(png_size(&folder.read("a.png")), [16, 8]);
    // Put in its place, as editors save.
    folder.write("new", scene(8));
    std::fs::rename(folder.path().join("new"), folder.path().join("a.pss")).unwrap();
    watching.until_it_waits();
    assert_eq!(folder.read("a.png"), first);
    // What it imports.
    folder.write("part.pss", "let part = box(size: 1)\n");
    watching.until_it_waits();
    assert_ne!(folder.read("a.png"), first);
}

#[test]
fn a_mistake_is_shown_and_waited_for() {
    let folder = Folder::new();
    folder.write("a.pss", "draw points(\"later/scan.ply\")\nrender(size: [8, 8], samples: 1)\n");
    let mut watching = Watching::start(&folder, &["a.pss", "-o", "a.png"]);
    assert!(watching.until_it_waits().contains("E0601"));
    // A folder comes, then the file in it.
    std::fs::create_dir(folder.path().join("later")).unwrap();
    assert!(watching.until_it_waits().contains("E0601"));
    let cloud = cli_common::ply_with_normals(&cli_common::sphere(300, 1.0));
    folder.write("later/scan.ply", cloud);
    let said = watching.until_it_waits();
    assert!(!said.contains("error"), "{said}");
    let picture = folder.read("a.png");
    folder.write("a.pss", "draw sphere(\n");
    assert!(watching.until_it_waits().contains("E0102"));
    assert_eq!(folder.read("a.png"), picture, "a picture that was there is not lost");
}

#[test]
fn what_no_file_can_mend_ends_it() {
    let folder = Folder::new();
    folder.write("a.pss", "draw sphere(r: 1)\n");
    for (args, code) in [
        (&["render", "--watch", "-"][..], 2),
        (&["render", "--watch", "a.pss", "-o", "-"], 2),
        (&["render", "--watch", "a.pss", "-o", "gone/a.png"], 73),
        (&["render", "--watch", "a.pss", "-D", "n=1"], 2),
    ] {
        assert_eq!(folder.run(args).code, code, "{args:?}");
    }
}
