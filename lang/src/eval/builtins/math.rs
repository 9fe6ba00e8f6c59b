//! Arithmetic and vectors.

use luxel_sdk::params::Dimension;

use super::{Call, Evaluator, Value};
use crate::syntax::Form;

/// Which function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Math {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sqrt,
    Abs,
    Min,
    Max,
    Clamp,
    Floor,
    Ceil,
    Round,
    Pow,
    Exp,
    Log,
    Hash01,
    Len,
    Length,
    Normalize,
    Dot,
    Cross,
}

impl Evaluator<'_> {
    /// Calls a function of numbers; what is not finite is told (E0209).
    pub(super) fn math(&mut self, math: Math, call: &mut Call<'_>) -> Value {
        let result = match math {
            Math::Sin | Math::Cos | Math::Tan => self.trigonometry(math, call),
            Math::Asin | Math::Acos | Math::Atan => self.inverse(math, call),
            Math::Exp | Math::Log | Math::Floor | Math::Ceil | Math::Round => {
                self.plain(math, call)
            }
            Math::Abs | Math::Sqrt => self.one(math, call),
            Math::Pow => {
                let (base, exponent) = (call.arg(0), call.arg(1));
                let values = base.zip(exponent);
                values
                    .map(|(a, b)| self.binary(crate::syntax::Op::Pow, a.value, b.value, call.span))
            }
            Math::Atan2 | Math::Min | Math::Max | Math::Clamp => self.alike(math, call),
            Math::Hash01 => self.hash01(call),
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

    fn trigonometry(&mut self, math: Math, call: &Call<'_>) -> Option<Value> {
        let x = self.number_arg(call, 0, Dimension::ANGLE)?;
        Some(Value::plain(match math {
            Math::Sin => x.sin(),
            Math::Cos => x.cos(),
            _ => x.tan(),
        }))
    }

    fn inverse(&mut self, math: Math, call: &Call<'_>) -> Option<Value> {
        let x = self.number_arg(call, 0, Dimension::NONE)?;
        let angle = match math {
            Math::Asin => x.asin(),
            Math::Acos => x.acos(),
            _ => x.atan(),
        };
        Some(Value::Number(angle, Dimension::ANGLE))
    }

    fn plain(&mut self, math: Math, call: &Call<'_>) -> Option<Value> {
        let x = self.number_arg(call, 0, Dimension::NONE)?;
        Some(Value::plain(match math {
            Math::Exp => x.exp(),
            Math::Log => x.ln(),
            Math::Floor => x.floor(),
            Math::Ceil => x.ceil(),
            _ => x.round(),
        }))
    }

    /// A number of any dimension.
    fn any(&mut self, call: &Call<'_>, i: usize) -> Option<(f64, Dimension)> {
        let arg = call.arg(i)?;
        match arg.value {
            Value::Number(x, dimension) => Some((x, dimension)),
            other => {
                let message = format!("`{}` wants a number, not {}", call.name, other.describe());
                self.poison("E0214", arg.span, message);
                None
            }
        }
    }

    fn one(&mut self, math: Math, call: &Call<'_>) -> Option<Value> {
        let (x, dimension) = self.any(call, 0)?;
        if math == Math::Abs {
            return Some(Value::Number(x.abs(), dimension));
        }
        if let Some(root) = dimension.sqrt() {
            Some(Value::Number(x.sqrt(), root))
        } else {
            let message = format!("{} has no square root", dimension.name());
            Some(self.poison("E0205", call.span, message))
        }
    }

    /// Functions whose arguments have one dimension.
    fn alike(&mut self, math: Math, call: &Call<'_>) -> Option<Value> {
        let (a, dimension) = self.any(call, 0)?;
        let (b, found) = self.any(call, 1)?;
        let (c, third) = if math == Math::Clamp { self.any(call, 2)? } else { (0.0, dimension) };
        for other in [found, third] {
            if other != dimension {
                let (x, y) = (dimension.name(), other.name());
                let message = format!("`{}` is given {x} and {y}", call.name);
                return Some(self.poison("E0203", call.span, message));
            }
        }
        Some(match math {
            Math::Atan2 => Value::Number(a.atan2(b), Dimension::ANGLE),
            Math::Min => Value::Number(a.min(b), dimension),
            Math::Max => Value::Number(a.max(b), dimension),
            _ => Value::Number(a.max(b).min(c), dimension),
        })
    }

    /// Noise in [0, 1) that depends on two numbers alone.
    fn hash01(&mut self, call: &Call<'_>) -> Option<Value> {
        let [seed, i] = [0, 1].map(|i| self.number_arg(call, i, Dimension::NONE));
        let (seed, i) = (seed?, i?);
        // −0 and 0 are one number.
        let bits = mix(mix((seed + 0.0).to_bits()) ^ (i + 0.0).to_bits());
        // The upper 53 bits, which a double holds exactly.
        Some(Value::plain((bits >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)))
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

/// A bijection of 64 bits that leaves no pattern: the finaliser of `SplitMix64` (Steele et al. 2014).
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}
