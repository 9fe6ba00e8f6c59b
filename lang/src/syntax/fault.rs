//! What does not close, in words.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, SourceId, Span};

use crate::prescan::Fault;

/// Brackets that a message shows.
const SHOWN: usize = 8;

/// What is told of a bracket, text or comment that does not close; `limit` is how deep brackets may
/// nest, and a block that never closes most likely does before `resume`.
pub(super) fn told(
    text: &str,
    source: SourceId,
    limit: usize,
    fault: &Fault,
    resume: Option<usize>,
) -> Diagnostic {
    let span = |range: Range<usize>| Span::new(source, range.start, range.end);
    let byte = |at: usize| char::from(text.as_bytes()[at]);
    match fault {
        Fault::TooDeep { at } => {
            let message = format!("more than {limit} nested brackets");
            Diagnostic::error("E0011", span(*at..at + 1), message)
                .help("give an inner part a name with `let`")
        }
        Fault::Unclosed { open } => {
            let message = format!("this `{}` is never closed", byte(*open));
            let found = Diagnostic::error("E0008", span(*open..open + 1), message);
            match resume.filter(|at| at > open) {
                Some(at) => found.label(span(at..at), "it most likely closes before this"),
                None => found,
            }
        }
        Fault::Mismatch { open, at } => {
            let message = format!("`{}` is closed by `{}`", byte(*open), byte(*at));
            Diagnostic::error("E0009", span(*at..at + 1), message)
                .label(span(*open..open + 1), "opened here")
        }
        Fault::Stray { at } => {
            let rest = &text[*at..];
            let n = rest.bytes().take_while(|b| b")]}".contains(b)).count();
            let (this, closes) = if n == 1 { ("this", "closes") } else { ("these", "close") };
            let more = if n > SHOWN { "…" } else { "" };
            let shown = &rest[..n.min(SHOWN)];
            let message = format!("{this} `{shown}{more}` {closes} nothing");
            let place = span(*at..at + n);
            Diagnostic::error("E0010", place, message).guess(place, "")
        }
        Fault::String { at } => {
            let message = "a string ends on its line with `\"`";
            let end = span(at.end..at.end);
            Diagnostic::error("E0005", span(at.clone()), message).guess(end, "\"")
        }
        Fault::Comment { at } => {
            let message = "this comment is never closed by `*/`";
            Diagnostic::error("E0006", span(*at..at + 2), message)
        }
        Fault::Escape { at } => {
            let message = "an unknown escape";
            Diagnostic::error("E0007", span(at.clone()), message)
                .help("known are \\\" \\\\ \\n \\t and \\u{…}; write a backslash as \\\\")
        }
    }
}
