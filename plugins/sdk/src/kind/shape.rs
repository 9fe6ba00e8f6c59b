//! Geometry: where rays meet it, and how points on it are chosen.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::num::{Bounds3, Ray, Transform};
use crate::params::Fault;

/// Where a ray met a shape, in the shape's own parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// Ray parameter, in lengths of the ray's direction.
    pub t: f64,
    /// The shape's own coordinates of the point: what `surface` needs to find it again.
    pub at: DVec2,
    /// Which face, for shapes with several. Shapes that are made of others keep there which of them
    /// was met: the fewer bits a shape takes, the deeper it can stand in others.
    pub face: u32,
}

/// A point of a surface, in the frame of the shape.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Surface {
    /// The point, on the surface to within `p_err`.
    pub p: DVec3,
    /// Bound of the absolute error of each coordinate of `p`.
    pub p_err: DVec3,
    /// Geometric normal, unit, to the outside.
    pub ng: DVec3,
    /// Shading normal, unit, on the side of `ng`.
    pub ns: DVec3,
    /// Surface coordinates for textures.
    pub uv: DVec2,
    /// ∂p/∂u, not zero.
    pub dp_du: DVec3,
    /// ∂p/∂v.
    pub dp_dv: DVec3,
}

impl Surface {
    /// The same point in the frame that a transform leads to. A mirroring one turns `dp_dv`, so that
    /// dp/du × dp/dv still points to the side of the normal.
    #[inline(always)]
    #[must_use]
    pub fn carried(&self, transform: &Transform) -> Self {
        let (p, p_err) = transform.point_with_error(self.p, self.p_err);
        let turn = if transform.swaps_handedness() { -1.0 } else { 1.0 };
        Self {
            p,
            p_err,
            ng: transform.normal(self.ng).normalize(),
            ns: transform.normal(self.ns).normalize(),
            uv: self.uv,
            dp_du: transform.vector(self.dp_du),
            dp_dv: transform.vector(self.dp_dv) * turn,
        }
    }
}

/// A sampled point of a surface.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ShapeSample {
    /// The point.
    pub surface: Surface,
    /// Density per area of the shape's own frame, m⁻².
    pub pdf: f64,
}

/// A flat piece between two pairs of parallel edges, in the frame of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Parallelogram {
    /// Its middle.
    pub centre: DVec3,
    /// One edge, from end to end.
    pub u: DVec3,
    /// The other edge, from end to end.
    pub v: DVec3,
}

/// How the shading normal of a surface turns along its coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NormalDerivatives {
    /// ∂ns/∂u of the unit shading normal by the u of `Surface::uv`.
    pub dn_du: DVec3,
    /// ∂ns/∂v.
    pub dn_dv: DVec3,
}

impl NormalDerivatives {
    /// Of a flat surface, whose normal does not turn.
    pub const FLAT: Self = Self { dn_du: DVec3::ZERO, dn_dv: DVec3::ZERO };

    /// The same in the frame that a transform leads to, for the point whose unit shading normal was
    /// `ns` in the frame that it leads from: the derivatives of the normal M⁻ᵀ·ns at unit length. A
    /// mirroring one turns `dn_dv`, as `Surface::carried` turns `dp_dv`.
    #[must_use]
    pub fn carried(&self, ns: DVec3, transform: &Transform) -> Self {
        let normal = transform.normal(ns);
        let length = normal.length();
        let n = normal / length;
        let turned = |d: DVec3| {
            let d = transform.normal(d) / length;
            d - n * n.dot(d)
        };
        let turn = if transform.swaps_handedness() { -1.0 } else { 1.0 };
        Self { dn_du: turned(self.dn_du), dn_dv: turned(self.dn_dv) * turn }
    }
}

/// Triangles that the host takes over: it builds their tree and intersects them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// What `points` are relative to, in the frame of the shape, metres.
    pub centre: DVec3,
    /// Corners, single precision about `centre`.
    pub points: Vec<Vec3>,
    /// Three corners each, counter-clockwise from outside.
    pub indices: Vec<[u32; 3]>,
    /// A unit shading normal per corner point, or empty.
    pub normals: Vec<Vec3>,
    /// Texture coordinates per corner point, or empty.
    pub uvs: Vec<Vec2>,
    /// A colour per corner point, linear sRGB, or empty.
    pub colors: Vec<Vec3>,
    /// Where the corners are later, if they move.
    pub later: Option<Later>,
}

