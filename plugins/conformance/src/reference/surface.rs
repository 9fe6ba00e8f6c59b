//! A matt surface.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::sampling::cosine_hemisphere;

/// Reflects alike in all directions (Lambert).
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Matt {
    /// Fraction of light reflected.
    #[param(default = 0.5, role = reflectance, textured)]
    pub(crate) reflectance: Spectrum,
}

impl Material for Matt {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if !(wo.z * wi.z > 0.0) {
            return Eval::ZERO;
        }
        let pdf = wi.z.abs() * FRAC_1_PI;
        Eval { f: self.reflectance * pdf, pdf }
    }

    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        let up = cosine_hemisphere([u[0], u[1]]);
        let possible = wo.z.abs() > 0.0 && up.z > 0.0;
        possible.then_some(Sample {
            weight: self.reflectance,
            wi: Vec3::new(up.x, up.y, up.z.copysign(wo.z)),
            pdf: up.z * FRAC_1_PI,
            eta: 1.0,
            lobe: Lobe::NONE,
        })
    }

    fn needs(&self) -> Needs {
        Needs::LIGHT
    }
}

/// Lets light through, and spreads it alike over the other side.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Veil {
    /// Fraction of light that passes.
    #[param(default = 0.8, role = reflectance, textured)]
    pub(crate) transmittance: Spectrum,
}

impl Material for Veil {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        Matt { reflectance: self.transmittance }.eval(wo, -wi)
    }

    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        let s = Matt { reflectance: self.transmittance }.sample(wo, u)?;
        Some(Sample { wi: -s.wi, lobe: Lobe::TRANSMISSION, ..s })
    }

    fn needs(&self) -> Needs {
        Needs::LIGHT
    }
}
