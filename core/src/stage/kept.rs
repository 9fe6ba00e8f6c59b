//! What one build leaves for the next, and what it had to make anew.

use std::ops::Add;
use std::sync::Arc;

use luxel_sdk::kind::Imported;

use super::Geometry;
use crate::object::{Kept, Object, Objects, Reads, Shelf};
use crate::scene::Hash;

/// Most bytes of what the last build has not used and that is kept all the same: trees and triangles,
/// and of assets and other objects what was read for them.
const MOST: usize = 1 << 30;

/// A shape's object, and what was made of it.
pub(super) type Shaped = (Arc<Object>, Arc<Geometry>);

/// What an asset's file was found to hold.
#[derive(Debug)]
pub(super) struct Brought {
    /// Who has read it.
    pub(super) importer: Arc<Object>,
    pub(super) reads: Reads,
    pub(super) imported: Imported,
    /// What was warned of.
    pub(super) warnings: Vec<String>,
    /// Of each of its nodes, as it came into the scene, the two hashes: children by theirs.
    pub(super) hashes: Vec<Option<[Hash; 2]>>,
}

impl Kept for Arc<Brought> {
    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(self, other)
    }

    fn bytes(&self) -> usize {
        self.reads.bytes()
    }
}

/// Assets by the hash of the node that asks for them.
pub(super) type Assets = Shelf<Hash, Arc<Brought>>;

/// What one build leaves for the next.
#[derive(Debug, Default)]
pub(super) struct Cache {
    pub(super) assets: Assets,
    pub(super) objects: Objects,
    pub(super) shapes: Shelf<Hash, Shaped>,
}

impl Cache {
    /// Takes over what was used a moment ago.
    pub(super) fn inherit(&mut self, before: &Self) {
        let trees = self.shapes.inherit(&before.shapes, MOST);
        let files = self.assets.inherit(&before.assets, MOST - trees);
        self.objects.inherit(&before.objects, MOST - trees - files);
    }
}

/// What a build had to make; everything else was kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Anew {
    /// Objects: parameters taken in, files read and decoded.
    pub objects: usize,
    /// Shapes made ready for rays.
    pub shapes: usize,
    /// Trees over the triangles of meshes: of shapes, and of parts of solids.
    pub trees: usize,
}

impl Add for Anew {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            objects: self.objects + other.objects,
            shapes: self.shapes + other.shapes,
            trees: self.trees + other.trees,
        }
    }
}

impl Kept for Shaped {
    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.1, &other.1)
    }

    fn bytes(&self) -> usize {
        match &*self.1 {
            Geometry::Analytic(_) => 0,
            Geometry::Mesh(mesh) => mesh.whole_bytes(),
        }
    }
}
