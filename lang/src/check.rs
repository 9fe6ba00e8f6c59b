//! What must hold of any text, as only the inside can tell: for `tests/fuzz`, with the feature `fuzz`.

use crate::editor::{self, Document};
use crate::fmt::check::{formatted, made};
use crate::{Budgets, format, syntax};

/// Reading by statement is reading the file whole; whether the text can be read.
///
/// # Panics
/// If one way reads what the other refuses, or something else.
pub fn chunks(text: &str) -> bool {
    syntax::check::whole(text)
}

/// Formatting keeps the tree and every comment, and changes nothing the second time; whether the text
/// can be formatted.
///
/// # Panics
/// If it does not.
pub fn format_keeps(text: &str) -> bool {
    if format(text, &Budgets::default()).is_err() {
        return false;
    }
    formatted(text).unwrap_or_else(|why| panic!("{why}"));
    true
}

/// The scene whose forms these bytes choose is read, however it is laid out, as the same tree, and
/// formatting keeps it; whether they choose one.
///
/// # Panics
/// If it does not.
pub fn made_keeps(bytes: &[u8]) -> bool {
    let Some(scene) = made::chosen(bytes) else { return false };
    made::judge(&scene).unwrap_or_else(|why| panic!("{why}"));
    true
}

/// An edited document is the document of the edited text; `step` says which edit was the last.
///
/// # Panics
/// If it is not.
pub fn edited(document: &Document, step: &str) {
    editor::check::same(document, step);
}
