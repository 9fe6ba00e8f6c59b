//! A bell of four cosines.

use std::f64::consts::PI;

use luxel_sdk::Params;
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

use super::profile::{Profile, separable};

/// A bell that ends smoothly at `radius` (Harris 1978): clean edges without ringing, the usual
/// choice for pictures.
///
/// ```scene
/// filter blackman_harris { radius = 1.5 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct BlackmanHarris<'a> {
    /// Where it ends, pixels.
    #[param(default = 1.5, min = 0.01, max = 16)]
    radius: f32,
    #[param(shared)]
    profile: Shared<'a, Profile>,
}

/// The four-term window of Harris 1978, "On the use of windows", table II, at `x` in [0, 1] from
/// its centre.
fn window(x: f64) -> f64 {
    let term = |n: f64| (PI * n * x).cos();
    0.35875 + 0.48829 * term(1.0) + 0.14128 * term(2.0) + 0.01168 * term(3.0)
}

impl Build<Profile> for BlackmanHarris<'_> {
    fn build(&self, _context: &dyn BuildContext) -> Result<Profile, Vec<Fault>> {
        Ok(Profile::new(self.radius, |x| window(x / f64::from(self.radius))))
    }
}

separable!(BlackmanHarris);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_one_in_the_middle_and_never_negative() {
        assert!((window(0.0) - 1.0).abs() < 1e-15);
        // Its value at the edge is .35875 − .48829 + .14128 − .01168 = .00006.
        assert!((0..=1000).all(|i| window(f64::from(i) / 1000.0) > 5e-5));
    }
}
