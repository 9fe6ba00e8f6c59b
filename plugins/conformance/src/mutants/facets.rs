//! Brushed metals with a fault.

use std::f32::consts::FRAC_1_PI;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::{Vec2, Vec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::sampling::{cosine_hemisphere, hash32, u32_to_unit};
use luxel_sdk::scattering::{Ggx, same_side};

use super::Mutant;

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Sound,
    ExchangesAxes,
    HidesTangent,
    DensityOfAllFacets,
    DarkInside,
    BrightAtGrazing,
    PaleGreen,
    RollsItsOwn,
    UnevenChoice,
}

/// A mirror in facets, mixed with chalk in equal parts.
struct Metal {
    reflectance: Spectrum,
    facets: Ggx,
    isotropic: bool,
    fault: Fault,
}

/// Chance of the facets.
const HALF: f32 = 0.5;

impl Metal {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if !same_side(wo, wi) || (self.fault == Fault::DarkInside && wo.z < 0.0) {
            return Eval::ZERO;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let mut facets = self.facets;
        if self.fault == Fault::ExchangesAxes {
            facets.alpha = Vec2::new(facets.alpha.y, facets.alpha.x);
        }
        let wm = (wo + wi).normalize();
        let shine = 0.25 * facets.d(wm) * facets.g2_over_cos_o(wo, wi);
        let chalk = FRAC_1_PI * wi.z;
        let mut pdf = 0.25 * facets.visible_over_cos(wo, wm);
        if self.fault == Fault::DensityOfAllFacets {
            pdf = 0.25 * facets.d(wm) * wm.z / wo.dot(wm);
        }
        let pdf = pdf * HALF + chalk * (1.0 - HALF);
        let mut f = self.reflectance * (shine * HALF + chalk * (1.0 - HALF));
        if self.fault == Fault::PaleGreen {
            f *= Spectrum::new(1.0, 0.96, 1.0, 1.0);
        }
        Eval { f, pdf }
    }

    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        static ROLLED: AtomicU32 = AtomicU32::new(0);
        let up = if wo.z < 0.0 { -wo } else { wo };
        if !(up.z > 0.0) {
            return None;
        }
        let mut choice = u[2];
        if self.fault == Fault::RollsItsOwn {
            choice = u32_to_unit(hash32(ROLLED.fetch_add(1, Ordering::Relaxed)));
        } else if self.fault == Fault::UnevenChoice {
            choice *= 0.95;
        }
        let wi = if choice < HALF {
            let wm = self.facets.sample(up, [u[0], u[1]]);
            (2.0 * up.dot(wm) * wm - up).normalize()
        } else {
            cosine_hemisphere([u[0], u[1]])
        };
        // The sample is right in itself: only `eval` has faults.
        let Eval { f, pdf } = Self { fault: Fault::Sound, ..*self }.eval(up, wi);
        let mut weight = f / pdf;
        if self.fault == Fault::BrightAtGrazing && up.z < 0.2 {
            weight *= 1.05;
        }
        let wi = if wo.z < 0.0 { -wi } else { wi };
        let sample = Sample { weight, wi, pdf, eta: 1.0, lobe: Lobe::NONE };
        (pdf > 0.0 && weight.is_finite()).then_some(sample)
    }

    fn needs(&self) -> Needs {
        if self.isotropic || self.fault == Fault::HidesTangent {
            return Needs::LIGHT.with(Needs::CHOICE);
        }
        Needs::ALL
    }
}

macro_rules! metal {
    ($name:ident) => {
        /// A brushed metal with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Fraction of light reflected.
            #[param(default = 0.5, role = reflectance, textured)]
            reflectance: Spectrum,
            /// GGX roughness.
            #[param(default = 0.4, min = 0.05, max = 1, textured)]
            roughness: f32,
            /// How much highlights are stretched.
            #[param(default = 0.5, min = -0.8, max = 0.8, textured)]
            anisotropy: f32,
        }

        impl $name {
            fn metal(&self) -> Metal {
                let facets = Ggx::anisotropic(self.roughness, self.anisotropy);
                let isotropic = self.anisotropy == 0.0;
                Metal { reflectance: self.reflectance, facets, isotropic, fault: Fault::$name }
            }
        }

        impl Material for $name {
            fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
                self.metal().eval(wo, wi)
            }

            fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
                self.metal().sample(wo, u)
            }

            fn needs(&self) -> Needs {
                self.metal().needs()
            }
        }
    };
}

metal!(Sound);
metal!(ExchangesAxes);
metal!(HidesTangent);
metal!(DensityOfAllFacets);
metal!(DarkInside);
metal!(BrightAtGrazing);
metal!(PaleGreen);
metal!(RollsItsOwn);
metal!(UnevenChoice);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: Class = Class::material::<Sound>("sound_metal");

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        class: Class::material::<ExchangesAxes>("exchanges_axes"),
        fault: "evaluates stretched highlights across",
    },
    Mutant {
        class: Class::material::<HidesTangent>("hides_tangent"),
        fault: "does not ask for the tangent it looks at",
    },
    Mutant {
        class: Class::material::<DensityOfAllFacets>("density_of_all_facets"),
        fault: "pdf of all facets, samples visible ones",
    },
    Mutant { class: Class::material::<DarkInside>("dark_inside"), fault: "eval is 0 from inside" },
    Mutant {
        class: Class::material::<BrightAtGrazing>("bright_at_grazing"),
        fault: "weights +5 % below cos 0.2",
    },
    Mutant { class: Class::material::<PaleGreen>("pale_green"), fault: "eval −4 % in one lane" },
    Mutant {
        class: Class::material::<RollsItsOwn>("rolls_its_own"),
        fault: "random numbers of its own",
    },
    Mutant {
        class: Class::material::<UnevenChoice>("uneven_choice"),
        fault: "lobes chosen 53 to 47, not in halves",
    },
];
