//! Four triangles against a ray, watertight.
//!
//! Source: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", without contraction
//! and with its f64 fallback. Rounding is monotonic, so the sign of `a·b − c·d` in f32 is either
//! exact or lost to zero, and f64 holds both products exactly: every edge is decided the same way
//! for both its triangles.

use glam::{BVec4A, DVec3, Vec4};

use super::node::{Block, LANES};
use super::ray::{Line, Shear, per_power_of_two};
use crate::cast::narrow;

/// Below it the edge functions of a triangle are scaled: they, differences of two products of what measures
/// 2⁻³⁰, may be multiplied by distances down to 2⁻⁴² before anything of 24 digits is lost to underflow, which
/// begins at 2⁻¹²⁶.
const UNDERFLOW: f32 = 1.0 / (1_u64 << 60) as f32;

/// The nearest hit so far; `id` is `u32::MAX` while there is none and `t` is then the limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) t: f32,
    pub(super) id: u32,
    pub(super) b1: f32,
    pub(super) b2: f32,
    /// `t`, `b1` and `b2` where they are known in double precision; `t` above is then rounded up.
    pub(super) exact: [f64; 3],
}

impl Nearest {
    /// No hit yet, and none beyond `t`.
    pub(super) fn none(t: f64) -> Self {
        Self { t: narrow(t), id: u32::MAX, b1: 0.0, b2: 0.0, exact: [t, 0.0, 0.0] }
    }
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
        let lanes = self.lanes(ray, best.t);
        self.take::<ANY>(lanes, best)
    }

    /// The same by Möller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection": edges
    /// are decided for each triangle by itself, so rays may slip between two.
    #[inline(always)]
    pub(super) fn intersect_fast<const ANY: bool>(
        &self,
        line: &Line,
        skip: u32,
        best: &mut Nearest,
    ) -> bool {
        let lanes = self.fast_lanes(line, skip, best.t);
        self.take::<ANY>(lanes, best)
    }

    /// The same as `intersect` in double precision, one triangle after another: the nearer hit, if
    /// there is one. Given and taken by value, so that the other precisions keep theirs in registers.
    #[inline(never)]
    pub(super) fn intersect_exact<const ANY: bool>(
        &self,
        line: Line,
        skip: u32,
        best: Nearest,
    ) -> Option<Nearest> {
        let mut nearer = None;
        for lane in 0..LANES {
            let id = self.ids[lane];
            let corners = self.points.map(|p| DVec3::from_array(p.map(|c| f64::from(c[lane]))));
            let Some([t, b1, b2]) = watertight(&line, corners) else { continue };
            let best = nearer.unwrap_or(best);
            let is_nearer = t < best.exact[0] || (t <= best.exact[0] && id < best.id);
            if id != skip && is_nearer {
                let above = narrow(t * (1.0 + f64::from(f32::EPSILON)));
                nearer = Some(Nearest { t: above, id, b1: 0.0, b2: 0.0, exact: [t, b1, b2] });
                if ANY {
                    break;
                }
            }
        }
        nearer
    }

    #[inline(always)]
    fn take<const ANY: bool>(&self, lanes: Option<Lanes>, best: &mut Nearest) -> bool {
        let Some(lanes) = lanes else { return false };
        if ANY {
            return true;
        }
        let (t, b1, b2) = (lanes.t.to_array(), lanes.b1.to_array(), lanes.b2.to_array());
        let mut mask = lanes.mask;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & (LANES - 1);
            mask &= mask - 1;
            let id = self.ids[lane];
            #[expect(clippy::float_cmp, reason = "equal distances are a tie, decided by number")]
            if t[lane] < best.t || (t[lane] == best.t && id < best.id) {
                (best.t, best.id, best.b1, best.b2) = (t[lane], id, b1[lane], b2[lane]);
            }
        }
        true
    }

    #[inline(always)]
    fn fast_lanes(&self, line: &Line, skip: u32, t_max: f32) -> Option<Lanes> {
        let splat = |v: DVec3| v.as_vec3().to_array().map(Vec4::splat);
        let (o, d) = (splat(line.o), splat(line.d));
        let [a, b, c] = &self.points;
        let minus = |p: &[Vec4; 3], q: &[Vec4; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let cross = |p: &[Vec4; 3], q: &[Vec4; 3]| {
            [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
        };
        let dot = |p: &[Vec4; 3], q: &[Vec4; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let (e1, e2, s) = (minus(b, a), minus(c, a), minus(&o, a));
        let p = cross(&d, &e2);
        let q = cross(&s, &e1);
        let r = Vec4::ONE / dot(&e1, &p);
        let (b1, b2, t) = (dot(&s, &p) * r, dot(&d, &q) * r, dot(&e2, &q) * r);
        let inside = b1.min(b2).cmpge(Vec4::ZERO) & (b1 + b2).cmple(Vec4::ONE);
        let within = t.cmpgt(Vec4::ZERO) & t.cmple(Vec4::splat(t_max));
        let mask = self.others((inside & within).bitmask(), skip);
        (mask != 0).then_some(Lanes { mask, t, b1, b2 })
    }

    /// Those of these lanes that do not hold the triangle to be passed.
    #[inline(always)]
    fn others(&self, mut mask: u32, skip: u32) -> u32 {
        if mask != 0 {
            for lane in 0..LANES {
                mask &= !(u32::from(self.ids[lane] == skip) << lane);
            }
        }
        mask
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
        let lost = edges.lost();
        if (lost & inside).any() {
            // Only where it must: what a triangle answers does not depend on its neighbours.
            edges = edges.decided(lost, [ax, bx, cx], [ay, by, cy]);
            inside = edges.inside();
        }

        let det = edges.u + edges.v + edges.w;
        let r = Vec4::ONE / det;
        let t = (edges.u * az + edges.v * bz + edges.w * cz) * sz * r;
        let within = t.cmpgt(Vec4::ZERO) & t.cmple(Vec4::splat(t_max)) & det.cmpne(Vec4::ZERO);
        let mask = self.others((inside & within).bitmask(), ray.skip);
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

    /// Where one is zero, or so small that products with it may lose digits to underflow.
    #[inline(always)]
    fn lost(self) -> BVec4A {
        let least = self.u.abs().min(self.v.abs()).min(self.w.abs());
        least.cmplt(Vec4::splat(UNDERFLOW))
    }

    /// The same, where `mask` says so with both products exact; a sign survives the narrowing even if
    /// its value does not. The three of a triangle that is so small are scaled alike, the greatest to one or more, below two.
    #[cold]
    #[inline(never)]
    fn decided(self, mask: BVec4A, [ax, bx, cx]: [Vec4; 3], [ay, by, cy]: [Vec4; 3]) -> Self {
        let mut out = [self.u, self.v, self.w].map(|edge| edge.to_array());
        for lane in (0..LANES).filter(|lane| mask.test(*lane)) {
            let [a, b, c] = [(ax, ay), (bx, by), (cx, cy)]
                .map(|(x, y)| [f64::from(x[lane]), f64::from(y[lane])]);
            let exact = [(c, b), (a, c), (b, a)].map(|(p, q)| p[0] * q[1] - p[1] * q[0]);
            let greatest = exact.iter().fold(0.0, |most: f64, edge| most.max(edge.abs()));
            let is_small = greatest < f64::from(UNDERFLOW);
            let scale = if is_small { per_power_of_two(greatest) } else { 1.0 };
            for (edge, exact) in out.iter_mut().zip(exact) {
                edge[lane] = with_sign(exact * scale);
            }
        }
        let [u, v, w] = out.map(Vec4::from_array);
        Self { u, v, w }
    }
}

/// A number in single precision, of the same sign even where it underflows.
fn with_sign(exact: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]
    let rounded = exact as f32;
    let least = f32::from_bits(1);
    match exact.partial_cmp(&0.0) {
        Some(std::cmp::Ordering::Greater) => rounded.max(least),
        Some(std::cmp::Ordering::Less) => rounded.min(-least),
        _ => rounded,
    }
}

/// `t` and the weights of the second and third corner where a line meets a triangle with t > 0.
///
/// Like the lanes above, in double precision. Products round: where both round to the same number, what
/// they lost decides, so that signs are exact short of underflow. A zero counts as inside for both triangles of an edge.
fn watertight(line: &Line, corners: [DVec3; 3]) -> Option<[f64; 3]> {
    let kz = line.d.abs().max_position();
    let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
    let rz = line.d[kz].recip();
    let (sx, sy) = (line.d[kx] * rz, line.d[ky] * rz);
    let sheared = corners.map(|p| {
        let p = p - line.o;
        (p[kx] - sx * p[kz], p[ky] - sy * p[kz], p[kz])
    });
    let [a, b, c] = sheared;
    let edge = |p: (f64, f64, f64), q: (f64, f64, f64)| {
        let (first, second) = (p.0 * q.1, p.1 * q.0);
        let difference = first - second;
        if difference == 0.0 {
            return p.0.mul_add(q.1, -first) - p.1.mul_add(q.0, -second);
        }
        difference
    };
    let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
    let inside = u.min(v).min(w) >= 0.0 || u.max(v).max(w) <= 0.0;
    let det = u + v + w;
    let r = det.recip();
    let t = (u * a.2 + v * b.2 + w * c.2) * rz * r;
    (inside && t > 0.0 && det != 0.0).then_some([t, v * r, w * r])
}
