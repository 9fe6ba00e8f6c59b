//! What is told of a place: the manual, the definition, the value.

mod defined;
mod quoted;

use std::ops::Range;
use std::path::Path;

use luxel_core::registry::Registry;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, UNITS};

use super::context::{Context, Head, Inside, dotted};
use super::define::{Place, Project, definition};
use super::named::Around;
use super::schema::{self, Given};
use super::statements::{self, page_of};
use super::swatch;
use crate::eval::{readable, types};
use crate::manual;
use crate::syntax::TokenKind;

/// What is told of a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hover {
    /// The bytes that it is told of.
    pub range: Range<usize>,
    /// What stands in the scene, to be shown as code.
    pub code: String,
    /// What it means, as paragraphs.
    pub text: String,
    /// What it comes to, where the text alone says so.
    pub value: Option<String>,
    /// Where what it names is defined, whose value may be told too; of what has a value of its own, its
    /// name.
    pub of: Option<Place>,
    /// What its value is: `value`, or of a loop's name `one of`.
    pub value_is: &'static str,
}

impl Hover {
    fn new(range: Range<usize>, code: impl Into<String>, text: impl Into<String>) -> Self {
        let (code, text) = (code.into(), text.into());
        Self { range, code, text, value: None, of: None, value_is: "value" }
    }

    fn of(self, place: Place) -> Self {
        Self { of: Some(place), ..self }
    }
}

/// What is told of a byte of a file.
pub fn hover(project: &dyn Project, path: &Path, at: usize, registry: &Registry) -> Option<Hover> {
    let document = project.document(path)?;
    let around = Around { project, path, document: &document, registry };
    let here = Context::at(&document, at);
    if let Inside::Text(written) = &here.inside {
        return Asked { around, here: &here }.quoted(written.start - 1);
    }
    let here = Context::at(&document, word_end(document.text(), at));
    if here.inside != Inside::Code || here.word.is_empty() {
        return None;
    }
    Asked { around, here: &here }.word()
}

/// The end of the word at a byte.
fn word_end(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    at + rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').count()
}

struct Asked<'a> {
    around: Around<'a>,
    here: &'a Context<'a>,
}

