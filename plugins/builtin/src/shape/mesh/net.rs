//! Triangles that share places, however their corners differ otherwise.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::kind::TriangleMesh;
use luxel_sdk::params::BuildContext;

use super::rebased;
use crate::stop::{gather, wanted};

/// Most triangles that subdivision and displacement make: about a gigabyte while they are made.
pub(super) const MOST_TRIANGLES: u64 = 1 << 23;

/// Triangles between places in double precision. Corners at one place share it, so no seam of
/// texture coordinates or of normals can become a crack.
#[derive(Clone, Debug, Default)]
pub(super) struct Net {
    /// In the frame of the shape, metres.
    pub(super) places: Vec<DVec3>,
    /// Three places each.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Three for each triangle, or none.
    pub(super) uvs: Vec<Vec2>,
    /// Three for each triangle, or none.
    pub(super) normals: Vec<Vec3>,
    /// Three for each triangle, linear sRGB, or none.
    pub(super) colors: Vec<Vec3>,
}

impl Net {
    /// The normal of a triangle; zero if it has no area.
    pub(super) fn face_normal(&self, triangle: [u32; 3]) -> DVec3 {
        let [a, b, c] = triangle.map(|i| self.places[i as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// A mesh about its own centre: a corner point for each place and what its corners carry, or,
    /// `apart`, for each corner, whatever it shares with others at this moment.
    ///
    /// # Errors
    /// A place that single precision does not reach. That it is not wanted any more.
    pub(super) fn into_mesh(
        self,
        apart: bool,
        context: &dyn BuildContext,
    ) -> Result<TriangleMesh, String> {
        let mut known = HashMap::with_capacity(self.places.len());
        let (mut first, mut indices) = (vec![], Vec::with_capacity(self.triangles.len()));
        for (i, triangle) in wanted(self.triangles.iter().enumerate(), context) {
            let mut corners = [0; 3];
            for k in 0..3 {
                let corner = 3 * i + k;
                let uv = self.uvs.get(corner).map(|uv| uv.to_array().map(f32::to_bits));
                let normal = self.normals.get(corner).map(|n| n.to_array().map(f32::to_bits));
                let color = self.colors.get(corner).map(|c| c.to_array().map(f32::to_bits));
                let own = apart.then_some(corner);
                let key = (triangle[k], uv, normal, color, own);
                corners[k] = *known.entry(key).or_insert_with(|| {
                    first.push(corner);
                    u32::try_from(first.len() - 1).expect("three corners of so many triangles")
                });
            }
            indices.push(corners);
        }
        drop(known);
        let place = |corner: &usize| self.places[self.triangles[corner / 3][corner % 3] as usize];
        let mesh = rebased(first.iter().map(place), context)?;
        let uvs = all(&first, &self.uvs, context)?;
        let normals = all(&first, &self.normals, context)?;
        let colors = all(&first, &self.colors, context)?;
        Ok(TriangleMesh { indices, uvs, normals, colors, ..mesh })
    }
}

/// The values of these corners, if there are any.
fn all<T: Copy>(
    corners: &[usize],
    values: &[T],
    context: &dyn BuildContext,
) -> Result<Vec<T>, String> {
    if values.is_empty() {
        return Ok(vec![]);
    }
    gather(corners.iter().map(|i| values[*i]), context)
}
