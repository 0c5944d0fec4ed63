//! The codes of messages: what each tells, how it comes about, and a scene that shows it beside its repair.

/// A scene with a cloud `scan.ply` of nine points beside it.
macro_rules! scan {
    ($scene:literal) => {
        concat!(
            $scene,
            "\n--- scan.ply\nply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
            "0 0 0\n0 1 0\n0 2 0\n1 0 0\n1 1 0\n1 2 0\n2 0 0\n2 1 0\n2 2 0"
        )
    };
}

mod errors;
mod judged;
mod warnings;

/// What a code means.
#[derive(Clone, Copy, Debug)]
pub struct Code {
    /// The code.
    pub code: &'static str,
    /// What it tells, one sentence.
    pub told: &'static str,
    /// How it comes about, and what helps.
    pub why: &'static str,
    /// A scene that is told so; empty where it takes more than a scene on a page: a full disk, a fault. First lines
    /// `$ pss ...` are commands of which the last tells (else `pss check scene.pss`), and a line `--- NAME` begins another
    /// file.
    pub bad: &'static str,
    /// The same scene, repaired; where there is none, what it takes.
    pub good: &'static str,
}

impl Code {
    /// All that is known of it, as text.
    pub fn page(&self) -> String {
        let indented =
            |scene: &str| scene.lines().map(|line| format!("        {line}\n")).collect::<String>();
        let mut out = format!("{}: {}\n\n    {}\n", self.code, self.told, self.why);
        if self.bad.is_empty() {
            out += &format!("\n    No scene on a page is told so: {}\n", self.good);
        } else {
            out += &format!("\n    Told of\n\n{}\n    Not of\n\n{}", indented(self.bad), indented(self.good));
        }
        out
    }
}

const fn code(
    code: &'static str,
    told: &'static str,
    why: &'static str,
    [bad, good]: [&'static str; 2],
) -> Code {
    Code { code, told, why, bad, good }
}

/// No scene shows it, as it takes something else.
const fn takes(what: &'static str) -> [&'static str; 2] {
    ["", what]
}

/// All codes: errors, then warnings, each in their order.
pub fn all() -> impl Iterator<Item = &'static Code> {
    errors::CODES.iter().chain(judged::CODES).chain(warnings::CODES)
}
