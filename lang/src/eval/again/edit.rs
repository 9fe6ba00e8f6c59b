//! What an edit changed of a text, and which statements it may have changed.

use std::ops::Range;

use luxel_core::diag::Diagnostic;

use super::Statement;
use super::warn::are_within;
use crate::budgets::Budgets;
use crate::syntax::{Cut, cut};

/// Bytes that are compared at once.
const BLOCK: usize = 4096;

/// One run of bytes that became another; what stands before and after it is the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Edit {
    pub(super) old: Range<usize>,
    pub(super) new: Range<usize>,
}

impl Edit {
    /// The shortest such run. Its ends may lie in a character.
    pub(super) fn of(old: &str, new: &str) -> Self {
        let (old, new) = (old.as_bytes(), new.as_bytes());
        let start = same(old.chunks(BLOCK), new.chunks(BLOCK), |a, b| {
            a.iter().zip(b).take_while(|(a, b)| a == b).count()
        });
        let (old_rest, new_rest) = (&old[start..], &new[start..]);
        let end = same(old_rest.rchunks(BLOCK), new_rest.rchunks(BLOCK), |a, b| {
            a.iter().rev().zip(b.iter().rev()).take_while(|(a, b)| a == b).count()
        });
        Self { old: start..old.len() - end, new: start..new.len() - end }
    }

    /// Where a byte after the edit stands now.
    pub(super) fn shifted(&self, at: usize) -> usize {
        at - self.old.end + self.new.end
    }
}

/// How many bytes are the same, block after block.
fn same<'a>(
    old: impl Iterator<Item = &'a [u8]>,
    new: impl Iterator<Item = &'a [u8]>,
    part: impl Fn(&[u8], &[u8]) -> usize,
) -> usize {
    let mut n_same = 0;
    for (old, new) in old.zip(new) {
        if old == new {
            n_same += old.len();
        } else {
            return n_same + part(old, new);
        }
    }
    n_same
}

/// Statements that were cut anew.
#[derive(Debug)]
pub(super) struct Recut {
    /// Which of the old ones are gone.
    pub(super) gone: Range<usize>,
    /// Those that stand in their place.
    pub(super) pieces: Vec<Cut>,
    /// What does not close in them, by places in the file.
    pub(super) faults: Vec<Diagnostic>,
}

/// Cuts anew what an edit may have changed of a text whose statements begin after byte `from`: from two
/// statements before it up to the first line after it on which one begins where one began. `None` if
/// something closes nothing, or stands where no statement can, or the rest of the file is another one.
pub(super) fn recut(
    (text, from): (&str, usize),
    edit: &Edit,
    stmts: &[Statement],
    budgets: &Budgets,
) -> Option<Recut> {
    let begun = stmts.partition_point(|stmt| stmt.range.start < edit.old.start);
    let mut first = begun.saturating_sub(2);
    let start = if first == 0 { from } else { stmts[first].range.start };
    let after = stmts.partition_point(|stmt| stmt.range.start < edit.old.end);
    let mut is_known = |at: usize| {
        at > edit.new.end
            && memchr::memchr(b'\n', &text.as_bytes()[edit.new.end..at]).is_some()
            && stmts[after..].binary_search_by_key(&at, |s| edit.shifted(s.range.start)).is_ok()
    };
    let found = cut(text, start, budgets, &mut is_known);
    if !found.faults.is_empty() && (found.met.is_none() || !are_within(&found.faults)) {
        return None;
    }
    let mut last = found.met.map_or(stmts.len(), |at| {
        after + stmts[after..].partition_point(|stmt| edit.shifted(stmt.range.start) < at)
    });
    let mut pieces = found.pieces;
    let is_before = |piece: &Cut, stmt: &Statement| {
        piece.range == stmt.range && piece.range.end <= edit.old.start && !piece.faulty
    };
    let n_before = stmts[first..last].iter().zip(&pieces);
    let n_before = n_before.take_while(|(stmt, piece)| is_before(piece, stmt)).count();
    pieces.drain(..n_before);
    first += n_before;
    let is_after = |Cut { range, faulty, .. }: &Cut, stmt: &Statement| {
        stmt.range.start >= edit.old.end
            && !faulty
            && range.start == edit.shifted(stmt.range.start)
            && range.end == edit.shifted(stmt.range.end)
    };
    while last > first && pieces.last().is_some_and(|piece| is_after(piece, &stmts[last - 1])) {
        pieces.pop();
        last -= 1;
    }
    Some(Recut { gone: first..last, pieces, faults: found.faults })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_run_that_differs_is_found() {
        let long = "x".repeat(3 * BLOCK);
        assert_eq!(Edit::of(&long, &long), Edit { old: 12288..12288, new: 12288..12288 });
        for (old, new, a, b) in [
            ("abc", "axc", 1..2, 1..2),
            ("aa", "aaa", 2..2, 2..3),
            ("", "a", 0..0, 0..1),
            ("abab", "ab", 2..4, 2..2),
            ("é", "è", 1..2, 1..2),
        ] {
            let found = Edit::of(old, new);
            assert_eq!(found, Edit { old: a.clone(), new: b.clone() }, "{old} {new}");
            let found = Edit::of(&format!("{long}{old}!{long}"), &format!("{long}{new}!{long}"));
            let further = |range: Range<usize>| range.start + long.len()..range.end + long.len();
            assert_eq!(found, Edit { old: further(a), new: further(b) }, "{old} {new}");
        }
    }
}
