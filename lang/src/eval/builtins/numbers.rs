//! Functions of numbers.

use arrayvec::ArrayVec;
use luxel_sdk::params::Dimension;

use super::{Call, Evaluator, Value};
use crate::eval::arithmetic::{Measured, scale};

/// Arguments that one takes, at most.
const MOST: usize = 3;

/// A function that makes a number of numbers, and of nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OfNumbers {
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
    Exp,
    Log,
    Hash01,
}

/// Why no number is made of some.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unmade {
    /// What this measures has no square root.
    Root(Dimension),
    /// They measure different things.
    Unlike(Dimension, Dimension),
}

impl OfNumbers {
    /// What its arguments measure; `None` of any.
    fn wants(self) -> Option<Dimension> {
        use OfNumbers::{Abs, Atan2, Clamp, Cos, Max, Min, Sin, Sqrt, Tan};
        match self {
            Sin | Cos | Tan => Some(Dimension::ANGLE),
            Abs | Atan2 | Clamp | Max | Min | Sqrt => None,
            _ => Some(Dimension::NONE),
        }
    }

    /// The number that it makes of as many as it takes, which measure what it wants; it may not be finite.
    fn made(self, args: &[Measured]) -> Result<Measured, Unmade> {
        let [(a, measure), (b, second), (c, third)] =
            std::array::from_fn(|i| args.get(i).copied().unwrap_or((0.0, args[0].1)));
        // All that it takes measure the same.
        if let Some(other) = [second, third].into_iter().find(|other| *other != measure) {
            return Err(Unmade::Unlike(measure, other));
        }
        let plain = |x: f64| (x, Dimension::NONE);
        let angle = |x: f64| (x, Dimension::ANGLE);
        Ok(match self {
            Self::Sin => plain(a.sin()),
            Self::Cos => plain(a.cos()),
            Self::Tan => plain(a.tan()),
            Self::Asin => angle(a.asin()),
            Self::Acos => angle(a.acos()),
            Self::Atan => angle(a.atan()),
            Self::Atan2 => angle(a.atan2(b)),
            Self::Sqrt => (a.sqrt(), measure.sqrt().ok_or(Unmade::Root(measure))?),
            Self::Abs => (a.abs(), measure),
            Self::Min => (a.min(b), measure),
            Self::Max => (a.max(b), measure),
            Self::Clamp => (a.max(b).min(c), measure),
            Self::Floor => plain(a.floor()),
            Self::Ceil => plain(a.ceil()),
            Self::Round => plain(a.round()),
            Self::Exp => plain(a.exp()),
            Self::Log => plain(a.ln()),
            Self::Hash01 => plain(hash01(a, b)),
        })
    }

    /// The number that it makes of others, which become what it wants, where bare ones count in these units;
    /// `None` where that is a mistake.
    pub(crate) fn of(
        self,
        args: &mut [Measured],
        units: &dyn Fn(Dimension) -> Option<f64>,
    ) -> Option<Measured> {
        if let Some(wanted) = self.wants() {
            for (x, found) in &mut *args {
                *x *= scale(*found, wanted, units)?;
                *found = wanted;
            }
        }
        self.made(args).ok().filter(|(x, _)| x.is_finite())
    }
}

/// Noise in [0, 1) that depends on two numbers alone.
fn hash01(seed: f64, i: f64) -> f64 {
    // −0 and 0 are one number.
    let bits = mix(mix((seed + 0.0).to_bits()) ^ (i + 0.0).to_bits());
    // The upper 53 bits, which a double holds exactly.
    (bits >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// A bijection of 64 bits that leaves no pattern: the finaliser of `SplitMix64` (Steele et al. 2014).
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

impl Evaluator<'_> {
    /// Calls a function of numbers; what is not finite is told (E0209).
    pub(super) fn of_numbers(&mut self, function: OfNumbers, call: &Call<'_>) -> Value {
        let mut args = ArrayVec::<Measured, MOST>::new();
        for i in 0..call.args.len() {
            let arg = match function.wants() {
                Some(wanted) => self.number_arg(call, i, wanted).map(|x| (x, wanted)),
                None => self.any_number(call, i),
            };
            args.extend(arg);
        }
        if args.len() < call.args.len() {
            return Value::Poison;
        }
        match function.made(&args) {
            Ok((x, measure)) => self.finite(x, measure, call.span),
            Err(Unmade::Root(measure)) => {
                let message = format!("{} has no square root", measure.name());
                self.poison("E0205", call.span, message)
            }
            Err(Unmade::Unlike(one, other)) => {
                let message =
                    format!("`{}` is given {} and {}", call.name, one.name(), other.name());
                self.poison("E0203", call.span, message)
            }
        }
    }

    /// A number that measures anything.
    fn any_number(&mut self, call: &Call<'_>, i: usize) -> Option<Measured> {
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_numbers_count_in_units_and_mistakes_make_nothing() {
        let (none, length, angle) = (Dimension::NONE, Dimension::LENGTH, Dimension::ANGLE);
        let units = |dimension: Dimension| (dimension == angle).then_some(0.5);
        let of = |function: OfNumbers, args: &[Measured]| function.of(&mut args.to_vec(), &units);
        assert_eq!(of(OfNumbers::Cos, &[(0.0, none)]), Some((1.0, none)));
        assert_eq!(of(OfNumbers::Sin, &[(3.0, none)]), Some((1.5_f64.sin(), none)));
        assert_eq!(of(OfNumbers::Sin, &[(3.0, length)]), None);
        assert_eq!(of(OfNumbers::Max, &[(3.0, length), (4.0, length)]), Some((4.0, length)));
        assert_eq!(of(OfNumbers::Max, &[(3.0, length), (4.0, none)]), None);
        assert_eq!(of(OfNumbers::Clamp, &[(3.0, none), (4.0, none), (5.0, angle)]), None);
        assert_eq!(of(OfNumbers::Sqrt, &[(4.0, length * length)]), Some((2.0, length)));
        assert_eq!(of(OfNumbers::Sqrt, &[(4.0, length)]), None);
        assert_eq!(of(OfNumbers::Log, &[(0.0, none)]), None);
        assert_eq!(of(OfNumbers::Exp, &[(3.0, length)]), None);
    }
}
