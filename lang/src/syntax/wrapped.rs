//! Objects, functions and choices with what other languages set around them.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, is_category, told};
use super::lex::{Token, TokenKind};
use crate::words::STATEMENTS;

/// Words that elsewhere make an object.
const MAKING: [&str; 8] = ["add", "create", "def", "define", "draw", "insert", "make", "new"];

/// Words that elsewhere begin a choice among values.
const CHOOSING: [&str; 3] = ["match", "select", "switch"];

/// Tokens of the head of a choice, at most.
const HEAD: usize = 8;

/// Why the place cannot be read, if something stands around it that does elsewhere.
pub(super) fn wrapped(around: &Around<'_>) -> Option<Diagnostic> {
    made(around)
        .or_else(|| chosen(around))
        .or_else(|| dotted(around))
        .or_else(|| recorded(around))
        .or_else(|| valued_body(around).and_then(|brace| body(around, brace)))
}

/// `new shape sphere { … }`
fn made(around: &Around<'_>) -> Option<Diagnostic> {
    let is_made = |i: &usize| {
        let is_object = is_category(around.word(i + 1)) && around.is_word(i + 2);
        MAKING.contains(&around.word(*i)) && around.begins(*i) && is_object
    };
    let start = (around.at.saturating_sub(3)..=around.at).rev().find(is_made)?;
    let (word, next) = (&around.tokens[start], &around.tokens[start + 1]);
    let message = format!("an object stands where it is written, without `{}`", word.text);
    let gap = Span::new(around.source, word.start, next.start);
    (!next.first_on_line).then(|| told(around.span(word), message).fix(gap, ""))
}

/// The word that begins a choice of another language, `switch x { case 1: … }`, of which the place is a part.
pub(super) fn choice(around: &Around<'_>) -> Option<usize> {
    let begun = |at: usize| (at.saturating_sub(HEAD)..=at).rev().find(|i| around.begins(*i));
    let of_block = around.open.last().copied().filter(|open| around.word(*open) == "{");
    of_block.into_iter().chain([around.at]).filter_map(begun).find(|i| {
        let gives = matches!(around.word(i + 1), "=" | ":" | ".");
        CHOOSING.contains(&around.word(*i)) && !gives
    })
}

/// How a choice is written.
pub(super) const CHOICE: &str =
    "a choice is written `if x == 1 { … } else if x == 2 { … } else { … }`";

fn chosen(around: &Around<'_>) -> Option<Diagnostic> {
    let word = &around.tokens[choice(around)?];
    let found = told(around.span(word), format!("there is no `{}`", word.text));
    Some(found.help(CHOICE))
}

/// `material.diffuse { … }`
fn dotted(around: &Around<'_>) -> Option<Diagnostic> {
    let start = around.at.checked_sub(3).filter(|_| around.word(around.at) == "{")?;
    let [category, dot, kind] = around.tokens.get(start..around.at)? else { return None };
    let is_one = is_category(category.text) && dot.text == "." && kind.kind == TokenKind::Word;
    let begins = around.begins(start) || around.word(start - 1) == "=";
    let gap = Span::new(around.source, category.end(), kind.start);
    let message = format!("no `.` stands between `{}` and its kind", category.text);
    (is_one && begins).then(|| told(around.span(dot), message).fix(gap, " "))
}

/// `let bench = { shape sphere { … } }`
fn recorded(around: &Around<'_>) -> Option<Diagnostic> {
    let brace = *around.open.last().filter(|open| around.word(**open) == "{")?;
    let is_record = brace > 1 && around.word(brace - 1) == "=" && around.is_word(brace - 2);
    let at = around.at.checked_sub(1)?;
    let is_object = is_category(around.word(at))
        && around.begins(at)
        && around.is_word(at + 1)
        && around.word(at + 2) == "{";
    let gap = Span::new(around.source, around.tokens[brace].start, around.tokens[brace].start);
    let found = told(around.span(&around.tokens[brace]), "objects stand in a `group { … }`");
    (is_record && is_object).then(|| found.guess(gap, "group "))
}

/// The brace of `fn f(x: length) { x * 2 }`, in which one value stands.
pub(super) fn valued_body(around: &Around<'_>) -> Option<usize> {
    let first = around.tokens.iter().position(|t| t.kind != TokenKind::Doc)?;
    let brace = *around.open.first().filter(|open| around.word(**open) == "{")?;
    let is_body = around.word(first) == "fn" && brace > 0 && around.word(brace - 1) == ")";
    let inner = &around.tokens[brace + 1..around.closing(brace)?];
    let first = inner.first()?;
    let begins = first.begins_operand() || matches!(first.text, "-" | "!");
    let is_more = |t: &Token<'_>| t.first_on_line || matches!(t.text, "=" | "{" | ";" | ":");
    let is_step = is_category(first.text) || STATEMENTS.contains(&first.text);
    let is_step = is_step || first.text == "return";
    let is_value = begins && !is_step && !inner[1..].iter().any(is_more);
    (is_body && is_value).then_some(brace)
}

fn body(around: &Around<'_>, brace: usize) -> Option<Diagnostic> {
    let (open, close) = (&around.tokens[brace], &around.tokens[around.closing(brace)?]);
    let value = around.text[open.end()..close.start].trim();
    let name = around.tokens.iter().find(|t| t.text != "fn" && t.kind == TokenKind::Word)?;
    let message = format!("what `{}` gives stands behind `=`", name.text);
    let found = told(around.span(open), message);
    let all = around.span(open).to(around.span(close));
    Some(found.fix(all, format!("= {value}")))
}
