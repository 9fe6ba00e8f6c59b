//! Maths beyond glam: error bounds, frames, transforms, bounds, rays, sums and quadratics.
//!
//! Positions and ray parameters are f64; directions in a shading frame are f32. Nothing here holds
//! an epsilon: each tolerance is a rounding bound with its derivation.

pub mod bounds;
pub mod error;
pub mod frame;
pub mod quadratic;
pub mod ray;
pub mod sum;
pub mod transform;
pub mod unit;

#[cfg(test)]
mod points;

pub use bounds::Bounds3;
pub use error::{gamma32, gamma64, offset_origin};
pub use frame::Frame;
pub use quadratic::{quadratic_roots, sphere_roots};
pub use ray::Ray;
pub use sum::{Moments, Sum};
pub use transform::Transform;
pub use unit::{unit_again, unit_and_length};
