//! How samples become pixels: the filter is sampled, so one sample feeds one pixel.

use crate::params::Fault;

/// A pixel filter that is nowhere negative (Ernst et al. 2006, filter importance sampling).
pub trait Filter: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// Half its width, pixels.
    fn radius(&self) -> f32;

    /// Its value at an offset from the pixel's centre, pixels; integrates to 1.
    fn eval(&self, offset: [f32; 2]) -> f32;

    /// An offset with density `eval`, `u` uniform in [0, 1)².
    fn sample(&self, u: [f32; 2]) -> [f32; 2];
}
