//! A medium that is the same everywhere.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{FreeFlight, Medium, PhaseRef, Samples};
use luxel_sdk::num::Ray;
use luxel_sdk::params::{Fault, Maybe};

/// Fog, smoke, milk, tinted glass: the same everywhere. State `sigma_t` with `albedo`, or `sigma_a`
/// and `sigma_s`. Where a group or camera is in it, it fills all space.
///
/// ```scene
/// let tint = medium homogeneous { sigma_a = spectrum([(400 nm, 9), (700 nm, 1)]) / (1 m) }
/// let fog  = medium homogeneous { sigma_t = 1 / (12 m), albedo = 0.98 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Homogeneous<'a> {
    /// Extinction: the inverse of the mean free path.
    #[param(optional, unit = "1/m", role = coefficient)]
    sigma_t: Spectrum,
    /// Share of the extinction that is scattering, for `sigma_t`.
    #[param(default = 1.0, role = reflectance)]
    albedo: Spectrum,
    /// Absorption.
    #[param(optional, unit = "1/m", role = coefficient)]
    sigma_a: Spectrum,
    /// Scattering.
    #[param(optional, unit = "1/m", role = coefficient)]
    sigma_s: Spectrum,
    /// Where scattered light goes: alike in all directions if absent.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

/// The least random number above zero: what zero counts as, so that logarithms stay finite.
const LEAST: f64 = 0.5 / 4294967296.0;

impl<'a> Homogeneous<'a> {
    /// What absorbs and scatters so much, m⁻¹.
    pub(super) fn of(sigma_a: Spectrum, sigma_s: Spectrum, phase: PhaseRef<'a>) -> Self {
        Self { sigma_t: Spectrum::ZERO, albedo: Spectrum::ONE, sigma_a, sigma_s, phase }
    }
}

impl Homogeneous<'_> {
    fn extinction(&self) -> Spectrum {
        self.sigma_t + self.sigma_a + self.sigma_s
    }

    fn scattering(&self) -> Spectrum {
        self.sigma_t * self.albedo + self.sigma_s
    }
}

/// e^(−σt) per lane; what does not absorb passes any distance.
#[expect(clippy::cast_possible_truncation, reason = "rounds; a fraction")]
fn attenuation(sigma: Spectrum, t: f64) -> Spectrum {
    let lane = |sigma: f32| if sigma > 0.0 { (-f64::from(sigma) * t).exp() as f32 } else { 1.0 };
    Spectrum::from_array(sigma.to_array().map(lane))
}

