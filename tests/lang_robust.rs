//! Nothing that is written makes the language fall over: every text is a scene or an error.

mod lang_support;

use lang_support::{catalog, complaints, read_with, scene};
use pss::diag::Diagnostic;
use pss::lang::Reading;
use pss::source::SourceMap;

const LONG: &str = r##"/* all of it */ units(cm)
param bore: length = 4mm in 0.1..8 "radius" param mode = "a\n\"b" in ["a", "a\n\"b"]
material clay(kind: "matte", color: #b8683c, roughness: 0.5)
fn f(x: number = 3, y) = x ** -y * 2
let list = [1, 2.5e-3, -3,][1] // comment
let c = { let a = 1 a + 2 } let d = if 1 < 2 and not 3 >= 4 { 1 } else if true { 2 } else { 3 }
let e = for i in 0..3, j in 0..i { [i, j] } let g = fn (x) => x % 2
import "other.pss" as other
print 3 expect volume(a) ~= 6.43 within 0.5% expect inside(s, [0, 0, 0]) is false
let cut = (points("a.ply") - box([0, 0, 0], b: [1, 1, 1])) | !half_space(x + 2*y <= 3) | union([])
@ghost @only draw cut.rotate_x(90deg, about: [0, 0, 1]).fit([0, 0, 0], height: 1in)
camera main(eye: [1, 2, 3], fov: 0.1turn) light(direction: [1, 0, 0], color: rgb(1, 0, 0))
render(size: [800, 600], aov: ["depth"], integrator: "ao")
"##;

/// Reads a text and prints what is to be said about it, both ways.
fn survive(text: &str) {
    let (outcome, sources) = read_with(text, &[("bore", "3"), ("mode", text)]);
    let all = match outcome {
        Ok((_, warnings)) => warnings,
        Err(errors) => {
            assert!(errors.iter().any(Diagnostic::is_error), "no error for {text:?}");
            errors
        }
    };
    assert!(all.iter().all(|d| d.help.is_some() && !d.labels.is_empty()), "{all:?}");
    pss::report::text(&all, &sources, true);
    all.iter().for_each(|d| drop(pss::report::json_line(d, &sources)));
}

fn xorshift(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state as usize
}

#[test]
fn the_whole_grammar_is_understood() {
    let (outcome, sources) = read_with(LONG, &[]);
    let errors = outcome.err().unwrap_or_default();
    // It is about wording: some of its names are nowhere.
    let errors: Vec<_> = errors.into_iter().filter(|e| e.code != "E0401").collect();
    assert!(errors.is_empty(), "{}", pss::report::text(&errors, &sources, false));
}

#[test]
fn every_prefix_is_a_scene_or_an_error() {
    for end in (0..LONG.len()).filter(|i| LONG.is_char_boundary(*i)) {
        survive(&LONG[..end]);
    }
}

#[test]
fn every_suffix_is_a_scene_or_an_error() {
    for start in (0..LONG.len()).filter(|i| LONG.is_char_boundary(*i)) {
        survive(&LONG[start..]);
    }
}

#[test]
fn random_changes_are_survived() {
    const PIECES: [&str; 24] = [
        "(", ")", "[", "]", "{", "}", "\"", "\\", "/*", "//", "\n", "\0", "ö", "1e999", "draw", "@", "#",
        "..", "**", "!", "-", "'", "\u{1b}", "\u{202e}",
    ];
    let mut state = 0x9e37_79b9_7f4a_7c15;
    for _ in 0..4000 {
        let mut bytes = LONG.as_bytes().to_vec();
        for _ in 0..=xorshift(&mut state) % 4 {
            let at = xorshift(&mut state) % bytes.len();
            match xorshift(&mut state) % 4 {
                0 => bytes[at] = xorshift(&mut state) as u8,
                1 => drop(bytes.remove(at)),
                2 => {
                    let end = (at + xorshift(&mut state) % 40).min(bytes.len());
                    let copy = bytes[at..end].to_vec();
                    bytes.splice(at..at, copy);
                }
                _ => {
                    let piece = PIECES[xorshift(&mut state) % PIECES.len()];
                    bytes.splice(at..at, piece.bytes());
                }
            }
        }
        survive(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn deep_nests_are_refused_at_once() {
    let n = 100_000;
    let deep = [
        format!("let a = {}1{}", "(".repeat(n), ")".repeat(n)),
        format!("let a = {}", "[".repeat(n)),
        format!("let a = {}1", "-".repeat(n)),
        format!("let a = {}true", "not ".repeat(n)),
        format!("draw {}sphere(r: 1)", "!".repeat(n)),
        format!("let a = 1{}", " ** 1".repeat(n)),
        format!("let a = {}1", "fn (x) => ".repeat(n)),
        format!("let a = if true {{ 1 }} {} else {{ 2 }}", "else if true { 1 }".repeat(n)),
        format!("let a = {}1{}", "{ let b = (".repeat(n), ") b }".repeat(n)),
    ];
    for text in deep {
        let (outcome, _) = read_with(&text, &[("a", &text)]);
        let errors = outcome.expect_err("too deep");
        assert_eq!(errors[0].code, "E0701");
    }
}

#[test]
fn nests_within_the_limit_are_read() {
    scene(&format!("let a = {}1{}", "(".repeat(1000), ")".repeat(1000)));
    scene(&format!("let a = {}1{}", "[".repeat(1000), "]".repeat(1000)));
    scene(&format!("let a = {}1", "- ".repeat(1000)));
    scene(&format!("draw {}[]{}", "union([".repeat(499), "])".repeat(499)));
    scene(&format!("let a = 1{}", " ** 1".repeat(1000)));
}

#[test]
fn long_chains_are_flat() {
    let n = 20_000;
    scene(&format!("draw sphere(r: 1){}", " | sphere(r: 1)".repeat(n)));
    scene(&format!("draw sphere(r: 1){}", ".move([1, 0, 0])".repeat(n)));
    scene(&format!("let a = 1{}", " + 1 - 1".repeat(n)));
    let lets: String = (0..n).map(|i| format!("let a{i} = a{} | a{}\n", i + 1, i + 1)).collect();
    scene(&format!("{lets}let a{n} = sphere(r: 1)\ndraw a0"));
}

#[test]
fn lists_that_double_end_in_an_error() {
    let lets: String = (0..60).map(|i| format!("let a{} = [a{i}, a{i}]\n", i + 1)).collect();
    let (outcome, _) = read_with(&format!("let a0 = sphere(r: 1)\n{lets}draw union(a60)"), &[]);
    assert_eq!(outcome.expect_err("too many")[0].code, "E0703");
}

/// The code of the first error of a scene whose values may take 64 MiB.
fn refused(text: &str) -> &'static str {
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    let catalog = catalog();
    let reading = Reading {
        catalog: &catalog,
        defines: &[],
        files: None,
        geometry: None,
        expects: true,
        memory: 64 << 20,
    };
    let errors = pss::lang::read_with(&mut sources, file, &reading).err().unwrap_or_default();
    errors.first().map_or("none", |error| error.code)
}

/// What takes little text to say takes little time and memory to refuse.
#[test]
fn short_texts_cost_little() {
    let nest = |open: &str, inside: &str, close: &str| {
        let body = format!("{}{inside}{}", open.repeat(900), close.repeat(900));
        format!("fn f(n) = {body}\nlet a = f(0)")
    };
    let lets: String = (0..200).map(|i| format!("let a{i} = 1 ")).collect();
    let million = "let m = 0..1000000\n";
    let cases = [
        ("E0703", "let a = concat(0..600000, 0..600000)".to_owned()),
        ("E0709", format!("{million}let a = for i in m {{ count(concat(0..900000, [])) }}")),
        ("E0709", format!("{million}let a = for i in m {{ sum(m) }}")),
        ("E0709", format!("{million}let e = for i in 0..1e5 {{ [] }}\nlet a = for i in m {{ union(e) }}")),
        ("E0709", format!("{million}let a = for i in m {{ {}1 }}", "1 + ".repeat(1000))),
        ("E0709", format!("let a = {{ {lets} for i in 0..1000000 {{ {} }} }}", ["a0"; 200].join("+"))),
        ("E0709", format!("{million}let a = for i in m {{ {{ {lets} a0 }} }}")),
        ("E0709", {
            let f = "fn f(n, x) = if n == 0 { x } else { f(n - 1, x) + f(n - 1, x) }";
            format!("{f}\nlet a = implicit(f(40, x) < 1, inside: box(size: 1))")
        }),
        ("E0709", {
            let (open, close) = ("(".repeat(900), ")".repeat(900));
            format!("{million}let a = for i in m {{ implicit({open}x{close} < 1, inside: box(size: 1)) }}")
        }),
        ("E0710", format!("{million}let a = for i in m {{ [i, i, i, i] }}")),
        ("E0710", format!("{million}let a = for i in m {{ [{}1] }}", "1, ".repeat(1000))),
        ("E0710", format!("{million}let a = for i in m {{ \"{}\" }}", "long ".repeat(200))),
        ("E0710", format!("{million}let a = for i in m {{ sphere(r: i) }}")),
        ("E0710", format!("{million}let a = for i in m {{ matte(#fff) }}")),
        ("E0710", format!("{million}let a = for i in m {{ fn(x) => x + i }}")),
        ("E0710", format!("{million}let s = sphere(r: 1)\nlet a = for i in m {{ s | s }}")),
        ("E0710", format!("{million}let s = sphere(r: 1)\nlet a = for i in m {{ s.move([1, 1, i]) }}")),
        ("E0710", "let a = sphere(r: 1).around(1000000)".to_owned()),
        ("E0706", nest("(", "f(n + 1)", ")")),
        ("E0706", nest("-", "f(n + 1)", "")),
        ("E0706", nest("[", "f(n + 1)", "]")),
    ];
    for (code, text) in cases {
        assert_eq!(refused(&text), code, "{}", &text[..text.len().min(120)]);
    }
}

#[test]
fn what_a_loop_warns_of_is_told_once() {
    let (outcome, _) = read_with("draw union(for i in 0..1000 { sphere(r: 0) })", &[]);
    assert_eq!(outcome.expect("a scene").1.len(), 1);
}

/// Lists that share their elements are long when they are written out, and so are shapes.
#[test]
fn what_doubles_is_cut_short_where_it_is_written_out() {
    let lists: String = (0..60).map(|i| format!("let a{} = [a{i}, a{i}]\n", i + 1)).collect();
    let printed = scene(&format!("let a0 = [1, 2]\n{lists}print a60")).prints;
    assert!(printed[0].len() < 3 << 20 && printed[0].ends_with(" ..."));
    let shapes: String = (0..60).map(|i| format!("let a{} = a{i} | a{i}\n", i + 1)).collect();
    let doubled = scene(&format!("let a0 = sphere(r: 1)\n{shapes}draw a60"));
    assert_eq!(doubled.written_out(), (1 << 61) - 1);
    let chain = scene(&format!("draw sphere(r: 1){}", ".move([1, 0, 0])".repeat(20_000)));
    assert_eq!(chain.written_out(), 20_001);
    assert!(serde_json::to_string(&chain).is_ok());
}

#[test]
fn time_grows_with_the_text_not_with_its_nesting() {
    for text in ["(", "[", "f(", "a.b(", "{ let a = "] {
        let close = |c: &str| {
            if c.contains('(') {
                ")"
            } else if c.contains('[') {
                "]"
            } else {
                " a }"
            }
        };
        for depth in [8, 64, 400] {
            // Were anything parsed twice at each depth, this would not end.
            let nest = format!("let z = {}1{}", text.repeat(depth), close(text).repeat(depth));
            survive(&nest);
            survive(&nest[..nest.len() - 1]);
        }
    }
}

#[test]
fn twenty_errors_are_shown_and_the_rest_is_counted() {
    let text: String = (0..25).map(|i| format!("let a{i} = unknown_{i}\n")).collect();
    let shown = complaints(&text, &[]);
    assert_eq!(shown.matches("error[E0401]").count(), 20);
    assert!(shown.ends_with("\nerror: 5 more errors are not shown\n"), "{shown}");
}

#[test]
fn json_has_the_promised_fields() {
    let (outcome, sources) = read_with("let ok = \"ö\"\ndraw sphere(r: \"ö\", at: 3)\n", &[]);
    let errors = outcome.expect_err("a wrong type");
    assert_eq!(
        pss::report::json_line(&errors[0], &sources),
        r##"{"severity":"error","code":"E0501","message":"`r` wants a length, found a string","file":"scene.pss","line":2,"column":16,"end_line":2,"end_column":19,"help":"write a length, such as `10`","notes":[]}"##
    );
    let nowhere = Diagnostic::error("E0601", "a\nb");
    let line = pss::report::json_line(&nowhere, &SourceMap::default());
    assert!(line.contains(r#""file":null"#) && !line.contains('\n'), "{line}");
}

/// The nearest names are sought for the errors that are shown, and not for words that nobody writes.
#[test]
fn thousands_of_unknown_names_take_no_time() {
    let many: String = (0..5000).map(|i| format!("let a{i} = b{i}\n")).collect();
    let known: String = (0..20_000).map(|i| format!("let abcdefgh{i} = 1\n")).collect();
    let unknown: String = (0..2000).map(|i| format!("let x{i} = abcdefghi{i}\n")).collect();
    let long = format!("fn f(i) = {}\nlet {} = 3", "a".repeat(100_000), "a".repeat(99_999));
    let formals: String = (0..5000).map(|i| format!("abcdefgh{i}, ")).collect();
    let calls: String = (0..2000).map(|i| format!("let y{i} = f(abcdefghi{i}: 1)\n")).collect();
    for text in [many, format!("{known}{unknown}"), long, format!("fn f({formals}) = 1\n{calls}")] {
        let start = std::time::Instant::now();
        let (outcome, sources) = read_with(&text, &[]);
        let errors = outcome.expect_err("unknown names");
        pss::report::text(&errors, &sources, false);
        let took = start.elapsed();
        assert!(took.as_secs_f64() < 5.0, "{took:?} {}", &text[..40]);
    }
}

/// A file of thousands of names by a name space, asked for thousands that it has not.
#[test]
fn thousands_of_unknown_members_take_no_time() {
    struct Names;
    impl pss::lang::Files for Names {
        fn resolve(
            &self,
            written: &str,
            _: &std::path::Path,
            _: pss::source::Span,
        ) -> Result<std::path::PathBuf, Diagnostic> {
            Ok(written.into())
        }
        fn read(&self, _: &std::path::Path, _: pss::source::Span) -> Result<String, Diagnostic> {
            Ok((0..20_000).map(|i| format!("let abcdefgh{i} = 1\n")).collect())
        }
    }
    let asked: String = (0..2000).map(|i| format!("let x{i} = n.abcdefghi{i}\n")).collect();
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, format!("import \"n.pss\" as n\n{asked}"));
    let catalog = catalog();
    let reading = Reading {
        catalog: &catalog,
        defines: &[],
        files: Some(&Names),
        geometry: None,
        expects: false,
        memory: pss::lang::MEMORY,
    };
    let start = std::time::Instant::now();
    let errors = pss::lang::read_with(&mut sources, file, &reading).expect_err("unknown members");
    assert_eq!(errors.len(), 2000);
    assert!(
        errors[0].help.as_deref().is_some_and(|help| help.starts_with("did you mean")),
        "{:?}",
        errors[0]
    );
    let took = start.elapsed();
    assert!(took.as_secs_f64() < 5.0, "{took:?}");
}

#[test]
fn items_end_with_their_last_token() {
    let text = "param n = 3\n// a\nexpect n is 3\nprint n /* b */\n\nlet a = [\n1] // c\ndraw sphere(r: 1)\n";
    let mut sources = SourceMap::default();
    let file = sources.add("scene.pss", None, text);
    let items = pss::lang::items(&sources, file).unwrap();
    let texts: Vec<&str> = items.iter().map(|item| sources.text(item.at)).collect();
    assert_eq!(texts, ["param n = 3", "expect n is 3", "print n", "let a = [\n1]", "draw sphere(r: 1)"]);
}
