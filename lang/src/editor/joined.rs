//! Braces that close nothing where one further up is to blame.

use std::ops::Range;

use luxel_core::diag::Diagnostic;

use super::document::Document;
use crate::syntax::{STRAYS_LOOKED_AT, joined_at, looked_at_again};

/// Braces that are looked at: where so many close nothing, each is told.
const MOST: usize = 64;

impl Document {
    /// For braces that close nothing, the bytes of the statements that are one if another brace is mended, and
    /// what is told of it in the place of what is told of them.
    pub(super) fn joined(&self) -> Vec<(Range<usize>, Vec<Diagnostic>)> {
        let strays = self.faults.iter().filter(|fault| fault.code == "E0010");
        let mut strays: Vec<usize> =
            strays.filter_map(|fault| Some(fault.span()?.range().start)).collect();
        strays.sort_unstable();
        let mut again = looked_at_again(self.text());
        let mut out: Vec<(Range<usize>, _)> = vec![];
        for at in strays.iter().copied().filter(|_| strays.len() <= MOST) {
            let done = out.last().map_or(0, |(range, _)| range.end);
            let index = |at: usize| self.pieces().partition_point(|piece| piece.start < at);
            let after = index(at);
            let first = after.saturating_sub(STRAYS_LOOKED_AT).max(index(done));
            if let Some(pieces) = self.pieces().get(first..after).filter(|some| !some.is_empty()) {
                let range = pieces[0].start..pieces[pieces.len() - 1].end;
                out.extend(joined_at(self.text(), range, at, self.budgets(), &mut again));
            }
        }
        out
    }
}
