//! The scene language: text to syntax to scene graph, with every mistake told at its place.
//!
//! `pest` is used here and nowhere else. This crate reads nothing itself (bytes come through
//! `Files`), prints nothing, and knows no plugin: it meets them as entries of a `Registry`.
#![forbid(unsafe_code)]

pub mod prescan;

mod budgets;
mod sink;
mod syntax;

pub use budgets::Budgets;

use luxel_core::diag::{Diagnostic, SourceId};

/// Reads a text without evaluating it; gives how many statements stand at its top level and what is
/// wrong with it. For measuring the parser alone.
pub fn parse_only(text: &str, budgets: &Budgets) -> (usize, Vec<Diagnostic>) {
    let mut sink = sink::Sink::new(budgets.diagnostics);
    let tree = syntax::parse(text, SourceId(0), budgets, &mut sink);
    (tree.stmts.len(), sink.finish())
}
