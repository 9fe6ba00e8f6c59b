//! Amounts whose units stand in pieces, and amounts behind one another.

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::Unit;

use super::around::{Around, told};
use super::lex::TokenKind;

/// Tokens of an amount before the place, at most.
const AMOUNT: usize = 8;

/// Why the place cannot be read, if it is of such an amount.
pub(super) fn amount(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(AMOUNT);
    (first..around.at).rev().find_map(|i| spaced(around, i)).or_else(|| doubled(around))
}

/// `15 W m^-2 sr^-1`
fn spaced(around: &Around<'_>, number: usize) -> Option<Diagnostic> {
    if around.tokens[number].kind != TokenKind::Number {
        return None;
    }
    let (mut at, mut unit, mut n_units, mut has_powers) = (number + 1, String::new(), 0, false);
    while let Some(word) = around.tokens.get(at).filter(|t| !t.first_on_line) {
        if Unit::named(word.text).is_none() {
            break;
        }
        let (is_below, power, end) = power(around, at + 1);
        unit += match (n_units, is_below) {
            (0, _) => "",
            (_, true) => "/",
            (_, false) => "*",
        };
        unit += word.text;
        let sign = if is_below && n_units == 0 { "-" } else { "" };
        if let Some(power) = power.filter(|power| !sign.is_empty() || *power != "1") {
            unit.extend(["^", sign, power]);
        }
        has_powers |= power.is_some();
        (at, n_units) = (end, n_units + 1);
    }
    let is_field = matches!(around.word(at), "=" | "{" | ":");
    if n_units < 2 || !has_powers || at <= around.at || is_field {
        return None;
    }
    let all =
        Span::new(around.source, around.tokens[number + 1].start, around.tokens[at - 1].end());
    let found = Diagnostic::error("E0204", all, "a unit is written in one piece");
    Some(found.fix(all, unit))
}

/// Whether the power that stands at a place is below zero, its digits if there are any, and where it ends.
fn power<'a>(around: &Around<'a>, at: usize) -> (bool, Option<&'a str>, usize) {
    let is_whole = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    match [0, 1, 2].map(|k| around.word(at + k)) {
        ["^", "-", n] if is_whole(n) => (true, Some(n), at + 3),
        ["^", n, _] if is_whole(n) => (false, Some(n), at + 2),
        _ => (false, None, at),
    }
}

/// `5 cm 3 mm`
fn doubled(around: &Around<'_>) -> Option<Diagnostic> {
    let next = around.current().filter(|t| t.kind == TokenKind::Number && !t.first_on_line)?;
    let (unit, number) = (around.before(1)?, around.before(2)?);
    let measured = |word: &str| Unit::named(word).map(|unit| unit.dimension);
    let measure = measured(unit.text)?;
    let is_alike = measured(around.word(around.at + 1)) == Some(measure);
    let is_value = around.open.last().is_none_or(|open| around.word(*open) == "{");
    let is_it = number.kind == TokenKind::Number && is_alike && is_value;
    let gap = Span::new(around.source, unit.end(), next.start);
    let found = told(around.span(next), "amounts behind one another are added by `+`");
    is_it.then(|| found.guess(gap, " + "))
}
