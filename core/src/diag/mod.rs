//! What went wrong, where, and what would be right: one form for every author's mistake.
//!
//! A `Diagnostic` is data. Printing it is the command line's work; nothing here does input or output.

mod mend;
mod near;
mod sources;

use std::collections::HashSet;
use std::fmt;

use serde::Serialize;

pub use mend::{Mended, applied, mend};
pub use near::{Near, near, nearest};
pub use sources::{LineColumn, SourceId, Sources};

/// A range of bytes in one source file, `start <= end`, both on character boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Span {
    /// The file.
    pub source: SourceId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The bytes `start..end` of `source`.
    pub fn new(source: SourceId, start: usize, end: usize) -> Self {
        let clip = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Self { source, start: clip(start), end: clip(end.max(start)) }
    }

    /// The smallest span that covers both; `other` is ignored when it is in another file.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        if other.source != self.source {
            return self;
        }
        Self { start: self.start.min(other.start), end: self.end.max(other.end), ..self }
    }

    /// The bytes as a range.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// How grave a diagnostic is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing; the scene can still be rendered.
    Warning,
    /// The scene cannot be rendered.
    Error,
}

/// A place that belongs to a diagnostic, with what is to be seen there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is there; may be empty.
    pub text: String,
}

/// How sure a mend is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// It says what the author meant: a program may apply it unasked.
    Sure,
    /// It is likely, or one of several: a person chooses.
    Guess,
}

/// A replacement that mends the mistake.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fix {
    /// What is replaced; an empty span inserts.
    pub span: Span,
    /// The new text.
    pub replacement: String,
    /// Whether it may be applied unasked.
    pub grade: Grade,
}

impl Fix {
    /// The text of the fix's file with the fix applied.
    pub fn applied(&self, text: &str) -> String {
        let Span { start, end, .. } = self.span;
        format!("{}{}{}", &text[..start as usize], self.replacement, &text[end as usize..])
    }
}

/// Keeps the first of those that say the same of the same place, as each turn of a loop does.
pub(crate) fn tell_once(diagnostics: &mut Vec<Diagnostic>) {
    let mut told = HashSet::new();
    diagnostics.retain(|found| told.insert((found.code, found.span(), found.message.clone())));
}

/// One mistake (or warning), with its code, places, advice and mends.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// `E0402`: stable, listed in the catalogue.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// What was found, lower case, no full stop.
    pub message: String,
    /// The first label is the primary place. Empty when no place in a file is at fault.
    pub labels: Vec<Label>,
    /// What would be right.
    pub help: Vec<String>,
    /// Mends that a program may apply.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// An error at `span`.
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Self::unplaced(code, message).label(span, "")
    }

    /// A warning at `span`.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, span, message) }
    }

    /// An error that no place in a file can be blamed for.
    pub fn unplaced(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: Severity::Error,
            message: message.into(),
            labels: vec![],
            help: vec![],
            fixes: vec![],
        }
    }

    /// Adds a place; the first one added is primary.
    #[must_use]
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    /// Says what is to be seen at the primary place.
    #[must_use]
    pub fn saying(mut self, text: impl Into<String>) -> Self {
        if let Some(first) = self.labels.first_mut() {
            first.text = text.into();
        }
        self
    }

    /// Adds a line of advice.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help.push(text.into());
        self
    }

    /// Adds a mend that is sure.
    #[must_use]
    pub fn fix(self, span: Span, replacement: impl Into<String>) -> Self {
        self.mend(span, replacement, Grade::Sure)
    }

    /// Adds a mend that a person must choose.
    #[must_use]
    pub fn guess(self, span: Span, replacement: impl Into<String>) -> Self {
        self.mend(span, replacement, Grade::Guess)
    }

    /// Adds a mend of a grade.
    #[must_use]
    pub fn mend(mut self, span: Span, replacement: impl Into<String>, grade: Grade) -> Self {
        self.fixes.push(Fix { span, replacement: replacement.into(), grade });
        self
    }

    /// The mend that may be applied unasked; of several that are sure a person chooses.
    pub fn sure(&self) -> Option<&Fix> {
        let mut sure = self.fixes.iter().filter(|fix| fix.grade == Grade::Sure);
        sure.next().filter(|_| sure.next().is_none())
    }

    /// Asks whether a near name was meant, and offers it.
    #[must_use]
    pub fn meant(self, span: Span, near: Option<Near<'_>>) -> Self {
        let Some(Near { name, grade }) = near else { return self };
        self.help(format!("did you mean `{name}`?")).mend(span, name, grade)
    }

    /// The same for a text in quotes.
    #[must_use]
    pub fn meant_text(self, span: Span, near: Option<Near<'_>>) -> Self {
        let Some(Near { name, grade }) = near else { return self };
        self.help(format!("did you mean \"{name}\"?")).mend(span, format!("\"{name}\""), grade)
    }

    /// The primary place.
    pub fn span(&self) -> Option<Span> {
        self.labels.first().map(|label| label.span)
    }

    /// Changes every place that it tells of.
    pub fn place(&mut self, place: impl Fn(Span) -> Span) {
        self.labels.iter_mut().for_each(|label| label.span = place(label.span));
        self.fixes.iter_mut().for_each(|fix| fix.span = place(fix.span));
    }

    /// Whether the scene cannot be rendered.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.code, self.message)
    }
}

/// The same in the order of files and lines; what has no place comes last.
pub fn in_order(found: &[Diagnostic]) -> Vec<Diagnostic> {
    let mut found = found.to_vec();
    found.sort_by_key(|found| (found.span().is_none(), found.span()));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_goes_by_places_and_what_has_none_comes_last() {
        let at = |source, start| {
            Diagnostic::error("E0001", Span::new(SourceId(source), start, start + 1), "x")
        };
        let later = Diagnostic::warning("E0002", Span::new(SourceId(0), 7, 8), "y");
        let lone = Diagnostic::unplaced("E0409", "z");
        let found = [lone.clone(), at(1, 0), at(0, 7), later.clone(), at(0, 2)];
        assert_eq!(in_order(&found), [at(0, 2), at(0, 7), later, at(1, 0), lone]);
    }
}
