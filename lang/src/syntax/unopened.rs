//! Blocks whose `{` is missing: one mistake, not one at each end.

use std::collections::HashMap;
use std::ops::Range;

use super::around::is_category;
use super::cut::Region;
use super::head::opens_block;
use super::lex::{Token, tokens};
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

/// Whether a statement begins as one with a block and opens none, or what stands in that begins before the
/// first brace.
fn lacks_block(text: &str, range: Range<usize>) -> bool {
    let tokens: Vec<_> = tokens(text, range).collect();
    let begins = |i: &usize| {
        let before = i.checked_sub(1).map_or("{", |before| tokens[before].text);
        let begins = tokens[*i].first_on_line || matches!(before, "{" | "}" | ";" | "else");
        begins && opens_block(tokens[*i].text)
    };
    let lacks = |i: usize| {
        let length = tokens[i..].iter().take_while(|token| token.text != "{").count();
        let goes_on = |pair: &[Token<'_>]| pair[0].ends_operand() && is_category(pair[1].text);
        i + length == tokens.len() || tokens[i..i + length].windows(2).any(goes_on)
    };
    !tokens.is_empty() && begins(&0) && (0..tokens.len()).filter(begins).any(lacks)
}
