//! Commas that are missing, and what is missing beside them.

use luxel_core::diag::{Diagnostic, Grade, Span};
use luxel_sdk::params::Unit;

use super::around::{Around, Place, is_category};
use super::explain::short;
use super::lex::{Token, TokenKind};
use crate::words::RESERVED;

impl Around<'_> {
    /// `(0, 1 2)`
    pub(super) fn missing_comma(&self) -> Option<Diagnostic> {
        let open = self.open.last().map(|i| self.tokens[*i].text)?;
        let (current, before) = (self.current()?, self.before(1)?);
        if open == "{" || !before.ends_operand() || !current.begins_operand() {
            return None;
        }
        let gap = Span::new(self.source, before.end(), before.end());
        let is_value = before.kind == TokenKind::Number || matches!(before.text, ")" | "]");
        if is_value && current.first_on_line && Unit::named(current.text).is_some() {
            let found = self.error("E0023", current, "a unit stands on the line of its number");
            return Some(found.guess(gap.to(self.span(current)), format!(" {}", current.text)));
        }
        // `scale 2` may be a call, and `x cos(a)` a product.
        let calls = self.word(self.at + 1) == "(";
        let may_call = before.kind == TokenKind::Word && (calls || current.kind != TokenKind::Word);
        let touches = before.end() == current.start;
        let grade = if may_call || touches { Grade::Guess } else { Grade::Sure };
        let message = format!("a comma is missing before `{}`", short(current.text));
        // `f(0.5 0.5)`
        let is_call = self.open.last().is_some_and(|open| {
            self.word(*open) == "(" && open.checked_sub(1).is_some_and(|i| self.is_word(i))
        });
        // `[3 mm, 4 4 mm]`
        let is_bare = Unit::named(self.word(self.at + 1)).is_some();
        let may_be_twice = before.kind == TokenKind::Word || is_call || is_bare || self.is_wide();
        if let Some(last) = self.again().filter(|_| may_be_twice) {
            let found = self.error("E0014", current, format!("{message}, or it stands here twice"));
            return Some(found.guess(gap.to(self.span(&self.tokens[last])), ""));
        }
        if self.is_reckoned() {
            let message =
                format!("an operator or a comma is missing before `{}`", short(current.text));
            return Some(self.error("E0014", current, message));
        }
        // `b c: int`: a type may be missing too.
        let is_typed = before.kind == TokenKind::Word && self.word(self.at + 1) == ":";
        let found = self.error("E0014", current, message);
        Some(if is_typed { found } else { found.mend(gap, ",", grade) })
    }

    /// The last token of a number, a word or words joined by dots that stands at the place as it does before it.
    fn again(&self) -> Option<usize> {
        let is_joined = |n: usize| self.before(n + 1).is_some_and(|token| token.text == ".");
        let n_before = (1..=self.at).step_by(2).find(|n| !is_joined(*n))?;
        let (before, here) = (&self.tokens[self.at - n_before..self.at], &self.tokens[self.at..]);
        let is_same =
            here.len() >= n_before && before.iter().zip(here).all(|(a, b)| a.text == b.text);
        (is_same && before[0].kind != TokenKind::Mark).then_some(self.at + n_before - 1)
    }

    /// Whether the innermost bracket holds one value, that is reckoned: `(12 9 * x) * 1 cm`.
    fn is_reckoned(&self) -> bool {
        let Some(open) = self.open.last().copied().filter(|open| self.word(*open) == "(") else {
            return false;
        };
        let reckons = |t: &Token<'_>| matches!(t.text, "+" | "-" | "*" | "/" | "^" | "%");
        let is_call = open > 0 && self.is_word(open - 1);
        !is_call && self.held(open).any(reckons) && self.held(open).all(|t| t.text != ",")
    }

    /// Whether with commas where they are missing more than three numbers would stand in the innermost bracket:
    /// vectors have so many.
    fn is_wide(&self) -> bool {
        let Some(open) = self.open.last().filter(|open| self.word(**open) == "(") else {
            return false;
        };
        let close = self.closing(*open).unwrap_or(self.tokens.len());
        let (mut depth, mut n) = (0_usize, 1);
        for i in open + 1..close {
            let (before, token) = (&self.tokens[i - 1], &self.tokens[i]);
            let is_gap = before.kind == TokenKind::Number && token.kind == TokenKind::Number;
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => n += usize::from(depth == 0 && (token.text == "," || is_gap)),
            }
        }
        n > 3
    }

    /// `roughness = 0 metallic = 1`: the word was read as the unit of what stands before it.
    pub(super) fn missing_field_comma(&self) -> Option<Diagnostic> {
        let (current, word, value) = (self.current()?, self.before(1)?, self.before(2)?);
        let is_field = current.text == "=" && word.kind == TokenKind::Word && !word.first_on_line;
        if !is_field || self.open.is_empty() || value.text == "}" || !value.ends_operand() {
            return None;
        }
        if !matches!(value.kind, TokenKind::Number | TokenKind::Table | TokenKind::Mark) {
            return None;
        }
        let gap = Span::new(self.source, value.end(), value.end());
        let grade = if Unit::named(word.text).is_some() { Grade::Guess } else { Grade::Sure };
        let message = format!("a comma is missing before `{}`", short(word.text));
        Some(self.error("E0014", word, message).mend(gap, ",", grade))
    }

    /// `radius = 1 m material white`: another field without what stands before it and in it.
    pub(super) fn missing_comma_and_equals(&self) -> Option<Diagnostic> {
        let first = self.at.saturating_sub(2).max(1);
        let i = (first..=self.at).find(|i| self.is_bare_field(*i));
        let i = i.filter(|_| self.inner() == Place::Fields)?;
        let (value, word, given) = (&self.tokens[i - 1], &self.tokens[i], &self.tokens[i + 1]);
        // `radius = widths widths[i]`
        if value.text == word.text {
            let found = self.error("E0023", word, format!("`{}` is written twice", word.text));
            return Some(found.guess(Span::new(self.source, value.end(), word.end()), ""));
        }
        // `size = 120 x 5 x 35 cm`
        let are_numbers = [i.wrapping_sub(2), i - 1]
            .iter()
            .any(|i| self.tokens.get(*i).is_some_and(|token| token.kind == TokenKind::Number));
        if word.text == "x" && are_numbers && given.kind == TokenKind::Number {
            let found = self.error("E0023", word, "a size is a vector");
            return Some(found.help("it is written `(1.2, 0.5, 3) m`"));
        }
        let message =
            format!("a comma is missing before `{0}`, and `=` behind it", short(word.text));
        let gap = Span::new(self.source, value.end(), given.start);
        // Two words after one another may be meant otherwise.
        let is_sure = is_category(word.text) || given.kind != TokenKind::Word;
        let grade = if is_sure { Grade::Sure } else { Grade::Guess };
        Some(self.error("E0014", word, message).mend(gap, format!(", {} = ", word.text), grade))
    }

    /// Whether token `i` is a word between two values, on their line.
    fn is_bare_field(&self, i: usize) -> bool {
        let (value, Some(word), Some(given)) =
            (&self.tokens[i - 1], self.tokens.get(i), self.tokens.get(i + 1))
        else {
            return false;
        };
        let before = i.checked_sub(2).map_or("", |i| self.word(i));
        let is_number = |i: Option<usize>| {
            i.and_then(|i| self.tokens.get(i)).is_some_and(|t| t.kind == TokenKind::Number)
        };
        // A word alone may be the name of what comes.
        let is_value = value.kind != TokenKind::Word
            || matches!(before, "=" | ")")
            || is_number(i.checked_sub(2));
        let has_unit = is_number(Some(i - 1)) || matches!(value.text, ")" | "]");
        let is_unit = has_unit && Unit::named(word.text).is_some();
        let is_name = word.kind == TokenKind::Word
            && !RESERVED.contains(&word.text)
            && !is_unit
            && !is_category(value.text);
        let is_apart = value.end() < word.start && !word.first_on_line && !given.first_on_line;
        let ends = value.ends_operand() && given.begins_operand() && given.text != "{";
        is_name && is_value && is_apart && ends
    }
}
