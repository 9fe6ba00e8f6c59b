//! The straight slope.

use luxel_sdk::Params;
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

use super::profile::{Profile, separable};

/// Samples count less in proportion to how far they are from the middle, and nothing from `radius` on:
/// with a radius of 1, what lies between two pixels is shared between them.
///
/// ```scene
/// filter triangle { radius = 1 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Triangle<'a> {
    /// Where it ends, pixels.
    #[param(default = 1.0, min = 0.01, max = 16)]
    radius: f32,
    #[param(shared)]
    profile: Shared<'a, Profile>,
}

impl Build<Profile> for Triangle<'_> {
    fn build(&self, _context: &dyn BuildContext) -> Result<Profile, Vec<Fault>> {
        Ok(Profile::new(self.radius, |x| f64::from(self.radius) - x))
    }
}

separable!(Triangle);