impl Asked<'_> {
    fn word(&self) -> Option<Hover> {
        self.field()
            .or_else(|| self.field_of_label())
            .or_else(|| self.object())
            .or_else(|| self.unit())
            .or_else(|| self.attribute())
            .or_else(|| self.ty())
            .or_else(|| self.argument())
            .or_else(|| self.name())
    }

    /// What is told of the word.
    fn told(&self, code: impl Into<String>, text: impl Into<String>) -> Hover {
        Hover::new(self.here.word.clone(), code, text)
    }

    /// The place of the word.
    fn own(&self) -> Place {
        let Range { start, end } = self.here.word;
        Place { path: self.around.path.to_owned(), range: (start, end) }
    }

    fn next(&self) -> &str {
        self.here.after().map_or("", |token| token.text)
    }

    /// The words before the dot before the word, if there is one, and whether they follow `set`.
    fn before_dot(&self) -> Option<(String, bool)> {
        let (last, before) = self.here.before.split_last()?;
        let (space, rest) = dotted(before);
        let is_set = rest.last().is_some_and(|token| token.text == "set");
        (last.text == "." && !space.is_empty()).then_some((space, is_set))
    }

    fn given(&self, givens: Vec<Given>) -> Option<Hover> {
        let given = givens.into_iter().find(|given| given.name() == self.here.word())?;
        Some(self.told(format!("{}: {}", given.name(), given.facts()), given.doc()))
    }

    /// The manual of a parameter that is given.
    fn field(&self) -> Option<Hover> {
        let head = self.here.head().filter(|_| self.next() == "=" && self.here.begins())?;
        let told = self.given(schema::givens(self.around, head))?;
        Some(told.of(self.own()))
    }

    /// The same of `set label.field`.
    fn field_of_label(&self) -> Option<Hover> {
        let (label, _) = self.before_dot().filter(|(_, is_set)| *is_set)?;
        self.given(schema::givens_of_label(self.around, &label)?)
    }

    /// The manual of a category or kind of object.
    fn object(&self) -> Option<Hover> {
        let here = self.here;
        let word = here.word();
        if !here.is_fresh
            && let Some(kind) = Kind::of_word(here.text_back(1))
            && let Some(class) = self.around.registry.class(kind, word)
        {
            return Some(self.told(format!("{kind} {word}"), class.doc.trim()));
        }
        let next = here.after()?;
        let is_head = matches!(next.kind, TokenKind::Word | TokenKind::Text) || next.text == "{";
        if !is_head {
            return None;
        }
        if let Some(page) = page_of(word) {
            return Some(self.told(word, page.trim()));
        }
        let kind = Kind::of_word(word)?;
        let names: Vec<_> =
            self.around.registry.of_kind(kind).map(|entry| entry.class.name).collect();
        let text = format!("A category of objects. Kinds: {}.", names.join(", "));
        Some(self.told(word, text))
    }

    /// A unit: its name can be nothing else, but for labels, fields and members.
    fn unit(&self) -> Option<Hover> {
        let is_name = matches!(self.here.text_back(1), "." | "set") || self.next() == "=";
        let found = UNITS.iter().find(|(name, _)| *name == self.here.word() && !is_name);
        let (name, unit) = found?;
        let what = unit.dimension.name();
        let one = readable::si(unit.scale, unit.dimension);
        let text = match unit.dimension.to_string() {
            base if base == *name => what,
            base if one == format!("1 {name}") => format!("{what}; 1 {name} is 1 {base}"),
            _ => format!("{what}; 1 {name} is {one}"),
        };
        Some(self.told(*name, text))
    }

    fn attribute(&self) -> Option<Hover> {
        let known = statements::attributes().into_iter().find(|it| it.label == self.here.word());
        let known = known.filter(|_| self.here.text_back(1) == "@")?;
        Some(self.told(format!("@{}", known.label), known.doc))
    }

    fn ty(&self) -> Option<Hover> {
        let word = self.here.word();
        let is_type = self.here.text_back(1) == ":" && types::names().any(|name| name == word);
        let text = types::dimension(word).map_or(String::new(), Dimension::name);
        is_type.then(|| self.told(word, text))
    }

    /// An argument that a call names.
    fn argument(&self) -> Option<Hover> {
        let Some(Head::Call(callee)) = self.here.head() else { return None };
        if self.next() != "=" || !matches!(self.here.text_back(1), "(" | ",") {
            return None;
        }
        let word = self.here.word();
        if let Some(function) = self.around.function_named(callee) {
            let argument = function.arguments.iter().find(|argument| *argument.name == *word)?;
            let of = format!("An argument of `{}`.\n\n{}", function.usage(), function.doc);
            return Some(self.told(argument.usage(), of.trim()));
        }
        let function = manual::function(callee).filter(|it| it.arguments.contains(&word))?;
        let of = format!("An argument of `{}`.\n\n{}", function.usage, function.doc);
        Some(self.told(word, of))
    }

    /// A name: where it comes from, or the manual of what every scene has.
    fn name(&self) -> Option<Hover> {
        let Around { project, path, .. } = self.around;
        let word = self.here.word();
        if let Some(place) = definition(project, path, self.here.word.start) {
            return self.defined(place);
        }
        let space = self.before_dot().map(|(space, _)| space);
        let name = space.as_ref().map_or(word.to_owned(), |space| format!("{space}.{word}"));
        if let Some(function) = manual::function(&name) {
            let colour = swatch::literal_at(self.around.document, self.here.word.start);
            let told = self.told(function.usage.clone(), function.text()).of(self.own());
            return Some(Hover { value: colour, ..told });
        }
        self.member(&space?)
    }
}
