//! The names of types.

use luxel_core::diag::{Grade, Near, near};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Dimension;

/// Types of numbers with what they measure.
const NUMBERS: [(&str, Dimension); 14] = [
    ("float", Dimension::NONE),
    ("number", Dimension::NONE),
    ("int", Dimension::NONE),
    ("length", Dimension::LENGTH),
    ("angle", Dimension::ANGLE),
    ("time", Dimension::TIME),
    ("temperature", Dimension::TEMPERATURE),
    ("power", Dimension::POWER),
    ("energy", Dimension::ENERGY),
    ("mass", Dimension::MASS),
    ("solid_angle", Dimension::SOLID_ANGLE),
    ("area", Dimension([2, 0, 0, 0, 0, 0, 0])),
    ("volume", Dimension([3, 0, 0, 0, 0, 0, 0])),
    ("intensity", Dimension::LUMINOUS),
];

const OTHERS: [&str; 12] = [
    "bool",
    "string",
    "vec2",
    "vec3",
    "color",
    "spectrum",
    "transform",
    "view",
    "record",
    "group",
    "object",
    "any",
];

/// Types of other languages, with what they are here.
const ELSEWHERE: [(&str, &str); 16] = [
    ("boolean", "bool"),
    ("colour", "color"),
    ("double", "float"),
    ("f32", "float"),
    ("f64", "float"),
    ("i32", "int"),
    ("i64", "int"),
    ("integer", "int"),
    ("num", "number"),
    ("point", "vec3"),
    ("real", "float"),
    ("rgb", "color"),
    ("str", "string"),
    ("text", "string"),
    ("u32", "int"),
    ("vector", "vec3"),
];

/// Every type's name.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    let kinds = Kind::ALL.iter().map(|(_, word)| *word);
    NUMBERS.iter().map(|(name, _)| *name).chain(OTHERS).chain(kinds)
}

/// What is meant by a name that is none of a type.
pub(crate) fn meant(name: &str) -> Option<Near<'static>> {
    let other = ELSEWHERE.iter().find(|(other, _)| other.eq_ignore_ascii_case(name));
    other.map_or_else(|| near(name, names()), |(_, name)| Some(Near { name, grade: Grade::Guess }))
}

/// The types of numbers that have a unit.
pub(crate) fn measured() -> impl Iterator<Item = &'static str> {
    NUMBERS.iter().filter(|(_, dimension)| !dimension.is_none()).map(|(name, _)| *name)
}

/// What a type of numbers measures.
pub(crate) fn dimension(name: &str) -> Option<Dimension> {
    NUMBERS.iter().find(|(known, _)| *known == name).map(|(_, dimension)| *dimension)
}

#[cfg(test)]
mod tests {
    use luxel_sdk::params::UNITS;

    use super::*;

    #[test]
    fn the_page_of_the_language_names_every_type_and_unit() {
        let page = include_str!("../../../docs/language.md");
        let words: Vec<_> = page.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        let own = names().filter(|name| Kind::of_word(name).is_none());
        for name in own.chain(UNITS.iter().map(|(name, _)| *name)) {
            assert!(words.contains(&name), "{name}");
        }
    }
}
