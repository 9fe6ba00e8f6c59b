//! Linear sRGB to spectra by the basis of Mallett and Yuksel 2019: bounded, linear, one lookup.
//!
//! "Spectral Primary Decomposition for Rendering with sRGB Reflectance", EGSR 2019. The published
//! basis was fitted at 5 nm and returns a primary 7e-4 off when integrated at 1 nm; we mix its three
//! curves by the inverse of that error, which keeps them non-negative and summing to 1.

use std::sync::LazyLock;

use glam::{DMat3, DVec3, Vec3, Vec4};

use super::curve::split;
use super::data::mallett_2019::BASIS;
use super::illuminant::illuminant;
use super::{Curve, Observer, Outside, RgbSpace, Spectrum, Wavelengths};

/// Red, green and blue curves side by side at 1 nm, and one guard row.
type Rows = [Vec4; 472];

static REFLECTANCE: LazyLock<Box<Rows>> = LazyLock::new(|| {
    let basis = [0, 1, 2].map(published);
    let unmix = seen_under_d65(&basis).inverse().transpose();
    Box::new(std::array::from_fn(|i| {
        let at = |c: usize| f64::from(basis[c].samples()[i.min(470)]);
        (unmix * DVec3::new(at(0), at(1), at(2))).as_vec3().extend(0.0)
    }))
});

static ILLUMINANT: LazyLock<Box<Rows>> = LazyLock::new(|| {
    let d65 = illuminant("D65").expect("D65 is in the catalogue");
    Box::new(std::array::from_fn(|i| REFLECTANCE[i] * d65.samples()[i.min(470)]))
});

/// The reflectance of a linear sRGB colour: r·R(λ) + g·G(λ) + b·B(λ), with R + G + B = 1.
///
/// In [0, 1] for `rgb` in [0, 1], flat for greys. Channels outside [0, 1] are not limited. Seen under
/// D65 by the 1931 observer, relative to white, the colour returns within 2e-6 of the largest channel.
/// Constant below 380 and above 780 nm.
pub fn uplift_reflectance(rgb: Vec3, w: &Wavelengths) -> Spectrum {
    combine(&REFLECTANCE, rgb, w)
}

/// The emission of a linear sRGB colour: its reflectance times D65, (1, 1, 1) having Y = 1.
///
/// White is D65 itself, which is not the white (.3127, .3290) of sRGB to the last digit: a colour
/// returns within 3e-4 of its largest channel. Zero above 780 nm.
pub fn uplift_illuminant(rgb: Vec3, w: &Wavelengths) -> Spectrum {
    combine(&ILLUMINANT, rgb, w)
}

fn combine(rows: &Rows, rgb: Vec3, w: &Wavelengths) -> Spectrum {
    let rgb = rgb.extend(0.0);
    Spectrum::from_array(w.lambda.to_array().map(|nm| {
        let (i, t) = split(nm);
        (rows[i] + (rows[i + 1] - rows[i]) * t).dot(rgb)
    }))
}

/// The reflectance and the illuminant basis (red, green, blue) at four places of the tables.
pub(super) fn basis_at(places: [(usize, f32); 4]) -> ([Spectrum; 3], [Spectrum; 3]) {
    let columns = |rows: &Rows| {
        let at = places.map(|(i, t)| rows[i] + (rows[i + 1] - rows[i]) * t);
        std::array::from_fn(|c| Spectrum::from_array(at.map(|row| row[c])))
    };
    (columns(&REFLECTANCE), columns(&ILLUMINANT))
}

/// Channel `c` of the published basis, each row scaled to sum to 1, so that white is flat.
fn published(c: usize) -> Curve {
    let row = |(i, row): (usize, &[f32; 3])| {
        let sum: f64 = row.iter().map(|&v| f64::from(v)).sum();
        (380.0 + 5.0 * i as f64, f64::from(row[c]) / sum)
    };
    let points: Vec<_> = BASIS.iter().enumerate().map(row).collect();
    Curve::from_table(&points, Outside::Constant)
}

/// The linear sRGB colours of three reflectances under D65, relative to white, as columns.
fn seen_under_d65(basis: &[Curve; 3]) -> DMat3 {
    let from_xyz = RgbSpace::LinearSrgb.from_xyz();
    let d65 = illuminant("D65").expect("D65 is in the catalogue");
    let white = from_xyz * d65.to_xyz(Observer::Cie1931);
    let [r, g, b] = [0, 1, 2].map(|c| {
        let lit = basis[c].times(&d65);
        from_xyz * lit.to_xyz(Observer::Cie1931) / white
    });
    DMat3::from_cols(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{Observer, RgbSpace, reflectance_rgb};

    const COLOURS: [Vec3; 6] = [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::ONE,
        Vec3::new(0.18, 0.18, 0.18),
        Vec3::new(0.8, 0.3, 0.05),
    ];

    #[expect(clippy::cast_possible_truncation, reason = "whole nm are exact")]
    fn curve(f: impl Fn(&Wavelengths) -> Spectrum) -> Curve {
        Curve::from_fn(|nm| {
            let lambda = Spectrum::splat(nm as f32);
            f64::from(f(&Wavelengths { lambda, pdf: Spectrum::ONE })[0])
        })
    }

    #[test]
    fn reflectances_are_bounded_and_white_is_flat() {
        for rgb in COLOURS {
            let c = curve(|w| uplift_reflectance(rgb, w));
            assert!(c.min() >= 0.0 && c.max() <= 1.0 + 2.0 * f32::EPSILON, "{rgb}");
        }
        let white = curve(|w| uplift_reflectance(Vec3::ONE, w));
        assert!(white.min() >= 1.0 - 2.0 * f32::EPSILON);
    }

    #[test]
    fn colours_return_from_their_spectra() {
        let from_xyz = RgbSpace::LinearSrgb.from_xyz();
        for rgb in COLOURS {
            // 3e-4: the table's white in sRGB, see convert.rs.
            let lit = curve(|w| uplift_illuminant(rgb, w)).to_xyz(Observer::Cie1931);
            let back = (from_xyz * lit).as_vec3();
            assert!((back - rgb).abs().max_element() < 3e-4, "{rgb} came back as {back}");
            // 2e-6: samples rounded to f32, amplified by the sRGB matrix (below 7 a row).
            let back = reflectance_rgb(&curve(|w| uplift_reflectance(rgb, w)));
            assert!((back - rgb).abs().max_element() < 2e-6, "{rgb} came back as {back}");
        }
        let white = curve(|w| uplift_illuminant(Vec3::ONE, w));
        assert!((white.y() - 1.0).abs() < 4.0 * f64::from(f32::EPSILON), "{}", white.y());
    }
}
