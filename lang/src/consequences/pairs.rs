//! Mistakes next to one another that one slip brings, however many words stand between them.

use std::collections::BTreeSet;

use luxel_core::diag::{Diagnostic, Fix, Grade, Label, SourceId, Sources, Span};
use luxel_sdk::kind::Kind;

/// Bytes from one to the other, at most.
const BYTES: usize = 200;

/// Bytes from one bracket to another, at most.
const FAR: usize = 500;

/// Takes out one of two, and what is said of a doc comment behind which something cannot be read.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let unread = diagnostics.iter().filter(|found| found.code == "E0023");
    let starts = unread.filter_map(Diagnostic::span).map(|at| (at.source, at.range().start));
    let starts: BTreeSet<_> = starts.collect();
    diagnostics.retain(|found| {
        let doc = Some(found).filter(|found| found.code == "E0022");
        doc.and_then(|doc| behind(doc, sources)).is_none_or(|next| !starts.contains(&next))
    });
    let errors = diagnostics.iter().enumerate().filter(|(_, found)| found.is_error());
    let mut all: Vec<(Span, usize)> =
        errors.filter_map(|(i, found)| Some((found.span()?, i))).collect();
    all.sort_unstable();
    let mut is_out = vec![false; diagnostics.len()];
    for pair in all.windows(2) {
        let [(_, i), (at, j)] = pair else { continue };
        let (first, second) = (&diagnostics[*i], &diagnostics[*j]);
        if let Some(mend) = of_another_kind(first, second, sources) {
            diagnostics[*i].labels.push(Label { span: *at, text: "this closes nothing".into() });
            diagnostics[*i].fixes = vec![mend];
            is_out[*j] = true;
        } else if is_kind_of_other(first, second, sources) {
            is_out[*i] = true;
        } else if has_lost_its_kind(second, first, sources) {
            is_out[*j] = true;
            // `group shape {`, and below it `cylinder {`: the word is no label.
            if first.code == "E0401" {
                diagnostics[*i].fixes.clear();
            }
        }
    }
    let mut is_out = is_out.into_iter();
    diagnostics.retain(|_| !is_out.next().unwrap_or_default());
}

/// Where the next thing begins behind what something is said of.
fn behind(found: &Diagnostic, sources: &Sources) -> Option<(SourceId, usize)> {
    let at = found.span()?;
    let rest = sources.text(at.source).get(at.range().end..)?;
    Some((at.source, at.range().end + rest.len() - rest.trim_start().len()))
}

/// How a brace that does not close, where a value stands, becomes the bracket that one behind it closes, which
/// closes nothing else.
fn of_another_kind(open: &Diagnostic, close: &Diagnostic, sources: &Sources) -> Option<Fix> {
    let (before, at) = (open.span()?, close.span()?);
    let is_one = (open.code, close.code) == ("E0008", "E0010") && before.source == at.source;
    if !is_one || at.range().start - before.range().start > FAR {
        return None;
    }
    let text = sources.text(at.source);
    if !text.get(..before.range().start)?.trim_end().ends_with(['=', '(', '[', ',']) {
        return None;
    }
    let opening = match (text.get(before.range())?, text.get(at.range())?) {
        ("{", ")") => "(",
        ("{", "]") => "[",
        _ => return None,
    };
    Some(Fix { span: before, replacement: opening.into(), grade: Grade::Guess })
}

/// Whether a kind of object is taken for a name because what stands behind it cannot be read:
/// `shape = shape mesh points {`, and on the next line `= …`.
fn is_kind_of_other(word: &Diagnostic, other: &Diagnostic, sources: &Sources) -> bool {
    let (Some(before), Some(at)) = (word.span(), other.span()) else { return false };
    let text = sources.text(before.source);
    let is_kind = text.get(before.range()).is_some_and(|word| Kind::of_word(word).is_some());
    let is_near = before.source == at.source && at.range().start - before.range().start <= BYTES;
    word.code == "E0101" && is_kind && is_near && matches!(other.code, "E0019" | "E0023")
}

/// Whether what kind of object something is stands on the line above, where something is wrong:
/// `move(x) cmshape`, and below it `cone {`.
fn has_lost_its_kind(found: &Diagnostic, wrong: &Diagnostic, sources: &Sources) -> bool {
    let (Some(at), Some(wrong)) = (found.span(), wrong.span()) else { return false };
    let text = sources.text(at.source);
    let is_near = at.source == wrong.source
        && at.start > wrong.start
        && at.range().start - wrong.range().start <= BYTES;
    let above = text.get(wrong.range().start..at.range().start).filter(|_| is_near);
    let above = above.unwrap_or_default();
    let before = above.trim_end_matches([' ', '\n', ')', ']', '}', '{']);
    let last = before.split_whitespace().next_back().unwrap_or_default();
    let is_apart = !above[before.len()..].trim_matches(' ').is_empty();
    let is_kind = |kind: &str| last.ends_with(kind) && (last != kind || is_apart);
    found.code == "E0401" && Kind::ALL.iter().any(|(_, kind)| is_kind(kind))
}
