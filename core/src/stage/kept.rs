//! What one build leaves for the next, and what it had to make anew.

use std::sync::Arc;

use luxel_sdk::kind::TriangleMesh;

use super::Geometry;
use crate::object::{Kept, Object, Objects, Shelf};
use crate::scene::Hash;

/// Most bytes of what the last build has not used and that is kept all the same: trees and triangles,
/// and of other objects what was read for them.
const MOST: usize = 1 << 30;

/// A shape's object, and what was made of it.
pub(super) type Shaped = (Arc<Object>, Arc<Geometry>);

/// What one build leaves for the next.
#[derive(Debug, Default)]
pub(super) struct Cache {
    pub(super) objects: Objects,
    pub(super) shapes: Shelf<Hash, Shaped>,
}

impl Cache {
    /// Takes over what was used a moment ago.
    pub(super) fn inherit(&mut self, before: &Self) {
        let trees = self.shapes.inherit(&before.shapes, MOST);
        self.objects.inherit(&before.objects, MOST - trees);
    }
}

/// What a build had to make; everything else was kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Anew {
    /// Objects: parameters taken in, files read and decoded.
    pub objects: usize,
    /// Shapes made ready: of meshes, their trees.
    pub shapes: usize,
}

impl Kept for Shaped {
    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.1, &other.1)
    }

    fn bytes(&self) -> usize {
        match &*self.1 {
            Geometry::Analytic(_) => 0,
            Geometry::Mesh(mesh) => mesh.bytes() + bytes(mesh.triangles()),
        }
    }
}

fn bytes(mesh: &TriangleMesh) -> usize {
    let TriangleMesh { points, indices, normals, uvs, colors, later, .. } = mesh;
    let later = later.as_ref().map_or(0, |later| {
        size_of_val(later.points.as_slice()) + size_of_val(later.normals.as_slice())
    });
    size_of_val(points.as_slice())
        + size_of_val(indices.as_slice())
        + size_of_val(normals.as_slice())
        + size_of_val(uvs.as_slice())
        + size_of_val(colors.as_slice())
        + later
}
