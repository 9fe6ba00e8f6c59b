//! Statements.

use std::rc::Rc;

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::abi::Class;

use super::Evaluator;
use super::env::Env;
use super::stray::Stray;
use super::value::{FieldValue, Function, Value};
use crate::syntax::{Block, Expr, ExprNode, Name, Op, Stmt, StmtNode};

/// What the statements of a block may say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// A file, or the body of a function: it emits.
    File,
    /// A group: it emits and has fields.
    Group,
    /// Any other object: it has fields alone.
    Object,
}

/// The fields that a block gives, and what of it is not known.
#[derive(Debug)]
pub(super) struct Body {
    pub(super) place: Place,
    pub(super) fields: Vec<FieldValue>,
    /// A condition or a call in it gave nothing.
    pub(super) broken: bool,
    /// Statements of it that cannot be read.
    pub(super) unread: Vec<Span>,
    /// Objects in it that have no name.
    pub(super) strays: Vec<Stray>,
    /// Parameters that they are meant for; `None` may be any.
    pub(super) meant: Vec<Option<&'static str>>,
    /// The class whose parameters the fields are, if it is known.
    pub(super) class: Option<Class>,
}

impl Body {
    pub(super) fn new(place: Place) -> Self {
        let (fields, unread, strays, meant) = Default::default();
        Self { place, fields, broken: false, unread, strays, meant, class: None }
    }

    /// Whether all of it is known, and is where it belongs.
    pub(super) fn is_whole(&self) -> bool {
        !self.broken && self.unread.is_empty() && self.meant.is_empty()
    }
}

