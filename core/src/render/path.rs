//! What the host remembers of a path in flight.

use glam::DVec3;
use luxel_sdk::color::{Palette, Spectrum, Wavelengths};
use luxel_sdk::kind::CameraRay;
use luxel_sdk::num::Ray;

use crate::stage::{Emitted, Leaving, MediumStack, Moment, Stage};

/// One path, beside the integrator's own state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    /// Which of the tile's samples it is.
    pub(super) job: u32,
    /// The moment that it sees, seconds.
    pub(super) time: f64,
    /// What its radiance counts for.
    pub(super) weight: f32,
    pub(super) palette: Palette,
    /// Whether its other wavelengths have ended at a dispersive surface.
    pub(super) ended: bool,
    /// Where it last arrived: light sampling from there competes with the ray that goes on.
    pub(super) from: DVec3,
    /// The surface it stands on.
    pub(super) on: Option<Standing>,
    /// Which source its last light sample is of.
    pub(super) light: u32,
    /// The media around it, on the side it came from.
    pub(super) media: MediumStack,
    /// What it would be in beyond that surface.
    pub(super) beyond: MediumStack,
}

/// A surface that a path stands on: enough to know which side a ray leaves to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    pub(super) leaving: Leaving,
    pub(super) p: DVec3,
    pub(super) ng: DVec3,
    /// Whether the path came from the outside.
    pub(super) outside: bool,
}

impl Standing {
    /// Whether a ray that leaves from here is outside: its origin tells, for its direction may dip
    /// below a facet that stands for a smooth surface.
    fn is_outside(&self, ray: &Ray) -> bool {
        let height = (ray.o - self.p).dot(self.ng);
        if height == 0.0 { ray.d.dot(self.ng) > 0.0 } else { height > 0.0 }
    }
}

impl Path {
    /// No path yet.
    pub(super) fn new(stage: &Stage) -> Self {
        let (palette, media) = (Palette::rgb(), stage.camera_media);
        let (from, beyond) = (DVec3::ZERO, media);
        let time = stage.film.time;
        let (job, weight, light, ended) = (0, 0.0, 0, false);
        Self { job, time, weight, palette, ended, from, on: None, light, media, beyond }
    }

    /// A path begins at the camera at a moment; `u` chooses the wavelengths, if there are any.
    pub(super) fn start(&mut self, job: u32, found: &CameraRay, u: f32, stage: Moment<'_>) {
        self.time = stage.time;
        if stage.mode.is_spectral() {
            self.palette = Palette::new(Wavelengths::sample(u));
        }
        (self.job, self.weight, self.from) = (job, found.weight, found.ray.o);
        (self.ended, self.on) = (false, None);
        if stage.features.is_tracked() {
            self.media = if stage.needed.motion() {
                stage.media_at(found.ray.o)
            } else {
                stage.camera_media
            };
        }
    }

    /// A path begins at a light; its wavelengths are chosen already.
    pub(super) fn start_at_light(&mut self, job: u32, found: &Emitted) {
        (self.job, self.weight, self.from) = (job, 1.0, found.ray.o);
        (self.ended, self.media, self.beyond) = (false, found.media, found.media);
        self.on = found.lamp.map(|lamp| {
            let (p, ng) = (lamp.surface.p, lamp.surface.ng);
            Standing { leaving: lamp.leaving, p, ng, outside: found.ray.d.dot(ng) > 0.0 }
        });
    }

    /// The surface that a ray from here leaves.
    pub(super) fn leaving(&self) -> Option<Leaving> {
        self.on.map(|on| on.leaving)
    }

    /// What a ray that leaves from here is in.
    pub(super) fn media_along(&self, ray: &Ray) -> MediumStack {
        match self.on {
            Some(on) if on.is_outside(ray) != on.outside => self.beyond,
            _ => self.media,
        }
    }

    /// What a dispersive refraction leaves of the lanes: the first stands for all four.
    ///
    /// # Source
    /// Wilkie et al. 2014, §4; PBR4 §4.5.4.
    pub(super) fn end_secondary(&mut self) -> Spectrum {
        let first = if self.ended { 1.0 } else { 4.0 };
        self.ended = true;
        Spectrum::new(first, 0.0, 0.0, 0.0)
    }
}
