//! A texture, a phase function and a medium.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Eval, FreeFlight, Lobe, Medium, Phase, PhaseRef, Sample, Samples, Texture, TexturePoint,
};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Maybe;
use luxel_sdk::sampling::{SPHERE_PDF, uniform_sphere};

/// From one value to another, again and again along u.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Gradient {
    /// Where u is whole.
    #[param(default = 0.2, textured)]
    pub(crate) from: Spectrum,
    /// Just before the next whole number.
    #[param(default = 0.8, textured)]
    pub(crate) to: Spectrum,
}

impl Texture for Gradient {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        let part = at.uv.x.rem_euclid(1.0);
        let part = if part.is_finite() { part } else { 0.0 };
        self.from + (self.to - self.from) * part
    }
}

/// Scatters alike in all directions.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Even {}

impl Phase for Even {
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
        Eval { f: Spectrum::splat(SPHERE_PDF), pdf: SPHERE_PDF }
    }

    fn sample(&self, _wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        let (weight, wi) = (Spectrum::ONE, uniform_sphere(u));
        Some(Sample { weight, wi, pdf: SPHERE_PDF, eta: 1.0, lobe: Lobe::NONE })
    }
}

/// Grey fog, the same everywhere.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Fog<'a> {
    /// Inverse of the mean free path.
    #[param(default = 1.0, unit = "1/m", min = 0, max = 1e6)]
    pub(crate) density: f32,
    /// Share of extinction that is scattering.
    #[param(default = 0.5, role = reflectance)]
    pub(crate) albedo: Spectrum,
    /// Radiance that it would have if it were endless and did not scatter.
    #[param(default = 0.0, unit = "W/m^2/sr", min = 0, max = 1e6)]
    pub(crate) glow: f32,
    /// Where scattered light goes.
    #[param(optional)]
    pub(crate) phase: PhaseRef<'a>,
}

impl Fog<'_> {
    #[expect(clippy::cast_possible_truncation, reason = "rounds; a fraction")]
    fn left(&self, t: f64) -> Spectrum {
        let depth = f64::from(self.density) * t;
        Spectrum::splat(if self.density > 0.0 { (-depth).exp() as f32 } else { 1.0 })
    }
}

impl Medium for Fog<'_> {
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        let u = f64::from(samples.next_1d());
        let t = -(-u).ln_1p() / f64::from(self.density);
        if t < ray.t_max {
            FreeFlight { t: Maybe::some(t.max(f64::MIN_POSITIVE)), weight: self.albedo }
        } else {
            FreeFlight { t: Maybe::default(), weight: Spectrum::ONE }
        }
    }

    fn transmittance(&self, ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
        self.left(ray.t_max)
    }

    fn glow(&self, ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
        let absorbed = Spectrum::ONE - self.albedo;
        absorbed * self.glow * (Spectrum::ONE - self.left(ray.t_max))
    }

    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}
