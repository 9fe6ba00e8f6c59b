//! Four f32 lanes: radiance, reflectance or transmittance at four wavelengths, or linear RGB.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Index, Mul, MulAssign, Neg, Sub, SubAssign};

use glam::{Vec3, Vec4};

/// A quantity at the four wavelengths of one path; unitless arithmetic, lane by lane.
///
/// In spectral mode lane `i` belongs to wavelength `i`; in RGB mode lanes 0 to 2 are linear sRGB and
/// lane 3 is carried along ([`Spectrum::from_rgb`]). No operation checks for NaN or infinity: they
/// propagate as in IEEE 754 and [`Spectrum::is_finite`] finds them.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[repr(transparent)]
pub struct Spectrum(pub Vec4);

impl Spectrum {
    /// Zero in every lane.
    pub const ZERO: Self = Self(Vec4::ZERO);
    /// One in every lane.
    pub const ONE: Self = Self(Vec4::ONE);

    /// The same value in every lane.
    pub const fn splat(v: f32) -> Self {
        Self(Vec4::splat(v))
    }

    /// Lanes in order.
    pub const fn new(a: f32, b: f32, c: f32, d: f32) -> Self {
        Self(Vec4::new(a, b, c, d))
    }

    /// Lanes from an array.
    pub const fn from_array(lanes: [f32; 4]) -> Self {
        Self(Vec4::from_array(lanes))
    }

    /// Linear RGB in lanes 0 to 2, their mean in lane 3, so that [`Spectrum::mean`],
    /// [`Spectrum::max_element`] and [`Spectrum::is_black`] of a fresh value are those of the colour.
    pub fn from_rgb(rgb: Vec3) -> Self {
        Self(rgb.extend(rgb.element_sum() / 3.0))
    }

    /// Lanes 0 to 2: the colour in RGB mode, meaningless in spectral mode.
    pub fn rgb(self) -> Vec3 {
        self.0.truncate()
    }

    /// Lanes as an array.
    pub const fn to_array(self) -> [f32; 4] {
        self.0.to_array()
    }

    /// Lane `i`.
    ///
    /// # Panics
    /// When `i` is not in [0, 4).
    pub fn lane(self, i: usize) -> f32 {
        self.0[i]
    }

    /// e to the power of each lane.
    #[must_use]
    pub fn exp(self) -> Self {
        Self(self.0.exp())
    }

    /// Natural logarithm of each lane: NaN below zero, −∞ at zero.
    #[must_use]
    pub fn ln(self) -> Self {
        Self(self.0.ln())
    }

    /// Square root of each lane: NaN below zero.
    #[must_use]
    pub fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    /// The larger of two, lane by lane; of a NaN and a number, either.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    /// The smaller of two, lane by lane; of a NaN and a number, either.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    /// Each lane limited to [lo, hi], which the caller gives in that order.
    #[must_use]
    pub fn clamp(self, lo: f32, hi: f32) -> Self {
        self.max(Self::splat(lo)).min(Self::splat(hi))
    }

    /// The largest lane.
    pub fn max_element(self) -> f32 {
        self.0.max_element()
    }

    /// The mean of the lanes.
    pub fn mean(self) -> f32 {
        self.0.element_sum() * 0.25
    }

    /// Whether no lane is NaN or infinite.
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// Whether every lane is zero.
    pub fn is_black(self) -> bool {
        self.0 == Vec4::ZERO
    }
}

macro_rules! lanewise {
    ($($op:ident $f:ident $op_assign:ident $f_assign:ident),*) => {$(
        impl $op for Spectrum {
            type Output = Self;
            fn $f(self, rhs: Self) -> Self {
                Self(self.0.$f(rhs.0))
            }
        }
        impl $op<f32> for Spectrum {
            type Output = Self;
            fn $f(self, rhs: f32) -> Self {
                Self(self.0.$f(rhs))
            }
        }
        impl $op<Spectrum> for f32 {
            type Output = Spectrum;
            fn $f(self, rhs: Spectrum) -> Spectrum {
                Spectrum(self.$f(rhs.0))
            }
        }
        impl $op_assign for Spectrum {
            fn $f_assign(&mut self, rhs: Self) {
                self.0.$f_assign(rhs.0);
            }
        }
        impl $op_assign<f32> for Spectrum {
            fn $f_assign(&mut self, rhs: f32) {
                self.0.$f_assign(rhs);
            }
        }
    )*};
}
lanewise!(
    Add add AddAssign add_assign, Sub sub SubAssign sub_assign,
    Mul mul MulAssign mul_assign, Div div DivAssign div_assign
);

impl Neg for Spectrum {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Sum for Spectrum {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ZERO, Add::add)
    }
}

impl Index<usize> for Spectrum {
    type Output = f32;
    fn index(&self, i: usize) -> &f32 {
        &self.0[i]
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "sums and products of small integers are exact")]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_works_lane_by_lane() {
        let s = Spectrum::new(1.0, 2.0, 3.0, 4.0);
        assert_eq!((s + s * 2.0 - 1.0).to_array(), [2.0, 5.0, 8.0, 11.0]);
        assert_eq!((12.0 / s).to_array(), [12.0, 6.0, 4.0, 3.0]);
        assert_eq!((-s).clamp(-3.0, -2.0).to_array(), [-2.0, -2.0, -3.0, -3.0]);
        assert_eq!([s, s, s].into_iter().sum::<Spectrum>(), s * 3.0);
        assert_eq!((s.mean(), s.max_element(), s[1], s.lane(3)), (2.5, 4.0, 2.0, 4.0));
    }

    #[test]
    fn black_and_finite_look_at_every_lane() {
        assert!(Spectrum::ZERO.is_black());
        for i in 0..4 {
            let mut lanes = [0.0; 4];
            lanes[i] = f32::NAN;
            assert!(!Spectrum::from_array(lanes).is_finite());
            lanes[i] = 1.0;
            assert!(!Spectrum::from_array(lanes).is_black());
        }
    }

    #[test]
    fn a_colour_keeps_its_mean_and_largest_channel() {
        let s = Spectrum::from_rgb(Vec3::new(1.0, 2.0, 6.0));
        assert_eq!((s.mean(), s.max_element(), s.rgb()), (3.0, 6.0, Vec3::new(1.0, 2.0, 6.0)));
    }
}
