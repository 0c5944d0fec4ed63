//! STRESS.md S11 to S16, of what scenes compute and import; the others are in `stress_s_text`.

mod cli_common;

use cli_common::Folder;

/// Exit code and messages of a check.
fn check(folder: &Folder, scene: &str) -> (i32, String) {
    folder.write("scene.pss", scene);
    let ran = folder.run(&["check", "scene.pss"]);
    (ran.code, ran.stderr)
}

/// A scene that must be refused with a code at a place.
fn refused(scene: &str, code: &str, place: &str) {
    let (exit, told) = check(&Folder::new(), scene);
    assert!(exit == 65 && told.contains(code) && told.contains(place), "{scene}\n{exit} {told}");
}

#[test]
fn s11_loops_without_an_end_are_told_at_their_line() {
    refused("let a = 1\nlet b = for i in 0..1e12 { i }\n", "E0703", "scene.pss:2:9");
    refused("let b = for i in 0..1e4, j in 0..1e4 { sphere(r: 1) }\n", "E0703", "scene.pss:1:9");
    refused("let b = count(for i in 0..1e4 { count(for j in 0..1e4 { j }) })\n", "E0709", "scene.pss:1:");
}

#[test]
fn s12_recursions_are_told_at_depth_1000_with_the_calls_that_led_there() {
    refused("fn f(n) = f(n + 1)\nlet a = f(0)\n", "E0706", "in `f`, called at scene.pss:1:11");
    let mutual = "fn f(n) = g(n)\nfn g(n) = f(n)\nlet a = f(0)\n";
    refused(mutual, "E0706", "in `g`, called at scene.pss:1:11");
    refused("fn f(n) = [f(n), f(n)]\nlet a = f(0)\n", "E0706", "more calls");
}

#[test]
fn s13_copies_of_copies_are_shared_or_counted() {
    let tenfold = "fn ten(s) = union(for i in 0..10 { s.move([3 * i, 0, 0]) })\n";
    let laughs = format!("{tenfold}draw {}sphere(r: 1){}\n", "ten(".repeat(10), ")".repeat(10));
    let (code, told) = check(&Folder::new(), &laughs);
    assert!(code == 65 && told.contains("E07"), "{code} {told}");
    let names: String = (1..=10).map(|i| format!("let a{i} = ten(a{})\n", i - 1)).collect();
    let (code, told) =
        check(&Folder::new(), &format!("{tenfold}let a0 = sphere(r: 1)\n{names}print count([a10])\n"));
    assert_eq!((code, told.contains("error")), (0, false), "{told}");
}

#[test]
fn s14_imports_that_go_round_or_too_deep_are_told_and_diamonds_are_read_once() {
    let folder = Folder::new();
    folder.write("self.pss", "import \"self.pss\"\n");
    folder.write("a.pss", "import \"b.pss\"\n").write("b.pss", "import \"./a.pss\"\n");
    for name in ["self.pss", "a.pss"] {
        let ran = folder.run(&["check", name]);
        assert!(ran.code == 65 && ran.stderr.contains("E0609"), "{}", ran.stderr);
    }
    for i in 0..70 {
        folder.write(&format!("d{i}.pss"), format!("import \"d{}.pss\"\n", i + 1));
    }
    folder.write("d70.pss", "let end = 1\n");
    let ran = folder.run(&["check", "d0.pss"]);
    assert!(ran.code == 65 && ran.stderr.contains("deeper than 64"), "{}", ran.stderr);
    assert_eq!(folder.run(&["check", "d10.pss"]).code, 0);
    folder.write("base.pss", "print \"base\"\nlet r = 1\n");
    folder
        .write("left.pss", "import \"base.pss\" as b\nlet l = b.r\n")
        .write("right.pss", "import \"./base.pss\" as b\nlet r2 = b.r\n");
    let (code, told) = check(&folder, "import \"left.pss\"\nimport \"x/../right.pss\"\nprint l + r2\n");
    assert!(code == 66 || (code == 0 && told.matches("base\n").count() == 1), "{code} {told}");
    let (code, told) = check(&folder, "import \"left.pss\"\nimport \"right.pss\"\nprint l + r2\n");
    assert!(code == 0 && told.matches("base\n").count() == 1 && told.contains("2\n"), "{code} {told}");
}

#[test]
fn s15_imports_of_what_is_no_file_are_66_at_the_line_that_imports() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("dir.pss")).unwrap();
    for name in ["gone.pss", "dir.pss"] {
        let (code, told) = check(&folder, &format!("let a = 1\nimport \"{name}\"\n"));
        assert!(code == 66 && told.contains("scene.pss:2:8"), "{code} {told}");
    }
    #[cfg(target_os = "linux")]
    {
        let pipe = folder.path().join("pipe.pss");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        if made.is_ok_and(|status| status.success()) {
            assert_eq!(check(&folder, "import \"pipe.pss\"\n").0, 66);
        }
    }
}

#[test]
fn s16_imports_outside_of_the_scenes_folder_are_77() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path().join("in")).unwrap();
    folder.write("secret.pss", "print \"secret\"\n");
    for path in ["../secret.pss", "/etc/passwd", "x/../../secret.pss", "../nothing.pss"] {
        folder.write("in/scene.pss", format!("import \"{path}\"\n"));
        let ran = folder.run(&["check", "in/scene.pss"]);
        assert!(ran.code == 77 && !ran.stderr.contains("\nsecret"), "{path} {} {}", ran.code, ran.stderr);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path().join("secret.pss"), folder.path().join("in/link.pss"))
            .unwrap();
        folder.write("in/scene.pss", "import \"link.pss\"\n");
        assert_eq!(folder.run(&["check", "in/scene.pss"]).code, 77);
    }
    folder.write("in/scene.pss", "import \"../secret.pss\"\n");
    let ran = folder.run(&["check", "in/scene.pss", "--allow-read", "."]);
    assert!(ran.code == 0 && ran.stderr.contains("secret"), "{}", ran.stderr);
}
