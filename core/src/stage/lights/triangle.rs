//! Triangles of shining meshes, as the points of the world see them that they light.

use glam::{DVec2, DVec3};
use luxel_sdk::num::{Bounds3, Transform};
use luxel_sdk::sampling::{Alias, SphericalTriangle, uniform_triangle};

use super::super::geometry::Mesh;
use crate::cast::index;

/// Square of the longest edge over the squared distance from which on a triangle is sampled by its
/// solid angle. Below, its points look so alike that samples of the area are off by an eighth, and
/// what else is random in a path hides that, while the angles take a fifth of a path's time.
const NEAR: f64 = 0.5;

/// Most triangles of a mesh whose solid angles are all found, to choose by them.
const FEW: usize = 4;

/// The triangles of a shining mesh.
#[derive(Debug)]
pub struct Facets {
    /// How one is chosen, by its area in the world: of one that moves the mean over the shutter.
    pub(super) choice: Alias,
    /// Of a mesh that stands: a point of the world, and the square of a distance from there beyond
    /// which no point is near a triangle.
    near: Option<(DVec3, f64)>,
}

impl Facets {
    /// Of a mesh whose triangles are chosen so, and whose corners in the world are these if it stands.
    pub(in super::super) fn new(choice: Alias, corners: Option<&[[DVec3; 3]]>) -> Self {
        let near = corners.map(|triangles| {
            let all = Bounds3::of_points(triangles.iter().flatten().copied());
            let longest2 = |[a, b, c]: &[DVec3; 3]| {
                let edges = [*b - *a, *c - *b, *a - *c];
                edges.map(DVec3::length_squared).into_iter().fold(0.0, f64::max)
            };
            let longest = triangles.iter().map(longest2).fold(0.0, f64::max).sqrt();
            // As far as the middle of a triangle may be from where `near` still takes it.
            let reach = all.diagonal().length() / 2.0 + longest / NEAR.sqrt();
            (all.centre(), reach * reach * (1.0 + 1e-9))
        });
        Self { choice, near }
    }

    /// Whether a point is too far away for any triangle to go by its solid angle.
    #[inline(always)]
    fn are_far(&self, from: DVec3) -> bool {
        self.near.is_some_and(|(centre, reach2)| from.distance_squared(centre) > reach2)
    }
}

/// A shining mesh and the point of the world that it lights.
pub(super) struct Lit<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) facets: &'a Facets,
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
        let far = self.facets.are_far(self.from);
        if !far && let Some((few, whole)) = self.few() {
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
        let drawn = self.facets.choice.sample(choose);
        let triangle = index(drawn.index);
        let seen = if far { None } else { self.near(triangle) };
        let at = seen.map_or_else(|| spread(u), |seen| seen.sample(u.map(f64::from)));
        Point { triangle, at, pdf: seen.map(|seen| drawn.pmf / seen.solid_angle()) }
    }

    /// The density with which `sample` finds a point of this triangle, as it says it.
    #[inline]
    pub(super) fn pdf(&self, triangle: u32) -> Option<f64> {
        if self.facets.are_far(self.from) {
            return None;
        }
        let chance = self.facets.choice.pmf(triangle as usize);
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
        let n = self.facets.choice.n_bins();
        if n > FEW {
            return None;
        }
        let (mut few, mut whole) = ([None; FEW], 0.0);
        for (i, place) in few.iter_mut().enumerate().take(n) {
            if self.facets.choice.pmf(i) > 0.0 {
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
