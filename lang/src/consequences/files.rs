//! What is unknown because another scene file is not read.

use std::collections::BTreeSet;

use luxel_core::diag::{Diagnostic, Sources, Span};

use super::{LOOKED_AT, line_of};
use crate::syntax::{TokenKind, tokens};

/// What files may bring that are not read.
#[derive(Default)]
pub(super) struct Unread<'a> {
    /// Labels.
    pub(super) hides_labels: bool,
    /// The words of their lines: an import has its name there.
    pub(super) words: BTreeSet<&'a str>,
}

/// What lines hide that read a file and are wrong themselves.
pub(super) fn unread<'a>(diagnostics: &[Diagnostic], sources: &'a Sources) -> Unread<'a> {
    let is_wrong = |found: &&Diagnostic| {
        found.is_error() && (found.code.starts_with("E00") || found.code.starts_with("E02"))
    };
    let wrong = diagnostics.iter().filter(is_wrong);
    let lines: Vec<_> = wrong.filter_map(|found| line(found.span()?, sources)).collect();
    // What stands in braces are values that the file is given.
    let head = |line: &&'a str| tokens(line, 0..line.len()).take_while(|it| it.text != "{");
    let words = lines.iter().flat_map(head);
    Unread {
        hides_labels: !lines.is_empty(),
        words: words.filter(|it| it.kind == TokenKind::Word).map(|it| it.text).collect(),
    }
}

/// The line of a place, as far as it is looked at, if it reads another scene file.
fn line(at: Span, sources: &Sources) -> Option<&str> {
    let (text, start) = (sources.text(at.source), line_of(at, sources));
    let near = &text.as_bytes()[start..text.len().min(start + LOOKED_AT)];
    let end = memchr::memchr(b'\n', near).unwrap_or(near.len());
    let line = text.get(start..start + end)?;
    let first = tokens(line, 0..line.len()).next()?.text;
    (matches!(first, "include" | "import") || line.contains(".scene\"")).then_some(line)
}
