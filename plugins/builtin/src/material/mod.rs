//! The built-in plugins of kind material.

mod diffuse;
mod conductor;
mod dielectric;
mod mix;
mod metallic_roughness;
mod thin_film;

#[cfg(test)]
mod check;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::material::<diffuse::Diffuse>("diffuse"),
    Class::material::<conductor::Conductor>("conductor"),
    Class::material::<dielectric::Dielectric>("dielectric"),
    Class::material::<mix::Mix<'static>>("mix"),
    Class::material::<metallic_roughness::MetallicRoughness>("metallic_roughness"),
    Class::material::<thin_film::ThinFilm>("thin_film"),
];
