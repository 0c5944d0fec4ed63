//! Words that people bring along from OpenSCAD, POV-Ray and programming languages, and what is written here instead.

/// Where a word stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place {
    /// Where an item begins.
    Item,
    /// As a name or a function.
    Name,
    /// After the point of a shape.
    Method,
    /// Before the colon of an argument.
    Argument,
}

use Place::{Argument, Item, Method, Name};

const MOVES: &str = "what changes a shape is written after it: `draw shape.move([x, y, z])`";
const TURNS: &str = "what changes a shape is written after it: `draw shape.rotate_z(45deg)`, or `.rotate(axis: [x, y, z], by: 45deg)`";
const SCALES: &str =
    "what changes a shape is written after it: `draw shape.scale(2)`, or `.scale([x, y, z])`";
const MIRRORS: &str = "what changes a shape is written after it: `draw shape.mirror([1, 0, 0])`";
const FITS: &str = "what changes a shape is written after it: `draw shape.fit([0, 0, 0], height: 10)`, or `.scale([x, y, z])`";
const MAPS: &str = "what changes a shape is written after it: `draw shape.matrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])`";
const TAKES: &str = "what is to be seen is drawn: `draw difference(base, [a, b])`, or `draw base - a`";
const JOINS: &str = "what is to be seen is drawn: `draw union([a, b])`, or `draw a | b`";
const MEETS: &str = "what is to be seen is drawn: `draw intersection([a, b])`, or `draw a & b`";
const LET: &str = "a value is named by `let name = value`";
const IMPORT: &str = "write `import \"file.pss\"`, or `import \"file.pss\" as name`";
const FN: &str = "write `fn name(a, b = 1) = value`; without a name, `fn(a) => value`";
const HULL: &str = "there is no hull and no Minkowski sum; `capsule`, `tube`, `box(..., round: r)` and `.offset(r)` are exact round shapes";
const OUTLINE: &str = "an outline is a list of points: `extrude([[0, 0], [10, 0], [0, 10]], h: 5)`";
pub const WEAR: &str = "a material is worn by `.with(matte(#b8683c))`";
const EXACT: &str = "surfaces are exact: there is no number of facets to set";

