//! Functions, choices, loops, blocks, lists and records: what `print` says of their values.

mod lang_support;

use lang_support::{complaints, scene};

/// What a scene prints, line by line.
fn prints(text: &str) -> String {
    scene(text).prints.join("\n")
}

/// The value of one expression.
fn value(expr: &str) -> String {
    prints(&format!("print {expr}"))
}

#[test]
fn a_function_is_a_name_for_an_expression_with_parameters() {
    assert_eq!(prints("fn twice(x) = 2 * x\nprint twice(4)\nprint twice(x: 5)"), "8\n10");
    assert_eq!(
        prints("fn f(a, b = a + 1, c = a * b) = [a, b, c]\nprint f(2)\nprint f(2, c: 0)"),
        "[2, 3, 6]\n[2, 3, 0]"
    );
    assert_eq!(prints("let add = fn(a) => fn(b) => a + b\nprint add(1)(2)"), "3");
    assert_eq!(prints("fn f(g, x) = g(g(x))\nprint f(fn(x) => x * x, 3)"), "81");
    assert_eq!(prints("fn f(x: length, a: angle) = x * sin(a)\nprint f(1cm, 90deg)"), "10");
    assert_eq!(prints("print f(3)\nfn f(n) = if n < 2 { 1 } else { n * f(n - 1) }"), "6");
    assert_eq!(
        prints(
            "fn even(n) = if n == 0 { true } else { odd(n - 1) }\nfn odd(n) = if n == 0 { false } else { even(n - 1) }\nprint even(900)"
        ),
        "true"
    );
}

#[test]
fn names_belong_to_where_they_are_written() {
    assert_eq!(prints("let a = 1\nfn f(b) = a + b\nprint { let a = 100  f(a) }"), "101");
    assert_eq!(prints("let x = 1\nlet y = { let x = x + 1  x * 10 }\nprint [x, y]"), "[1, 20]");
    assert_eq!(prints("fn f(x) = { let y = x * x  let z = y + 1  z }\nprint f(3)"), "10");
    assert_eq!(
        prints("let fs = for i in 0..3 { fn(x) => x + i }\nprint for f in fs { f(10) }"),
        "[10, 11, 12]"
    );
    assert!(complaints("print { let a = 1  a }\nprint a", &[]).contains("`a` is not known"));
    assert!(complaints("let b = { let a = c  let c = 1  a }", &[]).contains("`c` is not known"));
}

#[test]
fn choices_evaluate_one_side_only() {
    assert_eq!(value("if 1 < 2 { \"yes\" } else { 1 / 0 }"), "yes");
    assert_eq!(value("if false { 1 } else if true { 2 } else { 3 }"), "2");
    assert_eq!(value("true or 1 / 0 > 1"), "true");
    assert_eq!(value("false and [1, 2][7] == 1"), "false");
    assert_eq!(value("not (1 == 1 and 2 < 1)"), "true");
}

#[test]
fn loops_give_one_flat_list_the_last_name_fastest() {
    assert_eq!(value("for i in 0..3 { i * i }"), "[0, 1, 4]");
    assert_eq!(value("for i in 0..2, j in 5..7 { [i, j] }"), "[[0, 5], [0, 6], [1, 5], [1, 6]]");
    assert_eq!(value("for i in 0..4, j in 0..i { 10 * i + j }"), "[10, 20, 21, 30, 31, 32]");
    assert_eq!(value("for p in [[1, 2, 3], [4, 5, 6]] { p.x + p[2] }"), "[4, 10]");
    assert_eq!(value("for i in 3..3 { i }"), "[]");
    assert_eq!(value("for i in 0.5..3 { i }"), "[0.5, 1.5, 2.5]");
    assert_eq!(value("for a in 0deg..2deg { a }"), "[0deg, 1deg]");
}

#[test]
fn lists_ranges_and_vectors_have_elements() {
    assert_eq!(value("[count([1, 2, 3]), count(0..2.5), count([])]"), "[3, 3, 0]");
    assert_eq!(value("(2..9)[3]"), "5");
    assert_eq!(value("concat([1], 5..7)"), "[1, 5, 6]");
    assert_eq!(value("[sum([1, 2, 3.5]), sum(0..5), sum([])]"), "[6.5, 10, 0]");
    assert_eq!(value("sum([[1, 2], [3, 4]])"), "[4, 6]");
    assert_eq!(value("[1, 2, 3].y"), "2");
    assert_eq!(value("{ let v = [3, 4]  length(v) }"), "5");
    assert_eq!(value("[[1, 2], [3, 4]][1][0]"), "3");
}

