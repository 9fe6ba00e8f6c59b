//! What is not evaluated, and may be wrong all the same: functions that nobody calls, arms that are not
//! taken, loops without a turn, what is off. Of objects in it are looked at the class, the names of parameters and,
//! unless they are off, values that depend on no name.

use std::rc::Rc;

use luxel_core::diag::{Grade, near};
use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;

use super::Evaluator;
use super::env::{Env, File};
use super::object::has_param;
use super::value::{FieldValue, Value};
use crate::syntax::{Expr, ExprNode, Field, Object, Stmt, StmtNode, each_object};

/// Numbers that are looked at, at most: a vector.
const FEW: usize = 4;

impl Evaluator<'_> {
    /// Tells what is wrong with objects in parts of a statement that may not be evaluated, as far as that is
    /// known without the values of names. What was told already is not told again.
    pub(super) fn look_at_untaken(&mut self, stmt: &Stmt, env: &Env) {
        if stmt.is_off() {
            each_object(stmt, &mut |object| self.look_at_names(object, env));
        } else if may_be_untaken(stmt) {
            each_object(stmt, &mut |object| {
                self.look_at_head(object);
                self.look_at_names(object, env);
                self.look_at_constants(object, env);
            });
        } else if let StmtNode::Object(object) = &stmt.node {
            for inner in &object.body.stmts {
                self.look_at_untaken(inner, env);
            }
        }
    }

    /// A misspelt class. One that is not near to any may be of a plugin that is not loaded.
    fn look_at_head(&mut self, object: &Object) {
        let Some((kind, name)) = Kind::of_word(&object.category.text).zip(object.kind.as_ref())
        else {
            return;
        };
        let names = || self.registry.of_kind(kind).map(|entry| entry.class.name);
        let is_slip = self.registry.class(kind, &name.text).is_none()
            && near(&name.text, names()).is_some_and(|near| near.grade == Grade::Sure);
        if is_slip {
            let _told = self.head(object, object.category.span.to(object.body.span), None, None);
        }
    }

    /// Names that are no parameters.
    fn look_at_names(&mut self, object: &Object, env: &Env) {
        let Some(class) = self.class_of(object) else { return };
        let fields = fields(object).map(|field| valued(field, Value::Poison, &env.file));
        let fields: Vec<_> = fields.collect();
        for (i, field) in fields.iter().enumerate() {
            if !has_param(&class, &field.name.text) {
                self.unknown_param(&class, &fields, i);
            }
        }
    }

    /// Parameters whose values are the same wherever they are evaluated.
    fn look_at_constants(&mut self, object: &Object, env: &Env) {
        let Some(class) = self.class_of(object) else { return };
        for field in fields(object).filter(|field| is_constant(&field.value)) {
            let param = Registry::params(&class).find(|param| param.name == &*field.name.text);
            if let Some(param) = param {
                let value = self.eval(&field.value, env);
                if !matches!(value, Value::Poison) {
                    self.conform(param, &valued(field, value, &env.file));
                }
            }
        }
    }

    fn class_of(&self, object: &Object) -> Option<Class> {
        let kind = Kind::of_word(&object.category.text)?;
        self.registry.class(kind, &object.kind.as_ref()?.text).copied()
    }
}

/// The parameters that an object is given.
fn fields(object: &Object) -> impl Iterator<Item = &Field> {
    object.body.stmts.iter().filter(|stmt| !stmt.is_off()).filter_map(|stmt| match &stmt.node {
        StmtNode::Field(field) => Some(field),
        _ => None,
    })
}

fn valued(field: &Field, value: Value, file: &Rc<File>) -> FieldValue {
    FieldValue { name: field.name.clone(), value, span: field.value.span, file: file.clone() }
}

/// Whether a value is a number, a few of them, a text or a condition, as it is written.
fn is_constant(value: &Expr) -> bool {
    match &value.node {
        ExprNode::Number(..) | ExprNode::Text(_) | ExprNode::Bool(_) => true,
        ExprNode::Numbers { data, .. } => data.len() <= FEW,
        ExprNode::Paren { inner, .. } | ExprNode::Unary { inner, .. } => is_constant(inner),
        _ => false,
    }
}

/// Whether not all that a statement says need be evaluated.
fn may_be_untaken(stmt: &Stmt) -> bool {
    matches!(stmt.node, StmtNode::Fn(_) | StmtNode::For { .. } | StmtNode::If { .. })
}
