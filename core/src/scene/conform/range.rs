//! Numbers and ranges in words.

use luxel_sdk::params::Param;

/// Magnitudes outside of this are written with an exponent.
const PLAIN: std::ops::Range<f64> = 1e-5..1e10;

/// A number as a person writes it: `0.25`, `1e-9`, never hundreds of digits.
pub fn number_words(x: f64) -> String {
    if x.abs() <= 0.0 || PLAIN.contains(&x.abs()) || !x.is_finite() {
        return x.to_string();
    }
    format!("{x:e}")
}

/// A number of a parameter, in SI units, as people say it: an angle in degrees, to ten digits.
pub fn said(param: &Param, x: f64) -> String {
    if !is_angle(param) || !x.is_finite() {
        return number_words(x);
    }
    let short = format!("{:.9e}", x.to_degrees());
    number_words(short.parse().unwrap_or(x))
}

/// The unit of numbers that are so said; empty without one.
pub fn said_unit(param: &Param) -> String {
    if is_angle(param) { "deg".to_owned() } else { param.unit.replace('|', " or ") }
}

fn is_angle(param: &Param) -> bool {
    matches!(param.unit, "rad" | "deg")
}

/// The range that a parameter takes, without its unit (`said_unit`): `from 0 to 1`, `at least 0`,
/// `more than 0`; `None` if anything goes.
///
/// The least positive number, denormal or not, as a minimum means that 0 itself is excluded.
pub fn range_words(param: &Param) -> Option<String> {
    let Param { min, max, .. } = *param;
    let excludes_0 = min > 0.0 && min <= f64::MIN_POSITIVE;
    let least = if excludes_0 { "more than 0".to_owned() } else { said(param, min) };
    let most = said(param, max);
    match (min.is_finite(), max.is_finite()) {
        (true, true) if excludes_0 => Some(format!("{least}, at most {most}")),
        (true, true) => Some(format!("from {least} to {most}")),
        (true, false) if excludes_0 => Some(least),
        (true, false) => Some(format!("at least {least}")),
        (false, true) => Some(format!("at most {most}")),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_said_in_degrees() {
        let param = crate::registry::common_params(luxel_sdk::kind::Kind::Shape)[0];
        let angle = Param { unit: "rad", min: 0.0, max: std::f64::consts::PI, ..param };
        assert_eq!(range_words(&angle).unwrap(), "from 0 to 180");
        assert_eq!(said_unit(&angle), "deg");
        assert_eq!(said(&angle, 0.533_f64.to_radians()), "0.533");
        assert_eq!(said(&angle, f64::INFINITY), "inf");
        let rate = Param { unit: "1/m|rad/s", ..param };
        assert_eq!(said_unit(&rate), "1/m or rad/s");
        assert_eq!(said(&rate, 0.1), "0.1");
    }

    #[test]
    fn numbers_are_short_and_read_back_the_same() {
        for (x, words) in [
            (0.0, "0"),
            (-0.036, "-0.036"),
            (1e-9, "1e-9"),
            (f64::MIN_POSITIVE, "2.2250738585072014e-308"),
            (4_294_967_295.0, "4294967295"),
            (-5e160, "-5e160"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number_words(x), words);
            assert_eq!(words.parse::<f64>().unwrap().to_bits(), x.to_bits());
        }
    }

    #[test]
    fn the_least_positive_number_as_a_minimum_excludes_zero() {
        let param = crate::registry::common_params(luxel_sdk::kind::Kind::Shape)[0];
        let words = |min, max| range_words(&Param { min, max, ..param });
        let (none, tiny) = (f64::INFINITY, f64::MIN_POSITIVE);
        assert_eq!(words(tiny, none).unwrap(), "more than 0");
        assert_eq!(words(tiny, 2.0).unwrap(), "more than 0, at most 2");
        assert_eq!(words(0.0, none).unwrap(), "at least 0");
        assert_eq!(words(1e-9, 1.0).unwrap(), "from 1e-9 to 1");
        assert_eq!(words(-none, 3.0).unwrap(), "at most 3");
        assert_eq!(words(-none, none), None);
    }
}
