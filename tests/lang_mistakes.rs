//! What people get wrong who come from OpenSCAD, POV-Ray or a programming language: each mistake gives one error, which names
//! the repair. The texts stand in `goldens/mistakes.txt`; `PSS_BLESS=1` writes it anew, to be read.

use pss::source::SourceMap;

/// A scene with one mistake, and a word of the repair that its message names.
const MISTAKES: &[(&str, &str)] = &[
    ("translate([1, 0, 0]) sphere(r: 1)", ".move([x, y, z])"),
    ("sphere(r: 1)", "draw sphere(...)"),
    ("draw sphere(1)", "sphere(r:"),
    ("draw sphere(d: 2)", "r: d / 2"),
    ("draw sphere(radius: 2)", "`r:`"),
    ("draw sphere(r=1)", "`r: value`"),
    ("draw sphere r: 1", "sphere(r: 1)"),
    ("draw sphere(r: -1)", "zero or more"),
    ("draw cube([1, 2, 3])", "box(size: [x, y, z])"),
    ("draw box([1, 2, 3])", "box([0, 0, 0], [1, 1, 1])"),
    ("draw box(size: [1, 2])", "[x, y, z]"),
    ("draw box(size: 1).translate([1, 0, 0])", ".move([x, y, z])"),
    ("draw box(size: 1).rotate([0, 0, 45])", "rotate_x(90deg)"),
    ("draw box(size: 1).rotate_z(45)", "45deg"),
    ("draw cylinder(r1: 1, r2: 0, h: 3)", "cone(r1: 2, r2: 1, h: 3)"),
    ("draw cylinder(r: 1)", "cylinder(r: 1, h: 2)"),
    ("draw cylinder(r: 1, height: 2)", "`h:`"),
    ("draw torus(3, 1)", "torus(major:, minor:"),
    ("draw sphere(r: 1);", "remove it"),
    ("$fn = 50", "surfaces are exact"),
    ("x = 3", "let x = ..."),
    ("let x = 3\nlet x = 4", "another name"),
    ("let x = y = 3", "`==`"),
    ("var a = 3", "let name = value"),
    ("difference() { box(size: 2) sphere(r: 1) }", "draw base - a"),
    ("draw difference() { box(size: 2) sphere(r: 1) }", "difference(base, [a, b])"),
    ("draw union(box(size: 2), sphere(r: 1))", "union([a, b])"),
    ("draw box(size: 2) + sphere(r: 1)", "a | b"),
    ("draw box(size: 2) * sphere(r: 1)", "a & b"),
    ("draw box(size: 2) - sphere(r: 1) | sphere(r: 2)", "(box(size: 2) - sphere(r: 1)) | sphere(r: 2)"),
    ("draw sphere(r: 1).union(box(size: 1))", "a | b"),
    ("module peg(h) { cylinder(r: 1, h: h) }", "fn name(a, b = 1) = value"),
    ("function f(x) = x * 2", "fn name("),
    ("let f = (x) => x * 2", "fn(x) => value"),
    ("for (i = [0:5]) sphere(r: i)", "draw for i in 0..5"),
    ("draw for i in [0:5] { sphere(r: i) }", "0..5"),
    ("let l = [0:0.5:3]", "for i in 0..5"),
    ("if (3 > 2) sphere(r: 1)", "draw if n > 3"),
    ("draw if true then sphere(r: 1) else box(size: 1)", "if a { b } else { c }"),
    ("draw box(size: 1).rotate_z(30°)", "`30deg`"),
    ("draw box(size: 1).rotate_z(30degrees)", "write `30deg`"),
    ("draw sphere(r: 2inches)", "write `2in`"),
    ("draw if 90deg > 10 { sphere(r: 1) } else { box(size: 1) }", "an angle has a unit"),
    ("let same = 1 == \"1\"", "without quotes"),
    ("light sun(direction: [0, 0, -1], angle: 2deg)", "softness: 2deg"),
    ("let a = true ? 1 : 2", "if a { b } else { c }"),
    ("let a = 1 == 1 && 2 == 2", "`and`"),
    ("let a = 1 == 1 || 2 == 2", "`or`"),
    ("let a = !true", "not condition"),
    ("while (true) { }", "for i in 0..n"),
    ("include <lib.scad>", "import \"file.pss\""),
    ("#include \"colors.inc\"", "import \"file.pss\""),
    ("#declare r = 3", "let name = value"),
    ("camera { location <0, 2, -3> }", "camera name(eye: [x, y, z]"),
    ("camera(position: [1, 2, 3])", "`eye:`"),
    ("camera(eye: [1, 2, 3], target: [0, 0, 0])", "look_at: [x, y, z]"),
    ("light_source(at: [1, 1, 1])", "light(at: [x, y, z])"),
    ("draw sphere(r: 1, pigment: #f00)", ".with(matte(#b8683c))"),
    ("draw sphere(r: 1).color(#f00)", ".with(matte(#b8683c))"),
    ("draw sphere(r: 1).with(#f00)", "matte(#b8683c)"),
    ("material red(color: \"red\")", "#b8683c"),
    ("let v = <1, 2, 3>", "[x, y, z]"),
    ("let a = 2^3", "a ** b"),
    ("let a = sqrt(2", "add the missing `)`"),
    ("let s = 'abc'", "double quotes"),
    ("let a = sin(45)", "45deg"),
    ("let a = .5", "0.5"),
    ("let a = 5.", "5.0"),
    ("let a = 5 mm", "5mm"),
    ("let n = len([1, 2, 3])", "count(list)"),
    ("let a = pow(2, 3)", "a ** b"),
    ("let a = PI", "`pi`"),
    ("echo(\"hi\")", "print value"),
    ("return 5", "fn f(x) = 2 * x"),
    ("draw linear_extrude(height: 3)", "extrude(outline, h: 10)"),
    ("draw rotate_extrude()", "revolve(outline)"),
    ("draw hull([sphere(r: 1), box(size: 1)])", "no hull"),
    ("draw mirror([1, 0, 0], box(size: 1))", "shape.mirror(...)"),
    ("render(width: 800, height: 600)", "size: [width, height]"),
    ("draw box(size: 1) - plane(z: 0)", "half_space(z < 0)"),
    ("draw spere(r: 1)", "`sphere`"),
    ("expect 1 < 2 < 3", "and"),
    ("let a = 1\nprint(a, 3)", "`[a, b]`"),
    ("let b = (1, 2)", "`[a, b]`"),
    ("fn g(n) = for i in 0..n { sphere(r: 1), box(size: 1) }", "`a | b`"),
    ("fn g(n) = for i in 0..n { sphere(r: 1) box(size: 1) }", "`a | b`"),
    ("let c = { let a = 3, let b = 4\n    a + b }", "remove it"),
    ("let c = [for i in 0..3, i]", "a loop is a list already"),
    ("let c = [for i in 0..3 i]", "a loop is a list already"),
    ("let c = for i in 0..3 i", "a loop is a list already"),
    ("#sphere(r: 1)", "@ghost"),
    ("%sphere(r: 1)", "@ghost"),
    ("*sphere(r: 1)", "@skip"),
    ("!sphere(r: 1)", "@only"),
    ("fn hole(x) { sphere(r: x) }", "fn f(x) = {"),
    ("draw hull() { sphere(r: 1) }", "no hull"),
    ("let a = if 3 > 2 { 1 }", "else { c }"),
    ("let v = [1, 2, 3]\nprint v.w", "`.x`"),
    ("import(\"x.pss\")", "import \"file.pss\""),
    ("draw sphere(r: 1).rotate([90, 0, 0])", "rotate_x(90deg)"),
    ("draw difference(sphere(r: 2), box(size: 1), box(size: 2))", "difference(a, [b, c])"),
    ("draw sphere(r: 2, $fn: 4)", "no `$fn`"),
    ("let a = 0..=3", "one more"),
    ("let a = for i in 0..30 step 10 { i }", "no steps"),
    ("material m(color: red)", "#ff0000"),
    ("draw text(\"abc\")", "no letters"),
    ("draw cylinder(r: 1, h: 2, center: true)", ".move([x, y, z])"),
    ("draw sphere(r: 5.)", "5.0"),
    ("let a = sin(pi / 2)", "(pi / 2) * 1rad"),
    ("draw box(size: 1).rotate_z(1.57)", "`1.57deg` or `1.57rad`"),
    ("let a = sqr(3)", "x ** 2"),
    ("let a = sign(-3)", "if x < 0"),
    ("let a = acosh(2)", "`exp` and `ln`"),
    ("for (i = [0:4]) draw sphere(r: i)", "draw for i in 0..5"),
    ("for (i = [0:4])\n    draw sphere(r: i)", "draw for i in 0..5"),
    ("expect 1 ~= 2 within 1% + 1%", "within 2%"),
    ("expect 10 ~= 11 within 10deg", "angle / 1deg"),
    ("expect 30deg ~= 31deg within 0.1", "0.1deg"),
    ("expect sphere(r: 1) ~= sphere(r: 1.001) within 1%", "volume(a) ~= volume(b)"),
    ("print { let a = 3 }", "a block ends with its value"),
    ("print if true { 1 } else { 2 } + 1", "parentheses around all of it"),
    ("let a = for i in 0..3 { i } + 1", "parentheses around all of it"),
    ("draw implicit(if x > 0 { x } else { y } <= 0, inside: box(size: 3))", "parentheses around all of it"),
    ("let a = sphere(r: 1) == 3", "a shape is compared with a shape"),
    ("let a = [1, 2] < [3, 4]", "vectors have no order"),
    ("draw box(10)", "box(size: 10)"),
    ("draw sphere(r: 1).with(red)", "matte(#ff0000)"),
    ("echo(\"hi\", 3)", "print value"),
    ("@ghost sphere(r: 1)", "@ghost draw shape"),
    ("let a = 1...5", "`1..5`"),
    ("let a = 90 * deg", "`90deg`"),
    ("let a = 5cm + 3deg", "goes with angles alone"),
    ("draw union() { sphere(r: 1); box(size: 1); }", "draw a | b"),
    ("draw hull() { sphere(r: 1); box(size: 1); }", "no hull"),
    ("draw rotate_extrude(angle=180) square(1);", "revolve(outline)"),
    ("draw cube([1, 2, 3], center=true);", "box(size: [x, y, z])"),
    ("draw #sphere(r: 1)", "@ghost draw shape"),
    ("draw %sphere(r: 1)", "@ghost draw shape"),
    ("draw sphere { <0, 0, 0>, 1 }", "`sphere(...)`"),
    ("let v = [1, 2, 3]\nprint v.length", "`length(value)`"),
    ("let v = [1, 2, 3]\nprint v.q", "`.x`"),
    ("print sphere(r: 1).volume()", "`volume(shape)`"),
    ("print sphere(r: 1).bounds", "`bounds(shape)`"),
    ("let a = max(1, 2, 3)", "max(a, max(b, c))"),
    ("draw sphere(r: 1).scale(2, 2, 2)", "[x, y, z]"),
    ("let light = 3", "take another name"),
    ("param camera = 3", "take another name"),
    ("fn render(x) = x", "take another name"),
    ("fn f(in) = 1", "take another name"),
    ("draw implicit(x^2 + y^2 + z^2 <= 1, inside: box(size: 3))", "x**2 + y**2"),
    (
        "draw implicit(fn(x, y, z) => x**2 + y**2 + z**2 <= 1, inside: box(size: 3))",
        "leave `fn(...) =>` away",
    ),
    ("draw for i = 0..3 { sphere(r: i) }", "for i in 0..3"),
    ("draw for i, j in 0..3 { sphere(r: 1) }", "for i in 0..3, j in 0..3"),
    ("param a = 5 in 1:10", "1..10"),
    ("material clay(kind: matte, color: #fff)", "\"matte\""),
    ("render(integrator: path)", "\"path\""),
    ("draw sphere(r: 1).mirror(z)", "\"z\""),
    ("draw torus(r1: 3, r2: 1)", "`major:`"),
    ("fn f(x): number = x * 2", "fn f(x: number) = value"),
    ("fn f x = x * 2", "fn f(x) = value"),
    ("fn f(x) => x * 2", "fn f(x) = value"),
    ("let a = {x: 1, y: 2}", "`v.x`"),
    ("draw if true { sphere(r: 1) } else if false { box(size: 1) }", "else { c }"),
    ("let a = if true { 1 } elif false { 2 } else { 3 }", "else if c { d }"),
    ("let a = 5 mod 3", "a % b"),
    ("let a = 1 <> 2", "a != b"),
    ("let x = 1 if true else 2", "if a { b } else { c }"),
    ("print sin 30", "sin(30deg)"),
    ("let my-name = 3", "`my_name`"),
    ("let a: number = 3", "let name = value"),
    ("let a := 3", "let name = value"),
    ("draw sphere(r: 1) sphere(r: 2)", "draw a | b"),
    ("print let(a = 3) a", "{ let a = 3"),
    ("print asin(2)", "from -1 to 1"),
    ("print ln(0)", "above zero"),
    ("draw box(size: 1) || sphere(r: 1)", "solids take `|`"),
];

