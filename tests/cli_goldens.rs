//! `pss test` and the goldens beside scenes, at the command line.

mod cli_common;

use cli_common::Folder;

const SCENE: &str = "\
param r = 1
camera(eye: [0, -9, 0], look_at: [0, 0, 0], height: 3, kind: \"orthographic\")
render(size: [160, 120], samples: 4)
let ball = sphere(r: r)
draw ball - box([0, -2, 0], [2, 2, 2])
draw plane(z: -1)
expect volume(ball) ~= 4.18879 within 10%
";

const FILES: [&str; 4] = ["a.exr", "a.png", "a.pss", "a.spans"];

fn blessed() -> Folder {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    let ran = folder.run(&["test", ".", "--bless"]);
    assert!(
        ran.code == 0 && ran.stderr.contains("blessed: new .spans, new .exr, new .png"),
        "{}",
        ran.stderr
    );
    assert_eq!(folder.files(), FILES);
    folder
}

#[test]
fn a_scene_without_goldens_is_told_so_and_passes() {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    let ran = folder.run(&["test", "."]);
    assert!(ran.code == 0 && ran.stderr.contains("a.pss: ok, no golden"), "{}", ran.stderr);
    assert!(ran.stderr.contains("--bless"), "{}", ran.stderr);
    assert_eq!(folder.files(), ["a.pss"]);
}

#[test]
fn what_is_blessed_passes_and_is_small_and_the_same_for_any_threads() {
    let folder = blessed();
    let ran = folder.run(&["test", "."]);
    assert!(ran.code == 0 && ran.stderr.contains("a.pss: ok\n"), "{}", ran.stderr);
    let spans = String::from_utf8(folder.read("a.spans")).unwrap();
    assert!(spans.contains("\nrays 1000 seed 0 box -1 -1 -1 1 1 1\n"), "{spans}");
    assert!(spans.contains(":box~") && spans.contains("| ") && spans.contains(":plane"), "{spans}");
    let size = image::image_dimensions(folder.path().join("a.png")).unwrap();
    assert_eq!(size, (72, 54), "of the scene's shape, and no larger");
    let other = Folder::new();
    other.write("a.pss", SCENE);
    assert_eq!(other.run(&["test", ".", "--bless", "-t", "1"]).code, 0);
    for file in FILES {
        assert!(folder.read(file) == other.read(file), "{file}");
    }
    let ran = folder.run(&["test", ".", "--bless"]);
    assert!(ran.stderr.contains("a.pss: ok\n"), "nothing is written where nothing differs: {}", ran.stderr);
}

#[test]
fn what_differs_is_told_with_the_first_place_and_shown() {
    let folder = blessed();
    let ran = folder.run(&["test", ".", "-D", "r=1.01", "--junit", "report.xml"]);
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    for told in [
        "error[E0805]: `./a.spans` differs: ",
        " of 1000 rays",
        "ray ",
        "pss probe ./a.pss --ray \"",
        "error[E0805]: `./a.exr` differs: ",
        "of 3888 pixels",
        "depth ",
        "error[E0805]: `./a.png` differs: ",
        "a.diff.png` shows",
    ] {
        assert!(ran.stderr.contains(told), "{told}: {}", ran.stderr);
    }
    assert_eq!(ran.stderr.matches("error[E0805]").count(), 3, "{}", ran.stderr);
    let report = String::from_utf8(folder.read("report.xml")).unwrap();
    assert!(report.contains("failures=\"1\"") && report.matches("E0805").count() > 3, "{report}");
    // What was, where it differs, what is: of the layers, and of the picture.
    let size = image::image_dimensions(folder.path().join("a.diff.png")).unwrap();
    assert_eq!(size, (3 * (3 * 72 + 2), 3 * (2 * 54 + 1)));
    // The ray of the message is one that `probe` takes.
    let ray = ran.stderr.split("--ray \"").nth(1).unwrap().split('"').next().unwrap();
    assert_eq!(folder.run(&["probe", "a.pss", "--ray", ray]).code, 0);
    assert_eq!(folder.run(&["test", "."]).code, 0);
    assert!(!folder.files().contains(&"a.diff.png".to_owned()), "gone where all holds again");
}

#[test]
fn blessing_again_says_what_changed_and_keeps_the_picture_of_it() {
    let folder = blessed();
    let ran = folder.run(&["test", ".", "--bless", "-D", "r=1.01"]);
    assert!(ran.code == 0 && ran.stderr.contains(" rays of .spans, "), "{}", ran.stderr);
    assert!(
        ran.stderr.contains(" pixels of .exr, ") && ran.stderr.contains(" pixels of .png\n"),
        "{}",
        ran.stderr
    );
    assert!(folder.files().contains(&"a.diff.png".to_owned()));
    assert_eq!(folder.run(&["test", ".", "-D", "r=1.01"]).code, 0);
    assert_eq!(folder.run(&["test", "."]).code, 1);
}

#[test]
fn what_breaks_its_word_is_not_blessed_and_what_gives_none_is_warned_of() {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    let ran = folder.run(&["test", ".", "--bless", "-D", "r=2"]);
    assert!(ran.code == 1 && ran.stderr.contains("E0801"), "{}", ran.stderr);
    assert_eq!(folder.files(), ["a.pss"]);
    folder.write("a.pss", "draw sphere(r: 1)\nexpect solid(sphere(r: 1))\n");
    let ran = folder.run(&["test", ".", "--bless"]);
    assert!(ran.code == 0 && ran.stderr.contains("warning[W0206]"), "{}", ran.stderr);
    assert_eq!(folder.files(), FILES);
}

#[test]
fn files_that_are_no_goldens_are_left_alone() {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    assert_eq!(folder.run(&["render", "a.pss", "-o", "a.png", "-q"]).code, 0);
    let rendered = folder.read("a.png");
    assert!(folder.run(&["test", "."]).stderr.contains("ok, no golden"), "a rendering is none");
    let ran = folder.run(&["test", ".", "--bless"]);
    assert!(ran.code == 73 && ran.stderr.contains("E0806"), "{}", ran.stderr);
    assert!(folder.read("a.png") == rendered && folder.files() == ["a.png", "a.pss"]);
    // An input of the scene is not written over.
    let folder = Folder::new();
    folder.write("hills.pss", "draw heightfield(\"hills.exr\", size: 1)\n");
    folder.write("hills.spans", "pss spans 1\nrays 1 seed 0 box 0 0 0 1 1 1\n");
    let mut exr = std::io::Cursor::new(Vec::new());
    let mut film = pss::film::Film::new([2, 2], &[]).unwrap();
    film.rgba.fill([1.0; 4]);
    pss::output::write_exr(&film, &mut exr).unwrap();
    folder.write("hills.exr", exr.into_inner());
    let before = folder.read("hills.exr");
    let ran = folder.run(&["test", ".", "--bless"]);
    assert!(ran.code != 0 && folder.read("hills.exr") == before, "{}", ran.stderr);
}

#[test]
fn broken_goldens_are_told_with_their_line() {
    let folder = blessed();
    let spans = String::from_utf8(folder.read("a.spans")).unwrap();
    folder.write("a.spans", spans.replace("..", ".-."));
    let ran = folder.run(&["test", "."]);
    assert!(ran.code == 65 && ran.stderr.contains("E0806") && ran.stderr.contains("line "), "{}", ran.stderr);
    folder.write("a.spans", &spans);
    folder.write("a.png", "no picture");
    let ran = folder.run(&["test", "."]);
    assert!(ran.code == 65 && ran.stderr.contains("a.png` is no golden"), "{}", ran.stderr);
}

/// The number of rays stands in the head: who wants more writes so, and blesses.
#[test]
fn a_golden_keeps_its_own_number_of_rays() {
    let folder = blessed();
    let spans = String::from_utf8(folder.read("a.spans")).unwrap();
    folder.write("a.spans", spans.replace("rays 1000 seed 0", "rays 2000 seed 7"));
    assert_eq!(folder.run(&["test", "."]).code, 1);
    assert_eq!(folder.run(&["test", ".", "--bless"]).code, 0);
    assert!(String::from_utf8(folder.read("a.spans")).unwrap().contains("rays 2000 seed 7 box"));
    assert_eq!(folder.run(&["test", "."]).code, 0);
}
