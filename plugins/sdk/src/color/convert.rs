//! Measured curves to linear sRGB, for RGB mode.

use std::sync::LazyLock;

use glam::{DVec3, Vec3};

use super::illuminant::illuminant;
use super::observer::{MatchingTable, Observer};
use super::{Curve, RgbSpace};

/// What RGB mode derives once: constants of the program.
struct Tables {
    /// XYZ to linear sRGB.
    from_xyz: glam::DMat3,
    /// D65 at Y = 1.
    d65: Curve,
    /// Linear sRGB of D65, near (1, 1, 1): the table's white differs from (.3127, .3290) by 3e-5.
    d65_rgb: DVec3,
    /// For each channel, the part of its matching function that is positive, under D65, of sum 1.
    channels: [Box<[f64; 471]>; 3],
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    let from_xyz = RgbSpace::LinearSrgb.from_xyz();
    let d65 = illuminant("D65").expect("D65 is in the catalogue");
    let d65_rgb = from_xyz * d65.to_xyz(Observer::Cie1931);
    let cmf: &MatchingTable = Observer::Cie1931.table();
    let channels = [0, 1, 2].map(|c| {
        let row = from_xyz.row(c);
        let weight = |i: usize| {
            let bar = DVec3::from_array(cmf[i].map(f64::from));
            row.dot(bar).max(0.0) * f64::from(d65.samples()[i])
        };
        let sum: f64 = (0..471).map(weight).sum();
        Box::new(std::array::from_fn(|i| weight(i) / sum))
    });
    Tables { from_xyz, d65, d65_rgb, channels }
});

/// The linear sRGB colour of a reflectance under D65: (v, v, v) for the constant v.
///
/// A colour outside the gamut is moved towards the grey of its luminance until it has no negative
/// channel and, where that grey is at most 1, none above 1; its luminance stays.
pub fn reflectance_rgb(curve: &Curve) -> Vec3 {
    let t = &*TABLES;
    let rgb = t.from_xyz * curve.times(&t.d65).to_xyz(Observer::Cie1931) / t.d65_rgb;
    let grey = luminance(rgb);
    let rgb = towards_grey(rgb, grey);
    let largest = rgb.max_element();
    let rgb = if largest > 1.0 && grey < 1.0 {
        grey + (rgb - grey) * ((1.0 - grey) / (largest - grey))
    } else {
        rgb
    };
    rgb.as_vec3()
}

/// The linear sRGB colour of an emission in the film's convention: its Y stays exactly.
///
/// A colour outside the gamut is moved towards the grey of its luminance until it has no negative
/// channel. A curve of negative Y gives its grey.
pub fn emission_rgb(curve: &Curve) -> Vec3 {
    let rgb = TABLES.from_xyz * curve.to_xyz(Observer::Cie1931);
    towards_grey(rgb, luminance(rgb)).as_vec3()
}

/// A weighted mean of the curve for each of red, green and blue, with weights that are never
/// negative: for eta, k, and other quantities that are no colours. Stays between the curve's
/// smallest and largest value.
pub fn ior_rgb(curve: &Curve) -> Vec3 {
    let mean = |weights: &[f64; 471]| {
        curve.samples().iter().zip(weights).map(|(&v, w)| f64::from(v) * w).sum::<f64>()
    };
    let [r, g, b] = &TABLES.channels;
    DVec3::new(mean(r), mean(g), mean(b)).as_vec3()
}

/// Luminance of linear sRGB.
fn luminance(rgb: DVec3) -> f64 {
    RgbSpace::LinearSrgb.luminance_weights().dot(rgb)
}

/// `rgb` desaturated at constant luminance until no channel is negative.
fn towards_grey(rgb: DVec3, grey: f64) -> DVec3 {
    let smallest = rgb.min_element();
    if smallest >= 0.0 {
        rgb
    } else if grey <= 0.0 {
        DVec3::splat(grey)
    } else {
        (grey + (rgb - grey) * (grey / (grey - smallest))).max(DVec3::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{Outside, blackbody, metal};

    #[test]
    fn grey_reflectances_and_constant_indices_stay_grey() {
        for v in [0.0_f32, 0.18, 1.0] {
            let c = Curve::constant(v);
            // D65 samples are rounded to f32 once, alike in both integrals; v·D65 once more.
            assert!((reflectance_rgb(&c) - v).abs().max_element() <= 2.0 * f32::EPSILON * v);
            assert!((ior_rgb(&c) - v).abs().max_element() <= 2.0 * f32::EPSILON * v);
        }
    }

    #[test]
    fn d65_emission_is_white() {
        // The table's white is (.31272, .32903), the space's (.3127, .3290): 3e-5 · 6 at most.
        let rgb = emission_rgb(&illuminant("D65").unwrap());
        assert!((rgb - 1.0).abs().max_element() < 3e-4, "{rgb}");
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "compared in f32")]
    fn colours_outside_the_gamut_keep_their_luminance() {
        let weights = RgbSpace::LinearSrgb.luminance_weights().as_vec3();
        let line = [(519.0, 0.0), (520.0, 1.0), (521.0, 0.0)];
        for c in [blackbody(1000.0).unwrap(), Curve::from_points(&line, Outside::Zero).unwrap()] {
            let rgb = emission_rgb(&c);
            let y = c.y() as f32;
            assert!(rgb.min_element() >= 0.0, "{rgb}");
            assert!((weights.dot(rgb) / y - 1.0).abs() < 8.0 * f32::EPSILON, "{rgb}");
        }
        let step = [(580.0, 0.0), (581.0, 1.0)];
        let rgb = reflectance_rgb(&Curve::from_points(&step, Outside::Constant).unwrap());
        assert!(rgb.min_element() >= 0.0 && rgb.max_element() <= 1.0 + f32::EPSILON, "{rgb}");
    }

    #[test]
    fn gold_is_yellow() {
        let gold = metal("gold").unwrap();
        let (eta, k) = (ior_rgb(&gold.eta), ior_rgb(&gold.k));
        assert!(eta.x < eta.y && eta.y < eta.z && k.x > k.y && k.y > k.z, "{eta} {k}");
    }
}
