//! Words of the language that stand for no plugin, with their manual pages; and what the language
//! itself adds to the objects of a kind.

use luxel_sdk::kind::Kind;
use serde_json::{Value, json};

/// A field that the language reads: name, facts in a few words, manual.
pub(crate) type Field = (&'static str, &'static str, &'static str);

/// A word of the language.
pub(crate) struct Word {
    pub(crate) name: &'static str,
    pub(crate) doc: &'static str,
    pub(crate) fields: &'static [Field],
}

const TRANSFORM: Field = (
    "transform",
    "list of rotate, move, scale and matrix, optional",
    "Where it stands, applied first to last: [rotate((0, 1, 0), 30 deg), move((1, 0, 0) m)].",
);
const MATERIAL: Field =
    ("material", "material, optional", "Of the shapes in it that have none of their own.");

/// All of them.
pub(crate) const WORDS: [Word; 2] = [
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
pub(crate) fn fields_of(kind: Kind) -> &'static [Field] {
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
pub(crate) fn find(word: &str) -> Option<&'static Word> {
    WORDS.iter().find(|known| known.name == word)
}

impl Word {
    /// The manual page.
    pub(crate) fn page(&self) -> String {
        let mut page = format!("{} (language)\n\n{}\nFields:\n", self.name, self.doc);
        describe(&mut page, self.fields);
        page
    }

    /// The manual page for programs, in the form of a plugin's.
    pub(crate) fn object(&self) -> Value {
        json!({
            "kind": self.name,
            "name": "",
            "origin": "language",
            "doc": self.doc.trim(),
            "parameters": parameters(self.fields),
        })
    }
}

/// Fields as lines of a page.
pub(crate) fn describe(page: &mut String, fields: &[Field]) {
    for (name, facts, doc) in fields {
        page.extend(["  ", name, ": ", facts, "\n      ", doc, "\n"]);
    }
}

/// Fields as JSON.
pub(crate) fn parameters(fields: &[Field]) -> Vec<Value> {
    let one = |(name, facts, doc): &Field| json!({ "name": name, "type": facts, "doc": doc });
    fields.iter().map(one).collect()
}
