//! What a plugin sees: maths, spectra, sampling, one trait per kind, parameters.
//!
//! A plugin is a plain struct of its parameters plus one trait; this crate does no input or output.

pub mod num;
pub mod color;
pub mod sampling;
