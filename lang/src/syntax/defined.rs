//! The names that a statement which cannot be read may be meant to define: uses of them are no mistakes
//! of their own.

use std::ops::Range;

use luxel_core::diag::{SourceId, Span, nearest};

use super::around::{is_category, stands_nowhere};
use super::lex::{Token, TokenKind, tokens};
use super::tree::Name;
use super::type_names;
use crate::words::{RESERVED, STATEMENTS};

/// Words before a name that is being defined.
const DEFINING: [&str; 3] = ["let", "param", "fn"];

/// Tokens that are looked at.
const LOOKED_AT: usize = 12;

/// Names that `text[piece]` may define.
pub(super) fn perhaps_defined(text: &str, piece: Range<usize>, source: SourceId) -> Box<[Name]> {
    let mut after_line = false;
    let words: Vec<Token<'_>> = tokens(text, piece)
        .filter(|token| token.kind != TokenKind::Doc && token.text != "#")
        .take_while(|token| !std::mem::replace(&mut after_line, true) || !token.first_on_line)
        .take(LOOKED_AT)
        .collect();
    let name = |text: &str, first: &Token<'_>, last: &Token<'_>| Name {
        text: text.into(),
        span: Span::new(source, first.start, last.end()),
    };
    let word = |i: usize| words.get(i).filter(|t| t.kind == TokenKind::Word);
    let mark = |i: usize| words.get(i).map_or("", |t| t.text);
    let gives = |i: usize| matches!(mark(i), "=" | ":" | "(" | "==");
    let Some(first) = word(0) else { return Box::default() };
    if first.text == "import" {
        return imported(&words).map(|(text, token)| name(text, token, token)).collect();
    }
    if matches!(first.text, "for" | "foreach" | "until" | "while") {
        return of_loop(&words).map(|t| name(t.text, t, t)).collect();
    }
    // `x := 3`, `letx: float = 3`
    if gives(1) && mark(1) != "(" {
        return glued(first.text).map(|text| name(text, first, first)).collect();
    }
    // `f(x) = x * 2`
    let close = words.iter().position(|t| t.text == ")");
    if close.is_some_and(|close| mark(1) == "(" && mark(close + 1) == "=") {
        return Box::new([name(first.text, first, first)]);
    }
    // `include "a.scene" as lib`
    if let Some(third) = word(3).filter(|_| mark(2) == "as" && mark(0) != "import") {
        return Box::new([name(third.text, third, third)]);
    }
    if is_category(first.text) {
        return of_object(&words).map(|t| name(t.text, t, t)).collect();
    }
    if let Some((at, _)) = of_list(&words) {
        return Box::new([name(words[at].text, &words[at], &words[at])]);
    }
    // `#define R 2 m`
    let begins = DEFINING.contains(&first.text) || first.text == "define";
    // `lte x = 5`, `var x = 5` were to define something too.
    let may_begin = nearest(first.text, DEFINING).is_some() || !STATEMENTS.contains(&first.text);
    let Some(second) = word(1).filter(|_| begins || may_begin) else { return Box::default() };
    // `let höhe = 3`
    let rest = &text[second.start..];
    let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let length = rest.find(|c| !is_of_name(c)).unwrap_or(rest.len());
    if length > second.text.len() {
        let span = Span::new(source, second.start, second.start + length);
        return Box::new([Name { text: rest[..length].into(), span }]);
    }
    match word(2) {
        // `let x int = 3`, `let go ld = 3`
        Some(third) if begins || gives(3) => {
            let all = [
                second.text.to_owned(),
                third.text.to_owned(),
                format!("{}{}", second.text, third.text),
                format!("{}_{}", second.text, third.text),
            ];
            let n = if is_type(third.text) { 1 } else { all.len() };
            all[..n].iter().map(|text| name(text, second, third)).collect()
        }
        _ if begins || gives(2) => Box::new([name(second.text, second, second)]),
        _ => Box::default(),
    }
}

