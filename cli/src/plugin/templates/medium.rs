//! A medium, to be made your own.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{FreeFlight, Medium, PhaseRef, Samples};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Maybe;

/// Grey fog, the same everywhere.
///
/// ```scene
/// let fog = medium template_name { sigma_t = 1 / (2 m), albedo = 0.9 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName<'a> {
    /// Extinction: the inverse of the mean free path.
    #[param(default = 1.0, unit = "1/m", min = 0)]
    sigma_t: f32,
    /// Share of the light that is scattered where it meets the fog; the rest is absorbed.
    #[param(default = 1.0, role = reflectance)]
    albedo: Spectrum,
    /// Where scattered light goes: alike in all directions if absent.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

/// The least random number above zero: what zero counts as, so that its logarithm stays finite.
const LEAST: f64 = 0.5 / 4294967296.0;

impl Medium for TemplateName<'_> {
    /// Distances are chosen in proportion to what is met there, so that weights are plain: all that
    /// passes counts 1, what is scattered counts `albedo`.
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        let u = f64::from(samples.next_1d()).max(LEAST);
        // Infinite without extinction.
        let t = -u.ln() / f64::from(self.sigma_t);
        if t < ray.t_max {
            FreeFlight { t: Maybe::some(t), weight: self.albedo }
        } else {
            FreeFlight { t: Maybe::default(), weight: Spectrum::ONE }
        }
    }

    fn transmittance(&self, ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
        if self.sigma_t > 0.0 {
            Spectrum::splat((-f64::from(self.sigma_t) * ray.t_max).exp() as f32)
        } else {
            Spectrum::ONE
        }
    }

    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}

luxel_sdk::plugin! { medium "template_name" => TemplateName<'static>; }
