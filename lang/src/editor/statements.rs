//! What the lists of an editor are made of.

use std::collections::HashSet;
use std::sync::Arc;

use luxel_sdk::kind::Kind;
use luxel_sdk::params::UNITS;

use super::complete::{Item, ItemKind};
use super::document::Document;
use super::named::Signature;
use super::schema::Given;
use super::symbols::{Role, Sort};
use crate::eval::types;
use crate::manual::{self, Function};
use crate::syntax::StmtNode;
use crate::words::OF_A_TEXT;

/// Words that begin statements, with what is written after them and what they mean.
const WORDS: [(&str, &str, &str); 13] = [
    ("let", "let $0 = ", "a name; never changes"),
    ("param", "param $0: length = 1 m", "a name that `--set` may change"),
    ("fn", "fn $0() = ", "a function"),
    ("for", "for i in 0..$0 { }", "a loop"),
    ("if", "if $0 { }", "a condition"),
    ("include", "include \"$0\"", "the statements of another file"),
    ("import", "import \"$0\" as n", "the names of another file"),
    ("use", "use plugin \"$0\"", "a library that must be loaded"),
    ("place", "place $0", "a named object, group or asset again"),
    ("set", "set $0", "changes a labelled object"),
    ("assert", "assert $0, \"\"", "stops with the message unless it is true"),
    ("expect", "expect mean = $0", "what is true of the picture"),
    ("units", "units { length = $0 }", "what bare numbers measure in this file"),
];

fn words(of: impl Fn(&str) -> bool) -> impl Iterator<Item = Item> {
    let chosen = WORDS.iter().filter(move |(word, ..)| of(word));
    chosen.map(|(word, insert, detail)| {
        Item::new(*word, ItemKind::Keyword).insert(*insert).detail(*detail).rank(6)
    })
}

/// What may begin a statement of a file or a block.
pub(super) fn all() -> Vec<Item> {
    categories().into_iter().chain(words(|_| true)).collect()
}

/// Statements that may stand in an object beside its fields.
pub(super) fn in_objects() -> impl Iterator<Item = Item> {
    words(|word| matches!(word, "let" | "fn" | "for" | "if" | "assert"))
}

/// What may stand after `@`.
pub(super) fn attributes() -> Vec<Item> {
    let doc = "Takes the statement that follows out of the scene: it is read, and neither evaluated nor \
               rendered. `@off shape sphere { radius = 1 m }`";
    vec![Item::new("off", ItemKind::Keyword).detail("the next statement off").doc(doc)]
}

/// Categories of objects.
pub(super) fn categories() -> Vec<Item> {
    let kinds = Kind::ALL.iter().map(|(_, word)| {
        Item::new(*word, ItemKind::Category).insert(format!("{word} $0")).detail("an object")
    });
    let group = Item::new("group", ItemKind::Category).insert("group \"$0\" { }");
    kinds
        .chain([group.detail("objects in a frame of their own")])
        .map(|item| item.rank(4))
        .collect()
}

/// What may be expected of a picture.
pub(super) fn expectations() -> Vec<Item> {
    let forms = [
        ("mean", "mean = $0"),
        ("pixel", "pixel (x, y) = $0"),
        ("region", "region (x, y, w, h) = $0"),
        ("same_as", "same_as \"$0\""),
    ];
    forms.map(|(word, insert)| Item::new(word, ItemKind::Keyword).insert(insert)).to_vec()
}

/// A parameter of an object.
pub(super) fn param(given: Given) -> Item {
    let required = matches!(given, Given::Param(param, _) if param.required);
    Item::new(given.name(), ItemKind::Param)
        .insert(format!("{} = $0", given.name()))
        .detail(given.facts())
        .doc(given.doc())
        .rank(u8::from(!required))
}

/// What `units { }` may give a unit to: a unit of one name.
pub(super) fn dimensions() -> Vec<Item> {
    let with_unit = |name: &&str| {
        let wanted = types::dimension(name).filter(|dimension| !dimension.is_none());
        UNITS.iter().any(|(_, unit)| Some(unit.dimension) == wanted)
    };
    let names = types::names().filter(with_unit);
    names.map(|name| Item::new(name, ItemKind::Param).insert(format!("{name} = $0"))).collect()
}

/// The parameters that a file declares.
pub(super) fn params_of(document: &Document) -> Vec<Item> {
    let stmts = document.pieces().iter().flat_map(|piece| &piece.read.stmts);
    let defs = stmts.filter(|stmt| !stmt.is_off());
    let params = defs.filter_map(|stmt| match &stmt.node {
        StmtNode::Param(def) => Some(def),
        _ => None,
    });
    params
        .map(|def| {
            let name = &def.name.text;
            Item::new(&**name, ItemKind::Param)
                .insert(format!("{name} = $0"))
                .detail(&*def.ty.name.text)
                .doc(def.doc.as_str())
        })
        .collect()
}

/// The names that a file defines before a byte.
pub(super) fn names(document: &Document, before: usize) -> Vec<Item> {
    let mut out = vec![];
    for piece in document.pieces().iter().take_while(|piece| piece.end <= before) {
        for name in &piece.read.facts.defines {
            let start = name.span.range().start;
            let symbol = piece.symbols().iter().find(|symbol| symbol.start == start);
            let item = Item::new(&*name.text, ItemKind::Name).doc(piece.doc());
            out.push(match symbol.map(|symbol| &symbol.role) {
                Some(Role::Definition(Sort::Fn)) => {
                    let usage = Signature::of(document, piece).map(|found| found.usage());
                    let insert = format!("{}($0)", name.text);
                    let item = Item { kind: ItemKind::Function, ..item };
                    item.detail(usage.unwrap_or_default()).insert(insert)
                }
                Some(Role::Definition(Sort::Param)) => item.detail("a parameter"),
                Some(Role::Definition(Sort::Import(_))) => item.detail("an imported file"),
                _ => item,
            });
        }
    }
    out
}

/// Functions and constants that every scene has.
pub(super) fn functions(of: impl Fn(&str) -> bool) -> Vec<Item> {
    let one = |function: Function| {
        let name = function.name;
        let item = Item::new(name, ItemKind::Function).doc(function.text());
        if function.arguments.is_empty() {
            return item.detail("a constant");
        }
        let texts = OF_A_TEXT.contains(&name) || name == "spectrum.file";
        let insert = if texts { format!("{name}(\"$0\")") } else { format!("{name}($0)") };
        item.detail(function.usage).insert(insert)
    };
    // `rgb` alone is a mistake.
    manual::functions().filter(|it| of(it.name) && it.name != "rgb").map(one).collect()
}

/// Whether a function makes a colour or spectrum.
pub(super) fn is_colour(name: &str) -> bool {
    let first = name.split('.').next().unwrap_or_default();
    ["rgb", "xyz", "blackbody", "spectrum", "illuminant", "metal", "glass"].contains(&first)
}

/// What the language's own word for a category says.
pub(super) fn page_of(category: &str) -> Option<&'static str> {
    manual::find(category).map(|word| word.doc)
}

impl Document {
    /// The labels of its objects, in order, each once.
    pub(super) fn labels(&self) -> Vec<Arc<str>> {
        let mut seen = HashSet::new();
        let symbols = self.pieces().iter().flat_map(super::piece::Piece::symbols);
        let labels = symbols.filter(|symbol| symbol.role == Role::Label).map(|symbol| &symbol.text);
        labels.filter(|label| seen.insert(*label)).cloned().collect()
    }
}
