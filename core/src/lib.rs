//! The machine: registry, scene, stage, acceleration, film, rendering.
//!
//! It reads nothing itself (bytes come through `files::Files`) and prints nothing.

mod cast;

pub mod accel;
pub mod diag;
pub mod files;
pub mod film;
pub mod memory;
pub mod object;
pub mod registry;
pub mod render;
pub mod scene;
pub mod stage;
