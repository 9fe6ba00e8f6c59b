//! Forms of other languages: brackets where braces stand here, and what is not done here at all.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, Place, SHORT, is_category, told};
use super::lex::TokenKind;

/// What is said of a group whose members do not stand in braces.
const GROUPED: &str = "what stands in a group stands between `{` and `}`";

/// Why a form near the place cannot be read, if other languages have it.
pub(super) fn borrowed(around: &Around<'_>) -> Option<Diagnostic> {
    own_type(around)
        .or_else(|| taken_apart(around))
        .or_else(|| nested_table(around))
        .or_else(|| slice(around))
        .or_else(|| changed(around))
        .or_else(|| bracketed_group(around))
        .or_else(|| spread(around))
        .or_else(|| moved(around))
        .or_else(|| behind_brace(around))
}

/// With braces for the round or square brackets that open with a token, behind what stands before them, and with
/// `=` for the `:` in them.
pub(super) fn in_braces(
    around: &Around<'_>,
    found: Diagnostic,
    before: usize,
    open: usize,
) -> Diagnostic {
    let is_open = matches!(around.word(open), "(" | "[");
    let close = around.closing(open).filter(|close| is_open && *close < around.tokens.len());
    let Some(close) = close.map(|close| &around.tokens[close]) else { return found };
    let all = Span::new(around.source, around.tokens[before].end(), close.end());
    let mut inner = String::new();
    let mut start = around.tokens[open].end();
    for colon in around.held(open).filter(|token| token.text == ":") {
        let before = &around.text[start..colon.start];
        inner += before;
        inner += if before.ends_with(char::is_whitespace) { "=" } else { " =" };
        start = colon.end();
    }
    inner += &around.text[start..close.start];
    let inner = inner.trim();
    let blank = if inner.is_empty() { "" } else { " " };
    let braces = format!(" {{{blank}{inner}{blank}}}");
    if braces.len() <= SHORT { found.guess(all, braces) } else { found }
}

/// Whether the bracket that opens with a token holds values, and a name of none.
pub(super) fn holds_bare_values(around: &Around<'_>, open: usize) -> bool {
    let is_empty = around.closing(open) == Some(open + 1);
    !is_empty && around.held(open).all(|token| !matches!(token.text, "=" | ":"))
}

/// `group [ shape sphere { } ]`
fn bracketed_group(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(3);
    let may_begin = |i: usize| around.begins(i) || around.word(i - 1) == "=";
    let is_group = |i: &usize| around.word(*i) == "group" && may_begin(*i);
    let start = (first..around.at).rev().find(is_group)?;
    let label = around.tokens.get(start + 1).is_some_and(|t| t.kind == TokenKind::Text);
    let open = start + 1 + usize::from(label);
    if !matches!(around.word(open), "(" | "[") || around.tokens[open].first_on_line {
        return None;
    }
    let found = around.error("E0023", &around.tokens[open], GROUPED);
    let has_comma = around.held(open).any(|token| token.text == ",");
    Some(if has_comma { found } else { in_braces(around, found, open - 1, open) })
}

/// `red with reflectance = 0.5` and `red with (reflectance = 0.5)`
fn changed(around: &Around<'_>) -> Option<Diagnostic> {
    let (with, next) = (around.before(1)?, around.current()?);
    if with.text != "with" || next.first_on_line || around.before(2).is_none() {
        return None;
    }
    let found = around.error("E0023", next, "what is changed stands between `{` and `}`");
    if next.text == "(" {
        return Some(in_braces(around, found, around.at - 1, around.at));
    }
    if next.kind != TokenKind::Word || around.word(around.at + 1) != "=" {
        return None;
    }
    let rest = &around.text[next.start..around.end];
    let is_end = |(_, c): &(usize, char)| matches!(c, '\n' | '{' | ';' | '/');
    let end = rest.char_indices().take(SHORT).find(is_end);
    let end = end.map(|(at, _)| at).or_else(|| (rest.len() < SHORT).then_some(rest.len()));
    let line = end.filter(|_| around.open.is_empty()).map(|end| rest[..end].trim_end());
    let all = |line: &str| Span::new(around.source, next.start, next.start + line.len());
    Some(match line {
        Some(line) => found.guess(all(line), format!("{{ {line} }}")),
        None => found,
    })
}

/// `let (a, b) = (1, 2)`
fn taken_apart(around: &Around<'_>) -> Option<Diagnostic> {
    let (word, open) = (around.before(1)?, around.current()?);
    let is_let = word.text == "let" && around.begins(around.at - 1);
    if !is_let || !matches!(open.text, "(" | "[") {
        return None;
    }
    let close = around.closing(around.at).filter(|close| around.word(close + 1) == "=")?;
    let span = around.span(open).to(around.span(&around.tokens[close]));
    let help = "an element is taken out by its index, counted from 0: `let a = pair[0]`";
    Some(told(span, "`let` names one value").help(help))
}

