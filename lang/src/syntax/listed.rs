//! Lists as other languages write them: what they are made of first, and blanks for commas.

use luxel_core::diag::{Diagnostic, Grade, Span};

use super::around::{Around, told};
use super::head::is_defined;
use super::lex::{Token, TokenKind};

/// Bytes of a list that are written once more for a mend.
const SHORT: usize = 200;

/// Why the place cannot be read, if it is in such a list.
pub(super) fn listed(around: &Around<'_>) -> Option<Diagnostic> {
    comprehension(around).or_else(|| blanks(around)).or_else(|| indices(around))
}

/// `[x * 2 for x in 0..4]`
fn comprehension(around: &Around<'_>) -> Option<Diagnostic> {
    let word = around.current().filter(|word| word.text == "for")?;
    let open = *around.open.last().filter(|open| around.word(**open) == "[")?;
    let last = around.before(1).filter(|last| last.ends_operand())?;
    let message = "what a list is made of stands behind its `for`";
    let found = Diagnostic::error("E0023", around.span(word), message);
    let inside =
        around.closing(open).map(|end| around.tokens[open].end()..around.tokens[end].start);
    let Some(inside) = inside.filter(|inside| inside.len() <= SHORT) else {
        return Some(found.help("it is written `[for x in 0..4 => x * 2]`"));
    };
    if around.held(open).filter(|token| token.text == "for").count() > 1 {
        let help = "a list for each is written `[for x in 0..4 => [for y in 0..4 => x * y]]`";
        return Some(found.help(help));
    }
    let value = &around.text[inside.start..last.end()];
    let over = around.text[word.start..inside.end].trim_end();
    let all = Span::new(around.source, inside.start, inside.end);
    Some(found.guess(all, format!("{over} => {}", value.trim_start())))
}

/// `[1 2 3]`, and `[1 -2 3]`: with commas where they are missing it would be read as `[1 - 2, 3]`.
fn blanks(around: &Around<'_>) -> Option<Diagnostic> {
    let current = around.current().filter(|token| token.kind == TokenKind::Number)?;
    let open = *around.open.last().filter(|open| matches!(around.word(**open), "[" | "("))?;
    let inside = &around.tokens[open + 1..around.closing(open)?];
    let is_minus = |token: &Token<'_>| token.text == "-";
    let is_number = |token: &Token<'_>| token.kind == TokenKind::Number;
    let are_numbers = inside.iter().enumerate().all(|(i, token)| {
        let next = inside.get(i + 1).filter(|next| is_number(next) && next.start == token.end());
        is_number(token) || is_minus(token) && next.is_some()
    });
    let has_signs = inside.windows(3).any(|of| {
        let [before, minus, number] = of else { return false };
        let is_apart = before.end() < minus.start && minus.end() == number.start;
        is_number(before) && is_minus(minus) && is_apart
    });
    // Where one comma is missing it is told by itself.
    if !are_numbers || !has_signs && inside.len() < 3 {
        return None;
    }
    let message = format!("a comma is missing before `{}`", current.text);
    let found = around.error("E0014", current, message);
    let all = Span::new(around.source, inside.first()?.start, inside.last()?.end());
    if all.range().len() > SHORT {
        return has_signs.then_some(found);
    }
    let mut numbers = String::new();
    for (i, token) in inside.iter().enumerate() {
        let is_signed = i > 0 && is_minus(&inside[i - 1]);
        numbers += if i == 0 || is_signed { "" } else { ", " };
        numbers += token.text;
    }
    Some(found.mend(all, numbers, if has_signs { Grade::Guess } else { Grade::Sure }))
}

/// `rgb.srgb[0.8, 0.7, 0.6]` and `heights[0, 1]`
fn indices(around: &Around<'_>) -> Option<Diagnostic> {
    around.current().filter(|comma| comma.text == ",")?;
    let open = *around.open.last().filter(|open| around.word(**open) == "[")?;
    let word = around.tokens.get(open.checked_sub(1)?)?;
    if word.kind != TokenKind::Word || word.end() != around.tokens[open].start {
        return None;
    }
    let close = around.closing(open)?;
    let inside = around.tokens[open].end()..around.tokens[close].start;
    let all = around.span(&around.tokens[open]).to(around.span(&around.tokens[close]));
    let [first, rest @ ..] = &around.tokens[open + 1..close] else { return None };
    if let ([comma, last], true) = (rest, is_defined(around, word.text)) {
        let found = told(around.span(comma), "one number stands between `[` and `]`");
        let both = Span::new(around.source, first.end(), last.start);
        return Some(
            found.help("what is in a list of a list is written `a[0][1]`").guess(both, "]["),
        );
    }
    let found = Diagnostic::error("E0023", all, "a function is called with `(` and `)`");
    let is_short = inside.len() <= SHORT;
    Some(if is_short { found.guess(all, format!("({})", &around.text[inside])) } else { found })
}
