//! A text cut into pieces: tokens and comments, with what was between them.

use std::iter::Peekable;

use super::marks::Marks;
use super::table;
use crate::prescan::block_comment;
use crate::syntax::{Op, Token, TokenKind, tokens};

/// What a piece is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    /// A word of the language.
    Keyword,
    Number,
    Unit,
    Text,
    Table,
    Open,
    Close,
    /// Between items.
    Comma,
    /// The comma between the two names of a loop.
    Pair,
    /// Between statements or fields; shown where they share a line.
    Separator,
    Assign,
    Arrow,
    /// `±`
    PlusMinus,
    /// Between operands; how strongly it binds.
    Binary(u8),
    /// `..` and `..=`; how strongly they bind.
    Range(u8),
    /// A sign before an operand.
    Prefix,
    Dot,
    Colon,
    At,
    /// `// …`
    Line,
    /// `/// …`
    Doc,
    /// `/* … */`
    Block,
}

/// A token or a comment.
#[derive(Clone, Debug)]
pub(super) struct Piece<'a> {
    pub(super) text: &'a str,
    pub(super) kind: Kind,
    /// How many lines began since the piece before: 0, 1, or 2 for more.
    pub(super) newlines: u8,
    /// How many blanks stood before it on its line: 0, 1, or 2 for more.
    pub(super) blanks: u8,
    /// Whether a statement or a field begins with it.
    pub(super) starts: bool,
    /// Of a bracket: where its counterpart is.
    pub(super) mate: u32,
    /// Of an open bracket: whether its author broke the line in it. Of `{`: whether it must be broken.
    pub(super) broken: bool,
    /// Whether the line that its author began with it, amid an expression, is kept.
    pub(super) kept: bool,
    /// Columns.
    pub(super) width: u32,
    /// Blanks before it where all is on one line.
    pub(super) gap: u8,
    /// Blanks more, so that lines stand below each other.
    pub(super) pad: u16,
    /// Column at which it begins if all before were on one line.
    pub(super) at: u32,
    /// How many pieces before it do not fit on a line with others.
    pub(super) hard: u32,
}

impl Piece<'_> {
    pub(super) fn is_comment(&self) -> bool {
        matches!(self.kind, Kind::Line | Kind::Doc | Kind::Block)
    }

    pub(super) fn is_open(&self, bracket: &str) -> bool {
        self.kind == Kind::Open && self.text == bracket
    }

    pub(super) fn is_keyword(&self, word: &str) -> bool {
        self.kind == Kind::Keyword && self.text == word
    }

    /// Whether it takes several lines whatever stands around it.
    pub(super) fn is_long(&self) -> bool {
        match self.kind {
            Kind::Line | Kind::Doc => true,
            Kind::Block => self.text.contains('\n'),
            Kind::Table => table::is_long(self.text),
            _ => false,
        }
    }

    /// Whether it could end an operand.
    pub(super) fn ends_operand(&self) -> bool {
        use Kind::{Close, Number, Table, Text, Unit, Word};
        matches!(self.kind, Word | Number | Unit | Text | Table | Close)
    }
}

/// Words that no name can be where an operand stands.
const KEYWORDS: [&str; 18] = [
    "let", "param", "fn", "for", "if", "else", "include", "import", "use", "place", "set",
    "assert", "expect", "units", "with", "where", "as", "in",
];

/// The pieces of a text that can be read.
pub(super) fn pieces<'a>(text: &'a str, marks: &Marks) -> Vec<Piece<'a>> {
    let mut cutter = Cutter { text, marks, next_start: 0, at: 0, last: None, out: vec![] };
    // Where a statement begins, a token does: `m^2e = 3` is a unit and a field.
    let starts = marks.starts.iter().map(|at| *at as usize);
    let ends = starts.clone().chain([text.len()]);
    let parts = std::iter::once(0).chain(starts).zip(ends);
    let mut tokens = parts.flat_map(|(from, to)| tokens(text, from..to)).peekable();
    while let Some(token) = tokens.next() {
        cutter.token(token, &mut tokens);
    }
    cutter.gap(text.len());
    if cutter.last_kind() == Some(Kind::Comma) {
        cutter.drop_last();
    }
    cutter.out
}

