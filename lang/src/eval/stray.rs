//! Objects without a name in others that hold none.

use luxel_core::diag::{Diagnostic, Grade, Span};
use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Type};

use super::Evaluator;
use super::exec::Body;
use crate::syntax::Object;

/// The parameters of a class that take an object of a kind.
pub(super) fn takers(class: &Class, kind: Kind) -> impl Iterator<Item = &'static Param> {
    Registry::params(class).filter(move |param| {
        param.ty == Type::Object(kind) || param.ty == Type::Part && kind == Kind::Shape
    })
}

impl Evaluator<'_> {
    /// Tells of an object that stands in another one without a name. Of another kind than there are, it
    /// has been told already.
    pub(super) fn stray_object(&mut self, object: &Object, body: &mut Body) {
        let word = &object.category.text;
        let (Some(kind), Some(class)) = (Kind::of_word(word), body.class) else {
            body.meant.push(None);
            return;
        };
        let message = format!("a {word} cannot stand in this object without a name");
        let found = Diagnostic::error("E0026", object.head(), message);
        let is_given = |param: &&Param| body.fields.iter().any(|it| *it.name.text == *param.name);
        let open: Vec<_> = takers(&class, kind).filter(|param| !is_given(param)).collect();
        let is_free = |param: &&&Param| !body.meant.contains(&Some(param.name));
        let Some(param) = open.iter().find(is_free) else {
            let class = format!("{} {}", class.kind, class.name);
            let help = format!("no other parameter of `{class}` takes a {word}; groups hold many");
            self.tell(found.help(help));
            return;
        };
        body.meant.push(Some(param.name));
        let start = Span { end: object.category.span.start, ..object.category.span };
        let grade = if open.len() == 1 { Grade::Sure } else { Grade::Guess };
        let help = format!("give it to a parameter: `{} = {word} …`", param.name);
        self.tell(found.help(help).mend(start, format!("{} = ", param.name), grade));
    }
}
