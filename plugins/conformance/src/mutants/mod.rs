//! Plugins that are wrong on purpose: whether the suite sees it.
//!
//! Each is one of the suite's own plugins with one fault. They see the SDK alone.

mod field;
mod light;
mod material;
mod settings;
mod shape;

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
    pub by: Vec<&'static str>,
}

/// Every mutant.
pub fn mutants() -> Vec<Mutant> {
    [material::MUTANTS, shape::MUTANTS, light::MUTANTS, field::MUTANTS, settings::MUTANTS].concat()
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
            let by = report.failed().map(|row| row.check).collect();
            Caught { class: format!("{class:?}"), fault, by }
        })
        .collect()
}
