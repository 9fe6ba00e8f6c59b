//! Words that other renderers have for what is meant here.

use luxel_core::diag::{Grade, Near, near};

/// Their word and ours. Ours counts only where it is known: whether it is, plugins decide.
const WORDS: [(&str, &str); 76] = [
    ("albedo", "reflectance"),
    ("color", "reflectance"),
    ("kd", "reflectance"),
    ("alpha", "roughness"),
    ("emission", "radiance"),
    ("irradiance", "illuminance"),
    ("ior", "eta"),
    ("position", "center"),
    ("distant", "directional"),
    ("infinite", "environment"),
    ("envmap", "environment"),
    ("skydome", "environment"),
    ("lambertian", "diffuse"),
    ("matte", "diffuse"),
    ("metal", "conductor"),
    ("glass", "dielectric"),
    ("principled", "metallic_roughness"),
    ("cube", "box"),
    ("trianglemesh", "mesh"),
    ("pinhole", "perspective"),
    ("hg", "henyey_greenstein"),
    ("pathtracer", "path"),
    ("albedo", "base_color"),
    ("color", "base_color"),
    ("color", "spectrum"),
    ("colour", "reflectance"),
    ("colour", "base_color"),
    ("colour", "spectrum"),
    ("diffuse", "reflectance"),
    ("temperature", "spectrum"),
    ("metalness", "metallic"),
    ("index", "ior"),
    ("int_ior", "ior"),
    ("refractive_index", "ior"),
    ("eta", "ior"),
    ("emission", "spectrum"),
    ("strength", "intensity"),
    ("strength", "radiance"),
    ("strength", "illuminance"),
    ("brightness", "intensity"),
    ("brightness", "radiance"),
    ("brightness", "illuminance"),
    ("lumens", "power"),
    ("flux", "power"),
    ("watts", "power"),
    ("filename", "file"),
    ("path", "file"),
    ("src", "file"),
    ("url", "file"),
    ("spp", "samples"),
    ("sample_count", "samples"),
    ("pixelsamples", "samples"),
    ("bounces", "max_depth"),
    ("depth", "max_depth"),
    ("max_bounces", "max_depth"),
    ("width", "resolution"),
    ("height", "resolution"),
    ("size", "resolution"),
    ("location", "center"),
    ("origin", "center"),
    ("origin", "look"),
    ("position", "look"),
    ("direction", "look"),
    ("to_world", "look"),
    ("to_world", "transform"),
    ("rotate", "transform"),
    ("rotation", "transform"),
    ("translate", "transform"),
    ("translation", "transform"),
    ("fstop", "f_number"),
    ("focus_distance", "focus"),
    ("lens_radius", "aperture"),
    ("vertices", "points"),
    ("positions", "points"),
    ("faces", "indices"),
    ("triangles", "indices"),
];

/// The known word that is meant: another's word for it, which is a guess, or the nearest.
pub(super) fn meant<'a>(found: &str, known: &[&'a str]) -> Option<Near<'a>> {
    let theirs = WORDS.iter().filter(|(theirs, _)| *theirs == found);
    let ours = theirs.filter_map(|(_, ours)| known.iter().copied().find(|known| known == ours));
    let ours = ours.into_iter().next().map(|name| Near { name, grade: Grade::Guess });
    ours.or_else(|| near(found, known.iter().copied()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_another_renderer_is_understood_where_ours_is_known() {
        let name = |found, known: &[&'static str]| meant(found, known).map(|near| near.name);
        assert_eq!(name("distant", &["point", "directional"]), Some("directional"));
        assert_eq!(name("irradiance", &["illuminance", "radiance"]), Some("illuminance"));
        assert_eq!(name("distant", &["point", "spot"]), None);
        assert_eq!(name("radus", &["center", "radius"]), Some("radius"));
    }
}
