//! A ray made ready for a mesh tree: the robust box test.
//!
//! Source: PBR4 §6.8.2 (slabs) with the bound of §6.8.3; Woop, Benthin and Wald 2013 (the shear).

use glam::{Vec3, Vec4};

use super::node::Node;

/// Unit roundoff of f32.
const U: f32 = f32::EPSILON / 2.0;

/// 1 + 2γ(3): each slab distance has three roundings (subtraction, reciprocal, product), so a far
/// plane this much farther is never before a near plane that it touches.
const FAR: f32 = 1.0 + 2.0 * (3.0 * U / (1.0 - 3.0 * U)) + f32::EPSILON;

/// A ray in a mesh's scaled frame, with all that the box and the triangle test need of it.
pub(super) struct MeshRay {
    /// Origins for the near and the far planes: `o` moved apart by the slack of [`MeshRay::new`].
    near_o: [Vec4; 3],
    far_o: [Vec4; 3],
    rdir: [Vec4; 3],
    /// Which plane of each axis is entered first, 0 or 1.
    near: [usize; 3],
    /// One bit per negative component.
    pub(super) octant: usize,
    /// Axes with the largest component last; each is below 3.
    pub(super) axes: [usize; 3],
    /// Origin in the order of `axes`.
    pub(super) o: [f32; 3],
    /// `d[kx]/d[kz]`, `d[ky]/d[kz]`, `1/d[kz]`.
    pub(super) shear: [f32; 3],
    /// A triangle that is passed; `u32::MAX` for none.
    pub(super) skip: u32,
}

impl MeshRay {
    /// A finite origin and a finite, non-zero direction whose largest component is neither tiny nor
    /// huge; `reach` is the largest |coordinate| of the mesh.
    ///
    /// The triangle test shifts each vertex by at most 7u·(|o| + |p|) in the shear plane (u the
    /// unit roundoff: two subtractions, a shear factor of two roundings, a product, and again a
    /// subtraction). Boxes widened by 8u·(|o| + |p|) therefore hold every triangle the test
    /// accepts; widening is moving the origin, once per ray.
    #[inline(always)]
    pub(super) fn new(o: Vec3, d: Vec3, reach: f32) -> Self {
        let slack = 8.0 * U * (o.abs().max_element() + reach);
        let rdir = d.recip();
        let sign = |c: f32| usize::from(c.is_sign_negative());
        let near = [sign(d.x), sign(d.y), sign(d.z)];
        let apart = slack * Vec3::ONE.copysign(d);
        let a = d.abs();
        let kz = if a.x > a.y && a.x > a.z {
            0
        } else if a.y > a.z {
            1
        } else {
            2
        };
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][kz];
        let rz = 1.0 / d[kz];
        let splat = |v: Vec3| [Vec4::splat(v.x), Vec4::splat(v.y), Vec4::splat(v.z)];
        Self {
            near_o: splat(o + apart),
            far_o: splat(o - apart),
            rdir: splat(rdir),
            near,
            octant: near[0] | near[1] << 1 | near[2] << 2,
            axes,
            o: [o[axes[0]], o[axes[1]], o[axes[2]]],
            shear: [d[axes[0]] * rz, d[axes[1]] * rz, rz],
            skip: u32::MAX,
        }
    }

    /// The same ray, passing the triangle of that number.
    #[inline(always)]
    pub(super) fn skipping(self, skip: u32) -> Self {
        Self { skip, ..self }
    }

    /// Which of the node's four boxes the ray may enter at or before `t_max`, and where.
    ///
    /// A direction component of zero makes infinities, and NaN where the origin lies in a plane.
    /// `min` and `max` give their second operand if either is NaN, so that slab does not cut.
    #[inline(always)]
    pub(super) fn enter(&self, node: &Node, t_max: f32) -> (u32, Vec4) {
        let mut t_near = Vec4::ZERO;
        let mut t_far = Vec4::splat(t_max);
        for axis in 0..3 {
            let near = self.near[axis] & 1;
            let rdir = self.rdir[axis];
            t_near = ((node.planes[axis][near] - self.near_o[axis]) * rdir).max(t_near);
            t_far = ((node.planes[axis][near ^ 1] - self.far_o[axis]) * rdir).min(t_far);
        }
        (t_near.cmple(t_far * FAR).bitmask(), t_near)
    }
}

/// The parameter at which a subtree may be skipped when the best hit is at `t`: see [`FAR`].
#[inline(always)]
pub(super) fn cull(t: f32) -> f32 {
    t * FAR
}
