//! Calls without their round brackets, and what stands behind a call that moves it.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, told};
use super::lex::TokenKind;
use crate::words::RESERVED;

/// Functions of other languages that what stands behind them is moved by.
const MOVING: [&str; 6] = ["translate", "move", "rotate", "scale", "mirror", "multmatrix"];

/// Bytes before a call that are looked at for its function.
const NEAR: usize = 1 << 15;

/// Why the place cannot be read, if it is of such a call.
pub(super) fn call(around: &Around<'_>) -> Option<Diagnostic> {
    square(around).or_else(|| bare(around)).or_else(|| moved(around))
}

/// `ball[1 m]` as a statement, and `fn ball[x: length]`.
fn square(around: &Around<'_>) -> Option<Diagnostic> {
    let is_open = |i: &usize| around.word(*i) == "[";
    let closed = around.at.checked_sub(1).and_then(|close| around.opening(close));
    let open = [around.at, around.at + 1].into_iter().chain(closed).find(is_open)?;
    let start = open.checked_sub(1).filter(|start| around.is_word(*start))?;
    let is_head = start > 0 && around.word(start - 1) == "fn" && around.begins(start - 1);
    let is_call = around.begins(start) && is_function(around, start);
    let (first, last) = (&around.tokens[open], &around.tokens[around.closing(open)?]);
    let is_one = first.start == around.tokens[start].end() && matches!(last.text, "]" | ")");
    let all = around.span(first).to(around.span(last));
    let inner = &around.text[first.end()..last.start];
    let found = told(all, "what a function takes stands in round brackets");
    (is_one && (is_head || is_call)).then(|| found.guess(all, format!("({inner})")))
}

/// `ball 1 m` as a statement.
fn bare(around: &Around<'_>) -> Option<Diagnostic> {
    let start = around.statement();
    let (name, value) = (around.tokens.get(start)?, around.tokens.get(start + 1)?);
    let is_call = around.begins(start)
        && name.kind == TokenKind::Word
        && !RESERVED.contains(&name.text)
        && value.begins_operand()
        && !value.first_on_line
        && value.text != "{"
        && is_function(around, start);
    let rest = &around.tokens[start + 1..];
    let ends = |i: &usize| rest[*i].first_on_line || matches!(rest[*i].text, "}" | ";");
    let last = &rest[(1..rest.len()).find(ends).unwrap_or(rest.len()) - 1];
    let all = Span::new(around.source, name.end(), last.end());
    let given = &around.text[value.start..last.end()];
    let found = told(around.span(value), "what a function takes stands in brackets");
    is_call.then(|| found.guess(all, format!("({given})")))
}

/// Whether a function of the name at a place is defined before, not far from it.
fn is_function(around: &Around<'_>, name: usize) -> bool {
    let start = around.tokens[name].start;
    let text = &around.text.as_bytes()[start.saturating_sub(NEAR)..start];
    let head = format!("fn {}", around.word(name));
    let is_of_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    memchr::memmem::find_iter(text, &head)
        .any(|at| text.get(at + head.len()).is_none_or(|byte| !is_of_word(byte)))
}

/// `translate((0, 1, 0) m) sphere { … }`
fn moved(around: &Around<'_>) -> Option<Diagnostic> {
    let start = around.statement();
    let word = around.tokens.get(start).filter(|word| MOVING.contains(&word.text))?;
    let close = around.closing(start + 1).filter(|_| around.word(start + 1) == "(")?;
    let next = around.tokens.get(close + 1)?;
    let is_moved = next.kind == TokenKind::Word;
    let found = told(around.span(word), "what is moved says so itself");
    (is_moved && around.begins(start)).then(|| {
        found.help("it is written `shape sphere { radius = 1 m, transform = move((0, 1, 0) m) }`")
    })
}
