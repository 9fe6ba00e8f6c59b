//! The built-in plugins of kind sampler.

mod independent;
mod sobol;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::sampler::<sobol::Sobol>("sobol"),
    Class::sampler::<independent::Independent>("independent"),
];
