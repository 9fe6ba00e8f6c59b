//! The bell curve, cut off.

use luxel_sdk::Params;
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

use super::profile::{Profile, separable};

/// A bell curve, cut off at `radius`: smooth edges, slightly soft.
///
/// ```scene
/// filter gaussian { sigma = 0.5, radius = 1.5 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Gaussian<'a> {
    /// Standard deviation, pixels.
    #[param(default = 0.5, min = 0.05, max = 16)]
    sigma: f32,
    /// Where it is cut off, pixels.
    #[param(default = 1.5, min = 0.01, max = 16)]
    radius: f32,
    #[param(shared)]
    profile: Shared<'a, Profile>,
}

impl Build<Profile> for Gaussian<'_> {
    fn build(&self, _context: &dyn BuildContext) -> Result<Profile, Vec<Fault>> {
        let sigma = f64::from(self.sigma);
        Ok(Profile::new(self.radius, |x| (-0.5 * (x / sigma).powi(2)).exp()))
    }
}

separable!(Gaussian);
