//! Objects without a name in others that hold none.

use luxel_core::diag::{Diagnostic, Grade, Span};
use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Type};

use super::Evaluator;
use super::exec::Body;
use crate::syntax::{Name, Object};

/// The parameters of a class that take an object of a kind.
pub(super) fn takers(class: &Class, kind: Kind) -> impl Iterator<Item = &'static Param> {
    Registry::params(class).filter(move |param| {
        param.ty == Type::Object(kind) || param.ty == Type::Part && kind == Kind::Shape
    })
}

/// An object without a name.
#[derive(Debug)]
pub(super) struct Stray {
    category: Name,
    head: Span,
}

impl Stray {
    pub(super) fn of(object: &Object) -> Self {
        Self { category: object.category.clone(), head: object.head() }
    }
}

impl Evaluator<'_> {
    /// Tells of each object that stands without a name in one whose fields are known by now. One of a kind
    /// that there is not has been told already.
    pub(super) fn tell_strays(&mut self, body: &mut Body) {
        let (strays, Some(class)) = (std::mem::take(&mut body.strays), body.class) else { return };
        for Stray { category, head } in strays {
            let word = &category.text;
            let Some(kind) = Kind::of_word(word) else {
                body.meant.push(None);
                continue;
            };
            let message = format!("a {word} cannot stand in this object without a name");
            let found = Diagnostic::error("E0026", head, message);
            let is_given =
                |param: &&Param| body.fields.iter().any(|it| *it.name.text == *param.name);
            let open: Vec<_> = takers(&class, kind).filter(|param| !is_given(param)).collect();
            let is_free = |param: &&&Param| !body.meant.contains(&Some(param.name));
            let Some(param) = open.iter().find(is_free) else {
                let class = format!("{} {}", class.kind, class.name);
                self.tell(found.help(format!(
                    "no other parameter of `{class}` takes a {word}; groups hold many"
                )));
                continue;
            };
            body.meant.push(Some(param.name));
            let start = Span { end: category.span.start, ..category.span };
            // `material { … }` lacks more than that.
            let is_whole = head.end > category.span.end;
            let grade = if open.len() == 1 && is_whole { Grade::Sure } else { Grade::Guess };
            let help = format!("give it to a parameter: `{} = {word} …`", param.name);
            self.tell(found.help(help).mend(start, format!("{} = ", param.name), grade));
        }
    }
}
