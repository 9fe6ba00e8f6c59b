//! What was odd about plugin libraries, for whoever runs a command.

use luxel_core::diag::{Diagnostic, Severity, Sources};

use crate::exit::Failure;
use crate::report::{self, Form, Stream};

/// Warnings that belong to no place in a scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes(Vec<Diagnostic>);

impl Notes {
    /// Adds a warning.
    pub(crate) fn warn(&mut self, message: impl Into<String>) {
        let told = Diagnostic::unplaced("E0414", message);
        self.0.push(Diagnostic { severity: Severity::Warning, ..told });
    }

    /// Prints them in the form of a scene's diagnostics.
    ///
    /// # Errors
    /// As `report::out`, where they go there.
    pub(crate) fn tell(&self, form: Form, stream: Stream) -> Result<(), Failure> {
        report::diagnostics(&self.0, &Sources::default(), form, stream)
    }

    #[cfg(test)]
    pub(crate) fn messages(&self) -> Vec<&str> {
        self.0.iter().map(|told| told.message.as_str()).collect()
    }
}
