//! Parallelograms that shine, where their own shape cannot find points evenly: sheared ones.

use glam::{DVec2, DVec3};
use luxel_sdk::kind::{Parallelogram, Shape};
use luxel_sdk::num::{Transform, gamma64};
use luxel_sdk::sampling::SphericalTriangle;

use super::triangle::near;

/// A parallelogram that is found by the solid angle of its two halves.
#[derive(Clone, Copy, Debug)]
pub struct Quad(Parallelogram);

/// What a point of the world sees of it.
pub(super) struct SeenQuad {
    halves: [SphericalTriangle; 2],
    whole: f64,
}

impl Quad {
    /// The parallelogram of a shape in its place. `None` where it is none, or a rectangle in a place
    /// that keeps angles, which the shape finds best.
    pub(in super::super) fn new(shape: &dyn Shape, transform: Option<&Transform>) -> Option<Self> {
        let flat = shape.parallelogram()?;
        let keeps = transform.is_none_or(Transform::is_rigid_or_uniform);
        let right = flat.u.normalize().dot(flat.v.normalize()).abs() <= gamma64(8);
        (!(keeps && right)).then_some(Self(flat))
    }

    /// As a point of the world sees it, from near.
    pub(super) fn seen(&self, transform: Option<&Transform>, from: DVec3) -> Option<SeenQuad> {
        let Parallelogram { centre, u, v } = self.0;
        let corner = centre - 0.5 * (u + v);
        let (corner, u, v) = match transform {
            None => (corner - from, u, v),
            Some(transform) => {
                let to = transform.affine().translation - from;
                (transform.vector(corner) + to, transform.vector(u), transform.vector(v))
            }
        };
        let halves = [near(corner, [u, u + v])?, near(corner, [u + v, v])?];
        Some(SeenQuad { halves, whole: halves[0].solid_angle() + halves[1].solid_angle() })
    }
}

impl SeenQuad {
    /// Density, sr⁻¹.
    pub(super) fn pdf(&self) -> f64 {
        self.whole.recip()
    }

    /// A place on it in edges from its middle, uniform in solid angle; `u` uniform in [0, 1)².
    pub(super) fn sample(&self, [u, v]: [f32; 2]) -> DVec2 {
        let [first, second] = &self.halves;
        let (u, v) = (f64::from(u) * self.whole, f64::from(v));
        let left = u - first.solid_angle();
        let at = if left < 0.0 {
            let at = first.sample([u / first.solid_angle(), v]);
            DVec2::new(at.x + at.y, at.y)
        } else {
            let at = second.sample([left / second.solid_angle(), v]);
            DVec2::new(at.x, at.x + at.y)
        };
        (at - 0.5).clamp(DVec2::splat(-0.5), DVec2::splat(0.5))
    }
}
