//! The table of keywords: how each is written, and what it does. Errors, the reference and editors read it; what the words
//! mean to the grammar stands in `grammar/pss.pest`.

/// A word that cannot be a name.
#[derive(Clone, Copy, Debug)]
pub struct Keyword {
    /// The word.
    pub word: &'static str,
    /// How it is written.
    pub usage: &'static str,
    /// One sentence.
    pub doc: &'static str,
}

const fn line(word: &'static str, usage: &'static str, doc: &'static str) -> Keyword {
    Keyword { word, usage, doc }
}

/// All of them, those that begin an item first.
pub const KEYWORDS: [Keyword; 24] = [
    line("let", "let name = value", "Names a value: in the whole file, or in what follows in a block."),
    line("fn", "fn name(parameters) = value", "A function; without a name it is a value: `fn(x) => 2 * x`."),
    line(
        "param",
        "param name: type = default in lowest..highest \"description\"",
        "A value that the command line can set: `-D name=value`. The types are number, int, length, angle, color, vector, string and bool.",
    ),
    line(
        "import",
        "import \"file.pss\" as name",
        "Makes the names of another file known; without `as` among those of this one. What that file draws is not drawn; what it prints is printed.",
    ),
    line(
        "material",
        "material name(kind: \"matte\", color: #ffffff)",
        "Names a material, which `.with(name)` puts on a shape.",
    ),
    line("camera", "camera name(eye: [x, y, z], look_at: [x, y, z])", "Where the picture is seen from."),
    line("light", "light name(direction: [x, y, z])", "A sun, a point of light or a sky."),
    line("render", "render(size: [width, height])", "How the picture is made."),
    line(
        "units",
        "units(mm)",
        "What a length without a unit is in: um, mm, cm, m, km, in or ft; mm where nothing is said.",
    ),
    line(
        "draw",
        "draw shape",
        "Shows a shape, or a list of shapes. After `@only` nothing else is shown, after `@skip` it is left out.",
    ),
    line("print", "print value", "Writes a value to standard error."),
    line(
        "expect",
        "expect condition",
        "States what must hold; `check` and `test` evaluate it, `render` does not. `a ~= b` alone allows 1e-7 % of b.",
    ),
    line("if", "if condition { a } else { b }", "One of two values."),
    line(
        "else",
        "if condition { a } else { b }",
        "Before the value of an `if` whose condition does not hold.",
    ),
    line(
        "for",
        "for i in 0..5 { value }",
        "A list: the value of the block for each element of a list or a range. Several names make all pairs: `for x in 0..3, y in 0..2 { ... }`.",
    ),
    line("in", "for i in list { value }", "Before the list of a loop, or before what a parameter may be."),
    line("is", "expect a is b", "Between the two sides of an expectation, which must be equal."),
    line("or", "a or b", "Whether at least one of two conditions holds."),
    line("and", "a and b", "Whether two conditions both hold."),
    line("not", "not a", "Whether a condition does not hold."),
    line("true", "true", "What holds."),
    line("false", "false", "What does not hold."),
    line("within", "expect a ~= b within 1%", "By how much the sides of an expectation may differ."),
    line("as", "import \"file.pss\" as name", "Gives the names of a file a name space: `name.part`."),
];

/// Whether a word cannot be a name.
pub fn is_keyword(word: &str) -> bool {
    KEYWORDS.iter().any(|k| k.word == word)
}

/// How an item is written, in backquotes; its word may be the sign of an attribute.
pub fn usage(item: &str) -> String {
    let word = if item == "@" { "draw" } else { item };
    match KEYWORDS.iter().take(12).find(|k| k.word == word) {
        Some(known) => format!("`{}`", known.usage),
        None => "a value".to_owned(),
    }
}
