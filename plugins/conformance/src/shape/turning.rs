//! How normals turn, against those of neighbouring hits; and whether a shape is the parallelogram
//! that it says.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use luxel_sdk::kind::{Hit, NormalDerivatives, Parallelogram, Surface};
use luxel_sdk::num::{Ray, Transform};
use luxel_sdk::sampling::Rng;

use super::Look;
use crate::report::Judge;

/// The check of how normals turn.
pub(super) const TURNS: &str = "dn/du is the derivative";

/// Neighbours lie at most this share of the shape's radius away, of its least radius of curvature,
/// and of one unit of its coordinates.
const STEP: f64 = 1e-4;

/// What terms beyond the second in a step leave, over the first: places along a ray that meets the
/// surface at a slant move five steps, and shapes bend the lines of their coordinates by a few of
/// their own radii. (5·1e-4)² times four hundred.
const BEYOND: f64 = 1e-4;

/// The same of terms beyond the first, where one side alone is looked at: 5·1e-4 times twenty.
const BESIDE: f64 = 1e-2;

/// What a few dozen operations round.
const ROUNDS: f64 = 256.0 * f64::EPSILON;

/// A point with what is told of its normal.
struct Told {
    hit: Hit,
    at: Surface,
    turns: NormalDerivatives,
}

impl Look<'_> {
    /// Normals of hits on both sides of a hit differ by what their derivatives say.
    pub(super) fn turning(&self, rng: &mut Rng, judge: &mut Judge) {
        for _ in 0..200 {
            let ray = self.chord(rng);
            let Some(hit) = self.shape.intersect(&ray) else { continue };
            let at = self.shape.surface(&ray, &hit);
            if at.ns.dot(ray.d).abs() < 0.2 {
                continue;
            }
            let Some(turns) = self.shape.normal_derivatives(&hit, &at) else { continue };
            let told = Told { hit, at, turns };
            let finite = turns.dn_du.is_finite() && turns.dn_dv.is_finite();
            let here = || format!("{}: {hit:?}", self.at(&ray));
            judge.holds("finite", finite, here);
            let (u, v) = ray.d.any_orthonormal_pair();
            for across in [u, v] {
                self.turns_across(&ray, across, &told, judge);
            }
        }
    }

    fn turns_across(&self, ray: &Ray, across: DVec3, told: &Told, judge: &mut Judge) {
        let Told { hit, at, turns } = told;
        let (du, dv) = (at.dp_du.length(), at.dp_dv.length());
        let curvature = (turns.dn_du.length() / du).max(turns.dn_dv.length() / dv);
        let step = STEP * self.radius.min(du).min(dv).min(curvature.recip());
        let neighbour = |side: f64| {
            let near = Ray::new(ray.o + across * (side * step), ray.d);
            let met = self.shape.intersect(&near)?;
            let there = self.shape.surface(&near, &met);
            // Not over an edge, and not over a seam of the coordinates.
            let same = met.face == hit.face
                && (there.p - at.p).length() < 20.0 * step
                && there.ng.dot(at.ng) > 0.999
                && (there.uv - at.uv).abs().max_element() < 0.01;
            same.then_some(there)
        };
        let (Some(a), Some(b)) = (neighbour(-1.0), neighbour(1.0)) else { return };
        let moved = b.uv - a.uv;
        // Where coordinates say little of the place, nothing can be told: they may round.
        let rounds = ROUNDS * (1.0 + self.reach * (curvature + du.recip() + dv.recip()));
        for transform in [Transform::IDENTITY, sheared(), mirrored()] {
            let ns = |s: &Surface| s.carried(&transform).ns;
            let carried = turns.carried(at.ns, &transform);
            let turn = if transform.swaps_handedness() { -1.0 } else { 1.0 };
            let NormalDerivatives { dn_du, dn_dv } = carried;
            // The transforms stretch what rounds by their condition of four.
            let least = 4.0 * rounds * (1.0 + dn_du.length() + dn_dv.length());
            let off = |from: &Surface, to: &Surface, beyond: f64| {
                let moved = to.uv - from.uv;
                let predicted = dn_du * moved.x + dn_dv * (turn * moved.y);
                let size = dn_du.length() * moved.x.abs() + dn_dv.length() * moved.y.abs();
                (ns(to) - ns(from) - predicted).length() / (beyond * size + least)
            };
            // Where a blend begins, the normal turns at another rate beyond: one side is as told.
            let off = off(&a, &b, BEYOND).min(off(&a, at, BESIDE)).min(off(at, &b, BESIDE));
            let here = || format!("{}: {hit:?}, over {moved}, {transform:?}", self.at(ray));
            judge.within(TURNS, off, 1.0, here);
        }
    }

    /// Places on the parallelogram that a shape says it is are points of it.
    pub(super) fn parallelogram(&self, rng: &mut Rng, judge: &mut Judge) {
        let Some(Parallelogram { centre, u, v }) = self.shape.parallelogram() else { return };
        let here = || self.set.label.clone();
        let off = (self.shape.area() / u.cross(v).length() - 1.0).abs();
        // The angle between edges that are nearly parallel loses digits.
        let sin = u.cross(v).length() / (u.length() * v.length());
        judge.within("its parallelogram is it", off * sin / ROUNDS, 1.0, here);
        let ray = Ray::new(DVec3::ZERO, DVec3::X);
        for _ in 0..100 {
            let at = DVec2::new(rng.f64(), rng.f64()) - 0.5;
            let surface = self.shape.surface(&ray, &Hit { t: 1.0, at, face: 0 });
            let off = (surface.p - (centre + u * at.x + v * at.y)).length();
            let slack = ROUNDS * self.reach + surface.p_err.length();
            judge.within("its parallelogram is it", off / slack, 1.0, here);
        }
    }
}

/// Stretches and shears, by a condition of about four.
fn sheared() -> Transform {
    placed([[1.5, 0.2, -0.1], [0.5, 1.0, 0.3], [-0.2, 0.4, 0.8]])
}

fn mirrored() -> Transform {
    placed([[-1.0, 0.1, 0.0], [0.2, 0.9, -0.3], [0.0, 0.3, 0.7]])
}

fn placed(columns: [[f64; 3]; 3]) -> Transform {
    let [x, y, z] = columns.map(DVec3::from_array);
    let map = DAffine3::from_mat3(DMat3::from_cols(x, y, z));
    Transform::new(map).unwrap_or(Transform::IDENTITY)
}
