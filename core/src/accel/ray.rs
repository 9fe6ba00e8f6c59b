//! A ray made ready for a mesh tree: the robust box test.
//!
//! Source: PBR4 §6.8.2 (slabs) with the bound of §6.8.3; Woop, Benthin and Wald 2013 (the shear).

use glam::{DVec3, Vec3};

use super::node::{Node, WIDTH};
use super::precision::Precision;
use super::stack::Stack;

/// Unit roundoff of f32.
const U: f32 = f32::EPSILON / 2.0;

/// 1 + 2γ(3): each slab distance has three roundings (subtraction, reciprocal, product), so a far
/// plane this much farther is never before a near plane that it touches.
pub(super) const FAR: f32 = 1.0 + 2.0 * (3.0 * U / (1.0 - 3.0 * U)) + f32::EPSILON;

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
        // Powers of two, whose exponents add up to that of 1.
        let scale = f64::from_bits(exponent);
        let per_scale = f64::from_bits(2 * 1f64.to_bits() - exponent);
        let exact = d * per_scale;
        let d = exact.as_vec3();
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][kz];
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

/// A ray in a mesh's scaled frame, in double precision.
#[derive(Debug)]
pub(super) struct Line {
    pub(super) o: DVec3,
    /// Its largest |component| is in [1, 2].
    pub(super) d: DVec3,
}

/// A ray in a mesh's scaled frame, as the watertight triangle test wants it.
#[derive(Debug)]
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

/// The same ray, as the box test wants it.
#[derive(Debug)]
pub(super) struct Slabs {
    /// Origins for the near and the far planes: `o` moved apart by the slack of [`Slabs::new`].
    pub(super) near_o: [f32; 3],
    pub(super) far_o: [f32; 3],
    pub(super) rdir: [f32; 3],
    /// Which plane of each axis is entered first, 0 or 1.
    pub(super) near: [usize; 3],
    /// One bit per negative component.
    pub(super) octant: usize,
}

impl Slabs {
    /// A finite origin and a finite, non-zero direction whose largest component is neither tiny nor
    /// huge; `reach` is the largest |coordinate| of the mesh.
    ///
    /// The triangle test shifts each vertex by at most 7u·(|o| + |p|) in the shear plane (u the
    /// unit roundoff: two subtractions, a shear factor of two roundings, a product, and again a
    /// subtraction). Boxes widened by 8u·(|o| + |p|) therefore hold every triangle the test
    /// accepts; widening is moving the origin, once per ray. Without a promise it is not moved.
    #[inline(always)]
    pub(super) fn new(o: Vec3, d: Vec3, reach: f32, precision: Precision) -> Self {
        let slack = match precision {
            Precision::Fast => 0.0,
            _ => 8.0 * U * (o.abs().max_element() + reach),
        };
        let rdir = d.recip();
        let sign = |c: f32| usize::from(c.is_sign_negative());
        let near = [sign(d.x), sign(d.y), sign(d.z)];
        let apart = slack * Vec3::ONE.copysign(d);
        Self {
            near_o: (o + apart).to_array(),
            far_o: (o - apart).to_array(),
            rdir: rdir.to_array(),
            near,
            octant: near[0] | near[1] << 1 | near[2] << 2,
        }
    }

    /// Puts the children that the ray enters at or before `t_max` on the stack, the nearest last.
    ///
    /// A direction component of zero makes infinities, and NaN where the origin lies in a plane: a
    /// slab with a NaN does not cut.
    #[inline(always)]
    pub(super) fn enter(&self, node: &Node, t_max: f32, stack: &mut Stack<'_, f32>) {
        let mut t_near = [0.0; WIDTH];
        let mut t_far = [t_max; WIDTH];
        for axis in 0..3 {
            let side = self.near[axis] & 1;
            let (near, far) = (&node.planes[axis][side], &node.planes[axis][side ^ 1]);
            for lane in 0..WIDTH {
                let enter = (near[lane] - self.near_o[axis]) * self.rdir[axis];
                let leave = (far[lane] - self.far_o[axis]) * self.rdir[axis];
                t_near[lane] = if enter > t_near[lane] { enter } else { t_near[lane] };
                t_far[lane] = if leave < t_far[lane] { leave } else { t_far[lane] };
            }
        }
        for slot in node.order.far_to_near(self.octant) {
            let entered = t_near[slot] <= t_far[slot] * FAR;
            stack.push_if(entered, node.children[slot], t_near[slot]);
        }
    }
}

/// The parameter at which a subtree may be skipped when the best hit is at `t`: see [`FAR`].
#[inline(always)]
pub(super) fn cull(t: f32) -> f32 {
    t * FAR
}
