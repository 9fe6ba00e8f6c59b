//! Words that lack the quotes of a text, and names that have them.

use luxel_core::diag::{Diagnostic, near};
use luxel_sdk::params::{Param, Type};

use super::Evaluator;
use super::value::{FieldValue, Value};

/// Bytes of a name that a message shows.
const SHOWN: usize = 32;

impl Evaluator<'_> {
    /// Tells of a word without quotes where one of some words is wanted: `display = srgb`. That there is no
    /// such name, which is told of the same place, says less.
    pub(super) fn bare_word(&mut self, param: &Param, field: &FieldValue) {
        let is_word = matches!(field.value, Value::Poison) && param.ty == Type::Choice;
        if !is_word || !self.unknown.contains(&field.span) {
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
}

/// With what may be meant by a text where an object is wanted: `material = "gold"`.
pub(super) fn perhaps_name(found: Diagnostic, param: &Param, field: &FieldValue) -> Diagnostic {
    let is_wanted = matches!(param.ty, Type::Object(_) | Type::Part);
    match &field.value {
        Value::Text(name) if is_wanted && is_name(name) => {
            found.help(format!("what has a name, `let {name} = …`, is named without quotes"))
        }
        _ => found,
    }
}

/// Whether a text may be a name, and one that a message shows.
fn is_name(text: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    (1..=SHOWN).contains(&text.len()) && text.chars().all(is_part)
}
