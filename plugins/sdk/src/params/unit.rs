//! Units by name: one table for the language, the schemas and the messages.

use super::Dimension;

/// A unit: what it measures and how many SI units it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// What it measures.
    pub dimension: Dimension,
    /// `value · scale` is in SI units.
    pub scale: f64,
}

const fn unit(exponents: [i8; 7], scale: f64) -> Unit {
    Unit { dimension: Dimension(exponents), scale }
}

const LENGTH: [i8; 7] = Dimension::LENGTH.0;
const TIME: [i8; 7] = Dimension::TIME.0;
const POWER: [i8; 7] = Dimension::POWER.0;
const LUX: [i8; 7] = [-2, 0, 0, 0, 1, 0, 1];
const LUMEN: [i8; 7] = [0, 0, 0, 0, 1, 0, 1];

/// Every named unit. `lm` is cd·sr and `lx` is lm/m²; `EV` is a plain number of stops.
pub const UNITS: &[(&str, Unit)] = &[
    ("m", unit(LENGTH, 1.0)),
    ("km", unit(LENGTH, 1e3)),
    ("cm", unit(LENGTH, 1e-2)),
    ("mm", unit(LENGTH, 1e-3)),
    ("um", unit(LENGTH, 1e-6)),
    ("µm", unit(LENGTH, 1e-6)),
    ("nm", unit(LENGTH, 1e-9)),
    ("inch", unit(LENGTH, 0.0254)),
    ("ft", unit(LENGTH, 0.3048)),
    ("s", unit(TIME, 1.0)),
    ("ms", unit(TIME, 1e-3)),
    ("us", unit(TIME, 1e-6)),
    ("Hz", unit([0, 0, -1, 0, 0, 0, 0], 1.0)),
    ("kg", unit(Dimension::MASS.0, 1.0)),
    ("g", unit(Dimension::MASS.0, 1e-3)),
    ("K", unit(Dimension::TEMPERATURE.0, 1.0)),
    ("rad", unit(Dimension::ANGLE.0, 1.0)),
    ("deg", unit(Dimension::ANGLE.0, std::f64::consts::PI / 180.0)),
    ("sr", unit(Dimension::SOLID_ANGLE.0, 1.0)),
    ("W", unit(POWER, 1.0)),
    ("kW", unit(POWER, 1e3)),
    ("mW", unit(POWER, 1e-3)),
    ("J", unit(Dimension::ENERGY.0, 1.0)),
    ("cd", unit(Dimension::LUMINOUS.0, 1.0)),
    ("kcd", unit(Dimension::LUMINOUS.0, 1e3)),
    ("lm", unit(LUMEN, 1.0)),
    ("klm", unit(LUMEN, 1e3)),
    ("lx", unit(LUX, 1.0)),
    ("klx", unit(LUX, 1e3)),
    ("nit", unit([-2, 0, 0, 0, 1, 0, 0], 1.0)),
    ("EV", unit([0; 7], 1.0)),
];

impl Unit {
    /// A plain number.
    pub const ONE: Self = unit([0; 7], 1.0);

    /// The unit of one name, without powers or quotients.
    pub fn named(name: &str) -> Option<Self> {
        UNITS.iter().find(|(known, _)| *known == name).map(|(_, unit)| *unit)
    }

    /// Reads `W/m^2/sr`: names with whole powers, joined by `*` and `/` from left to right.
    ///
    /// # Errors
    /// The part that is not a unit.
    pub fn parse(text: &str) -> Result<Self, String> {
        // Most are a name alone, and are looked up for each number that is given.
        if let Some(unit) = Self::named(text) {
            return Ok(unit);
        }
        let mut out = Self::ONE;
        let mut rest = text;
        let mut divide = false;
        loop {
            let end = rest.find(['*', '/']).unwrap_or(rest.len());
            let factor = Self::parse_factor(rest[..end].trim())?;
            out = if divide { out.per(factor) } else { out.times(factor) };
            if end == rest.len() {
                return Ok(out);
            }
            divide = rest.as_bytes()[end] == b'/';
            rest = &rest[end + 1..];
        }
    }

    fn parse_factor(text: &str) -> Result<Self, String> {
        if text == "1" {
            return Ok(Self::ONE);
        }
        let (name, power) = match text.split_once('^') {
            Some((name, power)) => (name, power.parse().map_err(|_| text.to_owned())?),
            None => (text, 1),
        };
        let unit = Self::named(name).ok_or_else(|| name.to_owned())?;
        let dimension = unit.dimension.powi(power).ok_or_else(|| text.to_owned())?;
        Ok(Self { dimension, scale: unit.scale.powi(i32::from(power)) })
    }

    fn times(self, other: Self) -> Self {
        Self { dimension: self.dimension * other.dimension, scale: self.scale * other.scale }
    }

    fn per(self, other: Self) -> Self {
        Self { dimension: self.dimension / other.dimension, scale: self.scale / other.scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compound_units_multiply_out() {
        let radiance = Unit::parse("W/m^2/sr").unwrap();
        assert_eq!(radiance.dimension, Dimension([0, 1, -3, 0, 0, 0, -1]));
        let per_mm = Unit::parse("1/mm").unwrap();
        assert!((per_mm.scale - 1e3).abs() < 1e-12);
        assert_eq!(Unit::parse("meters"), Err("meters".to_owned()));
        let lux = Unit::parse("lm/m^2").unwrap();
        assert_eq!(lux.dimension, Unit::named("lx").unwrap().dimension);
    }
}
