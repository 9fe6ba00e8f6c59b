//! Every built-in plugin: one folder per kind, one file per plugin. They see the SDK alone.

mod sniff;
mod stop;
mod shape;
mod material;
mod texture;
mod light;
mod medium;
mod phase;
mod camera;
mod sampler;
mod filter;
mod integrator;
mod importer;

use luxel_sdk::abi::Class;

/// Every built-in class, kind by kind, to be added to a registry.
pub const CLASSES: &[&[Class]] = &[
    shape::CLASSES,
    material::CLASSES,
    texture::CLASSES,
    light::CLASSES,
    medium::CLASSES,
    phase::CLASSES,
    camera::CLASSES,
    sampler::CLASSES,
    filter::CLASSES,
    integrator::CLASSES,
    importer::CLASSES,
];
