//! What lights far away share: a disk of sky around one direction.

use std::f64::consts::PI;

use glam::DVec3;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Escaped, LightQuery, LightSample};
use luxel_sdk::num::Frame;
use luxel_sdk::params::{Emission, Fault, Quantity};
use luxel_sdk::sampling::one_minus_cos;

/// A round patch of sky that shines evenly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// Unit, to its centre.
    pub(super) to: DVec3,
    /// Full angle, radians; 0 is a delta.
    pub(super) angle: f64,
}

impl Patch {
    /// 1 − cos of the angular radius.
    fn versine(self) -> f64 {
        one_minus_cos(0.5 * self.angle)
    }

    /// π·sin² of the angular radius: irradiance over radiance on a surface that faces it, sr; for
    /// a patch that reaches below the horizon, what comes from above.
    #[expect(clippy::cast_possible_truncation, reason = "rounds; radiance is f32")]
    fn projected(self) -> f32 {
        let v = self.versine().min(1.0);
        (PI * v * (2.0 - v)) as f32
    }

    /// Radiance; for a delta the irradiance.
    fn le(self, emission: &Emission) -> Spectrum {
        let is_radiance = emission.quantity == Quantity::Radiance;
        if self.versine() <= 0.0 || is_radiance {
            return emission.spectrum;
        }
        emission.spectrum / self.projected()
    }

    /// Power through a sphere of the given radius (m), W: from each direction through a disk.
    #[expect(clippy::cast_possible_truncation, reason = "rounds; only guides sampling")]
    pub(super) fn power(self, emission: &Emission, radius: f64) -> f32 {
        let versine = self.versine();
        let solid_angle = if versine > 0.0 { 2.0 * PI * versine } else { 1.0 };
        self.le(emission).mean() * (solid_angle * PI * radius * radius) as f32
    }

    /// Light from a direction of the patch.
    #[expect(clippy::cast_possible_truncation, reason = "rounds; a density")]
    pub(super) fn sample(self, query: &LightQuery, emission: &Emission) -> LightSample {
        let (le, distance) = (self.le(emission), f64::INFINITY);
        let versine = self.versine();
        if versine <= 0.0 {
            return LightSample { le, wi: self.to, distance, pdf: 1.0, delta: true };
        }
        let wi = self.around(query.u, versine);
        LightSample { le, wi, distance, pdf: (0.5 / (PI * versine)) as f32, delta: false }
    }

    /// A direction whose 1 − cos to the centre is uniform in [0, `versine`], in f64: the sun is so
    /// small that f32 directions would show as steps.
    fn around(self, u: [f32; 2], versine: f64) -> DVec3 {
        let x = f64::from(u[0]) * versine;
        let (sin, cos) = (2.0 * PI * f64::from(u[1])).sin_cos();
        let r = (x * (2.0 - x)).sqrt();
        let (across, up) = self.tangents();
        (across * (r * cos) + up * (r * sin) + self.to * (1.0 - x)).normalize()
    }

    fn tangents(self) -> (DVec3, DVec3) {
        let across = Frame::from_z(self.to.as_vec3()).x.as_dvec3();
        let up = self.to.cross(across).normalize();
        (up.cross(self.to), up)
    }

    /// What a ray along the unit vector `d` finds.
    #[expect(clippy::cast_possible_truncation, reason = "rounds; a density")]
    pub(super) fn escaped(self, d: DVec3, emission: &Emission) -> Escaped {
        let versine = self.versine();
        // |d − to|² = 2·(1 − cos), without cancelling.
        if versine > 0.0 && 0.5 * (d - self.to).length_squared() <= versine {
            return Escaped { le: self.le(emission), pdf: (0.5 / (PI * versine)) as f32 };
        }
        Escaped { le: Spectrum::ZERO, pdf: 0.0 }
    }
}

/// Refuses a direction that has none.
pub(super) fn check_direction(direction: DVec3) -> Result<(), Fault> {
    if direction.try_normalize().is_some() {
        return Ok(());
    }
    Err(Fault::range("direction", format!("a direction is wanted, found {direction}")))
}

/// Azimuth and polar angle of a unit direction in [0, 1]²: the centre is −Z, the left edge and the
/// right one +Z, the top +Y. To the right of the centre lies +X.
pub(super) fn equirectangular(d: DVec3) -> [f64; 2] {
    let u = 0.5 + d.x.atan2(-d.z) / (2.0 * PI);
    let v = d.x.hypot(d.z).atan2(d.y) / PI;
    [u, v]
}

/// The inverse of `equirectangular`.
pub(super) fn direction([u, v]: [f64; 2]) -> DVec3 {
    let (sin_a, cos_a) = (2.0 * PI * (u - 0.5)).sin_cos();
    let (sin, cos) = (PI * v).sin_cos();
    DVec3::new(sin * sin_a, cos, -sin * cos_a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_of_a_patch_are_found_again_with_their_density() {
        let emission = Emission { spectrum: Spectrum::ONE, quantity: Quantity::Illuminance };
        for angle in [1e-6, 0.0093, 1.0, PI] {
            let patch = Patch { to: DVec3::new(0.36, 0.48, 0.8), angle };
            let mut rng = luxel_sdk::sampling::Rng::new(1);
            let mut irradiance = 0.0;
            for _ in 0..1000 {
                let query = LightQuery { p: DVec3::ZERO, u: rng.pair() };
                let sample = patch.sample(&query, &emission);
                let found = patch.escaped(sample.wi, &emission);
                assert!((found.pdf - sample.pdf).abs() <= 0.0, "{angle} {sample:?}");
                assert!(found.le == sample.le && !sample.delta);
                let facing = f64::from(sample.le.lane(0) / sample.pdf);
                irradiance += facing * sample.wi.dot(patch.to) / 1000.0;
            }
            // Cosines are uniform in [cos, 1]: standard error (1 − cos)/√12/√1000, five of them,
            // over their mean, and f32 rounding.
            let versine = one_minus_cos(0.5 * angle);
            let error = 5.0 * versine / 110.0 / (1.0 - 0.5 * versine) + 1e-6;
            assert!((irradiance - 1.0).abs() < error, "{angle} {irradiance}");
        }
    }

    #[test]
    fn a_point_in_the_sky_is_a_delta_that_no_ray_finds() {
        let emission = Emission { spectrum: Spectrum::ONE, quantity: Quantity::Scale };
        let patch = Patch { to: DVec3::Y, angle: 0.0 };
        assert!(patch.sample(&LightQuery { p: DVec3::ZERO, u: [0.3; 2] }, &emission).delta);
        assert!(patch.escaped(DVec3::Y, &emission).le.is_black());
        assert!(check_direction(DVec3::ZERO).is_err());
    }

    #[test]
    fn the_map_of_directions_is_its_own_inverse() {
        let centre = equirectangular(DVec3::NEG_Z);
        assert!((centre[0] - 0.5).abs() <= 0.0 && (centre[1] - 0.5).abs() <= 0.0);
        assert!(equirectangular(DVec3::X)[0] > 0.5);
        assert!(equirectangular(DVec3::Y)[1] <= 0.0);
        for (u, v) in [(0.1, 0.2), (0.6, 0.9), (0.999, 0.5), (0.25, 1e-9)] {
            let [a, b] = equirectangular(direction([u, v]));
            assert!((a - u).abs() < 1e-14 && (b - v).abs() < 1e-14, "{a} {b}");
        }
    }
}
