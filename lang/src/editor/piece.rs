//! One statement of a document, read: with spans that count from its first byte, so that it stays
//! as it is while others are edited.

use std::sync::{Arc, OnceLock};

use luxel_core::diag::Diagnostic;

use super::symbols::{Symbol, symbols};
use crate::budgets::Budgets;
use crate::eval::names::{Facts, Known, Numbered, RELATIVE, place};
use crate::syntax::{Stmt, read_piece};

/// A statement in its place.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) start: usize,
    pub(super) end: usize,
    /// Something in it does not close.
    pub(super) faulty: bool,
    /// Nothing is wrong with it and nothing around it concerns it.
    pub(super) is_alone: bool,
    pub(super) read: Arc<Read>,
    /// Its names, empty until the document knows them.
    pub(super) numbered: Numbered,
}

/// What a statement says.
#[derive(Debug, Default)]
pub(super) struct Read {
    /// One; none or several where something could not be read.
    pub(super) stmts: Vec<Stmt>,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) facts: Facts,
    symbols: OnceLock<Vec<Symbol>>,
}

impl Piece {
    /// Reads `text[start..end]`.
    pub(super) fn new(
        text: &str,
        start: usize,
        end: usize,
        faulty: bool,
        budgets: &Budgets,
    ) -> Self {
        let (stmts, diagnostics) = read_piece(&text[start..end], faulty, RELATIVE, budgets);
        let facts = Facts::of(&text[start..end], &stmts);
        let is_alone = facts.is_alone() && diagnostics.is_empty();
        let read = Arc::new(Read { stmts, diagnostics, facts, symbols: OnceLock::new() });
        Self { start, end, faulty, is_alone, read, numbered: Numbered::default() }
    }

    /// Learns the numbers of its names.
    pub(super) fn number(&mut self, known: &mut Known) {
        if self.numbered.is_unknown() {
            self.numbered = known.numbered(&self.read.facts);
        }
    }

    /// What its doc comment says.
    pub(super) fn doc(&self) -> String {
        let docs = self.read.stmts.first().into_iter().flat_map(|stmt| &stmt.docs);
        docs.map(|doc| doc.text.as_str()).collect::<Vec<_>>().join("\n")
    }

    /// Its names, in the order of the text.
    pub(super) fn symbols(&self) -> &[Symbol] {
        self.read.symbols.get_or_init(|| symbols(&self.read.stmts))
    }
}

/// A diagnostic of a statement in its file.
pub(super) fn placed(mut diagnostic: Diagnostic, start: usize) -> Diagnostic {
    place(&mut diagnostic, start);
    diagnostic
}
