//! Acceleration: where a ray meets a mesh, and which placements it may meet.
//!
//! [`MeshBvh`] is in f32 about the mesh's own centre and is watertight: a ray that crosses a closed
//! mesh is never let through an edge or a vertex, at any scale. [`TopBvh`] is in f64 over the boxes
//! of placements. Neither knows materials, transforms or scenes, and neither has an epsilon.
//!
//! obvhs clusters the triangles; the trees that are traversed are ours: eight children to a node, so
//! that one AVX register holds one plane of each, and four triangles to a leaf block.

mod mesh;
mod node;
mod precision;
mod processor;
mod ray;
mod slabs;
mod stack;
mod triangle;

mod build;
mod cluster;
mod collapse;
mod error;
mod flock;
mod partition;
mod passes;
mod triangles;
mod watch;

mod top;

#[cfg(test)]
mod leak_tests;
#[cfg(test)]
mod mesh_tests;
#[cfg(test)]
mod soup;
#[cfg(test)]
mod watch_tests;

pub use error::BuildError;
pub use flock::Flock;
pub use mesh::{Begun, MeshBvh, MeshHit, MeshWalk, Query};
pub use precision::Precision;
pub use processor::{Processor, Work, prefetch_value};
pub use ray::Direction;
pub use stack::{Room, Stack};
pub use top::{Box64, TopBvh, TopWalk};
pub use watch::{Standing, Watch};
