//! Words that other renderers have for what is meant here.

use luxel_core::diag::{Grade, Near, near};

/// Their word and ours. Ours counts only where it is known: whether it is, plugins decide.
const WORDS: [(&str, &str); 22] = [
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
