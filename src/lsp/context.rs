//! What stands around a place of a text: the call it is an argument of, what is expected there.

use super::names::{Binding, Kind, Outline};
use crate::lang::TokenKind;

/// What is called.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Callee<'t> {
    /// A function, a solid or a material, by its name.
    Function(&'t str),
    /// A function of a name space.
    Member(&'t str, &'t str),
    /// A method.
    Method(&'t str),
    /// An item, by its keyword.
    Item(&'t str),
    /// Nothing: these are the parameters of a function.
    Formals,
}

impl Outline {
    /// The word at a byte, or that ends there.
    pub fn word_at(&self, at: usize) -> Option<usize> {
        let i = self.tokens.partition_point(|t| t.end() < at);
        let holds = |i: &usize| {
            self.tokens.get(*i).is_some_and(|t| t.kind == TokenKind::Word && t.start() <= at && at <= t.end())
        };
        [i, i + 1].into_iter().find(holds)
    }

    /// The innermost bracket of an item that is open before a token.
    pub fn open_before(&self, token: usize) -> Option<usize> {
        let past = self.items.partition_point(|item| item.tokens.start < token);
        let item = &self.items[past.checked_sub(1)?];
        let mut open = Vec::new();
        for i in item.tokens.start..token.min(item.tokens.end) {
            match self.tokens[i].kind {
                TokenKind::Open => open.push(i),
                TokenKind::Close => drop(open.pop()),
                _ => {}
            }
        }
        open.pop()
    }

    /// What is called by the parenthesis with a number.
    pub fn callee(&self, open: usize) -> Option<Callee<'_>> {
        let named = open.checked_sub(1).filter(|_| self.word(open) == "(")?;
        let name = Some(self.word(named)).filter(|_| self.tokens[named].kind == TokenKind::Word)?;
        match self.before(named) {
            "." if self.before_is_space(named) => Some(Callee::Member(self.before(named - 1), name)),
            "." => Some(Callee::Method(name)),
            "fn" => Some(Callee::Formals),
            item @ ("camera" | "light" | "material") => Some(Callee::Item(item)),
            _ if name == "fn" => Some(Callee::Formals),
            _ if matches!(name, "camera" | "light" | "render" | "units") => Some(Callee::Item(name)),
            _ => Some(Callee::Function(name)),
        }
    }

    /// Whether a token stands where a type does: after the colon of a parameter.
    pub fn is_type(&self, token: usize) -> bool {
        if self.before(token) != ":" {
            return false;
        }
        match self.open_before(token) {
            Some(open) => self.callee(open) == Some(Callee::Formals),
            None => token.checked_sub(3).is_some_and(|param| self.word(param) == "param"),
        }
    }

    /// Whether a word that follows a point is a name of an imported file.
    pub fn before_is_space(&self, word: usize) -> bool {
        word.checked_sub(2).is_some_and(|space| self.space_at(space).is_some())
    }

    /// The name space that a word names.
    pub fn space_at(&self, word: usize) -> Option<&Binding> {
        let token = self.tokens.get(word).filter(|_| self.before(word) != ".")?;
        self.find(self.word(word), token.start()).filter(|b| b.kind == Kind::Space)
    }

    /// Whether a byte lies in a comment; no token holds it.
    pub fn in_comment(&self, at: usize) -> bool {
        let before = self.tokens.partition_point(|t| t.end() <= at);
        let start = before.checked_sub(1).map_or(0, |i| self.tokens[i].end());
        let mut rest = &self.text[start..at];
        while let Some(opens) = rest.find('/') {
            let (closes, length) = if rest[opens..].starts_with("//") { ("\n", 1) } else { ("*/", 2) };
            match rest.get(opens + 2..).and_then(|inside| inside.find(closes)) {
                Some(closes) => rest = &rest[opens + 2 + closes + length..],
                None => return true,
            }
        }
        false
    }

    /// The string that a byte stands in, closed or not.
    pub fn text_at(&self, at: usize) -> Option<usize> {
        let i = self.tokens.partition_point(|t| t.end() < at);
        let token = self.tokens.get(i).filter(|t| t.start() < at)?;
        let within = match token.kind {
            TokenKind::OpenText => true,
            TokenKind::Text => at < token.end(),
            _ => false,
        };
        within.then_some(i)
    }

    /// Whether a byte stands in something that is written letter by letter: a string, a number, a colour, a comment.
    pub fn is_literal_at(&self, at: usize) -> bool {
        use TokenKind::{Color, Number, OpenComment, OpenText, Text};
        let i = self.tokens.partition_point(|t| t.end() < at);
        let within = self.tokens.get(i).is_some_and(|t| match t.kind {
            Number | Color | OpenText | OpenComment => t.start() < at,
            Text => t.start() < at && at < t.end(),
            _ => false,
        });
        within || self.in_comment(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The callee at the end of a text.
    fn called(text: &str) -> String {
        let outline = Outline::new(text);
        let open = outline.open_before(outline.tokens.len());
        open.and_then(|open| outline.callee(open)).map_or(String::new(), |callee| format!("{callee:?}"))
    }

    #[test]
    fn the_innermost_open_call_is_meant() {
        assert_eq!(called("draw sphere(r: max(1, 2), "), "Function(\"sphere\")");
        assert_eq!(called("draw sphere(r: max(1, "), "Function(\"max\")");
        assert_eq!(called("draw a.move([1, 2"), "");
        assert_eq!(called("draw a.scale(2).move("), "Method(\"move\")");
        assert_eq!(called("import \"a.pss\" as m draw m.f("), "Member(\"m\", \"f\")");
        assert_eq!(called("light sun("), "Item(\"light\")");
        assert_eq!(called("fn f("), "Formals");
        assert_eq!(called("draw sphere(r: 1)"), "");
    }

    #[test]
    fn comments_and_strings_are_told_from_code() {
        let text = "a // b\nc /* d */ e \"f\" 1";
        let literal: String = text
            .char_indices()
            .filter(|(i, c)| c.is_alphanumeric() && Outline::new(text).is_literal_at(i + 1) && *c != ' ')
            .map(|(_, c)| c)
            .collect();
        assert_eq!(literal, "bdf1");
    }
}