impl Medium for Homogeneous<'_> {
    fn check(&self) -> Result<(), Fault> {
        let parts = self.sigma_a + self.sigma_s;
        if self.sigma_t.is_black() || parts.is_black() {
            return Ok(());
        }
        let message = "either `sigma_t` with `albedo`, or `sigma_a` and `sigma_s`: not both";
        Err(Fault::range("sigma_t", message))
    }

    /// The distance comes from one lane, chosen evenly; all four are weighed as if by the mean of
    /// their densities (one-sample balance heuristic, as in Wilkie et al. 2014).
    ///
    /// Where nothing scatters, every ray passes, with what absorption leaves of it.
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        let sigma = self.extinction();
        if self.scattering().is_black() {
            return FreeFlight { t: Maybe::default(), weight: attenuation(sigma, ray.t_max) };
        }
        let [lane, u] = samples.next_2d();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, 4)")]
        let chosen = f64::from(sigma.lane((lane * 4.0) as usize & 3));
        // Infinite without extinction. As u is finest at 0, ln u reaches 22.9 mean free paths.
        let t = -f64::from(u).max(LEAST).ln() / chosen;
        if !(t < ray.t_max) {
            let passed = attenuation(sigma, ray.t_max);
            return FreeFlight { t: Maybe::default(), weight: passed / passed.mean() };
        }
        let left = attenuation(sigma, t);
        let pdf = (sigma * left).mean();
        FreeFlight { t: Maybe::some(t), weight: self.scattering() * left / pdf }
    }

    fn transmittance(&self, ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
        attenuation(self.extinction(), ray.t_max)
    }

    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use luxel_sdk::kind::{SampleAt, Sampler};
    use luxel_sdk::sampling::{hash_combine64, u32_to_unit};

    use super::*;
    use crate::phase::isotropic::Isotropic;

    struct Numbers;

    impl Sampler for Numbers {
        fn samples(&self) -> u32 {
            1
        }
        fn seed(&self) -> u32 {
            0
        }
        fn get_1d(&self, at: SampleAt) -> f32 {
            self.get_2d(at)[0]
        }
        #[expect(clippy::cast_possible_truncation, reason = "two halves")]
        fn get_2d(&self, at: SampleAt) -> [f32; 2] {
            let bits = hash_combine64(u64::from(at.index), u64::from(at.dimension));
            [u32_to_unit((bits >> 32) as u32), u32_to_unit(bits as u32)]
        }
    }

    fn samples(index: u32) -> Samples<'static> {
        Samples::new(&Numbers, SampleAt { stream: 0, index, dimension: 0 })
    }

    fn ray(t_max: f64) -> Ray {
        Ray { o: DVec3::ZERO, d: DVec3::X, t_max }
    }

    fn medium(sigma_t: Spectrum, albedo: f32) -> Homogeneous<'static> {
        Homogeneous {
            sigma_t,
            albedo: Spectrum::splat(albedo),
            sigma_a: Spectrum::ZERO,
            sigma_s: Spectrum::ZERO,
            phase: PhaseRef::new(&Isotropic {}),
        }
    }

    #[test]
    fn flights_carry_transmittance_and_the_rest_is_scattered() {
        let fog = medium(Spectrum::new(0.2, 1.0, 5.0, 0.0), 0.5);
        for t_max in [0.3, 3.0, 40.0] {
            let n = 40_000;
            let (mut passed, mut passed_square) = (Spectrum::ZERO, Spectrum::ZERO);
            let (mut met, mut met_square) = (Spectrum::ZERO, Spectrum::ZERO);
            for i in 0..n {
                let flight = fog.sample(&ray(t_max), &mut samples(i));
                let (sum, square) = match flight.t.get() {
                    None => (&mut passed, &mut passed_square),
                    Some(t) => {
                        assert!(t > 0.0 && t < t_max);
                        (&mut met, &mut met_square)
                    }
                };
                *sum += flight.weight;
                *square += flight.weight * flight.weight;
            }
            let n = n as f32;
            let through = fog.transmittance(&ray(t_max), &mut samples(0));
            let scattered = (Spectrum::ONE - through) * 0.5;
            for (sum, square, expected) in
                [(passed, passed_square, through), (met, met_square, scattered)]
            {
                for lane in 0..4 {
                    let (mean, square) = (sum[lane] / n, square[lane] / n);
                    // Five standard errors, and f32 sums of 4e4 terms: 1e-5 at a random walk.
                    let error = 5.0 * ((square - mean * mean).max(0.0) / n).sqrt() + 2e-5;
                    assert!((mean - expected[lane]).abs() < error, "{t_max} {lane} {mean}");
                }
            }
        }
    }

    #[test]
    fn nothing_changes_nothing_at_any_distance() {
        let vacuum = medium(Spectrum::ZERO, 1.0);
        for t_max in [0.0, 1e-30, 1.0, 1e30, f64::INFINITY] {
            let flight = vacuum.sample(&ray(t_max), &mut samples(1));
            assert_eq!(flight, FreeFlight { t: Maybe::default(), weight: Spectrum::ONE });
            assert_eq!(vacuum.transmittance(&ray(t_max), &mut samples(1)), Spectrum::ONE);
        }
    }

    #[test]
    fn a_grey_lossless_medium_weighs_exactly_one() {
        let milk = medium(Spectrum::splat(1e4), 1.0);
        for i in 0..100 {
            let flight = milk.sample(&ray(f64::INFINITY), &mut samples(i));
            let off = flight.weight - 1.0;
            assert!(flight.t.given && off.0.abs().max_element() <= 2.0 * f32::EPSILON);
        }
    }

    #[test]
    fn two_ways_of_stating_extinction_are_refused() {
        let mut fog = medium(Spectrum::ONE, 0.5);
        assert!(fog.check().is_ok());
        fog.sigma_a = Spectrum::ONE;
        assert_eq!(fog.check().unwrap_err().field, "sigma_t");
    }
}
