//! Light from one point.

use std::f32::consts::PI;

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Quantity};

/// A point that shines alike in all directions. Shadows are hard, and no camera sees it.
///
/// ```scene
/// light point { position = (0, 2, 0) m, spectrum = blackbody(2700 K), power = 800 lm }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Point {
    /// Where it is.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    position: DVec3,
    /// Colour of the light; its amount is given apart.
    #[param(emission(intensity, power, scale))]
    emission: Emission,
}

impl Point {
    fn intensity(&self) -> Spectrum {
        match self.emission.quantity {
            Quantity::Power => self.emission.spectrum / (4.0 * PI),
            _ => self.emission.spectrum,
        }
    }
}

/// Light of an intensity (W/sr) that arrives at `p` from `position`; none at that point itself or
/// where its irradiance would overflow.
pub(super) fn from_point(
    position: DVec3,
    p: DVec3,
    intensity: impl Fn(DVec3) -> Spectrum,
) -> Option<LightSample> {
    let to = position - p;
    let distance = to.length();
    let wi = to / distance;
    #[expect(clippy::cast_possible_truncation, reason = "rounds; irradiance is f32")]
    let fall_off = (1.0 / (distance * distance)) as f32;
    let le = intensity(-wi) * fall_off;
    let lit = le.is_finite() && wi.is_finite() && !le.is_black();
    lit.then_some(LightSample { le, wi, distance, pdf: 1.0, delta: true })
}

impl Light for Point {
    fn form(&self) -> LightForm {
        LightForm::Point
    }

    fn sample(&self, query: &LightQuery) -> Option<LightSample> {
        from_point(self.position, query.p, |_| self.intensity())
    }

    fn power(&self, _area: f64, _scene_radius: f64) -> f32 {
        4.0 * PI * self.intensity().mean()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn irradiance_falls_with_the_square_of_the_distance() {
        let emission = Emission { spectrum: Spectrum::splat(4.0 * PI), quantity: Quantity::Power };
        let lamp = Point { position: DVec3::new(0.0, 2e6, 0.0), emission };
        let at = |p| lamp.sample(&LightQuery { p, u: [0.5; 2] });
        let sample = at(DVec3::ZERO).unwrap();
        // Two roundings.
        assert!((sample.le.lane(1) / 2.5e-13 - 1.0).abs() <= 2.0 * f32::EPSILON);
        assert!((sample.wi - DVec3::Y).length() <= 0.0 && (sample.distance - 2e6).abs() <= 0.0);
        assert!(at(lamp.position).is_none());
        assert!(at(lamp.position + DVec3::X * 1e-30).is_none());
        assert!((lamp.power(0.0, 1.0) / (4.0 * PI) - 1.0).abs() <= 2.0 * f32::EPSILON);
    }
}
