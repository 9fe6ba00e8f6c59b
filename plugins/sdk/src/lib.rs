//! What a plugin sees: maths, spectra, sampling, one trait per kind, parameters.
//!
//! A plugin is a plain struct of its parameters plus one trait; this crate does no input or output.

extern crate self as luxel_sdk;

pub mod num;
pub mod color;
pub mod sampling;
pub mod scattering;
pub mod wire;
pub mod params;
pub mod kind;
pub mod abi;

pub use luxel_sdk_derive::{Choice, Params};
