//! The codes of warnings and remarks.

use super::{Code, code};

/// In their order.
pub const CODES: &[Code] = &[
    code(
        "W0101",
        "A size is zero: the shape is nothing.",
        "Give it a size, or leave it out.",
        ["draw sphere(r: 0)", "draw sphere(r: 1)"],
    ),
    code(
        "W0102",
        "A file was read, but not all of it is as it should be.",
        "The message says what was dropped or mended.",
        [
            "draw points(\"scan.ply\")\n--- scan.ply\nply\nformat ascii 1.0\nelement vertex 10\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n0 1 0\n0 2 0\n1 0 0\n1 1 0\n1 2 0\n2 0 0\n2 1 0\n2 2 0\nnan 0 0",
            scan!("draw points(\"scan.ply\")"),
        ],
    ),
    code(
        "W0103",
        "The points of a scan are too coarse for their spacing, so far from the origin.",
        "Export the cloud in double precision, or nearer to the origin.",
        [
            "draw points(\"scan.ply\")\n--- scan.ply\nply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nend_header\n10000000 10000000 0\n10000000 10000002 0\n10000000 10000004 0\n10000002 10000000 0\n10000002 10000002 0\n10000002 10000004 0\n10000004 10000000 0\n10000004 10000002 0\n10000004 10000004 0",
            "draw points(\"scan.ply\")\n--- scan.ply\nply\nformat ascii 1.0\nelement vertex 9\nproperty double x\nproperty double y\nproperty double z\nend_header\n10000000.3 10000000.3 0\n10000000.3 10000002.3 0\n10000000.3 10000004.3 0\n10000002.3 10000000.3 0\n10000002.3 10000002.3 0\n10000002.3 10000004.3 0\n10000004.3 10000000.3 0\n10000004.3 10000002.3 0\n10000004.3 10000004.3 0",
        ],
    ),
    code(
        "W0104",
        "A scan is noisier than its surface smooths.",
        "Raise `smoothing:`.",
        [
            "draw points(sphere(r: 1), samples: 400, noise: 0.15)",
            "draw points(sphere(r: 1), samples: 400, noise: 0.08)",
        ],
    ),
    code(
        "W0105",
        "Walls of a scan are thinner than its surface resolves.",
        "Lower `smoothing:`, or scan more densely.",
        ["draw points(sphere(r: [1, 1, 0.08]), samples: 2000)", "draw points(sphere(r: 1), samples: 2000)"],
    ),
    code(
        "W0106",
        "Normals of a scan contradict each other.",
        "Try `normals: \"estimate\"`.",
        [
            "draw points(\"scan.ply\")\n--- scan.ply\nply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n0 0 0 0 0 -1\n0 1 0 0 0 1\n0 2 0 0 0 -1\n1 0 0 0 0 1\n1 1 0 0 0 -1\n1 2 0 0 0 1\n2 0 0 0 0 -1\n2 1 0 0 0 1\n2 2 0 0 0 -1",
            "draw points(\"scan.ply\")\n--- scan.ply\nply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n0 0 0 0 0 1\n0 1 0 0 0 1\n0 2 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n1 2 0 0 0 1\n2 0 0 0 0 1\n2 1 0 0 0 1\n2 2 0 0 0 1",
        ],
    ),
    code(
        "W0107",
        "The width of a scan's surface holds very many samples: rays take long.",
        "Lower `smoothing:` or `h:`, or leave out what is sparse beside dense samples.",
        ["draw points(sphere(r: 1), samples: 1500, h: 0.9)", "draw points(sphere(r: 1), samples: 1500)"],
    ),
    code(
        "W0121",
        "Faces of two shapes coincide.",
        "Nothing is wrong with that; if a cut shall go through, let the cutter stand out of what it cuts.",
        [
            "draw box([0, 0, 0], [4, 4, 2]) - cylinder(r: 1, from: [2, 2, 0], to: [2, 2, 2])",
            "draw box([0, 0, 0], [4, 4, 2]) - cylinder(r: 1, from: [2, 2, -1], to: [2, 2, 3])",
        ],
    ),
    code(
        "W0122",
        "A cutter cuts nothing.",
        "Move it to where it meets what it shall cut, or leave it out.",
        [
            "draw sphere(r: 1) - sphere(r: 1, at: [5, 0, 0])",
            "draw sphere(r: 1) - sphere(r: 1, at: [1, 0, 0])",
        ],
    ),
    code(
        "W0123",
        "What is drawn is nothing.",
        "Do its parts meet? Does a cutter take all?",
        [
            "draw sphere(r: 1) & sphere(r: 1, at: [5, 0, 0])",
            "draw sphere(r: 1) & sphere(r: 1, at: [1, 0, 0])",
        ],
    ),
    code(
        "W0124",
        "The base of a difference lies wholly inside its cutters.",
        "Make the cutter smaller; what both hold is written `a & b`.",
        ["draw box(size: 1) - sphere(r: 2)", "draw box(size: 1) - sphere(r: 0.6)"],
    ),
    code(
        "W0125",
        "What is left, or open, between shapes is too thin to be meant.",
        "Let the one stand out of the other, or reach into it.",
        [
            "draw box([0, 0, 0], [4, 4, 2]) - box([1, 1, 0.000000001], [3, 3, 3])",
            "draw box([0, 0, 0], [4, 4, 2]) - box([1, 1, -1], [3, 3, 3])",
        ],
    ),
    code(
        "W0126",
        "The insides of two solids drawn overlap.",
        "Move one of them, or draw them as one: `draw a | b`.",
        [
            "draw sphere(r: 1)\ndraw sphere(r: 1, at: [1, 0, 0])",
            "draw sphere(r: 1) | sphere(r: 1, at: [1, 0, 0])",
        ],
    ),
    code(
        "W0127",
        "A shape is nothing: no line meets it.",
        "Look at its sizes; a formula may hold nowhere in its bounds.",
        [
            "draw sphere(r: 1) | implicit(x**2 < -1, inside: box(size: 4))",
            "draw sphere(r: 1) | implicit(x**2 < 1, inside: box(size: 4))",
        ],
    ),
    code(
        "W0128",
        "A comparison is closer than what was measured tells.",
        "It is taken to be what the numbers say, which may be wrong; compare with room for the bar of error.",
        [
            "let v = volume(sphere(r: 1) | sphere(r: 1, at: [1, 0, 0]))\nprint v == 9 * pi / 4",
            "let v = volume(sphere(r: 1) | sphere(r: 1, at: [1, 0, 0]))\nprint v < 9 * pi / 4 + 0.01",
        ],
    ),
    code(
        "W0201",
        "A name hides what the language calls so.",
        "Take another name.",
        ["let sphere = 3", "let ball = 3"],
    ),
    code(
        "W0202",
        "A number is so small that it is read as 0.",
        "Choose smaller units.",
        ["let a = 1e-400", "let a = 1e-300"],
    ),
    code(
        "W0203",
        "The scene draws nothing: its picture is the background.",
        "Draw something: `draw sphere(r: 1)`.",
        [
            "$ pss render scene.pss --size 8x6\nlet ball = sphere(r: 1)",
            "$ pss render scene.pss --size 8x6\nlet ball = sphere(r: 1)\ndraw ball",
        ],
    ),
    code(
        "W0204",
        "What is kept of a stopped render is given up, damaged, or cannot be kept.",
        "With `--resume` a render goes on where it was stopped; without, it begins anew.",
        [
            "$ pss render scene.pss -o a.png --size 8x6 --quiet --time-limit 0\n$ pss render scene.pss -o a.png --size 8x6\ndraw sphere(r: 1)",
            "$ pss render scene.pss -o a.png --size 8x6 --quiet --time-limit 0\n$ pss render scene.pss -o a.png --size 8x6 --resume\ndraw sphere(r: 1)",
        ],
    ),
    code(
        "W0205",
        "A channel of a colour is above 1.",
        "The channels of `rgb` are linear and reach from 0 to 1; write bytes as `#ff8000`.",
        ["let a = rgb(255, 128, 0)", "let a = #ff8000"],
    ),
    code(
        "W0207",
        "A scene has no golden, and other scenes of its folder have.",
        "Bring back what was removed, or `pss test --bless` makes goldens of what the scene is now.",
        [
            "$ pss test scene.pss\ndraw sphere(r: 1)\n--- other.spans\npss spans 1",
            "$ pss test scene.pss\ndraw sphere(r: 1)\n--- other.txt\npss spans 1",
        ],
    ),
];
