//! The wavelengths of one path with everything that is looked up at them again and again.

use glam::Vec3;

use super::curve::split;
use super::uplift::basis_at;
use super::{Curve, Spectrum, Wavelengths};

/// A path's wavelengths, where they lie in tables at 1 nm, and the RGB basis at them.
///
/// Made once for a path; every lookup after that is a few multiplications.
#[derive(Clone, Copy, Debug)]
pub struct Palette {
    /// The wavelengths.
    pub wavelengths: Wavelengths,
    rows: [u16; 4],
    fractions: [f32; 4],
    reflectance: [Spectrum; 3],
    illuminant: [Spectrum; 3],
}

impl Palette {
    /// The palette of a spectral path.
    pub fn new(wavelengths: Wavelengths) -> Self {
        let places = wavelengths.lambda.to_array().map(split);
        let (reflectance, illuminant) = basis_at(places);
        Self {
            wavelengths,
            #[expect(clippy::cast_possible_truncation, reason = "rows are at most 470")]
            rows: places.map(|(row, _)| row as u16),
            fractions: places.map(|(_, fraction)| fraction),
            reflectance,
            illuminant,
        }
    }

    /// The palette of a path whose lanes are RGB: nothing can be looked up in it.
    pub fn rgb() -> Self {
        let none = [Spectrum::ZERO; 3];
        Self {
            wavelengths: Wavelengths { lambda: Spectrum::splat(550.0), pdf: Spectrum::ONE },
            rows: [0; 4],
            fractions: [0.0; 4],
            reflectance: none,
            illuminant: none,
        }
    }

    /// As `uplift_reflectance` at these wavelengths.
    #[inline]
    pub fn reflectance(&self, rgb: Vec3) -> Spectrum {
        let [r, g, b] = self.reflectance;
        r * rgb.x + g * rgb.y + b * rgb.z
    }

    /// As `uplift_illuminant` at these wavelengths.
    #[inline]
    pub fn illuminant(&self, rgb: Vec3) -> Spectrum {
        let [r, g, b] = self.illuminant;
        r * rgb.x + g * rgb.y + b * rgb.z
    }

    /// As `Curve::eval` at these wavelengths.
    #[inline]
    pub fn curve(&self, curve: &Curve) -> Spectrum {
        let table = curve.table();
        Spectrum::from_array(std::array::from_fn(|lane| {
            let row = usize::from(self.rows[lane]);
            table[row] + (table[row + 1] - table[row]) * self.fractions[lane]
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{uplift_illuminant, uplift_reflectance};

    #[test]
    fn a_palette_answers_as_the_tables_do() {
        let colour = Vec3::new(0.8, 0.3, 0.05);
        let curve = Curve::from_fn(|nm| (nm * 0.03).sin());
        for i in 0_u8..100 {
            let w = Wavelengths::sample(f32::from(i) / 100.0);
            let palette = Palette::new(w);
            // Three products and two sums, in another order than the tables': γ(5) of their sum.
            let close = |a: Spectrum, b: Spectrum| {
                (0..4).all(|lane| (a.lane(lane) - b.lane(lane)).abs() <= 4.0 * f32::EPSILON)
            };
            assert!(close(palette.reflectance(colour), uplift_reflectance(colour, &w)));
            assert!(close(palette.illuminant(colour), uplift_illuminant(colour, &w)));
            assert_eq!(palette.curve(&curve), curve.eval(&w));
        }
    }
}
