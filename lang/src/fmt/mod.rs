//! A scene's text, laid out: the same tree, the same comments, one way to write them.
//!
//! The text is read first, and refused with its mistakes if any of it cannot be; then its tokens and
//! comments are written anew. What is on one line stays there while it fits, what is on several stays
//! on several. Everything takes time in proportion to the text.

mod align;
mod block;
mod bracket;
#[cfg(any(test, feature = "fuzz"))]
pub(crate) mod check;
mod layout;
mod marks;
mod measure;
mod out;
mod piece;
mod sequence;
mod table;
#[cfg(test)]
mod tests;

use luxel_core::diag::{Diagnostic, SourceId};

use crate::budgets::Budgets;
use crate::sink::Sink;
use crate::syntax::{self, Tree};
use layout::Layout;
use marks::Marks;

/// Columns of a line.
const WIDTH: usize = 100;
/// Columns of a step of indentation.
const STEP: usize = 2;

/// The text as the formatter writes it.
///
/// Lines end in `\n`, the last one too; a byte order mark is left out. Strings, numbers and units are
/// kept to the letter. Formatting again changes nothing.
///
/// # Errors
/// What is wrong with a text that cannot be read, warnings among it unless they are too many; places
/// are bytes of `text`.
pub fn format(text: &str, budgets: &Budgets) -> Result<String, Vec<Diagnostic>> {
    let (tree, sink) = read(text, budgets);
    if sink.errors() > 0 {
        let mut found = sink.finish();
        if found.len() > budgets.diagnostics {
            found.retain(Diagnostic::is_error);
        }
        return Err(found);
    }
    let mut pieces = piece::pieces(text, &Marks::of(&tree));
    measure::measure(&mut pieces);
    Ok(Layout::new(pieces, text.len()).file())
}

/// The tree of a text, and what is wrong with it.
fn read(text: &str, budgets: &Budgets) -> (Tree, Sink) {
    let mut sink = Sink::new(budgets.diagnostics.max(1));
    let tree = syntax::parse(text, SourceId(0), budgets, &mut sink);
    (tree, sink)
}