/// `#[ [1 2] [3 4] ]`
fn nested_table(around: &Around<'_>) -> Option<Diagnostic> {
    let is_table = |open: &usize| {
        around.word(*open) == "[" && open.checked_sub(1).is_some_and(|i| around.word(i) == "#")
    };
    let open = (0..=around.at).rev().filter(is_table).find(|open| around.word(open + 1) == "[")?;
    let inner = &around.tokens[open + 1];
    let found =
        around.error("E0018", inner, "a table is one list of numbers, without brackets in it");
    let close = around.closing(open).filter(|close| *close < around.tokens.len());
    let Some(close) = close.map(|close| &around.tokens[close]) else { return Some(found) };
    let all = Span::new(around.source, inner.start, close.start);
    let bare = around.text[inner.start..close.start].replace(['[', ']', '(', ')'], "");
    Some(if bare.len() <= SHORT { found.guess(all, bare) } else { found })
}

/// `sizes[0:2]`
fn slice(around: &Around<'_>) -> Option<Diagnostic> {
    let (open, colon) = (*around.open.last()?, around.current()?);
    let is_index = around.word(open) == "[" && open > 0 && around.tokens[open - 1].ends_operand();
    let help = "a part of a list is made by a loop: `[for i in 0..2 => sizes[i]]`";
    let found = around.error("E0023", colon, "an index takes one element out of a list");
    (is_index && colon.text == ":" && !around.tokens[open].first_on_line).then(|| found.help(help))
}

/// Words with which other languages define types.
const TYPES_OF_OWN: [&str; 7] =
    ["class", "enum", "interface", "record", "struct", "type", "typedef"];

/// `struct P { x: float }`
pub(super) fn own_type(around: &Around<'_>) -> Option<Diagnostic> {
    let i = around.tokens.iter().position(|t| t.kind != TokenKind::Doc)?;
    let word = &around.tokens[i];
    let is_one = TYPES_OF_OWN.contains(&word.text) && around.is_word(i + 1) && around.at > i + 1;
    let found = around.error("E0023", word, format!("`{}` begins no statement", word.text));
    let help = "a scene has no types of its own; values that belong together are a record: \
                `let p = { x = 1, y = 2 }`";
    is_one.then(|| found.help(help))
}

/// `{ ...red, reflectance = 0.5 }`
fn spread(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(2);
    let dots = (first..=around.at).find(|i| around.word(*i) == "..")?;
    let brace = dots.checked_sub(1).filter(|brace| around.word(*brace) == "{")?;
    let name = dots + 1 + usize::from(around.word(dots + 1) == ".");
    let close = around.closing(brace).filter(|close| *close < around.tokens.len())?;
    if !around.is_word(name) {
        return None;
    }
    let help = format!("what is as `{0}` else is `{0} with {{ … }}`", around.word(name));
    let found = around.error("E0023", &around.tokens[dots], "no fields are spread here").help(help);
    let rest = &around.text[around.tokens[name].end()..around.tokens[close].start];
    let rest = rest.trim().trim_start_matches(',').trim();
    let all = around.span(&around.tokens[brace]).to(around.span(&around.tokens[close]));
    let mended = format!("{} with {{ {rest} }}", around.word(name));
    Some(if mended.len() <= SHORT { found.guess(all, mended) } else { found })
}

/// Functions that move, and would stand before what they move.
const MOVES: [&str; 5] = ["move", "rotate", "scale", "spin", "translate"];

/// `translate([2, 0, 0]) shape sphere { }`
fn moved(around: &Around<'_>) -> Option<Diagnostic> {
    let i = around.tokens.iter().position(|t| t.kind != TokenKind::Doc)?;
    let word = &around.tokens[i];
    if !MOVES.contains(&word.text) || around.word(i + 1) != "(" {
        return None;
    }
    let close = around.closing(i + 1)?;
    let is_one = is_category(around.word(close + 1)) && around.at <= close + 1;
    let help = "it stands in it: `shape sphere { transform = move((2, 0, 0) m) }`";
    let found = around.error("E0023", word, "what moves an object is its `transform`").help(help);
    is_one.then_some(found)
}

/// `shape sphere { radius = 1 m } material = red`
fn behind_brace(around: &Around<'_>) -> Option<Diagnostic> {
    let (name, brace) = (around.current()?, around.before(1)?);
    let is_field = name.kind == TokenKind::Word && around.word(around.at + 1) == "=";
    if brace.text != "}" || !is_field || name.first_on_line {
        return None;
    }
    let open = around.opening(around.at - 1)?;
    let message = format!("`{}` stands behind the `}}` that ends the parameters", name.text);
    let found = around.error("E0023", name, message).label(around.span(brace), "they end here");
    let is_object = around.within(open) == Place::Fields;
    is_object.then(|| found.help("it stands before it, behind a comma"))
}
