//! Smooth panes and prisms with a fault.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample, reflect};
use luxel_sdk::scattering::{dielectric_reflectance, refract};

use super::Mutant;

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Sound,
    KeepsRadiance,
    HidesDispersion,
    SaysIndexOfEntry,
    SameIndexBothWays,
    SchlickFromInside,
}

/// A smooth boundary.
struct Glass {
    ior: Spectrum,
    fault: Fault,
}

impl Glass {
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        let inside = wo.z < 0.0 && self.fault != Fault::SameIndexBothWays;
        let eta = if inside { 1.0 / self.ior } else { self.ior };
        let cos = wo.z.abs();
        let reflected = eta.to_array().map(|eta| self.reflected(cos, eta, wo.z < 0.0));
        let chance = reflected[0];
        if u[2] < chance {
            let weight = Spectrum::from_array(reflected) / chance;
            return Some(Sample::delta(reflect(wo), weight));
        }
        let eta = eta.lane(0);
        let up = refract(if wo.z < 0.0 { -wo } else { wo }, Vec3::Z, eta)?;
        let wi = if wo.z < 0.0 { -up } else { up };
        let weight = if self.fault == Fault::KeepsRadiance { 1.0 } else { 1.0 / (eta * eta) };
        let mut lobe = Lobe::DELTA.with(Lobe::TRANSMISSION);
        if self.disperses() && self.fault != Fault::HidesDispersion {
            lobe = lobe.with(Lobe::DISPERSIVE);
        }
        let said = if self.fault == Fault::SaysIndexOfEntry { self.ior.lane(0) } else { eta };
        Some(Sample { weight: Spectrum::splat(weight), wi, pdf: 1.0, eta: said, lobe })
    }

    fn reflected(&self, cos: f32, eta: f32, inside: bool) -> f32 {
        if inside && self.fault == Fault::SchlickFromInside {
            // Schlick's formula holds for the cosine on the thin side.
            let r0 = ((eta - 1.0) / (eta + 1.0)).powi(2);
            return r0 + (1.0 - r0) * (1.0 - cos).max(0.0).powi(5);
        }
        dielectric_reflectance(cos, eta)
    }

    fn disperses(&self) -> bool {
        let lanes = self.ior.to_array();
        lanes.iter().any(|lane| lane.to_bits() != lanes[0].to_bits())
    }
}

macro_rules! glass {
    ($name:ident) => {
        /// Smooth glass with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Index of refraction of the inside.
            #[param(default = 1.5, role = ior, min = 1, max = 4, textured)]
            ior: Spectrum,
        }

        impl Material for $name {
            fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
                Eval::ZERO
            }

            fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
                Glass { ior: self.ior, fault: Fault::$name }.sample(wo, u)
            }

            fn needs(&self) -> Needs {
                Needs::CHOICE
            }
        }
    };
}

glass!(Sound);
glass!(KeepsRadiance);
glass!(HidesDispersion);
glass!(SaysIndexOfEntry);
glass!(SameIndexBothWays);
glass!(SchlickFromInside);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: Class = Class::material::<Sound>("sound_glass");

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        class: Class::material::<KeepsRadiance>("keeps_radiance"),
        fault: "no 1/η² on what is refracted",
    },
    Mutant {
        class: Class::material::<HidesDispersion>("hides_dispersion"),
        fault: "all lanes go the first one's way",
    },
    Mutant {
        class: Class::material::<SaysIndexOfEntry>("says_index_of_entry"),
        fault: "tells the index of entry when leaving",
    },
    Mutant {
        class: Class::material::<SameIndexBothWays>("same_index_both_ways"),
        fault: "bends light that leaves as if it entered",
    },
    Mutant {
        class: Class::material::<SchlickFromInside>("schlick_from_inside"),
        fault: "Schlick with the wrong cosine inside",
    },
];
