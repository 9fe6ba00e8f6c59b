//! Names that nothing stands for because of what their definition is written like.

use std::collections::{BTreeMap, BTreeSet};

use luxel_core::diag::{Diagnostic, Fix, Grade, Label, SourceId, Sources, Span};
use luxel_sdk::kind::Kind;
use memchr::memmem;

use crate::eval::DEFINED;
use crate::syntax::{Token, TokenKind, tokens};
use crate::words::BEFORE_NAMES;

use super::nearby::is_unread;
use super::{lacks_name, line_of};

/// Words beside something that cannot be read that may be what was to be defined there, on each side.
const WORDS: usize = 3;
/// Bytes of its line before it that are looked at.
const BYTES: usize = 200;
/// Letters from which on the beginning of such a word may be meant by it: `fn riseb: int)`.
const LONG: usize = 3;
/// Bytes of a line on which parameters are looked for, and of the text behind it, in which comments may stand.
const LINE: usize = 1000;
/// Bytes of a text in which a definition is looked for.
const SEARCHED: usize = 1 << 20;
/// Places of one name that are shown.
const SHOWN: usize = 4;

/// What is told of words of the language that are names.
const WORD: &str = "E0019";

/// What is told of names that stand before their definition.
const EARLY: &str = "E0102";

/// A word of a text, and where it begins.
type Word<'a> = (SourceId, &'a str, u32);

/// Takes out what is told of names that stand beside something that cannot be read: their definition may be
/// what stands there. Of other names each is told once, with the places where it stands.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let is_cause =
        |found: &&Diagnostic| found.code == "E0001" || is_unread(found) && found.sure().is_none();
    let causes = diagnostics.iter().filter(is_cause).filter_map(Diagnostic::span);
    let causes: BTreeSet<Span> = causes.collect();
    let defined = |at: &Span| words_beside(*at, sources).chain(parameters(*at, sources));
    let unread: BTreeSet<Word<'_>> = causes.iter().flat_map(defined).collect();
    named_by_use(diagnostics, sources);
    let mut places: BTreeMap<(SourceId, &str), Vec<Span>> = BTreeMap::new();
    for found in &*diagnostics {
        if let Some(name) = name_or_parameter(found, sources) {
            places.entry(name).or_default().extend(found.span());
        }
    }
    let is_nameless = diagnostics.iter().any(|found| lacks_name(found, sources));
    diagnostics.retain_mut(|found| {
        if is_of_builtin(found) {
            let at = found.span().map(|at| (at.source, sources.text(at.source).get(at.range())));
            let is_one = |(source, word): (_, Option<&str>)| {
                unread.iter().any(|one| one.0 == source && Some(one.1) == word)
            };
            return !is_nameless && !at.is_some_and(is_one);
        }
        let Some(name) = name_or_parameter(found, sources) else { return true };
        // `rise(b: int) = b * 1 m`, which is read as a call too
        let is_unread = || places[&name].iter().any(|at| causes.contains(at));
        let is_defined = || is_unread() || is_defined_by_one(name, found, &unread);
        let is_hidden = found.code == "E0101" && is_defined();
        !is_hidden && told_once(found, name, &places[&name], sources)
    });
}

/// Whether a function stands where a value is wanted: one that every scene has, where a definition of the same name
/// cannot be read.
fn is_of_builtin(found: &Diagnostic) -> bool {
    found.code == "E0214" && found.sure().is_none() && found.message.ends_with("not a function")
}

/// Where an object may be given a label or a name, only what fits its uses is offered: a name where something
/// uses it, of which nothing is told then, and else a label.
fn named_by_use(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let used: BTreeSet<_> = diagnostics.iter().filter_map(|found| name(found, sources)).collect();
    let mut given = BTreeSet::new();
    for found in &mut *diagnostics {
        let Some(source) = found.span().map(|at| at.source) else { continue };
        let named = found.fixes.iter().position(|fix| given_name(fix).is_some());
        let Some(i) = named.filter(|_| found.fixes.len() > 1) else { continue };
        let of = given_name(&found.fixes[i]).map(|name| (source, name.to_owned()));
        if of.as_ref().is_some_and(|(source, name)| used.contains(&(*source, name))) {
            found.fixes = vec![found.fixes.swap_remove(i)];
            given.extend(of);
        } else if i > 0 {
            found.fixes.remove(i);
        }
    }
    diagnostics.retain(|found| {
        let of = name(found, sources).filter(|_| found.code == "E0101");
        of.is_none_or(|(source, name)| !given.contains(&(source, name.to_owned())))
    });
}