#[test]
fn random_numbers_depend_on_their_arguments_alone() {
    let many =
        prints("for_print(1)\n".replace("for_print(1)", "print for i in 0..1000 { rand(7, i) }").as_str());
    let numbers: Vec<f64> = many.trim_matches(['[', ']']).split(", ").map(|x| x.parse().unwrap()).collect();
    assert!(numbers.iter().all(|x| (0.0..1.0).contains(x)));
    let mean = numbers.iter().sum::<f64>() / 1000.0;
    assert!((mean - 0.5).abs() < 0.04, "{mean}");
    let mut sorted = numbers.clone();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    assert_eq!(sorted.len(), 1000);
    assert_eq!(
        value("rand(7, 3) == rand(7, 3) and rand(7, 3) != rand(3, 7) and rand(0) == rand(-0)"),
        "true"
    );
}

#[test]
fn values_are_printed_as_they_are_written() {
    assert_eq!(value("\"a b\""), "a b");
    assert_eq!(value("[\"a\", 1.5, 2mm, 90deg, true, #f00]"), "[\"a\", 1.5, 2, 90deg, true, rgb(1, 0, 0)]");
    assert_eq!(value("[sphere(r: 1), fn(x) => x, 1..4]"), "[a shape, fn(x), 1..4]");
}

#[test]
fn shapes_are_made_by_functions_and_loops() {
    let made = scene(
        "fn peg(x) = sphere(r: 1, at: [x, 0, 0])\nlet row = union(for i in 0..5 { peg(3 * i) })\ndraw row",
    );
    let pss::scene::ShapeKind::Boolean { operands, .. } = &made.draws[0].shape.0.kind else { panic!() };
    assert_eq!(operands.len(), 5);
    let pss::scene::ShapeKind::Leaf { name, .. } = &operands[0].shape.0.kind else { panic!() };
    assert_eq!(name, "peg");
    assert_eq!(scene("draw for i in 0..4 { sphere(r: 1 + i) }").draws.len(), 4);
}

#[test]
fn a_formula_calls_the_functions_of_the_scene() {
    let text = |formula: &str| {
        format!("fn f(p, q = 1) = {{ let s = p * p  s + q }}\ndraw implicit({formula}, inside: box(size: 3))")
    };
    let formula = |text: String| format!("{:?}", scene(&text).draws[0].shape.0.kind);
    let steps = |text: &str| {
        let from = text.find("Formula").unwrap();
        text[from..].split("closed").next().unwrap().to_owned()
    };
    assert_eq!(steps(&formula(text("f(x) + y <= 3"))), steps(&formula(text("(x * x + 1) + y <= 3"))));
    assert_eq!(steps(&formula(text("f(z, q: x) <= 3"))), steps(&formula(text("(z * z + x) <= 3"))));
    assert_eq!(steps(&formula(text("(if 1 < 2 { x } else { y }) <= 3"))), steps(&formula(text("x <= 3"))));
}

/// A recursion or a loop without an end is told, with the calls that led there, and ends.
#[test]
fn what_has_no_end_is_told() {
    let told = complaints("fn f(n) = f(n + 1)\nlet a = f(0)", &[]);
    assert!(told.contains("E0706") && told.contains("in `f`, called at scene.pss:1:11"), "{told}");
    let told = complaints("let a = for i in 0..1000, j in 0..1000, k in 0..1000 { i }", &[]);
    assert!(told.contains("E0703") || told.contains("E0709"), "{told}");
    let told = complaints("fn f(n) = if n == 0 { 0 } else { f(n - 1) + f(n - 1) }\nlet a = f(60)", &[]);
    assert!(told.contains("E0709"), "{told}");
    let told = complaints("let a = b\nlet b = f(1)\nfn f(x) = a + x", &[]);
    assert!(told.contains("E0407"), "{told}");
}

