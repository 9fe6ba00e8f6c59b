//! Names before evaluation: every use has a definition before it, in the branches not taken too.
//!
//! After this, an unknown name is poison that says nothing more.

use std::collections::{BTreeMap, BTreeSet};
use std::slice;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Grade, Span};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Unit;

use super::by_name::ByName;
use super::mention::mention_body;
use super::{builtins, types};
use crate::sink::Sink;
use crate::syntax::{
    Arg, COMPARES, Comp, Expect, Expr, ExprNode, Field, FnBody, FnDef, Name, Object, Op, Stmt,
    StmtNode, Tree, Ty, children, says_units, stray,
};
use crate::words::RESERVED;

/// Tells every name that is unknown, used too early or defined twice.
pub(crate) fn resolve(tree: &Tree, text: &str, sink: &mut Sink) {
    let mut resolver = Resolver::new(text, sink);
    resolver.block(&tree.stmts, &[]);
}

/// Whether an expression names nothing but what every scene has, and makes no object.
pub(super) fn is_constant(expr: &Expr) -> bool {
    let mut sink = Sink::new(usize::MAX);
    let mut resolver = Resolver::new("", &mut sink);
    resolver.scopes.push(Scope::default());
    resolver.expr(expr);
    sink.errors() == 0
}

/// The names of a file.
pub(super) trait Around {
    /// The statement that first defines a name, and where it stands in the file.
    fn definer(&self, name: &str) -> Option<(usize, Span)>;
    /// The statement that first bears a label, and where it stands in the file.
    fn labeller(&self, label: &str) -> Option<(usize, Span)>;
    /// The names that are defined before a statement.
    fn before(&self, statement: usize) -> Vec<&str>;
    /// Whether a statement before one defines a function of this name.
    fn has_function_before(&self, statement: usize, name: &str) -> bool;
}

/// Whether a name that stands there in a text is that of a function, be it one that cannot be read.
pub(super) fn follows_fn(text: &str, name: Span) -> bool {
    text.get(..name.range().start).is_some_and(|before| before.trim_end().ends_with("fn"))
}

/// The names of one block.
#[derive(Default)]
pub(super) struct Scope {
    pub(super) names: ByName<Span>,
    /// Every name that the block defines anywhere.
    pub(super) later: ByName<Span>,
    /// What the functions of the block mention.
    pub(super) mentions: BTreeMap<Arc<str>, BTreeSet<Arc<str>>>,
    pub(super) labels: ByName<Span>,
}

pub(super) struct Resolver<'a> {
    pub(super) sink: &'a mut Sink,
    pub(super) scopes: Vec<Scope>,
    /// The functions whose bodies are being read.
    pub(super) functions: Vec<Name>,
    /// The file.
    pub(super) text: &'a str,
    /// In the body of an object that holds no others.
    in_object: bool,
    /// In the body of what has fields, which define nothing.
    has_fields: bool,
    /// Where names that nothing defines are kept instead of being told.
    pub(super) free: Option<BTreeMap<Arc<str>, u32>>,
    /// The file of a statement that is looked at by itself, and which it is: `scopes` has only what it mentions.
    pub(super) around: Option<(&'a dyn Around, usize)>,
}

/// What a statement mentions, if it is a function.
pub(super) fn mentions(stmt: &Stmt) -> Option<(Arc<str>, BTreeSet<Arc<str>>)> {
    let StmtNode::Fn(def) = &stmt.node else { return None };
    let mut mentions = BTreeSet::new();
    mention_body(def, &mut mentions);
    Some((def.name.text.clone(), mentions))
}

/// The names that a statement defines.
pub(super) fn defines(stmt: &Stmt) -> &[Name] {
    match &stmt.node {
        StmtNode::Let { name, .. } | StmtNode::Import { name, .. } => slice::from_ref(name),
        StmtNode::Param(def) => slice::from_ref(&def.name),
        StmtNode::Fn(def) => slice::from_ref(&def.name),
        StmtNode::Broken { defines } => defines,
        _ => &[],
    }
}

/// The names that a statement of a file may be meant to define, if it is a field.
pub(super) fn stray_names(stmt: &Stmt) -> impl Iterator<Item = Name> {
    let name = match &stmt.node {
        StmtNode::Field(field) => Some(&field.name),
        _ => None,
    };
    name.into_iter().flat_map(stray)
}

impl<'a> Resolver<'a> {
    /// Nothing is defined yet.
    pub(super) fn new(text: &'a str, sink: &'a mut Sink) -> Self {
        let (scopes, functions) = (vec![], vec![]);
        let (in_object, has_fields) = (false, false);
        Self { sink, text, scopes, functions, in_object, has_fields, free: None, around: None }
    }

