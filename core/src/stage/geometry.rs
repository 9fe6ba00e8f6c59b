//! Geometry in its own frame: analytic shapes, and meshes with their tree.

mod chart;
mod part;
#[cfg(test)]
mod tests;

use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3, Vec3};
use luxel_sdk::kind::{Hit, Later, Surface, TriangleMesh};
use luxel_sdk::num::{Bounds3, Ray, gamma32, gamma64, unit_and_length};

use self::chart::parametrisation;
use super::analytic::Analytic;
use super::closed::is_closed;
use crate::accel::{
    Begun, BuildError, Direction, MeshBvh, MeshHit, Precision, Processor, Query, Watch,
};
use crate::cast::index;

pub(super) use chart::by_coordinates;
pub(super) use part::mesh_part;

/// What a placement places. Shared by every placement of the same shape.
#[derive(Debug)]
pub enum Geometry {
    /// A shape that intersects itself, in double precision.
    Analytic(Analytic),
    /// Triangles and their tree.
    Mesh(Arc<Mesh>),
}

/// How a ray comes to a geometry, in its frame.
#[derive(Clone, Copy, Debug)]
pub struct Approach<'a> {
    /// Whose instructions are used.
    pub processor: Processor,
    /// How triangles are met.
    pub precision: Precision,
    /// The ray's direction; `None` if it cannot be made ready, and meshes are missed.
    pub direction: Option<&'a Direction>,
    /// Where the ray enters the box.
    pub t_enter: f64,
    /// The triangle that it leaves, if it starts on one.
    pub from: Option<u32>,
    /// When, in seconds.
    pub time: f64,
}

/// Most triangles behind its origin that a ray passes; what it then meets counts.
const MOST_BEHIND: u32 = 7;

/// What a ray that was traced through a mesh's tree has met.
pub(super) enum Landed {
    Nowhere,
    At(Hit),
    /// A triangle that double precision finds behind the ray's origin: the ray is taken up there, and
    /// passes it.
    Behind(Taken, u32),
}

/// Where a ray is taken up, and how many triangles behind its origin it may still pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taken {
    start: f64,
    left: u32,
}

/// A mesh with its tree.
#[derive(Debug)]
pub struct Mesh {
    triangles: Arc<TriangleMesh>,
    bvh: MeshBvh,
    /// The interval of time in which it is met, seconds.
    during: [f64; 2],
    /// Whether every edge joins exactly two triangles that run along it in opposite directions:
    /// found when first asked for, which only scenes with media do.
    closed: OnceLock<bool>,
    /// What the tree's points are relative to, in the mesh's frame.
    centre: DVec3,
    /// Diagonal of the tree's box, metres of the mesh's frame.
    diagonal: f64,
    /// What is nearer than this may lie behind a ray's origin by rounding: `NEAR` diagonals.
    near: f64,
}

/// More than the error of a point in single precision about the centre of a mesh, in its diagonals.
const NEAR: f64 = 1.0 / (1u64 << 20) as f64;

impl Mesh {
    /// Takes over the triangles of a shape and builds their tree, for an interval of time in seconds.
    ///
    /// # Errors
    /// What is wrong with the triangles; that the watch was cancelled.
    pub fn build(
        triangles: Arc<TriangleMesh>,
        during: [f64; 2],
        watch: &Watch,
    ) -> Result<Self, BuildError> {
        let bvh = match &triangles.later {
            None => MeshBvh::build_watched(&triangles.points, &triangles.indices, watch)?,
            Some(later) => {
                let points = (&*triangles.points, &*later.points);
                let shares = during.map(|time| later.share(time));
                MeshBvh::build_moving(points, &triangles.indices, shares, watch)?
            }
        };
        let diagonal = bvh.bounds().map_or(0.0, |(min, max)| (max - min).as_dvec3().length());
        let centre = triangles.centre;
        let near = diagonal * NEAR;
        Ok(Self { triangles, bvh, during, closed: OnceLock::new(), centre, diagonal, near })
    }

