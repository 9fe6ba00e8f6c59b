//! Unidirectional path tracing (Kajiya 1986) with light sampling (Veach 1997).

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, Ask, Host, Job, PathIntegrator, Samples, Wants, mis};

/// Light as it is: follows every path from the camera to the lights, through surfaces and media,
/// and looks for a light at every corner. Unbiased unless `max_depth` cuts paths off.
///
/// ```scene
/// integrator path { max_depth = 64, russian_roulette_from = 5 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct PathTracer {
    /// How often light is scattered at most: 0 shows lights alone, 1 direct light. The default is
    /// as good as without limit.
    #[param(default = 1_000_000, min = 0, max = 4_294_967_295u32)]
    pub(crate) max_depth: u32,
    /// The scattering event from which a path may end by chance, counted from 0. Costs noise, saves
    /// time, biases nothing.
    #[param(default = 3, min = 0, max = 4_294_967_295u32)]
    pub(crate) russian_roulette_from: u32,
    /// The throughput below which it may: a path of a tenth of this lives on with a chance of a tenth,
    /// and then counts as much as this (a weight window). 1 takes less time and has more noise than
    /// that is worth where walls light one another; 0 ends no path.
    #[param(default = 0.25, min = 0, max = 1)]
    pub(crate) russian_roulette_below: f32,
    /// Whether lights are looked for at every corner. Without, only paths that meet one count.
    #[param(default = true)]
    pub(crate) light_sampling: bool,
}

/// A path on its way.
#[derive(Clone, Copy, Default)]
pub(crate) struct Path {
    /// What radiance that arrives from here on counts for.
    beta: Spectrum,
    /// Density of the last direction; infinite where light sampling could not have found it.
    pdf: f32,
    /// Product of the squared relative indices: what `beta` lost to refraction alone.
    eta_scale: f32,
    /// Scattering events so far.
    depth: u32,
}

impl PathIntegrator for PathTracer {
    type State = Path;

    fn wants(&self) -> Wants {
        let wants = Wants::EMISSION.with(Wants::SCATTER);
        if self.light_sampling { wants.with(Wants::DIRECT) } else { wants }
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Path {
        ask.trace(job.ray);
        Path { beta: Spectrum::ONE, pdf: f32::INFINITY, eta_scale: 1.0, depth: 0 }
    }

    fn arrive(
        &self,
        path: &mut Path,
        at: &Arrival,
        samples: &mut Samples<'_>,
        _host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        if !at.le.is_black() {
            let found_by_chance = if self.light_sampling { mis(path.pdf, at.le_pdf) } else { 1.0 };
            ask.add(path.beta * at.le * found_by_chance);
        }
        ask.add_glow(path.beta, at);
        if path.depth >= self.max_depth {
            return;
        }
        if let Some(direct) = at.direct.as_ref() {
            let weight = mis(direct.pdf, direct.f_pdf);
            ask.add_if_visible(direct.ray, path.beta * direct.f_le * weight);
        }
        let Some(scatter) = at.scatter.as_ref() else { return };
        path.beta *= scatter.weight;
        path.pdf = scatter.pdf;
        path.eta_scale *= scatter.eta * scatter.eta;
        if self.survives(path, samples) {
            path.depth += 1;
            ask.trace(at.ray(scatter.wi));
        }
    }
}

impl PathTracer {
    /// Russian roulette by throughput, refraction aside, below a window of weights (PBR4 §13.2.1;
    /// Booth 1985).
    fn survives(&self, path: &mut Path, samples: &mut Samples<'_>) -> bool {
        let throughput = path.beta.max_element() * path.eta_scale;
        // A NaN ends the path too.
        let hopeless = !(throughput > 0.0 && throughput.is_finite());
        if hopeless || path.depth < self.russian_roulette_from {
            return !hopeless;
        }
        let u = samples.next_1d();
        let chance = throughput / self.russian_roulette_below;
        if chance < 1.0 {
            path.beta *= chance.recip();
            return u < chance;
        }
        true
    }
}
