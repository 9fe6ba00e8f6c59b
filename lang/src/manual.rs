//! The manual in a few words: what parameters take, the words of the language that stand for no plugin,
//! and the functions that every scene has.

use luxel_core::scene::{range_words, said, said_unit};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Preset, Role, Type};

pub use crate::eval::builtins::{Function, functions};

/// A field that the language reads: name, facts in a few words, manual.
pub type Field = (&'static str, &'static str, &'static str);

/// A word of the language.
pub struct Word {
    /// As a scene writes it.
    pub name: &'static str,
    /// Its manual page.
    pub doc: &'static str,
    /// What the language reads in its braces.
    pub fields: &'static [Field],
}

impl Word {
    /// What it is, and an example.
    pub fn parts(&self) -> (&'static str, &'static str) {
        self.doc.trim().split_once("\n\n").unwrap_or((self.doc, ""))
    }
}

const TRANSFORM: Field = (
    "transform",
    "list of rotate, move, scale, matrix, motion and spin, optional",
    "Where it stands, applied first to last: [rotate((0, 1, 0), 30 deg), move((1, 0, 0) m)].",
);
const MATERIAL: Field =
    ("material", "material, optional", "Of the shapes in it that have none of their own.");

/// All of them.
pub const WORDS: [Word; 2] = [
    Word {
        name: "group",
        doc: "\
Objects in their places, in a frame of their own. Has no class: `group \"label\" { … }` holds shapes,
lights, assets, places and other groups, with names, loops and functions as in a file. At statement
level it stands in the scene; named with `let` it can be placed any number of times and costs its
memory once.

let pair = group {
  material = white
  shape sphere { radius = 1 m }
  shape sphere { radius = 1 m, transform = move((3, 0, 0) m) }
}
place pair { transform = rotate((0, 1, 0), 90 deg) }
",
        fields: &[TRANSFORM, MATERIAL],
    },
    Word {
        name: "place",
        doc: "\
Puts a named object, group or asset into the scene. `place name \"label\" { … }`, any number of times,
where `let name = …` has named it.

place tree { transform = [scale(2), move((0, 0, -4) m)] }
",
        fields: &[TRANSFORM, MATERIAL],
    },
];

/// What the language adds to every object of a kind.
pub fn fields_of(kind: Kind) -> &'static [Field] {
    match kind {
        Kind::Shape | Kind::Light => &[TRANSFORM],
        Kind::Importer => &[
            TRANSFORM,
            (
                "materials",
                "record of materials, optional",
                "Materials that take the place of the file's own, by name: { leaf = green }. What no \
                 name can hold is `_` in it.",
            ),
        ],
        _ => &[],
    }
}

/// The word, if it is one of these.
pub fn find(word: &str) -> Option<&'static Word> {
    WORDS.iter().find(|known| known.name == word)
}

/// The function or constant of that name that every scene has.
pub fn function(name: &str) -> Option<Function> {
    functions().find(|function| function.name == name)
}

/// Type, unit, range, default and the like of one of a class's parameters, each in a few words.
pub fn facts(param: &Param, of: &[Param]) -> Vec<String> {
    let mut facts = vec![what(param)];
    if !param.unit.is_empty() {
        facts.push(format!("in {}", said_unit(param)));
    }
    facts.extend(range_words(param));
    if !param.choices.is_empty() {
        facts.push(format!("one of {}", param.words().collect::<Vec<_>>().join(", ")));
    }
    if param.textured {
        let number = param.ty == Type::Float;
        let what = if number {
            "may be a texture (of a colour its luminance)"
        } else {
            "may be a texture"
        };
        facts.push(what.into());
    }
    let group: Vec<_> = of.iter().filter(|it| it.group == param.group).map(|it| it.name).collect();
    if !param.group.is_empty() && group.len() > 1 {
        facts.push(format!("exactly one of {} is given", group.join(", ")));
    }
    match default(param) {
        _ if param.required => facts.push("required".into()),
        Some(default) => facts.push(format!("default {default}")),
        None if param.group.is_empty() => facts.push("optional".into()),
        None => {}
    }
    if !param.deprecated.is_empty() {
        facts.push(format!("old name, now `{}`", param.deprecated));
    }
    facts
}

/// Its type in words.
pub fn what(param: &Param) -> String {
    match param.ty {
        // The spectrum itself stands in no group; its amounts do.
        Type::Emission if param.group.is_empty() => "spectrum".into(),
        Type::Emission | Type::Float | Type::Double | Type::MaybeFloat => "number".into(),
        Type::Int => "whole number".into(),
        Type::Bool => "true or false".into(),
        Type::Vec2 if param.role == Role::Count => "two whole numbers".into(),
        Type::Vec2 => "two numbers".into(),
        Type::Vec3 | Type::DVec3 => "three numbers".into(),
        Type::Spectrum if param.role == Role::Waves => "number".into(),
        Type::Spectrum => "colour or spectrum".into(),
        Type::ComplexIor => "metal, or complex index of refraction".into(),
        Type::Choice => "word".into(),
        Type::Text => "text".into(),
        Type::File => "file".into(),
        Type::Table => "list of numbers".into(),
        Type::Look => "look_at(from, to, up)".into(),
        Type::Object(kind) => kind.word().into(),
        Type::Part => "shape".into(),
    }
}

/// Its default as a scene writes it, if it has one.
pub fn default(param: &Param) -> Option<String> {
    match param.default {
        Preset::Absent => None,
        Preset::Numbers(numbers) => Some(numbers_of(param, numbers)),
        Preset::Index(i) => Some(param.words().nth(i as usize).unwrap_or("?").into()),
        Preset::Text(text) => Some(format!("{text:?}")),
    }
}

fn numbers_of(param: &Param, numbers: [f64; 4]) -> String {
    let n = match param.ty {
        Type::Vec2 => 2,
        Type::Vec3 | Type::DVec3 => 3,
        Type::Bool => return (numbers[0] > 0.0).to_string(),
        _ => 1,
    };
    let all: Vec<String> = numbers[..n].iter().map(|x| said(param, *x)).collect();
    let all = if n == 1 { all.concat() } else { format!("({})", all.join(", ")) };
    match &*said_unit(param) {
        "" | "EV" => all,
        unit => format!("{all} {unit}"),
    }
}
