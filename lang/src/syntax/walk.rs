//! Every expression and every object of a statement.

use super::tree::{Block, Expr, ExprNode, FnBody, Object, Stmt, StmtNode, children};

/// What a statement is made of.
#[derive(Clone, Copy)]
enum Part<'s> {
    Expr(&'s Expr),
    Object(&'s Object),
}

/// What is done with each part.
type Each<'e, 's> = &'e mut dyn FnMut(Part<'s>);

/// Calls `each` on every expression in a statement, those in objects and blocks included.
pub(crate) fn each_expr<'s>(stmt: &'s Stmt, each: &mut dyn FnMut(&'s Expr)) {
    each_part(stmt, &mut |part| {
        if let Part::Expr(expr) = part {
            each(expr);
        }
    });
}

/// The same with every object.
pub(crate) fn each_object<'s>(stmt: &'s Stmt, each: &mut dyn FnMut(&'s Object)) {
    each_part(stmt, &mut |part| {
        if let Part::Object(object) = part {
            each(object);
        }
    });
}

fn each_part<'s>(stmt: &'s Stmt, each: Each<'_, 's>) {
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
        StmtNode::Object(inner) => object(inner, each),
        StmtNode::Call(call) => expr(call, each),
        StmtNode::Import { .. } | StmtNode::Use { .. } | StmtNode::Broken { .. } => {}
    }
}

fn block<'s>(inner: &'s Block, each: Each<'_, 's>) {
    for stmt in &inner.stmts {
        each_part(stmt, each);
    }
}

fn object<'s>(inner: &'s Object, each: Each<'_, 's>) {
    each(Part::Object(inner));
    block(&inner.body, each);
}

fn expr<'s>(value: &'s Expr, each: Each<'_, 's>) {
    each(Part::Expr(value));
    if let ExprNode::Object(inner) = &value.node {
        object(inner, each);
    }
    children(value, &mut |child| expr(child, each));
}
