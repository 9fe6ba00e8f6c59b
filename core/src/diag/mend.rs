//! Mends applied to texts.

use std::collections::BTreeMap;

use super::{Diagnostic, Fix, SourceId, Sources};

/// A text with mends applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mended {
    /// Which text.
    pub source: SourceId,
    /// How it is now.
    pub text: String,
    /// What was changed, by place: the code of the mistake and its mend.
    pub changes: Vec<(&'static str, Fix)>,
}

/// Applies the mends that are sure to the texts that `may` be changed.
///
/// A diagnostic with several sure mends leaves the choice to a person. Of mends that overlap or touch
/// the first is applied: what the others are worth shows when the text is read again.
pub fn mend(
    found: &[Diagnostic],
    sources: &Sources,
    may: impl Fn(SourceId) -> bool,
) -> Vec<Mended> {
    let mut texts: BTreeMap<SourceId, Vec<(&'static str, Fix)>> = BTreeMap::new();
    for diagnostic in found {
        let Some(fix) = diagnostic.sure() else { continue };
        if !may(fix.span.source) {
            continue;
        }
        let chosen = texts.entry(fix.span.source).or_default();
        let apart =
            |other: &Fix| fix.span.end < other.span.start || other.span.end < fix.span.start;
        if chosen.iter().all(|(_, other)| apart(other)) {
            chosen.push((diagnostic.code, fix.clone()));
        }
    }
    let applied = |(source, mut changes): (SourceId, Vec<(&'static str, Fix)>)| {
        changes.sort_by_key(|(_, fix)| fix.span);
        // From the end, so that the places before stay what they are.
        let before = sources.text(source).to_owned();
        let text = changes.iter().rev().fold(before, |text, (_, fix)| fix.applied(&text));
        Mended { source, text, changes }
    };
    texts.into_iter().map(applied).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Span;
    use super::*;

    #[test]
    fn sure_mends_that_are_apart_are_applied_and_no_others() {
        let mut sources = Sources::default();
        let id = sources.add("a.scene", "one two three four");
        let other = sources.add("--set", "five");
        let span = |start, end| Span::new(id, start, end);
        let told = |code| Diagnostic::unplaced(code, "x");
        let found = [
            told("E0003").fix(span(8, 13), "3"),
            told("E0001").fix(span(0, 3), "1"),
            told("E0004").fix(span(13, 13), "!"),
            told("E0002").guess(span(4, 7), "2"),
            told("E0005").fix(span(4, 5), "a").fix(span(4, 5), "b"),
            told("E0006").fix(Span::new(other, 0, 4), "5"),
        ];
        let mended = mend(&found, &sources, |source| source == id);
        assert_eq!(mended.len(), 1);
        assert_eq!(mended[0].text, "1 two 3 four");
        let codes: Vec<_> = mended[0].changes.iter().map(|(code, _)| *code).collect();
        assert_eq!(codes, ["E0001", "E0003"]);
    }
}
