//! The machine: registry, scene, stage, acceleration, film, rendering.

pub mod accel;
