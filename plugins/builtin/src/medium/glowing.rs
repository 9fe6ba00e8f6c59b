//! A medium that shines, the same everywhere.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{FreeFlight, Medium, PhaseRef, Samples};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Emission;

use super::homogeneous::Homogeneous;

/// Hot gas, embers, neon: absorbs and shines, the same everywhere. It shines as it absorbs: so thick that
/// nothing is seen through it, and without scattering, it has the radiance that is stated.
///
/// ```scene
/// let flame = medium glowing { sigma_a = 1 / (20 cm), spectrum = blackbody(1900 K), radiance = 3e4 nit }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Glowing<'a> {
    /// Absorption, and with it how strongly it shines.
    #[param(required, unit = "1/m", role = coefficient)]
    sigma_a: Spectrum,
    /// Scattering.
    #[param(default = 0.0, unit = "1/m", role = coefficient)]
    sigma_s: Spectrum,
    /// Colour of the light of a thick piece; its amount is given apart.
    #[param(emission(radiance, scale))]
    emission: Emission,
    /// Where scattered light goes: alike in all directions if absent.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

impl Glowing<'_> {
    /// The same without its light.
    fn dark(&self) -> Homogeneous<'_> {
        Homogeneous::of(self.sigma_a, self.sigma_s, self.phase)
    }
}

/// ∫ e^(−σs) ds from 0 to t, m.
#[expect(clippy::cast_possible_truncation, reason = "rounds; radiance is f32")]
fn seen_depth(sigma: f32, t: f64) -> f32 {
    let sigma = f64::from(sigma);
    if sigma > 0.0 { (-(-sigma * t).exp_m1() / sigma) as f32 } else { t as f32 }
}

impl Medium for Glowing<'_> {
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        self.dark().sample(ray, samples)
    }

    fn transmittance(&self, ray: &Ray, samples: &mut Samples<'_>) -> Spectrum {
        self.dark().transmittance(ray, samples)
    }

    /// In closed form, so it is free of noise.
    fn glow(&self, ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
        let sigma_t = (self.sigma_a + self.sigma_s).to_array();
        let lane = |i: usize| {
            let emitted = self.sigma_a.lane(i) * self.emission.spectrum.lane(i);
            if emitted > 0.0 { emitted * seen_depth(sigma_t[i], ray.t_max) } else { 0.0 }
        };
        Spectrum::from_array([0, 1, 2, 3].map(lane))
    }

    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_seen_of_a_length_is_all_of_it_until_it_hides_itself() {
        let near = |a: f32, b: f64| (f64::from(a) / b - 1.0).abs() < 1e-6;
        assert!(near(seen_depth(0.0, 3.0), 3.0));
        assert!(near(seen_depth(1e-12, 3.0), 3.0));
        assert!(near(seen_depth(0.5, 3.0), 2.0 * (1.0 - (-1.5f64).exp())));
        assert!(near(seen_depth(4.0, f64::INFINITY), 0.25));
    }
}
