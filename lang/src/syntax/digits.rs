//! Numbers that are none.

use luxel_core::diag::Diagnostic;

use super::around::Around;
use super::lex::{Token, TokenKind};
use super::number;

impl Around<'_> {
    /// `1.2.3`, `1e`, `5.`
    pub(super) fn number(&self) -> Option<Diagnostic> {
        if let Some(found) = self.other_base() {
            return Some(found);
        }
        let near = [self.current(), self.before(1)];
        let bad = near
            .into_iter()
            .flatten()
            .find(|t| t.kind == TokenKind::Number && number::parse(t.text.as_bytes()).is_none())?;
        let found = self.error("E0016", bad, format!("`{}` is not a number", bad.text));
        Some(match bad.text.strip_suffix('.') {
            Some(whole) => found.fix(self.span(bad), whole),
            None => found.help("a number is written as 12, 0.5, .5, 1_000 or 2.5e-3"),
        })
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
