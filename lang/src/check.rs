//! What must hold of any bytes, as only the inside can tell: for `tests/fuzz`, with the feature `fuzz`.
//!
//! Each function judges one input, says whether it was of use, and panics if something else holds.

#[cfg(test)]
mod tests;

use crate::editor::{self, Document};
use crate::fmt::check;
use crate::{Budgets, format, syntax};

/// Byte that no text holds: it parts a text from its edits.
const PART: u8 = 0xFF;

/// Reading by statement is reading the file whole.
///
/// # Panics
/// If one way reads what the other refuses, or something else.
pub fn chunks(bytes: &[u8]) -> bool {
    str::from_utf8(bytes).is_ok_and(syntax::check::whole)
}

/// Formatting keeps the tree and every comment, and changes nothing the second time.
///
/// # Panics
/// If it does not.
pub fn format_keeps(bytes: &[u8]) -> bool {
    let text = str::from_utf8(bytes).ok();
    let Some(text) = text.filter(|text| format(text, &Budgets::default()).is_ok()) else {
        return false;
    };
    check::formatted(text).unwrap_or_else(|why| panic!("{why}"));
    true
}

/// The scene whose forms the bytes choose is read, however it is laid out, as the same tree, and
/// formatting keeps it.
///
/// # Panics
/// If it does not.
pub fn made_keeps(bytes: &[u8]) -> bool {
    let Some(scene) = check::chosen(bytes) else { return false };
    check::made_keeps(&scene).unwrap_or_else(|why| panic!("{why}"));
    true
}

/// An edited document is the document of the edited text, after each of some edits: two bytes say
/// where in the text, one how much goes, the rest comes.
///
/// # Panics
/// If it is not.
pub fn edits(bytes: &[u8]) -> bool {
    let mut parts = bytes.split(|byte| *byte == PART);
    let text = parts.next().map(String::from_utf8_lossy).unwrap_or_default();
    let mut document = Document::new(text, &Budgets::default());
    let mut n = 0;
    for part in parts.take(32) {
        let Some(([high, low, length], with)) = part.split_first_chunk() else { continue };
        let share = usize::from(u16::from_be_bytes([*high, *low]));
        let start = (share * (document.text().len() + 1)) >> 16;
        let (end, with) = (start + usize::from(*length), String::from_utf8_lossy(with));
        document.edit(start..end, &with);
        n += 1;
        editor::check::same(&document, &format!("edit {n}, {start}..{end} {with:?}"));
    }
    n > 0
}
