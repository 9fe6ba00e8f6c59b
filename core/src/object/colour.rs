//! Colours as described into what a field needs, by role and colour mode.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use luxel_sdk::color::{
    Curve, K_CD, Observer, Outside, Spectrum, blackbody, emission_rgb, glass, illuminant, ior_rgb,
    metal, reflectance_rgb, uplift_illuminant,
};
use luxel_sdk::params::{Dimension, Quantity, Role, Unit};

use super::build::ColorMode;
use super::patch::Uplift;
use crate::cast::narrow;
use crate::scene::Color;

/// What a field of four lanes takes.
pub(super) enum Lanes {
    /// The same lanes for every path.
    Constant(Spectrum),
    /// A curve over the wavelengths.
    Curve(Curve),
    /// A colour that is uplifted.
    Rgb(Vec3, Uplift),
}

/// The white that a light has when its scene gives no spectrum: RGB (1, 1, 1), so D65.
pub fn white() -> Color {
    Color::Rgb([1.0; 3])
}

fn rgb32(rgb: [f64; 3]) -> Vec3 {
    glam::DVec3::from_array(rgb).as_vec3()
}

/// A colour as a curve; `None` for RGB. Names have been checked by the language.
fn curve_of(color: &Color, outside: Outside) -> Result<Option<Curve>, String> {
    let unknown = |what: &str, name: &Arc<str>| format!("there is no {what} `{name}`");
    Ok(Some(match color {
        Color::Rgb(_) => return Ok(None),
        Color::Constant(x) => Curve::constant(narrow(*x)),
        Color::Curve(points) => Curve::from_points(points, outside).map_err(|e| e.to_string())?,
        Color::Blackbody(t) => blackbody(*t).ok_or("a temperature is finite and at least 1 K")?,
        Color::Illuminant(name) => illuminant(name).ok_or_else(|| unknown("illuminant", name))?,
        Color::Metal(name) => metal(name).ok_or_else(|| unknown("metal", name))?.eta,
        Color::Waves(length) => Curve::from_fn(|nm| waves(*length, nm)),
        Color::Glass(name) => glass(name).ok_or_else(|| unknown("glass", name))?.curve(),
        Color::Scaled(inner, factor) => match curve_of(inner, outside)? {
            Some(curve) => curve.map(|_, x| x * factor),
            None => return Ok(None),
        },
    }))
}

/// The RGB inside a colour that is one, times its factor.
fn rgb_of(color: &Color) -> Option<[f64; 3]> {
    match color {
        Color::Rgb(rgb) => Some(*rgb),
        Color::Scaled(inner, factor) => rgb_of(inner).map(|rgb| rgb.map(|x| x * factor)),
        _ => None,
    }
}

/// Lanes of a reflectance, a coefficient or an index of refraction.
pub(super) fn lanes(color: &Color, role: Role, mode: ColorMode) -> Result<Lanes, String> {
    if let Color::Constant(x) = color {
        return Ok(Lanes::Constant(Spectrum::splat(narrow(*x))));
    }
    if let Some(rgb) = rgb_of(color) {
        let rgb = rgb32(rgb);
        let grey = rgb.min_element() >= rgb.max_element();
        return Ok(match mode {
            _ if grey => Lanes::Constant(Spectrum::splat(rgb.x)),
            ColorMode::Rgb => Lanes::Constant(Spectrum::from_rgb(rgb)),
            ColorMode::Spectral => Lanes::Rgb(rgb, Uplift::Reflectance),
        });
    }
    if let (ColorMode::Rgb, Color::Waves(length)) = (mode, color) {
        let rgb = DOMINANT.map(|nm| waves(*length, nm));
        return Ok(Lanes::Constant(Spectrum::from_rgb(rgb32(rgb))));
    }
    let curve = curve_of(color, Outside::Constant)?.expect("only RGB has no curve");
    Ok(match (mode, role) {
        (ColorMode::Spectral, _) => Lanes::Curve(curve),
        (ColorMode::Rgb, Role::Ior) => Lanes::Constant(Spectrum::splat(curve.at(587.5618))),
        (ColorMode::Rgb, Role::ComplexIor) => Lanes::Constant(Spectrum::from_rgb(ior_rgb(&curve))),
        (ColorMode::Rgb, _) => Lanes::Constant(Spectrum::from_rgb(reflectance_rgb(&curve))),
    })
}

/// Wavelengths that look like the primaries of sRGB beside its white, nm: what a channel stands for where
/// something depends on the wavelength itself.
const DOMINANT: [f64; 3] = [611.4, 549.1, 464.2];

/// How many waves of a wavelength fit into a length in metres.
fn waves(length: f64, nm: f64) -> f64 {
    length * 1e9 / nm
}

/// Extinction of a metal, where the colour names one.
pub(super) fn extinction(color: &Color, mode: ColorMode) -> Option<Lanes> {
    let Color::Metal(name) = color else { return None };
    let k = metal(name)?.k;
    Some(match mode {
        ColorMode::Spectral => Lanes::Curve(k),
        ColorMode::Rgb => Lanes::Constant(Spectrum::from_rgb(ior_rgb(&k))),
    })
}

/// An amount of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Amount {
    pub(super) quantity: Quantity,
    pub(super) value: f64,
    pub(super) dimension: Dimension,
}

impl Amount {
    /// Whether it is counted in lumens: some power of the candela.
    fn is_photometric(self) -> bool {
        self.dimension.0[4] != 0
    }

