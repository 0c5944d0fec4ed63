//! The codes of errors.

use super::{Code, code, takes};

/// In their order.
pub const CODES: &[Code] = &[
    code(
        "E0001",
        "The command line is wrong.",
        "`pss help` and `pss COMMAND --help` list what is taken.",
        ["$ pss explain shpere", "$ pss explain sphere"],
    ),
    code(
        "E0101",
        "An item is not complete, or something does not fit where it stands.",
        "The mark stands where reading stopped; often a sign or a bracket before it is missing.",
        ["draw sphere(r: )", "draw sphere(r: 2)"],
    ),
    code(
        "E0102",
        "A bracket is not closed, or closes nothing.",
        "Each `(`, `[` and `{` has its own `)`, `]` and `}`, and they nest.",
        ["draw union([sphere(r: 1), box(size: 1))", "draw union([sphere(r: 1), box(size: 1)])"],
    ),
    code(
        "E0103",
        "A character has no meaning in a scene.",
        "Scenes are written in ASCII outside of strings and comments; a `;` is not needed.",
        ["let a = 3;", "let a = 3"],
    ),
    code(
        "E0104",
        "A string does not end, or holds an escape that is none.",
        "A string ends on its line. The escapes are `\\\"`, `\\\\`, `\\n` and `\\t`.",
        ["print \"done", "print \"done\""],
    ),
    code(
        "E0105",
        "A unit or a colour is not known.",
        "Units of length are um mm cm m km in ft, of angles deg rad turn; they touch their number. Colours are `#rgb` or `#rrggbb`.",
        ["draw sphere(r: 3inch)", "draw sphere(r: 3in)"],
    ),
    code(
        "E0106",
        "A line begins with a word that begins no item.",
        "A scene is a list of items: `let`, `fn`, `param`, `draw`, `camera`, ... What is to be seen is drawn: `draw sphere(r: 1)`.",
        ["sphere(r: 1)", "draw sphere(r: 1)"],
    ),
    code(
        "E0107",
        "Comparisons and ranges do not chain.",
        "`a < b < c` is written `a < b and b < c`.",
        ["expect 1 < 2 < 3", "expect 1 < 2 and 2 < 3"],
    ),
    code(
        "E0108",
        "A comment does not end.",
        "`/*` is closed by the next `*/`; comments do not nest.",
        ["draw sphere(r: 1) /* a ball", "draw sphere(r: 1) /* a ball */"],
    ),
    code(
        "E0201",
        "Operators stand together without parentheses.",
        "`a - b | c` could mean two solids. One chain holds one of `|`, `&`, `-`, `^`; parentheses say the rest.",
        [
            "draw box(size: 2) - sphere(r: 1) | sphere(r: 0.5)",
            "draw (box(size: 2) - sphere(r: 1)) | sphere(r: 0.5)",
        ],
    ),
    code(
        "E0202",
        "An operator of numbers stands between shapes.",
        "Shapes are combined by `|` (union), `&` (intersection), `-` (difference), `^` and `!`.",
        ["draw sphere(r: 1) + box(size: 1)", "draw sphere(r: 1) | box(size: 1)"],
    ),
    code(
        "E0203",
        "An operator does not fit its operands.",
        "Numbers go with numbers, vectors with vectors of the same size, angles with angles; conditions are joined by `and` and `or`.",
        ["let a = 30deg + 2", "let a = 30deg + 2deg"],
    ),
    code(
        "E0301",
        "Something without an inside stands where a solid is needed.",
        "`&`, `-`, `^` and `!` need to know what is inside. Close an open scan, give a sheet a thickness, or put a solid in its place.",
        ["draw box(size: 1) - plane(z: 0)", "draw box(size: 1) - half_space(z < 0)"],
    ),
    code(
        "E0302",
        "A solid and a sheet are joined.",
        "A union is of solids or of sheets. Draw them one by one.",
        ["draw sphere(r: 1) | plane(z: 0)", "draw [sphere(r: 1), plane(z: 0)]"],
    ),
    code(
        "E0303",
        "The intersection of nothing is all of space; or a hole is too wide to be closed.",
        "Give `intersection` at least one shape. Of a hole the message says how wide it is: `.close(max_hole: ...)` may be larger.",
        ["draw intersection([])", "draw intersection([sphere(r: 1)])"],
    ),
    code(
        "E0304",
        "Something is closed that is no scan, or changed after it was clipped.",
        "`.close` caps the holes of a scan, before it is combined with others; `.clip` comes last.",
        ["draw sphere(r: 1).close(max_hole: 1)", "draw sphere(r: 1)"],
    ),
    code(
        "E0305",
        "A shape has no bounds, or is nothing, where its size is needed.",
        "Cut what is unbounded with something that has an end: `shape & box(size: 100)`.",
        [
            "draw half_space(z < 0).fit([0, 0, 0], height: 10)",
            "draw (half_space(z < 0) & box(size: 4)).fit([0, 0, 0], height: 10)",
        ],
    ),
    code(
        "E0306",
        "Samples of a solid cannot be taken.",
        "Sample a bounded solid that has an inside, such as `points(sphere(r: 1), samples: 1000)`.",
        ["draw points(half_space(z < 0), samples: 1000)", "draw points(sphere(r: 1), samples: 1000)"],
    ),
    code(
        "E0307",
        "A shape has no exact offset.",
        "What lies near an edge has a rounded one. Write the shape with other sizes, or move samples of it.",
        ["draw cylinder(r: 1, h: 2).offset(0.1)", "draw sphere(r: 1).offset(0.1)"],
    ),
    code(
        "E0308",
        "A thickness is given to something that has an inside.",
        "`.thicken` is for sheets. A hollow solid is `solid - solid.inset(2mm)`.",
        ["draw sphere(r: 1).thicken(0.1)", "draw sphere(r: 1) - sphere(r: 1).inset(0.1)"],
    ),
    code(
        "E0309",
        "Nothing is left of an inset.",
        "The length is larger than what is inside of the shape.",
        ["draw sphere(r: 1).inset(2)", "draw sphere(r: 1).inset(0.2)"],
    ),
    code(
        "E0310",
        "A material takes its colour from a scan that has none.",
        "Take a scan with colours, or a material of one colour: `matte(#b8683c)`.",
        [
            scan!("material own(kind: \"points\")\ndraw points(\"scan.ply\").with(own)"),
            scan!("material own(color: #b8683c)\ndraw points(\"scan.ply\").with(own)"),
        ],
    ),
    code(
        "E0401",
        "A name is not known.",
        "Names are defined by `let`, `fn`, `param`, `material` and `import`, in any order; those of a block from their line on.",
        ["draw spere(r: 1)", "draw sphere(r: 1)"],
    ),
    code(
        "E0402",
        "A name is defined twice, or something is given twice that there is one of.",
        "A name is bound once in its scope: there is no assignment. Take another name.",
        ["let a = 1\nlet a = 2", "let a = 1\nlet b = 2"],
    ),
    code(
        "E0403",
        "There is no such argument, or no such camera.",
        "The message lists what there is.",
        ["draw sphere(radius: 1)", "draw sphere(r: 1)"],
    ),
    code(
        "E0404",
        "An argument is missing.",
        "The message shows the whole call.",
        ["draw sphere(at: [0, 0, 1])", "draw sphere(r: 1, at: [0, 0, 1])"],
    ),
    code(
        "E0405",
        "An argument is given twice.",
        "Remove one of them.",
        ["draw sphere(r: 1, r: 2)", "draw sphere(r: 1)"],
    ),
    code(
        "E0406",
        "An argument by place is not taken, or one too many.",
        "Most arguments are named: `r: 2`. Those that may be given by place stand first in `pss explain WORD`, without a colon.",
        ["draw sphere(2)", "draw sphere(r: 2)"],
    ),
    code(
        "E0407",
        "Arguments do not go together, or a name is defined by itself.",
        "The message says which; a circle of definitions is broken where one need not use the next.",
        ["let a = b\nlet b = a", "let a = 1\nlet b = a"],
    ),
    code(
        "E0408",
        "There is no such method or part.",
        "Methods of shapes are listed by `pss explain`; vectors have `.x .y .z`, bounds `.min .max .size .center`.",
        ["draw sphere(r: 1).translate([1, 0, 0])", "draw sphere(r: 1).move([1, 0, 0])"],
    ),
    code(
        "E0409",
        "`-D` names no parameter of the scene.",
        "Parameters are the `param` items of the scene itself.",
        [
            "$ pss check scene.pss -D bor=3mm\nparam bore: length = 4 in 1..8\ndraw sphere(r: bore)",
            "$ pss check scene.pss -D bore=3mm\nparam bore: length = 4 in 1..8\ndraw sphere(r: bore)",
        ],
    ),
    code(
        "E0410",
        "Something is called that is no function, or a function stands without its arguments.",
        "A function is called with parentheses: `sphere(r: 1)`.",
        ["let a = 3\nprint a(1)", "let a = 3\nprint a * 1"],
    ),
    code(
        "E0501",
        "A value is of another kind than is wanted.",
        "The message says what is wanted and shows how it is written.",
        ["draw sphere(r: \"2\")", "draw sphere(r: 2)"],
    ),
    code(
        "E0502",
        "A bare number stands where an angle is wanted.",
        "Angles have units: `45deg`, `0.8rad`, `0.25turn`.",
        ["draw box(size: 1).rotate_z(45)", "draw box(size: 1).rotate_z(45deg)"],
    ),
    code(
        "E0503",
        "A value is outside of what is allowed.",
        "The message says what is allowed.",
        ["render(samples: 0)", "render(samples: 1)"],
    ),
    code(
        "E0504",
        "A number is infinite or undefined.",
        "Look for a division by zero or a root of a negative number.",
        ["let a = 1 / 0", "let a = 1 / 2"],
    ),
    code(
        "E0505",
        "A number is beyond what a scene may use, or a transform cannot be undone.",
        "Numbers end at 1e18; no factor of a scale may be zero or very much smaller than another.",
        ["draw sphere(r: 1e19)", "draw sphere(r: 1e3)"],
    ),
    code(
        "E0506",
        "A size is negative.",
        "Sizes are zero or more.",
        ["draw sphere(r: -1)", "draw sphere(r: 1)"],
    ),
    code(
        "E0507",
        "A word is not one of those that may be given.",
        "The message lists them.",
        ["render(tone: \"filmic\")", "render(tone: \"agx\")"],
    ),
    code(
        "E0508",
        "The condition of a half-space is not linear, or is none.",
        "Write a linear condition on x, y and z: `z < 60` or `x + 2*y <= 3`.",
        ["draw box(size: 1) & half_space(x * y < 1)", "draw box(size: 1) & half_space(x + y < 1)"],
    ),
    code(
        "E0509",
        "The value of a `-D` cannot be read.",
        "Strings are given as they stand, anything else as in a scene: `-D bore=3mm`.",
        [
            "$ pss check scene.pss -D bore=wide\nparam bore: length = 4 in 1..8\ndraw sphere(r: bore)",
            "$ pss check scene.pss -D bore=3mm\nparam bore: length = 4 in 1..8\ndraw sphere(r: bore)",
        ],
    ),
    code(
        "E0510",
        "A transform has no direction, or a scale of zero.",
        "An axis is a vector that is not zero.",
        ["draw box(size: 1).scale(0)", "draw box(size: 1).scale(2)"],
    ),
    code(
        "E0511",
        "A formula of x, y and z holds what it cannot.",
        "A formula is made of numbers, operators, functions of numbers, and functions of the scene that are made of these.",
        [
            "draw implicit(x**2 + y**2, inside: box(size: 3))",
            "draw implicit(x**2 + y**2 <= 1, inside: box(size: 3))",
        ],
    ),
    code(
        "E0512",
        "A vector of a formula has no number with this index.",
        "Indices begin at 0.",
        [
            "draw implicit([x, y][2] <= 0, inside: box(size: 3))",
            "draw implicit([x, y][1] <= 0, inside: box(size: 3))",
        ],
    ),
    code(
        "E0513",
        "The files of a scene have different units.",
        "All files that say `units` agree; lengths with units of their own mean the same in each.",
        [
            "units(mm)\nimport \"peg.pss\"\ndraw peg\n--- peg.pss\nunits(in)\nlet peg = cylinder(r: 1, h: 3)",
            "units(mm)\nimport \"peg.pss\"\ndraw peg\n--- peg.pss\nlet peg = cylinder(r: 1in, h: 3in)",
        ],
    ),
    code(
        "E0601",
        "A file cannot be read.",
        "Is the name right? It is relative to the file that names it.",
        ["draw points(\"nowhere.ply\")", "draw points(sphere(r: 1), samples: 1000)"],
    ),
    code(
        "E0602",
        "A file name holds a zero byte.",
        "Write the name of a file.",
        takes("strings have no escape for such a byte; programs that build scenes may put one in."),
    ),
    code(
        "E0603",
        "A file lies outside of what a scene may read.",
        "A scene reads below its own folder, what `-D` names, and below the folders of `--allow-read DIR`.",
        ["draw points(\"../scan.ply\")", "draw points(sphere(r: 1), samples: 1000)"],
    ),
    code(
        "E0604",
        "A file holds what cannot be used.",
        "The message says where it is wrong.",
        [
            "$ pss probe scene.pss --rays rays.txt\ndraw sphere(r: 1)\n--- rays.txt\n0,0,5 0,0",
            "$ pss probe scene.pss --rays rays.txt\ndraw sphere(r: 1)\n--- rays.txt\n0,0,5 0,0,-1",
        ],
    ),
    code(
        "E0605",
        "A file does not hold what is asked of it, or not as it is asked.",
        "The message says what it lacks.",
        [
            "draw points(\"scan.ply\")\n--- scan.ply\nply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nend_header\n1 2\n3 4",
            scan!("draw points(\"scan.ply\")"),
        ],
    ),
    code(
        "E0606",
        "A file is of another kind than its name says, or is broken.",
        "The message says what it is.",
        takes("it takes a disk or a network that fails while the file is read."),
    ),
    code(
        "E0607",
        "An output is one of the inputs.",
        "Write the picture under another name.",
        [scan!("$ pss cloud convert scan.ply scan.ply"), scan!("$ pss cloud convert scan.ply clean.ply")],
    ),
    code(
        "E0608",
        "A file cannot be written.",
        "Does its folder exist, and may it be written to?",
        [
            "$ pss render scene.pss -o nowhere/a.png\ndraw sphere(r: 1)",
            "$ pss render scene.pss -o a.png --size 8x6\ndraw sphere(r: 1)",
        ],
    ),
    code(
        "E0609",
        "A file is imported by itself.",
        "Put what both need into a file of its own, and import that.",
        ["import \"scene.pss\"\ndraw sphere(r: 1)", "draw sphere(r: 1)"],
    ),
    code(
        "E0610",
        "What is kept of a stopped render is of another picture.",
        "A render goes on only with the same scene, files, settings and program. Leave out `--resume` to begin anew.",
        [
            "$ pss render scene.pss -o a.png --size 8x6 --quiet --time-limit 0\n$ pss render scene.pss -o a.png --size 9x6 --resume\ndraw sphere(r: 1)",
            "$ pss render scene.pss -o a.png --size 8x6 --quiet --time-limit 0\n$ pss render scene.pss -o a.png --size 8x6 --resume\ndraw sphere(r: 1)",
        ],
    ),
    code(
        "E0611",
        "The render was stopped: by a signal, or by `--time-limit`.",
        "What there is stands beside the picture's place, with `.partial` in its name; `--resume` goes on.",
        [
            "$ pss render scene.pss -o a.png --size 8x6 --time-limit 0\ndraw sphere(r: 1)",
            "$ pss render scene.pss -o a.png --size 8x6\ndraw sphere(r: 1)",
        ],
    ),
    code(
        "E0612",
        "Another run is making this picture.",
        "Wait for it, or write to another file.",
        takes("it takes two runs of one picture at a time."),
    ),
    code(
        "E0701",
        "Something nests too deep, or is too large to be read.",
        "Brackets, signs and lists nest up to 1000 deep. Name parts with `let`, or list them side by side.",
        [
            "fn ten(a) = [[[[[[[[[[a]]]]]]]]]]\nfn hundred(a) = ten(ten(ten(ten(ten(ten(ten(ten(ten(ten(a))))))))))\nfn more(a) = hundred(hundred(hundred(hundred(hundred(hundred(a))))))\nlet a = more(more(1))",
            "fn ten(a) = [[[[[[[[[[a]]]]]]]]]]\nfn hundred(a) = ten(ten(ten(ten(ten(ten(ten(ten(ten(ten(a))))))))))\nfn more(a) = hundred(hundred(hundred(hundred(hundred(hundred(a))))))\nlet a = more(1)",
        ],
    ),
    code(
        "E0702",
        "Something is understood but not carried out yet.",
        "Write the scene without it.",
        takes("it takes a program that offers less than `pss` does, built on its library."),
    ),
    code(
        "E0703",
        "There are too many of something.",
        "Lists end at a million elements.",
        ["let a = for i in 0..2000, j in 0..2000 { i }", "let a = for i in 0..20, j in 0..20 { i }"],
    ),
    code(
        "E0704",
        "There is no memory to read the scene.",
        "Close other programs.",
        takes("it takes a machine whose memory is full."),
    ),
    code(
        "E0705",
        "The scene is too large.",
        "Keep points in files of their own: `points(\"a.ply\")`.",
        takes("it takes a scene of more than 256 MB."),
    ),
    code(
        "E0706",
        "Functions call each other too deep.",
        "A recursion ends where a condition says so. A list is made by `for`, without recursion.",
        ["fn f(n) = n + f(n - 1)\nprint f(3)", "fn f(n) = if n == 0 { 0 } else { n + f(n - 1) }\nprint f(3)"],
    ),
    code(
        "E0707",
        "The picture is too large for the memory.",
        "Make it smaller, or render it in parts with `--crop`.",
        takes("it takes a machine with less memory than the picture needs."),
    ),
    code(
        "E0708",
        "A shape cannot be measured here.",
        "Ask in the scene itself, of a shape that can be prepared.",
        takes(
            "it takes a program that reads scenes and measures nothing, as an editor does while one types.",
        ),
    ),
    code(
        "E0709",
        "The scene takes too many steps.",
        "Does a recursion call itself more than once? Keep what it gives in a `let`.",
        [
            "fn f(n) = if n < 2 { n } else { f(n - 1) + f(n - 2) }\nprint f(60)",
            "fn f(n) = if n < 2 { n } else { f(n - 1) + f(n - 2) }\nprint f(10)",
        ],
    ),
    code(
        "E0710",
        "What the scene computes takes too much memory.",
        "Make shorter lists, or use one shape many times: `shape.array(list)`.",
        takes("it takes lists or shapes of 4 GiB."),
    ),
    code(
        "E0801",
        "An expectation is not met.",
        "The message gives both sides, and the bar of what was measured.",
        [
            "expect volume(box(size: 2)) ~= 6 within 1%\ndraw box(size: 2)",
            "expect volume(box(size: 2)) ~= 8 within 1%\ndraw box(size: 2)",
        ],
    ),
    code(
        "E0802",
        "`within` stands without a comparison.",
        "Write `expect a ~= b within 1%`.",
        ["expect 1 < 2 within 1%\ndraw sphere(r: 1)", "expect 1.001 ~= 1 within 1%\ndraw sphere(r: 1)"],
    ),
    code(
        "E0803",
        "Two pictures differ by more than is allowed.",
        "Look at both, and at `--diff FILE.png`; `--max X` allows so much.",
        [
            "$ pss render scene.pss -o a.png --size 8x8\n$ pss render scene.pss -o b.png --size 8x8 -D r=2\n$ pss compare a.png b.png\nparam r = 1\ncamera(eye: [0, -9, 0], look_at: [0, 0, 0])\ndraw sphere(r: r)",
            "$ pss render scene.pss -o a.png --size 8x8\n$ pss render scene.pss -o b.png --size 8x8 -D r=1\n$ pss compare a.png b.png\nparam r = 1\ncamera(eye: [0, -9, 0], look_at: [0, 0, 0])\ndraw sphere(r: r)",
        ],
    ),
    code(
        "E0804",
        "Two pictures have different sizes.",
        "Render both at one `--size`.",
        [
            "$ pss render scene.pss -o a.png --size 8x8\n$ pss render scene.pss -o b.png --size 8x9\n$ pss compare a.png b.png\ndraw sphere(r: 1)",
            "$ pss render scene.pss -o a.png --size 8x8\n$ pss render scene.pss -o b.png --size 8x8\n$ pss compare a.png b.png\ndraw sphere(r: 1)",
        ],
    ),
    code(
        "E0805",
        "A scene is not what its golden says.",
        "The message gives the first ray or pixel that differs, what was there and what is. If it is meant, `pss test --bless` makes it the golden.",
        [
            "$ pss test scene.pss --bless\n$ pss test scene.pss -D r=1.1\nparam r = 1\nrender(size: [8, 8], samples: 1)\ndraw sphere(r: r)\nexpect volume(sphere(r: 1)) ~= 4.18879 within 0.1%",
            "$ pss test scene.pss --bless\n$ pss test scene.pss -D r=1\nparam r = 1\nrender(size: [8, 8], samples: 1)\ndraw sphere(r: r)\nexpect volume(sphere(r: 1)) ~= 4.18879 within 0.1%",
        ],
    ),
    code(
        "E0806",
        "A file that lies where a golden goes is none.",
        "Remove what is broken, and `pss test --bless` writes it anew; move away what somebody rendered beside the scene.",
        [
            "$ pss test scene.pss\ndraw sphere(r: 1)\n--- scene.spans\nrays: many",
            "$ pss test scene.pss\ndraw sphere(r: 1)\n--- scene.txt\nrays: many",
        ],
    ),
    code(
        "E0900",
        "The program is wrong.",
        "This is a fault of pss, not of the scene; please report it.",
        takes("it takes a fault of the program."),
    ),
];
