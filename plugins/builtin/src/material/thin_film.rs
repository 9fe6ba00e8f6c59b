//! Films so thin that waves reflected by both their sides meet again.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::scattering::film_reflectance;

/// A soap bubble, oil held in the air: a clear film as thin as waves of light are long, with the same on
/// both sides. What it does not reflect passes on straight ahead. Its colours are those of interference,
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
    /// Index of refraction relative to what is on both sides.
    #[param(default = 1.33, min = 1, max = 10)]
    ior: Spectrum,
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
    use super::super::check::{Side, scatters_as_it_claims, stays_finite};
    use super::*;

    #[test]
    fn what_it_does_not_reflect_passes() {
        for (waves, ior) in [(0.0, 1.33), (0.25, 1.0), (0.6, 1.33), (40.0, 4.0)] {
            let film = ThinFilm { thickness: Spectrum::splat(waves), ior: Spectrum::splat(ior) };
            scatters_as_it_claims(&film, Side::Outside);
            scatters_as_it_claims(&film, Side::Inside);
            stays_finite(&film);
        }
    }
}