/// Where the corners of a mesh are at a second time. Between the two they move evenly; before the
/// first and after the second they stand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Later {
    /// When they are at the mesh's points, and when at these, which is later: seconds.
    pub times: [f64; 2],
    /// As many as the mesh has, about the same centre.
    pub points: Vec<Vec3>,
    /// As many as the mesh has.
    pub normals: Vec<Vec3>,
}

impl Later {
    /// How far corners have come at a time: from 0 to 1.
    #[expect(clippy::cast_possible_truncation, reason = "rounds; of a share 6e-8 at most")]
    pub fn share(&self, time: f64) -> f32 {
        let [from, to] = self.times;
        ((time - from) / (to - from)).clamp(0.0, 1.0) as f32
    }
}

impl TriangleMesh {
    /// Rebases corners in double precision about the centre of their bounds.
    ///
    /// Non-finite corners are kept as they are, to be reported with their index.
    pub fn rebased(points: &[DVec3], indices: Vec<[u32; 3]>) -> Self {
        let bounds = Bounds3::of_points(points.iter().copied().filter(|p| p.is_finite()));
        let centre = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
        let points = points.iter().map(|p| (*p - centre).as_vec3()).collect();
        Self { centre, points, indices, ..Self::default() }
    }

    /// The corners of a triangle in the frame of the shape, exact in double precision.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.indices[triangle as usize].map(|i| self.centre + self.points[i as usize].as_dvec3())
    }
}

/// Geometry in its own frame, in double precision.
///
/// The host applies the placement: rays arrive in the frame of the shape, and their direction is
/// not unit length where the placement scales.
pub trait Shape: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// A box that holds every point of the surface.
    fn bounds(&self) -> Bounds3;

    /// The nearest hit with `0 < t <= ray.t_max`. A NaN in the ray hits nothing.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;

    /// The point that a hit names.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface;

    /// Area in the frame of the shape, m²; infinite for one that cannot shine: it has no end, or
    /// points of it cannot be chosen at random.
    fn area(&self) -> f64;

    /// A point, `u` uniform in [0, 1)². With `from`, the shape may prefer what is seen from there.
    /// None, and a density of 0, where points cannot be chosen: as a lamp it is found by chance alone.
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let _ = (from, u);
        None
    }

    /// The density with which `sample` finds this point of the surface, m⁻².
    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        let _ = (from, at);
        0.0
    }

    /// Whether the surface encloses a volume.
    fn is_closed(&self) -> bool {
        false
    }

    /// Triangles for the host to take over. Then no other method but `bounds` is called.
    fn mesh(&self) -> Option<Arc<TriangleMesh>> {
        None
    }

    /// How many parts it consists of: the host builds a tree over their boxes and asks only for those
    /// that a ray enters, so that a shape of thousands of strands costs what one does. 0 for a shape
    /// that is all in one; `intersect` meets all of them in either case.
    fn parts(&self) -> u32 {
        0
    }

    /// A box that holds every point of a part, counted from 0.
    fn part_bounds(&self, part: u32) -> Bounds3 {
        let _ = part;
        Bounds3::EMPTY
    }

    /// The nearest hit of one part, as `intersect` finds that of all. `surface` is to find the point
    /// by the hit alone, which may be of any part.
    fn intersect_part(&self, part: u32, ray: &Ray) -> Option<Hit> {
        let _ = (part, ray);
        None
    }

    /// At least how far away the surface of a closed shape is from a point, metres: negative inside.
    ///
    /// It vanishes on the surface alone and changes by no more than the way between two points:
    /// |f(p) − f(q)| ≤ |p − q|. It is found to within `gamma64(64)` of the largest coordinate of the
    /// point and of the bounds. `None` where the shape knows no such function, at any point.
    fn distance(&self, p: DVec3) -> Option<f64> {
        let _ = p;
        None
    }

    /// The parallelogram that it is, where it is nothing else. `surface` then finds, by the hit alone
    /// and for any place, the point `centre + at.x·u + at.y·v` with `at` in [−½, ½]²: of a lamp that
    /// shears in its placement, the host chooses points so that light is found evenly.
    fn parallelogram(&self) -> Option<Parallelogram> {
        None
    }

    /// How the shading normal turns at a point that `surface` found by this hit, in the shape's frame.
    ///
    /// Exact to rounding, or of a normal that comes from differences to a millionth; finite. `None`
    /// where the shape does not know it, or where the normal has no derivative, as at an apex.
    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let _ = (hit, at);
        None
    }
}