#[test]
fn operators_act_on_vectors_part_by_part_and_with_a_number_on_each() {
    assert_eq!(value("[1, 2] ** 2"), "[1, 4]");
    assert_eq!(value("2 ** [1, 2]"), "[2, 4]");
    assert_eq!(value("[7, 8] % 3"), "[1, 2]");
    assert_eq!(value("[7, 8] % [3, 5]"), "[1, 3]");
    assert_eq!(value("1 / [1, 2]"), "[1, 0.5]");
    assert_eq!(value("[1, 2] ** [2, 3]"), "[1, 8]");
    assert_eq!(value("1 + [1, 2]"), "[2, 3]");
    assert_eq!(value("2 * [30deg, 60deg] - [0deg, 10deg]"), "[60deg, 110deg]");
    assert_eq!(value("-[30deg, 60deg]"), "[-30deg, -60deg]");
    assert_eq!(value("[30deg, 60deg] / 30deg"), "[1, 2]");
    assert_eq!(value("sin([0deg, 90deg])"), "[0, 1]");
    assert_eq!(value("asin([0, 1])"), "[0deg, 90deg]");
    assert_eq!(value("atan2([0, 1], 0)"), "[0deg, 90deg]");
    assert_eq!(value("mix([0, 2], [2, 4], 0.5)"), "[1, 3]");
    assert_eq!(value("max([1deg, 5deg], 3deg)"), "[3deg, 5deg]");
    assert_eq!(value("sum([30deg, 20deg])"), "50deg");
    assert!(complaints("let a = [1, 2] + [1, 2, 3]", &[]).contains("vectors of one size are wanted"));
    assert!(complaints("let a = 1 / [1, 0]", &[]).contains("E0504"));
    assert!(complaints("let a = sin([30, 60])", &[]).contains("`30deg`"));
}

#[test]
fn vectors_of_a_formula_follow_the_same_rules() {
    let formula = |text: &str| {
        format!(
            "{:?}",
            scene(&format!("draw implicit({text} <= 1, inside: box(size: 3))")).draws[0].shape.0.kind
        )
    };
    for [vector, parts] in [
        ["([x, y] ** 2)[0]", "x ** 2"],
        ["(1 / [x, y])[0]", "1 / x"],
        ["([x, y] % 3)[1]", "y % 3"],
        ["(2 + [x, y])[0]", "2 + x"],
    ] {
        let steps = |text: String| text.matches("Two(").count() + text.matches("Power(").count();
        assert!(steps(formula(parts)) <= steps(formula(vector)), "{vector}");
    }
}

#[test]
fn functions_of_numbers_are_values() {
    assert_eq!(prints("let f = sin\nprint f(90deg)"), "1");
    assert_eq!(prints("fn twice(f, x) = f(f(x))\nprint twice(sqrt, 16)"), "2");
    assert_eq!(value("for f in [floor, ceil] { f(1.5) }"), "[1, 2]");
    assert_eq!(value("max"), "max(a, b)");
    let text = |f: &str| format!("let f = {f}\ndraw implicit(f(x) <= 1, inside: box(size: 3))");
    let formula =
        |f: &str| format!("{:?}", scene(&text(f)).draws[0].shape.0.kind).replace(char::is_numeric, "");
    assert_eq!(formula("sqrt"), formula("fn(x) => sqrt(x)"));
    assert!(complaints("let f = sphere", &[]).contains("E0410"));
}

#[test]
fn lists_ranges_and_records_are_compared() {
    assert_eq!(value("[1, 2, 3, 4, 5] == [1, 2, 3, 4, 5]"), "true");
    assert_eq!(value("[1, 2, 3, 4, 5] == [1, 2, 3, 4]"), "false");
    assert_eq!(value("[] == []"), "true");
    assert_eq!(value("0..3 == 0..4"), "false");
    assert_eq!(value("[[\"a\", 1], [#fff, 3deg]] != [[\"a\", 1], [#fff, 4deg]]"), "true");
    assert!(complaints("let a = [1, \"b\"] == [1, 2]", &[]).contains("E0203"));
    // Lists of lists of one list: the steps are counted.
    let doubled: String = (0..40).map(|i| format!("let l{} = [l{i}, l{i}]\n", i + 1)).collect();
    assert!(complaints(&format!("let l0 = [1, 2]\n{doubled}print l40 == l40"), &[]).contains("E0709"));
}

/// After the steps or the memory are spent nothing is evaluated any more: one error tells it.
#[test]
fn what_follows_the_last_step_is_not_told_of() {
    let told = complaints(
        "fn f(n) = if n == 0 { 0 } else { f(n - 1) + f(n - 1) }\nprint f(60)\nexpect 1 is 2\nprint 3\nlet a = f(70)",
        &[],
    );
    assert_eq!(told.matches("E0709").count(), 1, "{told}");
}

#[test]
fn parameters_and_loops_that_hide_words_are_warned_of() {
    let told = complaints("fn f(box) = box\nlet a = for sin in 0..3 { sin }\nlet g = fn(pi) => pi", &[]);
    assert_eq!(told.matches("W0201").count(), 3, "{told}");
}

#[test]
fn channels_above_one_are_warned_of() {
    let told = complaints("let a = rgb(255, 0.5, 1)", &[]);
    assert!(told.matches("W0205").count() == 1 && told.contains("`#ff8000`"), "{told}");
}
