//! A statement without the inner statements that cannot be read.

use std::ops::Range;

use super::tree::Stmt;

/// What stands in the place of a statement that cannot be read, for the grammar to go on.
const FILLING: &str = "a=0";

/// Inner statements that cannot be read, by where they begin, in order.
#[derive(Debug, Default)]
pub(super) struct Gaps {
    gaps: Vec<Gap>,
    /// How many of them the tree has.
    n_filled: usize,
}

#[derive(Debug)]
struct Gap {
    range: Range<usize>,
    broken: Stmt,
}

impl Gaps {
    /// Those at some bytes of a text. What stands in another one goes with it.
    pub(super) fn new(mut wrong: Vec<Range<usize>>, broken: impl Fn(Range<usize>) -> Stmt) -> Self {
        wrong.sort_by_key(|range| (range.start, std::cmp::Reverse(range.end)));
        let mut gaps: Vec<Gap> = vec![];
        for range in wrong {
            if gaps.last().is_none_or(|last| last.range.end <= range.start) {
                gaps.push(Gap { range: range.clone(), broken: broken(range) });
            }
        }
        Self { gaps, n_filled: 0 }
    }

    /// A statement of the text with others in the place of those: each byte that is left stands where it
    /// stood. `None` if there are none, or one is too short, or the whole.
    pub(super) fn filled(&self, text: &str, stmt: &Range<usize>) -> Option<String> {
        let mut bytes = text.as_bytes()[stmt.clone()].to_vec();
        for Gap { range, .. } in &self.gaps {
            let within = stmt.start < range.start && range.end <= stmt.end;
            if !within || range.len() < FILLING.len() {
                return None;
            }
            let gap = &mut bytes[range.start - stmt.start..range.end - stmt.start];
            // What follows on its line is another one.
            let ends = gap.len() > FILLING.len() && !gap.contains(&b'\n');
            gap.iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
            gap[..FILLING.len()].copy_from_slice(FILLING.as_bytes());
            if ends {
                gap[FILLING.len()] = b',';
            }
        }
        String::from_utf8(bytes).ok().filter(|_| !self.gaps.is_empty())
    }

    /// The statement that cannot be read and begins here.
    pub(super) fn at(&mut self, start: usize) -> Option<Stmt> {
        let i = self.gaps.binary_search_by_key(&start, |gap| gap.range.start).ok()?;
        self.n_filled += 1;
        Some(self.gaps[i].broken.clone())
    }

    /// Whether each stands in the tree that was built.
    pub(super) fn are_filled(&self) -> bool {
        self.n_filled == self.gaps.len()
    }
}
