//! From points as read to a mesh in metres about its own centre.

use std::collections::HashMap;
use std::fmt;

use glam::{DMat3, DVec3, Vec3};
use luxel_sdk::kind::TriangleMesh;
use luxel_sdk::num::Bounds3;
use luxel_sdk::params::BuildContext;

use super::Shading;
use crate::stop::wanted;

/// Most points of a mesh: more than the corners of as many triangles as a mesh may have, and every
/// place among them fits 32 bits.
pub(super) const MOST_POINTS: u32 = 1 << 31;

/// Refuses more points than a mesh may have; from a header, before any is read.
pub(super) fn check_n_points(n: usize) -> Result<(), String> {
    if n <= MOST_POINTS as usize {
        return Ok(());
    }
    Err(format!("{n} points in one mesh, at most {MOST_POINTS} may be"))
}

/// How points of a file become points of the shape: turned, and scaled to metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// A rotation by quarter turns.
    pub(super) turn: DMat3,
    /// Metres per unit.
    pub(super) unit: f64,
}

impl Axes {
    /// Of points that are in metres with +Y up already.
    pub(super) const METRES: Self = Self { turn: DMat3::IDENTITY, unit: 1.0 };

    /// A point of the file in the frame of the shape.
    pub(super) fn point(self, p: DVec3) -> DVec3 {
        self.turn * (p * self.unit)
    }

    /// Rebases points about the centre of their bounds, subtracted before anything rounds to
    /// single precision. Walks over them twice and keeps only the result.
    ///
    /// # Errors
    /// The first point that is not finite; where single precision does not reach from the centre
    /// to all, the point farthest out.
    pub(super) fn rebase<I>(self, points: I) -> Result<TriangleMesh, BadPoint>
    where
        I: Iterator<Item = DVec3> + Clone,
    {
        let mut bounds = Bounds3::EMPTY;
        for (i, p) in points.clone().enumerate() {
            if !p.is_finite() {
                return Err(BadPoint {
                    i,
                    p,
                    what: "has a coordinate that is not a finite number",
                });
            }
            bounds = Bounds3 { min: bounds.min.min(p), max: bounds.max.max(p) };
        }
        let middle = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
        let centre = self.turn * (middle * self.unit);
        let (least, most) = points.size_hint();
        let mut out = Vec::with_capacity(most.unwrap_or(least));
        for (i, p) in points.clone().enumerate() {
            let local = (self.turn * ((p - middle) * self.unit)).as_vec3();
            if !(local.is_finite() && centre.is_finite()) {
                return Err(farthest(points).unwrap_or(BadPoint { i, p, what: TOO_FAR }));
            }
            out.push(local);
        }
        Ok(TriangleMesh { centre, points: out, ..TriangleMesh::default() })
    }

    /// Turns a normal and makes it unit; zero where it has no direction.
    pub(super) fn normal(self, n: Vec3) -> Vec3 {
        if !n.is_finite() {
            return Vec3::ZERO;
        }
        let n = n.as_dvec3();
        (self.turn * n / n.abs().max_element()).try_normalize().unwrap_or(DVec3::ZERO).as_vec3()
    }
}

/// A point that no mesh can hold.
#[derive(Debug)]
pub(super) struct BadPoint {
    /// Which one, counted from 0.
    pub(super) i: usize,
    /// As it was read.
    pub(super) p: DVec3,
    /// What is wrong with it, as the end of a sentence.
    pub(super) what: &'static str,
}

impl fmt::Display for BadPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.p.to_array();
        write!(f, "point {} at ({x:e}, {y:e}, {z:e}) {}", self.i, self.what)
    }
}

impl From<BadPoint> for String {
    fn from(bad: BadPoint) -> Self {
        bad.to_string()
    }
}

/// Single precision ends at 3.4e38.
const TOO_FAR: &str = "is too far out: a mesh reaches less than 3.4e38 m from its centre";

/// The point with the largest coordinate.
fn farthest(points: impl Iterator<Item = DVec3>) -> Option<BadPoint> {
    let size = |p: &DVec3| p.abs().max_element();
    let far = points.enumerate().max_by(|(_, p), (_, q)| size(p).total_cmp(&size(q)));
    far.map(|(i, p)| BadPoint { i, p, what: TOO_FAR })
}

/// Adds a polygon as a fan about its first corner.
pub(super) fn fan(corners: &[u32], out: &mut Vec<[u32; 3]>) {
    if let [first, rest @ ..] = corners {
        out.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }
}

/// Settles the normals, while that is wanted; the number of given ones that had no direction and were
/// made anew.
pub(super) fn finish(
    mesh: &mut TriangleMesh,
    smooth: Shading,
    context: &dyn BuildContext,
) -> usize {
    let made = match smooth {
        Shading::Flat => {
            mesh.normals = Vec::new();
            return 0;
        }
        Shading::Keep => mesh.normals.is_empty(),
        Shading::Smooth => false,
    };
    if made {
        return 0;
    }
    if mesh.normals.is_empty() {
        mesh.normals = vertex_normals(mesh, context);
        return 0;
    }
    let lost = mesh.normals.iter().filter(|n| **n == Vec3::ZERO).count();
    if lost > 0 {
        let made = vertex_normals(mesh, context);
        for (n, made) in mesh.normals.iter_mut().zip(made) {
            *n = if *n == Vec3::ZERO { made } else { *n };
        }
    }
    lost
}

/// The angle between two vectors, accurate however small it is.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// A normal for each point: the mean of its faces' normals, weighted by their angles there. Points
/// at the same place share it, so that seams of textures do not show. Not of all, once that is not
/// wanted any more.
///
/// # Source
/// Thürmer & Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets".
fn vertex_normals(mesh: &TriangleMesh, context: &dyn BuildContext) -> Vec<Vec3> {
    // Adding zero makes −0 the same place as 0.
    let key = |i: u32| (mesh.points[i as usize] + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut sums: HashMap<[u32; 3], DVec3> = HashMap::with_capacity(mesh.points.len());
    for triangle in wanted(&mesh.indices, context) {
        let p = triangle.map(|i| mesh.points[i as usize].as_dvec3());
        let Some(n) = (p[1] - p[0]).cross(p[2] - p[0]).try_normalize() else { continue };
        for k in 0..3 {
            let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            *sums.entry(key(triangle[k])).or_default() += n * angle(a, b);
        }
    }
    let n_points = u32::try_from(mesh.points.len()).expect("readers check the number of points");
    let of = |i| sums.get(&key(i)).and_then(|n| n.try_normalize()).unwrap_or(DVec3::Y).as_vec3();
    wanted(0..n_points, context).map(of).collect()
}
