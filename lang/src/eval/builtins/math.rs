//! Powers, vectors and lists.

use luxel_sdk::params::Dimension;

use super::{Call, Evaluator, Value};
use crate::syntax::Form;

/// Which function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Math {
    Pow,
    Len,
    Length,
    Normalize,
    Dot,
    Cross,
}

impl Evaluator<'_> {
    /// Calls a function of vectors or lists, or takes a power; what is not finite is told (E0209).
    pub(super) fn math(&mut self, math: Math, call: &mut Call<'_>) -> Value {
        let result = match math {
            Math::Pow => {
                let (base, exponent) = (call.arg(0), call.arg(1));
                let values = base.zip(exponent);
                values
                    .map(|(a, b)| self.binary(crate::syntax::Op::Pow, a.value, b.value, call.span))
            }
            Math::Len => self.len(call),
            Math::Length | Math::Normalize => self.vector(math, call),
            Math::Dot | Math::Cross => self.product(math, call),
        };
        match result {
            Some(Value::Number(x, dimension)) => self.finite(x, dimension, call.span),
            Some(value) => value,
            None => Value::Poison,
        }
    }

    fn len(&mut self, call: &Call<'_>) -> Option<Value> {
        let arg = call.arg(0)?;
        let count = match &arg.value {
            Value::Numbers(n) => n.data.len(),
            Value::Items(items) => items.items.len(),
            other => {
                let message = format!("`len` wants a list, not {}", other.describe());
                return Some(self.poison("E0214", arg.span, message));
            }
        };
        Some(Value::plain(count as f64))
    }

    fn vector(&mut self, math: Math, call: &Call<'_>) -> Option<Value> {
        let (v, dimension, span) = self.vector_arg(call, 0)?;
        let length = v[0].hypot(v[1]).hypot(v[2]);
        if math == Math::Length {
            return Some(Value::Number(length, dimension));
        }
        if length <= 0.0 || !length.is_finite() {
            return Some(self.poison("E0209", span, "this vector has no direction"));
        }
        Some(Value::numbers(v.map(|x| x / length), Dimension::NONE, Form::Tuple))
    }

    fn product(&mut self, math: Math, call: &Call<'_>) -> Option<Value> {
        let [a, b] = [0, 1].map(|i| self.vector_arg(call, i));
        let ((a, da, _), (b, db, _)) = (a?, b?);
        let (a, b) = (glam::DVec3::from_array(a), glam::DVec3::from_array(b));
        let dimension = da * db;
        if math == Math::Dot {
            return Some(Value::Number(a.dot(b), dimension));
        }
        let cross = a.cross(b);
        if !cross.is_finite() {
            return Some(self.poison("E0209", call.span, "the result is not finite"));
        }
        Some(Value::numbers(cross.to_array(), dimension, Form::Tuple))
    }
}