/// The names of `for i, ball in balls` without its block, `for (int i = 0;`, `for i ball in balls`, `while i < n`.
fn of_loop<'t, 'a>(words: &'t [Token<'a>]) -> impl Iterator<Item = &'t Token<'a>> {
    let mark = |i: usize| words.get(i).map_or("", |t| t.text);
    // What a `while` compares is of the loop too.
    let all = matches!(mark(0), "until" | "while").then_some(words.len());
    let end = words.iter().position(|t| t.text == "in").or(all);
    let end = end.unwrap_or(if mark(2) == "," { 4 } else { 2 + usize::from(mark(1) == "(") * 2 });
    let names = words.iter().take(end).filter(|t| t.kind == TokenKind::Word);
    names.filter(|t| !RESERVED.contains(&t.text) && !is_type(t.text) && t.start > words[0].start)
}

/// The names of `material gold = conductor { … }` and `material red diffuse { … }`: of the latter the second as
/// well, where the block is not read under that name.
fn of_object<'t, 'a>(words: &'t [Token<'a>]) -> impl Iterator<Item = &'t Token<'a>> {
    let mark = |i: usize| words.get(i).map_or("", |t| t.text);
    let named = words.get(1..).unwrap_or_default();
    let are_words = named.iter().take(2).filter(|t| t.kind == TokenKind::Word).count() == 2;
    let is_two = are_words && stands_nowhere(mark(0));
    let n = match (mark(2), mark(3)) {
        ("=", _) => 1,
        (_, "{") if is_two => 2,
        (_, "") if is_two => 1,
        _ => 0,
    };
    named.iter().take(n).filter(|t| t.kind == TokenKind::Word)
}

/// A list that is defined as other languages do, by its first tokens: which of them is its name, and which the last
/// before `=`. `float heights[3] = …`, `float[] heights = …`
pub(super) fn of_list(words: &[Token<'_>]) -> Option<(usize, usize)> {
    let mark = |i: usize| words.get(i).map_or("", |t| t.text);
    let open = [1, 2].into_iter().find(|i| mark(*i) == "[")?;
    let close = open + 1 + usize::from(mark(open + 1) != "]");
    let name = if open == 1 { close + 1 } else { 1 };
    let last = name.max(close);
    let is_word = words.get(name).is_some_and(|t| t.kind == TokenKind::Word);
    (is_word && mark(close) == "]" && mark(last + 1) == "=").then_some((name, last))
}

pub(super) fn is_type(word: &str) -> bool {
    type_names::names().any(|known| known == word)
}

/// What `import "a.scene" …` may name: words that follow, or else as the file is called.
fn imported<'t, 'a>(words: &'t [Token<'a>]) -> impl Iterator<Item = (&'a str, &'t Token<'a>)> {
    let is_name = |t: &&Token<'_>| t.kind == TokenKind::Word && !RESERVED.contains(&t.text);
    let named = words.iter().skip(1).filter(is_name).map(|t| (t.text, t));
    let file = words.get(1).filter(|t| t.kind == TokenKind::Text && words.len() == 2);
    named.chain(file.and_then(|file| Some((stem(file.text)?, file))))
}

/// The name of a file, if it can be a name of the language; its path stands in quotes.
pub(super) fn stem(path: &str) -> Option<&str> {
    let stem = path.trim_matches('"').rsplit('/').next()?.split('.').next()?;
    let legal = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = |c: char| c.is_ascii_alphabetic() || c == '_';
    (stem.chars().all(legal) && stem.starts_with(begins)).then_some(stem)
}

/// Whether a statement begins as one that says what units bare numbers have, or nearly so, or without its word.
pub(crate) fn says_units(stmt: &str) -> bool {
    if let Some(first) = stmt.strip_prefix('{').map(str::trim_start) {
        return type_names::measured().any(|it| {
            first.strip_prefix(it).is_some_and(|behind| behind.trim_start().starts_with('='))
        });
    }
    let word = stmt.split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or("");
    word.starts_with(['u', 'U']) && nearest(word, ["units"]).is_some()
}

/// The names that a field outside an object was meant to define.
pub(crate) fn stray(field: &Name) -> impl Iterator<Item = Name> {
    glued(&field.text).map(|text| Name { text: text.into(), span: field.span })
}

/// A word as a name, also without the word of the language that begins it: `letx`.
fn glued(word: &str) -> impl Iterator<Item = &str> {
    let rest = DEFINING.iter().filter_map(|known| word.strip_prefix(known));
    [word].into_iter().chain(rest).filter(|name| !name.is_empty() && !RESERVED.contains(name))
}
