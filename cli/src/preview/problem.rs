//! A message that lies over the picture.

use luxel_core::diag::{Diagnostic, Severity, Sources};
use serde::Serialize;

use crate::exit::Failure;
use crate::report;

/// A message with its excerpt.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Problem {
    severity: &'static str,
    /// As on the terminal.
    text: String,
}

impl Problem {
    /// A diagnostic with the lines at fault.
    pub(crate) fn of_diagnostic(diagnostic: &Diagnostic, sources: &Sources) -> Self {
        let severity = match diagnostic.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        Self { severity, text: report::excerpt(diagnostic, sources) }
    }

    /// Why something could not be done.
    pub(crate) fn of_failure(failure: &Failure) -> Self {
        let help = failure.help.as_ref().map_or(String::new(), |help| format!("\n  help: {help}"));
        Self { severity: "error", text: format!("error: {}{help}", failure.message) }
    }
}

#[cfg(test)]
mod tests {
    use luxel_core::diag::Span;

    use super::*;

    #[test]
    fn a_problem_holds_the_line_at_fault_and_no_colours() {
        let mut sources = Sources::default();
        let id = sources.add("a.scene", "sphere { radus = 5 m }");
        let found = Diagnostic::error("E0402", Span::new(id, 9, 14), "no `radus`");
        let told = Problem::of_diagnostic(&found, &sources);
        assert_eq!(told.severity, "error");
        assert!(told.text.contains("a.scene:1:10") && !told.text.contains('\x1b'), "{}", told.text);
        let failure = Failure::new(crate::exit::Exit::Input, "no file").help("name one");
        assert_eq!(Problem::of_failure(&failure).text, "error: no file\n  help: name one");
    }
}
