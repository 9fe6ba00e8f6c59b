//! Numbers that measure something, and what operators make of them.

use luxel_sdk::params::{Dimension, Unit};

use crate::syntax::Op;

/// A number in SI units with what it measures.
pub(super) type Measured = (f64, Dimension);

/// Why two numbers are not joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unjoined {
    /// They measure different things.
    Dimensions,
    /// The second is zero.
    Zero,
    /// The second has a unit, or is no whole number up to 9 where the first has one.
    Exponent,
    /// What comes of it is not finite.
    Infinite,
    /// The operator makes no number of two.
    Operator,
}

/// A number that is written with this unit.
pub(super) fn measured(x: f64, unit: Option<&Unit>) -> Measured {
    let unit = unit.copied().unwrap_or(Unit::ONE);
    (x * unit.scale, unit.dimension)
}

/// What is to be multiplied with a number of dimension `found` to be one of the wanted dimension, where bare
/// ones count in these units; `None` if it is no such number.
pub(super) fn scale(
    found: Dimension,
    wanted: Dimension,
    units: &dyn Fn(Dimension) -> Option<f64>,
) -> Option<f64> {
    if found == wanted { Some(1.0) } else { units(wanted).filter(|_| found.is_none()) }
}

/// The number that an operator makes of two.
pub(super) fn joined(op: Op, (x, dx): Measured, (y, dy): Measured) -> Result<Measured, Unjoined> {
    if matches!(op, Op::Add | Op::Sub | Op::Rem) && dx != dy {
        return Err(Unjoined::Dimensions);
    }
    let (value, dimension) = match op {
        Op::Add => (x + y, dx),
        Op::Sub => (x - y, dx),
        Op::Mul => (x * y, dx * dy),
        Op::Div | Op::Rem if y.abs() <= 0.0 => return Err(Unjoined::Zero),
        Op::Div => (x / y, dx / dy),
        Op::Rem => (x.rem_euclid(y), dx),
        Op::Pow => (x.powf(y), power_dimension(dx, y, dy).ok_or(Unjoined::Exponent)?),
        _ => return Err(Unjoined::Operator),
    };
    if value.is_finite() { Ok((value, dimension)) } else { Err(Unjoined::Infinite) }
}

fn power_dimension(base: Dimension, exponent: f64, of_exponent: Dimension) -> Option<Dimension> {
    if !of_exponent.is_none() {
        return None;
    }
    if base.is_none() {
        return Some(base);
    }
    let whole = exponent.fract().abs() <= 0.0 && exponent.abs() <= 9.0;
    #[expect(clippy::cast_possible_truncation, reason = "a whole number up to 9")]
    whole.then(|| base.powi(exponent as i8)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operators_make_numbers_of_what_they_join() {
        let (none, length, time) = (Dimension::NONE, Dimension::LENGTH, Dimension::TIME);
        for (op, a, b, wanted) in [
            (Op::Add, (1.0, length), (2.0, length), Ok((3.0, length))),
            (Op::Sub, (1.0, length), (2.0, none), Err(Unjoined::Dimensions)),
            (Op::Mul, (3.0, length), (2.0, length), Ok((6.0, length * length))),
            (Op::Div, (3.0, length), (2.0, time), Ok((1.5, length / time))),
            (Op::Div, (3.0, length), (-0.0, time), Err(Unjoined::Zero)),
            (Op::Rem, (-1.0, length), (3.0, length), Ok((2.0, length))),
            (Op::Rem, (1.0, length), (3.0, time), Err(Unjoined::Dimensions)),
            (Op::Rem, (1.0, length), (0.0, length), Err(Unjoined::Zero)),
            (Op::Pow, (3.0, length), (2.0, none), Ok((9.0, length * length))),
            (Op::Pow, (3.0, length), (0.5, none), Err(Unjoined::Exponent)),
            (Op::Pow, (3.0, none), (2.0, length), Err(Unjoined::Exponent)),
            (Op::Pow, (-1.0, none), (0.5, none), Err(Unjoined::Infinite)),
            (Op::Mul, (1e200, none), (1e200, none), Err(Unjoined::Infinite)),
            (Op::Lt, (1.0, none), (2.0, none), Err(Unjoined::Operator)),
        ] {
            assert_eq!(joined(op, a, b), wanted, "{op:?} {a:?} {b:?}");
        }
    }
}
