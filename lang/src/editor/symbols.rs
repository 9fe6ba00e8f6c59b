//! What each name in a statement defines or refers to, by the rules of the language: static scopes.

use std::ops::Range;
use std::sync::Arc;

use luxel_core::diag::Span;

use crate::syntax::{
    Arg, Block, Comp, Expr, ExprNode, Field, FnBody, FnDef, Name, Object, Stmt, StmtNode, children,
};

/// A name at a place, counted from the first byte of its statement.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Symbol {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) text: Arc<str>,
    pub(super) role: Role,
}

/// What a name does. Places are starts of other symbols of the statement.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Role {
    /// It is defined here.
    Definition(Sort),
    /// It is the one that is defined here.
    Local(usize),
    /// It is a name of the file, or one that every scene has.
    Top,
    /// It is a name of what stands before the dot.
    Member(usize),
    /// It names an argument of this function.
    Argument(usize),
    /// It is a parameter of this file.
    ParamOf(Arc<str>),
    /// It labels an object; the place includes quotes.
    Label,
    /// It is a label.
    Labelled,
    /// It is a file; the place includes quotes.
    File,
}

/// What kind of thing is defined.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Sort {
    Let,
    Param,
    Fn,
    /// The names of this file.
    Import(Arc<str>),
    /// What a loop runs through.
    Item,
    /// An argument of the function that is defined here.
    ArgumentOf(usize),
}

impl Symbol {
    /// Its bytes in a file in which its statement begins at `start`.
    pub(super) fn range(&self, start: usize) -> Range<usize> {
        start + self.start..start + self.end
    }
}

/// The names of statements with relative spans, in the order of the text.
pub(super) fn symbols(stmts: &[Stmt]) -> Vec<Symbol> {
    let mut walk = Walk { out: vec![], scopes: vec![], is_off: false };
    for stmt in stmts {
        walk.stmt(stmt);
    }
    walk.out.sort_by_key(|symbol| symbol.start);
    walk.out
}

struct Walk {
    out: Vec<Symbol>,
    /// The names of each block inside the statement, with where they are defined.
    scopes: Vec<Vec<(Arc<str>, usize)>>,
    /// Inside a statement that `@off` takes out.
    is_off: bool,
}

impl Walk {
    fn add(&mut self, text: &Arc<str>, span: Span, role: Role) {
        let Range { start, end } = span.range();
        self.out.push(Symbol { start, end, text: text.clone(), role });
    }

    fn define(&mut self, name: &Name, sort: Sort) {
        if let Some(scope) = self.scopes.last_mut() {
            scope.push((name.text.clone(), name.span.range().start));
        }
        self.add(&name.text, name.span, Role::Definition(sort));
    }

    fn used(&mut self, name: &Name) {
        let mut inner = self.scopes.iter().rev().flat_map(|scope| scope.iter().rev());
        let role = match inner.find(|(text, _)| *text == name.text) {
            Some((_, place)) => Role::Local(*place),
            None => Role::Top,
        };
        self.add(&name.text, name.span, role);
    }

    fn stmt(&mut self, stmt: &Stmt) {
        if !stmt.is_off() {
            return self.defining(stmt);
        }
        // What is off defines nothing for what follows.
        let was = std::mem::replace(&mut self.is_off, true);
        self.scoped(|walk| walk.defining(stmt));
        self.is_off = was;
    }

