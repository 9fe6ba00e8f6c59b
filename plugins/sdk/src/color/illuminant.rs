//! Light sources by name or temperature: CIE illuminants, daylight, the blackbody.

use super::data::daylight::DAYLIGHT;
use super::data::illuminants as table;
use super::name::same_name;
use super::{BAND_NM, Curve, Outside};

/// First radiation constant for radiance, 2hc², W·m²·sr⁻¹ (CODATA 2018, exact).
const C1_L: f64 = 2.0 * 6.626_070_15e-34 * 299_792_458.0 * 299_792_458.0;
/// Second radiation constant, hc/k, nm·K (CODATA 2018, exact).
const C2_NM: f64 = 6.626_070_15e-34 * 299_792_458.0 / 1.380_649e-23 * 1e9;

/// Tabulated illuminants: name, wavelength of the first entry in nm, entries at 5 nm.
static TABLES: [(&str, f64, &[f32]); 14] = [
    ("C", 360.0, &table::C),
    ("D50", 360.0, &table::D50),
    ("D55", 360.0, &table::D55),
    ("D65", 360.0, &table::D65),
    ("D75", 360.0, &table::D75),
    ("FL1", 380.0, &table::FL1),
    ("FL2", 380.0, &table::FL2),
    ("FL7", 380.0, &table::FL7),
    ("FL11", 380.0, &table::FL11),
    ("FL12", 380.0, &table::FL12),
    ("LED-B1", 380.0, &table::LED_B1),
    ("LED-B3", 380.0, &table::LED_B3),
    ("LED-B5", 380.0, &table::LED_B5),
    ("LED-RGB1", 380.0, &table::LED_RGB1),
];

/// The names [`illuminant`] knows, as the CIE writes them.
pub fn illuminant_names() -> impl Iterator<Item = &'static str> {
    ["A", "E"].into_iter().chain(TABLES.iter().map(|t| t.0))
}

/// Whether there is an illuminant of that name, without making its spectrum.
pub fn is_illuminant(name: &str) -> bool {
    illuminant_names().any(|known| same_name(name, known))
}

/// The CIE illuminant of that name, scaled to Y = 1, or `None`; case and separators do not matter.
///
/// Tabulated ones end at 780 nm and are zero beyond.
///
/// # Source
/// CIE 15:2018; A by its formula.
pub fn illuminant(name: &str) -> Option<Curve> {
    if same_name(name, "E") {
        return Some(Curve::constant(1.0));
    }
    if same_name(name, "A") {
        // Planck's law at 2848 K with c₂ = 1.435·10⁷ nm·K, as the definition has it.
        let a = |nm: f64| (560.0 / nm).powi(5) / (1.435e7 / (2848.0 * nm)).exp_m1();
        return Some(of_unit_y(a));
    }
    let (_, start, entries) = TABLES.iter().find(|t| same_name(name, t.0))?;
    let points: Vec<_> =
        entries.iter().enumerate().map(|(i, &v)| (start + 5.0 * i as f64, f64::from(v))).collect();
    let curve = Curve::from_table(&points, Outside::Zero);
    let scale = curve.y().recip();
    Some(curve.map(|_, v| v * scale))
}

/// Daylight of a correlated colour temperature (K), scaled to Y = 1; `None` outside [4000, 25000].
///
/// The D illuminants of the CIE lie at 1.4388/1.438 of their nominal temperature: D65 at 6504 K.
///
/// # Source
/// CIE 15:2018 §3.1, components S0, S1, S2.
pub fn daylight(cct: f64) -> Option<Curve> {
    if !(4000.0..=25000.0).contains(&cct) {
        return None;
    }
    let r = 1e3 / cct;
    let x = if cct <= 7000.0 {
        ((-4.6070 * r + 2.9678) * r + 0.09911) * r + 0.244063
    } else {
        ((-2.0064 * r + 1.9018) * r + 0.24748) * r + 0.237040
    };
    let y = (-3.0 * x + 2.870) * x - 0.275;
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    let m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
    let points: Vec<_> = DAYLIGHT
        .iter()
        .enumerate()
        .map(|(i, s)| {
            let [s0, s1, s2] = s.map(f64::from);
            (360.0 + 5.0 * i as f64, s0 + m1 * s1 + m2 * s2)
        })
        .collect();
    let curve = Curve::from_table(&points, Outside::Zero);
    let scale = curve.y().recip();
    Some(curve.map(|_, v| v * scale))
}

