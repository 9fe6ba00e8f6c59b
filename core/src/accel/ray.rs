//! A ray made ready for a mesh tree.
//!
//! Source: Woop, Benthin and Wald 2013 (the shear).

use glam::{DVec3, Vec3};

use super::precision::Precision;
use super::slabs::Slabs;

/// A direction in the frame of meshes, made ready for their triangles: once per ray and frame.
///
/// It is scaled by a power of two, so that no product of the tests overflows or loses digits below.
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    /// Its largest |component| is in [1, 2].
    pub(super) d: Vec3,
    /// The same before it was rounded.
    pub(super) exact: DVec3,
    /// Axes with the largest component last; each is below 3.
    pub(super) axes: [usize; 3],
    /// `d[kx]/d[kz]`, `d[ky]/d[kz]`, `1/d[kz]`.
    pub(super) shear: [f32; 3],
    scale: f64,
    per_scale: f64,
}

/// The axes with each of them last. A static: made anew for each ray it would be thirty instructions.
static AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

/// Exponents of normal numbers whose inverse is normal too, where they stand in an f64.
const EXPONENTS: std::ops::Range<u64> = 1 << 52..2046 << 52;

impl Direction {
    /// `None` for a direction whose largest component is zero, not finite, or so large or small that
    /// its inverse is not a normal number. With a NaN beside it no triangle is hit.
    #[inline(always)]
    pub fn new(d: DVec3) -> Option<Self> {
        let a = d.abs();
        // Without branches: which axis it is cannot be foreseen.
        let of_yz = if a.y > a.z { a.y } else { a.z };
        let largest = if a.x > of_yz { a.x } else { of_yz };
        let kz = (1 + usize::from(a.y <= a.z)) * usize::from(a.x <= of_yz);
        let exponent = largest.to_bits() & f64::INFINITY.to_bits();
        if !EXPONENTS.contains(&exponent) {
            return None;
        }
        let (scale, per_scale) = (f64::from_bits(exponent), per_power_of_two(largest));
        let exact = d * per_scale;
        let d = exact.as_vec3();
        let axes = AXES[kz];
        let rz = 1.0 / d[kz];
        let shear = [d[axes[0]] * rz, d[axes[1]] * rz, rz];
        Some(Self { d, exact, axes, shear, scale, per_scale })
    }

    /// Length of the direction that was given in lengths of the scaled one: what a parameter `t`
    /// along the given one is multiplied with to be one along the scaled one.
    #[inline]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// 1 / [`Direction::scale`], exactly: at least 1 over the largest |component|.
    #[inline]
    pub fn per_scale(&self) -> f64 {
        self.per_scale
    }
}

/// 1 over the greatest power of two that is not above a number, neither of them too small to be normal: their
/// exponents add up to that of 1. Of 0 it is finite.
#[inline(always)]
pub(super) fn per_power_of_two(number: f64) -> f64 {
    f64::from_bits(2 * 1f64.to_bits() - (number.to_bits() & f64::INFINITY.to_bits()))
}

/// A ray in a mesh's scaled frame, in double precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) o: DVec3,
    /// Its largest |component| is in [1, 2].
    pub(super) d: DVec3,
}

/// A ray in a mesh's scaled frame, as the watertight triangle test wants it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    /// As in [`Direction`].
    pub(super) axes: [usize; 3],
    /// Origin in the order of `axes`.
    pub(super) o: [f32; 3],
    /// [`Direction::shear`].
    pub(super) factors: [f32; 3],
    /// A triangle that is passed; `u32::MAX` for none.
    pub(super) skip: u32,
}

impl Shear {
    #[inline(always)]
    pub(super) fn new(direction: &Direction, o: Vec3, skip: u32) -> Self {
        let axes = direction.axes;
        let o = [o[axes[0]], o[axes[1]], o[axes[2]]];
        Self { axes, o, factors: direction.shear, skip }
    }
}

impl Slabs<f32> {
    /// A finite origin and a finite, non-zero direction whose largest component is neither tiny nor
    /// huge; `reach` is the largest |coordinate| of the mesh.
    ///
    /// The triangle test shifts each vertex by at most 7u·(|o| + |p|) in the shear plane (u the
    /// unit roundoff: two subtractions, a shear factor of two roundings, a product, and again a
    /// subtraction). Boxes widened by 8u·(|o| + |p|) therefore hold every triangle the test
    /// accepts. Without a promise they are not widened.
    #[inline(always)]
    pub(super) fn through_mesh(o: Vec3, d: Vec3, reach: f32, precision: Precision) -> Self {
        let slack = match precision {
            Precision::Fast => 0.0,
            _ => 4.0 * f32::EPSILON * (o.abs().max_element() + reach),
        };
        Self::new(o.to_array(), d.to_array(), slack)
    }
}