    fn block(&mut self, stmts: &[Stmt], names: &[&Name]) {
        let mut scope = Scope::default();
        for stmt in stmts.iter().filter(|stmt| !stmt.is_off()) {
            for name in defines(stmt) {
                scope.later.entry(name.text.clone()).or_insert(name.span);
            }
            for name in stray_names(stmt).filter(|_| !self.has_fields) {
                scope.later.entry(name.text).or_insert(name.span);
            }
            scope.mentions.extend(mentions(stmt));
        }
        self.scopes.push(scope);
        for name in names {
            self.define(name);
        }
        for stmt in stmts {
            self.stmt(stmt);
        }
        self.scopes.pop();
    }

    /// The body of what has fields, or none.
    fn body(&mut self, stmts: &[Stmt], has_fields: bool) {
        let outer = std::mem::replace(&mut self.has_fields, has_fields);
        self.block(stmts, &[]);
        self.has_fields = outer;
    }

    fn define(&mut self, name: &Name) {
        // Told where it was read.
        if RESERVED.contains(&&*name.text) {
            return;
        }
        if let Some(unit) = Unit::named(&name.text) {
            let message = format!(
                "`{}` is a unit ({}) and cannot be a name",
                name.text,
                unit.dimension.name()
            );
            self.sink.push(
                Diagnostic::error("E0104", name.span, message)
                    .help(format!("choose a longer name, as `{}_`", name.text)),
            );
        }
        let Some(scope) = self.scopes.last_mut() else { return };
        if let Some(first) = scope.names.get(&name.text) {
            let message = format!("`{}` is defined twice", name.text);
            self.sink.push(
                Diagnostic::error("E0103", name.span, message).label(*first, "first defined here"),
            );
            return;
        }
        scope.names.insert(name.text.clone(), name.span);
    }

