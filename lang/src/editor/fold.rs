//! What can be folded: brackets and comments over several lines.

use super::document::Document;
use crate::syntax::{TokenKind, tokens};

/// Lines, from 0, that can be folded into the first of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fold {
    /// The line that stays.
    pub start: usize,
    /// The last line that goes.
    pub end: usize,
    /// Whether it is a comment.
    pub is_comment: bool,
}

/// What can be folded, in order of the last lines; nothing more once `stop` says so.
pub fn folds(document: &Document, stop: &dyn Fn() -> bool) -> Vec<Fold> {
    let text = document.text();
    let mut open: Vec<usize> = vec![];
    let mut out = comments(document);
    let mut add = |start: usize, end: usize| {
        if start < end {
            out.push(Fold { start, end, is_comment: false });
        }
    };
    for token in tokens(text, 0..text.len()).take_while(|_| !stop()) {
        let line = || document.line_of(token.start);
        match (token.kind, token.text) {
            (TokenKind::Table, table) => {
                let end = document.line_of(token.start + table.len() - 1);
                add(line(), end.saturating_sub(1));
            }
            (TokenKind::Mark, "(" | "[" | "{") => open.push(line()),
            // The line of the closing bracket stays in sight.
            (TokenKind::Mark, ")" | "]" | "}") => {
                let end = line().saturating_sub(1);
                open.pop().into_iter().for_each(|start| add(start, end));
            }
            _ => {}
        }
    }
    out
}

/// Lines of comments that follow one another.
fn comments(document: &Document) -> Vec<Fold> {
    let (mut out, mut first) = (vec![], None);
    for line in 0..=document.n_lines() {
        let is_comment = line < document.n_lines()
            && document.text()[document.line(line)].trim_start().starts_with("//");
        match first {
            None if is_comment => first = Some(line),
            Some(start) if !is_comment => {
                if line > start + 1 {
                    out.push(Fold { start, end: line - 1, is_comment: true });
                }
                first = None;
            }
            _ => {}
        }
    }
    out
}
