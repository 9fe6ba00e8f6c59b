//! An integrator that owns the whole picture, to be made your own.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, ArrivalKind, Ask, Host, Job, PathIntegrator, PathsRef, PictureIntegrator, PictureJob,
    Samples, Wants,
};

/// Light, followed from the lamps to where the camera sees it: what glass gathers comes out smooth,
/// what the camera sees in a mirror stays black. The camera must be a point: `perspective`.
///
/// ```scene
/// integrator template_name { paths = 4 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Paths from the lights, for each sample of each pixel.
    #[param(default = 1, min = 1, max = 16)]
    paths: u32,
}

impl PictureIntegrator for TemplateName {
    /// What the host prepares for all its paths together.
    fn wants(&self) -> Wants {
        FromCamera.wants().with(FromLights.wants())
    }

    /// Makes the picture: each pass gives every pixel one sample, and may hold as many runs of paths
    /// as you like. The host runs them on all threads.
    fn render(&self, job: &dyn PictureJob) {
        let pixels = job.raster().size.element_product();
        for _ in 0..job.samples() {
            if job.is_cancelled() {
                return;
            }
            job.run_camera_paths(PathsRef::new(&FromCamera));
            job.run_light_paths(pixels.saturating_mul(self.paths), PathsRef::new(&FromLights));
            job.finish_pass();
        }
    }
}

/// Paths that see what lies behind everything, where no light path ends.
struct FromCamera;

impl PathIntegrator for FromCamera {
    /// What a path remembers between arrivals: nothing here.
    type State = ();

    fn wants(&self) -> Wants {
        Wants::EMISSION
    }

    /// A path begins with the camera's ray.
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
        ask.add_glow(Spectrum::ONE, at);
    }
}

/// Paths that leave the lights and show themselves to the camera wherever they arrive.
struct FromLights;

/// A path on its way: what it carries, and what it began with.
#[derive(Clone, Copy, Default)]
struct Carried {
    beta: Spectrum,
    full: f32,
}

impl PathIntegrator for FromLights {
    type State = Carried;

    fn wants(&self) -> Wants {
        Wants::SIGHT.with(Wants::SCATTER)
    }

    /// A path begins with a ray that leaves a light, which the camera may see.
    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Carried {
        if let Some(sight) = job.sight.as_ref() {
            ask.splat_if_visible(sight, sight.f_we);
        }
        ask.trace(job.ray);
        Carried { beta: job.beta, full: job.beta.max_element() }
    }

    /// The path arrived: give light to the pixel that sees it, and go on by chance.
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
        let Some(scatter) = at.scatter.as_ref() else { return };
        path.beta *= at.reversed(scatter);
        // Russian roulette: it lives on with the chance of the share of its power that is left.
        let chance = (path.beta.max_element() / path.full).min(1.0);
        if chance > 0.0 && samples.next_1d() < chance {
            path.beta *= chance.recip();
            ask.trace(at.ray(scatter.wi));
        }
    }
}

luxel_sdk::plugin! { picture_integrator "template_name" => TemplateName; }