    /// Whether its points move while the shutter is open.
    pub(super) fn is_moving(&self) -> bool {
        let [open, close] = self.during.map(|time| self.share(time));
        open < close
    }

    /// The corner points of a triangle.
    #[inline(always)]
    pub(super) fn indices(&self, triangle: u32) -> [usize; 3] {
        let [a, b, c] = self.triangles.indices[triangle as usize];
        [a as usize, b as usize, c as usize]
    }

    /// The triangles.
    pub fn triangles(&self) -> &TriangleMesh {
        &self.triangles
    }

    /// Triangles without area that were left out of the tree.
    pub fn dropped(&self) -> usize {
        self.bvh.dropped()
    }

    /// Bytes of the tree.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes()
    }

    /// Bytes of the tree and the triangles.
    pub(super) fn whole_bytes(&self) -> usize {
        let TriangleMesh { points, indices, normals, uvs, colors, later, .. } = &*self.triangles;
        let vectors = |all: &[Vec3]| size_of_val(all);
        let later = later.as_ref();
        let later = later.map_or(0, |later| vectors(&later.points) + vectors(&later.normals));
        let triangles = size_of_val(&**indices) + size_of_val(&**uvs) + later;
        self.bytes()
            + [points, normals, colors].map(|all| vectors(all)).iter().sum::<usize>()
            + triangles
    }

    /// How far its points have come at a time, from 0 to 1.
    #[inline(always)]
    fn share(&self, time: f64) -> f32 {
        self.triangles.later.as_ref().map_or(0.0, |later| later.share(time))
    }

    /// The corners of a triangle at a time, about the centre: as the tree has them, to the bit.
    #[inline(always)]
    pub(super) fn corners(&self, corners: [usize; 3], time: f64) -> [DVec3; 3] {
        self.moved(&self.triangles.points, |later| &later.points, corners, time)
    }

    /// The normals at its corners at a time, unit where the mesh stands.
    #[inline(always)]
    pub(super) fn normals(&self, corners: [usize; 3], time: f64) -> [DVec3; 3] {
        self.moved(&self.triangles.normals, |later| &later.normals, corners, time)
    }

    /// What three corners have at a time, of two lists with one for each corner.
    #[inline(always)]
    fn moved(
        &self,
        first: &[Vec3],
        last: impl Fn(&Later) -> &[Vec3],
        [a, b, c]: [usize; 3],
        time: f64,
    ) -> [DVec3; 3] {
        match &self.triangles.later {
            None => [first[a].as_dvec3(), first[b].as_dvec3(), first[c].as_dvec3()],
            Some(later) => between(first, last(later), [a, b, c], later.share(time)),
        }
    }

    /// Where a ray that enters the box at `t_enter` is taken up: a diagonal before, so that little is
    /// lost by rounding, and triangles on the box's faces stay ahead however their distance is
    /// rounded.
    #[inline(always)]
    pub(super) fn take_up(&self, direction: &Direction, t_enter: f64) -> Taken {
        let start = (t_enter - self.diagonal * direction.per_scale()).max(0.0);
        Taken { start, left: MOST_BEHIND }
    }

    /// What is asked of the tree about a ray that is taken up there.
    #[inline(always)]
    fn query<'a, const ANY: bool>(
        &self,
        ray: &Ray,
        approach: &Approach<'_>,
        direction: &'a Direction,
        taken: Taken,
    ) -> Query<'a> {
        let o = ray.at(taken.start) - self.centre;
        let t_max = (ray.t_max - taken.start) * direction.scale();
        // What single precision rounds stays beyond the end where `land` looks again, else before it:
        // a ray ends short of the lamp that it is sent to.
        let t_max = match (approach.precision, ANY) {
            (Precision::Exact, _) => t_max,
            (_, true) => t_max * (1.0 - f64::from(f32::EPSILON)),
            (_, false) => t_max * (1.0 + f64::from(f32::EPSILON)),
        };
        let (skip, precision, share) =
            (approach.from, approach.precision, self.share(approach.time));
        Query { o, direction, t_max, skip, precision, share }
    }

    /// The nearest hit. A ray that leaves this mesh may seem to meet a sliver beside the triangle
    /// that it leaves, by rounding: what double precision finds behind the origin is passed, and what
    /// else lies there is left to double precision.
    #[inline(always)]
    pub(super) fn intersect(
        &self,
        ray: &Ray,
        mut approach: Approach<'_>,
        steps: &mut u32,
    ) -> Option<Hit> {
        let direction = approach.direction?;
        let mut taken = self.take_up(direction, approach.t_enter);
        loop {
            let query = self.query::<false>(ray, &approach, direction, taken);
            let (hit, n) = self.bvh.intersect(approach.processor, &query);
            *steps += n;
            match self.land(ray, &approach, taken, hit) {
                Landed::Behind(next, triangle) if approach.precision == Precision::Exact => {
                    (taken, approach.from) = (next, Some(triangle));
                }
                Landed::Behind(..) => approach.precision = Precision::Exact,
                Landed::Nowhere => return None,
                Landed::At(hit) => return Some(hit),
            }
        }
    }

    /// What a hit of the tree means for a ray that was taken up there.
    #[inline(always)]
    pub(super) fn land(
        &self,
        ray: &Ray,
        approach: &Approach<'_>,
        taken: Taken,
        hit: Option<MeshHit>,
    ) -> Landed {
        let (Some(hit), Some(direction)) = (hit, approach.direction) else {
            return Landed::Nowhere;
        };
        let t = taken.start + hit.t * direction.per_scale();
        let near = approach.from.is_some() || t <= self.near * direction.per_scale();
        if near && taken.left > 0 && self.is_behind(hit.triangle, ray, approach.time) {
            return Landed::Behind(Taken { start: t, left: taken.left - 1 }, hit.triangle);
        }
        let at = DVec2::new(hit.b1, hit.b2);
        if t <= ray.t_max { Landed::At(Hit { t, at, face: hit.triangle }) } else { Landed::Nowhere }
    }

    /// Sets out through the tree.
    #[inline(always)]
    pub(super) fn begin<const ANY: bool>(
        &self,
        ray: &Ray,
        approach: &Approach<'_>,
        taken: Taken,
    ) -> Begun<'_> {
        let Some(direction) = approach.direction else { return Begun::Over(None, 0) };
        self.bvh.begin::<ANY>(&self.query::<ANY>(ray, approach, direction, taken))
    }

    #[inline(always)]
    fn occluded(&self, ray: &Ray, approach: Approach<'_>) -> bool {
        let Some(direction) = approach.direction else { return false };
        let taken = self.take_up(direction, approach.t_enter);
        let query = self.query::<true>(ray, &approach, direction, taken);
        self.bvh.occluded(approach.processor, &query)
            && (approach.from.is_none() || self.intersect(ray, approach, &mut 0).is_some())
    }

    /// Whether the plane of a triangle lies behind the origin of a ray, in double precision. Asked for
    /// few rays, so it stays out of the copies for each processor.
    #[inline(never)]
    fn is_behind(&self, triangle: u32, ray: &Ray, time: f64) -> bool {
        let [a, b, c] = self.corners(self.indices(triangle), time);
        let normal = (b - a).cross(c - a);
        normal.dot(a + self.centre - ray.o) * normal.dot(ray.d) <= 0.0
    }

    /// The point of a triangle with barycentrics `at` of its second and third corner, at a time in
    /// seconds.
    #[inline(always)]
    pub fn surface(&self, triangle: u32, at: DVec2, precision: Precision, time: f64) -> Surface {
        let (mesh, corners) = (self.triangles(), self.indices(triangle));
        let [a, b, c] = self.corners(corners, time);
        let weights = [1.0 - at.x - at.y, at.x, at.y];
        let about = a * weights[0] + b * weights[1] + c * weights[2];
        // The next ray's origin is rounded to single precision about the centre: γ(7) covers the
        // sum of three products and that rounding (PBR4 §6.8.5). The triangle test shears all axes
        // into each other, so each axis takes the error of the largest: a plane through the centre
        // has none of its own, and rays would meet the triangle that they leave. In double precision
        // the point rounds five times and the test shifts corners by 7u·(|o| + |p|) on either side
        // of it: γ(19). What is far from the frame's origin rounds on the way to the centre and back,
        // and as the ray is taken up: γ(4).
        let spread =
            a.abs() * weights[0].abs() + b.abs() * weights[1].abs() + c.abs() * weights[2].abs();
        let p = about + mesh.centre;
        let p_err = match precision {
            Precision::Exact => DVec3::splat(
                spread.max_element() * gamma64(19) + p.abs().max_element() * gamma64(4),
            ),
            _ => spread.max_element() * f64::from(gamma32(7)) + p.abs() * f64::EPSILON,
        };
        let (ng, _) = unit_and_length((b - a).cross(c - a));
        let ng = if ng.is_nan() { DVec3::Z } else { ng };
        let ns = self.shading_normal(corners, weights, ng, time);
        let (uv, dp_du, dp_dv) = parametrisation(mesh, corners, [a, b, c], weights);
        Surface { p, p_err, ng, ns, uv, dp_du, dp_dv }
    }
}

