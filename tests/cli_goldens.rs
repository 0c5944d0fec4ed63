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
        ran.stderr.contains(" pixels of .exr, ") && ran.stderr.contains(" pixels of .png, "),
        "{}",
        ran.stderr
    );
    assert!(folder.files().contains(&"a.diff.png".to_owned()));
    assert_eq!(folder.run(&["test", ".", "-D", "r=1.01"]).code, 0);
    assert_eq!(folder.run(&["test", "."]).code, 1);
}

#[test]
fn what_breaks_its_word_or_gives_none_is_not_blessed() {
    let folder = Folder::new();
    folder.write("a.pss", SCENE);
    let ran = folder.run(&["test", ".", "--bless", "-D", "r=2"]);
    assert!(ran.code == 1 && ran.stderr.contains("E0801"), "{}", ran.stderr);
    for word in ["", "expect solid(sphere(r: 1))\n", "expect 1 is 1\n", "let v = volume(sphere(r: 1))\n"] {
        folder.write("a.pss", format!("draw sphere(r: 1)\n{word}"));
        let ran = folder.run(&["test", ".", "--bless"]);
        assert!(ran.code == 1 && ran.stderr.contains("error[E0807]"), "{word} {}", ran.stderr);
        assert!(ran.stderr.contains("expect volume(part)"), "{}", ran.stderr);
        assert_eq!(folder.files(), ["a.pss"]);
    }
}

#[test]
fn a_golden_holds_only_with_a_number_and_is_blessed_again_only_with_one() {
    let folder = blessed();
    let before = FILES.map(|file| folder.read(file));
    let without = SCENE.replace("expect volume(ball) ~= 4.18879 within 10%\n", "");
    folder.write("a.pss", &without);
    let ran = folder.run(&["test", "."]);
    assert!(ran.code == 1 && ran.stderr.contains("error[E0807]"), "{}", ran.stderr);
    for word in ["", "expect 1 is 1\n"] {
        folder.write("a.pss", without.clone() + word);
        let ran = folder.run(&["test", ".", "--bless", "-D", "r=1.01"]);
        assert!(ran.code == 1 && ran.stderr.contains("error[E0807]"), "{}", ran.stderr);
    }
    folder.write("a.pss", SCENE);
    assert!(FILES.map(|file| folder.read(file)) == before && folder.files() == FILES);
}

#[test]
fn a_golden_that_is_gone_is_an_error_as_long_as_another_is_here() {
    let folder = blessed();
    for keep in 1..7 {
        let kept = FILES.map(|file| (file, folder.read(file)));
        // By bits: which of the three stay.
        let gone = ["a.exr", "a.png", "a.spans"].into_iter().enumerate().filter(|(i, _)| keep >> i & 1 == 0);
        let gone: Vec<&str> = gone.map(|(_, file)| file).collect();
        gone.iter().for_each(|file| std::fs::remove_file(folder.path().join(file)).unwrap());
        let ran = folder.run(&["test", "."]);
        assert_eq!(ran.code, 1, "{gone:?} {}", ran.stderr);
        assert_eq!(ran.stderr.matches("error[E0808]").count(), gone.len(), "{}", ran.stderr);
        assert!(
            gone.iter().all(|file| ran.stderr.contains(&format!("`./{file}` is gone"))),
            "{}",
            ran.stderr
        );
        let ran = folder.run(&["test", ".", "--bless"]);
        assert!(ran.code == 0, "what did not change is made again: {}", ran.stderr);
        for (file, bytes) in kept {
            assert!(folder.read(file) == bytes, "{file}");
        }
    }
    for file in ["a.exr", "a.png", "a.spans"] {
        std::fs::remove_file(folder.path().join(file)).unwrap();
    }
    let ran = folder.run(&["test", "."]);
    assert!(ran.code == 0 && ran.stderr.contains("ok, no golden"), "nothing remembers it: {}", ran.stderr);
}

#[test]
fn other_scenes_of_the_folder_tell_that_goldens_are_gone() {
    let folder = blessed();
    folder.write("b.pss", SCENE.replace("draw plane(z: -1)\n", "")).write("words.pss", "let r = 3\n");
    let ran = folder.run(&["test", "."]);
    assert!(ran.code == 0 && ran.stderr.matches("warning[W0207]").count() == 1, "{}", ran.stderr);
    assert!(ran.stderr.contains("`./b.pss` has no golden"), "{}", ran.stderr);
}

#[test]
fn goldens_without_their_scene_are_an_error_that_names_them() {
    let folder = blessed();
    folder.write("b.pss", SCENE);
    assert_eq!(folder.run(&["render", "b.pss", "-o", "c.png", "-o", "c.exr", "--size", "8x8", "-q"]).code, 0);
    std::fs::remove_file(folder.path().join("a.pss")).unwrap();
    let run = || folder.run(&["test", ".", "--junit", "report.xml"]);
    let ran = run();
    assert!(ran.code == 1 && ran.stderr.contains("error[E0808]: `./a.pss` is gone"), "{}", ran.stderr);
    assert!(ran.stderr.contains("`./a.spans`, `./a.exr`, `./a.png`"), "{}", ran.stderr);
    assert!(!ran.stderr.contains("c.png") && !ran.stderr.contains("c.exr"), "renderings: {}", ran.stderr);
    assert!(String::from_utf8(folder.read("report.xml")).unwrap().contains("failures=\"1\""));
    // Each says by itself that it is one; a folder without any scene is no excuse.
    std::fs::remove_file(folder.path().join("b.pss")).unwrap();
    for file in ["a.spans", "a.exr"] {
        std::fs::remove_file(folder.path().join(file)).unwrap();
        let ran = run();
        assert!(ran.code == 1 && ran.stderr.contains("`./a.png`"), "{}", ran.stderr);
    }
}

#[test]
fn blessing_again_shows_what_changed_first_or_does_not_bless() {
    let folder = blessed();
    let spans = folder.read("a.spans");
    let pixels = ["a.exr", "a.png"].map(|file| (file, folder.read(file)));
    pixels.iter().for_each(|(file, _)| std::fs::remove_file(folder.path().join(file)).unwrap());
    let again = || folder.run(&["test", ".", "--bless", "-D", "r=1.01"]);
    let ran = again();
    assert!(ran.code == 1 && ran.stderr.contains("E0808"), "nothing could show it: {}", ran.stderr);
    assert!(folder.read("a.spans") == spans && folder.files() == ["a.pss", "a.spans"]);
    for (file, bytes) in &pixels {
        folder.write(file, bytes);
    }
    let ran = again();
    assert!(ran.code == 0 && ran.stderr.contains("`./a.diff.png` shows what changed"), "{}", ran.stderr);
    for first in ["./a.spans: ray ", "./a.exr: pixel ", "./a.png: pixel "] {
        assert!(ran.stderr.contains(first) && ran.stderr.contains(" was: "), "{first} {}", ran.stderr);
    }
}

#[test]
fn a_picture_of_another_size_is_shown_beside_the_old_one() {
    let folder = blessed();
    folder.write("a.pss", SCENE.replace("[160, 120]", "[120, 160]"));
    let ran = folder.run(&["test", ".", "--bless"]);
    assert!(ran.code == 0 && ran.stderr.contains("the size was: 72 x 54 pixels"), "{}", ran.stderr);
    let size = image::image_dimensions(folder.path().join("a.diff.png")).unwrap();
    assert_eq!(size, (3 * (3 * 72 + 2), 3 * (2 * 72 + 1)));
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
