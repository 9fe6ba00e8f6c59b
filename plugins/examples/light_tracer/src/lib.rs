//! An integrator that owns the picture, as a plugin: light, followed the way it goes.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, ArrivalKind, Ask, Host, Job, PathIntegrator, PathsRef, PictureIntegrator, PictureJob,
    Samples, Wants,
};

/// Follows light from the lamps, and looks from every place where it arrives to the camera: caustics
/// that a path from the camera finds by chance alone are bright and smooth.
///
/// As many paths leave the lamps in a pass as the picture has pixels. The camera must be a point:
/// `perspective`. What it sees in a mirror or through smooth glass stays black, as no light that
/// goes there is found; lamps and the sky are seen directly, point lights are not. Media that glow
/// are dark to it.
///
/// ```scene
/// integrator light_tracer { max_depth = 64 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct LightTracer {
    /// How often light is scattered at most: 0 shows lights alone, 1 direct light. The default is
    /// as good as without limit.
    #[param(default = 1_000_000, min = 0, max = 4_294_967_295u32)]
    max_depth: u32,
    /// The scattering event from which a path may end by chance, counted from 0. Costs noise, saves
    /// time, biases nothing.
    #[param(default = 3, min = 0, max = 4_294_967_295u32)]
    russian_roulette_from: u32,
}

impl PictureIntegrator for LightTracer {
    fn wants(&self) -> Wants {
        Sky.wants().with(Light(*self).wants())
    }

    fn has_independent_passes(&self) -> bool {
        true
    }

    fn render(&self, job: &dyn PictureJob) {
        let size = job.raster().size;
        for _ in 0..job.samples() {
            if job.is_cancelled() {
                return;
            }
            job.run_camera_paths(PathsRef::new(&Sky));
            job.run_light_paths(size.x.saturating_mul(size.y), PathsRef::new(&Light(*self)));
            job.finish_pass();
        }
    }
}

/// Paths from the lights.
struct Light(LightTracer);

/// A path on its way.
#[derive(Clone, Copy, Default)]
struct Carried {
    /// Power.
    beta: Spectrum,
    /// What it began with: paths end by chance of what is left of it.
    full: f32,
    /// Scattering events so far.
    depth: u32,
}

impl PathIntegrator for Light {
    type State = Carried;

    fn wants(&self) -> Wants {
        Wants::SIGHT.with(Wants::SCATTER)
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Carried {
        if let Some(sight) = job.sight.as_ref() {
            ask.splat_if_visible(sight, sight.f_we);
        }
        if self.0.max_depth > 0 {
            ask.trace(job.ray);
        }
        Carried { beta: job.beta, full: job.beta.max_element(), depth: 0 }
    }

    fn arrive(
        &self,
        path: &mut Carried,
        at: &Arrival,
        samples: &mut Samples<'_>,
        _host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        if let Some(sight) = at.sight.as_ref() {
            ask.splat_if_visible(sight, path.beta * sight.f_we);
        }
        path.depth += 1;
        let Some(scatter) = at.scatter.as_ref() else { return };
        if path.depth >= self.0.max_depth {
            return;
        }
        path.beta *= at.reversed(scatter);
        if self.survives(path, samples) {
            ask.trace(at.ray(scatter.wi));
        }
    }
}

impl Light {
    /// Russian roulette: a path lives on with the chance of the share of its power that is left.
    fn survives(&self, path: &mut Carried, samples: &mut Samples<'_>) -> bool {
        let chance = path.beta.max_element() / path.full;
        // A NaN ends the path too.
        let hopeless = !(chance > 0.0 && chance.is_finite());
        if hopeless || path.depth <= self.0.russian_roulette_from {
            return !hopeless;
        }
        let u = samples.next_1d();
        if chance < 1.0 {
            path.beta *= chance.recip();
            return u < chance;
        }
        true
    }
}

/// Paths from the camera, one ray long: what lies behind everything.
struct Sky;

impl PathIntegrator for Sky {
    type State = ();

    fn wants(&self) -> Wants {
        Wants::EMISSION
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) {
        ask.trace(job.ray);
    }

    fn arrive(
        &self,
        (): &mut (),
        at: &Arrival,
        _samples: &mut Samples<'_>,
        _host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        if at.kind == ArrivalKind::Escaped {
            ask.add(at.le);
        }
    }
}

luxel_sdk::plugin! { picture_integrator "light_tracer" => LightTracer; }
