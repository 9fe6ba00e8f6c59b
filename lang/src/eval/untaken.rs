//! What is not evaluated, and may be wrong all the same: functions that nobody calls, arms that are not
//! taken, loops without a turn, what is off. The parameters of objects in it are looked at by name.

use std::rc::Rc;

use luxel_sdk::kind::Kind;

use super::Evaluator;
use super::env::{Env, File};
use super::object::has_param;
use super::value::{FieldValue, Value};
use crate::syntax::{Object, Stmt, StmtNode, each_object};

impl Evaluator<'_> {
    /// Tells of names that are no parameters in parts of a statement that may not be evaluated. What was
    /// told already is not told again.
    pub(super) fn look_at_untaken(&mut self, stmt: &Stmt, env: &Env) {
        if may_be_untaken(stmt) {
            each_object(stmt, &mut |object| self.look_at_fields(object, &env.file));
        } else if let StmtNode::Object(object) = &stmt.node {
            for inner in &object.body.stmts {
                self.look_at_untaken(inner, env);
            }
        }
    }

    fn look_at_fields(&mut self, object: &Object, file: &Rc<File>) {
        let kind = Kind::of_word(&object.category.text).zip(object.kind.as_ref());
        let Some(class) = kind.and_then(|(kind, name)| self.registry.class(kind, &name.text))
        else {
            return;
        };
        let fields = object.body.stmts.iter().filter(|stmt| !stmt.is_off());
        let fields = fields.filter_map(|stmt| match &stmt.node {
            StmtNode::Field(field) => Some(FieldValue {
                name: field.name.clone(),
                value: Value::Poison,
                span: field.value.span,
                file: file.clone(),
            }),
            _ => None,
        });
        let fields: Vec<_> = fields.collect();
        for field in &fields {
            if !has_param(class, &field.name.text) {
                self.unknown_param(class, field, &fields);
            }
        }
    }
}

/// Whether not all that a statement says need be evaluated.
fn may_be_untaken(stmt: &Stmt) -> bool {
    stmt.is_off()
        || matches!(stmt.node, StmtNode::Fn(_) | StmtNode::For { .. } | StmtNode::If { .. })
}
