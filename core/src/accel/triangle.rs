//! Four triangles against a ray, watertight.
//!
//! Source: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", without contraction
//! and with its f64 fallback. Rounding is monotonic, so the sign of `a·b − c·d` in f32 is either
//! exact or lost to zero, and f64 holds both products exactly: every edge is decided the same way
//! for both its triangles.

use glam::{BVec4A, Vec4};

use super::node::{Block, WIDTH};
use super::ray::Shear;

/// The nearest hit so far; `id` is `u32::MAX` while there is none and `t` is then the limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) t: f32,
    pub(super) id: u32,
    pub(super) b1: f32,
    pub(super) b2: f32,
}

/// Scaled barycentrics of the three vertices, one lane per triangle.
#[derive(Clone, Copy)]
struct Edges {
    u: Vec4,
    v: Vec4,
    w: Vec4,
}

/// What a block gives before the nearest is picked.
pub(super) struct Lanes {
    mask: u32,
    t: Vec4,
    b1: Vec4,
    b2: Vec4,
}

impl Block {
    /// Takes the nearest hit of this block into `best` if it is nearer, or as near with a lower
    /// number. True if any of its triangles is hit with 0 < t <= `best.t`.
    #[inline(always)]
    pub(super) fn intersect<const ANY: bool>(&self, ray: &Shear, best: &mut Nearest) -> bool {
        let Some(lanes) = self.lanes(ray, best.t) else { return false };
        if ANY {
            return true;
        }
        let (t, b1, b2) = (lanes.t.to_array(), lanes.b1.to_array(), lanes.b2.to_array());
        let mut mask = lanes.mask;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & (WIDTH - 1);
            mask &= mask - 1;
            let id = self.ids[lane];
            #[expect(clippy::float_cmp, reason = "equal distances are a tie, decided by number")]
            if t[lane] < best.t || (t[lane] == best.t && id < best.id) {
                *best = Nearest { t: t[lane], id, b1: b1[lane], b2: b2[lane] };
            }
        }
        true
    }

    #[inline(always)]
    fn lanes(&self, ray: &Shear, t_max: f32) -> Option<Lanes> {
        // The bound is known to the compiler here, so indexing costs nothing below.
        let [kx, ky, kz] = ray.axes;
        let (kx, ky, kz) = (kx.min(2), ky.min(2), kz.min(2));
        let (ox, oy, oz) = (Vec4::splat(ray.o[0]), Vec4::splat(ray.o[1]), Vec4::splat(ray.o[2]));
        let [sx, sy, sz] = ray.factors;
        let (sx, sy, sz) = (Vec4::splat(sx), Vec4::splat(sy), Vec4::splat(sz));

        // Translate to the ray's origin, shear its direction onto the z axis.
        let [a, b, c] = &self.points;
        let (az, bz, cz) = (a[kz] - oz, b[kz] - oz, c[kz] - oz);
        let (ax, bx, cx) = ((a[kx] - ox) - sx * az, (b[kx] - ox) - sx * bz, (c[kx] - ox) - sx * cz);
        let (ay, by, cy) = ((a[ky] - oy) - sy * az, (b[ky] - oy) - sy * bz, (c[ky] - oy) - sy * cz);

        // Edge functions at the origin of the plane.
        let mut edges = Edges { u: cx * by - cy * bx, v: ax * cy - ay * cx, w: bx * ay - by * ax };
        let mut inside = edges.inside();
        if !inside.any() {
            return None;
        }
        if (edges.zeros() & inside).any() {
            edges = Edges::exact([ax, bx, cx], [ay, by, cy]);
            inside = edges.inside();
        }

        let det = edges.u + edges.v + edges.w;
        let r = Vec4::ONE / det;
        let t = (edges.u * az + edges.v * bz + edges.w * cz) * sz * r;
        let within = t.cmpgt(Vec4::ZERO) & t.cmple(Vec4::splat(t_max)) & det.cmpne(Vec4::ZERO);
        let mut mask = (inside & within).bitmask();
        if mask != 0 {
            for lane in 0..WIDTH {
                mask &= !(u32::from(self.ids[lane] == ray.skip) << lane);
            }
        }
        (mask != 0).then(|| Lanes { mask, t, b1: edges.v * r, b2: edges.w * r })
    }
}

impl Edges {
    /// Not of mixed signs; false for NaN, which fills all three together.
    #[inline(always)]
    fn inside(self) -> BVec4A {
        self.u.min(self.v).min(self.w).cmpge(Vec4::ZERO)
            | self.u.max(self.v).max(self.w).cmple(Vec4::ZERO)
    }

    #[inline(always)]
    fn zeros(self) -> BVec4A {
        self.u.cmpeq(Vec4::ZERO) | self.v.cmpeq(Vec4::ZERO) | self.w.cmpeq(Vec4::ZERO)
    }

    /// The same with both products exact; a sign survives the narrowing even if its value does not.
    #[cold]
    #[inline(never)]
    fn exact([ax, bx, cx]: [Vec4; 3], [ay, by, cy]: [Vec4; 3]) -> Self {
        let difference = |a: Vec4, b: Vec4, c: Vec4, d: Vec4| {
            Vec4::from_array([0, 1, 2, 3].map(|lane| {
                let [a, b, c, d] = [a[lane], b[lane], c[lane], d[lane]].map(f64::from);
                let exact = a * b - c * d;
                #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]
                let rounded = exact as f32;
                let least = f32::from_bits(1);
                match exact.partial_cmp(&0.0) {
                    Some(std::cmp::Ordering::Greater) => rounded.max(least),
                    Some(std::cmp::Ordering::Less) => rounded.min(-least),
                    _ => rounded,
                }
            }))
        };
        Self {
            u: difference(cx, by, cy, bx),
            v: difference(ax, cy, ay, cx),
            w: difference(bx, ay, by, ax),
        }
    }
}