/// Spectral radiance of a blackbody at `nm` and `kelvin`, both positive, in W·m⁻²·sr⁻¹·nm⁻¹.
///
/// Underflows to zero where the exponent does; never NaN for positive finite arguments that keep
/// hc/λkT finite.
///
/// # Source
/// Planck's law; PBR4 §4.4.1. `exp_m1` keeps the Rayleigh–Jeans end exact.
pub fn planck(nm: f64, kelvin: f64) -> f64 {
    let m = nm * 1e-9;
    C1_L / m.powi(5) / (C2_NM / nm / kelvin).exp_m1() * 1e-9
}

/// Whether a blackbody of that temperature, in kelvin, has a spectrum: 1 ≤ `kelvin` < ∞.
pub fn is_blackbody(kelvin: f64) -> bool {
    (1.0..f64::INFINITY).contains(&kelvin)
}

/// The blackbody's spectrum at `kelvin`, scaled to Y = 1; `None` unless 1 ≤ `kelvin` < ∞.
///
/// Works in logarithms, so that a body too cold to be seen still has its true shape.
pub fn blackbody(kelvin: f64) -> Option<Curve> {
    if !is_blackbody(kelvin) {
        return None;
    }
    // ln B less a constant; ln(eˣ − 1) = x + ln(1 − e⁻ˣ).
    let ln_b = |nm: f64| {
        let x = C2_NM / nm / kelvin;
        -5.0 * nm.ln() - x - (-(-x).exp_m1()).ln()
    };
    let largest = (360..=830).map(|nm| ln_b(f64::from(nm))).fold(f64::NEG_INFINITY, f64::max);
    Some(of_unit_y(|nm| (ln_b(nm) - largest).exp()))
}

/// A blackbody's radiance in the film's convention, spectral radiance times 470 nm, W·m⁻²·sr⁻¹;
/// `None` unless 1 ≤ `kelvin` ≤ 10⁹.
pub fn blackbody_radiance(kelvin: f64) -> Option<Curve> {
    (1.0..=1e9)
        .contains(&kelvin)
        .then(|| Curve::from_fn(|nm| planck(nm, kelvin) * f64::from(BAND_NM)))
}

/// Radiance of a blackbody over all wavelengths, σT⁴/π, W·m⁻²·sr⁻¹.
#[cfg(test)]
fn total_radiance(kelvin: f64) -> f64 {
    5.670_374_419e-8 * kelvin.powi(4) / std::f64::consts::PI
}

