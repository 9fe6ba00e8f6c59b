//! Every expression of a statement.

use super::tree::{Block, Expr, ExprNode, FnBody, Stmt, StmtNode, children};

/// Calls `each` on every expression in a statement, those in objects and blocks included.
pub(crate) fn each_expr<'s>(stmt: &'s Stmt, each: &mut dyn FnMut(&'s Expr)) {
    match &stmt.node {
        StmtNode::Let { value, .. } | StmtNode::Set { value, .. } => expr(value, each),
        StmtNode::Param(def) => {
            expr(&def.value, each);
            if let Some(range) = &def.range {
                expr(range, each);
            }
        }
        StmtNode::Fn(def) => {
            def.params.iter().flat_map(|param| &param.default).for_each(|value| expr(value, each));
            match &def.body {
                FnBody::Value(value) => expr(value, each),
                FnBody::Template(inner) => block(inner, each),
            }
        }
        StmtNode::For { over, body, .. } => {
            expr(over, each);
            block(body, each);
        }
        StmtNode::If { arms, otherwise } => {
            for (cond, inner) in arms {
                expr(cond, each);
                block(inner, each);
            }
            if let Some(inner) = otherwise {
                block(inner, each);
            }
        }
        StmtNode::Include { with: fields, .. } | StmtNode::Units(fields) => {
            for field in fields {
                expr(&field.value, each);
            }
        }
        StmtNode::Place { body, .. } => body.iter().for_each(|inner| block(inner, each)),
        StmtNode::Assert { cond, .. } => expr(cond, each),
        StmtNode::Expect(said) => {
            let at = said.at.iter().flat_map(|(_, args)| args).map(|arg| &arg.value);
            let given = said.given.iter().map(|field| &field.value);
            at.chain(&said.values).chain(given).for_each(|value| expr(value, each));
        }
        StmtNode::Field(field) => expr(&field.value, each),
        StmtNode::Object(object) => block(&object.body, each),
        StmtNode::Call(call) => expr(call, each),
        StmtNode::Import { .. } | StmtNode::Use { .. } | StmtNode::Broken { .. } => {}
    }
}

fn block<'s>(inner: &'s Block, each: &mut dyn FnMut(&'s Expr)) {
    for stmt in &inner.stmts {
        each_expr(stmt, each);
    }
}

fn expr<'s>(value: &'s Expr, each: &mut dyn FnMut(&'s Expr)) {
    each(value);
    if let ExprNode::Object(object) = &value.node {
        block(&object.body, each);
    }
    children(value, &mut |child| expr(child, each));
}
