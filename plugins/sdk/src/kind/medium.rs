//! What fills space: absorption and scattering along a ray.

use super::{PhaseRef, Samples};
use crate::color::Spectrum;
use crate::num::Ray;
use crate::params::{Fault, Maybe};

/// How far a ray flew freely.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct FreeFlight {
    /// Where it met the medium; absent when it passed through to `t_max`.
    pub t: Maybe<f64>,
    /// Transmittance (times the scattering coefficient where it met the medium) over the density
    /// with which this was chosen; its mean is 1 in a medium that absorbs nothing.
    pub weight: Spectrum,
}

/// What fills space. Rays are in world space, direction of unit length, `t` in metres.
pub trait Medium: Send + Sync {
    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// Chooses how far a ray flies before it is scattered, up to `ray.t_max` (may be infinite).
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight;

    /// The fraction of light that passes along the ray up to `ray.t_max`.
    fn transmittance(&self, ray: &Ray, samples: &mut Samples<'_>) -> Spectrum;

    /// The light that it sends itself towards where the ray begins, from up to `ray.t_max` and dimmed by
    /// what of it lies between: ∫ transmittance · emission dt, radiance. Asked for each flight, wherever
    /// that ends.
    ///
    /// # Source
    /// PBR4 §11.1.2, §14.1.
    fn glow(&self, _ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
        Spectrum::ZERO
    }

    /// How it scatters.
    fn phase(&self) -> PhaseRef<'_>;
}
