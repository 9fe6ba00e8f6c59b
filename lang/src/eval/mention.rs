//! What expressions and statements mention, for whoever asks before they are evaluated.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::syntax::{Expr, ExprNode, FnBody, FnDef, Stmt, StmtNode, children};

/// The names that a function's body mentions.
pub(super) fn mention_body(def: &FnDef, out: &mut BTreeSet<Arc<str>>) {
    match &def.body {
        FnBody::Value(value) => mention(value, out),
        FnBody::Template(block) => mention_stmts(&block.stmts, out),
    }
}

fn mention(expr: &Expr, out: &mut BTreeSet<Arc<str>>) {
    match &expr.node {
        ExprNode::Path(path) => out.extend(path.first().map(|name| name.text.clone())),
        ExprNode::Object(object) => mention_stmts(&object.body.stmts, out),
        _ => children(expr, &mut |child| mention(child, out)),
    }
}

/// The names that statements mention.
pub(super) fn mention_stmts(stmts: &[Stmt], out: &mut BTreeSet<Arc<str>>) {
    for stmt in stmts {
        match &stmt.node {
            StmtNode::Let { value, .. }
            | StmtNode::Set { value, .. }
            | StmtNode::Assert { cond: value, .. }
            | StmtNode::Call(value) => mention(value, out),
            StmtNode::Fn(def) => {
                let defaults = def.params.iter().flat_map(|param| &param.default);
                defaults.for_each(|value| mention(value, out));
                mention_body(def, out);
            }
            StmtNode::Param(def) => {
                [&def.value].into_iter().chain(&def.range).for_each(|value| mention(value, out));
            }
            StmtNode::Include { with, .. } => {
                for field in with {
                    mention(&field.value, out);
                }
            }
            StmtNode::For { over, body, .. } => {
                mention(over, out);
                mention_stmts(&body.stmts, out);
            }
            StmtNode::If { arms, otherwise } => {
                for (cond, block) in arms {
                    mention(cond, out);
                    mention_stmts(&block.stmts, out);
                }
                if let Some(block) = otherwise {
                    mention_stmts(&block.stmts, out);
                }
            }
            StmtNode::Place { what, body, .. } => {
                mention(what, out);
                if let Some(block) = body {
                    mention_stmts(&block.stmts, out);
                }
            }
            StmtNode::Expect(said) => {
                let at = said.at.iter().flat_map(|(_, args)| args).map(|arg| &arg.value);
                let given = said.given.iter().map(|field| &field.value);
                at.chain(&said.values).chain(given).for_each(|value| mention(value, out));
            }
            StmtNode::Field(field) => mention(&field.value, out),
            StmtNode::Object(object) => mention_stmts(&object.body.stmts, out),
            _ => {}
        }
    }
}
