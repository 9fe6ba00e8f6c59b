//! Values that are wrong alike wherever a name is used.

use std::collections::BTreeMap;

use luxel_core::diag::{Diagnostic, Label, SourceId, Sources, Span};
use memchr::memmem;

use crate::eval::{DEFINED, OF_KINDS, OUTSIDE};
use crate::syntax::{TokenKind, tokens};

/// What is said of another place.
const AGAIN: &str = "and here";

/// Other places that are shown.
const SHOWN: usize = 3;

/// Bytes of a value in which names are looked for.
const VALUE: usize = 200;

/// Bytes of a text in which a definition is looked for.
const SEARCHED: usize = 1 << 20;

/// Of values that do not fit in the same words and in which one name stands the first is told, with the others and
/// where the name is defined: there the mistake may be. So of those in which a name stands that is a number without
/// a unit; and of pixels outside the picture, whose size may be what is wrong.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let mut definitions = Definitions { sources, of: BTreeMap::new() };
    let mut first: BTreeMap<Alike, usize> = BTreeMap::new();
    let mut others: Vec<(usize, usize, Option<Span>)> = vec![];
    for (i, found) in diagnostics.iter().enumerate().filter(|(_, found)| found.sure().is_none()) {
        let alikes = definitions.alikes(found);
        let before = alikes.iter().find_map(|(alike, place)| Some((*first.get(alike)?, i, *place)));
        if before.is_none() {
            first.extend(alikes.into_iter().map(|(alike, _)| (alike, i)));
        }
        others.extend(before);
    }
    let mut is_out = vec![false; diagnostics.len()];
    for (one, other, definition) in others {
        is_out[other] = true;
        let again = diagnostics[other].span();
        let labels = &mut diagnostics[one].labels;
        let label = |span, text: &str| Label { span, text: text.into() };
        if let Some(place) = definition.filter(|at| labels.iter().all(|label| label.span != *at)) {
            labels.push(label(place, DEFINED));
        }
        let n_shown = labels.iter().filter(|label| label.text == AGAIN).count();
        labels.extend(again.filter(|_| n_shown < SHOWN).map(|at| label(at, AGAIN)));
    }
    let mut is_out = is_out.into_iter();
    diagnostics.retain(|_| !is_out.next().unwrap_or_default());
}

/// What several mistakes have in common.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum Alike {
    /// Code, message and the definition of a name.
    Words(&'static str, String, Span),
    /// The definition of a number without a unit.
    Unitless(Span),
    /// They are of pixels outside the picture.
    Pixels,
}

/// Names that files define, by file and name.
struct Definitions<'a> {
    sources: &'a Sources,
    of: BTreeMap<SourceId, BTreeMap<&'a str, Span>>,
}

impl Definitions<'_> {
    /// By what others may be like a mistake, and where the name is defined that makes them so.
    fn alikes(&mut self, found: &Diagnostic) -> Vec<(Alike, Option<Span>)> {
        if found.code == "E0603" && found.message.ends_with(OUTSIDE) {
            return vec![(Alike::Pixels, None)];
        }
        let Some(at) = found.span().filter(|_| found.code.starts_with("E02")) else {
            return vec![];
        };
        let text = self.sources.text(at.source);
        let value = Some(at.range()).filter(|value| value.len() <= VALUE).unwrap_or_default();
        let words = tokens(text, value).filter(|token| token.kind == TokenKind::Word);
        let defined = self.of.entry(at.source).or_insert_with(|| definitions(text, at.source));
        let of_unit = match found.code {
            "E0201" | "E0202" | "E0203" => true,
            "E0214" => found.message.contains(OF_KINDS),
            _ => false,
        };
        let of_unit = of_unit && found.fixes.is_empty();
        let mut all = vec![];
        for place in words.filter_map(|word| defined.get(word.text)) {
            if of_unit && is_unitless(text, *place) {
                all.push((Alike::Unitless(*place), Some(*place)));
            }
            let words = Alike::Words(found.code, found.message.clone(), *place);
            all.push((words, Some(*place)));
        }
        all
    }
}

/// The names that a text defines by `let`, each where it does so first.
fn definitions(text: &str, source: SourceId) -> BTreeMap<&str, Span> {
    let mut all = BTreeMap::new();
    if text.len() > SEARCHED {
        return all;
    }
    let in_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    for at in memmem::find_iter(text.as_bytes(), "let ") {
        let rest = text[at + 4..].trim_start_matches(' ');
        let name = &rest[..rest.find(|c| !in_word(c)).unwrap_or(rest.len())];
        if !name.is_empty() && !text[..at].ends_with(in_word) {
            let start = text.len() - rest.len();
            all.entry(name).or_insert_with(|| Span::new(source, start, start + name.len()));
        }
    }
    all
}

/// Whether a name is given a number without a unit.
fn is_unitless(text: &str, name: Span) -> bool {
    let start = name.range().end;
    let is_end = |end: &usize| text.is_char_boundary(*end);
    let end = (start + VALUE..text.len()).find(is_end).unwrap_or(text.len());
    let mut value = tokens(text, start..end);
    let is_given = value.next().is_some_and(|sign| sign.text == "=");
    let is_number = value.next().is_some_and(|number| number.kind == TokenKind::Number);
    is_given && is_number && value.next().is_none_or(|next| next.first_on_line)
}
