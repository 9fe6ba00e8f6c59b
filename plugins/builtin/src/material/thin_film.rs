//! Films so thin that waves reflected by both their sides meet again.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::scattering::film_reflectance;

/// A soap bubble, a film of oil held in air: clear, as thin as waves of light are long, with air on both
/// sides. What it does not reflect passes on straight ahead. Its colours are those of interference,
/// so that light is carried by wavelength.
///
/// ```scene
/// let soap = material thin_film { thickness = 300 nm, ior = 1.33 }
/// ```
///
/// In `film rgb` each channel is light of one wavelength: 611, 549 and 464 nm. Polarisation is left out.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct ThinFilm {
    /// From one side to the other.
    #[param(required, unit = "m", role = waves)]
    thickness: Spectrum,
    /// Index of refraction, in air.
    #[param(default = 1.33, min = 1, max = 10)]
    ior: f32,
}

impl Material for ThinFilm {
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
        Eval::ZERO
    }

    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        let reflected = film_reflectance(wo.z.abs(), self.ior, self.thickness);
        let chance = reflected.mean();
        if u[2] < chance {
            return Some(Sample::delta(Vec3::new(-wo.x, -wo.y, wo.z), reflected / chance));
        }
        let passed = (Spectrum::ONE - reflected) / (1.0 - chance);
        let lobe = Lobe::DELTA.with(Lobe::TRANSMISSION);
        Some(Sample { lobe, ..Sample::delta(-wo, passed) })
    }

    fn needs(&self) -> Needs {
        Needs::CHOICE
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::stays_finite;
    use super::*;

    #[test]
    fn what_it_does_not_reflect_passes() {
        let film = ThinFilm { thickness: Spectrum::new(0.0, 0.21, 0.6, 40.0), ior: 1.33 };
        stays_finite(&film);
        for wo in [Vec3::Z, Vec3::new(0.6, 0.0, -0.8), Vec3::new(0.0, 0.99, 0.01).normalize()] {
            let whole = film_reflectance(wo.z.abs(), film.ior, film.thickness);
            let (mut reflected, mut passed) = (Spectrum::ZERO, Spectrum::ZERO);
            let n = 1000_u16;
            for i in 0..n {
                let u = (f32::from(i) + 0.5) / f32::from(n);
                let sample = film.sample(wo, [0.3, 0.7, u]).expect("one of both ways is taken");
                let side = if sample.wi.z * wo.z > 0.0 { &mut reflected } else { &mut passed };
                *side += sample.weight / f32::from(n);
            }
            // One more or less of the thousand goes the other way, and counts for up to four.
            let off = |a: Spectrum, b: Spectrum| (a.0 - b.0).abs().max_element();
            assert!(off(reflected, whole) < 4e-3, "{reflected:?} {whole:?}");
            assert!(off(passed, Spectrum::ONE - whole) < 4e-3, "{passed:?} {whole:?}");
        }
    }
}