struct Cutter<'a, 'm> {
    text: &'a str,
    marks: &'m Marks,
    next_start: usize,
    /// Up to where the text is cut.
    at: usize,
    /// The last piece that is no comment.
    last: Option<usize>,
    out: Vec<Piece<'a>>,
}

impl<'a> Cutter<'a, '_> {
    fn last_kind(&self) -> Option<Kind> {
        self.last.map(|at| self.out[at].kind)
    }

    fn push(&mut self, text: &'a str, kind: Kind, (newlines, blanks): (u8, u8)) {
        self.out.push(Piece {
            text,
            kind,
            newlines,
            blanks,
            starts: false,
            mate: 0,
            broken: false,
            kept: false,
            width: 0,
            gap: 0,
            pad: 0,
            at: 0,
            hard: 0,
        });
    }

    /// Cuts the comments before byte `end`; gives the lines and blanks after them.
    fn gap(&mut self, end: usize) -> (u8, u8) {
        let (mut newlines, mut blanks) = (0_u8, 0_u8);
        while self.at < end {
            let rest = &self.text[self.at..end];
            let length = match rest.as_bytes()[0] {
                b'\n' => {
                    (newlines, blanks) = ((newlines + 1).min(2), 0);
                    1
                }
                b'/' => {
                    let block = rest.starts_with("/*");
                    let end = if block {
                        block_comment(rest.as_bytes())
                    } else {
                        memchr::memchr(b'\n', rest.as_bytes())
                    };
                    let length = end.unwrap_or(rest.len());
                    let kind = if block { Kind::Block } else { Kind::Line };
                    self.push(rest[..length].trim_end(), kind, (newlines, blanks));
                    (newlines, blanks) = (0, 0);
                    length
                }
                // What is left is white space.
                _ => {
                    blanks = (blanks + 1).min(2);
                    rest.chars().next().map_or(1, char::len_utf8)
                }
            };
            self.at += length;
        }
        (newlines, blanks)
    }

    fn token(&mut self, token: Token<'a>, rest: &mut Peekable<impl Iterator<Item = Token<'a>>>) {
        let before = self.out.len();
        let gap = self.gap(token.start);
        let commented = self.out.len() > before;
        self.at = token.end();
        let starts = self.starts(&token);
        if token.kind == TokenKind::Doc {
            return self.push(token.text.trim_end(), Kind::Doc, gap);
        }
        if starts {
            self.separate();
        }
        let same_line = gap.0 == 0 && !commented && !starts;
        let kind = self.kind(&token, rest, same_line);
        if kind == Kind::Close && self.last_kind() == Some(Kind::Comma) && !self.is_single() {
            self.drop_last();
        }
        self.last = Some(self.out.len());
        self.push(&self.text[token.start..self.at], kind, gap);
        self.out.last_mut().expect("it was just pushed").starts = starts;
    }

    /// Whether a statement or field begins with the token; docs before it are not it.
    fn starts(&mut self, token: &Token<'_>) -> bool {
        let place = |at: &u32| *at as usize <= token.start;
        let mut starts = self.last.is_none();
        let mut next = self.next_start;
        while self.marks.starts.get(next).is_some_and(place) {
            (starts, next) = (true, next + 1);
        }
        if token.kind != TokenKind::Doc {
            self.next_start = next;
        }
        starts
    }

    /// Puts what separates two statements after the first.
    fn separate(&mut self) {
        let Some(last) = self.last else { return };
        match self.out[last].kind {
            Kind::Comma => self.out[last].kind = Kind::Separator,
            Kind::Open => {}
            _ => {
                self.push("", Kind::Separator, (0, 0));
                self.out[last + 1..].rotate_right(1);
            }
        }
    }

    /// Whether the last comma makes a vector of one item.
    fn is_single(&self) -> bool {
        let mut depth = 0_usize;
        let last = self.last.unwrap_or(0);
        for at in (0..last).rev() {
            match self.out[at].kind {
                Kind::Close => depth += 1,
                Kind::Open if depth == 0 => {
                    let before = self.out[..at].iter().rfind(|it| !it.is_comment());
                    return self.out[at].text == "(" && !before.is_some_and(Piece::ends_operand);
                }
                Kind::Open => depth -= 1,
                Kind::Comma if depth == 0 => return false,
                _ => {}
            }
        }
        false
    }

    /// Whether the last piece is the first name of a loop.
    fn follows_loop_name(&self) -> bool {
        let mut before = self.out.iter().rev().filter(|it| !it.is_comment()).skip(1);
        before.next().is_some_and(|it| it.is_keyword("for"))
    }

    fn drop_last(&mut self) {
        if let Some(last) = self.last {
            self.out.remove(last);
            self.last = self.out[..last].iter().rposition(|it| !it.is_comment());
        }
    }

    fn kind(
        &mut self,
        token: &Token<'a>,
        rest: &mut Peekable<impl Iterator<Item = Token<'a>>>,
        same_line: bool,
    ) -> Kind {
        let before = self.last.map(|at| &self.out[at]);
        match token.kind {
            TokenKind::Number => Kind::Number,
            TokenKind::Text => Kind::Text,
            TokenKind::Table => Kind::Table,
            // What stands for a type is one, whatever it is called.
            TokenKind::Word if before.is_some_and(|it| it.text == ":") => Kind::Word,
            // `a.else` names a member, however little that is one.
            TokenKind::Word if before.is_some_and(|it| it.kind == Kind::Dot) => Kind::Word,
            TokenKind::Word if KEYWORDS.contains(&token.text) => Kind::Keyword,
            // What is expected stands apart from its brackets.
            TokenKind::Word if before.is_some_and(|it| it.starts && it.text == "expect") => {
                Kind::Keyword
            }
            TokenKind::Word if before.is_some_and(|it| it.kind == Kind::At) => Kind::Keyword,
            TokenKind::Word => {
                let measured = |it: &Piece<'_>| {
                    matches!(it.kind, Kind::Number | Kind::Table)
                        || it.kind == Kind::Close && it.text != "}"
                };
                if same_line && before.is_some_and(measured) {
                    self.unit(rest);
                    return Kind::Unit;
                }
                Kind::Word
            }
            _ => self.mark(token, rest),
        }
    }

    /// Takes what else belongs to a unit: `W` is followed by `/m^2/sr`.
    fn unit(&mut self, rest: &mut Peekable<impl Iterator<Item = Token<'a>>>) {
        let marks = self.marks;
        loop {
            let at = self.at;
            let joins = |it: &Token<'_>| {
                it.start == at && matches!(it.text, "^" | "/" | "*") && !marks.is_binary(at)
            };
            let Some(joint) = rest.next_if(joins) else { return };
            self.at = joint.end();
            // An exponent may have a sign.
            let _ = rest.next_if(|it| it.start == at + 1 && it.text == "-");
            self.at = rest.next().map_or(joint.end(), |it| it.end());
        }
    }

    fn mark(
        &mut self,
        token: &Token<'a>,
        rest: &mut Peekable<impl Iterator<Item = Token<'a>>>,
    ) -> Kind {
        let binary = self.marks.is_binary(token.start);
        match token.text {
            "(" | "[" | "{" => Kind::Open,
            ")" | "]" | "}" => Kind::Close,
            "," if self.follows_loop_name() => Kind::Pair,
            "," | ";" => Kind::Comma,
            "=" => Kind::Assign,
            "=>" => Kind::Arrow,
            "." => Kind::Dot,
            ":" => Kind::Colon,
            "@" => Kind::At,
            "±" => Kind::PlusMinus,
            ".." | "..=" => Kind::Range(strength(token.text)),
            "+" if !binary => {
                let end = token.end();
                match rest.next_if(|it| it.start == end && it.text == "-") {
                    Some(minus) => {
                        self.at = minus.end();
                        Kind::PlusMinus
                    }
                    None => Kind::Prefix,
                }
            }
            operator if binary => Kind::Binary(strength(operator)),
            _ => Kind::Prefix,
        }
    }
}

fn strength(operator: &str) -> u8 {
    u8::try_from(Op::of(operator).strength()).unwrap_or(u8::MAX)
}
