//! Reading by statement is reading the file whole. Asked by tests and by `tests/fuzz`.

use luxel_core::diag::{Diagnostic, SourceId};

use super::lex::tokens;
use super::parse::{Tree, parse, parse_whole, read_head};
use crate::budgets::Budgets;
use crate::prescan::{Fault, scan};
use crate::sink::Sink;

/// Reads a text in both ways; whether it can be read.
///
/// # Panics
/// If one way reads what the other refuses, or something else.
pub(crate) fn whole(text: &str) -> bool {
    let (budgets, source) = (Budgets::default(), SourceId(0));
    // The grammar takes any version.
    if read_head(text, &budgets).1.iter().any(Diagnostic::is_error) {
        return false;
    }
    let too_deep = |fault: &Fault| matches!(fault, Fault::TooDeep { .. });
    if scan(text, 0..text.len(), 0, budgets.brackets).faults.iter().any(too_deep) {
        return false;
    }
    let mut told = Sink::new(budgets.diagnostics);
    let by_statement = parse(text, source, &budgets, &mut told);
    let mut told_whole = Sink::new(budgets.diagnostics);
    let whole = parse_whole(text, source, &budgets, &mut told_whole);
    let whole = whole.filter(|_| told_whole.errors() == 0);
    if told.errors() > 0 {
        let told = told.finish();
        // Only the whole file may hold two statements in a line without anything between.
        let whole = whole.filter(|whole| are_apart(text, whole));
        assert!(whole.is_none(), "only by statement something is wrong: {told:?}\n{text}");
        return false;
    }
    assert_eq!(Some(by_statement), whole, "{text}");
    true
}

/// Whether each statement begins a line, or follows a comma or semicolon.
fn are_apart(text: &str, tree: &Tree) -> bool {
    let mut statements = tree.stmts.iter().skip(1).map(|stmt| stmt.span.range().start).peekable();
    let mut before = "";
    let are_apart = tokens(text, 0..text.len()).all(|token| {
        let begins = statements.next_if_eq(&token.start).is_some();
        let apart = !begins || token.first_on_line || matches!(before, "," | ";");
        before = token.text;
        apart
    });
    // One that begins inside a token, as after `1` in `1_x {}`, follows what it stands in.
    are_apart && statements.next().is_none()
}