impl Mesh {
    /// From a point of a triangle to the smooth surface that its normals speak of: the mean of the
    /// point's projections onto the planes at the corners, as far as they lie beyond the triangle on
    /// the side that is looked at.
    ///
    /// # Source
    /// Hanika 2021, Hacking the Shadow Terminator (Ray Tracing Gems II, ch. 4).
    pub fn lift(&self, triangle: u32, at: DVec2, outside: bool, time: f64) -> DVec3 {
        if self.triangles.normals.is_empty() {
            return DVec3::ZERO;
        }
        let corners = self.indices(triangle);
        let [a, b, c] = self.corners(corners, time);
        let normals = self
            .normals(corners, time)
            .map(|n| if self.triangles.later.is_some() { n.normalize_or_zero() } else { n });
        let weights = [1.0 - at.x - at.y, at.x, at.y];
        let p = a * weights[0] + b * weights[1] + c * weights[2];
        let ng = (b - a).cross(c - a);
        let mut lift = DVec3::ZERO;
        for ((corner, n), weight) in [a, b, c].into_iter().zip(normals).zip(weights) {
            let n = if (n.dot(ng) > 0.0) == outside { n } else { -n };
            lift -= n * (weight * (p - corner).dot(n).min(0.0));
        }
        lift
    }