    /// The factor that turns a spectrum of the given mean over the band and luminous Y into this
    /// amount (see `luxel_sdk::color` for the lanes' unit).
    fn factor(self, mean: f64, y: f64) -> f64 {
        match self.quantity {
            Quantity::Scale => self.value,
            _ if self.is_photometric() => {
                let band = f64::from(luxel_sdk::color::BAND_NM);
                self.value / K_CD * band / Observer::Cie1931.y_integral() / y
            }
            _ => self.value / mean,
        }
    }
}

/// Mean and luminous Y of light by its RGB: each is reckoned from the whole band, and lamps are often alike.
#[derive(Debug, Default)]
pub(super) struct Brightness {
    known: HashMap<[u32; 3], [f64; 2]>,
}

impl Brightness {
    fn of(&mut self, rgb: Vec3) -> [f64; 2] {
        *self.known.entry(rgb.to_array().map(f32::to_bits)).or_insert_with(|| {
            let curve = rgb_curve(rgb);
            [curve.mean(), curve.y()]
        })
    }
}

/// Lanes of a source of light: its spectrum times the amount.
///
/// # Errors
/// A spectrum without any light, which no amount can scale.
pub(super) fn emission(
    color: &Color,
    amount: Amount,
    mode: ColorMode,
    brightness: &mut Brightness,
) -> Result<Lanes, String> {
    let finite = |factor: f64| {
        let dark = "a spectrum without light cannot be scaled to an amount";
        Some(factor).filter(|factor| factor.is_finite()).ok_or(dark)
    };
    if let Some(rgb) = rgb_of(color) {
        let [mean, y] = brightness.of(rgb32(rgb));
        let factor = finite(amount.factor(mean, y))?;
        let rgb = rgb32(rgb.map(|x| x * factor));
        return Ok(match mode {
            ColorMode::Rgb => Lanes::Constant(Spectrum::from_rgb(rgb)),
            ColorMode::Spectral => Lanes::Rgb(rgb, Uplift::Illuminant),
        });
    }
    let curve = curve_of(color, Outside::Zero)?.expect("only RGB has no curve");
    let factor = finite(amount.factor(curve.mean(), curve.y()))?;
    Ok(match mode {
        ColorMode::Spectral => Lanes::Curve(curve.map(|_, x| x * factor)),
        ColorMode::Rgb => {
            Lanes::Constant(Spectrum::from_rgb(emission_rgb(&curve) * narrow(factor)))
        }
    })
}

/// The factor on a texture's colours that gives the amount for white.
pub(super) fn texture_factor(amount: Amount, brightness: &mut Brightness) -> f32 {
    let [mean, y] = brightness.of(Vec3::ONE);
    narrow(amount.factor(mean, y))
}

/// RGB light as a curve.
fn rgb_curve(rgb: Vec3) -> Curve {
    Curve::from_fn(|nm| {
        let mut w = luxel_sdk::color::Wavelengths::sample(0.5);
        w.lambda = Spectrum::splat(narrow(nm));
        f64::from(uplift_illuminant(rgb, &w).lane(0))
    })
}

/// The dimension of a unit of the schema.
///
/// # Panics
/// If a schema's unit is not one: a mistake of the plugin's author that a test catches.
pub(super) fn dimension(unit: &str) -> Dimension {
    if unit.is_empty() {
        return Dimension::NONE;
    }
    Unit::parse(unit).expect("units in schemas exist").dimension
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lamps_are_as_bright_whatever_was_made_before_them() {
        let radiance = |value| Amount {
            quantity: Quantity::Radiance,
            value,
            dimension: dimension("W/m^2/sr"),
        };
        let rgb = |color: [f64; 3], value, brightness: &mut Brightness| {
            let lanes = emission(&Color::Rgb(color), radiance(value), ColorMode::Rgb, brightness);
            let Ok(Lanes::Constant(rgb)) = lanes else { panic!("RGB is the same for every path") };
            rgb.to_array().map(f32::to_bits)
        };
        let mut brightness = Brightness::default();
        let all = [[1.0; 3], [1.0, 0.2, 0.1], [0.1, 0.2, 1.0]];
        for (color, value) in all.into_iter().chain(all).zip([3.0, 2.0, 5.0, 7.0, 11.0, 1.0]) {
            let fresh = rgb(color, value, &mut Brightness::default());
            assert_eq!(rgb(color, value, &mut brightness), fresh, "{color:?}");
        }
        let dark = emission(&Color::Rgb([0.0; 3]), radiance(1.0), ColorMode::Rgb, &mut brightness);
        assert!(dark.is_err(), "no amount scales it");
    }

    #[test]
    fn a_length_is_told_in_waves_of_each_wavelength() {
        let film = Color::Waves(300e-9);
        let Ok(Lanes::Curve(curve)) = lanes(&film, Role::Waves, ColorMode::Spectral) else {
            panic!("it depends on the wavelength")
        };
        // Between two entries of the curve, 1 nm apart, it errs by up to a quarter of (1 nm / λ)²: 1.3e-6
        // from 449 nm on, and single precision rounds thrice. At an entry it only rounds.
        for nm in [360.0f32, 449.5, 550.0, 829.5] {
            assert!(
                (f64::from(curve.at(nm)) / (300.0 / f64::from(nm)) - 1.0).abs() < 1.5e-6,
                "{nm}"
            );
        }
        let Ok(Lanes::Constant(rgb)) = lanes(&film, Role::Waves, ColorMode::Rgb) else {
            panic!("a channel has one wavelength")
        };
        assert!(rgb.lane(0) < rgb.lane(1) && rgb.lane(1) < rgb.lane(2));
    }
}
