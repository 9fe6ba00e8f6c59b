//! Numbers that are none.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, Place};
use super::lex::{Token, TokenKind};
use super::number;

impl Around<'_> {
    /// `1.2.3`, `1e`, `5.`
    pub(super) fn number(&self) -> Option<Diagnostic> {
        if let Some(found) = self.other_base() {
            return Some(found);
        }
        // Of `1e m` the letter was read as a unit.
        let begun = self.before(2).filter(|t| t.text.ends_with(['e', 'E']));
        let near = [self.current(), self.before(1), begun];
        let bad = near
            .into_iter()
            .flatten()
            .find(|t| t.kind == TokenKind::Number && number::parse(t.text.as_bytes()).is_none())?;
        if let Some(found) = self.dotted(bad).or_else(|| self.parted(bad)) {
            return Some(found);
        }
        let found = self.error("E0016", bad, format!("`{}` is not a number", bad.text));
        Some(match bad.text.strip_suffix('.') {
            Some(whole) => found.fix(self.span(bad), whole),
            None => found.help("a number is written as 12, 0.5, .5, 1_000 or 2.5e-3"),
        })
    }

    /// `(0.1. 0.2)`, `(0. -2)`, `{ radius = 3. height = 1 m }`
    fn dotted(&self, bad: &Token<'_>) -> Option<Diagnostic> {
        let at = self.tokens.iter().position(|token| token.start == bad.start)?;
        let next = self.tokens.get(at + 1).filter(|next| !next.first_on_line)?;
        let whole = bad.text.strip_suffix('.').filter(|_| !self.open.is_empty())?;
        number::parse(whole.as_bytes())?;
        let dot = Span::new(self.source, bad.end() - 1, bad.end());
        let found = comma_for(dot);
        let is_field = next.kind == TokenKind::Word && self.word(at + 2) == "=";
        if whole.contains('.') || is_field {
            return next.begins_operand().then(|| found.fix(dot, ","));
        }
        let is_apart = matches!(next.text, "-" | "(" | "[") && next.start > bad.end();
        is_apart.then(|| found.guess(dot, ","))
    }

    /// `center = (0, 1, 0) m. radius = 1 m`
    pub(super) fn dot_before_field(&self) -> Option<Diagnostic> {
        let (dot, end) = (self.before(1).filter(|dot| dot.text == ".")?, self.before(2)?);
        let is_field = self.is_word(self.at) && self.word(self.at + 1) == "=";
        let is_it = is_field && end.ends_operand() && self.inner() == Place::Fields;
        is_it.then(|| comma_for(self.span(dot)).fix(self.span(dot), ","))
    }

    /// `0. 75` and `0. .75`
    fn parted(&self, bad: &Token<'_>) -> Option<Diagnostic> {
        let at = self.tokens.iter().position(|token| token.start == bad.start)?;
        let next = self.tokens.get(at + 1).filter(|next| next.kind == TokenKind::Number)?;
        let whole = bad.text.strip_suffix('.')?;
        let part = next.text.strip_prefix('.').unwrap_or(next.text);
        let is_part = part.bytes().all(|byte| byte.is_ascii_digit());
        if next.first_on_line || !is_part || number::parse(whole.as_bytes()).is_none() {
            return None;
        }
        let both = self.span(bad).to(self.span(next));
        let found = Diagnostic::error("E0016", both, "there is no blank in a number");
        Some(found.guess(both, format!("{whole}.{part}")))
    }

    /// `0xff`, `0b101`, `0o17`
    fn other_base(&self) -> Option<Diagnostic> {
        let other = |first: &Token<'_>, next: &Token<'_>| {
            let radix = match next.text.get(..1).filter(|_| first.text == "0")? {
                "x" | "X" => 16,
                "b" | "B" => 2,
                "o" | "O" => 8,
                _ => return None,
            };
            let value = u64::from_str_radix(&next.text[1..], radix).ok();
            value.filter(|_| first.end() == next.start)
        };
        let mut pairs = self.tokens[self.at.saturating_sub(3)..].windows(2).take(4);
        pairs.find_map(|pair| {
            let value = other(&pair[0], &pair[1])?;
            let span = self.span(&pair[0]).to(self.span(&pair[1]));
            let message = "numbers are written with the digits 0 to 9";
            Some(Diagnostic::error("E0016", span, message).fix(span, value.to_string()))
        })
    }
}

/// A dot where a comma is meant.
fn comma_for(dot: Span) -> Diagnostic {
    Diagnostic::error("E0014", dot, "a comma is missing: a `.` stands in its place")
}
