//! Mistakes in what a function makes of arguments that are not those that were meant.

use luxel_core::diag::{Diagnostic, Span};

use super::nearby::is_unread;
use crate::eval::CALLED;

/// Takes out what is told of a function's body where something in the call cannot be read: another call may have
/// been meant.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>) {
    let is_cause =
        |found: &&Diagnostic| found.sure().is_none() && (is_unread(found) || found.code == "E0008");
    let causes = diagnostics.iter().filter(is_cause).filter_map(Diagnostic::span);
    let mut causes: Vec<Span> = causes.collect();
    causes.sort_unstable();
    let is_read = |call: Span| {
        let first = causes.partition_point(|at| (at.source, at.start) < (call.source, call.start));
        causes.get(first).is_none_or(|at| at.source != call.source || at.start >= call.end)
    };
    diagnostics.retain(|found| {
        found.labels.iter().all(|label| label.text != CALLED || is_read(label.span))
    });
}
