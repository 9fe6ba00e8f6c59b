//! Words that other renderers have for what is meant here.

use luxel_core::diag::{Grade, Near, near};

/// Their word and ours. Ours counts only where it is known: whether it is, plugins decide.
const WORDS: [(&str, &str); 97] = [
    ("albedo", "reflectance"),
    ("color", "reflectance"),
    ("kd", "reflectance"),
    ("alpha", "roughness"),
    ("emission", "radiance"),
    ("irradiance", "illuminance"),
    ("ior", "eta"),
    ("position", "center"),
    ("pos", "center"),
    ("pos", "position"),
    ("res", "resolution"),
    ("rad", "radius"),
    ("r", "radius"),
    ("centre", "center"),
    ("major_radius", "radius"),
    ("outer_radius", "radius"),
    ("base_radius", "radius"),
    ("radius1", "radius"),
    ("radius2", "top_radius"),
    ("r1", "radius"),
    ("r2", "top_radius"),
    ("major", "radius"),
    ("minor", "tube"),
    ("h", "height"),
    ("length", "height"),
    ("angle", "cone"),
    ("from", "position"),
    ("energy", "power"),
    ("quad", "rectangle"),
    ("origin", "from"),
    ("eye", "from"),
    ("target", "to"),
    ("center", "to"),
    ("at", "to"),
    ("minor_radius", "tube"),
    ("center", "point"),
    ("center", "base"),
    ("mat", "material"),
    ("distant", "directional"),
    ("infinite", "constant"),
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
    ("size", "resolution"),
    ("location", "center"),
    ("origin", "center"),
    ("to_world", "look"),
    ("to_world", "transform"),
    ("fstop", "f_number"),
    ("focus_distance", "focus"),
    ("lens_radius", "aperture"),
    ("vertices", "points"),
    ("positions", "points"),
    ("faces", "indices"),
    ("triangles", "indices"),
];

/// What is one thing here and several elsewhere, or has another form.
pub(super) struct Form {
    /// Our words.
    pub(super) ours: &'static [&'static str],
    /// How it is written.
    pub(super) written: &'static str,
    /// Their words.
    theirs: &'static [&'static str],
}

/// Every one that is told; of several the first counts whose words are known.
const FORMS: [Form; 9] = [
    Form {
        ours: &["resolution"],
        written: "resolution = (640, 480)",
        theirs: &["width", "height", "xresolution", "yresolution"],
    },
    Form {
        ours: &["size", "center"],
        written: "center = (0, 0.5, 0) m, size = (2, 1, 1) m",
        theirs: &[
            "min", "max", "lower", "upper", "from", "to", "width", "height", "depth", "length",
        ],
    },
    Form {
        ours: &["base", "axis", "height"],
        written: "base = (0, 0, 0) m, axis = (0, 1, 0), height = 1 m",
        theirs: &["from", "to", "start", "end", "bottom", "top", "p0", "p1", "p2"],
    },
    Form {
        ours: &["u", "v"],
        written: "u = (1, 0, 0) m, v = (0, 0, 1) m",
        theirs: &["size", "width", "height", "length", "normal"],
    },
    Form { ours: &["radius"], written: "radius = 20 cm / 2", theirs: &["diameter", "d"] },
    Form {
        ours: &["look"],
        written: "look = look_at(from = (0, 1, 5) m, to = (0, 1, 0) m, up = (0, 1, 0))",
        theirs: &[
            "position",
            "pos",
            "location",
            "origin",
            "from",
            "eye",
            "at",
            "to",
            "target",
            "lookat",
            "look_at",
            "direction",
            "up",
        ],
    },
    Form {
        ours: &["transform"],
        written: "transform = move((1, 0, 0) m)",
        theirs: &["translate", "translation", "move"],
    },
    Form {
        ours: &["material"],
        written: "material = material diffuse { reflectance = rgb.srgb(0.8, 0.4, 0.2) }",
        theirs: &["albedo", "color", "colour", "diffuse", "reflectance", "rgb"],
    },
    Form {
        ours: &["transform"],
        written: "transform = rotate((0, 1, 0), 20 deg)",
        theirs: &["rotate", "rotation"],
    },
];

/// What is meant by another renderer's word, which wants more than one of the known words, and how it is
/// written.
pub(super) fn form(found: &str, known: &[&'static str]) -> Option<&'static Form> {
    let is_known = |form: &Form| form.ours.iter().all(|ours| known.contains(ours));
    FORMS.iter().find(|form| form.theirs.contains(&found) && is_known(form))
}

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
        let ours = |found, known: &[&'static str]| form(found, known).map(|form| form.ours);
        assert_eq!(name("distant", &["point", "directional"]), Some("directional"));
        assert_eq!(name("irradiance", &["illuminance", "radiance"]), Some("illuminance"));
        assert_eq!(name("distant", &["point", "spot"]), None);
        assert_eq!(name("radus", &["center", "radius"]), Some("radius"));
        assert_eq!(ours("height", &["exposure", "resolution"]), Some(&["resolution"][..]));
        assert_eq!(ours("width", &["center", "u", "v"]), Some(&["u", "v"][..]));
        assert_eq!(ours("position", &["center", "transform"]), None);
        assert_eq!(name("position", &["center", "transform"]), Some("center"));
    }
}