/// Words, where they stand, and what helps.
const HABITS: &[(&[&str], Place, &str)] = &[
    (&["difference"], Item, TAKES),
    (&["union", "merge"], Item, JOINS),
    (&["intersection"], Item, MEETS),
    (&["hull", "minkowski"], Item, HULL),
    (&["module", "function", "def", "func", "#macro"], Item, FN),
    (&["var", "const", "#declare", "#local"], Item, LET),
    (&["include", "use", "#include", "from"], Item, IMPORT),
    (
        &["for", "intersection_for", "#for"],
        Item,
        "a loop is a value, a list: `draw for i in 0..5 { sphere(r: 1, at: [3 * i, 0, 0]) }`",
    ),
    (&["if", "#if", "#ifdef", "#switch"], Item, "a choice is a value: `draw if n > 3 { a } else { b }`"),
    (&["while", "repeat", "#while"], Item, "write `for i in 0..n { ... }`, or a function that calls itself"),
    (&["return"], Item, "the value of a function is what stands after its `=`: `fn f(x) = 2 * x`"),
    (&["echo", "puts", "console"], Item, "write `print value`"),
    (&["assert"], Item, "write `expect condition`"),
    (&["light_source"], Item, "write `light(at: [x, y, z])`, or `light(direction: [x, y, z])` for a sun"),
    (&["texture", "pigment", "finish", "interior"], Item, WEAR),
    (
        &["global_settings", "#version", "#default"],
        Item,
        "how the picture is made is said by `render(size: [640, 480], samples: 16)`",
    ),
    (
        &["#end", "#else"],
        Item,
        "what belongs together stands in braces: `if a { b } else { c }`, `for i in 0..5 { a }`",
    ),
    (&["background"], Item, "write `light sky(color: #dfe8ff)`"),
    (&["$", "$fn", "$fa", "$fs"], Item, EXACT),
    (&["#", "%"], Item, "what is to be seen through is drawn by `@ghost draw shape`"),
    (&["*"], Item, "what is not to be seen is left out by `@skip draw shape`"),
    (&["!"], Item, "what alone is to be seen is drawn by `@only draw shape`"),
    (&["cube"], Name, "write `box(size: [x, y, z])`, centred, or `box([0, 0, 0], [x, y, z])`"),
    (&["ellipsoid"], Name, "write `sphere(r: [x, y, z])`"),
    (&["linear_extrude", "prism"], Name, "write `extrude(outline, h: 10)`"),
    (&["rotate_extrude", "lathe", "sor"], Name, "write `revolve(outline)`"),
    (&["polygon", "square", "circle"], Name, OUTLINE),
    (
        &["polyhedron", "surface"],
        Name,
        "read triangles with `mesh(\"part.stl\")`, heights with `heightfield(\"map.png\", size: [x, y, z])`",
    ),
    (
        &[
            "red", "green", "blue", "white", "black", "yellow", "orange", "gray", "grey", "cyan", "magenta",
            "brown",
        ],
        Name,
        "colours are written by their red, green and blue: `#ff0000`",
    ),
    (&["hull", "minkowski", "hulling"], Name, HULL),
    (&["blob", "isosurface"], Name, "write `implicit(x**2 + y**2 + z**2 <= 1, inside: box(size: 3))`"),
    (&["len"], Name, "write `count(list)`; the length of a vector is `length(v)`"),
    (&["norm", "vlength"], Name, "write `length(v)`"),
    (&["pow"], Name, "write `a ** b`"),
    (&["log"], Name, "write `ln(x)`, or `ln(x) / ln(10)`"),
    (&["PI", "Pi"], Name, "write `pi`"),
    (
        &["rands", "random"],
        Name,
        "write `rand(seed, i)`: a number in 0..1 that depends on its arguments alone",
    ),
    (
        &["undef", "null", "None", "nil"],
        Name,
        "every name has a value; leave an argument out to have its default",
    ),
    (&["str"], Name, "`print` takes any value, and lists of them: `print [\"r\", r]`"),
    (&["translate"], Name, MOVES),
    (&["rotate"], Name, TURNS),
    (&["scale"], Name, SCALES),
    (&["mirror"], Name, MIRRORS),
    (&["resize"], Name, FITS),
    (&["multmatrix"], Name, MAPS),
    (&["color"], Name, WEAR),
    (&["atan"], Name, "write `atan2(y, x)`"),
    (&["sqr"], Name, "a square is `x ** 2`, a root `sqrt(x)`"),
    (&["cbrt"], Name, "write `x ** (1 / 3)`"),
    (&["sign", "sgn", "signum"], Name, "write `if x < 0 { -1 } else { 1 }`"),
    (
        &["sinh", "cosh", "tanh", "asinh", "acosh", "atanh"],
        Name,
        "write it by `exp` and `ln`: cosh is `(exp(x) + exp(-x)) / 2`",
    ),
    (&["log10"], Name, "write `ln(x) / ln(10)`"),
    (&["log2"], Name, "write `ln(x) / ln(2)`"),
    (&["hypot"], Name, "write `length([x, y])`"),
    (&["fmod", "mod", "modulo"], Name, "write `a % b`"),
    (&["trunc", "int"], Name, "write `floor(x)`, `ceil(x)` or `round(x)`"),
    (&["fract", "frac"], Name, "write `x % 1`"),
    (&["lerp"], Name, "write `mix(a, b, t)`"),
    (&["degrees"], Name, "write `x * 1deg`; an angle in degrees is `angle / 1deg`"),
    (&["radians"], Name, "write `x * 1rad`; an angle in radians is `angle / 1rad`"),
    (
        &["text"],
        Name,
        "there are no letters; an outline of points is extruded: `extrude([[0, 0], [1, 0], [0, 1]], h: 1)`",
    ),
    (&["projection", "offset", "render"], Name, "shapes are solids; a flat outline is a list of points"),
    (&["children"], Name, "a function takes shapes as arguments: `fn pair(s) = s | s.move([9, 0, 0])`"),
    (
        &["x", "y", "z"],
        Name,
        "coordinates are known in `implicit` and `half_space`; an axis is written in quotes, `\"z\"`; a value of your own is defined: `let name = value`",
    ),
    (&["each"], Name, "lists are joined by `concat(a, b)`"),
    (&["translate", "translated", "position", "at"], Method, "write `.move([x, y, z])`"),
    (&["rotateX", "rotx"], Method, "write `.rotate_x(45deg)`"),
    (&["rotateY", "roty"], Method, "write `.rotate_y(45deg)`"),
    (&["rotateZ", "rotz"], Method, "write `.rotate_z(45deg)`"),
    (&["color", "colour", "texture", "pigment", "material", "paint"], Method, WEAR),
    (&["resize"], Method, "write `.fit([x, y, z], height: 10)`, or `.scale([x, y, z])`"),
    (&["union", "add", "join", "fuse"], Method, "write `a | b`"),
    (&["difference", "subtract", "minus"], Method, "write `a - b`"),
    (&["intersection", "intersect", "common"], Method, "write `a & b`"),
    (&["hull", "minkowski"], Method, HULL),
    (
        &["len", "size"],
        Method,
        "the elements of a list are counted by `count(list)`, a shape is measured by `bounds(shape).size`",
    ),
    (&["d", "diameter"], Argument, "write the radius: `r: d / 2`"),
    (&["radius"], Argument, "write `r:`"),
    (&["height"], Argument, "write `h:`"),
    (
        &["center", "centre", "origin"],
        Argument,
        "what stands elsewhere is moved: `.move([x, y, z])`; some shapes take `at: [x, y, z]`, their centre",
    ),
    (&["diam", "d1", "d2"], Argument, "write the radius, half of it"),
    (&["pigment", "texture", "color", "colour", "material"], Argument, WEAR),
    (
        &["location", "position", "pos", "from", "eye"],
        Argument,
        "a camera has `eye:`, a light `at:` or `direction:`",
    ),
    (&["target", "lookat", "look", "to", "aim"], Argument, "write `look_at: [x, y, z]`"),
    (
        &["angle"],
        Argument,
        "a camera has a vertical angle, `fov: 30deg`, and a sun has a diameter, `softness: 2deg`",
    ),
    (&["fovy"], Argument, "write the vertical angle: `fov: 30deg`"),
    (&["width", "resolution"], Argument, "write `size: [width, height]`"),
    (&["spp", "antialias", "quality"], Argument, "write `samples: 16`"),
    (&["power", "brightness", "energy"], Argument, "write `intensity: 2`"),
];