    #[inline(always)]
    fn shading_normal(&self, corners: [usize; 3], w: [f64; 3], ng: DVec3, time: f64) -> DVec3 {
        if self.triangles.normals.is_empty() {
            return ng;
        }
        let [a, b, c] = self.normals(corners, time);
        let ns = (a * w[0] + b * w[1] + c * w[2]).normalize_or(ng);
        if ns.dot(ng) < 0.0 { -ns } else { ns }
    }

    /// The corners of a triangle in the frame of the shape, when the shutter opens.
    pub fn opening_corners(&self, triangle: u32) -> [DVec3; 3] {
        self.corners(self.indices(triangle), self.during[0]).map(|p| self.centre + p)
    }

    /// The area of a triangle at a time in the frame that `edge` carries its edges to.
    pub(super) fn area(&self, triangle: u32, time: f64, edge: impl Fn(DVec3) -> DVec3) -> f64 {
        let [a, b, c] = self.corners(self.indices(triangle), time);
        edge(b - a).cross(edge(c - a)).length() / 2.0
    }

    /// The mean of the corners' colours, linear sRGB, if they have any; `at` as in `surface`.
    pub fn color(&self, triangle: u32, at: DVec2) -> Option<Vec3> {
        let mesh = self.triangles();
        if mesh.colors.is_empty() {
            return None;
        }
        let [a, b, c] = mesh.indices[triangle as usize].map(|i| mesh.colors[i as usize]);
        let at = at.as_vec2();
        Some(a * (1.0 - at.x - at.y) + b * at.x + c * at.y)
    }
}

