//! What the registry says of what stands around a place.

use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, Param, Unit};

use super::context::{Context, Head, brace};
use super::define::label;
use super::named::Around;
use crate::manual::{self, Field};
use crate::syntax::tokens;

/// What an object may be given.
#[derive(Clone, Copy)]
pub(super) enum Given {
    /// A parameter of its class or kind, and the class's.
    Param(&'static Param, &'static [Param]),
    /// A field that the language reads.
    Field(&'static Field),
}

impl Given {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Param(param, _) => param.name,
            Self::Field((name, ..)) => name,
        }
    }

    /// Type, unit, range and default in a few words.
    pub(super) fn facts(self) -> String {
        match self {
            Self::Param(param, of) => manual::facts(param, of).join(", "),
            Self::Field((_, facts, _)) => (*facts).to_owned(),
        }
    }

    pub(super) fn doc(self) -> &'static str {
        match self {
            Self::Param(param, _) => param.doc.trim(),
            Self::Field((.., doc)) => doc,
        }
    }
}

/// What the object may be given in whose braces a head says that a place stands.
pub(super) fn givens(around: Around<'_>, head: &Head) -> Vec<Given> {
    let (category, kind) = match head {
        Head::Object { category, kind } => (category.clone(), kind.clone()),
        Head::Amend(name) => match around.object_named(name) {
            Some(found) => found,
            None => return vec![],
        },
        Head::Place => ("place".to_owned(), None),
        _ => return vec![],
    };
    if let Some(word) = manual::find(&category) {
        return word.fields.iter().map(Given::Field).collect();
    }
    let Some(kind_of) = Kind::of_word(&category) else { return vec![] };
    let class = kind.and_then(|name| around.registry.class(kind_of, &name));
    let own = match class {
        Some(class) => Registry::params(class).collect(),
        None => shared(around.registry, kind_of),
    };
    let fields = manual::fields_of(kind_of).iter().map(Given::Field);
    let of = class.map_or(&[][..], |class| class.params);
    own.into_iter().map(|param| Given::Param(param, of)).chain(fields).collect()
}

/// The parameters that all classes of a kind have.
fn shared(registry: &Registry, kind: Kind) -> Vec<&'static Param> {
    let mut classes = registry.of_kind(kind).map(|entry| &entry.class);
    let mut out: Vec<_> = classes.next().map_or(vec![], |first| Registry::params(first).collect());
    for class in classes {
        let has = |param: &&Param| {
            Registry::params(class).any(|own| own.name == param.name && own.ty == param.ty)
        };
        out.retain(has);
    }
    out
}

/// What the first object of a label may be given.
pub(super) fn givens_of_label(around: Around<'_>, name: &str) -> Option<Vec<Given>> {
    let place = label(around.project, around.path, name)?;
    let document = around.project.document(&place.path)?;
    let start = document.piece_at(place.range.0)?.start;
    let before: Vec<_> = tokens(document.text(), start..place.range.1).collect();
    Some(givens(Around { path: &place.path, document: &document, ..around }, &brace(&before)))
}

/// What the value is given to that stands at a place: `name = |`.
pub(super) fn given_to(around: Around<'_>, here: &Context<'_>) -> Option<Given> {
    if here.text_back(1) != "=" {
        return None;
    }
    let name = here.text_back(2);
    givens(around, here.head()?).into_iter().find(|given| given.name() == name)
}

/// What a parameter's numbers measure.
pub(super) fn dimension(param: &Param) -> Option<Dimension> {
    let unit = param.unit.split('|').next().filter(|unit| !unit.is_empty())?;
    Unit::parse(unit).ok().map(|unit| unit.dimension)
}

/// The first sentence of a manual page.
pub(super) fn summary(class: &Class) -> String {
    let paragraph = class.doc.trim().split("\n\n").next().unwrap_or_default();
    let line = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    line.find(". ").map_or(line.clone(), |end| line[..=end].to_owned())
}
