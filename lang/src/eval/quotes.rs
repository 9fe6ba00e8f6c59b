//! Words that lack the quotes of a text, and what has them though it is none.

use luxel_core::diag::{Diagnostic, Span, near};
use luxel_core::scene::{self, Given};
use luxel_sdk::params::{Param, Type, Unit};

use super::Evaluator;
use super::arithmetic::measured;
use super::value::{FieldValue, Value};
use crate::sink::Sink;
use crate::syntax::{self, ExprNode};

/// Bytes of a text that a message shows.
const SHOWN: usize = 32;

/// How the names of files with pictures end.
const PICTURES: [&str; 5] = ["png", "jpg", "jpeg", "exr", "hdr"];

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

    /// With what may be meant by a text where none is wanted.
    pub(super) fn with_unquoted(
        &self,
        found: Diagnostic,
        param: &Param,
        field: &FieldValue,
    ) -> Diagnostic {
        let Value::Text(text) = &field.value else { return found };
        if text.len() > SHOWN {
            return found;
        }
        if matches!(param.ty, Type::Object(_) | Type::Part) && is_name(text) {
            let help = format!("what has a name, `let {text} = …`, is named without quotes");
            return found.help(help);
        }
        if !self.written(field.span).starts_with('"') {
            return found;
        }
        match self.constant(text, field) {
            Some(given) => unquoted(found, text, given, (param, field)),
            None if param.unit.is_empty()
                && matches!(param.ty, Type::Spectrum | Type::Emission) =>
            {
                perhaps_colour(found, text, param, field.span)
            }
            None => found,
        }
    }

    /// The value of a text, were it written without quotes: a number or a vector, perhaps with a unit, or
    /// `true` or `false`.
    fn constant(&self, text: &str, field: &FieldValue) -> Option<Given> {
        let mut sink = Sink::new(usize::MAX);
        let expr = syntax::parse_expr(text, 0, field.span.source, &self.budgets, &mut sink)?;
        let given = match expr.node {
            ExprNode::Number(x, unit) => {
                let (x, dimension) = measured(x, unit.as_deref());
                Given::Number(x, dimension)
            }
            ExprNode::Numbers { data, unit, .. } => {
                let unit = unit.as_deref().copied().unwrap_or(Unit::ONE);
                let data = data.iter().map(|x| x * unit.scale).collect();
                Given::Numbers(data, unit.dimension)
            }
            ExprNode::Bool(value) => Given::Bool(value),
            _ => return None,
        };
        (sink.errors() == 0).then_some(given)
    }
}

/// With a number that stands in quotes without them, if it fits then.
fn unquoted(
    found: Diagnostic,
    text: &str,
    given: Given,
    (param, field): (&Param, &FieldValue),
) -> Diagnostic {
    let units = |dimension| field.file.units.get(&dimension).copied();
    match scene::conform(param, given, &units) {
        Ok(_) => found.help("only a text stands in quotes").fix(field.span, text.trim()),
        Err(misfit) if !misfit.units.is_empty() => {
            let found = found.help("only a text stands in quotes, and a number has its unit");
            misfit.units.iter().fold(found, |found, unit| {
                found.guess(field.span, format!("{} {unit}", text.trim()))
            })
        }
        Err(_) => found,
    }
}

/// With how a colour, or a picture of one, is written.
fn perhaps_colour(found: Diagnostic, text: &str, param: &Param, span: Span) -> Diagnostic {
    let ends = |end: &&str| text.rsplit_once('.').is_some_and(|it| it.1.eq_ignore_ascii_case(end));
    if param.textured && PICTURES.iter().any(ends) {
        return found
            .help(format!("a picture is a texture: `texture image {{ file = \"{text}\" }}`"));
    }
    let found = found.help("a colour is written by its numbers, as `rgb.srgb(0.8, 0.1, 0.1)`");
    match hexadecimal(text) {
        Some([r, g, b]) => found.guess(span, format!("rgb.srgb({r}, {g}, {b})")),
        None => found,
    }
}

/// The components of `#rrggbb`, from 0 to 1, to an eighth of a step.
fn hexadecimal(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#').filter(|it| it.len() == 6 && !it.starts_with('+'))?;
    let bytes = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some([1, 2, 3].map(|i| (f64::from(bytes[i]) / 0.255).round() / 1000.0))
}

/// Whether a text may be a name, and one that a message shows.
fn is_name(text: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    (1..=SHOWN).contains(&text.len()) && text.chars().all(is_part)
}