/// `f`, a function of nm with a largest value near 1, scaled to Y = 1.
fn of_unit_y(f: impl Fn(f64) -> f64) -> Curve {
    let y = Curve::from_fn(&f).y();
    Curve::from_fn(|nm| f(nm) / y)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::color::{K_CD, Observer, luminance_cd_m2, xyz_to_xy};

    fn xy(curve: &Curve) -> DVec2 {
        xyz_to_xy(curve.to_xyz(Observer::Cie1931))
    }

    fn check_xy(curve: &Curve, expected: (f64, f64), abs: f64) {
        let got = xy(curve);
        let off = (got - DVec2::from(expected)).abs().max_element();
        assert!(off < abs, "{got} instead of {expected:?}");
    }

    #[test]
    fn every_name_gives_a_finite_light_of_unit_y() {
        for name in illuminant_names() {
            let c = illuminant(name).unwrap();
            // The scaled samples are rounded to f32.
            assert!((c.y() - 1.0).abs() < f64::from(f32::EPSILON), "{name}: {}", c.y());
            assert!(c.min() >= 0.0 && c.max().is_finite(), "{name}");
        }
        assert_eq!(illuminant("led_b1"), illuminant("LED-B1"));
        assert_eq!(illuminant("D64"), None);
        assert_eq!(illuminant(""), None);
    }

    #[test]
    fn d65_has_its_published_white() {
        // Truth colour.D65_white, abs 3e-4.
        let xyz = illuminant("D65").unwrap().to_xyz(Observer::Cie1931);
        for (got, expected) in xyz.to_array().into_iter().zip([0.9504707649, 1.0, 1.0888284224]) {
            assert!((got - expected).abs() < 3e-4, "{xyz}");
        }
    }

    #[test]
    fn a_has_its_published_chromaticity() {
        // Truth colour.illuminant_A, abs 5e-5.
        let a = illuminant("A").unwrap();
        check_xy(&a, (0.44757354857161313, 0.40743939269060886), 5e-5);
    }

    #[test]
    fn blackbody_chromaticities_match_the_locus() {
        // Truth colour.blackbody_xy, abs 2e-4.
        for (kelvin, expected) in [
            (2042.0, (0.5221281961604605, 0.4139359199197973)),
            (2856.0, (0.44753514422783025, 0.4074282897043499)),
            (5000.0, (0.3451011744720346, 0.3516080420867534)),
            (6500.0, (0.31352588036670903, 0.3236283046370668)),
            (10000.0, (0.28063357207812717, 0.288287840668302)),
        ] {
            check_xy(&blackbody(kelvin).unwrap(), expected, 2e-4);
            check_xy(&blackbody_radiance(kelvin).unwrap(), expected, 2e-4);
        }
    }

    #[test]
    fn the_blackbody_is_finite_at_any_temperature() {
        for kelvin in [1.0, 30.0, 300.0, 1e6, 1e30, f64::MAX] {
            let c = blackbody(kelvin).unwrap();
            assert!(c.max().is_finite() && c.min() >= 0.0, "{kelvin} K");
            assert!((c.y() - 1.0).abs() < 1e-6, "{kelvin} K: {}", c.y());
        }
        for kelvin in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(blackbody(kelvin), None);
            assert_eq!(blackbody_radiance(kelvin), None);
            assert_eq!(daylight(kelvin), None);
        }
    }

    #[test]
    fn the_blackbody_has_its_luminous_efficacy_and_luminance() {
        // Truths photometry.blackbody_efficacy, rel 1e-3, and photometry.platinum, rel 1e-2.
        for (kelvin, efficacy) in [(2856.0, 16.446279810252257), (6500.0, 95.36314478970914)] {
            let lumens = luminance_cd_m2(blackbody_radiance(kelvin).unwrap().y());
            let got = lumens / total_radiance(kelvin);
            assert!((got / efficacy - 1.0).abs() < 1e-3, "{kelvin} K: {got} of {K_CD}");
        }
        let platinum = luminance_cd_m2(blackbody_radiance(2041.4).unwrap().y()) * 1e-4;
        assert!((platinum / 59.64562172879829 - 1.0).abs() < 1e-2, "{platinum} cd/cm²");
    }

    #[test]
    fn daylight_at_6504_kelvin_is_d65() {
        // CIE rounds m1 and m2 to three decimals and the tables to six digits; the tail past 780 nm,
        // cut from the table, weighs 1e-5.
        let d65 = xy(&illuminant("D65").unwrap());
        check_xy(&daylight(6504.0).unwrap(), d65.into(), 1e-4);
        assert!(daylight(4000.0).unwrap().min() >= 0.0);
        assert!(daylight(25000.0).unwrap().min() >= 0.0);
    }
}
