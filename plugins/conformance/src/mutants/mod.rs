//! Plugins that are wrong on purpose: whether the suite sees it.
//!
//! Each is one of the suite's own plugins with one fault. They see the SDK alone.

mod abroad;
mod dawn;
mod facets;
mod field;
mod glass;
mod haze;
mod lamps;
mod light;
mod material;
mod numbers;
mod paths;
mod pattern;
mod picture;
mod plate;
mod turning;
mod settings;
mod shape;

use std::borrow::Cow;

use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;

use crate::Options;

/// A plugin with a fault.
#[derive(Clone, Copy, Debug)]
pub struct Mutant {
    /// The plugin.
    pub class: Class,
    /// What is wrong with it.
    pub fault: &'static str,
}

/// Whether a mutant was caught.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Caught {
    /// Kind and name of the mutant.
    pub class: String,
    /// What is wrong with it.
    pub fault: &'static str,
    /// The checks that failed; none if it got through.
    pub by: Vec<Cow<'static, str>>,
}

/// Every mutant.
pub fn mutants() -> Vec<Mutant> {
    let linked = [
        material::MUTANTS,
        facets::MUTANTS,
        glass::MUTANTS,
        shape::MUTANTS,
        plate::MUTANTS,
        turning::MUTANTS,
        light::MUTANTS,
        lamps::MUTANTS,
        dawn::MUTANTS,
        field::MUTANTS,
        pattern::MUTANTS,
        haze::MUTANTS,
        settings::MUTANTS,
        numbers::MUTANTS,
        paths::MUTANTS,
        picture::MUTANTS,
    ];
    [linked.concat().as_slice(), &abroad::mutants()].concat()
}

/// Judges each of the mutants alone, in a registry that holds nothing else but the host's classes.
///
/// # Panics
/// If a mutant has the name of a class of the host.
pub fn score(mutants: &[Mutant], options: &Options) -> Vec<Caught> {
    mutants
        .iter()
        .map(|mutant| {
            let mut registry = Registry::new();
            registry.add("mutants", &[mutant.class]).expect("mutants have names of their own");
            let Mutant { class, fault } = *mutant;
            let is_it = |c: &Class| c.kind == class.kind && c.name == class.name;
            let report = crate::run(&registry, is_it, options);
            let by = report.failed().map(|row| row.check.clone()).collect();
            Caught { class: format!("{class:?}"), fault, by }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is caught is the fault, not the plugin around it.
    #[test]
    fn without_their_faults_the_mutants_pass() {
        let settings = [plate::SOUND, dawn::SOUND, pattern::SOUND, paths::SOUND, picture::SOUND];
        let alone = [facets::SOUND, glass::SOUND, abroad::sound()];
        let more = [haze::SOUND, lamps::SOUND, numbers::SOUND].concat();
        let classes = [alone.as_slice(), &settings, &more].concat();
        let sound: Vec<_> = classes.into_iter().map(|class| Mutant { class, fault: "" }).collect();
        for judged in score(&sound, &Options::default()) {
            assert!(judged.by.is_empty(), "{judged:#?}");
        }
    }
}
