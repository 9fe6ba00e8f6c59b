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

/// Share of the radiance of a thick piece that does not scatter which a length t shows, in [0, 1].
#[expect(clippy::cast_possible_truncation, reason = "rounds; a fraction")]
fn shown(sigma_a: f32, sigma_s: f32, t: f64) -> f32 {
    let (sigma_a, sigma_s) = (f64::from(sigma_a), f64::from(sigma_s));
    let sigma_t = sigma_a + sigma_s;
    if sigma_a > 0.0 { (sigma_a / sigma_t * -(-sigma_t * t).exp_m1()) as f32 } else { 0.0 }
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
        let lane = |i: usize| shown(self.sigma_a.lane(i), self.sigma_s.lane(i), ray.t_max);
        self.emission.spectrum * Spectrum::from_array([0, 1, 2, 3].map(lane))
    }

    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thin_piece_shines_as_it_absorbs_and_a_thick_one_hides_itself() {
        let near = |a: f32, b: f64| assert!((f64::from(a) / b - 1.0).abs() < 1e-6, "{a} {b}");
        near(shown(1e-12, 0.0, 3.0), 3e-12);
        near(shown(0.5, 0.0, 3.0), 1.0 - (-1.5f64).exp());
        near(shown(1.0, 3.0, f64::INFINITY), 0.25);
        near(shown(1e-40, 0.0, f64::INFINITY), 1.0);
        let none = [shown(0.0, 2.0, 3.0), shown(0.0, 0.0, f64::INFINITY)];
        assert_eq!(none.map(f32::to_bits), [0; 2]);
    }
}