/// Edits that would change what was meant: there is none.
const UNSURE: &[&str] = &[
    "draw box(size: 1).rotate_z(1.57)",
    "let a = sin(3)",
    "let a = sqr(3)",
    "let a = sign(-3deg)",
    "let a = for i in 0..=3 { i }",
    "expect 1 ~= 2 within 1% + 1%",
    "let wall1 = 1\nlet a = wall2",
    "let pi2 = 1\nlet a = i",
    "let wheels = 1\nlet a = wheel",
    "let x = y = 3",
    "let a = 1 / 2pi",
    "let c = { let a = 3; -a }",
    "let c = { 1, -2 }",
    "material m(color: green)",
    "echo(\"hi\", 3)",
    "draw box(size: 1) | sphere(r: 1) - sphere(r: 2)",
    "draw half_space(z = 3)",
    "draw box(size: 1, center: true)",
];

/// What is said of a scene, by reading or preparing it, and how many errors that were.
fn said(text: &str) -> (String, usize) {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    let catalog = pss::prepare::catalog();
    let reading = pss::lang::Reading {
        catalog: &catalog,
        defines: &[],
        files: None,
        geometry: None,
        expects: true,
        memory: pss::lang::MEMORY,
    };
    let read = pss::lang::read_with(&mut sources, file, &reading);
    let told = read.and_then(|read| pss::prepare::prepare(&read.scene, &Default::default()));
    let errors = told.err().unwrap_or_default();
    (pss::report::text(&errors, &sources, false), errors.iter().filter(|e| e.is_error()).count())
}

