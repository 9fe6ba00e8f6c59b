//! Expressions.

use std::rc::Rc;

use luxel_core::diag::{Diagnostic, Span, near};
use luxel_sdk::params::{Dimension, Unit};

use super::arithmetic::measured;
use super::builtins;
use super::env::Env;
use super::value::{FieldValue, Mixed, Range, Value};
use super::{BARE, Evaluator};
use crate::syntax::{Comp, Expr, ExprNode, Field, Form, Name};

impl Evaluator<'_> {
    /// The value of an expression; poison where there was a mistake.
    pub(super) fn eval(&mut self, expr: &Expr, env: &Env) -> Value {
        if !self.tick(1, expr.span) {
            return Value::Poison;
        }
        // Leaves need no room on the stack.
        match &expr.node {
            ExprNode::Number(x, unit) => {
                let (x, dimension) = measured(*x, unit.as_deref());
                return Value::Number(x, dimension);
            }
            ExprNode::Text(text) => return Value::Text(text.clone()),
            ExprNode::Bool(value) => return Value::Bool(*value),
            ExprNode::Path(path) => return self.path(path, env),
            ExprNode::Broken => return Value::Poison,
            _ => {}
        }
        let value = if self.enter(expr.span) { self.eval_inner(expr, env) } else { Value::Poison };
        self.leave();
        value
    }

    fn eval_inner(&mut self, expr: &Expr, env: &Env) -> Value {
        match &expr.node {
            ExprNode::Numbers { data, unit, form } => {
                let unit = unit.as_deref().copied().unwrap_or(Unit::ONE);
                if unit == Unit::ONE {
                    return Value::numbers(data.clone(), Dimension::NONE, *form);
                }
                self.tick(data.len() as u64 / 16, expr.span);
                let data: Vec<f64> = data.iter().map(|x| x * unit.scale).collect();
                Value::numbers(data, unit.dimension, *form)
            }
            ExprNode::Items { items, unit, form } => {
                let made = self.items(items, unit.as_deref(), *form, env);
                self.shallow(made, expr.span)
            }
            ExprNode::Paren { inner, unit } => {
                let value = self.eval(inner, env);
                self.with_unit(value, unit.as_deref(), inner.span)
            }
            ExprNode::Chain { first, rest } => self.chain(first, rest, env),
            ExprNode::Unary { op, inner } => {
                let value = self.eval(inner, env);
                self.unary(*op, value, expr.span)
            }
            ExprNode::Call { callee, args } => self.call(callee, args, expr.span, env),
            ExprNode::Index { of, at } => self.index(of, at, env),
            ExprNode::Member { of, name } => {
                let value = self.eval(of, env);
                self.member(&value, name)
            }
            ExprNode::Record(fields) => {
                let fields = self.fields(fields, env);
                self.shallow(Value::record(fields), expr.span)
            }
            ExprNode::Comp(comp) => self.comp(comp, expr.span, env),
            ExprNode::If { arms, otherwise } => {
                for (cond, value) in arms {
                    match self.condition(cond, env) {
                        Some(true) => return self.eval(value, env),
                        Some(false) => {}
                        None => return Value::Poison,
                    }
                }
                self.eval(otherwise, env)
            }
            ExprNode::Object(object) => self.object(object, env, None),
            ExprNode::With { of, fields } => {
                let value = self.eval(of, env);
                let fields = self.fields(fields, env);
                self.amend(value, fields, of.span)
            }
            _ => Value::Poison,
        }
    }

    /// The values of `name = value` pairs.
    pub(super) fn fields(&mut self, fields: &[Field], env: &Env) -> Vec<FieldValue> {
        self.given_twice(fields.iter().map(|field| &field.name));
        fields.iter().map(|field| self.field(field, env)).collect()
    }

    /// The value of one pair.
    pub(super) fn field(&mut self, field: &Field, env: &Env) -> FieldValue {
        let value = self.eval(&field.value, env);
        self.note(&field.name, &value);
        let span = field.value.span;
        FieldValue { name: field.name.clone(), value, span, file: env.file.clone() }
    }

    /// Whether a condition holds; `None` after a mistake.
    pub(super) fn condition(&mut self, cond: &Expr, env: &Env) -> Option<bool> {
        match self.eval(cond, env) {
            Value::Bool(value) => Some(value),
            Value::Poison => None,
            other => {
                let message = format!("a condition is true or false, not {}", other.describe());
                self.poison("E0214", cond.span, message);
                None
            }
        }
    }

    fn path(&mut self, path: &[Name], env: &Env) -> Value {
        let Some(first) = path.first() else { return Value::Poison };
        if let Some(mut value) = env.get(&first.text) {
            for name in &path[1..] {
                value = self.member(&value, name);
            }
            return value;
        }
        let words: Vec<&str> = path.iter().map(|name| &*name.text).collect();
        // A name that is nowhere was told when names were resolved.
        builtins::value(&words.join(".")).unwrap_or_else(|| {
            self.unknown.insert(first.span);
            Value::Poison
        })
    }

    fn member(&mut self, of: &Value, name: &Name) -> Value {
        let (found, known): (Option<Value>, Vec<&str>) = match of {
            Value::Poison => return Value::Poison,
            Value::Module(module) => (
                module.names.get(&name.text).cloned(),
                module.names.keys().map(|name| &**name).collect(),
            ),
            Value::Record(record) => (
                record
                    .fields
                    .iter()
                    .rev()
                    .find(|f| f.name.text == name.text)
                    .map(|f| f.value.clone()),
                record.fields.iter().map(|f| &*f.name.text).collect(),
            ),
            Value::Object(object) => (
                object.fields.iter().find(|f| f.name.text == name.text).map(|f| f.value.clone()),
                object.fields.iter().map(|f| &*f.name.text).collect(),
            ),
            Value::Numbers(n) if n.form == Form::Tuple => {
                let index = ["x", "y", "z", "w"].iter().position(|axis| **axis == *name.text);
                let x = index.and_then(|i| n.data.get(i));
                (x.map(|x| Value::Number(*x, n.dimension)), vec!["x", "y", "z"])
            }
            other => {
                let message = format!("{} has no `.{}`", other.describe(), name.text);
                let found = Diagnostic::error("E0101", name.span, message);
                let is_list = matches!(other, Value::Numbers(_) | Value::Items(_));
                let counts = ["length", "len", "size", "count"].contains(&&*name.text);
                let help = "how many a list holds is `len(list)`";
                self.tell(if is_list && counts { found.help(help) } else { found });
                return Value::Poison;
            }
        };
        if let Some(value) = found {
            self.note(name, &value);
            return value;
        }
        let what = match of {
            Value::Module(module) => format!("`{}`", module.path),
            other => other.describe(),
        };
        let message = format!("there is no `{}` in {what}", name.text);
        let diagnostic = Diagnostic::error("E0101", name.span, message)
            .meant(name.span, near(&name.text, known));
        self.tell(diagnostic);
        Value::Poison
    }

    fn items(&mut self, items: &[Expr], unit: Option<&Unit>, form: Form, env: &Env) -> Value {
        let mut values = Vec::with_capacity(items.len());
        for item in items {
            let value = self.eval(item, env);
            values.push(self.with_unit(value, unit, item.span));
        }
        // Lists of lists double with every function that makes one; other small ones are as many as
        // the text has, or are soon dropped.
        let is_list = |value: &Value| matches!(value, Value::Numbers(_) | Value::Items(_));
        if items.len() >= LARGE || values.iter().any(is_list) {
            let bytes = values.len() * size_of::<Value>() + 64;
            if !self.hold(bytes, items[0].span) {
                return Value::Poison;
            }
        }
        if values.iter().any(Value::is_poison) {
            return Value::Poison;
        }
        Value::list(values, form)
    }

    /// A value times the unit that stands after its brackets: it must be a bare number.
    fn with_unit(&mut self, value: Value, unit: Option<&Unit>, span: Span) -> Value {
        let Some(unit) = unit else { return value };
        match value {
            Value::Number(x, Dimension::NONE) => Value::Number(x * unit.scale, unit.dimension),
            Value::Numbers(n) if n.dimension.is_none() => {
                let data: Vec<f64> = n.data.iter().map(|x| x * unit.scale).collect();
                Value::numbers(data, unit.dimension, n.form)
            }
            Value::Poison => Value::Poison,
            other => {
                let message = format!("{BARE}, not {}", other.describe());
                self.poison("E0203", span, message)
            }
        }
    }

    fn index(&mut self, of: &Expr, at: &Expr, env: &Env) -> Value {
        let (list, place) = (self.eval(of, env), self.eval(at, env));
        let x = match place {
            Value::Number(x, Dimension::NONE) => x,
            Value::Poison => return Value::Poison,
            other => {
                let message = format!("an index is a whole number, not {}", other.describe());
                return self.poison("E0214", at.span, message);
            }
        };
        let length = match &list {
            Value::Numbers(n) => n.data.len(),
            Value::Items(i) => i.items.len(),
            Value::Poison => return Value::Poison,
            other => {
                let message =
                    format!("only lists and vectors have elements, not {}", other.describe());
                return self.poison("E0214", of.span, message);
            }
        };
        if x.fract().abs() > 0.0 {
            return self.poison("E0208", at.span, format!("an index is a whole number, not {x}"));
        }
        if x < 0.0 || x >= length as f64 {
            let message =
                format!("index {x} of a list of {length}: the last is {}", length as f64 - 1.0);
            let mut found = Diagnostic::error("E0216", at.span, message);
            let from_start = x + length as f64;
            if x < 0.0 && from_start >= 0.0 {
                let help = "elements are counted from 0 at the start of a list";
                found = found.help(help).guess(at.span, from_start.to_string());
            }
            self.tell(found);
            return Value::Poison;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 ≤ x < length"
        )]
        let i = x as usize;
        match &list {
            Value::Numbers(n) => Value::Number(n.data[i], n.dimension),
            Value::Items(items) => items.items[i].clone(),
            _ => Value::Poison,
        }
    }

    fn comp(&mut self, comp: &Comp, span: Span, env: &Env) -> Value {
        let over = self.eval(&comp.over, env);
        self.note(&comp.item, &over);
        let Some(elements) = self.elements(over, comp.over.span) else { return Value::Poison };
        self.note_index(comp.index.as_ref(), &elements);
        if comp.filter.is_none() && elements.len() > self.budgets.list as f64 {
            let message = format!(
                "a list of {} elements; the limit is {}",
                elements.len(),
                self.budgets.list
            );
            return self.poison("E0503", span, message);
        }
        let mut out = vec![];
        self.loops.push(span);
        let repeats = self.repeats;
        let mut index = 0.0;
        let mut inner = env.inner();
        while let Some(element) = elements.get(index) {
            inner.renew();
            if let Some(name) = &comp.index {
                inner.define(&name.text, Value::plain(index));
            }
            inner.define(&comp.item.text, element);
            index += 1.0;
            let wanted =
                comp.filter.as_ref().is_none_or(|f| self.condition(f, &inner) == Some(true));
            if wanted {
                let value = self.eval(&comp.value, &inner);
                if !self.hold(value.bytes(), span) {
                    break;
                }
                out.push(value);
            }
            if out.len() > self.budgets.list {
                let message = format!("a list of more than {} elements", self.budgets.list);
                self.over_budget("E0503", span, message, "list");
            }
            if !self.goes_on(repeats, 1, span) {
                break;
            }
        }
        self.loops.pop();
        if self.stopped || out.iter().any(Value::is_poison) {
            return Value::Poison;
        }
        let made = out.len() * size_of::<Value>();
        let list = self.shallow(Value::list(out, Form::List), span);
        if let Value::Numbers(packed) = &list {
            let spared = made.saturating_sub(packed.data.len() * size_of::<f64>());
            self.held.set(self.held.get().saturating_sub(spared));
        }
        list
    }

    /// Keeps what the index of a loop runs through.
    pub(super) fn note_index(&mut self, index: Option<&Name>, elements: &Elements) {
        if let Some(index) = index {
            let dimension = Dimension::NONE;
            let all = Range { start: 0.0, end: elements.len(), inclusive: false, dimension };
            self.note(index, &Value::Range(all));
        }
    }

    /// Tells of a loop over a list of one range, `[0..3]`.
    fn bracketed_range(&mut self, span: Span) {
        let found = Diagnostic::error("E0214", span, "a loop runs over a range without brackets");
        let written = self.written(span);
        let bare = written.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        let bare = bare.map(|bare| bare.trim().to_owned());
        self.tell(match bare {
            Some(bare) => found.guess(span, bare),
            None => found,
        });
    }

    /// What a loop runs over; `None` after a mistake.
    pub(super) fn elements(&mut self, over: Value, span: Span) -> Option<Elements> {
        match over {
            Value::Numbers(n) => Some(Elements::Numbers(n)),
            Value::Items(items) if matches!(&items.items[..], [Value::Range(_)]) => {
                self.bracketed_range(span);
                None
            }
            Value::Items(items) => Some(Elements::Items(items)),
            Value::Range(range) if range.dimension.is_none() => {
                if range.start.fract().abs() > 0.0 || range.end.fract().abs() > 0.0 {
                    self.poison("E0208", span, "a loop runs over whole numbers");
                    return None;
                }
                let count = range.end - range.start + if range.inclusive { 1.0 } else { 0.0 };
                Some(Elements::Range(range.start, count.max(0.0)))
            }
            Value::Poison => None,
            other => {
                let what = match &other {
                    Value::Range(range) => {
                        format!("a range whose ends are each {}", range.dimension.name())
                    }
                    other => other.describe(),
                };
                let message =
                    format!("a loop runs over a list or a range of whole numbers, not {what}");
                self.poison("E0214", span, message);
                None
            }
        }
    }
}

/// Elements from which on a list is counted, whatever is in it.
pub(super) const LARGE: usize = 64;

/// What a loop runs over.
pub(super) enum Elements {
    Numbers(Rc<super::value::Numbers>),
    Items(Rc<Mixed>),
    /// First and count.
    Range(f64, f64),
}

impl Elements {
    /// How many there are.
    pub(super) fn len(&self) -> f64 {
        match self {
            Self::Numbers(n) => n.data.len() as f64,
            Self::Items(items) => items.items.len() as f64,
            Self::Range(_, count) => *count,
        }
    }

    /// One of them, by a whole number from 0.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the index counts up from 0"
    )]
    pub(super) fn get(&self, index: f64) -> Option<Value> {
        match self {
            Self::Numbers(n) => n.data.get(index as usize).map(|x| Value::Number(*x, n.dimension)),
            Self::Items(items) => items.items.get(index as usize).cloned(),
            Self::Range(first, count) => (index < *count).then(|| Value::plain(first + index)),
        }
    }
}
