//! Operators, with checked dimensions.

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::Dimension;

use super::Evaluator;
use super::arithmetic::{Measured, Unjoined, joined};
use super::env::Env;
use super::expr::LARGE;
use super::value::{Range, Value};
use crate::syntax::{Expr, Form, Op};

impl Evaluator<'_> {
    /// Operands of one precedence, from left to right; powers from right to left.
    pub(super) fn chain(&mut self, first: &Expr, rest: &[(Op, Span, Expr)], env: &Env) -> Value {
        if rest.first().is_some_and(|(op, ..)| *op == Op::Pow) {
            return self.powers(first, rest, env);
        }
        let mut value = self.eval(first, env);
        for (op, _, operand) in rest {
            let decided = match (op, &value) {
                (Op::And, Value::Bool(false)) => Some(Value::Bool(false)),
                (Op::Or, Value::Bool(true)) => Some(Value::Bool(true)),
                _ => None,
            };
            value = if let Some(decided) = decided {
                decided
            } else {
                let right = self.eval(operand, env);
                self.binary(*op, value, right, first.span.to(operand.span))
            };
        }
        value
    }

    fn powers(&mut self, first: &Expr, rest: &[(Op, Span, Expr)], env: &Env) -> Value {
        let mut values = vec![self.eval(first, env)];
        values.extend(rest.iter().map(|(_, _, operand)| self.eval(operand, env)));
        let end = rest.last().map_or(first.span, |(_, _, last)| last.span);
        let span = first.span.to(end);
        let mut exponent = values.pop().unwrap_or(Value::Poison);
        while let Some(base) = values.pop() {
            exponent = self.binary(Op::Pow, base, exponent, span);
        }
        exponent
    }

    /// `-x` and `!x`.
    pub(super) fn unary(&mut self, op: Op, value: Value, span: Span) -> Value {
        match (op, value) {
            (_, Value::Poison) => Value::Poison,
            (Op::Not, Value::Bool(value)) => Value::Bool(!value),
            (Op::Sub, Value::Number(x, dimension)) => Value::Number(-x, dimension),
            (Op::Sub, value @ (Value::Numbers(_) | Value::Items(_))) => {
                self.binary(Op::Mul, Value::plain(-1.0), value, span)
            }
            (op, value) => {
                let message = format!("`{}` does not apply to {}", op.token(), value.describe());
                self.poison("E0214", span, message)
            }
        }
    }

    /// One operator between two values.
    pub(super) fn binary(&mut self, op: Op, a: Value, b: Value, span: Span) -> Value {
        let (a, b) = (flat_vector(a), flat_vector(b));
        match (op, &a, &b) {
            (_, Value::Poison, _) | (_, _, Value::Poison) => Value::Poison,
            (Op::And, Value::Bool(a), Value::Bool(b)) => Value::Bool(*a && *b),
            (Op::Or, Value::Bool(a), Value::Bool(b)) => Value::Bool(*a || *b),
            (_, Value::Number(x, dx), Value::Number(y, dy)) => {
                self.numbers(op, (*x, *dx), (*y, *dy), span)
            }
            (Op::Eq | Op::Ne, ..) => self.equality(op, &a, &b, span),
            (Op::Mul, Value::Number(..), Value::Numbers(v)) if v.form == Form::Tuple => {
                self.vector_scaled(op, &b, &a, span)
            }
            (Op::Mul | Op::Div, Value::Numbers(v), Value::Number(..)) if v.form == Form::Tuple => {
                self.vector_scaled(op, &a, &b, span)
            }
            (Op::Add | Op::Sub, Value::Numbers(v), Value::Numbers(w))
                if v.form == Form::Tuple && w.form == Form::Tuple =>
            {
                self.vector_sum(op, &a, &b, span)
            }
            (Op::Mul, Value::Number(x, d), Value::Color(c, dc))
            | (Op::Mul, Value::Color(c, dc), Value::Number(x, d)) => {
                Value::Color(c.scaled(*x), *dc * *d)
            }
            (Op::Div, Value::Color(c, dc), Value::Number(x, d)) => {
                let factor = 1.0 / x;
                if !factor.is_finite() {
                    return self.poison("E0209", span, "division by zero");
                }
                Value::Color(c.scaled(factor), *dc / *d)
            }
            _ => self.no_operator(op, &a, &b, span),
        }
    }

    fn no_operator(&mut self, op: Op, a: &Value, b: &Value, span: Span) -> Value {
        let (a, b) = (a.describe(), b.describe());
        self.poison("E0214", span, format!("`{}` does not join {a} and {b}", op.token()))
    }

    fn equality(&mut self, op: Op, a: &Value, b: &Value, span: Span) -> Value {
        match self.equal(a, b, span, COMPARED_DEPTH) {
            Ok(equal) => Value::Bool(equal == (op == Op::Eq)),
            Err(Incomparable::Told) => Value::Poison,
            Err(Incomparable::Kinds(a, b)) => {
                let message = format!("`{}` does not compare {a} and {b}", op.token());
                let help = "numbers of one dimension, texts, `true` and `false` can be compared, and \
                            lists of these";
                self.tell(Diagnostic::error("E0214", span, message).help(help));
                Value::Poison
            }
        }
    }

    /// Whether two values are the same; lists are so item by item.
    fn equal(
        &mut self,
        a: &Value,
        b: &Value,
        span: Span,
        depth: usize,
    ) -> Result<bool, Incomparable> {
        let kinds = || Err(Incomparable::Kinds(a.describe(), b.describe()));
        match (a, b) {
            (Value::Poison, _) | (_, Value::Poison) => return Err(Incomparable::Told),
            (Value::Bool(a), Value::Bool(b)) => return Ok(a == b),
            (Value::Text(a), Value::Text(b)) => {
                let compared = if a.len() == b.len() { a.len() as u64 / TEXT_STEP } else { 0 };
                return self.tick(compared, span).then(|| a == b).ok_or(Incomparable::Told);
            }
            // A zero has two signs.
            (Value::Number(x, dx), Value::Number(y, dy)) if dx == dy => {
                return Ok(x <= y && y <= x);
            }
            _ => {}
        }
        let (Some(n), Some(m)) = (length(a), length(b)) else { return kinds() };
        if n != m {
            return Ok(false);
        }
        if depth == 0 {
            return kinds();
        }
        if !self.tick(n as u64, span) {
            return Err(Incomparable::Told);
        }
        if let (Value::Numbers(v), Value::Numbers(w)) = (a, b) {
            let names = || Incomparable::Kinds(v.dimension.name(), w.dimension.name());
            return (v.dimension == w.dimension).then(|| v.data == w.data).ok_or_else(names);
        }
        let mut all = true;
        for i in 0..n {
            all &= self.equal(&item(a, i), &item(b, i), span, depth - 1)?;
        }
        Ok(all)
    }

    fn numbers(&mut self, op: Op, a: Measured, b: Measured, span: Span) -> Value {
        let ((x, dx), (y, dy)) = (a, b);
        let is_alike = !matches!(op, Op::Mul | Op::Div | Op::Pow | Op::And | Op::Or);
        if is_alike && dx != dy {
            return self.mismatch(op, dx, dy, span);
        }
        match op {
            Op::Range | Op::RangeTo => {
                let inclusive = op == Op::RangeTo;
                return Value::Range(Range { start: x, end: y, inclusive, dimension: dx });
            }
            Op::Lt => return Value::Bool(x < y),
            Op::Le => return Value::Bool(x <= y),
            Op::Gt => return Value::Bool(x > y),
            Op::Ge => return Value::Bool(x >= y),
            Op::Eq => return Value::Bool(x.total_cmp(&y).is_eq() || (x <= y && y <= x)),
            Op::Ne => return Value::Bool(x < y || y < x),
            _ => {}
        }
        match joined(op, a, b) {
            Ok((x, dimension)) => Value::Number(x, dimension),
            Err(Unjoined::Dimensions) => self.mismatch(op, dx, dy, span),
            Err(Unjoined::Zero) => self.poison("E0209", span, "division by zero"),
            Err(Unjoined::Exponent) => {
                let message = "an exponent is a plain number, whole where the base has a unit";
                let found = Diagnostic::error("E0203", span, message);
                let found = self.with_base(found, span);
                self.tell(found);
                Value::Poison
            }
            Err(Unjoined::Infinite) => self.infinite(span),
            Err(Unjoined::Operator) => {
                self.no_operator(op, &Value::Number(x, dx), &Value::Number(y, dy), span)
            }
        }
    }

    /// A number, or a told mistake where it is none.
    pub(super) fn finite(&mut self, x: f64, dimension: Dimension, span: Span) -> Value {
        if x.is_finite() {
            return Value::Number(x, dimension);
        }
        self.infinite(span)
    }

    fn infinite(&mut self, span: Span) -> Value {
        self.poison("E0209", span, "the result is not a finite number")
    }

    fn mismatch(&mut self, op: Op, a: Dimension, b: Dimension, span: Span) -> Value {
        let message = format!("`{}` joins {} and {}", op.token(), a.name(), b.name());
        let mut diagnostic = Diagnostic::error("E0203", span, message);
        if a.is_none() || b.is_none() {
            diagnostic = diagnostic.help("give the bare number a unit");
        }
        self.tell(diagnostic);
        Value::Poison
    }

    fn vector_scaled(&mut self, op: Op, vector: &Value, by: &Value, span: Span) -> Value {
        let (Value::Numbers(v), Value::Number(x, d)) = (vector, by) else { return Value::Poison };
        if !self.copies(v.data.len(), span) {
            return Value::Poison;
        }
        let divide = op == Op::Div;
        let dimension = if divide { v.dimension / *d } else { v.dimension * *d };
        let data: Vec<f64> = v.data.iter().map(|y| if divide { y / x } else { y * x }).collect();
        self.finite_vector(data, dimension, span)
    }

    fn vector_sum(&mut self, op: Op, a: &Value, b: &Value, span: Span) -> Value {
        let (Value::Numbers(v), Value::Numbers(w)) = (a, b) else { return Value::Poison };
        if v.data.len() != w.data.len() {
            return self.poison("E0207", span, "vectors of different lengths");
        }
        if v.dimension != w.dimension {
            return self.mismatch(op, v.dimension, w.dimension, span);
        }
        if !self.copies(v.data.len(), span) {
            return Value::Poison;
        }
        let sum = |(x, y): (&f64, &f64)| if op == Op::Add { x + y } else { x - y };
        let data: Vec<f64> = v.data.iter().zip(w.data.iter()).map(sum).collect();
        self.finite_vector(data, v.dimension, span)
    }

    /// Counts numbers that are made of others; a few of them take no memory worth counting.
    fn copies(&mut self, n: usize, span: Span) -> bool {
        let bytes = if n < LARGE { 0 } else { n * size_of::<f64>() };
        self.tick(n as u64, span) && self.hold(bytes, span)
    }

    fn finite_vector(&mut self, data: Vec<f64>, dimension: Dimension, span: Span) -> Value {
        if data.iter().all(|x| x.is_finite()) {
            return Value::numbers(data, dimension, Form::Tuple);
        }
        self.poison("E0209", span, "the result is not finite")
    }
}

