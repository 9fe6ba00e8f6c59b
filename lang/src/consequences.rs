//! Mistakes of which the cause is told already, or of which another says more.

use std::collections::BTreeSet;

use luxel_core::diag::{Diagnostic, Span};

/// Takes out what is said of the value of an expression in which something cannot be read, as of a call that
/// lacks what stands behind a missing bracket, and of two mistakes of one place the one that says less.
pub(crate) fn sift(diagnostics: &mut Vec<Diagnostic>) {
    let is_cause = |found: &&Diagnostic| found.is_error() && found.code.starts_with("E00");
    let causes = diagnostics.iter().filter(is_cause);
    let of = |found: &Diagnostic| {
        let mended = found.fixes.iter().map(|fix| fix.span);
        found.span().into_iter().chain(mended).collect::<Vec<Span>>()
    };
    let mut causes: Vec<Span> = causes.flat_map(of).collect();
    causes.sort_unstable();
    // Of a word without quotes it is said what it may be, which says more than that it is no name; and of a
    // brace that it is one too many, which says more than that it is not expected. A name that is defined
    // later is no word.
    let (words, braces) = (places(diagnostics, "E0416"), places(diagnostics, "E0008"));
    let early = places(diagnostics, "E0102");
    diagnostics.retain(|found| {
        let has_cause =
            |places: &BTreeSet<Span>| found.span().is_some_and(|at| places.contains(&at));
        let says_less = match found.code {
            "E0101" => has_cause(&words),
            "E0023" => has_cause(&braces),
            "E0416" => has_cause(&early),
            _ => false,
        };
        if says_less {
            return false;
        }
        let is_of_value = found.code.starts_with("E02") || found.code.starts_with("E04");
        let span = found.span().filter(|_| is_of_value && found.is_error());
        !span.is_some_and(|span| holds_one(span, &causes))
    });
}

/// Where something is told with a code.
fn places(diagnostics: &[Diagnostic], code: &str) -> BTreeSet<Span> {
    diagnostics.iter().filter(|found| found.code == code).filter_map(Diagnostic::span).collect()
}

/// Whether one of some places, which are in order, lies in a larger one.
fn holds_one(span: Span, places: &[Span]) -> bool {
    let first = places.partition_point(|at| (at.source, at.start) < (span.source, span.start));
    let begin_within = |at: &&Span| at.source == span.source && at.start <= span.end;
    let mut within = places[first..].iter().take_while(begin_within);
    within.any(|at| at.end <= span.end && *at != span)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use luxel_core::diag::SourceId;
    use luxel_core::files::MemoryFiles;
    use luxel_core::registry::Registry;

    use super::*;
    use crate::{Settings, load};

    #[test]
    fn a_call_is_not_said_to_lack_what_stands_behind_a_missing_bracket() {
        let codes = |call: &str| {
            let text = format!("scene 1\nlet c = {{ a = rgb.srgb(0.8, 0.7{call} }}\n");
            let files = MemoryFiles::default().with("a.scene", text.as_bytes());
            let path = Path::new("a.scene");
            let told = load(path, &files, &Registry::new(), &Settings::default()).diagnostics;
            told.iter().map(|found| found.code).collect::<Vec<_>>()
        };
        assert_eq!(codes(")"), ["E0403", "E0409"]);
        assert_eq!(codes(""), ["E0009", "E0409"]);
    }

    #[test]
    fn values_around_what_cannot_be_read_are_not_judged() {
        let error = |code, file, start, end| {
            Diagnostic::error(code, Span::new(SourceId(file), start, end), "")
        };
        let cause = || error("E0009", 0, 20, 21).guess(Span::new(SourceId(0), 19, 19), ")");
        let kept = |found: Diagnostic| {
            let mut all = vec![found, cause()];
            sift(&mut all);
            all.len() == 2
        };
        assert!(!kept(error("E0403", 0, 10, 19)) && !kept(error("E0214", 0, 19, 30)));
        for (code, file, start, end) in [
            ("E0403", 0, 10, 18),
            ("E0403", 0, 20, 21),
            ("E0403", 1, 10, 30),
            ("E0214", 0, 22, 30),
            ("E0101", 0, 10, 30),
        ] {
            assert!(kept(error(code, file, start, end)), "{code} {file} {start}");
        }
        let warning = Diagnostic::warning("E0403", Span::new(SourceId(0), 10, 30), "");
        assert!(kept(warning));
    }
}
