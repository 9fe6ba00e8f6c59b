//! What `luxel plugin new` writes: a small crate of each kind.

use luxel_sdk::kind::Kind;

/// Files of one kind's crate, with names to be filled in.
pub(super) struct Template {
    /// `src/lib.rs`.
    pub(super) source: &'static str,
    /// A scene that uses it.
    pub(super) scene: &'static str,
    /// A file that the scene reads, if any.
    pub(super) data: Option<&'static str>,
}

/// The manifest.
pub(super) const MANIFEST: &str = include_str!("templates/Cargo.toml.txt");
/// How it is built and used.
pub(super) const README: &str = include_str!("templates/README.md");

macro_rules! template {
    ($word:literal, $data:expr) => {
        Template {
            source: include_str!(concat!("templates/", $word, ".rs")),
            scene: include_str!(concat!("templates/", $word, ".scene")),
            data: $data,
        }
    };
}

/// That of a kind; the film is the host's alone.
pub(super) fn of(kind: Kind) -> Option<Template> {
    Some(match kind {
        Kind::Shape => template!("shape", None),
        Kind::Material => template!("material", None),
        Kind::Texture => template!("texture", None),
        Kind::Light => template!("light", None),
        Kind::Medium => template!("medium", None),
        Kind::Phase => template!("phase", None),
        Kind::Camera => template!("camera", None),
        Kind::Sampler => template!("sampler", None),
        Kind::Filter => template!("filter", None),
        Kind::Integrator => template!("integrator", None),
        Kind::Importer => template!("importer", Some(include_str!("templates/importer.txt"))),
        Kind::Film => return None,
    })
}

/// An integrator that owns the whole picture: of the same kind, by another trait.
pub(super) fn of_picture() -> Template {
    template!("picture_integrator", None)
}

/// The struct's name: `rough_glass` is `RoughGlass`, unless that means something in the template.
pub(super) fn type_name(name: &str, source: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    let camel: String = words.map(capital).collect();
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let taken = source.split(|c| !letter(c)).any(|word| word == camel);
    if taken || PRELUDE.contains(&camel.as_str()) { camel + "Plugin" } else { camel }
}

/// Names that the code of a derive may mean.
const PRELUDE: [&str; 20] = [
    "Box", "Choice", "Clone", "Copy", "Default", "Drop", "Err", "Fn", "From", "Into", "Iterator",
    "None", "Ok", "Option", "Result", "Send", "Some", "String", "Sync", "Vec",
];

/// What is wrong with a name, if anything is.
pub(super) fn fault(name: &str) -> Option<String> {
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(legal) {
        return Some("a name begins with a to z and goes on with a to z, 0 to 9 and _".into());
    }
    if name.len() > LONGEST {
        return Some(format!("a name has at most {LONGEST} letters"));
    }
    if KEYWORDS.contains(&name) {
        return Some("it is a word of the Rust language".into());
    }
    CRATES.contains(&name).then(|| "a crate that it needs has this name".into())
}

/// Letters of a name, at most.
const LONGEST: usize = 40;

/// Rust's keywords, the reserved ones included.
const KEYWORDS: [&str; 51] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate",
    "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Crates whose names a plugin's would hide, or that cargo refuses.
const CRATES: [&str; 9] = [
    "alloc",
    "core",
    "glam",
    "luxel_sdk",
    "luxel_sdk_derive",
    "bytemuck",
    "proc_macro",
    "std",
    "test",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_make_no_crate_or_class_are_refused() {
        for fine in ["gyroid", "a", "rough_glass2", "union", "plugin"] {
            assert_eq!(fault(fine), None, "{fine}");
        }
        for bad in ["", "Gyroid", "2x", "_x", "a-b", "../x", "a b", "é", "crate", "self", "std"] {
            assert!(fault(bad).is_some(), "{bad}");
        }
        assert!(fault(&"a".repeat(41)).is_some());
    }

    #[test]
    fn a_struct_is_named_after_the_plugin_and_hides_nothing() {
        let source = of(Kind::Material).unwrap().source;
        for (name, expected) in [
            ("rough_glass", "RoughGlass"),
            ("x_", "X"),
            ("a__b2", "AB2"),
            ("material", "MaterialPlugin"),
            ("spectrum", "SpectrumPlugin"),
            ("option", "OptionPlugin"),
        ] {
            assert_eq!(type_name(name, source), expected);
        }
    }

    #[test]
    fn every_kind_that_a_library_may_offer_has_a_template_that_says_what_it_is() {
        let all = Kind::ALL.iter().map(|(kind, _)| (*kind, of(*kind)));
        let picture = (Kind::Integrator, Some(of_picture()));
        for (i, (kind, template)) in all.chain([picture]).enumerate() {
            let Some(template) = template else {
                assert_eq!(kind, Kind::Film);
                continue;
            };
            let Template { source, scene, .. } = template;
            let word = match kind {
                Kind::Importer => "importer",
                Kind::Integrator if i == Kind::ALL.len() => "picture_integrator",
                _ => kind.word(),
            };
            let export = format!("luxel_sdk::plugin! {{ {word} \"template_name\" => TemplateName");
            assert!(source.contains(&export), "{word}");
            assert!(source.contains("/// ```scene\n") && source.contains("#[param("), "{word}");
            assert!(scene.contains(&format!("{} template_name {{", kind.word())), "{word}");
        }
    }
}
