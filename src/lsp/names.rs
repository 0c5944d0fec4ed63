//! The names that a text binds and where each is known, found by its tokens: a text that is not complete yet has names too.
//! What the names are worth is not known here.

use std::ops::Range;

use crate::lang::{Token, TokenKind, is_keyword, item_ranges, tokens, unquoted};
use crate::source::Span;

/// How a name is bound.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// By `let`, in the file or in a block.
    Let,
    /// By `fn`.
    Function,
    /// By `param`.
    Param,
    /// By `material`.
    Material,
    /// By `import ... as`.
    Space,
    /// The label of a camera or a light, which is no name of the file.
    Label,
    /// By `for`.
    Variable,
    /// A parameter of the function whose `fn` is the token with this number.
    Formal(usize),
}

/// A name that is bound.
#[derive(Clone, Debug)]
pub struct Binding {
    /// How.
    pub kind: Kind,
    /// The number of its token.
    pub token: usize,
    /// Bytes of the name.
    pub name: Range<usize>,
    /// Bytes where it is known.
    pub scope: Range<usize>,
    /// The item it stands in.
    pub item: usize,
    /// Whether it is a name of the file.
    pub of_file: bool,
}

/// A file that is imported.
#[derive(Clone, Debug)]
pub struct Import {
    /// The file, as it was written.
    pub path: String,
    /// Bytes of the string.
    pub at: Range<usize>,
    /// Its name space.
    pub space: Option<String>,
}

/// An item: its bytes from the first to the last token, and the numbers of its tokens.
#[derive(Clone, Debug)]
pub struct Item {
    /// Bytes.
    pub range: Range<usize>,
    /// Tokens.
    pub tokens: Range<usize>,
    /// Bytes up to the next item.
    pub reach: Range<usize>,
}

/// A text, cut into tokens and items, and its names.
#[derive(Clone, Debug)]
pub struct Outline {
    /// The text.
    pub text: String,
    /// Its tokens.
    pub tokens: Vec<Token>,
    /// Its items.
    pub items: Vec<Item>,
    /// All names, in the order of the text but for those of functions' parameters.
    pub bindings: Vec<Binding>,
    /// What is imported.
    pub imports: Vec<Import>,
    /// For each token, how many brackets of its item are open around it.
    depths: Vec<usize>,
}

impl Outline {
    /// Reads a text.
    pub fn new(text: &str) -> Outline {
        let tokens = tokens(text);
        let items: Vec<Item> =
            item_ranges(text).into_iter().filter_map(|reach| item(&tokens, reach)).collect();
        let mut out = Outline {
            text: text.to_owned(),
            depths: vec![0; tokens.len()],
            tokens,
            items,
            bindings: Vec::new(),
            imports: Vec::new(),
        };
        for i in 0..out.items.len() {
            out.measure(out.items[i].tokens.clone());
            out.head(i);
            out.locals(i);
        }
        out
    }

    /// The characters of a token; nothing for one that is not there.
    pub fn word(&self, token: usize) -> &str {
        self.tokens.get(token).map_or("", |t| t.text(&self.text))
    }

    /// The characters of the token before another.
    pub fn before(&self, token: usize) -> &str {
        token.checked_sub(1).map_or("", |i| self.word(i))
    }

    /// The characters of a binding's name.
    pub fn name(&self, binding: &Binding) -> &str {
        &self.text[binding.name.clone()]
    }

    /// What a name means at a byte: the innermost binding.
    pub fn find(&self, name: &str, at: usize) -> Option<&Binding> {
        let known = self.known(at).filter(|b| self.name(b) == name);
        // Of names bound twice the first stands.
        known.reduce(|best, b| if best.scope.start < b.scope.start { b } else { best })
    }

    /// All bindings that are known at a byte.
    pub fn known(&self, at: usize) -> impl Iterator<Item = &Binding> {
        let holds = move |scope: &Range<usize>| scope.start <= at && at <= scope.end;
        self.bindings.iter().filter(move |b| b.kind != Kind::Label && holds(&b.scope))
    }

    /// A name of the file that it does not import.
    pub fn own(&self, name: &str) -> Option<&Binding> {
        self.owned().find(|b| self.name(b) == name)
    }

    /// All names of the file that it does not import.
    pub fn owned(&self) -> impl Iterator<Item = &Binding> {
        self.bindings.iter().filter(|b| b.of_file && !matches!(b.kind, Kind::Space | Kind::Label))
    }

    /// The parameters of what a binding names; empty where it is no function.
    pub fn formals(&self, binding: &Binding) -> Vec<&Binding> {
        let begins = match binding.kind {
            Kind::Function => binding.token.checked_sub(1),
            Kind::Let => Some(binding.token + 2).filter(|i| self.word(*i) == "fn"),
            _ => None,
        };
        let of = |b: &&Binding| begins.is_some_and(|begins| b.kind == Kind::Formal(begins));
        self.bindings.iter().filter(of).collect()
    }

    /// How many brackets of its item are open around a token.
    pub fn depth(&self, token: usize) -> usize {
        self.depths.get(token).copied().unwrap_or(0)
    }

    fn is_word(&self, token: usize) -> bool {
        self.tokens.get(token).is_some_and(|t| t.kind == TokenKind::Word)
    }

    fn measure(&mut self, range: Range<usize>) {
        let mut depth = 0_usize;
        for i in range {
            let kind = self.tokens[i].kind;
            depth = if kind == TokenKind::Close { depth.saturating_sub(1) } else { depth };
            self.depths[i] = depth;
            depth += usize::from(kind == TokenKind::Open);
        }
    }

