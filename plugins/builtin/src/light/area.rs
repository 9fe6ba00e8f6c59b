//! A shape that shines.

use std::f32::consts::PI;

use glam::Vec2;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Light, LightForm};
use luxel_sdk::params::{Emission, Quantity, ShapeSlot};

/// A shape that shines, equally bright from everywhere (Lambertian). It shines to the side that its
/// normals point to, and its material still reflects.
///
/// ```scene
/// light area "lamp" {
///   shape    = shape rectangle { center = (0, 2, 0) m, u = (1, 0, 0) m, v = (0, 0, 1) m }
///   spectrum = blackbody(3000 K)
///   power    = 800 lm
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Area {
    /// What shines.
    #[param(required)]
    shape: ShapeSlot,
    /// Colour of the light; its amount is given apart. A texture tints it over the surface.
    #[param(emission(radiance, power, scale), textured)]
    emission: Emission,
    /// Whether the back shines too.
    #[param(default = false)]
    two_sided: bool,
}

impl Area {
    /// π times the shining area, sr·m².
    fn etendue(&self, area: f64) -> f32 {
        let sides = if self.two_sided { 2.0 } else { 1.0 };
        #[expect(clippy::cast_possible_truncation, reason = "rounds; radiance is f32")]
        let area = area as f32;
        PI * area * sides
    }

    fn radiance(&self, area: f64) -> Spectrum {
        match self.emission.quantity {
            // A shape without area shines nowhere; its radiance would be infinite.
            Quantity::Power if area <= 0.0 => Spectrum::ZERO,
            Quantity::Power => self.emission.spectrum / self.etendue(area),
            _ => self.emission.spectrum,
        }
    }
}

impl Light for Area {
    fn form(&self) -> LightForm {
        LightForm::Surface
    }

    fn le(&self, cos_o: f32, _uv: Vec2, area: f64) -> Spectrum {
        let shines = cos_o > 0.0 || (self.two_sided && cos_o < 0.0);
        if shines { self.radiance(area) } else { Spectrum::ZERO }
    }

    fn power(&self, area: f64, _scene_radius: f64) -> f32 {
        self.radiance(area).mean() * self.etendue(area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(quantity: Quantity, two_sided: bool) -> Area {
        let emission = Emission { spectrum: Spectrum::splat(10.0), quantity };
        Area { shape: ShapeSlot(0), emission, two_sided }
    }

    #[test]
    fn power_is_radiance_times_pi_times_the_shining_area() {
        for two_sided in [false, true] {
            let lamp = light(Quantity::Power, two_sided);
            let sides = if two_sided { 2.0 } else { 1.0 };
            let le = lamp.le(0.3, Vec2::ZERO, 0.25).lane(0);
            // Three roundings.
            let rel = le * PI * 0.25 * sides / 10.0 - 1.0;
            assert!(rel.abs() <= 4.0 * f32::EPSILON);
            assert!((lamp.power(0.25, 1.0) / 10.0 - 1.0).abs() <= 4.0 * f32::EPSILON);
            assert_eq!(lamp.le(-0.3, Vec2::ZERO, 0.25).is_black(), !two_sided);
        }
    }

    #[test]
    fn a_shape_without_area_gives_nothing_rather_than_infinity() {
        assert!(light(Quantity::Power, false).le(1.0, Vec2::ZERO, 0.0).is_black());
        assert!(light(Quantity::Radiance, false).le(f32::NAN, Vec2::ZERO, 1.0).is_black());
    }
}
