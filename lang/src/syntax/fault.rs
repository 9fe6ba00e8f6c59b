//! What does not close, in words, and what mends it.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, SourceId, Span};

use super::around::is_category;
use super::closing::indent;
use super::lex::{Token, TokenKind, tokens};
use crate::prescan::{Fault, opens_object};
use crate::words::OF_A_NUMBER;

/// The function whose arguments are mostly named, and their names.
const LOOK_AT: (&str, [&str; 3]) = ("look_at", ["from", "to", "up"]);

/// Brackets that a message shows.
const SHOWN: usize = 8;

/// Bytes in brackets that are looked at for what they were to be: of many that nest, each is.
const LOOKED_AT: usize = 1 << 10;

/// Bytes of a line behind a bracket that are looked at for another that closes the same.
const REST: usize = 256;

/// The blanks with which the line of a byte begins.
fn indent_of(text: &str, at: usize) -> &str {
    let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
    &text[line..line + indent(&text[line..])]
}

/// What most likely mends a bracket that closes nothing, or another one than the last that opened: which bytes
/// become what.
pub(super) fn mend(text: &str, fault: &Fault) -> Option<(Range<usize>, &'static str)> {
    let closing = |open: usize| match text.as_bytes()[open] {
        b'(' => ")",
        b'[' => "]",
        _ => "}",
    };
    match fault {
        Fault::Stray { at } => Some((*at..at + 1, "")),
        Fault::Unclosed { open } => {
            doubled(text, *open).map(|again| (again..again + 1, "")).or_else(|| {
                let end = numbers(text, *open).or_else(|| before_block(text, *open))?;
                Some((end..end, closing(*open)))
            })
        }
        Fault::Mismatch { open, .. }
            if text[..*open].ends_with('#') && !text[*open..].starts_with('[') =>
        {
            Some((*open..open + 1, "["))
        }
        Fault::Mismatch { open, at, left: 0 }
            if is_call(text, *open..*at) || is_among_vectors(text, *open..*at) =>
        {
            Some((*open..open + 1, "("))
        }
        Fault::Mismatch { open, at, left: 0 }
            if text[*at..].starts_with('}')
                && (opens_object(text.as_bytes(), *open) || is_of_choice(text, *open..*at)) =>
        {
            Some((*open..open + 1, "{"))
        }
        Fault::Mismatch { open, at, left: 0 } if is_closed_later(text, *at, closing(*open)) => None,
        Fault::Mismatch { open, at, left: 0 } => Some((*at..at + 1, closing(*open))),
        Fault::Mismatch { open, at, left: 1 } => {
            let end = numbers(text, *open).or_else(|| before_field(text, *open..*at));
            let end = end.unwrap_or(*at);
            let end = text[..end].trim_end().len();
            Some((end..end, closing(*open)))
        }
        _ => None,
    }
}

/// Whether what two brackets hold, of which the second is round, stands next to a vector: `(1, 0, 0), [0, 1, 0)`.
fn is_among_vectors(text: &str, brackets: Range<usize>) -> bool {
    let before = text[..brackets.start].trim_end().strip_suffix(',').unwrap_or_default();
    let behind = text[brackets.end + 1..].trim_start().strip_prefix(',').unwrap_or_default();
    let is_beside = before.trim_end().ends_with(')') || behind.trim_start().starts_with('(');
    text[brackets.end..].starts_with(')') && is_beside
}

/// Whether `else` stands right before or behind two brackets: what they hold is one of two values or blocks.
fn is_of_choice(text: &str, brackets: Range<usize>) -> bool {
    let is_else = |token: Token<'_>| token.text == "else";
    let is_behind = tokens(text, brackets.end + 1..text.len()).next().is_some_and(is_else);
    let before = text[..brackets.start].trim_end().strip_suffix("else");
    is_behind || before.is_some_and(|before| before.ends_with(['}', ' ', '\n']))
}