/// The name that a mend gives to an object.
fn given_name(fix: &Fix) -> Option<&str> {
    let (name, value) = fix.replacement.strip_prefix("let ")?.split_once(" = ")?;
    (!value.is_empty()).then_some(name)
}

/// Whether a word that stands elsewhere may be what defines a name: the same, or one that begins with the name
/// if that is long enough, and surely meant if any is.
fn is_defined_by_one(
    name: (SourceId, &str),
    found: &Diagnostic,
    words: &BTreeSet<Word<'_>>,
) -> bool {
    let ((source, name), at) = (name, found.span());
    let is_meant = |word: &str| found.sure().is_none_or(|fix| fix.replacement == word);
    let from = words.range((source, name, 0)..);
    let mut alike = from.take_while(|word| word.0 == source && word.1.starts_with(name));
    alike.any(|word| {
        let is_elsewhere = at.is_none_or(|at| at.start != word.2);
        is_elsewhere && (word.1 == name || name.len() >= LONG && is_meant(word.1))
    })
}

/// Whether this is the first that is said of a name, which then shows the other places. Where each has its
/// own mend, each is told; but where the name that is meant stands nowhere but in its definition, that is
/// what is mended.
fn told_once(
    found: &mut Diagnostic,
    name: (SourceId, &str),
    places: &[Span],
    sources: &Sources,
) -> bool {
    if places.len() < 2 {
        return true;
    }
    let definition = meant(found).and_then(|near| definition(near, name.0, sources));
    if found.sure().is_some() && definition.is_none() {
        return true;
    }
    if found.span() != Some(places[0]) {
        return false;
    }
    if let Some(span) = definition {
        let defined = &sources.text(name.0)[span.range()];
        found.help = vec![format!("what is defined is `{defined}`: misspelt there?")];
        let replacement = name.1.to_owned();
        found.fixes = vec![Fix { span, replacement, grade: Grade::Guess }];
    }
    let others = places[1..].iter().take(SHOWN - 1);
    found.labels.extend(others.map(|at| Label { span: *at, text: "and here".into() }));
    if places.len() > SHOWN {
        found.help.push(format!("it stands in {} places", places.len()));
    }
    true
}

/// The name that nothing stands for, or that is a word of the language.
fn name<'a>(found: &Diagnostic, sources: &'a Sources) -> Option<(SourceId, &'a str)> {
    let at = found.span().filter(|_| matches!(found.code, "E0101" | EARLY | WORD))?;
    let name = sources.text(at.source).get(at.range())?;
    Some((at.source, name)).filter(|_| Kind::of_word(name).is_none() || found.code == WORD)
}

/// As [`name`], or the parameter that a call gives by a name which its function does not have, where the name that
/// is surely meant stands in its definition alone: there it may be misspelt.
fn name_or_parameter<'a>(found: &Diagnostic, sources: &'a Sources) -> Option<(SourceId, &'a str)> {
    name(found, sources).or_else(|| {
        let of_function = found.labels.iter().any(|label| label.text == DEFINED);
        let is_one = found.code == "E0402" && of_function && found.sure().is_some();
        let at = found.span().filter(|_| is_one)?;
        definition(meant(found)?, at.source, sources)?;
        Some((at.source, sources.text(at.source).get(at.range())?))
    })
}

/// The name that may be meant, if one is: `vec3` is only too much.
fn meant(found: &Diagnostic) -> Option<&str> {
    match &found.fixes[..] {
        [only] if Some(only.span) == found.span() => Some(&*only.replacement),
        _ => None,
    }
    .filter(|name| !name.is_empty())
}

