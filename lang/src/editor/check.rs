//! An edited document is the document of the edited text. Asked by tests and by `tests/fuzz`.

use super::Document;
use super::piece::Piece;
use crate::Budgets;

/// Holds an edited document against a new one of its text; `step` says which edit was the last.
///
/// # Panics
/// If they differ.
pub(crate) fn same(edited: &Document, step: &str) {
    let fresh = Document::new(edited.text(), &Budgets::default());
    let pieces = |document: &Document| -> Vec<_> {
        let of = |piece: &Piece| (piece.start, piece.end, piece.faulty, piece.read.stmts.clone());
        document.pieces().iter().map(of).collect()
    };
    assert_eq!(pieces(edited), pieces(&fresh), "{step}:\n{}", edited.text());
    let sorted = |document: &Document| {
        let mut found = document.diagnostics();
        found.sort_by_key(|found| (found.span(), found.code));
        found
    };
    assert_eq!(sorted(edited), sorted(&fresh), "{step}:\n{}", edited.text());
}
