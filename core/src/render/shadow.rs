//! How much light passes along a shadow ray.

use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::Samples;
use luxel_sdk::num::{Ray, offset_origin};

use super::path::Path;
use crate::accel::Processor;
use crate::object::{Scratch, Site};
use crate::stage::{Leaving, Moment};

/// The fraction of light that passes along a ray that is not occluded: less through media. Surfaces
/// that rays pass are passed. Where shapes may be nested, the ray may be occluded yet.
pub(super) fn passes(
    processor: Processor,
    stage: Moment<'_>,
    ray: &Ray,
    path: &Path,
    samples: &mut Samples<'_>,
    scratch: &mut Scratch,
) -> Spectrum {
    let mut media = path.media_along(ray);
    let mut from = path.leaving();
    let mut left = Spectrum::ONE;
    let mut ray = *ray;
    loop {
        let open = stage.features.is_open();
        let hit = if open { stage.intersect(processor, &ray, from, &mut 0) } else { None };
        let t_max = hit.map_or(ray.t_max, |hit| hit.hit.t);
        if let Some((medium, t_max)) = stage.medium_along(&media, &Ray { t_max, ..ray }) {
            scratch.reset();
            let uv = glam::Vec2::ZERO;
            let at = Site { p: ray.o, uv, palette: &path.palette, color: None };
            let medium = stage.media[medium as usize].resolve(&at, scratch).medium();
            left *= medium.transmittance(&Ray { t_max, ..ray }, samples);
        }
        let Some(hit) = hit else { return left };
        if left.is_black() {
            return Spectrum::ZERO;
        }
        let crossing = stage.crossing(processor, &media, &ray, &hit);
        if crossing.met.is_some() {
            return Spectrum::ZERO;
        }
        from = Some(Leaving::from(&hit));
        media = crossing.beyond;
        let surface = &crossing.surface;
        let o = offset_origin(surface.p, surface.p_err, surface.ng, ray.d);
        // The end stays where it was.
        let t_max = ray.t_max - (o - ray.o).dot(ray.d);
        ray = Ray { o, t_max, ..ray };
    }
}