/// Words that mean the same as one of ours, in the same place: what may mean something else, as `green` of CSS does, is none.
const SAME: &[(&str, Place, &str)] = &[
    ("union", Item, "draw union"),
    ("difference", Item, "draw difference"),
    ("intersection", Item, "draw intersection"),
    ("var", Item, "let"),
    ("const", Item, "let"),
    ("#declare", Item, "let"),
    ("#local", Item, "let"),
    ("function", Item, "fn"),
    ("def", Item, "fn"),
    ("func", Item, "fn"),
    ("echo", Item, "print"),
    ("assert", Item, "expect"),
    ("light_source", Item, "light"),
    ("red", Name, "#ff0000"),
    ("blue", Name, "#0000ff"),
    ("white", Name, "#ffffff"),
    ("black", Name, "#000000"),
    ("yellow", Name, "#ffff00"),
    ("cyan", Name, "#00ffff"),
    ("magenta", Name, "#ff00ff"),
    ("ellipsoid", Name, "sphere"),
    ("linear_extrude", Name, "extrude"),
    ("prism", Name, "extrude"),
    ("rotate_extrude", Name, "revolve"),
    ("lathe", Name, "revolve"),
    ("sor", Name, "revolve"),
    ("isosurface", Name, "implicit"),
    ("len", Name, "count"),
    ("norm", Name, "length"),
    ("vlength", Name, "length"),
    ("PI", Name, "pi"),
    ("Pi", Name, "pi"),
    ("translate", Method, "move"),
    ("translated", Method, "move"),
    ("rotateX", Method, "rotate_x"),
    ("rotx", Method, "rotate_x"),
    ("rotateY", Method, "rotate_y"),
    ("roty", Method, "rotate_y"),
    ("rotateZ", Method, "rotate_z"),
    ("rotz", Method, "rotate_z"),
    ("radius", Argument, "r"),
    ("height", Argument, "h"),
    ("center", Argument, "at"),
    ("centre", Argument, "at"),
    ("origin", Argument, "at"),
    ("target", Argument, "look_at"),
    ("lookat", Argument, "look_at"),
    ("fovy", Argument, "fov"),
    ("spp", Argument, "samples"),
];

/// Arguments of one call that are another's.
const ARGUMENTS: &[(&str, &[&str], &str)] = &[
    ("cylinder", &["r1", "r2"], "a cylinder of two radii is `cone(r1: 2, r2: 1, h: 3)`"),
    (
        "torus",
        &["r", "R", "r1", "r2", "r_major", "r_minor"],
        "the ring's radius is `major:`, that of its tube `minor:`",
    ),
    ("cone", &["r"], "a cone has two radii: `cone(r1: 2, r2: 0, h: 3)`"),
];

/// What to write instead of an argument of a call.
pub fn instead_of_argument(callee: &str, word: &str) -> Option<&'static str> {
    let own = ARGUMENTS.iter().find(|(of, words, _)| *of == callee && words.contains(&word));
    own.map(|(.., help)| *help).or_else(|| instead(word, Argument))
}

/// The word of ours that means the same.
pub fn same(word: &str, place: Place) -> Option<&'static str> {
    SAME.iter().find(|(theirs, at, _)| *at == place && *theirs == word).map(|(_, _, ours)| *ours)
}

/// What to write instead of a word that begins an item, where that is no word of an item: of all places where it may be known.
pub fn instead_of_item(word: &str) -> Option<&'static str> {
    [Item, Name, Method].into_iter().find_map(|place| instead(word, place))
}

/// What to write instead of a word.
pub fn instead(word: &str, place: Place) -> Option<&'static str> {
    HABITS.iter().find(|(words, at, _)| *at == place && words.contains(&word)).map(|(_, _, help)| *help)
}