    /// Looks at a statement of the innermost block.
    pub(super) fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.node {
            StmtNode::Let { name, ty, value } => {
                self.expr(value);
                if let Some(ty) = ty {
                    self.ty(ty);
                }
                self.define_on(stmt, name);
            }
            StmtNode::Param(def) => {
                self.ty(&def.ty);
                self.expr(&def.value);
                def.range.iter().for_each(|range| self.expr(range));
                self.define_on(stmt, &def.name);
            }
            StmtNode::Fn(def) => {
                self.function(def);
                self.define_on(stmt, &def.name);
            }
            StmtNode::For { index, item, over, body } => {
                self.expr(over);
                let names: Vec<&Name> = index.iter().chain([item]).collect();
                self.scoped(&names, |this| this.block(&body.stmts, &[]));
            }
            StmtNode::If { arms, otherwise } => {
                for (cond, block) in arms {
                    self.expr(cond);
                    self.block(&block.stmts, &[]);
                }
                if let Some(block) = otherwise {
                    self.block(&block.stmts, &[]);
                }
            }
            StmtNode::Include { with, .. } => self.fields(with),
            StmtNode::Import { name, .. } => self.define_on(stmt, name),
            StmtNode::Place { what, label, body } => {
                self.expr(what);
                self.label(stmt, label.as_ref());
                if let Some(block) = body {
                    self.body(&block.stmts, true);
                }
            }
            StmtNode::Set { value, .. } => self.expr(value),
            StmtNode::Assert { cond, .. } => self.expr(cond),
            StmtNode::Expect(said) => self.expectation(said),
            StmtNode::Units(_) | StmtNode::Use { .. } => {}
            StmtNode::Field(field) => {
                self.expr(&field.value);
                // That it stands in no object is told when it is evaluated.
                if !self.has_fields {
                    self.perhaps(stray_names(stmt));
                }
            }
            StmtNode::Object(object) => {
                self.label(stmt, object.label.as_ref());
                self.object(object);
            }
            StmtNode::Call(call) => self.call(call),
            StmtNode::Broken { defines } => self.perhaps(defines.iter().cloned()),
        }
    }

    /// Names that a statement which is wrong may be meant to define.
    fn perhaps(&mut self, names: impl Iterator<Item = Name>) {
        let Some(scope) = self.scopes.last_mut() else { return };
        for name in names {
            scope.names.entry(name.text).or_insert(name.span);
        }
    }

    /// Defines a name, unless the statement is off.
    fn define_on(&mut self, stmt: &Stmt, name: &Name) {
        if !stmt.is_off() {
            self.define(name);
        }
    }

    fn expectation(&mut self, said: &Expect) {
        for arg in said.at.iter().flat_map(|(_, args)| args) {
            self.expr(&arg.value);
        }
        for value in &said.values {
            self.expr(value);
        }
        self.fields(&said.given);
    }

    /// Two objects of a block must not share a label.
    fn label(&mut self, stmt: &Stmt, label: Option<&Name>) {
        let (Some(label), Some(scope)) = (label, self.scopes.last_mut()) else { return };
        if stmt.is_off() {
            return;
        }
        let first = *scope.labels.entry(label.text.clone()).or_insert(label.span);
        if first != label.span {
            let message = format!("the label \"{}\" is used twice", label.text);
            self.sink.push(
                Diagnostic::error("E0110", label.span, message).label(first, "first used here"),
            );
        }
    }

    fn scoped(&mut self, names: &[&Name], inside: impl FnOnce(&mut Self)) {
        self.scopes.push(Scope::default());
        for name in names {
            self.define(name);
        }
        inside(self);
        self.scopes.pop();
    }

    fn function(&mut self, def: &FnDef) {
        let names: Vec<&Name> = def.params.iter().map(|p| &p.name).collect();
        for param in &def.params {
            self.ty(&param.ty);
        }
        self.functions.push(def.name.clone());
        self.scopes.push(Scope::default());
        for (i, param) in def.params.iter().enumerate() {
            param.default.iter().for_each(|value| self.expr(value));
            self.define(names[i]);
        }
        match &def.body {
            FnBody::Value(value) => self.expr(value),
            FnBody::Template(block) => self.body(&block.stmts, false),
        }
        self.scopes.pop();
        self.functions.pop();
    }

    fn object(&mut self, object: &Object) {
        // Units of numbers are no names.
        if Kind::of_word(&object.category.text).is_none() && says_units(&object.category.text) {
            return;
        }
        let outer = std::mem::replace(&mut self.in_object, &*object.category.text != "group");
        self.apart(&object.body.stmts);
        self.body(&object.body.stmts, true);
        self.in_object = outer;
    }

    /// Parameters on one line have a comma between them.
    fn apart(&mut self, stmts: &[Stmt]) {
        for pair in stmts.windows(2) {
            let StmtNode::Field(one) = &pair[0].node else { continue };
            let (name, place) = match &pair[1].node {
                StmtNode::Field(next) => (&*next.name.text, next.name.span),
                StmtNode::Call(call) => match called(call).filter(|_| self.in_object) {
                    Some(name) => (&*name.text, name.span),
                    None => continue,
                },
                _ => continue,
            };
            let end = one.value.span.end;
            let between = self.text.get(end as usize..place.start as usize);
            // What ends with a line ends in a brace that was put there; of a `.` it is said what it is.
            let ends_line = self.text.get(..end as usize).is_some_and(|it| it.ends_with('\n'));
            if ends_line || between.is_none_or(|between| between.contains([',', ';', '.', '\n'])) {
                continue;
            }
            let gap = Span { start: end, end, ..place };
            let found =
                Diagnostic::error("E0014", place, format!("a comma is missing before `{name}`"));
            self.sink.push(match &pair[1].node {
                StmtNode::Field(_) => found.fix(gap, ","),
                _ if &*one.name.text == "transform" => found
                    .help("several transforms stand in a list: `[scale(2), move((1, 0, 0) m)]`"),
                _ => found,
            });
        }
    }

    /// A call as a statement. In an object, where none can stand, `center (0, 1, 0)` is a parameter
    /// whose `=` is missing.
    fn call(&mut self, call: &Expr) {
        match called(call).filter(|name| self.in_object && self.is_unknown(name)) {
            Some(name) => self.no_equals(call, name),
            None => self.expr(call),
        }
    }

    /// Whether nobody defines a name. Of a statement that is looked at alone, others may.
    pub(super) fn is_unknown(&self, name: &Name) -> bool {
        let name = &name.text;
        let known = |s: &Scope| s.names.contains_key(name) || s.later.contains_key(name);
        self.free.is_none() && !self.scopes.iter().any(known) && builtins::value(name).is_none()
    }

    /// Arguments of a call; of a function that every scene has, `to (0, 1, 0)` is one whose `=` is
    /// missing.
    fn args(&mut self, function: &[Name], args: &[Arg]) {
        let words: Vec<&str> = function.iter().map(|name| &*name.text).collect();
        let function = words.join(".");
        for arg in args {
            let takes = |name: &&Name| builtins::takes(&function, &name.text);
            let name = called(&arg.value).filter(takes).filter(|name| self.is_unknown(name));
            match name.filter(|_| arg.name.is_none()) {
                Some(name) => self.no_equals(&arg.value, name),
                None if self.is_compared(&function, &arg.value) => {}
                None if self.is_unquoted(&function, &arg.value) => {}
                None => self.expr(&arg.value),
            }
        }
    }

    /// Whether an argument compares a name of the function's own with a value, which is told:
    /// `to == (0, 1, 0)`.
    fn is_compared(&mut self, function: &str, value: &Expr) -> bool {
        let ExprNode::Chain { first, rest } = &value.node else { return false };
        let (ExprNode::Path(path), [(Op::Eq, op, given)]) = (&first.node, &rest[..]) else {
            return false;
        };
        let takes = path.len() == 1 && builtins::takes(function, &path[0].text);
        if !takes || !self.is_unknown(&path[0]) {
            return false;
        }
        self.sink.push(Diagnostic::error("E0013", *op, COMPARES).fix(*op, "="));
        self.expr(given);
        true
    }

    /// Tells that a call is a name and its value.
    fn no_equals(&mut self, call: &Expr, name: &Name) {
        let ExprNode::Call { args, .. } = &call.node else { return };
        let (start, end, name) = (name.span.start, name.span.end, &name.text);
        let blanks = self.text.get(end as usize..).and_then(|rest| rest.find('(')).unwrap_or(0);
        let value = Span { start: end + u32::try_from(blanks).unwrap_or(0), ..call.span };
        let message = format!("`=` is missing between `{name}` and its value");
        let gap = Span { start: end, end, ..value };
        // `phase henyey_greenstein(0.5)` is an object.
        let before = self.text.get(..start as usize).unwrap_or_default().trim_end();
        let last = before.rsplit(|c: char| !c.is_ascii_alphanumeric() && c != '_').next();
        let is_kind = last.is_some_and(|word| Kind::of_word(word).is_some());
        let grade = if is_kind { Grade::Guess } else { Grade::Sure };
        self.sink.push(Diagnostic::error("E0012", value, message).mend(gap, " =", grade));
        for arg in args {
            self.expr(&arg.value);
        }
    }

    fn fields(&mut self, fields: &[Field]) {
        for field in fields {
            self.expr(&field.value);
        }
    }

    fn ty(&mut self, ty: &Ty) {
        if types::names().any(|known| known == &*ty.name.text) {
            return;
        }
        let message = format!("there is no type `{}`", ty.name.text);
        let found = Diagnostic::error("E0215", ty.name.span, message)
            .meant(ty.name.span, types::meant(&ty.name.text));
        let known: Vec<_> = types::names().collect();
        self.sink.push(found.help(format!("known are {}", known.join(", "))));
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.node {
            ExprNode::Path(path) => self.path(path, expr.span),
            ExprNode::Object(object) => self.object(object),
            ExprNode::Comp(comp) => self.comp(comp),
            ExprNode::Call { callee, args } => {
                self.expr(callee);
                match &callee.node {
                    ExprNode::Path(path) => self.args(path, args),
                    _ => {
                        for arg in args {
                            self.expr(&arg.value);
                        }
                    }
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

    fn comp(&mut self, comp: &Comp) {
        self.expr(&comp.over);
        let names: Vec<&Name> = comp.index.iter().chain([&comp.item]).collect();
        self.scoped(&names, |this| {
            comp.filter.iter().for_each(|filter| this.expr(filter));
            this.expr(&comp.value);
        });
    }

    fn path(&mut self, path: &[Name], span: Span) {
        let Some(first) = path.first() else { return };
        if self.scopes.iter().any(|scope| scope.names.contains_key(&first.text)) {
            return;
        }
        let words: Vec<&str> = path.iter().map(|name| &*name.text).collect();
        let joined = words.join(".");
        if builtins::value(&joined).is_some() {
            return;
        }
        if let Some(free) = &mut self.free {
            *free.entry(first.text.clone()).or_default() += 1;
            return;
        }
        // What is only counted needs no advice.
        let diagnostic = if self.sink.is_full() {
            Diagnostic::error("E0101", span, "there is no such name")
        } else {
            self.later(first).unwrap_or_else(|| self.unknown(first, &joined, span))
        };
        self.sink.push(diagnostic);
    }
}

/// The single name that is called, if an expression is such a call.
fn called(call: &Expr) -> Option<&Name> {
    match &call.node {
        ExprNode::Call { callee, .. } => match &callee.node {
            ExprNode::Path(path) if path.len() == 1 => path.first(),
            _ => None,
        },
        _ => None,
    }
}
