//! A plain division into tokens, for explaining mistakes: it accepts everything.

use std::ops::Range;

use crate::prescan::{block_comment, table};

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    Word,
    /// Digits, dots and an exponent: perhaps not a legal number.
    Number,
    /// A string, perhaps without its end.
    Text,
    /// A `#[…]` table.
    Table,
    /// A `///` line.
    Doc,
    /// An operator, a bracket, or anything else.
    Mark,
}

/// A token with its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token<'a> {
    pub(crate) kind: TokenKind,
    pub(crate) start: usize,
    pub(crate) text: &'a str,
    /// Whether a line begins between the token before and this one.
    pub(crate) first_on_line: bool,
}

impl Token<'_> {
    /// One past the last byte.
    pub(crate) fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// Whether it could begin an operand.
    pub(crate) fn begins_operand(&self) -> bool {
        match self.kind {
            TokenKind::Mark => matches!(self.text, "(" | "[" | "{"),
            TokenKind::Doc => false,
            TokenKind::Word => !matches!(self.text, "in" | "with" | "as" | "else"),
            _ => true,
        }
    }

    /// Whether it could end an operand.
    pub(crate) fn ends_operand(&self) -> bool {
        match self.kind {
            TokenKind::Mark => matches!(self.text, ")" | "]" | "}"),
            TokenKind::Doc => false,
            _ => true,
        }
    }

    /// Whether it wants something after it.
    pub(crate) fn is_operator(&self) -> bool {
        self.kind == TokenKind::Mark
            && !matches!(self.text, "(" | "[" | "{" | ")" | "]" | "}" | "," | ";" | ":")
    }
}

/// Every token of `text[range]`, comments left out.
pub(crate) fn tokens(text: &str, range: Range<usize>) -> impl Iterator<Item = Token<'_>> {
    let text = &text[..range.end];
    let mut at = range.start;
    std::iter::from_fn(move || next(text, &mut at))
}

fn next<'a>(text: &'a str, at: &mut usize) -> Option<Token<'a>> {
    let mut first_on_line = false;
    loop {
        let rest = &text[*at..];
        let c = rest.chars().next()?;
        let begins = |mark: &str| c == '/' && rest.starts_with(mark);
        let is_doc = begins("///") && !begins("////");
        // What else is blank to the eye is none to the grammar.
        if matches!(c, ' ' | '\t' | '\r' | '\n' | '\u{FEFF}') {
            first_on_line |= c == '\n';
            *at += c.len_utf8();
        } else if begins("//") && !is_doc {
            *at += rest.find('\n').unwrap_or(rest.len());
        } else if begins("/*") {
            let end = block_comment(rest.as_bytes()).unwrap_or(rest.len());
            first_on_line |= rest[..end].contains('\n');
            *at += end;
        } else {
            let (kind, length) = token(rest, c, is_doc);
            let start = *at;
            *at += length;
            return Some(Token { kind, start, text: &rest[..length], first_on_line });
        }
    }
}

fn token(rest: &str, c: char, is_doc: bool) -> (TokenKind, usize) {
    let span = |legal: fn(char) -> bool| rest.find(|c| !legal(c)).unwrap_or(rest.len());
    if is_doc {
        return (TokenKind::Doc, rest.find('\n').unwrap_or(rest.len()));
    }
    let is_table = rest.starts_with("#[");
    if let Some(length) = is_table.then(|| table(rest.as_bytes())).flatten() {
        return (TokenKind::Table, length);
    }
    let dotted = rest.starts_with('.') && rest[1..].starts_with(|c: char| c.is_ascii_digit());
    match c {
        'a'..='z' | 'A'..='Z' | '_' | 'µ' => {
            (TokenKind::Word, span(|c| c.is_ascii_alphanumeric() || c == '_' || c == 'µ'))
        }
        '0'..='9' => (TokenKind::Number, number(rest.as_bytes())),
        '.' if dotted => (TokenKind::Number, number(rest.as_bytes())),
        '"' => (TokenKind::Text, string(rest)),
        _ => {
            let known = ["..=", "..", "||", "&&", "==", "!=", "<=", ">=", "=>"];
            let may_be_long = matches!(c, '.' | '|' | '&' | '=' | '!' | '<' | '>');
            let mut marks = known.iter().filter(|_| may_be_long);
            let mark = marks.find(|mark| rest.starts_with(**mark));
            (TokenKind::Mark, mark.map_or(c.len_utf8(), |mark| mark.len()))
        }
    }
}

/// The length of what looks like a number, mistakes such as `1.2.3`, `1e` and `5.` included.
fn number(bytes: &[u8]) -> usize {
    let mut at = 0;
    loop {
        match bytes.get(at) {
            Some(b'0'..=b'9' | b'_') => at += 1,
            Some(b'.') if !bytes.get(at + 1).is_some_and(|b| is_range_or_member(*b)) => at += 1,
            Some(b'e' | b'E') => {
                let signed = matches!(bytes.get(at + 1), Some(b'+' | b'-'));
                let after = bytes.get(at + 1 + usize::from(signed));
                match after {
                    Some(b'0'..=b'9') => at += 1 + usize::from(signed),
                    Some(b) if b.is_ascii_alphabetic() => return at,
                    _ => return at + 1,
                }
            }
            _ => return at,
        }
    }
}

/// Whether after this byte a `.` is no part of a number: `0..4`, `0.name`.
fn is_range_or_member(after: u8) -> bool {
    after == b'.' || after == b'_' || after.is_ascii_alphabetic()
}

fn string(rest: &str) -> usize {
    let mut escaped = false;
    for (i, c) in rest.char_indices().skip(1) {
        match c {
            '\n' => return i,
            '"' if !escaped => return i + 1,
            _ => escaped = c == '\\' && !escaped,
        }
    }
    rest.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_numbers_are_one_token() {
        let text = "1.2.3 1e 5. 0..4 2e5 3em .5 6.x";
        let found: Vec<_> = tokens(text, 0..text.len()).map(|t| t.text).collect();
        let expected = ["1.2.3", "1e", "5.", "0", "..", "4", "2e5", "3", "em", ".5", "6", ".", "x"];
        assert_eq!(found, expected);
    }

    #[test]
    fn comments_are_left_out_and_lines_noted() {
        let text = "a /* x\n */ b /*/ c */ // c\n/// d";
        let found: Vec<_> =
            tokens(text, 0..text.len()).map(|t| (t.text, t.first_on_line)).collect();
        assert_eq!(found, [("a", false), ("b", true), ("/// d", true)]);
    }
}
