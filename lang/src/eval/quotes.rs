//! Words that lack the quotes of a text, and names that have them.

use std::collections::BTreeSet;

use luxel_core::diag::{Diagnostic, Span, near};
use luxel_core::scene::Misfit;
use luxel_sdk::params::{Param, Type};

use super::Evaluator;
use super::env::Env;
use super::value::{FieldValue, Value};

/// What may be a text, or none, although it is written otherwise.
#[derive(Default)]
pub(super) struct Quotes {
    /// Names that stand for nothing.
    unknown: BTreeSet<Span>,
    /// Texts that are the names of something.
    names: BTreeSet<Span>,
}

impl Quotes {
    /// Keeps a name that stands for nothing, of which that is told.
    pub(super) fn unknown(&mut self, name: Span) {
        self.unknown.insert(name);
    }

    /// Keeps a text that stands for something where it is written.
    pub(super) fn text(&mut self, text: &str, at: Span, env: &Env) {
        if env.get(text).is_some_and(|value| !value.is_poison()) {
            self.names.insert(at);
        }
    }
}

impl Evaluator<'_> {
    /// Tells of a word without quotes where one of some words is wanted: `display = srgb`. That there is no
    /// such name, which is told of the same place, says less.
    pub(super) fn bare_word(&mut self, param: &Param, field: &FieldValue) {
        let is_word = matches!(field.value, Value::Poison) && param.ty == Type::Choice;
        if !is_word || !self.quotes.unknown.contains(&field.span) {
            return;
        }
        let word = self.written(field.span).to_owned();
        let words: Vec<&str> = param.words().collect();
        let is_one = words.contains(&&*word);
        let none = if is_one { String::new() } else { format!(", and `{word}` is none") };
        let message = format!("the words of `{}` stand in quotes{none}", param.name);
        let found = Diagnostic::error("E0416", field.span, message)
            .help(format!("known are \"{}\"", words.join("\", \"")));
        let quoted = |word: &str| format!("\"{word}\"");
        self.tell(match near(&word, words.iter().copied()) {
            _ if is_one => found.fix(field.span, quoted(&word)),
            Some(near) => found.guess(field.span, quoted(near.name)),
            None => found,
        });
    }

    /// With what is meant by a text that does not fit and is the name of something: `material = "gold"`.
    pub(super) fn perhaps_name(
        &self,
        found: Diagnostic,
        misfit: &Misfit,
        field: &FieldValue,
    ) -> Diagnostic {
        match &field.value {
            Value::Text(text)
                if misfit.code == "E0214" && self.quotes.names.contains(&field.span) =>
            {
                found.help("a name stands without quotes").guess(field.span, &**text)
            }
            _ => found,
        }
    }
}