/// What mends brackets that close nothing: the brace that an `else` before them lacks, or that they are none.
fn without(text: &str, strays: Range<usize>) -> (Range<usize>, &'static str) {
    match bare_else(text, strays.start) {
        Some(end) => (end..end, " {"),
        None => (strays, ""),
    }
}

/// The end of an `else` that lacks the brace which another one closes on its line.
fn bare_else(text: &str, close: usize) -> Option<usize> {
    let near = (close.saturating_sub(REST)..close).find(|near| text.is_char_boundary(*near))?;
    let line = text[near..close].rfind('\n').map_or(near, |end| near + end + 1);
    let word = tokens(text, line..close).filter(|token| token.text == "else").last()?;
    let has_brace = tokens(text, word.end()..close).any(|token| matches!(token.text, "{" | "if"));
    (text[close..].starts_with('}') && !has_brace).then(|| word.end())
}

/// The second of two braces of which one never closes: nothing that may stand in braces begins with one. Nor does
/// anything in a table. Or that of two around one list, behind which no other stands.
fn doubled(text: &str, open: usize) -> Option<usize> {
    if text[..open].ends_with('#') && text[open..].starts_with("[[") {
        return Some(open + 1);
    }
    let blanks = |text: &str| text.len() - text.trim_start_matches([' ', '\t']).len();
    let next = open + 1 + blanks(&text[open + 1..]);
    if !text[open..].starts_with('{') {
        let is_same = text[open..].starts_with('[') && text[next..].starts_with('[');
        return is_same.then(|| behind(text, next)).flatten().filter(|c| *c != ',').map(|_| next);
    }
    let before = text[..open].trim_end_matches([' ', '\t']);
    if text[next..].starts_with('{') { Some(next) } else { before.ends_with('{').then_some(open) }
}

/// What stands behind the bracket that closes one, on its line.
fn behind(text: &str, open: usize) -> Option<char> {
    let near = &text.as_bytes()[open..text.len().min(open + LOOKED_AT)];
    let end = memchr::memchr(b'\n', near).unwrap_or(near.len());
    let line = text.get(open..open + end)?;
    let mut depth = 0_i32;
    let close = tokens(line, 0..line.len()).find(|token| {
        depth += i32::from(matches!(token.text, "(" | "[" | "{"));
        depth -= i32::from(matches!(token.text, ")" | "]" | "}"));
        depth == 0
    })?;
    line[close.end()..].trim_start().chars().next()
}

/// Where the numbers of a table end, whose bracket opens there.
fn numbers(text: &str, open: usize) -> Option<usize> {
    if !text[..open].ends_with('#') {
        return None;
    }
    let mut all = tokens(text, open + 1..text.len()).peekable();
    let mut end = None;
    while let Some(token) = all
        .next_if(|token| token.kind == TokenKind::Number || matches!(token.text, "-" | "+" | ","))
    {
        if token.kind == TokenKind::Number {
            end = Some(token.end());
        }
    }
    end
}

