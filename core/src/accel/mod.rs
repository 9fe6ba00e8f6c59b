//! Acceleration: where a ray meets a mesh, and which placements it may meet.
//!
//! [`MeshBvh`] is in f32 about the mesh's own centre and is watertight: a ray that crosses a closed
//! mesh is never let through an edge or a vertex, at any scale. [`TopBvh`] is in f64 over the boxes
//! of placements. Neither knows materials, transforms or scenes, and neither has an epsilon.
//!
//! obvhs clusters the triangles; the trees that are traversed are ours: four children to a node,
//! four triangles to a leaf block, so that one SSE or NEON register holds one coordinate of each.

mod mesh;
mod node;
mod ray;
mod stack;
mod triangle;
mod widest;

mod build;
mod cluster;
mod collapse;
mod error;
mod partition;

mod top;

#[cfg(test)]
mod leak_tests;
#[cfg(test)]
mod mesh_tests;
#[cfg(test)]
mod soup;

pub use error::BuildError;
pub use mesh::{MeshBvh, MeshHit};
pub use ray::Direction;
pub use top::{Step, TopBvh, Visit};
pub use widest::{Work, widest};
