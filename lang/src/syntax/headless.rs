//! Statements whose first words cannot be read, though what stands in their block can.

use std::ops::Range;

use super::around::{is_category, stands_nowhere};
use super::closing::rewritten;
use super::edits::Mended;
use super::head::opens_block;
use super::lex::{Token, TokenKind, tokens};
use crate::words::STATEMENTS;

/// Words of other languages, and one of ours, with which nothing begins that has a block.
const FOREIGN: [&str; 7] = ["else", "foreach", "loop", "repeat", "unless", "until", "while"];

/// Tokens of such a head, at most.
const MOST: usize = 24;

/// A statement with a head in place of its own.
pub(super) struct Headed {
    pub(super) mended: Mended,
    /// Where the block begins that follows the head.
    pub(super) brace: usize,
}

/// A statement that cannot be read up to byte `at`, with a head that can; it begins at byte `base` of its text.
/// `None` where no block follows that is of use.
///
/// What a loop or a choice would do is done once.
pub(super) fn headed(piece: &str, base: usize, at: usize) -> Option<Headed> {
    let all = tokens(piece, 0..piece.len()).filter(|token| token.kind != TokenKind::Doc);
    let all: Vec<Token<'_>> = all.take(MOST).collect();
    let i = brace(&all)?;
    let (head, brace) = (&all[..i], all[i].start);
    let first = head.first()?;
    if at >= brace {
        return None;
    }
    let is_step = opens_block(first.text) || FOREIGN.contains(&first.text);
    let mends = if is_step {
        // The block of an object or of another statement that stands in it is none of its own.
        let has_object = head.iter().any(|token| is_category(token.text));
        let is_other = has_object || STATEMENTS.contains(&head.last()?.text);
        (!is_other && is_named(head)).then(|| vec![(first.start..brace, "if true ".to_owned())])?
    } else {
        object(head, brace)?
    };
    let mends: Vec<_> = mends.iter().map(|(at, new)| (at.clone(), &**new)).collect();
    Some(Headed { mended: rewritten(piece, base, &mends), brace })
}

/// Whether a name stands where that of a loop does, and behind each comma: what uses it in the block is right.
fn is_named(head: &[Token<'_>]) -> bool {
    let [first, rest @ ..] = head else { return false };
    if !matches!(first.text, "for" | "foreach") {
        return true;
    }
    let end = rest.iter().position(|token| token.text == "in");
    let mut names = rest[..end.unwrap_or(rest.len())].iter().filter(|token| token.text != "(");
    let is_name = |token: &Token<'_>| token.kind == TokenKind::Word;
    let begins = names.clone().next().is_some_and(is_name);
    begins && (end.is_none() || names.next_back().is_some_and(is_name))
}

/// What makes a head one of an object that goes on to a brace: its label has quotes, or names it where it
/// stands nowhere.
fn object(head: &[Token<'_>], brace: usize) -> Option<Vec<(Range<usize>, String)>> {
    let [category, kind, rest @ ..] = head else { return None };
    let gives = head.iter().any(|token| matches!(token.text, "=" | ":"));
    if !is_category(category.text) || kind.kind != TokenKind::Word || gives {
        return None;
    }
    let behind = kind.end()..brace;
    let [label] = rest else { return Some(vec![(behind, " ".to_owned())]) };
    let is_named = label.kind == TokenKind::Word;
    Some(if !is_named {
        vec![(behind, " ".to_owned())]
    } else if stands_nowhere(category.text) {
        let before = category.start..category.start;
        vec![(before, format!("let {} = ", label.text)), (behind, " ".to_owned())]
    } else {
        vec![(behind, format!(" \"{}\" ", label.text))]
    })
}

/// The brace that follows a head, outside its brackets.
fn brace(head: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0_usize;
    for (i, token) in head.iter().enumerate().filter(|(_, token)| token.kind == TokenKind::Mark) {
        match token.text {
            "{" if depth == 0 => return Some(i),
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.checked_sub(1)?,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_read_whose_head_cannot_be() {
        let headed = |piece: &str, at: usize| headed(piece, 0, at).map(|it| it.mended.text);
        for (piece, at, wanted) in [
            ("for i 0..n { a }", 6, Some("if true { a }")),
            ("for (int i = 0; i < n; i++) { a }", 4, Some("if true { a }")),
            ("while x { a } else { b }", 6, Some("if true { a } else { b }")),
            ("shape sphere egg { a }", 13, Some("shape sphere \"egg\" { a }")),
            ("shape sphere 5 { a }", 13, Some("shape sphere { a }")),
            ("material diffuse egg { a }", 17, Some("let egg = material diffuse { a }")),
            ("shape sphere { a b }", 17, None),
            ("material gold = conductor { a }", 14, None),
            ("for i in (0..n { a })", 15, None),
            ("egg sphere big { a }", 4, None),
            ("for i in shape sphere { a }", 9, None),
            ("for in 0..n { a }", 4, None),
            ("for i, in 0..n { a }", 7, None),
            ("for (, i in 0..n) { a }", 5, None),
            ("for i j in 0..n { a }", 6, Some("if true { a }")),
        ] {
            assert_eq!(headed(piece, at).as_deref(), wanted, "{piece}");
        }
    }
}
