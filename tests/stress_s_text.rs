//! STRESS.md S1 to S10 and S17 to S24: texts that are broken, huge, strange or hostile. S11 to S16 are in `stress_s`.

mod cli_common;

use cli_common::{Folder, png_size};
use pss::source::SourceMap;

/// Exit code and messages of a check.
fn check(scene: impl AsRef<[u8]>) -> (i32, String) {
    let folder = Folder::new();
    folder.write("scene.pss", scene);
    let ran = folder.run(&["check", "scene.pss"]);
    (ran.code, ran.stderr)
}

/// A scene that must be refused as wrong input, with all of these words said.
#[track_caller]
fn refused(scene: impl AsRef<[u8]>, words: &[&str]) {
    let (code, told) = check(&scene);
    let shown = String::from_utf8_lossy(scene.as_ref()).chars().take(200).collect::<String>();
    assert_eq!(code, 65, "{shown}\n{told}");
    for word in words {
        assert!(told.contains(word), "no `{word}` about\n{shown}\n{told}");
    }
}

/// What reading says of a text in this process, and whether it is refused.
fn read(text: &str) -> Result<Vec<pss::diag::Diagnostic>, Vec<pss::diag::Diagnostic>> {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]).map(|(_, warnings)| warnings)
}

#[test]
fn s1_a_bracket_that_is_not_closed_is_told_at_its_opening_and_at_the_gap() {
    let lines = "draw union([sphere(r: 1), box(size: 1)\nlet a = 1\n";
    refused(lines, &["E0102", "scene.pss:1:12", "opened here", "expected `]` before this"]);
    refused("fn f() = {\n    let a = 1\n    a\n", &["E0102", "scene.pss:1:10", "add the missing `}`"]);
    // Each item for itself: the second mistake is told too.
    refused("let a = (1\nlet b = [2\n", &["scene.pss:1:9", "scene.pss:2:9"]);
}

#[test]
fn s2_every_prefix_of_every_scene_is_a_scene_or_an_error() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let (mut scenes, mut read_through) = (0, 0);
    for folder in [root.clone(), root.join("cookbook"), root.join("cookbook/parts")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "pss") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            scenes += 1;
            for end in (0..text.len()).step_by(37).filter(|end| text.is_char_boundary(*end)) {
                read_through += usize::from(read(&text[..end]).is_ok());
            }
        }
    }
    assert!(30 <= scenes && 30 <= read_through, "{scenes} {read_through}");
}

#[test]
fn s3_unknown_words_name_the_nearest_and_doubles_both_places() {
    refused("drwa sphere(r: 1)\n", &["E0106", "did you mean `draw`?"]);
    refused("draw spheer(r: 1)\n", &["E0401", "did you mean `sphere`?"]);
    refused("let radius = 1\ndraw sphere(r: raduis)\n", &["scene.pss:2:16", "did you mean `radius`?"]);
    refused("let a = 1\nlet a = 2\n", &["E0402", "scene.pss:2:5", "the first time", "the second time"]);
}

#[test]
fn s4_wrong_numbers_types_and_units_of_arguments_show_the_signature_or_what_is_wanted() {
    refused("draw sphere(\"a\")\n", &["E0406", "`sphere(r:, at:)`"]);
    refused("draw sphere()\n", &["E0404", "`r` is missing", "`sphere(r:, at:)`"]);
    refused("draw sphere(r: \"a\")\n", &["E05", "wants"]);
    refused("draw sphere(r: 1, q: 2)\n", &["E0403", "`sphere(r:, at:)`"]);
    refused("draw box(size: [1, 2])\n", &["`size` wants 3 numbers, found 2"]);
    refused("draw sphere(r: 3deg)\n", &["wants", "angle"]);
    refused("draw box(size: 1).rotate_z(45)\n", &["E0502", "45deg"]);
}

#[test]
fn s5_numbers_that_are_none_are_refused_and_what_is_lost_is_told() {
    for number in ["1e999", "nan", "inf", "-inf", &format!("1{}", "0".repeat(400))] {
        refused(format!("let a = {number}\n"), &["scene.pss:1:"]);
    }
    refused("let a = 1e999\n", &["`1e999` is not finite"]);
    let (code, told) = check("let a = 1e-400\nlet b = [0, 0.0, 0e5, 1e-300]\n");
    assert_eq!((code, told.matches("W0202").count()), (0, 1), "{told}");
    assert!(told.contains("scene.pss:1:9") && told.contains("it is 0"), "{told}");
    // A million digits are one number.
    let long = format!("let a = 0.{}\n", "3".repeat(1_000_000));
    assert!(read(&long).is_ok());
}

