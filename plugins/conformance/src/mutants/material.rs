//! Matt surfaces with a fault.

use std::f32::consts::PI;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Material, Needs, Sample};

use super::Mutant;
use crate::reference::Matt;

/// A matt material whose values and samples pass through two functions.
macro_rules! faulty {
    ($name:ident, $eval:expr, $sample:expr) => {
        /// A matt surface with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Fraction of light reflected.
            #[param(default = 0.5, role = reflectance, textured)]
            reflectance: Spectrum,
        }

        impl Material for $name {
            fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
                let change: fn(Eval, Vec3, Vec3) -> Eval = $eval;
                change(Matt { reflectance: self.reflectance }.eval(wo, wi), wo, wi)
            }

            fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
                let change: fn(Sample, Vec3) -> Sample = $sample;
                let sample = Matt { reflectance: self.reflectance }.sample(wo, u)?;
                Some(change(sample, wo))
            }

            fn needs(&self) -> Needs {
                Needs::LIGHT
            }
        }
    };
}

fn scaled(eval: Eval, f: f32, pdf: f32) -> Eval {
    Eval { f: eval.f * f, pdf: eval.pdf * pdf }
}

/// 1 for both cosines alike, but not the same when they are exchanged.
fn lean(wo: Vec3) -> f32 {
    0.5 + 0.5 * wo.z.abs()
}

faulty!(WithoutPi, |e, _, _| scaled(e, 1.0, PI), |s, _| Sample {
    pdf: s.pdf * PI,
    weight: s.weight / PI,
    ..s
});
faulty!(NotReciprocal, |e, wo, _| scaled(e, lean(wo), 1.0), |s, wo| Sample {
    weight: s.weight * lean(wo),
    ..s
});
faulty!(MoreThanArrives, |e, _, _| scaled(e, 1.04, 1.0), |s, _| Sample {
    weight: s.weight * 1.04,
    ..s
});
faulty!(
    NanAtGrazing,
    |e, wo, _| if wo.z.abs() < 2e-6 { scaled(e, (-wo.z.abs()).sqrt(), 1.0) } else { e },
    |s, _| s
);
faulty!(DensityTooHigh, |e, _, _| scaled(e, 1.0, 1.02), |s, _| Sample {
    pdf: s.pdf * 1.02,
    weight: s.weight / 1.02,
    ..s
});

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::material::<WithoutPi>("without_pi"), fault: "pdf without 1/π" },
    Mutant {
        class: Class::material::<NotReciprocal>("not_reciprocal"),
        fault: "depends on wo only",
    },
    Mutant { class: Class::material::<MoreThanArrives>("more_than_arrives"), fault: "+4 % energy" },
    Mutant { class: Class::material::<NanAtGrazing>("nan_at_grazing"), fault: "NaN at cos 1e-6" },
    Mutant { class: Class::material::<DensityTooHigh>("density_too_high"), fault: "pdf +2 %" },
];
