//! What is unknown because another scene file is not read.

use luxel_core::diag::{Diagnostic, Sources};

use super::{LOOKED_AT, line_of};

/// What files may bring that are not read.
#[derive(Clone, Copy, Default)]
pub(super) struct Unread {
    pub(super) hide_labels: bool,
    pub(super) hide_names: bool,
}

/// What a line hides that reads a file, and is wrong itself.
pub(super) fn unread(diagnostics: &[Diagnostic], sources: &Sources) -> Unread {
    let is_wrong = |found: &&Diagnostic| {
        found.is_error() && (found.code.starts_with("E00") || found.code.starts_with("E02"))
    };
    let lines = diagnostics.iter().filter(is_wrong).filter(|found| reads_one(found, sources));
    let hides = |out: Unread, found: &Diagnostic| Unread {
        hide_labels: true,
        // Of one that only stands in the wrong place it is known what it brings.
        hide_names: out.hide_names || found.code != "E0001",
    };
    lines.fold(Unread::default(), hides)
}

/// Whether a mistake stands on a line that reads another scene file.
pub(super) fn reads_one(found: &Diagnostic, sources: &Sources) -> bool {
    let Some(at) = found.span() else { return false };
    let text = sources.text(at.source).as_bytes().get(line_of(at, sources)..).unwrap_or_default();
    let text = &text[..text.len().min(LOOKED_AT)];
    let line = text.split(|byte| *byte == b'\n').next().unwrap_or_default();
    line.trim_ascii_start().starts_with(b"include")
        || memchr::memmem::find(line, b".scene\"").is_some()
}