impl Evaluator<'_> {
    /// The statements of a block, in an environment of their own.
    pub(super) fn block(&mut self, block: &Block, env: &Env, body: &mut Body) {
        if self.enter(block.span) && !block.stmts.is_empty() {
            self.stmts(&block.stmts, &env.inner(), body);
        }
        self.leave();
    }

    /// Statements one after another.
    pub(super) fn stmts(&mut self, stmts: &[Stmt], env: &Env, body: &mut Body) {
        for stmt in stmts {
            if !self.tick(1, stmt.span) {
                return;
            }
            if stmt.is_off() {
                self.labels.off(stmt);
            } else {
                self.stmt(stmt, env, body);
            }
            // Of what stands in a block, the statement of the file that it stands in is looked at.
            if self.depth == 0 && !self.stopped {
                self.look_at_untaken(stmt, env);
            }
        }
    }

    fn stmt(&mut self, stmt: &Stmt, env: &Env, body: &mut Body) {
        match &stmt.node {
            StmtNode::Let { name, ty, value } => {
                let mut found = self.eval(value, env);
                if let Some(ty) = ty {
                    found = self.fit(ty, found, value.span, env);
                }
                if stmt.is_likely {
                    found = Value::Poison;
                }
                self.note(name, &found);
                self.define(name, found, env);
            }
            StmtNode::Param(def) => {
                let value = self.param(def, env);
                self.note(&def.name, &value);
                self.define(&def.name, value, env);
            }
            StmtNode::Fn(def) => {
                let function = Function { def: def.clone(), env: env.frozen() };
                let function = Value::Function(Rc::new(function));
                self.define(&def.name, if stmt.is_likely { Value::Poison } else { function }, env);
            }
            StmtNode::For { index, item, over, body: block } => {
                self.for_loop((index.as_ref(), item), over, block, env, body);
            }
            StmtNode::If { arms, otherwise } => self.if_stmt(arms, otherwise.as_deref(), env, body),
            StmtNode::Import { path, name } => {
                let module = self.import(path, env);
                self.define(name, module, env);
            }
            StmtNode::Use { name, version } => self.require(name, version.as_ref()),
            StmtNode::Set { path, value } => {
                let found = self.eval(value, env);
                self.set(path, found, value.span, env);
            }
            StmtNode::Assert { cond, message } => self.assert(cond, message, env),
            StmtNode::Expect(said) => self.expectation(said, body.place, env),
            // The file's units were read before its first statement.
            StmtNode::Units(_) => {}
            StmtNode::Broken { defines } => {
                self.damaged = true;
                body.unread.push(stmt.span);
                for name in defines {
                    env.define(&name.text, Value::Poison);
                }
            }
            _ => self.content(stmt, env, body),
        }
    }

    /// Defines a name for what stands after it in its block.
    fn define(&mut self, name: &Name, value: Value, env: &Env) {
        let n_names = env.define(&name.text, value);
        if n_names > self.budgets.names && !self.stopped {
            let message = format!("a block defines more than {} names", self.budgets.names);
            self.over_budget("E0511", name.span, message, "names");
        }
    }

    /// A statement that gives a field or emits something.
    fn content(&mut self, stmt: &Stmt, env: &Env, body: &mut Body) {
        match &stmt.node {
            StmtNode::Include { path, with } => {
                let with = self.fields(with, env);
                self.emits(stmt.span, body, "include");
                self.include(path, with, env);
            }
            StmtNode::Place { what, label, body: block } => {
                self.emits(stmt.span, body, "place");
                self.place(what, label.as_ref(), block.as_deref(), stmt.span, env);
            }
            StmtNode::Field(field) => {
                let is_stray = body.place == Place::File;
                if let Some(object) = is_stray.then(|| self.given_object(field, env)).flatten() {
                    let value = self.object(&object, env, None);
                    self.emit(&value, object.head());
                    return;
                }
                let value = self.field(field, env);
                if is_stray {
                    self.stray_field(&field.name, env);
                }
                body.fields.push(value);
            }
            StmtNode::Object(object) => {
                let value = self.object(object, env, body.class.as_ref());
                if body.place == Place::Object {
                    body.strays.push(Stray::of(object));
                } else {
                    self.labels.add(object.label.as_ref(), &value);
                    self.emit(&value, object.head());
                }
            }
            StmtNode::Call(call) => self.call_stmt(call, env, body),
            _ => {}
        }
    }

    /// Whether things may be emitted here; told if not.
    fn emits(&mut self, span: Span, body: &Body, what: &str) {
        if body.place == Place::Object {
            let message = format!("`{what}` cannot stand in this object: only groups hold others");
            self.tell(Diagnostic::error("E0026", span, message));
        }
    }

    fn for_loop(
        &mut self,
        (index, item): (Option<&Name>, &Name),
        over: &Expr,
        block: &Block,
        env: &Env,
        body: &mut Body,
    ) {
        let value = self.eval(over, env);
        self.note(item, &value);
        let Some(elements) = self.elements(value, over.span) else {
            self.unseen.block = true;
            return;
        };
        self.note_index(index, &elements);
        self.loops.push(item.span);
        let repeats = self.repeats;
        let mut count = 0.0;
        let mut inner = env.inner();
        while let Some(element) = elements.get(count) {
            inner.renew();
            if let Some(index) = index {
                inner.define(&index.text, Value::plain(count));
            }
            inner.define(&item.text, element);
            count += 1.0;
            self.block(block, &inner, body);
            if !self.goes_on(repeats, 2, over.span) {
                break;
            }
        }
        self.loops.pop();
    }

    fn if_stmt(
        &mut self,
        arms: &[(Expr, Block)],
        otherwise: Option<&Block>,
        env: &Env,
        body: &mut Body,
    ) {
        for (cond, block) in arms {
            match self.condition(cond, env) {
                Some(true) => return self.block(block, env, body),
                Some(false) => {}
                None => {
                    // Which arm would count is unknown: what is missing later may stand in one.
                    self.damaged = true;
                    self.unseen.block = true;
                    body.broken = true;
                    return;
                }
            }
        }
        if let Some(block) = otherwise {
            self.block(block, env, body);
        }
    }

    fn assert(&mut self, cond: &Expr, message: &Name, env: &Env) {
        if self.condition(cond, env) != Some(false) {
            return;
        }
        let mut diagnostic = Diagnostic::error("E0601", cond.span, message.text.to_string());
        for (name, value) in self.values_in(cond, env) {
            diagnostic = diagnostic.help(format!("{name} = {}", value.show()));
        }
        self.tell(diagnostic);
    }

    /// The values of the operands of a condition, as they are written.
    fn values_in(&mut self, cond: &Expr, env: &Env) -> Vec<(String, Value)> {
        let mut out = vec![];
        let ExprNode::Chain { first, rest } = &cond.node else { return out };
        let logical = rest.iter().any(|(op, ..)| matches!(op, Op::And | Op::Or));
        for operand in std::iter::once(&**first).chain(rest.iter().map(|(_, _, e)| e)) {
            if logical {
                out.extend(self.values_in(operand, env));
            } else if !matches!(operand.node, ExprNode::Number(..) | ExprNode::Text(_)) {
                let text = self.written(operand.span).to_owned();
                out.push((text, self.eval(operand, env)));
            }
        }
        out
    }

    fn call_stmt(&mut self, call: &Expr, env: &Env, body: &mut Body) {
        let ExprNode::Call { callee, args } = &call.node else { return };
        let function = self.eval(callee, env);
        if let Value::Function(function) = &function
            && let crate::syntax::FnBody::Template(block) = &function.def.body
        {
            self.emits(call.span, body, &function.def.name.text);
            let Some(inner) = self.bind(function, args, call.span, env) else {
                self.unseen.block = true;
                return;
            };
            self.within(call.span, |evaluator| {
                evaluator.block(block, &inner, &mut Body::new(Place::File));
            });
            return;
        }
        let value = self.apply(&function, args, call.span, env);
        match value {
            Value::Object(_) if body.place != Place::Object => self.emit(&value, call.span),
            Value::Poison => {
                (self.damaged, body.broken) = (true, true);
                self.unseen.block = true;
            }
            Value::Transform(_) if body.place != Place::File => {
                self.unused(call.span, body, ("transform", "transform"));
            }
            Value::Look(_) if body.place != Place::File => {
                self.unused(call.span, body, ("look", "view"));
            }
            _ => {
                let message = "this call gives a value that nothing uses";
                self.tell(
                    Diagnostic::warning("E0114", call.span, message)
                        .help("only functions with a `{ … }` body emit something"),
                );
            }
        }
    }

    /// A value that stands alone in an object, and the parameter that it is surely meant for.
    fn unused(&mut self, span: Span, body: &mut Body, (param, what): (&str, &str)) {
        body.broken = true;
        let found = Diagnostic::error("E0114", span, format!("this {what} is given to nothing"));
        let last = body.fields.iter().rfind(|field| *field.name.text == *param);
        let Some(last) = last else {
            let start = Span { end: span.start, ..span };
            self.tell(found.guess(start, format!("{param} = ")));
            return;
        };
        let gap = Span { start: last.span.end, end: span.start, ..span };
        // Where no comma stands between the two, that has been told.
        if gap.start > gap.end || self.written(gap).contains([',', ';', '\n']) {
            self.tell(found.help("several stand in a list: `[scale(2), move((1, 0, 0) m)]`"));
        }
    }
}