/// Where a name is defined that stands nowhere else in a text.
fn definition(name: &str, source: SourceId, sources: &Sources) -> Option<Span> {
    let text = Some(sources.text(source)).filter(|text| text.len() <= SEARCHED)?;
    let in_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let all = memmem::find_iter(text.as_bytes(), name.as_bytes());
    let mut all = all.filter(|at| {
        let (before, behind) = (&text[..*at], &text[at + name.len()..]);
        !before.ends_with(in_word) && !behind.starts_with(in_word)
    });
    let at = all.next().filter(|_| all.next().is_none())?;
    let before = text[..at].trim_end_matches([' ', '\t']);
    let is_parameter = before.ends_with(['(', ',']) && text[at + name.len()..].starts_with(':');
    let is_named = BEFORE_NAMES.iter().chain(&["\" as"]).any(|word| before.ends_with(word));
    let defines = is_parameter || is_named;
    defines.then(|| Span::new(source, at, at + name.len()))
}

/// The words on both sides of a place that may be what is defined there: beside what defines a name, or where a
/// line begins. What stands where a value does defines nothing.
fn words_beside(at: Span, sources: &Sources) -> impl Iterator<Item = Word<'_>> {
    let (text, start) = (sources.text(at.source), at.range().start);
    let near = start.saturating_sub(BYTES);
    let line = memchr::memrchr(b'\n', &text.as_bytes()[near..start]).map(|end| near + end + 1);
    // Of a longer line nothing is looked at before the place.
    let line = line.or((near == 0).then_some(0)).unwrap_or(start);
    let mut all: Vec<Token<'_>> = tokens(text, line..start).collect();
    let first = all.len().saturating_sub(WORDS);
    let is_end = |end: &usize| text.is_char_boundary(*end);
    let end = (start + LINE..text.len()).find(is_end).unwrap_or(text.len());
    let words = tokens(text, start..end).filter(|token| token.kind != TokenKind::Doc);
    all.extend(words.take(WORDS + 1));
    let defines = |i: usize| all.get(i).is_some_and(|token| BEFORE_NAMES.contains(&token.text));
    let may_be = |i: &usize| {
        let token = &all[*i];
        let is_behind = (1..=2).any(|back| i.checked_sub(back).is_some_and(defines));
        let is = |i: usize, sign| all.get(i).is_some_and(|token| token.text == sign);
        // `let a = b { let` and `} c = d`, `fn f(x: int) = (x fn` and `) g(y: int) = y`
        let is_closed = *i > 0 && matches!(all[i - 1].text, "}" | ")" | "]");
        let is_given = is_closed && (is(i + 1, "=") || is(i + 1, "("));
        let begins = *i == 0 || token.first_on_line || is_given;
        token.kind == TokenKind::Word && (begins || is_behind)
    };
    let words: Vec<usize> = (first..all.len()).filter(may_be).collect();
    words.into_iter().map(move |i| {
        let word = Span::new(at.source, all[i].start, all[i].end());
        (at.source, all[i].text, word.start)
    })
}

/// The names of parameters on the line of a place, if it begins a function.
fn parameters(at: Span, sources: &Sources) -> impl Iterator<Item = Word<'_>> {
    let (text, start) = (sources.text(at.source), line_of(at, sources));
    let is_end = |end: &usize| text.is_char_boundary(*end);
    let end = (start + LINE..text.len()).find(is_end).unwrap_or(text.len());
    let end = text[start..end].find('\n').map_or(end, |line| start + line);
    let line: Vec<Token<'_>> = tokens(text, start..end).collect();
    let is_function = line.first().is_some_and(|first| first.text == "fn");
    let is_one = |pair: &&[Token<'_>]| is_function && pair[1].text == ":";
    let names: Vec<&str> = line.windows(2).filter(is_one).map(|pair| pair[0].text).collect();
    names.into_iter().map(move |name| (at.source, name, at.start))
}
