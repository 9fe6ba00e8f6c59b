//! The second reader: statements straight from their bytes, many times as fast as pest.
//!
//! `scene.pest` stays the grammar of record, and this reader follows it rule by rule. It reads only
//! what is right: at the first thing that it does not expect, or that is to be told, it gives up
//! (every `None` here), and pest reads the statement and explains it. What it reads is the tree that
//! pest gives, span by span; `agree` holds it to that.
//!
//! The grammar takes the first alternative that fits and never comes back. So an alternative is taken
//! here only where none before it fits, and a repetition ends only where its part does not fit.

mod cursor;
mod expr;
mod head;
mod numbers;
mod stmt;
mod token;
mod words;

use std::ops::Range;

use luxel_core::diag::{SourceId, Span};

use super::operators::Operand;
use super::tree::{Op, Stmt};
use crate::budgets::Budgets;
use cursor::Cursor;
pub(super) use words::Words;

/// How deep expressions and blocks may nest: twice the brackets that the pre-scan lets through, and
/// some for what nests without brackets.
const DEPTH: usize = 300;

/// Reads the one statement that the bytes hold; `None` if it is left to pest.
pub(super) fn read(
    text: &str,
    range: Range<usize>,
    source: SourceId,
    budgets: &Budgets,
    words: &mut Words,
) -> Option<Stmt> {
    let end = range.end;
    let cursor = Cursor::new(&text[..end], range.start);
    let mut reader = Reader::new(cursor, source, budgets, words);
    reader.cursor.skip();
    let stmt = reader.stmt()?;
    reader.cursor.skip();
    (reader.cursor.at == end).then_some(stmt)
}

/// Reads from a cursor on.
struct Reader<'a> {
    cursor: Cursor<'a>,
    source: SourceId,
    budgets: &'a Budgets,
    words: &'a mut Words,
    /// Room for the numbers of a list.
    numbers: Vec<f64>,
    /// Operands and operators of expressions that are being read, the outermost first.
    operands: Vec<Operand>,
    ops: Vec<(Op, Span)>,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn new(
        cursor: Cursor<'a>,
        source: SourceId,
        budgets: &'a Budgets,
        words: &'a mut Words,
    ) -> Self {
        let (numbers, operands, ops) = (vec![], vec![], vec![]);
        Self { cursor, source, budgets, words, numbers, operands, ops, depth: 0 }
    }

    /// From `start` to where reading stands.
    fn span(&self, start: usize) -> Span {
        Span::new(self.source, start, self.cursor.at)
    }

    /// Goes a level deeper, unless that is too deep.
    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if self.depth == DEPTH {
            return None;
        }
        self.depth += 1;
        let made = read(self);
        self.depth -= 1;
        made
    }

    /// What stands up to `close`, parted by commas, and whether a comma stands after the last.
    fn listed<T>(
        &mut self,
        close: u8,
        mut read: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<(Box<[T]>, bool)> {
        let (mut made, mut comma) = (vec![], false);
        loop {
            self.cursor.skip();
            if self.cursor.takes(close) {
                return Some((made.into(), comma));
            }
            if !made.is_empty() && !comma {
                return None;
            }
            made.push(read(self)?);
            self.cursor.skip();
            comma = self.cursor.takes(b',');
        }
    }
}
