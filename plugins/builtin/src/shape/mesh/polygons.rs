//! Faces of any number of corners, before they are subdivided or displaced.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

use luxel_sdk::params::BuildContext;

use super::net::Net;
use crate::stop::{gather, go_on, wanted};

/// Faces of a mesh as they were given.
#[derive(Clone, Debug, Default)]
pub(super) struct Polygons {
    /// In the frame of the shape, metres.
    pub(super) points: Vec<DVec3>,
    /// Where each face's corners begin, and behind the last where they end.
    pub(super) starts: Vec<u32>,
    /// Of each corner its place in `points`.
    pub(super) corners: Vec<u32>,
    /// Of each corner, or none.
    pub(super) uvs: Vec<Vec2>,
    /// Of each corner, or none; zero where there is none for it.
    pub(super) normals: Vec<Vec3>,
    /// Of each corner, linear sRGB, or none.
    pub(super) colors: Vec<Vec3>,
    /// Which point each has become when points at the same place were made one, if they were.
    pub(super) same: Vec<u32>,
}

impl Polygons {
    /// The number of faces.
    pub(super) fn n_faces(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Gives each corner what its point has.
    pub(super) fn spread<T: Copy>(&self, of_points: &[T]) -> Vec<T> {
        if of_points.is_empty() {
            return vec![];
        }
        self.corners.iter().map(|i| of_points[*i as usize]).collect()
    }

    /// Makes points at the same place one: where each point has coordinates of its own, seams of
    /// these have torn the surface apart.
    ///
    /// # Errors
    /// If it is not wanted any more.
    pub(super) fn weld(&mut self, context: &dyn BuildContext) -> Result<(), String> {
        // Adding zero makes −0 the same place as 0.
        let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let mut first = HashMap::with_capacity(self.points.len());
        let points = (0..).zip(&self.points);
        self.same = gather(points.map(|(i, p)| *first.entry(key(*p)).or_insert(i)), context)?;
        for corner in wanted(&mut self.corners, context) {
            *corner = self.same[*corner as usize];
        }
        go_on(context)
    }

    /// Drops corners that repeat the one before, and faces with fewer than three that are left.
    ///
    /// # Errors
    /// If it is not wanted any more.
    pub(super) fn clean(self, context: &dyn BuildContext) -> Result<Self, String> {
        let mut out =
            Self { points: self.points, starts: vec![0], same: self.same, ..Self::default() };
        for face in wanted(self.starts.windows(2), context) {
            let range = face[0]..face[1];
            let before = |i: u32| if i == range.start { range.end - 1 } else { i - 1 };
            let corner = |i: u32| self.corners[i as usize];
            let kept: Vec<u32> =
                range.clone().filter(|i| corner(*i) != corner(before(*i))).collect();
            if kept.len() < 3 {
                continue;
            }
            for i in kept.iter().map(|i| *i as usize) {
                out.corners.push(self.corners[i]);
                out.uvs.extend(self.uvs.get(i));
                out.normals.extend(self.normals.get(i));
                out.colors.extend(self.colors.get(i));
            }
            out.starts.push(out.corners.len().try_into().expect("there are no more than before"));
        }
        go_on(context)?;
        Ok(out)
    }

    /// Every face as a fan about its first corner.
    ///
    /// # Errors
    /// If it is not wanted any more.
    pub(super) fn fans(self, context: &dyn BuildContext) -> Result<Net, String> {
        let mut kept = vec![];
        for face in wanted(self.starts.windows(2), context) {
            kept.extend((face[0] + 1..face[1].max(1) - 1).map(|i| [face[0], i, i + 1]));
        }
        let triangles = gather(kept.iter().map(|t| t.map(|i| self.corners[i as usize])), context)?;
        Ok(Net {
            places: self.points,
            triangles,
            uvs: pick(&kept, &self.uvs, context)?,
            normals: pick(&kept, &self.normals, context)?,
            colors: pick(&kept, &self.colors, context)?,
        })
    }
}

/// What the corners of triangles have, triangle by triangle; nothing where there is nothing.
///
/// # Errors
/// If it is not wanted any more.
pub(super) fn pick<T: Copy>(
    triangles: &[[u32; 3]],
    of_corners: &[T],
    context: &dyn BuildContext,
) -> Result<Vec<T>, String> {
    if of_corners.is_empty() {
        return Ok(vec![]);
    }
    gather(triangles.as_flattened().iter().map(|i| of_corners[*i as usize]), context)
}