/// Where the head of a block ends on its line, in which a bracket opens that never closes.
fn before_block(text: &str, open: usize) -> Option<usize> {
    let near = open.saturating_sub(REST);
    let line = text.as_bytes()[near..open].iter().rposition(|byte| *byte == b'\n');
    let start = line.map(|end| near + end + 1).or((near == 0).then_some(0))?;
    let rest = text.as_bytes()[open..].iter().take(REST);
    let end = open + rest.take_while(|byte| **byte != b'\n').count();
    if text[open..].starts_with('{') || !text.is_char_boundary(end) {
        return None;
    }
    let first = tokens(text, start..open).find(|token| !matches!(token.text, "}" | "else"))?;
    let mut depth = 0_usize;
    let brace = tokens(text, open + 1..end).find(|token| {
        match token.text {
            "{" if depth == 0 => return true,
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        false
    })?;
    let is_last = tokens(text, brace.end()..end).next().is_none();
    let is_head = matches!(first.text, "fn" | "for" | "if") && is_last;
    // `fn leg(top: length = group {`: what the function makes begins behind the last `=`.
    let before = tokens(text, open + 1..brace.start).collect::<Vec<_>>();
    let value = before.windows(2).rev().find(|pair| {
        let begins = pair[1].text == "group" || is_category(pair[1].text);
        pair[0].text == "=" && begins && first.text == "fn"
    });
    let end = value.map_or(brace.start, |pair| pair[0].start);
    is_head.then(|| text[..end].trim_end().len())
}

/// Whether what was closed at a byte by another bracket is closed further on in its line too.
fn is_closed_later(text: &str, at: usize, bracket: &str) -> bool {
    let rest = &text[at + 1..];
    let mut depth = 0_usize;
    for byte in rest.bytes().take(REST) {
        match byte {
            b'\n' => return false,
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' if depth == 0 => return bracket.as_bytes() == [byte],
            b')' | b']' | b'}' => depth -= 1,
            _ => {}
        }
    }
    false
}

/// Whether what a `[` behind a word begins, and a `)` ends, is given to a function: no index is more than one
/// number, or a list.
fn is_call(text: &str, inside: Range<usize>) -> bool {
    let before = &text[..inside.start];
    let name = before.trim_end_matches(|c: char| c.is_alphanumeric() || c == '_');
    let name = &before[name.len()..];
    let is_mixed = text[inside.start..].starts_with('[') && text[inside.end..].starts_with(')');
    if !is_mixed || name.is_empty() || inside.len() > LOOKED_AT {
        return false;
    }
    let mut depth = 0_usize;
    let mut inner = tokens(text, inside.start + 1..inside.end).peekable();
    let first = inner.peek().map_or("", |first| first.text);
    // In brackets of its own, one with a comma is a vector.
    let most = usize::from(first == "(");
    let has_more = inner.any(|token| {
        match token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth <= most && token.text == ","
    });
    has_more || first == "[" || OF_A_NUMBER.contains(&name)
}

/// Where in brackets a comma or a line ends before the first field that follows something else: it is no argument's
/// name.
fn before_field(text: &str, inside: Range<usize>) -> Option<usize> {
    if inside.len() > LOOKED_AT {
        return None;
    }
    let before = &text[..inside.start];
    let inner: Vec<_> = tokens(text, inside).collect();
    let is_named = |i: usize| {
        let of = inner.get(i..i + 2);
        of.is_some_and(|of| of[0].kind == TokenKind::Word && of[1].text == "=")
    };
    // Arguments of `look_at` have names too.
    let is_look = before.trim_end().ends_with(LOOK_AT.0);
    let is_own = |i: usize| is_look && LOOK_AT.1.contains(&inner[i].text);
    let has_names = is_named(1) && !is_look;
    let is_object = |i: usize| {
        is_category(inner[i].text) && inner.get(i + 1).is_some_and(|t| t.kind == TokenKind::Word)
    };
    let mut depth = 0_usize;
    (1..inner.len()).find_map(|i| {
        match inner[i].text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            "," if depth == 0 && is_named(i + 1) && !has_names && !is_own(i + 1) => {
                return Some(inner[i].start);
            }
            // Arguments have commas between them.
            _ if depth == 0
                && inner[i].first_on_line
                && (is_named(i) && !is_own(i) || is_object(i))
                && inner[i - 1].text != "," =>
            {
                return Some(inner[i - 1].end());
            }
            _ => {}
        }
        None
    })
}

