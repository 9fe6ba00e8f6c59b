//! The snippet of a manual as a whole scene that shows what it is about.

use luxel_sdk::kind::Kind;

/// A floor, a ball and a block, in front of which anything else can be tried.
const THINGS: &str = "
shape plane { point = (0, 0, 0) m, normal = (0, 1, 0), material = material diffuse { reflectance = texture checker { a = 0.35, b = 0.5, scale = (1, 1) } } }
shape sphere { center = (-0.45, 0.6, 0) m, radius = 60 cm, material = material diffuse { reflectance = rgb.linear_srgb(0.6, 0.25, 0.1) } }
shape box { size = (60, 60, 60) cm, transform = [rotate((0, 1, 0), 30 deg), move((0.75, 0.3, 0.3) m)], material = material diffuse { reflectance = 0.7 } }
shape sphere { center = (0.2, 0.2, 1) m, radius = 20 cm, material = material conductor { eta = metal(\"Au\"), roughness = 0.2 } }
";
/// What a snippet places that names no tree of its own.
const TREE: &str = "
let tree = group {
  shape cone { base = (0, 0.6, 0) m, axis = (0, 1, 0), height = 2 m, radius = 70 cm, material = material diffuse { reflectance = rgb.linear_srgb(0.05, 0.2, 0.07) } }
  shape cylinder { base = (0, 0, 0) m, axis = (0, 1, 0), height = 80 cm, radius = 12 cm, material = material diffuse { reflectance = rgb.linear_srgb(0.22, 0.13, 0.07) } }
}
";
/// Where they are seen from.
const AT_THINGS: &str =
    "look_at(from = (1.2, 1.7, 4.2) m, to = (0.1, 0.5, 0) m, up = (0, 1, 0)), fov = 36 deg";
/// A bright sky with a sun, without units that would ask for an exposure.
const SKY: &str = "
light constant { spectrum = rgb.linear_srgb(0.8, 0.9, 1), scale = 0.35 }
light directional { direction = (-1, -1.6, -1.2), angular_size = 4 deg, spectrum = rgb.linear_srgb(1, 0.95, 0.85), scale = 2 }
";

/// A ball on a floor: of a material, or filled with a medium.
fn ball(what: &str) -> String {
    format!(
        "shape sphere {{ center = (0, 1, 0) m, radius = 1 m, {what} }}
shape plane {{ point = (0, 0, 0) m, normal = (0, 1, 0), material = material diffuse {{ reflectance = texture checker {{ a = 0.2, b = 0.6, scale = (1, 1) }} }} }}
light area {{ shape = shape sphere {{ center = (3, 5, 3) m, radius = 90 cm }}, scale = 14 }}
light constant {{ scale = 0.3 }}
camera perspective {{ look = look_at(from = (0, 1.6, 5) m, to = (0, 0.95, 0) m, up = (0, 1, 0)), fov = 34 deg }}
"
    )
}

/// The name that a snippet gives last to something of a category, as in `let gold = material …`, or to a
/// copy of one.
fn named<'s>(snippet: &'s str, category: &str) -> Option<&'s str> {
    let mut names = snippet.lines().filter_map(|line| {
        let (name, value) = line.strip_prefix("let ")?.split_once('=')?;
        let value = value.trim_start();
        (value.starts_with(category) || value.contains(" with {")).then(|| name.trim())
    });
    names.next_back()
}

/// The scene around a snippet; a camera for the shapes of which only the snippet knows where they are is
/// `camera`.
pub(super) fn around(kind: Kind, snippet: &str, camera: &str) -> String {
    let has = |word: &str| {
        snippet.lines().any(|line| line.strip_prefix(word).is_some_and(|it| it.starts_with(' ')))
    };
    let tree = if has("place tree") && !has("let tree") { TREE } else { "" };
    let mut scene = format!("scene 1\n{tree}{snippet}\n");
    if !has("integrator") {
        scene += "integrator path { max_depth = 24 }\n";
    }
    let seen = format!("camera perspective {{ look = {AT_THINGS} }}\n");
    match kind {
        Kind::Material | Kind::Texture if !has("shape") => {
            let material = named(snippet, "material").map(|name| format!("material = {name}"));
            let texture = named(snippet, "texture");
            let of_texture = texture
                .map(|name| format!("material = material diffuse {{ reflectance = {name} }}"));
            scene += &ball(&material.or(of_texture).unwrap_or_default());
        }
        Kind::Medium | Kind::Phase => {
            let medium = named(snippet, "medium").unwrap_or_default();
            scene += &ball(&format!("interior = {medium}"));
        }
        Kind::Light => scene.extend([THINGS, &seen]),
        Kind::Camera => scene.extend([THINGS, SKY]),
        Kind::Shape | Kind::Material | Kind::Texture | Kind::Importer => {
            scene.extend([SKY, camera]);
        }
        _ => scene.extend([THINGS, SKY, &seen]),
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_snippet_names_last_is_what_is_shown() {
        let snippet =
            "let a = material mix {}\nlet b = a with { weight = 1 }\nlet c = texture checker {}";
        assert_eq!((named(snippet, "material"), named(snippet, "texture")), (Some("b"), Some("c")));
        assert_eq!(named("shape sphere {}", "material"), None);
    }
}
