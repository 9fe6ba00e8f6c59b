//! The built-in plugins of kind integrator.

mod path;
mod direct;
mod ambient_occlusion;
mod debug;

#[cfg(test)]
mod tests;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::integrator::<path::PathTracer>("path"),
    Class::integrator::<direct::Direct>("direct"),
    Class::integrator::<ambient_occlusion::AmbientOcclusion>("ambient_occlusion"),
    Class::integrator::<debug::Debug>("debug"),
];
