//! Declarations: what can be called in a scene, with which arguments. The language, the help and the
//! documentation read these tables; the rooms that build the things write them, one line a thing.

/// What a declared thing is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Group {
    /// A shape.
    Primitive,
    /// A material: `material name(kind: ...)` or its short form.
    Material,
    /// The `camera` item.
    Camera,
    /// The `light` item.
    Light,
    /// The `render` item.
    Render,
}

/// The type an argument must have.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Kind {
    /// Any finite number.
    Number,
    /// A whole number in a range, both ends allowed.
    Int(i64, i64),
    /// A number of scene units; any sign.
    Length,
    /// A length above zero; zero is allowed with a warning (the shape is nothing), a negative one is an error.
    Size,
    /// A length above zero; zero is an error.
    Width,
    /// A length above zero, or three of them.
    SizeOrVector,
    /// A number above zero.
    Positive,
    /// An angle.
    Angle,
    /// A colour.
    Color,
    /// A vector of so many numbers.
    Vector(usize),
    /// A list of points, each of three numbers.
    Points,
    /// One of these words, the first being the default.
    Choice(&'static [&'static str]),
    /// A list of these words.
    Choices(&'static [&'static str]),
    /// True or false.
    Bool,
    /// A file.
    Path,
    /// A file or a solid.
    PathOrSolid,
    /// A linear condition on x, y, z.
    HalfSpace,
    /// A list of points in a plane, or several such lists.
    Outline,
    /// A number, or two.
    NumberOrPair,
    /// A condition on x, y, z.
    Condition,
    /// A solid.
    Solid,
    /// A length or one of these words.
    LengthOr(&'static [&'static str]),
}

/// One argument.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// The name before the colon.
    pub name: &'static str,
    /// Its type.
    pub kind: Kind,
    /// Whether it may be given by place, in the order of the table.
    pub by_place: bool,
    /// Whether the call is wrong without it. (Where one of several is needed, the builder says so.)
    pub required: bool,
    /// A short description: the unit, the default.
    pub doc: &'static str,
}

impl Param {
    /// An optional argument given by name.
    pub const fn named(name: &'static str, kind: Kind, doc: &'static str) -> Param {
        Param { name, kind, by_place: false, required: false, doc }
    }

    /// A needed argument given by name.
    pub const fn required(name: &'static str, kind: Kind, doc: &'static str) -> Param {
        Param { name, kind, by_place: false, required: true, doc }
    }

    /// An optional argument that may be given by place.
    pub const fn placed(name: &'static str, kind: Kind, doc: &'static str) -> Param {
        Param { name, kind, by_place: true, required: false, doc }
    }
}

/// Something that can be called.
#[derive(Clone, Copy, Debug)]
pub struct Decl {
    /// The word.
    pub word: &'static str,
    /// What it is.
    pub group: Group,
    /// One sentence.
    pub doc: &'static str,
    /// Its arguments.
    pub params: &'static [Param],
    /// A call that works, for help and tests.
    pub example: &'static str,
}

/// Everything that can be called, gathered from the rooms that build it.
#[derive(Clone, Debug, Default)]
pub struct Catalog {
    /// The declarations.
    pub decls: Vec<Decl>,
}

impl Catalog {
    /// The declaration with this word in a group.
    pub fn find(&self, group: Group, word: &str) -> Option<&Decl> {
        self.decls.iter().find(|d| d.group == group && d.word == word)
    }

    /// The words of a group.
    pub fn words(&self, group: Group) -> impl Iterator<Item = &'static str> + '_ {
        self.decls.iter().filter(move |d| d.group == group).map(|d| d.word)
    }
}

/// Why a call cannot be built: which argument, what is wrong, and the way out.
#[derive(Clone, PartialEq, Debug)]
pub struct BuildError {
    /// The argument; empty for the call as a whole.
    pub param: &'static str,
    /// One sentence, no final stop.
    pub message: String,
    /// The way out.
    pub help: String,
}
