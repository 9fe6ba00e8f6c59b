//! Loops as other languages write them.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, told};
use super::lex::{TokenKind, tokens};

/// Why the head of a loop near the place cannot be read, if it is another language's.
pub(super) fn loops(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(2);
    let starts = (first..=around.at).rev().filter(|i| around.begins(*i) && around.is_word(*i));
    starts
        .filter(|i| around.word(i + 1) != "=")
        .find_map(|start| {
            endless(around, start)
                .or_else(|| each(around, start))
                .or_else(|| bracketed(around, start))
                .or_else(|| over_nothing(around, start))
                .or_else(|| given(around, start))
        })
        .or_else(|| several(around))
        .or_else(|| nameless(around))
}

/// `for in xs { … }` and `[for in xs => 1]`
fn nameless(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(2);
    let start = (first..=around.at).find(|i| around.word(*i) == "for")?;
    let (word, next) = (&around.tokens[start], around.tokens.get(start + 1)?);
    let value = around.tokens.get(start + 2)?;
    let goes_on = value.begins_operand() && !value.first_on_line && value.text != "in";
    if next.text != "in" || !goes_on {
        return None;
    }
    let both = around.span(word).to(around.span(next));
    let found = told(both, "a name is missing between `for` and `in`");
    Some(found.help("of each turn it is the value: `for i in 0..10`"))
}

/// `for x in xs, y in ys { … }`
fn several(around: &Around<'_>) -> Option<Diagnostic> {
    let comma = around.current().filter(|comma| comma.text == ",")?;
    let start = (0..around.at).rev().find(|i| around.begins(*i))?;
    // A comma ends what was read, not what was meant.
    let mut rest = tokens(around.text, comma.end()..around.text.len());
    let is_next = rest.nth(1).is_some_and(|word| word.text == "in");
    let found = told(around.span(comma), "a loop runs over one range or list");
    let help = "loops stand in one another: `for x in 0..3 { for y in 0..3 { … } }`";
    (around.word(start) == "for" && is_next).then(|| found.help(help))
}

/// `while true { … }`
fn endless(around: &Around<'_>, start: usize) -> Option<Diagnostic> {
    let (word, next) = (&around.tokens[start], around.tokens.get(start + 1)?);
    if !matches!(word.text, "while" | "until") || next.first_on_line {
        return None;
    }
    let found = told(around.span(word), format!("`{}` begins no loop", word.text));
    Some(found.help("a loop runs over a range or a list: `for i in 0..10 { … }`"))
}

/// `foreach ball in balls { … }`
fn each(around: &Around<'_>, start: usize) -> Option<Diagnostic> {
    let word = &around.tokens[start];
    let named = around.is_word(start + 1) && around.word(start + 2) == "in";
    let found = told(around.span(word), "a loop begins with `for`");
    (word.text == "foreach" && named).then(|| found.fix(around.span(word), "for"))
}

/// `for (i in 0..9) { … }`
fn bracketed(around: &Around<'_>, start: usize) -> Option<Diagnostic> {
    let close = around.closing(start + 1).filter(|_| around.word(start) == "for")?;
    let (open, end) = (around.tokens.get(start + 1)?, &around.tokens[close]);
    let has_in = around.is_word(start + 2) && around.word(start + 3) == "in";
    if open.text != "(" || !has_in || around.word(close + 1) != "{" {
        return None;
    }
    let all = around.span(open).to(around.span(end));
    let found = told(all, "no brackets stand around the head of a loop");
    let inner = around.text[open.end()..end.start].trim();
    Some(found.fix(
        all,
        if open.start == around.tokens[start].end() {
            format!(" {inner}")
        } else {
            inner.to_owned()
        },
    ))
}

/// `for i 0..9 { … }` and `for i of 0..9 { … }`
fn over_nothing(around: &Around<'_>, start: usize) -> Option<Diagnostic> {
    let (name, next) = (around.tokens.get(start + 1)?, around.tokens.get(start + 2)?);
    let is_loop = around.word(start) == "for" && name.kind == TokenKind::Word;
    let goes_on = next.begins_operand() && !next.first_on_line && name.end() < next.start;
    let end = (start + 2..around.tokens.len()).find(|i| around.word(*i) == "{")?;
    let is_whole = around.tokens[start..end].iter().all(|t| !matches!(t.text, "in" | "="));
    let is_whole = is_whole && next.text != ",";
    if !is_loop || !goes_on || next.text == "{" || !is_whole {
        return None;
    }
    // `for i of 0..9`
    let value = around.tokens.get(start + 3)?;
    let is_word = next.kind == TokenKind::Word && next.end() < value.start;
    if is_word && value.begins_operand() && value.text != "{" {
        let message = format!("`in` stands between `{}` and what it runs over", name.text);
        return Some(told(around.span(next), message).fix(around.span(next), "in"));
    }
    let message = format!("`in` is missing between `{}` and what it runs over", name.text);
    let gap = Span::new(around.source, name.end(), name.end());
    Some(told(around.span(next), message).fix(gap, " in"))
}

/// `for i = 0..9 { … }`
fn given(around: &Around<'_>, start: usize) -> Option<Diagnostic> {
    let sign = around.tokens.get(start + 2).filter(|_| around.word(start) == "for")?;
    let is_named = around.is_word(start + 1) && matches!(sign.text, "=" | ":");
    let end = (start..around.tokens.len()).find(|i| around.word(*i) == "{")?;
    let is_range = (start..end).any(|i| matches!(around.word(i), ".." | "..="));
    let gap = Span::new(around.source, around.tokens[start + 1].end(), sign.end());
    let found = told(around.span(sign), "`in` stands between a name and what it runs over");
    (is_named && is_range).then(|| found.fix(gap, " in"))
}