    /// The name that an item binds in the file.
    fn head(&mut self, item: usize) {
        let Range { start, end } = self.items[item].tokens;
        let kind = match self.word(start) {
            "let" => Kind::Let,
            "fn" => Kind::Function,
            "param" => Kind::Param,
            "material" => Kind::Material,
            "camera" | "light" => Kind::Label,
            "import" => return self.import(item),
            _ => return,
        };
        if start + 1 < end {
            self.bind(kind, start + 1, 0..self.text.len(), item, true);
        }
    }

    fn import(&mut self, item: usize) {
        let Range { start, end } = self.items[item].tokens;
        let Some(string) = self.tokens[start..end].get(1).filter(|t| t.kind == TokenKind::Text) else {
            return;
        };
        let at = string.range();
        let path = unquoted(string.text(&self.text), Span::default()).unwrap_or_default();
        let named = start + 3 < end && self.word(start + 2) == "as" && self.is_word(start + 3);
        let space = named.then(|| self.word(start + 3).to_owned());
        if named {
            self.bind(Kind::Space, start + 3, 0..self.text.len(), item, true);
        }
        self.imports.push(Import { path, at, space });
    }

    /// The names of blocks, loops and functions within an item.
    fn locals(&mut self, item: usize) {
        let Range { start, end } = self.items[item].tokens;
        for i in start..end {
            match self.word(i) {
                "let" if start < i => self.local(Kind::Let, i + 1, item),
                "in" if start + 2 <= i && matches!(self.before(i - 1), "for" | ",") => {
                    self.local(Kind::Variable, i - 1, item);
                }
                "fn" => self.parameters(i, item),
                _ => {}
            }
        }
    }

    /// A name that is known from its place to the end of what is around it.
    fn local(&mut self, kind: Kind, token: usize, item: usize) {
        if token < self.items[item].tokens.end {
            let scope = self.tokens[token].start()..self.closing(token, item, false);
            self.bind(kind, token, scope, item, false);
        }
    }

    /// The parameters of the function that begins with a token.
    fn parameters(&mut self, begins: usize, item: usize) {
        let Item { tokens: Range { start, end }, reach, .. } = self.items[item].clone();
        let opens = if begins == start { begins + 2 } else { begins + 1 };
        if self.word(opens) != "(" || end <= opens {
            return;
        }
        let depth = self.depth(opens);
        let scope_end = if begins == start { reach.end } else { self.closing(begins, item, true) };
        let within = (opens + 1..end).take_while(|i| depth < self.depth(*i));
        let first = |i: &usize| self.depth(*i) == depth + 1 && matches!(self.before(*i), "(" | ",");
        for i in within.filter(first).collect::<Vec<_>>() {
            let scope = self.tokens[i].start()..scope_end;
            self.bind(Kind::Formal(begins), i, scope, item, false);
        }
    }

    /// The byte where the bracket around a token closes, or the list element it stands in ends; that of the item where there
    /// is none.
    fn closing(&self, token: usize, item: usize, at_comma: bool) -> usize {
        let Item { tokens: Range { end, .. }, reach, .. } = &self.items[item];
        let depth = self.depth(token);
        let comma = |i: &usize| at_comma && self.depth(*i) == depth && self.word(*i) == ",";
        let ends = (token + 1..*end).find(|i| self.depth(*i) < depth || comma(i));
        ends.map_or(reach.end, |i| self.tokens[i].start())
    }

    fn bind(&mut self, kind: Kind, token: usize, scope: Range<usize>, item: usize, of_file: bool) {
        if self.is_word(token) && !is_keyword(self.word(token)) {
            let name = self.tokens[token].range();
            self.bindings.push(Binding { kind, token, name, scope, item, of_file });
        }
    }
}

fn item(tokens: &[Token], reach: Range<usize>) -> Option<Item> {
    let first = tokens.partition_point(|t| t.start() < reach.start);
    let past = tokens.partition_point(|t| t.start() < reach.end);
    let (start, end) = (tokens.get(first)?, tokens.get(past.checked_sub(1)?)?);
    Some(Item { range: start.start()..end.end(), tokens: first..past, reach })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The line of what the last `name` of a text means.
    fn meant(text: &str, name: &str) -> Option<usize> {
        let outline = Outline::new(text);
        let found = outline.find(name, text.rfind(name)?)?;
        Some(text[..found.name.start].matches('\n').count())
    }

    #[test]
    fn the_innermost_binding_is_meant() {
        assert_eq!(meant("let a = 1\nfn f(a) =\na", "a"), Some(1));
        assert_eq!(meant("let a = 1\nfn f(\na) = 2\nlet b = a", "a"), Some(0));
        assert_eq!(meant("let i = 1\nlet b = for\ni in 0..3 {\n i }", "i"), Some(2));
        assert_eq!(meant("let b = for\ni in 0..3,\nk in 0..i { [k, i,\nk] }", "k"), Some(2));
        assert_eq!(meant("let x = 1\nlet b = [fn(\nx) => x, x]", "x"), Some(0));
        assert_eq!(meant("let b = {\nlet c = 1\nc }", "c"), Some(1));
        assert_eq!(meant("let b = {\nlet c = 1\nc }\nlet d = c", "c"), None);
        assert_eq!(meant("camera c(eye: 1)\nlet d = c", "c"), None);
    }

    #[test]
    fn texts_that_are_not_complete_have_names() {
        assert_eq!(meant("let a = sphere(r:\nlet b = a", "a"), Some(0));
        assert_eq!(meant("fn f(r, h) = cylinder(r: r, h: h", "h"), Some(0));
        assert_eq!(Outline::new("import \"a\\\"b.pss\" as m let").imports[0].path, "a\"b.pss");
        let outline = Outline::new("let f = fn(a, b = [1, 2]) => a");
        assert_eq!(outline.formals(&outline.bindings[0]).len(), 2);
    }
}