#[test]
fn each_typical_mistake_gives_one_error_that_names_the_repair() {
    assert!(50 <= MISTAKES.len());
    let (mut page, mut wrong) = (String::new(), Vec::new());
    for (scene, repair) in MISTAKES {
        let (text, errors) = said(scene);
        if errors != 1 || !text.contains(repair) {
            wrong.push(format!("{scene}\n{errors} errors, no word of {repair}\n{text}"));
        }
        page += &format!("{}\n\n", text.trim_end());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/goldens/mistakes.txt");
    if std::env::var_os("PSS_BLESS").is_some() {
        std::fs::write(path, &page).unwrap();
    }
    let known = std::fs::read_to_string(path).unwrap_or_default();
    assert!(known == page, "the texts changed: run with PSS_BLESS=1 and read the difference");
}

#[test]
fn what_may_be_meant_otherwise_has_no_edit() {
    for text in UNSURE {
        let mut sources = SourceMap::default();
        let file = sources.add("scene.pss", None, *text);
        let errors = pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]).expect_err(text);
        let (mended, count) = pss::diag::mended(text, file, &errors);
        assert!(count == 0, "{text}\n{mended}");
    }
}

/// An edit that a message brings is right: with it, and those of the errors that come to light, the mistake is gone or another
/// one is told that says what is missing; never the same once more.
#[test]
fn edits_mend_what_they_are_for() {
    let mut mended = 0;
    for (scene, _) in MISTAKES {
        let (mut text, mut seen) = ((*scene).to_owned(), Vec::new());
        loop {
            let mut sources = SourceMap::default();
            let file = sources.add("scene.pss", None, text.as_str());
            let Err(errors) = pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]) else {
                mended += usize::from(!seen.is_empty());
                break;
            };
            let told: Vec<String> = errors.iter().map(|e| e.message.clone()).collect();
            assert!(!seen.contains(&told), "{scene}\n{text}\n{told:?}");
            seen.push(told);
            let (next, count) = pss::diag::mended(&text, file, &errors);
            if count == 0 {
                break;
            }
            text = next;
        }
    }
    // Counted when the edits were written: fewer mean that one was lost.
    assert!(20 <= mended, "{mended}");
}

