//! The codes of errors in what is held against something: expectations, pictures, goldens, and the program itself.

use super::{Code, code, takes};

/// In their order; they follow those of `errors`.
pub const CODES: &[Code] = &[
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
        "E0807",
        "A scene has goldens, or shall have, and expects no number of a shape.",
        "Let it expect what a formula knows of it, so that a wrong golden is seen: `expect volume(part) ~= 6.43 within 0.1%`. Numbers are asked by `volume`, `area`, `centroid`, `bounds` and `raycast`.",
        [
            "$ pss test scene.pss --bless\nrender(size: [8, 8], samples: 1)\ndraw sphere(r: 1)\nexpect 1 is 1",
            "$ pss test scene.pss --bless\nrender(size: [8, 8], samples: 1)\ndraw sphere(r: 1)\nexpect volume(sphere(r: 1)) ~= 4.18879 within 0.1%",
        ],
    ),
    code(
        "E0808",
        "A golden is gone and others of its scene are here, or the scene is.",
        "Bring back what was removed. Who means it removes the scene and all its goldens, or lets `pss test --bless` make those that are gone.",
        [
            "$ pss test .\ndraw sphere(r: 1)\n--- other.spans\npss spans 1",
            "$ pss test .\ndraw sphere(r: 1)\n--- other.txt\npss spans 1",
        ],
    ),
    code(
        "E0900",
        "The program is wrong.",
        "This is a fault of pss, not of the scene; please report it.",
        takes("it takes a fault of the program."),
    ),
];
