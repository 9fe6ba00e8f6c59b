//! What paths from lights need: the way to the camera, and scattering seen the other way round.

use glam::DVec3;

use super::{Arrival, ArrivalKind, Scatter};
use crate::color::Spectrum;
use crate::num::Ray;

/// Where the camera sees a place, and how bright.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Sight {
    /// From the place to the camera's eye, which is its end.
    pub ray: Ray,
    /// Which pixel sees it, by its place in the picture's rows, upper left first.
    pub pixel: u32,
    /// What one unit of the path's `beta` adds to the estimate of that pixel, where this is the only
    /// path. The host divides by how many there are.
    pub f_we: Spectrum,
}

impl Default for Sight {
    /// Nothing, in no pixel.
    fn default() -> Self {
        let ray = Ray::new(DVec3::ZERO, DVec3::Z);
        Self { ray, pixel: u32::MAX, f_we: Spectrum::ZERO }
    }
}

impl Arrival {
    /// What a path from a light keeps of its `beta` when it goes on along `scatter`. The sample was
    /// drawn for light that comes back along `scatter.wi`; the path's light leaves that way.
    ///
    /// Black where a path from the camera would carry nothing in the other direction: where the
    /// light comes from a side that the shading normal hides.
    ///
    /// # Source
    /// Veach 1997, §5.3: eq. 5.19 for shading normals, eq. 5.14 for refraction.
    pub fn reversed(&self, scatter: &Scatter) -> Spectrum {
        let weight = scatter.weight * (scatter.eta * scatter.eta);
        if self.kind != ArrivalKind::Surface {
            return weight;
        }
        let agree = |d: DVec3| (d.dot(self.ns) > 0.0) == (d.dot(self.ng) > 0.0);
        if !agree(self.wo) {
            // The host has scattered about the geometric normal, as a camera below the shading
            // normal does: then no cosine differs.
            return if agree(scatter.wi) { Spectrum::ZERO } else { weight };
        }
        let away = scatter.wi.dot(self.ng) * self.wo.dot(self.ns);
        let towards = scatter.wi.dot(self.ns) * self.wo.dot(self.ng);
        #[expect(clippy::cast_possible_truncation, reason = "rounds; weights are f32")]
        let ratio = (away / towards).abs() as f32;
        if ratio.is_finite() { weight * ratio } else { Spectrum::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ns: DVec3, wo: DVec3) -> Arrival {
        Arrival { kind: ArrivalKind::Surface, ng: DVec3::Z, ns, wo, ..Arrival::default() }
    }

    fn along(wi: DVec3, eta: f32) -> Scatter {
        Scatter { weight: Spectrum::splat(0.5), wi, pdf: 1.0, eta }
    }

    #[test]
    fn a_flat_surface_scatters_light_as_it_scatters_sight() {
        let wi = DVec3::new(0.6, 0.0, 0.8);
        let flat = at(DVec3::Z, DVec3::new(-0.28, 0.0, 0.96));
        assert_eq!(flat.reversed(&along(wi, 1.0)), Spectrum::splat(0.5));
        // Light that enters glass keeps its power: what sight lost by 1/eta² comes back.
        assert_eq!(flat.reversed(&along(-wi, 1.5)), Spectrum::splat(0.5 * 2.25));
    }

    #[test]
    fn a_bent_normal_weighs_light_by_the_four_cosines() {
        let ns = DVec3::new(0.6, 0.0, 0.8);
        let (wo, wi) = (DVec3::Z, DVec3::new(0.8, 0.0, 0.6));
        let got = at(ns, wo).reversed(&along(wi, 1.0)).lane(0);
        // |wi·ng||wo·ns| / (|wi·ns||wo·ng|) = 0.6·0.8 / (0.96·1), two roundings.
        assert!((got / (0.5 * 0.48 / 0.96) - 1.0).abs() < 4.0 * f32::EPSILON, "{got}");
    }

    #[test]
    fn light_from_below_the_shading_normal_goes_only_where_a_camera_would_see_it() {
        let ns = DVec3::new(0.6, 0.0, 0.8);
        let below = at(ns, DVec3::new(-0.96, 0.0, 0.28));
        assert!(below.reversed(&along(DVec3::Z, 1.0)).is_black());
        let hidden = along(DVec3::new(-0.9, 0.0, 0.19f64.sqrt()), 1.0);
        assert_eq!(below.reversed(&hidden), Spectrum::splat(0.5));
    }
}
