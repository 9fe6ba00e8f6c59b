//! What strings stand for: files, names of catalogues, words of parameters.

use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Type};

use super::context::{Context, Head};
use super::named::Around;
use super::schema::{self, Given};
use crate::words::OF_A_TEXT;

/// What the string at a place stands for.
pub(super) enum Said {
    /// A file; its name ends in one of these, if there are any.
    File(Vec<&'static str>),
    /// A name of a catalogue: what the function of this name is given.
    Named(&'static str),
    /// A word that a parameter takes.
    Word(&'static Param, &'static [Param]),
    /// A plugin library.
    Library,
    /// Versions of the plugin library of that name.
    Version(String),
    /// Nothing that is known.
    Other,
}

/// What the string at a place stands for.
pub(super) fn said(around: Around<'_>, here: &Context<'_>) -> Said {
    let last = here.text_back(1);
    if let (Some(Head::Call(callee)), "(" | "=") = (here.head(), last) {
        if callee == "spectrum.file" && matches!(here.text_back(2), "file" | "path") {
            return Said::File(SPECTRA.to_vec());
        }
        let name = OF_A_TEXT.into_iter().find(|name| name == callee);
        return name.map_or(Said::Other, Said::Named);
    }
    match last {
        "include" | "import" | "same_as" => return Said::File(vec![".scene"]),
        "plugin" if here.text_back(2) == "use" => return Said::Library,
        "version" if here.text_back(3) == "plugin" => {
            return Said::Version(here.text_back(2).trim_matches('"').to_owned());
        }
        _ => {}
    }
    match schema::given_to(around, here) {
        Some(Given::Param(param, _)) if param.ty == Type::File => {
            Said::File(ends(param, class_of(around, here)))
        }
        Some(Given::Param(param, of)) => Said::Word(param, of),
        _ => Said::Other,
    }
}

/// The class of the object in whose braces a place stands.
fn class_of<'a>(around: Around<'a>, here: &Context<'_>) -> Option<&'a Class> {
    let (category, kind) = match here.head()? {
        Head::Object { category, kind } => (category.clone(), kind.clone()),
        Head::Amend(name) => around.object_named(name)?,
        _ => return None,
    };
    around.registry.class(Kind::of_word(&category)?, &kind?)
}

/// How files end whose formats a manual names.
const FORMATS: [(&str, &[&str]); 12] = [
    ("png", &[".png"]),
    ("jpeg", &[".jpg", ".jpeg"]),
    ("jpg", &[".jpg", ".jpeg"]),
    ("hdr", &[".hdr"]),
    ("exr", &[".exr"]),
    ("pfm", &[".pfm"]),
    ("obj", &[".obj"]),
    ("ply", &[".ply"]),
    ("stl", &[".stl"]),
    ("gltf", &[".gltf", ".glb"]),
    ("vdb", &[".vdb"]),
    ("csv", &[".csv"]),
];

/// How files of spectra usually end.
const SPECTRA: [&str; 5] = [".csv", ".dat", ".spd", ".tsv", ".txt"];

/// How the files end that a parameter reads, as far as its manual or that of its class names formats.
fn ends(param: &Param, class: Option<&Class>) -> Vec<&'static str> {
    let own = named(param.doc);
    if own.is_empty() { class.map_or(vec![], |class| named(class.doc)) } else { own }
}

/// How files of the formats end that a text names.
fn named(text: &str) -> Vec<&'static str> {
    let words: Vec<String> =
        text.split(|c: char| !c.is_alphanumeric()).map(str::to_ascii_lowercase).collect();
    let known = FORMATS.iter().filter(|(format, _)| words.iter().any(|word| word == format));
    let mut out: Vec<&str> = known.flat_map(|(_, ends)| *ends).copied().collect();
    out.sort_unstable();
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_those_that_the_manual_names() {
        assert_eq!(named("The picture: EXR or JPEG."), [".exr", ".jpeg", ".jpg"]);
        assert_eq!(named("A `.gltf` or a glTF."), [".glb", ".gltf"]);
        assert_eq!(named("An object of explicit size."), Vec::<&str>::new());
    }
}
