//! What a bracket that is written once more leaves open behind it.

use std::collections::BTreeMap;

use luxel_core::diag::{Diagnostic, Fix, Grade, Label, Sources, Span};

/// Bytes between such a bracket and the one further down that closes nothing because of it.
const BETWEEN: usize = 500;

/// Takes out what is said to be missing before a bracket that closes nothing, on a line above it in its statement,
/// as another one may have been closed too early, and what is unknown between the two.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let is_stray = |found: &&Diagnostic| found.code == "E0010" && found.sure().is_none();
    let strays = diagnostics.iter().filter(is_stray).filter_map(Diagnostic::span);
    let mut strays: Vec<Span> = strays.collect();
    strays.sort_unstable();
    let (mut left, mut closed) = (vec![], BTreeMap::new());
    diagnostics.retain(|found| {
        let Some(at) = found.span().filter(|_| found.code == "E0403") else { return true };
        let next =
            strays.partition_point(|stray| (stray.source, stray.start) < (at.source, at.end));
        let stray = strays.get(next).filter(|stray| stray.source == at.source);
        let stray = stray.filter(|stray| is_left_by(at, **stray, sources));
        if let Some(stray) = stray {
            left.push(Span { start: at.end, ..*stray });
            closed.insert(*stray, last(at));
        }
        stray.is_none()
    });
    for found in diagnostics.iter_mut().filter(|found| found.code == "E0010") {
        let close =
            found.span().and_then(|at| closed.get(&at)).filter(|at| is_round(**at, sources));
        if let Some(close) = close {
            found.labels.push(Label { span: *close, text: "the call ends here".into() });
            found.fixes =
                vec![Fix { span: *close, replacement: String::new(), grade: Grade::Guess }];
        }
    }
    let is_in = |at: Span, open: &Span| {
        at.source == open.source && open.start <= at.start && at.end <= open.end
    };
    diagnostics.retain(|found| {
        let is_unknown = matches!(found.code, "E0101" | "E0113" | "E0402");
        let at = found.span().filter(|_| is_unknown);
        at.is_none_or(|at| !left.iter().any(|open| is_in(at, open)))
    });
}

/// Whether something lacks what follows because what a bracket further down was to close was closed before.
fn is_left_by(at: Span, stray: Span, sources: &Sources) -> bool {
    let text = sources.text(at.source);
    let between = text.get(at.range().end..stray.range().start).unwrap_or_default();
    let is_within = |line: &str| line.is_empty() || line.starts_with([' ', '\t', ')', ']', '}']);
    let is_statement = between.contains('\n') && between.split('\n').skip(1).all(is_within);
    let closes = |bracket| text.get(stray.range()).is_some_and(|it| it.starts_with(bracket));
    let is_call = is_round(last(at), sources);
    between.len() <= BETWEEN && is_statement && (closes('}') || is_call && closes(')'))
}

/// The last byte of a place.
fn last(at: Span) -> Span {
    Span { start: at.end.saturating_sub(1).max(at.start), ..at }
}

/// Whether a round bracket closes there.
fn is_round(at: Span, sources: &Sources) -> bool {
    sources.text(at.source).get(at.range()) == Some(")")
}
