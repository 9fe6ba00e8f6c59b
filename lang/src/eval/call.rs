//! Calls of functions.

use std::rc::Rc;

use luxel_core::diag::{Diagnostic, Span, near};

use super::builtins::Given;
use super::env::Env;
use super::value::{Function, Value};
use super::{DEFINED, Evaluator};
use crate::syntax::{Arg, Expr, ExprNode, FnBody, Stmt};

impl Evaluator<'_> {
    /// A call as an expression.
    pub(super) fn call(&mut self, callee: &Expr, args: &[Arg], span: Span, env: &Env) -> Value {
        let function = self.eval(callee, env);
        let is_written_out =
            matches!(callee.node, ExprNode::Items { .. } | ExprNode::Numbers { .. });
        if is_written_out && !matches!(function, Value::Poison) {
            // A comma may be missing between two vectors.
            let end = Span { start: callee.span.end, ..callee.span };
            self.tell(uncallable(&function, span).guess(end, ","));
            return Value::Poison;
        }
        let value = self.apply(&function, args, span, env);
        if let (Value::Color(..), Value::Builtin(_), ExprNode::Path(path)) =
            (&value, &function, &callee.node)
        {
            path.last().into_iter().for_each(|name| self.note(name, &value));
        }
        value
    }

    /// Calls a value with arguments that stand in `env`.
    pub(super) fn apply(&mut self, callee: &Value, args: &[Arg], span: Span, env: &Env) -> Value {
        match callee {
            Value::Function(function) => {
                if let FnBody::Template(block) = &function.def.body
                    && block.stmts.iter().any(Stmt::is_broken)
                {
                    return Value::Poison;
                }
                let FnBody::Value(body) = &function.def.body else {
                    let name = &function.def.name.text;
                    let message = format!("`{name}` emits nodes and gives no value");
                    return self.poison("E0214", span, message);
                };
                match self.bind(function, args, span, env) {
                    Some(inner) => self.within(span, |evaluator| evaluator.eval(body, &inner)),
                    None => Value::Poison,
                }
            }
            Value::Builtin(builtin) => {
                let mut given = vec![];
                for arg in args {
                    let value = self.eval(&arg.value, env);
                    given.push(Given { name: arg.name.clone(), value, span: arg.value.span });
                }
                self.call_builtin(builtin, given, span, env)
            }
            Value::Poison => {
                for arg in args {
                    self.eval(&arg.value, env);
                }
                Value::Poison
            }
            other => {
                self.tell(uncallable(other, span));
                Value::Poison
            }
        }
    }

    /// Evaluates the body of a function that is called there.
    pub(super) fn within<T>(&mut self, call: Span, run: impl FnOnce(&mut Self) -> T) -> T {
        let outer = self.called.replace(call);
        let result = run(self);
        self.called = outer;
        result
    }

    /// The environment of a function's body; `None` after a mistake.
    pub(super) fn bind(
        &mut self,
        function: &Rc<Function>,
        args: &[Arg],
        span: Span,
        env: &Env,
    ) -> Option<Env> {
        let def = &function.def;
        let mut values: Vec<Option<Value>> = vec![None; def.params.len()];
        let mut unnamed = args.iter().filter(|arg| arg.name.is_none());
        if let Some(extra) = unnamed.nth(def.params.len()) {
            for arg in args {
                self.eval(&arg.value, env);
            }
            self.unknown_argument(function, extra, args);
            return None;
        }
        let mut positional = 0;
        for arg in args {
            let value = self.eval(&arg.value, env);
            let place = if let Some(name) = &arg.name {
                def.params.iter().position(|p| p.name.text == name.text)
            } else {
                positional += 1;
                Some(positional - 1).filter(|i| *i < def.params.len())
            };
            let Some(i) = place else {
                self.unknown_argument(function, arg, args);
                return None;
            };
            if values[i].is_some() {
                let message = format!("`{}` is given twice", def.params[i].name.text);
                self.poison("E0404", arg.value.span, message);
                return None;
            }
            values[i] = Some(self.fit(&def.params[i].ty, value, arg.value.span, env));
        }
        let inner = function.env.inner();
        for (param, value) in def.params.iter().zip(values) {
            let value = match (value, &param.default) {
                (Some(value), _) => value,
                (None, Some(default)) => {
                    let value = self.eval(default, &inner);
                    self.fit(&param.ty, value, default.span, &inner)
                }
                (None, None) => {
                    let message = format!("`{}` wants `{}`", def.name.text, param.name.text);
                    let diagnostic = Diagnostic::error("E0403", span, message);
                    self.tell(diagnostic.label(param.name.span, "declared here"));
                    return None;
                }
            };
            inner.define(&param.name.text, value);
        }
        Some(inner)
    }

    /// Tells of one of a call's arguments that the function does not take.
    fn unknown_argument(&mut self, function: &Function, arg: &Arg, args: &[Arg]) {
        let def = &function.def;
        let is_given =
            |name: &str| args.iter().flat_map(|arg| &arg.name).any(|it| &*it.text == name);
        let known = || def.params.iter().map(|p| &*p.name.text).filter(|name| !is_given(name));
        let diagnostic = if let Some(name) = &arg.name {
            let message = format!("`{}` has no parameter `{}`", def.name.text, name.text);
            Diagnostic::error("E0402", name.span, message)
                .meant(name.span, near(&name.text, known()))
        } else {
            let message = takes_only(&def.name.text, def.params.len());
            Diagnostic::error("E0402", arg.value.span, message)
        };
        self.tell(diagnostic.label(def.name.span, DEFINED));
    }
}

/// How many arguments a function takes, of which more are given.
pub(super) fn takes_only(function: &str, n: usize) -> String {
    let s = if n == 1 { "" } else { "s" };
    format!("`{function}` takes {n} argument{s}, and no more")
}

/// What is said of a value that is no function.
fn uncallable(value: &Value, span: Span) -> Diagnostic {
    Diagnostic::error("E0214", span, format!("{} cannot be called", value.describe()))
}
