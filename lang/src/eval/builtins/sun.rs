//! Where the sun stands.

use luxel_core::diag::Span;
use luxel_sdk::params::Dimension;

use super::{Call, Evaluator, Value};
use crate::syntax::Form;

impl Evaluator<'_> {
    /// `sun_position(latitude, longitude, time)`: the unit vector towards the sun; +X is east, +Y up
    /// and −Z north.
    pub(super) fn sun(&mut self, call: &mut Call<'_>) -> Value {
        self.sun_vector(call).unwrap_or(Value::Poison)
    }

    fn sun_vector(&mut self, call: &Call<'_>) -> Option<Value> {
        let [latitude, longitude] = [0, 1].map(|i| self.number_arg(call, i, Dimension::ANGLE));
        let (text, span) = self.text_arg(call, 2)?;
        let Some(days) = days_since_2000(&text) else {
            self.bad_time(&text, span);
            return None;
        };
        let direction = position(latitude?, longitude?, days);
        Some(Value::numbers(direction, Dimension::NONE, Form::Tuple))
    }

    fn bad_time(&mut self, text: &str, span: Span) {
        let message = format!("\"{text}\" is not a time, as \"2026-06-21T17:30:00Z\"");
        self.poison("E0214", span, message);
    }
}

/// Days since 2000-01-01T12:00Z of an ISO 8601 time in [1900, 2100) with its offset: `Z` or `+02:00`.
fn days_since_2000(text: &str) -> Option<f64> {
    let bytes = text.as_bytes();
    let digits = |range: std::ops::Range<usize>| -> Option<f64> {
        let part = bytes.get(range)?;
        let ok = part.iter().all(u8::is_ascii_digit);
        ok.then(|| part.iter().fold(0.0, |n, b| n * 10.0 + f64::from(b - b'0')))
    };
    let marks = [(4, b'-'), (7, b'-'), (10, b'T'), (13, b':')];
    if !marks.iter().all(|(at, mark)| bytes.get(*at) == Some(mark)) {
        return None;
    }
    let (year, month, day) = (digits(0..4)?, digits(5..7)?, digits(8..10)?);
    let (hour, minute) = (digits(11..13)?, digits(14..16)?);
    let (second, rest) = match bytes.get(16) {
        Some(b':') => (digits(17..19)?, 19),
        _ => (0.0, 16),
    };
    let offset = match (bytes.get(rest)?, bytes.len() - rest) {
        (b'Z', 1) => 0.0,
        (sign @ (b'+' | b'-'), 6) if bytes[rest + 3] == b':' => {
            let hours = digits(rest + 1..rest + 3)? + digits(rest + 4..rest + 6)? / 60.0;
            if *sign == b'+' { hours } else { -hours }
        }
        _ => return None,
    };
    let legal = (1900.0..2100.0).contains(&year)
        && (1.0..=12.0).contains(&month)
        && (1.0..=31.0).contains(&day)
        && hour < 24.0
        && minute < 60.0
        && second <= 60.0;
    // The Julian day of a date of the Gregorian calendar (Fliegel and Van Flandern 1968).
    let a = ((14.0 - month) / 12.0).floor();
    let (y, m) = (year + 4800.0 - a, month + 12.0 * a - 3.0);
    let number = day + ((153.0 * m + 2.0) / 5.0).floor() + 365.0 * y + (y / 4.0).floor()
        - (y / 100.0).floor()
        + (y / 400.0).floor()
        - 32045.0;
    let hours = hour - offset + minute / 60.0 + second / 3600.0;
    legal.then(|| number - 0.5 + hours / 24.0 - 2_451_545.0)
}

/// The unit vector towards the sun, to about 0.5 minutes of arc between 1999 and 2015 and a few
/// minutes in this century.
///
/// # Source
/// The PSA algorithm: Blanco-Muriel et al. 2001, "Computing the solar vector".
fn position(latitude: f64, longitude: f64, days: f64) -> [f64; 3] {
    // The sun among the stars.
    let node = 2.1429 - 0.0010394594 * days;
    let mean_longitude = 4.8950630 + 0.017202791698 * days;
    let anomaly = 6.2400600 + 0.0172019699 * days;
    let ecliptic = mean_longitude + 0.03341607 * anomaly.sin() + 0.00034894 * (2.0 * anomaly).sin()
        - 0.0001134
        - 0.0000203 * node.sin();
    let obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * node.cos();
    let ascension = (obliquity.cos() * ecliptic.sin()).atan2(ecliptic.cos());
    let declination = (obliquity.sin() * ecliptic.sin()).asin();
    // The turn of the earth.
    let hours = (days - 0.5).rem_euclid(1.0) * 24.0;
    let sidereal = 6.6974243242 + 0.0657098283 * days + hours;
    let angle = (sidereal * 15.0).to_radians() + longitude - ascension;
    // Seen from the place: zenith distance with parallax, azimuth from north to east.
    let zenith =
        latitude.cos() * angle.cos() * declination.cos() + declination.sin() * latitude.sin();
    let zenith = zenith.clamp(-1.0, 1.0).acos();
    let zenith = zenith + 6371.01 / 149597890.0 * zenith.sin();
    let north = declination.tan() * latitude.cos() - latitude.sin() * angle.cos();
    let azimuth = (-angle.sin()).atan2(north);
    [zenith.sin() * azimuth.sin(), zenith.cos(), -zenith.sin() * azimuth.cos()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_with_their_offset() {
        assert_eq!(days_since_2000("2000-01-01T12:00:00Z"), Some(0.0));
        assert_eq!(days_since_2000("2000-01-02T14:00+02:00"), Some(1.0));
        for wrong in ["2000-01-01", "2000-13-01T00:00Z", "2000-01-01T12:00:00", "", "noon"] {
            assert_eq!(days_since_2000(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_sun_stands_over_the_tropic_at_the_solstice() {
        // 2026-06-21, 08:24 UTC: declination 23.436°, so that it stands at the zenith of that
        // latitude where it is noon: longitude 15°·(12 − 8.4) + the equation of time, −1.8 min.
        let days = days_since_2000("2026-06-21T08:24:00Z").unwrap();
        let noon = (15.0 * (12.0 - 8.4) + 1.8 / 4.0_f64).to_radians();
        let [x, y, z] = position(23.436_f64.to_radians(), noon, days);
        // The equation of time is rounded to 0.1 min of time, 0.025°; the algorithm errs by less.
        assert!(y > 0.1_f64.to_radians().cos(), "{x} {y} {z}");
    }

    #[test]
    fn morning_is_in_the_east_and_noon_in_the_south() {
        let london = 51.5_f64.to_radians();
        let at = |time: &str| position(london, 0.0, days_since_2000(time).unwrap());
        let [x, y, _] = at("2026-03-20T07:00:00Z");
        assert!(x > 0.9 && y > 0.0);
        let [x, y, z] = at("2026-03-20T12:07:00Z");
        // At the equinox the sun culminates at the colatitude, here to within its daily motion.
        assert!(x.abs() < 0.01 && z > 0.0, "{x} {z}");
        assert!((y.asin() - (90.0_f64 - 51.5).to_radians()).abs() < 0.4_f64.to_radians());
    }
}
