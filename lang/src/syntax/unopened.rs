//! Blocks whose `{` is missing: one mistake, not one at each end.

use std::collections::HashMap;
use std::ops::Range;

use super::cut::Region;
use super::head::opens_block;
use super::lex::tokens;
use crate::prescan::Fault;

/// Takes a `}` that closes nothing for the end of the last `for` or `if` before it that has no `{`.
///
/// That head tells the mistake. What stands between is the block: it cannot be read without its head.
pub(super) fn unopened(text: &str, found: &mut Region) {
    let pieces = &mut found.pieces;
    // Each statement is looked through once, however many braces are asked about.
    let mut known = HashMap::new();
    found.faults.retain(|fault| {
        let Fault::Stray { at } = fault else { return true };
        let after = pieces.partition_point(|piece| piece.range.start < *at);
        let first = after.saturating_sub(LOOKED_AT);
        let is_head = |i: &usize| {
            *known.entry(*i).or_insert_with(|| lacks_block(text, pieces[*i].range.clone()))
        };
        let Some(head) = (first..after).rev().find(is_head) else { return true };
        // A head on the line of its block ends in the brace itself.
        pieces[head].faulty = false;
        pieces[head + 1..after].iter_mut().for_each(|piece| piece.headless = true);
        false
    });
}

/// Statements before a brace among which its head is looked for.
const LOOKED_AT: usize = 100;

/// Whether a statement begins as one with a block and opens none.
fn lacks_block(text: &str, range: Range<usize>) -> bool {
    let mut tokens = tokens(text, range);
    tokens.next().is_some_and(|first| opens_block(first.text)) && tokens.all(|t| t.text != "{")
}
