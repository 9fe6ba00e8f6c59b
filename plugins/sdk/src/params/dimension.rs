//! What a number measures, checked while a scene is read.

use std::fmt;
use std::ops::{Div, Mul};

/// Exponents of the seven base units: metre, kilogram, second, kelvin, candela, radian, steradian.
///
/// Angle and solid angle are counted, unlike in the SI, because scene authors confuse radiance with
/// irradiance and degrees with numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Dimension(pub [i8; 7]);

impl Dimension {
    /// A plain number.
    pub const NONE: Self = Self([0; 7]);
    /// Metre.
    pub const LENGTH: Self = Self([1, 0, 0, 0, 0, 0, 0]);
    /// Kilogram.
    pub const MASS: Self = Self([0, 1, 0, 0, 0, 0, 0]);
    /// Second.
    pub const TIME: Self = Self([0, 0, 1, 0, 0, 0, 0]);
    /// Kelvin.
    pub const TEMPERATURE: Self = Self([0, 0, 0, 1, 0, 0, 0]);
    /// Candela.
    pub const LUMINOUS: Self = Self([0, 0, 0, 0, 1, 0, 0]);
    /// Radian.
    pub const ANGLE: Self = Self([0, 0, 0, 0, 0, 1, 0]);
    /// Steradian.
    pub const SOLID_ANGLE: Self = Self([0, 0, 0, 0, 0, 0, 1]);
    /// Radian per second.
    pub const ANGULAR_SPEED: Self = Self([0, 0, -1, 0, 0, 1, 0]);
    /// Watt.
    pub const POWER: Self = Self([2, 1, -3, 0, 0, 0, 0]);
    /// Joule.
    pub const ENERGY: Self = Self([2, 1, -2, 0, 0, 0, 0]);

    /// Raised to a whole power; `None` when an exponent leaves the range of `i8`.
    pub fn powi(self, n: i8) -> Option<Self> {
        let mut out = [0; 7];
        for (o, e) in out.iter_mut().zip(self.0) {
            *o = e.checked_mul(n)?;
        }
        Some(Self(out))
    }

    /// Square root; `None` when an exponent is odd.
    pub fn sqrt(self) -> Option<Self> {
        self.0.iter().all(|e| e % 2 == 0).then(|| Self(self.0.map(|e| e / 2)))
    }

    /// Whether this is a plain number.
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// The word a person would use, or the base units: `length`, `angle`, `m^2/s`.
    pub fn name(self) -> String {
        const WORDS: [(Dimension, &str); 16] = [
            (Dimension::NONE, "a plain number"),
            (Dimension::LENGTH, "a length"),
            (Dimension::TIME, "a time"),
            (Dimension::TEMPERATURE, "a temperature"),
            (Dimension::ANGLE, "an angle"),
            (Dimension::SOLID_ANGLE, "a solid angle"),
            (Dimension::POWER, "a power"),
            (Dimension::MASS, "a mass"),
            (Dimension::ENERGY, "an energy"),
            (Dimension([2, 0, 0, 0, 0, 0, 0]), "an area"),
            (Dimension([3, 0, 0, 0, 0, 0, 0]), "a volume"),
            (Dimension::LUMINOUS, "a luminous intensity, as in cd"),
            (Dimension([0, 0, 0, 0, 1, 0, 1]), "a luminous flux, as in lm"),
            (Dimension([-2, 0, 0, 0, 1, 0, 1]), "an illuminance, as in lx"),
            (Dimension([-2, 0, 0, 0, 1, 0, 0]), "a luminance, as in nit"),
            (Dimension::ANGULAR_SPEED, "an angular speed, as `90 deg/s`"),
        ];
        match WORDS.iter().find(|(dimension, _)| *dimension == self) {
            Some((_, word)) => (*word).to_owned(),
            None => self.to_string(),
        }
    }
}

impl Mul for Dimension {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_add(other.0[i])))
    }
}

impl Div for Dimension {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_sub(other.0[i])))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const NAMES: [&str; 8] = ["W", "m", "kg", "s", "K", "cd", "rad", "sr"];
        let [m, kg, s, rest @ ..] = self.0;
        // Power, and what is made of it, by its own unit.
        let (w, m, kg, s) =
            if (kg, s) == (1, -3) { (1, m.saturating_sub(2), 0, 0) } else { (0, m, kg, s) };
        let [k, cd, rad, sr] = rest;
        let powers = [w, m, kg, s, k, cd, rad, sr];
        let named = || NAMES.into_iter().zip(powers);
        let mut first = true;
        for (name, power) in named().filter(|(_, power)| *power > 0) {
            let sep = if first { "" } else { "*" };
            write!(f, "{sep}{name}")?;
            if power > 1 {
                write!(f, "^{power}")?;
            }
            first = false;
        }
        for (name, power) in named().filter(|(_, power)| *power < 0) {
            match (first, power) {
                (true, power) => write!(f, "{name}^{power}")?,
                (false, -1) => write!(f, "/{name}")?,
                (false, power) => write!(f, "/{name}^{}", power.unsigned_abs())?,
            }
            first = false;
        }
        if first { write!(f, "1") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Unit;

    #[test]
    fn a_dimension_is_written_as_a_unit_of_it() {
        let written = ["W/m^2/sr", "W/m^2", "W/sr", "m/s", "m^2", "s^-1", "kg/m^3", "cd/m^2"];
        for text in written {
            let dimension = Unit::parse(text).unwrap().dimension;
            assert_eq!(dimension.to_string(), text);
            assert_eq!(Unit::parse(&dimension.to_string()).unwrap().dimension, dimension);
        }
        assert_eq!(Dimension::NONE.to_string(), "1");
    }
}
