//! Names, calls and types are looked up before anything is evaluated, and a broken item hides no mistake in another.

mod cli_common;

use cli_common::Folder;

/// The codes and places told of a scene, in their order.
fn told(text: &str) -> Vec<String> {
    let folder = Folder::new();
    folder.write("scene.pss", text);
    let ran = folder.run(&["check", "scene.pss", "--format", "json"]);
    let lines = ran.stderr.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    lines.map(|d| format!("{} {}:{}", d["code"].as_str().unwrap(), d["line"], d["column"])).collect()
}

#[test]
fn what_nobody_evaluates_is_looked_up_too() {
    for (text, wanted) in [
        ("fn f(x) = zz", "E0401 1:11"),
        ("fn f(x: colour) = x", "E0401 1:9"),
        ("fn f(x) = sphere(radius: x)", "E0403 1:18"),
        ("fn f(a, b = cc) = a + b", "E0401 1:13"),
        ("let f = fn(x) => qq", "E0401 1:18"),
        ("let a = if true { 1 } else { zz }", "E0401 1:30"),
        ("let a = false and zz", "E0401 1:19"),
        ("draw for i in [] { sphere(q: 3) }", "E0403 1:27"),
        ("fn f(x) = translate(x)", "E0401 1:11"),
        ("expect true or zz", "E0401 1:16"),
        ("fn f(k) = implicit(x**2 + q < k, inside: box(size: 1))", "E0401 1:27"),
        ("fn f(k) = min(k)", "E0404 1:11"),
    ] {
        assert_eq!(told(text), [wanted], "{text}");
    }
}

#[test]
fn what_is_right_is_not_complained_of() {
    for text in [
        "fn f(n) = if n < 1 { 0 } else { f(n - 1) + g(n) }\nfn g(m) = f(m - 1)",
        "fn f(a, b = a) = { let c = a + b  let d = c  c * d }",
        "fn f(k) = implicit(x**2 + y**2 + k * z < 1, inside: box(size: k))",
        "fn f(k) = half_space(x + k < 3)",
        "fn f(list) = for p in list, i in 0..p.x { [p, i, pi, tau] }",
        "fn f(m) = sphere(r: 1).with(m).move([1, 2, 3])",
        "let clay = matte(#fff)\nfn f(s = sphere(r: 1)) = s.with(clay)",
    ] {
        assert_eq!(told(text), Vec::<String>::new(), "{text}");
    }
}

#[test]
fn a_broken_item_hides_nothing_in_the_others_and_what_it_defines_is_known() {
    let text = "let a = (1\nlet b = zz\ndraw sphere(d: 3)\n";
    assert_eq!(told(text), ["E0102 1:9", "E0401 2:9", "E0403 3:13"]);
    // What `a` and `f` are worth is not known, but that there are such.
    let text =
        "let a = 1 +\nfn f(x) = (x\nmaterial m(color #fff)\nlet b = a + f(2)\ndraw sphere(r: b).with(m)\n";
    assert_eq!(told(text).iter().filter(|t| !t.starts_with("E0101") && !t.starts_with("E0102")).count(), 0);
    let text = "let s = a - b | c\nlet a = sphere(r: 1)\nlet b = qq\n";
    assert_eq!(told(text), ["E0201 1:15", "E0401 3:9"]);
    // What a file that cannot be followed defines is not known: nothing is said of names.
    assert_eq!(told("import \"a.pss\" us a\ndraw nowhere\n").len(), 1);
}

#[test]
fn one_item_is_told_of_once() {
    assert_eq!(told("draw sphere(r: zz) - box(size: yy)\n").len(), 1);
    assert_eq!(told("fn f(x) = zz\ndraw sphere(r: f(1))\n").len(), 1);
}

#[test]
fn a_file_imported_twice_is_one_mistake() {
    let folder = Folder::new();
    folder.write("lib.pss", "let a = 1\nlet b = 2\nlet c = 3\n");
    folder.write("scene.pss", "import \"lib.pss\"\nimport \"./lib.pss\"\ndraw sphere(r: a)\n");
    let ran = folder.run(&["check", "scene.pss"]);
    assert_eq!(ran.stderr.matches("error[").count(), 1, "{}", ran.stderr);
    assert!(ran.stderr.contains("error[E0402]") && ran.stderr.contains("scene.pss:2:8"), "{}", ran.stderr);
}

#[test]
fn what_an_imported_file_promises_is_checked() {
    let folder = Folder::new();
    folder.write("lib.pss", "let a = 1\nexpect a is 2\n");
    folder.write("scene.pss", "import \"lib.pss\"\ndraw sphere(r: a)\n");
    let ran = folder.run(&["check", "scene.pss"]);
    assert!(
        ran.code == 1 && ran.stderr.contains("E0801") && ran.stderr.contains("lib.pss:2"),
        "{}",
        ran.stderr
    );
    assert_eq!(folder.run(&["render", "scene.pss", "--size", "8x8"]).code, 0, "who renders does not ask");
}

#[test]
fn a_broken_cloud_that_is_not_drawn_is_told_by_check_and_not_read_by_render() {
    let folder = Folder::new();
    folder.write("broken.ply", "ply\nnothing\n");
    folder.write(
        "scene.pss",
        "let s = points(\"broken.ply\")\nlet t = points(\"nope.ply\")\ndraw sphere(r: 1)\n",
    );
    let ran = folder.run(&["check", "scene.pss"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    for told in ["warning[E0605]", "warning[E0601]", "2 warnings"] {
        assert!(ran.stderr.contains(told), "{told}: {}", ran.stderr);
    }
    let ran = folder.run(&["render", "scene.pss", "--size", "8x8"]);
    assert!(ran.code == 0 && !ran.stderr.contains("ply"), "{}", ran.stderr);
}

#[test]
fn names_of_a_million_letters_are_told_by_where_they_begin() {
    let folder = Folder::new();
    folder.write("scene.pss", format!("draw {}\n", "a".repeat(1_000_000)));
    let ran = folder.run(&["check", "scene.pss"]);
    assert!(ran.code == 65 && ran.stderr.len() < 20_000, "{}", ran.stderr.len());
}

#[test]
fn all_repairs_of_a_file_are_made_at_once() {
    let folder = Folder::new();
    folder.write("scene.pss", "let a = 30degrees\nlet b = 5 mm\ndraw sphere(radius: 3).rotate_z(45)\n");
    let ran = folder.run(&["check", "--fix", "scene.pss"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let mended = String::from_utf8(folder.read("scene.pss")).unwrap();
    assert_eq!(mended, "let a = 30deg\nlet b = 5mm\ndraw sphere(r: 3).rotate_z(45deg)\n");
}