#[test]
fn edits_are_put_into_the_text() {
    let cases = [
        ("draw spere(r: 1)", "draw sphere(r: 1)"),
        ("draw sphere(radius=1);", "draw sphere(r:1)"),
        (
            "draw box(size: 2) - sphere(r: 1) | sphere(r: 2)",
            "draw (box(size: 2) - sphere(r: 1)) | sphere(r: 2)",
        ),
        ("draw box(size: 2) + sphere(r: 1)", "draw box(size: 2) | sphere(r: 1)"),
        ("draw box(size: .5).rotate_z(45)", "draw box(size: 0.5).rotate_z(45deg)"),
        ("let a = 5 mm\nlet b = 2 == 2 && 1 == 1", "let a = 5mm\nlet b = 2 == 2 and 1 == 1"),
        ("linear = 5\nsphere(r: 5.)", "let linear = 5\ndraw sphere(r: 5.0)"),
        ("let a = sin(pi / 2)", "let a = sin((pi / 2) * 1rad)"),
        ("draw sphere(r: 1).with(red)", "draw sphere(r: 1).with(matte(#ff0000))"),
        ("let a = 3;let b = 4;", "let a = 3 let b = 4"),
        ("echo(3)", "print(3)"),
        ("draw for i = 0..3 { sphere(r: i) }", "draw for i in 0..3 { sphere(r: i) }"),
        (
            "let a = if 1 <> 2 { 5 mod 3 } elif 1 == 2 { 1 } else { 2 }",
            "let a = if 1 != 2 { 5 % 3 } else if 1 == 2 { 1 } else { 2 }",
        ),
        ("draw box(size: 1) || sphere(r: 1)", "draw box(size: 1) || sphere(r: 1)"),
        ("union() { sphere(r: 1) }", "union() { sphere(r: 1) }"),
        (
            "draw implicit(x^2 + y^2 <= 1, inside: box(size: 3))",
            "draw implicit(x**2 + y**2 <= 1, inside: box(size: 3))",
        ),
    ];
    for (scene, want) in cases {
        let mut text = scene.to_owned();
        for _ in 0..9 {
            let mut sources = SourceMap::default();
            let file = sources.add("scene.pss", None, text.as_str());
            if let Err(errors) = pss::lang::read(&mut sources, file, &pss::prepare::catalog(), &[]) {
                text = pss::diag::mended(&text, file, &errors).0;
            }
        }
        assert_eq!(text, want);
    }
}