/// Bytes of a text that are compared in a step.
const TEXT_STEP: u64 = 64;

/// How deep lists are compared.
const COMPARED_DEPTH: usize = 64;

/// Why two values are neither the same nor different.
enum Incomparable {
    /// A mistake that was told: in an item, or the budget is spent.
    Told,
    /// What the two are.
    Kinds(String, String),
}

/// The number of items of a list or vector.
fn length(value: &Value) -> Option<usize> {
    match value {
        Value::Numbers(n) => Some(n.data.len()),
        Value::Items(i) => Some(i.items.len()),
        _ => None,
    }
}

/// An item of a list or vector; the index is in range.
fn item(value: &Value, i: usize) -> Value {
    match value {
        Value::Numbers(n) => Value::Number(n.data[i], n.dimension),
        Value::Items(items) => items.items[i].clone(),
        _ => Value::Poison,
    }
}

/// A vector in which bare zeros stand beside numbers of one dimension, made one of that dimension.
fn flat_vector(value: Value) -> Value {
    let Value::Items(items) = &value else { return value };
    if items.form != Form::Tuple {
        return value;
    }
    match with_zeros(&items.items) {
        Some((data, dimension)) => Value::numbers(data, dimension, Form::Tuple),
        None => value,
    }
}

/// Numbers of one dimension among which bare zeros may stand.
pub(super) fn with_zeros(items: &[Value]) -> Option<(Vec<f64>, Dimension)> {
    let dimension = items.iter().find_map(|item| match item {
        Value::Number(_, d) if !d.is_none() => Some(*d),
        _ => None,
    })?;
    let number = |item: &Value| match item {
        Value::Number(x, d) if *d == dimension || (d.is_none() && x.abs() <= 0.0) => Some(*x),
        _ => None,
    };
    Some((items.iter().map(number).collect::<Option<_>>()?, dimension))
}
