//! What stands where it cannot: objects without a name in others that hold none, fields in no object.

use luxel_core::diag::{Diagnostic, Grade, Span};
use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Type};

use super::Evaluator;
use super::env::Env;
use super::exec::Body;
use super::value::Value;
use crate::syntax::{ExprNode, Field, Name, Object, stray};
use crate::words::RESERVED;

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

    /// The object that a field of a file is meant to be, which is told: `integrator = path { … }`.
    pub(super) fn given_object(&mut self, field: &Field, env: &Env) -> Option<Object> {
        let (name, value) = (&field.name, &field.value);
        Kind::of_word(&name.text)?;
        let ExprNode::Object(object) = &value.node else { return None };
        let is_whole = object.category.text == name.text;
        let is_kind = object.kind.is_none() && Kind::of_word(&object.category.text).is_none();
        if !is_whole && !is_kind {
            return None;
        }
        env.define(&name.text, Value::Poison);
        let found = Diagnostic::error("E0113", name.span, "an object stands in a file without `=`");
        let before = |start| Span { start, end: value.span.start, ..name.span };
        if is_whole {
            self.tell(found.guess(before(name.span.start), ""));
            return Some(Object::clone(object));
        }
        self.tell(found.guess(before(name.span.end), " "));
        let kind = Some(object.category.clone());
        Some(Object { category: name.clone(), kind, ..Object::clone(object) })
    }

    /// Tells of a field of a file.
    pub(super) fn stray_field(&mut self, name: &Name, env: &Env) {
        // `let = 3`: that it is no name is told already.
        if RESERVED.contains(&&*name.text) {
            return;
        }
        let message = format!("`{}` stands in no object", name.text);
        let start = Span { end: name.span.start, ..name.span };
        let found = Diagnostic::error("E0113", name.span, message);
        if env.get(&name.text).is_some() {
            self.tell(found.help("a name keeps its value: give the new one a name of its own"));
            return;
        }
        let names: Vec<Name> = stray(name).collect();
        let is_defined = "a name is defined with `let`";
        self.tell(match &names[..] {
            // `letx = 3`
            [all, rest] => {
                let at = all.text.len() - rest.text.len();
                let gap =
                    Span::new(name.span.source, start.range().start + at, start.range().start + at);
                found.help(is_defined).guess(gap, " ")
            }
            _ if Kind::of_word(&name.text).is_some() => {
                found.help(format!("an object is written `{} NAME {{ … }}`", name.text))
            }
            _ => found.help(is_defined).guess(start, "let "),
        });
        for name in names {
            env.define(&name.text, Value::Poison);
        }
    }
}
