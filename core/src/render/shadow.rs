//! How much light passes along a shadow ray.

use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::Samples;
use luxel_sdk::num::{Ray, offset_origin};

use super::path::Path;
use crate::accel::Processor;
use crate::object::{Scratch, Site};
use crate::stage::{Leaving, Skin, Stage};

/// The fraction of light that passes along a ray that is not occluded: less through media. Surfaces
/// that are only the boundary of a medium are passed.
pub(super) fn passes(
    processor: Processor,
    stage: &Stage,
    ray: &Ray,
    path: &Path,
    samples: &mut Samples<'_>,
    scratch: &mut Scratch,
) -> Spectrum {
    if !stage.features.media && !stage.features.open_surfaces {
        return Spectrum::ONE;
    }
    let mut media = path.media_along(ray, stage);
    let mut from = path.leaving();
    let mut left = Spectrum::ONE;
    let mut ray = *ray;
    loop {
        let open = stage.features.open_surfaces;
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
        // The ray is not occluded, so what it meets is open; rounding may disagree at an edge.
        if left.is_black() || stage.placements[hit.placement as usize].skin != Skin::Open {
            return Spectrum::ZERO;
        }
        from = Some(Leaving::from(&hit));
        let surface = stage.surface(&ray, &hit);
        stage.cross(&mut media, hit.placement, ray.d, surface.ng);
        let o = offset_origin(surface.p, surface.p_err, surface.ng, ray.d);
        // The end stays where it was.
        let t_max = ray.t_max - (o - ray.o).dot(ray.d);
        ray = Ray { o, t_max, ..ray };
    }
}
