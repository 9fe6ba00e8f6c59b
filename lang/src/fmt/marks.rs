//! What the tree knows and a token alone does not: where statements and fields begin, and which
//! operators stand between operands.

use luxel_core::diag::Span;

use crate::syntax::{Arg, Block, Expr, ExprNode, Field, FnBody, Stmt, StmtNode, Tree};

/// Places of a text, each list in order.
pub(super) struct Marks {
    /// Where statements (with their docs) and fields begin.
    pub(super) starts: Vec<u32>,
    /// Where operators between two operands stand.
    pub(super) binary: Vec<u32>,
}

impl Marks {
    /// Those of a tree.
    pub(super) fn of(tree: &Tree) -> Self {
        let mut marks = Self { starts: vec![], binary: vec![] };
        tree.stmts.iter().for_each(|stmt| marks.stmt(stmt));
        marks.starts.sort_unstable();
        marks.binary.sort_unstable();
        marks
    }

    /// Whether the operator at this byte stands between operands.
    pub(super) fn is_binary(&self, at: usize) -> bool {
        u32::try_from(at).is_ok_and(|at| self.binary.binary_search(&at).is_ok())
    }

    fn start(&mut self, span: Span) {
        self.starts.push(span.start);
    }

    fn block(&mut self, block: &Block) {
        block.stmts.iter().for_each(|stmt| self.stmt(stmt));
    }

    fn stmt(&mut self, stmt: &Stmt) {
        self.start(stmt.span);
        match &stmt.node {
            StmtNode::Let { value, .. } | StmtNode::Set { value, .. } => self.expr(value),
            StmtNode::Param(param) => {
                self.expr(&param.value);
                param.range.iter().for_each(|range| self.expr(range));
            }
            StmtNode::Fn(function) => {
                let defaults = function.params.iter().filter_map(|param| param.default.as_ref());
                defaults.for_each(|value| self.expr(value));
                match &function.body {
                    FnBody::Value(value) => self.expr(value),
                    FnBody::Template(block) => self.block(block),
                }
            }
            StmtNode::For { over, body, .. } => {
                self.expr(over);
                self.block(body);
            }
            StmtNode::If { arms, otherwise } => {
                for (cond, block) in arms {
                    self.expr(cond);
                    self.block(block);
                }
                if let Some(block) = otherwise {
                    self.block(block);
                }
            }
            StmtNode::Include { with: fields, .. } | StmtNode::Units(fields) => self.fields(fields),
            StmtNode::Place { body, .. } => body.iter().for_each(|block| self.block(block)),
            StmtNode::Assert { cond, .. } => self.expr(cond),
            StmtNode::Expect(expect) => {
                expect.at.iter().for_each(|(_, args)| self.args(args));
                expect.values.iter().for_each(|value| self.expr(value));
                self.fields(&expect.given);
            }
            StmtNode::Field(field) => self.expr(&field.value),
            StmtNode::Object(object) => self.block(&object.body),
            StmtNode::Call(call) => self.expr(call),
            StmtNode::Import { .. } | StmtNode::Use { .. } | StmtNode::Broken { .. } => {}
        }
    }

    fn fields(&mut self, fields: &[Field]) {
        for field in fields {
            self.start(field.name.span);
            self.expr(&field.value);
        }
    }

    fn args(&mut self, args: &[Arg]) {
        for arg in args {
            self.expr(&arg.value);
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.node {
            ExprNode::Items { items, .. } => items.iter().for_each(|item| self.expr(item)),
            ExprNode::Paren { inner, .. } | ExprNode::Unary { inner, .. } => self.expr(inner),
            ExprNode::Comp(comp) => {
                self.expr(&comp.over);
                comp.filter.iter().for_each(|filter| self.expr(filter));
                self.expr(&comp.value);
            }
            ExprNode::If { arms, otherwise } => {
                for (cond, value) in arms {
                    self.expr(cond);
                    self.expr(value);
                }
                self.expr(otherwise);
            }
            ExprNode::Object(object) => self.block(&object.body),
            ExprNode::Record(fields) => self.fields(fields),
            ExprNode::Chain { first, rest } => {
                self.expr(first);
                for (_, span, operand) in rest {
                    self.binary.push(span.start);
                    self.expr(operand);
                }
            }
            ExprNode::Call { callee, args } => {
                self.expr(callee);
                self.args(args);
            }
            ExprNode::Index { of, at } => {
                self.expr(of);
                self.expr(at);
            }
            ExprNode::Member { of, .. } => self.expr(of),
            ExprNode::With { of, fields } => {
                self.expr(of);
                self.fields(fields);
            }
            ExprNode::Number(..)
            | ExprNode::Numbers { .. }
            | ExprNode::Text(_)
            | ExprNode::Bool(_)
            | ExprNode::Path(_)
            | ExprNode::Broken => {}
        }
    }
}
