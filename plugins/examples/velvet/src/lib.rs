//! A material with a textured parameter, as a plugin: cloth that shines at its edges.

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Material, Needs, Sample};
use luxel_sdk::sampling::uniform_hemisphere;
use luxel_sdk::scattering::same_side;

/// Velvet: fibres that stand upright light up where one looks along the cloth.
///
/// ```scene
/// let curtain = material velvet { color = rgb.linear_srgb(0.195, 0.005, 0.014), sheen = 0.8 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct Velvet {
    /// Fraction of light that the fibres reflect at most.
    #[param(default = 0.5, role = reflectance, textured)]
    color: Spectrum,
    /// From 0, matt cloth, to 1, fibres alone.
    #[param(default = 0.7, min = 0, max = 1, textured)]
    sheen: f32,
}

impl Velvet {
    /// The share of `color` that is scattered from one cosine to the other, per steradian:
    /// (1 − s)/π of matt cloth, and s·(1 − `cos_i`)·(1 − `cos_o`)·3/π of fibres, whose albedo is
    /// 1 − `cos_o`, at most 1. It is the same both ways.
    fn f(&self, cos_o: f32, cos_i: f32) -> f32 {
        let fibres = 3.0 * (1.0 - cos_o) * (1.0 - cos_i);
        FRAC_1_PI * (1.0 - self.sheen + self.sheen * fibres)
    }
}

impl Material for Velvet {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if !same_side(wo, wi) {
            return Eval::ZERO;
        }
        let (cos_o, cos_i) = (wo.z.abs().min(1.0), wi.z.abs().min(1.0));
        Eval { f: self.color * (self.f(cos_o, cos_i) * cos_i), pdf: 1.0 / TAU }
    }

    /// Alike in all directions: the fibres prefer low ones, the cloth high ones.
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        let up = uniform_hemisphere([u[0], u[1]]);
        let wi = Vec3::new(up.x, up.y, up.z.copysign(wo.z));
        Sample::of(wi, self.eval(wo, wi))
    }

    fn needs(&self) -> Needs {
        Needs::LIGHT
    }
}

luxel_sdk::plugin! { material "velvet" => Velvet; }
