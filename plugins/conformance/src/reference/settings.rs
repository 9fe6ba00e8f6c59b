//! Camera, sampler, filter and integrator.

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, Ask, Camera, CameraRay, Filter, Host, Job, PathIntegrator, Raster, SampleAt, Sampler,
    Samples, Wants, mis,
};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Look;
use luxel_sdk::sampling::{hash_combine64, u32_to_unit};

/// A camera without a lens.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Pinhole {
    /// Where it stands.
    #[param(required)]
    pub(crate) look: Look,
    /// Half the picture's height at the distance 1.
    #[param(default = 0.5, min = 1e-3, max = 1e3)]
    pub(crate) tan: f64,
}

impl Camera for Pinhole {
    fn ray(&self, raster: Raster, p: DVec2, _lens: [f32; 2]) -> Option<CameraRay> {
        let (right, up, backward) = self.look.axes();
        let s = raster.to_screen(p) * self.tan;
        let d = (right * s.x + up * s.y - backward).normalize();
        Some(CameraRay { ray: Ray::new(self.look.from, d), weight: 1.0 })
    }

    fn project(&self, raster: Raster, p: DVec3) -> Option<DVec2> {
        let (right, up, backward) = self.look.axes();
        let d = p - self.look.from;
        let depth = -d.dot(backward);
        let s = DVec2::new(d.dot(right), d.dot(up)) / (depth * self.tan);
        (depth > 0.0).then(|| raster.of_screen(s))
    }
}

/// Independent numbers.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Numbers {
    /// Samples for each pixel.
    #[param(default = 64, min = 1, max = 4_294_967_295u32)]
    pub(crate) samples: u32,
    /// Equal seeds give equal numbers.
    #[param(default = 0, min = 0, max = 4_294_967_295u32)]
    pub(crate) seed: u32,
}

impl Sampler for Numbers {
    fn samples(&self) -> u32 {
        self.samples
    }

    fn seed(&self) -> u32 {
        self.seed
    }

    fn get_1d(&self, at: SampleAt) -> f32 {
        self.get_2d(at)[0]
    }

    #[expect(clippy::cast_possible_truncation, reason = "the hash is split into its two halves")]
    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        let path = (u64::from(at.stream) << 32) | u64::from(at.index);
        let bits = hash_combine64(path, u64::from(at.dimension));
        [u32_to_unit((bits >> 32) as u32), u32_to_unit(bits as u32)]
    }
}

/// Every place of a pixel counts alike.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Block {
    /// Half the width, pixels.
    #[param(default = 0.5, min = 0.01, max = 16)]
    pub(crate) radius: f32,
}

impl Filter for Block {
    fn radius(&self) -> f32 {
        self.radius
    }

    fn eval(&self, offset: [f32; 2]) -> f32 {
        let inside = offset.iter().all(|x| x.abs() <= self.radius);
        if inside { 0.25 / (self.radius * self.radius) } else { 0.0 }
    }

    fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        u.map(|u| (2.0 * u - 1.0) * self.radius)
    }
}

/// Follows paths to their end and looks for a light at every corner.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Walk {}

/// A path on its way: its throughput and the density of its last direction.
#[derive(Clone, Copy, Default)]
pub(crate) struct Way {
    pub(crate) beta: Spectrum,
    pub(crate) pdf: f32,
}

impl PathIntegrator for Walk {
    type State = Way;

    fn wants(&self) -> Wants {
        Wants::EMISSION.with(Wants::SCATTER).with(Wants::DIRECT)
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Way {
        ask.trace(job.ray);
        Way { beta: Spectrum::ONE, pdf: f32::INFINITY }
    }

    fn arrive(
        &self,
        way: &mut Way,
        at: &Arrival,
        samples: &mut Samples<'_>,
        _host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        ask.add(way.beta * at.le * mis(way.pdf, at.le_pdf));
        ask.add_glow(way.beta, at);
        if let Some(direct) = at.direct.as_ref() {
            ask.add_if_visible(direct.ray, way.beta * direct.f_le * mis(direct.pdf, direct.f_pdf));
        }
        let Some(scatter) = at.scatter.as_ref() else { return };
        way.beta *= scatter.weight;
        way.pdf = scatter.pdf;
        let chance = way.beta.max_element().min(1.0);
        if samples.next_1d() < chance {
            way.beta /= chance;
            ask.trace(at.ray(scatter.wi));
        }
    }
}
