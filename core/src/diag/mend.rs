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
    let mut asked = BTreeMap::new();
    for diagnostic in found {
        let Some(fix) = diagnostic.sure() else { continue };
        let source = fix.span.source;
        if !*asked.entry(source).or_insert_with(|| may(source)) {
            continue;
        }
        let chosen = texts.entry(source).or_default();
        // Those that are chosen are apart: only the nearest on each side can touch it.
        let i = chosen.partition_point(|(_, other)| other.span < fix.span);
        let before = i.checked_sub(1).is_none_or(|i| chosen[i].1.span.end < fix.span.start);
        let after = chosen.get(i).is_none_or(|(_, other)| fix.span.end < other.span.start);
        if before && after {
            chosen.insert(i, (diagnostic.code, fix.clone()));
        }
    }
    let mended = |(source, changes): (SourceId, Vec<(&'static str, Fix)>)| {
        let text = applied(sources.text(source), changes.iter().map(|(_, fix)| fix));
        Mended { source, text, changes }
    };
    texts.into_iter().map(mended).collect()
}

/// A text with mends that are apart, in order.
pub fn applied<'a>(text: &str, fixes: impl Iterator<Item = &'a Fix>) -> String {
    let (mut out, mut done) = (String::with_capacity(text.len()), 0);
    for fix in fixes {
        let range = fix.span.range();
        out.push_str(&text[done..range.start]);
        out.push_str(&fix.replacement);
        done = range.end;
    }
    out.push_str(&text[done..]);
    out
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
