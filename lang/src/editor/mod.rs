//! What an editor asks of a text: pure functions over documents and a registry. Offsets are bytes; no
//! protocol, no disk.

mod define;
mod document;
mod lines;
mod piece;
mod symbols;
#[cfg(test)]
mod tests;

pub use define::{Place, Project, definition, references, renamable, rename};
pub use document::Document;
