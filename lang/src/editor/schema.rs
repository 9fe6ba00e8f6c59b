//! What the registry says of what stands around a place.

use std::path::Path;

use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, Param, Unit};

use super::context::{Context, Head, brace};
use super::define::{Project, label};
use super::document::Document;
use crate::manual::{self, Field};
use crate::syntax::{Expr, ExprNode, StmtNode, tokens};

/// What an object may be given.
#[derive(Clone, Copy)]
pub(super) enum Given {
    /// A parameter of its class or kind.
    Param(&'static Param),
    /// A field that the language reads.
    Field(&'static Field),
}

impl Given {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Param(param) => param.name,
            Self::Field((name, ..)) => name,
        }
    }

    /// Type, unit, range and default in a few words.
    pub(super) fn facts(self) -> String {
        match self {
            Self::Param(param) => manual::facts(param).join(", "),
            Self::Field((_, facts, _)) => (*facts).to_owned(),
        }
    }

    pub(super) fn doc(self) -> &'static str {
        match self {
            Self::Param(param) => param.doc.trim(),
            Self::Field((.., doc)) => doc,
        }
    }
}

/// What the object may be given in whose braces a head says that a place stands.
pub(super) fn givens(registry: &Registry, document: &Document, head: &Head) -> Vec<Given> {
    let (category, kind) = match head {
        Head::Object { category, kind } => (category.clone(), kind.clone()),
        Head::Amend(name) => match object_named(document, name, 8) {
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
    let class = kind.and_then(|name| registry.class(kind_of, &name));
    let own = class.into_iter().flat_map(Registry::params).map(Given::Param);
    own.chain(manual::fields_of(kind_of).iter().map(Given::Field)).collect()
}

/// What the first object of a label may be given.
pub(super) fn givens_of_label(
    registry: &Registry,
    project: &dyn Project,
    path: &Path,
    name: &str,
) -> Option<Vec<Given>> {
    let place = label(project, path, name)?;
    let document = project.document(&place.path)?;
    let start = document.piece_at(place.range.0)?.start;
    let before: Vec<_> = tokens(document.text(), start..place.range.1).collect();
    Some(givens(registry, &document, &brace(&before)))
}

/// What the value is given to that stands at a place: `name = |`.
pub(super) fn given_to(registry: &Registry, here: &Context<'_>) -> Option<Given> {
    if here.text_back(1) != "=" {
        return None;
    }
    let name = here.text_back(2);
    givens(registry, here.document, here.head()?).into_iter().find(|given| given.name() == name)
}

/// Category and kind of the object that a name of the file stands for, through copies with changes.
pub(super) fn object_named(
    document: &Document,
    name: &str,
    steps: usize,
) -> Option<(String, Option<String>)> {
    let piece = document.piece_at(document.top(name)?.start)?;
    let value = piece.read.stmts.iter().find_map(|stmt| match &stmt.node {
        StmtNode::Let { name: own, value, .. } if *own.text == *name => Some(value),
        _ => None,
    })?;
    object_of(document, value, steps)
}

fn object_of(document: &Document, value: &Expr, steps: usize) -> Option<(String, Option<String>)> {
    match &value.node {
        ExprNode::Object(object) => {
            let kind = object.kind.as_ref().map(|kind| kind.text.to_string());
            Some((object.category.text.to_string(), kind))
        }
        ExprNode::With { of, .. } => object_of(document, of, steps),
        ExprNode::Path(path) if path.len() == 1 => {
            object_named(document, &path[0].text, steps.checked_sub(1)?)
        }
        _ => None,
    }
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
