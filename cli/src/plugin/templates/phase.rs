//! A phase function, to be made your own.

use std::f64::consts::{PI, TAU};

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Phase, Sample};
use luxel_sdk::num::Frame;

/// Clear air: scatters ahead and back twice as much as to the side (Rayleigh), as far as `share` says;
/// the rest alike in all directions.
///
/// ```scene
/// let air = phase template_name { share = 1 }
/// let sky = medium homogeneous { sigma_t = 1 / (9 m), albedo = 1, phase = air }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Share of the light that is scattered as in clear air.
    #[param(default = 1.0, min = 0, max = 1, textured)]
    share: f32,
}

impl TemplateName {
    /// The phase function, sr⁻¹, at a cosine: its integral over the sphere is 1.
    fn value(&self, cos: f64) -> f32 {
        let (air, even) = (3.0 / (16.0 * PI) * (1.0 + cos * cos), 1.0 / (4.0 * PI));
        let share = f64::from(self.share);
        (even + (air - even) * share) as f32
    }
}

impl Phase for TemplateName {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        let pdf = self.value(f64::from(wo.dot(wi)));
        if pdf.is_finite() { Eval { f: Spectrum::splat(pdf), pdf } } else { Eval::ZERO }
    }

    /// Chooses one of the two lobes, then a cosine by inverting its distribution; samples have the
    /// density of the phase function itself, so their weight is 1.
    fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        let ([u, v], share) = (u.map(f64::from), f64::from(self.share));
        let cos = if u < share {
            // Of Rayleigh's: a cubic equation with one real root.
            let q = 4.0 * (u / share) - 2.0;
            let a = (q + (q * q + 1.0).sqrt()).cbrt();
            a - a.recip()
        } else {
            1.0 - 2.0 * ((u - share) / (1.0 - share))
        };
        let cos = cos.clamp(-1.0, 1.0);
        let sin = (1.0 - cos * cos).sqrt();
        let (y, x) = (TAU * v).sin_cos();
        let local = Vec3::new((sin * x) as f32, (sin * y) as f32, cos as f32);
        let wi = Frame::from_z(wo).to_world(local).normalize();
        let pdf = self.value(cos);
        let sample = Sample { weight: Spectrum::ONE, wi, pdf, eta: 1.0, lobe: Lobe::NONE };
        (wi.is_finite() && pdf > 0.0).then_some(sample)
    }
}

luxel_sdk::plugin! { phase "template_name" => TemplateName; }