#[test]
fn s6_numbers_beyond_1e18_are_refused_with_the_limit() {
    refused("draw sphere(r: 1e19)\n", &["scene.pss:1:16", "1e18"]);
    refused("let a = 1e18\ndraw sphere(r: 1, at: [a * 10, 0, 0])\n", &["scene.pss:2:", "1e18"]);
    assert_eq!(check("let a = 1e18\n").0, 0);
}

#[test]
fn s7_sizes_axes_and_maps_that_are_nothing_name_the_parameter() {
    refused("draw sphere(r: -1)\n", &["`r` is negative"]);
    refused("draw box(size: 1).rotate(axis: [0, 0, 0], by: 3deg)\n", &["E0510", "axis"]);
    refused("draw box(size: 1).scale([1, 0, 1])\n", &["E0510", "scale"]);
    // A size of zero is a shape that is nothing, as a parameter may come to it.
    for shape in ["sphere(r: 0)", "box(size: [0, 1, 1])", "box([0, 0, 0], [0, 1, 1])"] {
        let (code, told) = check(format!("draw {shape}\n"));
        assert!(code == 0 && told.contains("W0101"), "{shape}: {code} {told}");
    }
}

#[test]
fn s8_nests_up_to_the_limit_are_read_and_deeper_ones_are_refused() {
    let nest = |open: &str, inside: &str, close: &str, depth: usize| {
        format!("draw {}{inside}{}\n", open.repeat(depth), close.repeat(depth))
    };
    for (open, close) in [("(", ")"), ("union([", "])")] {
        let deep = nest(open, "sphere(r: 1)", close, 100_000);
        refused(&deep, &["E0701", "1000"]);
    }
    assert!(read(&nest("(", "sphere(r: 1)", ")", 990)).is_ok());
    // A call and its list are two.
    assert!(read(&nest("union([", "sphere(r: 1)", "])", 490)).is_ok());
}

/// Alternatives that begin alike make a parser that goes back try all of them at each level.
#[test]
fn s9_texts_that_begin_alike_again_and_again_take_steps_as_their_length() {
    let bombs = [
        format!("let a = {}1{}\n", "f(x: (".repeat(300), "))".repeat(300)),
        format!("let a = {}1{}\n", "fn(x) => (".repeat(300), ")".repeat(300)),
        format!("let a = {}1{}\n", "if (".repeat(300), ") { 1 } else { 2 }".repeat(300)),
        format!("let a = {}", "[(".repeat(400)),
    ];
    for bomb in bombs {
        // It would not come back within the time that the universe has.
        let _ = read(&bomb);
    }
}

#[test]
fn s10_sixteen_mebibytes_are_read_and_more_is_refused() {
    let line = "draw sphere(r: 1, at: [10, 20, 30])\n";
    let flat = line.repeat((2 << 20) / line.len());
    assert!(read(&flat).is_ok());
    let folder = Folder::new();
    folder.write("scene.pss", vec![b' '; (16 << 20) + 1]);
    let ran = folder.run(&["check", "scene.pss"]);
    assert!(ran.code == 65 && ran.stderr.contains("16 MiB"), "{} {}", ran.code, ran.stderr);
    // The time of the whole is measured by the benchmark of reading; here it is enough that it is read.
    if std::env::var_os("PSS_LONG").is_some() {
        assert!(read(&line.repeat((16 << 20) / line.len())).is_ok());
    }
}

#[test]
fn s17_marks_line_ends_and_tabs_leave_columns_right_and_nul_is_no_text() {
    refused("\u{feff}draw sphere(r: 1)\r\nlet x = y\r\n", &["scene.pss:2:9"]);
    refused("\tlet x = y\n", &["scene.pss:1:10"]);
    refused("let a = 1\rlet b = c", &["E0401", "`c`"]);
    refused("let a = \"a\0b\"\n", &["E0103", "scene.pss:1:11", "NUL"]);
    assert_eq!(check("\u{feff}draw sphere(r: 1)\r\n").0, 0);
}

#[test]
fn s18_what_is_no_utf_8_or_hides_is_told_and_strings_hold_anything() {
    refused(b"let a = \"\xff\xfe\"\n", &["not UTF-8", "byte 9"]);
    refused("let \u{430}bc = 1\n", &["E0103", "ASCII"]);
    refused("let a\u{200b}b = 1\n", &["\\u{200b}"]);
    // Neither an error nor `print` lets a text rule the terminal.
    let (code, told) = check("print \"crab 🦀 \u{202e}rtl \u{1b}[31m\"\n");
    assert!(code == 0 && told.contains("crab 🦀"), "{told}");
    assert!(!told.contains(['\u{202e}', '\u{1b}']) && told.contains("\\u{202e}"), "{told}");
    let (_, told) = check("let a = \"\u{1b}[31m\" + 1\n");
    assert!(!told.contains('\u{1b}'), "{told}");
}

