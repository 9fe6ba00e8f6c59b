//! Materials of a library, behind the boundary: the host notices what they must not do, and their
//! objects are not asked again.

use std::panic::resume_unwind;
use std::sync::OnceLock;

use glam::Vec3;
use luxel_core::registry::dynamic::Library;
use luxel_sdk::Params;
use luxel_sdk::abi::{Class, LibraryTable};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Material, Sample};
use luxel_sdk::params::Fault;

use super::Mutant;
use crate::reference::Matt;

/// A matt material whose checks and answers pass through two functions.
macro_rules! matt {
    ($name:ident, $check:expr, $eval:expr) => {
        /// A matt material with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Share of light that is reflected.
            #[param(default = 0.5, role = reflectance, textured)]
            reflectance: Spectrum,
            /// Nothing depends on it.
            #[param(default = 0.5, min = 0, max = 1)]
            gloss: f32,
        }

        impl Material for $name {
            fn check(&self) -> Result<(), Fault> {
                let check: fn(f32) = $check;
                check(self.gloss);
                Ok(())
            }

            fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
                let change: fn(Eval, Vec3) -> Eval = $eval;
                change(Matt { reflectance: self.reflectance }.eval(wo, wi), wi)
            }

            fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
                Matt { reflectance: self.reflectance }.sample(wo, u)
            }
        }
    };
}

#[cfg(test)]
matt!(Sound, |_| {}, |eval, _| eval);
matt!(NoNumber, |_| {}, |eval, wi| if wi.z.abs() < 1e-5 {
    Eval { pdf: f32::NAN, ..eval }
} else {
    eval
});
// Without the hook of panics: nothing is printed.
matt!(
    TripsAtTheEnd,
    |gloss| if gloss >= 1.0 {
        resume_unwind(Box::new(""))
    },
    |eval, _| eval
);

/// A class of these, as the host opens it.
fn opened(name: &str) -> Class {
    const CLASSES: &[Class] = &[
        #[cfg(test)]
        Class::material::<Sound>("sound_abroad"),
        Class::material::<NoNumber>("no_number"),
        Class::material::<TripsAtTheEnd>("trips_at_the_end"),
    ];
    static TABLE: LibraryTable = LibraryTable {
        // The hook of a library's panics would be that of the host.
        begin: None,
        ..luxel_sdk::library_table!(&[CLASSES])
    };
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    let library = LIBRARY.get_or_init(|| Library::linked(&TABLE).expect("a table of the SDK's"));
    let class = library.classes.iter().find(|class| class.name == name);
    *class.expect("one of the classes above")
}

/// The same without a fault.
#[cfg(test)]
pub(super) fn sound() -> Class {
    opened("sound_abroad")
}

/// All of them.
pub(super) fn mutants() -> [Mutant; 2] {
    [
        Mutant { class: opened("no_number"), fault: "NaN for grazing light" },
        Mutant { class: opened("trips_at_the_end"), fault: "panics at an end of a range" },
    ]
}