/// What is told of a bracket that never closes.
fn unclosed(text: &str, source: SourceId, open: usize, closes: &[(usize, usize)]) -> Diagnostic {
    let span = |range: Range<usize>| Span::new(source, range.start, range.end);
    if let Some(again) = doubled(text, open) {
        let place = span(again..again + 1);
        let message = format!("`{}` is written twice", &text[again..=again]);
        return Diagnostic::error("E0008", place, message).guess(place, "");
    }
    let bracket = &text[open..=open];
    let message = format!("this `{bracket}` is never closed");
    let found = Diagnostic::error("E0008", span(open..open + 1), message);
    if let Some((place, with)) = mend(text, &Fault::Unclosed { open }) {
        return found.guess(span(place), with);
    }
    let Some(at) = closes.iter().find_map(|(one, at)| (*one == open).then_some(*at)) else {
        return found;
    };
    let found = found.label(span(at..at), "it most likely closes before this");
    if bracket != "{" {
        return found;
    }
    let all = || closes.iter().filter(|(_, other)| *other == at).map(|(one, _)| *one);
    let others = all().filter(|one| *one != open);
    let found = others.fold(found, |found, one| found.label(span(one..one + 1), "nor is this"));
    if text[at..].starts_with("else") {
        return found.guess(span(at..at), "} ");
    }
    let end = if text[..at].ends_with('\n') { "" } else { "\n" };
    let braces = all().map(|one| format!("{}}}\n", indent_of(text, one)));
    found.guess(span(at..at), format!("{end}{}", braces.collect::<String>()))
}

/// What is told of a bracket, text or comment that does not close; `limit` is how deep brackets may
/// nest, and blocks that never close most likely do before the bytes of `closes`.
pub(super) fn told(
    text: &str,
    source: SourceId,
    limit: usize,
    fault: &Fault,
    closes: &[(usize, usize)],
) -> Diagnostic {
    let span = |range: Range<usize>| Span::new(source, range.start, range.end);
    let byte = |at: usize| char::from(text.as_bytes()[at]);
    match fault {
        Fault::TooDeep { at } => {
            let message = format!("more than {limit} nested brackets");
            Diagnostic::error("E0011", span(*at..at + 1), message)
                .help("give an inner part a name with `let`")
        }
        Fault::Unclosed { open } => unclosed(text, source, *open, closes),
        Fault::Mismatch { open, at, .. } => {
            let message = format!("`{}` is closed by `{}`", byte(*open), byte(*at));
            let found = Diagnostic::error("E0009", span(*at..at + 1), message)
                .label(span(*open..open + 1), "opened here");
            match mend(text, fault) {
                Some((place, with)) => found.guess(span(place), with),
                None => found,
            }
        }
        Fault::Stray { at } => {
            let rest = &text[*at..];
            let n = rest.bytes().take_while(|b| b")]}".contains(b)).count();
            let (this, closes) = if n == 1 { ("this", "closes") } else { ("these", "close") };
            let more = if n > SHOWN { "…" } else { "" };
            let shown = &rest[..n.min(SHOWN)];
            let message = format!("{this} `{shown}{more}` {closes} nothing");
            let (place, with) = without(text, *at..at + n);
            Diagnostic::error("E0010", span(*at..at + n), message).guess(span(place), with)
        }
        Fault::String { at } => {
            let message = "a string ends on its line with `\"`";
            let end = unopened(text, at.start).unwrap_or(at.end);
            Diagnostic::error("E0005", span(at.clone()), message).guess(span(end..end), "\"")
        }
        Fault::Comment { at } => {
            let message = "this comment is never closed by `*/`";
            Diagnostic::error("E0006", span(*at..at + 2), message)
        }
        Fault::Escape { at } => {
            let message = "an unknown escape";
            Diagnostic::error("E0007", span(at.clone()), message).help(
                "known are \\\" \\\\ \\n \\t and \\u{…} of a character that there is; write a \
                     backslash as \\\\",
            )
        }
    }
}

/// Where a text most likely begins whose end was taken for its beginning, on a line with one that does not end:
/// `illuminant(D65")`.
fn unopened(text: &str, end: usize) -> Option<usize> {
    let line = text[..end].rsplit('\n').next()?;
    let close = line.find('"')?;
    let is_written = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    let before = line[..close].trim_end_matches(is_written);
    let begins = before.ends_with(['(', '[', ',', '=', ' ']) && before.len() < close;
    let ends = line[close + 1..].starts_with([')', ']', ',', ' ']);
    (begins && ends).then(|| end - line.len() + before.len())
}