/// Three of `first` on their way to `last`. Apart: it would take registers from meshes that stand.
#[inline(never)]
fn between(first: &[Vec3], last: &[Vec3], corners: [usize; 3], share: f32) -> [DVec3; 3] {
    corners.map(|i| (first[i] + (last[i] - first[i]) * share).as_dvec3())
}

/// Where a ray enters a box, or a little before; `None` where it passes.
pub(super) fn enter(bounds: &Bounds3, ray: &Ray) -> Option<f64> {
    let found = bounds.intersect_ray(ray.o, ray.d.recip(), f64::INFINITY);
    // A difference and a product, by a rounded inverse.
    found.map(|(near, _)| near / (1.0 + gamma64(4)))
}

impl Geometry {
    /// A box that holds every point, in the geometry's frame.
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Analytic(shape) => shape.object().fixed().shape().bounds(),
            Self::Mesh(mesh) => match mesh.bvh.bounds() {
                Some((min, max)) => {
                    let centre = mesh.centre;
                    let widen = |p: DVec3, towards: f64| {
                        p + centre + (p.abs() + centre.abs()) * (towards * f64::EPSILON)
                    };
                    Bounds3 { min: widen(min.as_dvec3(), -1.0), max: widen(max.as_dvec3(), 1.0) }
                }
                None => Bounds3::EMPTY,
            },
        }
    }

    /// A box that holds every point when the shutter opens.
    pub(super) fn opening_bounds(&self) -> Bounds3 {
        match self {
            Self::Mesh(mesh) if mesh.is_moving() => {
                let triangles = 0..index(mesh.triangles.indices.len());
                Bounds3::of_points(triangles.flat_map(|i| mesh.opening_corners(i)))
            }
            _ => self.bounds(),
        }
    }

    /// Whether its points move while the shutter is open.
    pub fn is_moving(&self) -> bool {
        match self {
            Self::Analytic(_) => false,
            Self::Mesh(mesh) => mesh.is_moving(),
        }
    }

    /// Whether it is ready for an interval of time.
    pub(super) fn is_of(&self, during: [f64; 2]) -> bool {
        match self {
            Self::Mesh(mesh) if mesh.triangles.later.is_some() => {
                mesh.during.map(f64::to_bits) == during.map(f64::to_bits)
            }
            _ => true,
        }
    }

    /// Whether it encloses a volume.
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Analytic(shape) => shape.object().fixed().shape().is_closed(),
            Self::Mesh(mesh) => *mesh.closed.get_or_init(|| is_closed(mesh.triangles())),
        }
    }

    /// The nearest hit of a ray in the geometry's frame.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray, approach: Approach<'_>, steps: &mut u32) -> Option<Hit> {
        match self {
            Self::Analytic(shape) => shape.intersect(ray, approach.processor, steps),
            Self::Mesh(mesh) => mesh.intersect(ray, approach, steps),
        }
    }

    /// Whether anything is hit.
    #[inline(always)]
    pub fn occluded(&self, ray: &Ray, approach: Approach<'_>) -> bool {
        match self {
            Self::Analytic(shape) => shape.occluded(ray, approach.processor),
            Self::Mesh(mesh) => mesh.occluded(ray, approach),
        }
    }

    /// The point that a hit names, in the geometry's frame.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &Hit, precision: Precision, time: f64) -> Surface {
        match self {
            Self::Analytic(shape) => shape.object().fixed().shape().surface(ray, hit),
            Self::Mesh(mesh) => mesh.surface(hit.face, hit.at, precision, time),
        }
    }
}
