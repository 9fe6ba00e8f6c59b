//! Triangles of shining meshes, as the points of the world see them that they light.

use glam::{DVec2, DVec3};
use luxel_sdk::num::Transform;
use luxel_sdk::sampling::{Alias, SphericalTriangle, uniform_triangle};

use super::super::geometry::Mesh;
use crate::cast::index;

/// Square of the longest edge over the squared distance from which on a triangle is sampled by its
/// solid angle. Below, its points look so alike that samples of the area are off by an eighth, and
/// what else is random in a path hides that, while the angles take a fifth of a path's time.
const NEAR: f64 = 0.5;

/// Most triangles of a mesh whose solid angles are all found, to choose by them.
const FEW: usize = 4;

/// A shining mesh and the point of the world that it lights.
pub(super) struct Lit<'a> {
    pub(super) mesh: &'a Mesh,
    /// How a triangle is chosen by its area in the world.
    pub(super) choice: &'a Alias,
    /// From the mesh's frame to the world.
    pub(super) transform: Option<&'a Transform>,
    /// The point.
    pub(super) from: DVec3,
    /// When, seconds.
    pub(super) time: f64,
}

/// A point of a mesh that was chosen.
pub(super) struct Point {
    pub(super) triangle: u32,
    /// Barycentrics of the triangle's second and third corner.
    pub(super) at: DVec2,
    /// Density per solid angle, sr⁻¹; `None` where it follows from the mesh's area.
    pub(super) pdf: Option<f64>,
}

impl Lit<'_> {
    /// Chooses a triangle and a point of it: few triangles, and the points of those that are near, by
    /// their solid angle, others by their area. `u` uniform in [0, 1), as the last number.
    #[inline]
    pub(super) fn sample(&self, u: [f32; 2], choose: f64) -> Point {
        if let Some((few, whole)) = self.few() {
            let mut left = choose * whole;
            // What rounds beyond the last belongs to it.
            let mut chosen = None;
            for (triangle, seen) in few.iter().enumerate() {
                let Some(seen) = seen else { continue };
                chosen = Some((triangle, seen));
                left -= seen.solid_angle();
                if left < 0.0 {
                    break;
                }
            }
            if let Some((triangle, seen)) = chosen {
                let at = seen.sample(u.map(f64::from));
                return Point { triangle: index(triangle), at, pdf: Some(whole.recip()) };
            }
        }
        let drawn = self.choice.sample(choose);
        let triangle = index(drawn.index);
        let seen = self.near(triangle);
        let at = seen.map_or_else(|| spread(u), |seen| seen.sample(u.map(f64::from)));
        Point { triangle, at, pdf: seen.map(|seen| drawn.pmf / seen.solid_angle()) }
    }

    /// The density with which `sample` finds a point of this triangle, as it says it.
    #[inline]
    pub(super) fn pdf(&self, triangle: u32) -> Option<f64> {
        let chance = self.choice.pmf(triangle as usize);
        if chance <= 0.0 {
            return Some(0.0);
        }
        if let Some((_, whole)) = self.few() {
            return Some(whole.recip());
        }
        self.near(triangle).map(|seen| chance / seen.solid_angle())
    }

    /// All triangles of a mesh that has few, where every one that has an area is near, and their
    /// solid angle.
    #[inline]
    fn few(&self) -> Option<([Option<SphericalTriangle>; FEW], f64)> {
        let n = self.choice.n_bins();
        if n > FEW {
            return None;
        }
        let (mut few, mut whole) = ([None; FEW], 0.0);
        for (i, place) in few.iter_mut().enumerate().take(n) {
            if self.choice.pmf(i) > 0.0 {
                let seen = self.near(index(i))?;
                whole += seen.solid_angle();
                *place = Some(seen);
            }
        }
        Some((few, whole))
    }

    /// A triangle that goes by its solid angle.
    #[inline]
    fn near(&self, triangle: u32) -> Option<SphericalTriangle> {
        let [a, b, c] = self.mesh.corners(self.mesh.indices(triangle), self.time);
        let centre = self.mesh.triangles().centre;
        // Edges are exact in the mesh's frame, and what both the mesh and the point are far by goes
        // before it can round.
        let ([x, y], a) = match self.transform {
            None => ([b - a, c - a], a + (centre - self.from)),
            Some(transform) => {
                let to = transform.affine().translation - self.from;
                let edges = [transform.vector(b - a), transform.vector(c - a)];
                (edges, transform.vector(a) + (transform.vector(centre) + to))
            }
        };
        near(a, [x, y])
    }
}

/// A triangle by its first corner from a point and its edges from there, if it is near enough, and
/// far enough from being edge-on, to go by its solid angle.
#[inline]
pub(super) fn near(a: DVec3, [x, y]: [DVec3; 2]) -> Option<SphericalTriangle> {
    let longest = x.length_squared().max(y.length_squared()).max((y - x).length_squared());
    let middle = a + (x + y) * (1.0 / 3.0);
    if longest < NEAR * middle.length_squared() {
        return None;
    }
    SphericalTriangle::new(a, [x, y])
}

/// Barycentrics of the second and the third corner, alike over the area.
fn spread(u: [f32; 2]) -> DVec2 {
    let [_, b, c] = uniform_triangle(u).map(f64::from);
    DVec2::new(b, c)
}
