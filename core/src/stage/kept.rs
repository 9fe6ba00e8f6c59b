//! What one build leaves for the next, and what it had to make anew.

use std::ops::Add;
use std::sync::Arc;

use luxel_sdk::kind::{ImportNode, ImportValue, Imported};

use super::Geometry;
use crate::object::{Kept, Object, Objects, Reads, Shelf};
use crate::scene::Hash;

/// Most bytes of what the last build has not used and that is kept all the same: trees and triangles,
/// and what assets and other objects say that they hold, or what was read for them.
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
        held(&self.imported)
    }
}

/// Bytes of memory that an asset's nodes take, as far as they can be many: those of its file are gone.
fn held(imported: &Imported) -> usize {
    let many = |value: &ImportValue| match value {
        ImportValue::Table(numbers) => size_of_val(&**numbers),
        ImportValue::Bytes(_, bytes) => bytes.len(),
        _ => 0,
    };
    let node = |node: &ImportNode| {
        let values = node.params.iter().map(|(_, value)| many(value)).sum::<usize>();
        size_of::<ImportNode>() + size_of_val(&*node.params) + values
    };
    imported.nodes.iter().map(node).sum::<usize>() + size_of_val(&*imported.placed)
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

#[cfg(test)]
mod tests {
    use luxel_sdk::kind::Kind;

    use super::*;

    #[test]
    fn an_asset_takes_what_its_tables_and_files_take() {
        let node = |value| ImportNode {
            kind: Kind::Shape,
            class: "mesh".to_owned(),
            label: String::new(),
            params: vec![("points".into(), value)],
        };
        let asset = |value| Imported { nodes: vec![node(value)], placed: vec![], warnings: vec![] };
        let plain = held(&asset(ImportValue::Bool(true)));
        let table = held(&asset(ImportValue::Table(vec![1.0; 3000].into())));
        let bytes = held(&asset(ImportValue::Bytes("a.png".to_owned(), vec![0; 777].into())));
        assert!(plain < 500 && table == plain + 24_000 && bytes == plain + 777);
    }
}