    fn defining(&mut self, stmt: &Stmt) {
        match &stmt.node {
            StmtNode::Let { name, value, .. } => {
                self.expr(value);
                self.define(name, Sort::Let);
            }
            StmtNode::Param(def) => {
                self.expr(&def.value);
                if let Some(range) = &def.range {
                    self.expr(range);
                }
                self.define(&def.name, Sort::Param);
            }
            StmtNode::Fn(def) => self.function(def),
            StmtNode::For { index, item, over, body } => {
                self.expr(over);
                self.scoped(|walk| {
                    index.iter().chain([item]).for_each(|name| walk.define(name, Sort::Item));
                    walk.block(body);
                });
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
            StmtNode::Include { path, with } => {
                self.add(&path.text, path.span, Role::File);
                self.params_of(path, with);
            }
            StmtNode::Import { path, name } => {
                self.add(&path.text, path.span, Role::File);
                self.define(name, Sort::Import(path.text.clone()));
            }
            _ => self.content(stmt),
        }
    }

    /// A statement that defines no name of the file.
    fn content(&mut self, stmt: &Stmt) {
        match &stmt.node {
            StmtNode::Place { what, label, body } => {
                self.expr(what);
                self.label(label.as_ref());
                if let Some(block) = body {
                    self.block(block);
                }
            }
            StmtNode::Set { path, value } => {
                path.iter()
                    .take(1)
                    .for_each(|name| self.add(&name.text, name.span, Role::Labelled));
                self.expr(value);
            }
            StmtNode::Assert { cond, .. } => self.expr(cond),
            StmtNode::Expect(said) => self.expectation(said),
            StmtNode::Field(field) => self.expr(&field.value),
            StmtNode::Object(object) => self.object(object),
            StmtNode::Call(call) => self.expr(call),
            StmtNode::Broken { defines } => {
                defines.iter().for_each(|name| self.define(name, Sort::Let));
            }
            _ => {}
        }
    }

    fn expectation(&mut self, said: &crate::syntax::Expect) {
        said.at.iter().flat_map(|(_, args)| args).for_each(|arg| self.expr(&arg.value));
        for value in &said.values {
            self.expr(value);
        }
        match &said.path {
            Some(path) => {
                self.add(&path.text, path.span, Role::File);
                self.params_of(path, &said.given);
            }
            None => {
                for field in &said.given {
                    self.add(&field.name.text, field.name.span, Role::Top);
                    self.expr(&field.value);
                }
            }
        }
    }

    fn params_of(&mut self, path: &Name, with: &[Field]) {
        for field in with {
            self.add(&field.name.text, field.name.span, Role::ParamOf(path.text.clone()));
            self.expr(&field.value);
        }
    }

    fn function(&mut self, def: &FnDef) {
        let own = def.name.span.range().start;
        self.scoped(|walk| {
            for param in &def.params {
                if let Some(value) = &param.default {
                    walk.expr(value);
                }
                walk.define(&param.name, Sort::ArgumentOf(own));
            }
            match &def.body {
                FnBody::Value(value) => walk.expr(value),
                FnBody::Template(block) => walk.block(block),
            }
        });
        self.define(&def.name, Sort::Fn);
    }

    fn block(&mut self, block: &Block) {
        self.scoped(|walk| block.stmts.iter().for_each(|stmt| walk.stmt(stmt)));
    }

    fn scoped(&mut self, inside: impl FnOnce(&mut Self)) {
        self.scopes.push(vec![]);
        inside(self);
        self.scopes.pop();
    }

    /// A label of what is off is none, but keeps the name of the object that has it.
    fn label(&mut self, label: Option<&Name>) {
        let role = if self.is_off { Role::Labelled } else { Role::Label };
        if let Some(label) = label {
            self.add(&label.text, label.span, role);
        }
    }

    fn object(&mut self, object: &Object) {
        self.label(object.label.as_ref());
        self.block(&object.body);
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.node {
            ExprNode::Path(path) => self.path(path),
            ExprNode::Object(object) => self.object(object),
            ExprNode::Comp(comp) => self.comp(comp),
            ExprNode::Call { callee, args } => self.call(callee, args),
            ExprNode::Member { of, name } => {
                self.expr(of);
                if let ExprNode::Path(path) = &of.node
                    && let Some(last) = path.last()
                {
                    self.add(&name.text, name.span, Role::Member(last.span.range().start));
                }
            }
            _ => {
                let mut inner = vec![];
                children(expr, &mut |child| inner.push(child));
                for child in inner {
                    self.expr(child);
                }
            }
        }
    }

    fn path(&mut self, path: &[Name]) {
        path.iter().take(1).for_each(|name| self.used(name));
        for pair in path.windows(2) {
            let before = pair[0].span.range().start;
            self.add(&pair[1].text, pair[1].span, Role::Member(before));
        }
    }

    fn call(&mut self, callee: &Expr, args: &[Arg]) {
        self.expr(callee);
        let function = match &callee.node {
            ExprNode::Path(path) => path.last().map(|name| name.span.range().start),
            _ => None,
        };
        for arg in args {
            if let (Some(name), Some(function)) = (&arg.name, function) {
                self.add(&name.text, name.span, Role::Argument(function));
            }
            self.expr(&arg.value);
        }
    }

    fn comp(&mut self, comp: &Comp) {
        self.expr(&comp.over);
        self.scoped(|walk| {
            comp.index.iter().chain([&comp.item]).for_each(|name| walk.define(name, Sort::Item));
            if let Some(filter) = &comp.filter {
                walk.expr(filter);
            }
            walk.expr(&comp.value);
        });
    }
}
