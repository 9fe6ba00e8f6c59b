//! What an editor asks of a text: pure functions over documents and a registry. Offsets are bytes; no
//! protocol, no disk.

#[cfg(any(test, feature = "fuzz"))]
pub(crate) mod check;
mod complete;
mod context;
mod define;
mod document;
mod fold;
mod hover;
mod joined;
mod lines;
mod named;
mod outline;
mod piece;
mod schema;
mod statements;
mod swatch;
mod symbols;
#[cfg(test)]
mod tests;
mod texts;
mod tokens;

pub use complete::{Completion, Item, ItemKind, OnDisk, complete};
pub use define::{Place, Project, definition, reached, references, renamable, rename};
pub use document::Document;
pub use fold::{Fold, folds};
pub use hover::{Hover, hover};
pub use outline::{Entry, EntryKind, outline};
pub use swatch::{Swatch, swatches, written};
pub use tokens::{Colour, Coloured, coloured};
