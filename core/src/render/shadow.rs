//! How much light passes along a shadow ray.

use luxel_sdk::color::{Palette, Spectrum};
use luxel_sdk::kind::Samples;
use luxel_sdk::num::{Ray, offset_origin};

use crate::object::{Scratch, Site};
use crate::stage::{MediumStack, Skin, Stage};

/// The fraction of light that passes along a ray: nothing behind a surface, less through media.
/// Surfaces that are only the boundary of a medium are passed.
pub(super) fn passes(
    stage: &Stage,
    ray: &Ray,
    mut media: MediumStack,
    palette: &Palette,
    samples: &mut Samples<'_>,
    scratch: &mut Scratch,
) -> Spectrum {
    if !stage.features.media && !stage.features.open_surfaces {
        return if stage.occluded(ray) { Spectrum::ZERO } else { Spectrum::ONE };
    }
    if stage.occluded(ray) {
        return Spectrum::ZERO;
    }
    let mut left = Spectrum::ONE;
    let mut ray = *ray;
    loop {
        let hit = if stage.features.open_surfaces { stage.intersect(&ray, &mut 0) } else { None };
        let t_max = hit.map_or(ray.t_max, |hit| hit.hit.t);
        if let Some(medium) = media.current(stage.outside) {
            scratch.reset();
            let uv = glam::Vec2::ZERO;
            let at = Site { p: ray.o, uv, palette };
            let medium = stage.media[medium as usize].resolve(&at, scratch).medium();
            left *= medium.transmittance(&Ray { t_max, ..ray }, samples);
        }
        let Some(hit) = hit else { return left };
        // The ray is not occluded, so what it meets is open; rounding may disagree at an edge.
        if left.is_black() || stage.placements[hit.placement as usize].skin != Skin::Open {
            return Spectrum::ZERO;
        }
        let surface = stage.surface(&ray, &hit);
        stage.cross(&mut media, hit.placement, ray.d, surface.ng);
        let o = offset_origin(surface.p, surface.p_err, surface.ng, ray.d);
        // The end stays where it was.
        let t_max = ray.t_max - (o - ray.o).dot(ray.d);
        ray = Ray { o, t_max, ..ray };
    }
}
