//! Mistakes beside and behind brackets that are wrong.

use std::collections::{BTreeMap, BTreeSet};

use luxel_core::diag::{Diagnostic, SourceId, Sources, Span};

use super::line_of;
use super::nearby::is_unread;
use crate::syntax::{ELSE, TokenKind, tokens};
use crate::words::BEFORE_NAMES;

/// Bytes of an expression in which a name is looked for.
const LINE: usize = 1000;

/// Bytes between what stands in one list over some lines.
const NEAR: u32 = 500;

/// Takes out what is told on the line of a bracket that is wrong, unless its mend is sure, it is a name that
/// nothing stands for, or what an object lacks: without the bracket it is not known what belongs together there.
/// Of two such brackets the first is told, and of several of which one was taken for what another is, it alone.
/// Nothing but that is told of a line that begins with an `else` that is misspelt.
/// Nor is it told that a value does not fit which a line gives to a name in which something cannot be read.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let mut lines: BTreeMap<_, Span> = BTreeMap::new();
    let wrong = diagnostics.iter().filter(|it| is_bracket(it, sources));
    for at in wrong.filter_map(Diagnostic::span) {
        let first = lines.entry((at.source, line_of(at, sources))).or_insert(at);
        *first = at.min(*first);
    }
    let is_unsure = |found: &&Diagnostic| is_unread(found) && found.sure().is_none();
    let unread = diagnostics.iter().filter(is_unsure);
    let names: BTreeSet<_> = unread.filter_map(|found| defined(found, sources)).collect();
    let of_name = |at: Span| {
        let mut words = tokens(sources.text(at.source), at.range());
        at.range().len() <= LINE && words.any(|word| names.contains(&(at.source, word.text)))
    };
    let displaced = displaced(diagnostics, sources);
    let line = |at: Span| (at.source, line_of(at, sources));
    let branches = diagnostics.iter().filter(|found| found.message == ELSE);
    let branches: BTreeSet<_> = branches.filter_map(Diagnostic::span).map(line).collect();
    diagnostics.retain(|found| {
        let Some(at) = found.span() else { return true };
        // What is surely `=` for `:` is none in `fn f a: vec3, b: vec3) = a`.
        let is_judged = found.is_error() && (found.sure().is_none() || found.code == "E0017");
        let first = lines.get(&line(at));
        let is_beside =
            !matches!(found.code, "E0101" | "E0403") && first.is_some_and(|first| *first != at);
        let is_branch = branches.contains(&line(at)) && found.message != ELSE;
        let is_of_one = found.code.starts_with("E02") && !names.is_empty() && of_name(at);
        let is_displaced = displaced.contains(&(at, found.code));
        !is_displaced && !(is_judged && (is_beside || is_branch || is_of_one))
    });
}

/// What is told near a wrong bracket because what stands there belongs to something else than was meant, by place
/// and code.
fn displaced(diagnostics: &[Diagnostic], sources: &Sources) -> BTreeSet<(Span, &'static str)> {
    let is_one = |found: &&Diagnostic| found.code == "E0114" || is_bracket(found, sources);
    let placed = |found| Some((Diagnostic::span(found)?, found));
    let mut all: Vec<_> = diagnostics.iter().filter(is_one).filter_map(placed).collect();
    all.sort_by_key(|(at, _)| *at);
    let out = behind(&all).into_iter().chain(unused_before(&all));
    out.map(|(at, found)| (at, found.code)).collect()
}

/// Brackets and values, and where they stand, in order.
type Placed<'a> = (Span, &'a Diagnostic);

/// Those that follow, each near the last, on a bracket that closed one of another kind: brackets that close
/// nothing, or one further out, and values that nothing uses.
fn behind<'a>(all: &[Placed<'a>]) -> Vec<Placed<'a>> {
    let mut out = vec![];
    // The last of them, and which bracket was closed.
    let mut last: Option<(Span, Option<Span>)> = None;
    for (at, found) in all {
        let open = found.labels.get(1).map(|open| open.span);
        let outer = last.filter(|(last, _)| is_near(*last, *at)).map(|(_, outer)| outer);
        let (is_one, closed) = match (found.code, outer) {
            ("E0010" | "E0114", Some(outer)) => (true, Some(outer)),
            ("E0009", outer) => (outer.is_some_and(|outer| open < outer), Some(open)),
            _ => (false, None),
        };
        last = closed.map(|closed| (*at, closed));
        out.extend(is_one.then_some((*at, *found)));
    }
    out
}

/// Values that nothing uses before a bracket that closes nothing, each near the next.
fn unused_before<'a>(all: &[Placed<'a>]) -> Vec<Placed<'a>> {
    let (mut out, mut next) = (vec![], None);
    for (at, found) in all.iter().rev() {
        let is_one = found.code == "E0114" && next.is_some_and(|next| is_near(*at, next));
        next = (is_one || found.code == "E0010").then_some(*at);
        out.extend(is_one.then_some((*at, *found)));
    }
    out
}

/// Whether two places, in order, may be of one list.
fn is_near(at: Span, next: Span) -> bool {
    at.source == next.source && next.start.saturating_sub(at.end) <= NEAR
}

/// The name to which the line before a place gives a value.
fn defined<'a>(found: &Diagnostic, sources: &'a Sources) -> Option<(SourceId, &'a str)> {
    let at = found.span()?;
    let mut line = tokens(sources.text(at.source), line_of(at, sources)..at.range().start);
    line.next().filter(|word| BEFORE_NAMES.contains(&word.text))?;
    let name = line.next().filter(|name| name.kind == TokenKind::Word)?;
    Some((at.source, name.text))
}

/// Whether a bracket is wrong, and how that is mended not sure. What stands in a brace that never closes is known,
/// but for one that is written twice.
fn is_bracket(found: &Diagnostic, sources: &Sources) -> bool {
    let opens_block = || {
        let at = found.span().map(|at| sources.text(at.source).as_bytes().get(at.range().start));
        let is_brace = found.code == "E0008" && at == Some(Some(&b'{'));
        is_brace && !found.fixes.iter().any(|fix| fix.replacement.is_empty())
    };
    let is_one = matches!(found.code, "E0008" | "E0009" | "E0010");
    is_one && found.sure().is_none() && !opens_block()
}
