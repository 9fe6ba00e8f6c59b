//! All directions alike.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Phase, Sample};
use luxel_sdk::sampling::{SPHERE_PDF, uniform_sphere};

/// Scatters alike in all directions.
///
/// ```scene
/// let smoke = medium homogeneous { sigma_t = 2 / (1 m), albedo = 0.8, phase = phase isotropic {} }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Isotropic {}

impl Phase for Isotropic {
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
        Eval { f: Spectrum::splat(SPHERE_PDF), pdf: SPHERE_PDF }
    }

    fn sample(&self, _wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        let wi = uniform_sphere(u);
        Some(Sample { weight: Spectrum::ONE, wi, pdf: SPHERE_PDF, eta: 1.0, lobe: Lobe::NONE })
    }
}