#[test]
fn s19_a_scene_of_nothing_is_its_background_and_says_so() {
    for scene in ["", "// only a comment\n", "camera(eye: [0, 5, 0], look_at: [0, 0, 0])\n"] {
        let folder = Folder::new();
        folder.write("scene.pss", scene);
        let ran = folder.run(&["render", "scene.pss", "--size", "4x4"]);
        assert!(ran.code == 0 && ran.stderr.contains("W0203"), "{}", ran.stderr);
        assert_eq!(png_size(&folder.read("scene.png")), [4, 4]);
    }
    // Without a camera the whole is looked at; the language says so.
    assert_eq!(check("draw sphere(r: 1)\n").0, 0);
}

#[test]
fn s20_strings_and_comments_without_an_end_are_told_where_they_begin() {
    refused("draw sphere(r: 1)\nlet s = \"abc\ndraw sphere(r: 1)\n", &["E0104", "scene.pss:2:9"]);
    refused("let a = 1\n/* never\ndraw sphere(r: 1)\n", &["E0108", "scene.pss:2:1"]);
    refused("let a = 1 /* never\n", &["E0108", "scene.pss:1:11"]);
    refused("/* header\ndraw sphere(r: 1)\nexpect 1 is 2\n", &["E0108", "scene.pss:1:1"]);
    refused("// x\n/* header\n", &["E0108", "scene.pss:2:1"]);
}

#[test]
fn s21_cameras_and_pictures_that_are_none_are_refused_and_one_pixel_is_made() {
    let camera = |rest: &str| format!("draw sphere(r: 1)\ncamera(eye: [0, 0, 5], {rest})\n");
    for rest in [
        "look_at: [0, 0, 5]",
        "look_at: [0, 0, 0], up: [0, 0, 1]",
        "look_at: [0, 0, 0], fov: 0deg",
        "look_at: [0, 0, 0], fov: 180deg",
    ] {
        refused(camera(rest), &["scene.pss:2:"]);
    }
    for size in ["[0, 0]", "[4294967296, 1]", "[65536, 65536]", "[1.5, 2]", "[-1, 1]"] {
        refused(format!("draw sphere(r: 1)\nrender(size: {size})\n"), &["scene.pss:2:"]);
    }
    let folder = Folder::new();
    folder.write("scene.pss", "draw sphere(r: 1)\n");
    assert_eq!(folder.run(&["render", "scene.pss", "--size", "1x1"]).code, 0);
    assert_eq!(png_size(&folder.read("scene.png")), [1, 1]);
}

#[test]
fn s22_outputs_of_no_format_or_over_an_input_are_refused() {
    let folder = Folder::new();
    folder.write("scene.pss", "draw sphere(r: 1)\n").write("in.png", "draw sphere(r: 1)\n");
    assert_eq!(folder.run(&["render", "scene.pss", "-o", "a.jpg"]).code, 2);
    assert_eq!(folder.run(&["render", "scene.pss", "-o", "scene"]).code, 2);
    assert_eq!(folder.run(&["render", "in.png", "-o", "in.png"]).code, 73);
    assert_eq!(folder.read("in.png"), b"draw sphere(r: 1)\n");
}

#[test]
fn s23_a_broken_cloud_that_nothing_draws_is_not_opened() {
    let folder = Folder::new();
    folder
        .write("broken.ply", "no cloud")
        .write("a.pss", "let b = points(\"broken.ply\")\ndraw sphere(r: 1)\n");
    assert_eq!(folder.run(&["render", "a.pss", "--size", "4x4"]).code, 0);
    folder.write("b.pss", "draw points(\"broken.ply\")\n");
    let ran = folder.run(&["check", "b.pss"]);
    assert!(ran.code == 65 && ran.stderr.contains("broken.ply"), "{}", ran.stderr);
}

/// Random bytes; mutated scenes are in `lang_robust`, and the fuzz target goes on from there.
#[test]
fn s24_random_bytes_are_survived() {
    let mut state = 24u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    for _ in 0..20_000 {
        let bytes: Vec<u8> = (0..random() % 60).map(|_| (random() % 128) as u8).collect();
        let _ = read(std::str::from_utf8(&bytes).unwrap());
    }
}
