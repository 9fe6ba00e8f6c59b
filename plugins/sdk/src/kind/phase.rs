//! How a medium scatters light, given its parameters at one point.

use glam::Vec3;

use super::{Eval, Sample};
use crate::params::Fault;

/// The distribution of scattered directions in a medium.
///
/// Directions are unit vectors in world space, both pointing away from the point: `wo` to the
/// viewer, `wi` to where the light comes from. `eval.f` is the phase function, sr⁻¹, normalised to 1.
pub trait Phase: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// The phase function and the density of `sample`.
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval;

    /// A direction, `u` uniform in [0, 1)².
    fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample>;
}
