//! What may be written at a place.

mod quoted;
mod units;
mod values;

use std::ops::Range;
use std::path::Path;

use luxel_core::registry::Registry;
use luxel_sdk::kind::Kind;

use super::context::{Context, Head, Inside, dotted};
use super::define::{Project, beside};
use super::named::{Around, ObjectSort};
use super::schema::{self, Given};
use super::statements;
use crate::eval::types;
use crate::syntax::TokenKind;

/// What an item of a list is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ItemKind {
    /// A word of the language.
    Keyword,
    /// A category of objects.
    Category,
    /// A kind of object.
    Class,
    /// A parameter.
    Param,
    /// A name of the scene.
    Name,
    /// A function.
    Function,
    /// A unit.
    Unit,
    /// One of a few values.
    Value,
    /// A type.
    Type,
    /// A file or folder.
    File,
}

/// Something that may be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// What is shown, and what is written if `insert` is empty.
    pub label: String,
    /// What it is.
    pub kind: ItemKind,
    /// Type, unit and default, or the like, on one line.
    pub detail: String,
    /// The manual's text.
    pub doc: String,
    /// What is written; `$0` is where the cursor goes. Empty for the label.
    pub insert: String,
    /// Less stands further up.
    pub rank: u8,
}

impl Item {
    pub(super) fn new(label: impl Into<String>, kind: ItemKind) -> Self {
        let (detail, doc, insert) = Default::default();
        Self { label: label.into(), kind, detail, doc, insert, rank: 5 }
    }

    /// A file or folder.
    pub fn file(name: String) -> Self {
        Self::new(name, ItemKind::File)
    }

    /// A plugin library that is not loaded, and why not.
    pub fn library(name: &str, why: &str) -> Self {
        Self::new(name, ItemKind::Value).detail(why)
    }

    pub(super) fn detail(self, detail: impl Into<String>) -> Self {
        Self { detail: detail.into(), ..self }
    }

    pub(super) fn doc(self, doc: impl Into<String>) -> Self {
        Self { doc: doc.into(), ..self }
    }

    pub(super) fn insert(self, insert: impl Into<String>) -> Self {
        Self { insert: insert.into(), ..self }
    }

    /// Without what is written already.
    fn without(self, prefix: &str) -> Self {
        let rest = |text: String| text.strip_prefix(prefix).map(str::to_owned).unwrap_or(text);
        Self { label: rest(self.label), insert: rest(self.insert), ..self }
    }

    pub(super) fn rank(self, rank: u8) -> Self {
        Self { rank, ..self }
    }
}

/// What may be written at a place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// The bytes that an item takes the place of.
    pub range: Range<usize>,
    /// The items.
    pub items: Vec<Item>,
    /// What may be written too, and only the disk knows.
    pub on_disk: Option<OnDisk>,
}

/// What the disk has to tell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OnDisk {
    /// The files of a folder.
    Files {
        /// The path as far as it is written.
        written: String,
        /// How names of files end, in whatever case; if there are none, any file will do.
        ends: Vec<&'static str>,
    },
    /// Plugin libraries that are not loaded.
    Libraries,
}

/// What may be written at a byte of a file.
pub fn complete(project: &dyn Project, path: &Path, at: usize, registry: &Registry) -> Completion {
    let Some(document) = project.document(path) else { return Completion::default() };
    let here = Context::at(&document, at);
    let around = Around { project, path, document: &document, registry };
    let asked = Asked { around, here: &here };
    match &here.inside {
        Inside::Comment => Completion::default(),
        Inside::Text(range) => asked.in_text(range),
        Inside::Code => {
            let items = asked.in_code().into_iter().map(|item| asked.fitted(item)).collect();
            Completion { range: here.word.clone(), items, on_disk: None }
        }
    }
}

struct Asked<'a> {
    around: Around<'a>,
    here: &'a Context<'a>,
}

impl Asked<'_> {
    fn in_code(&self) -> Vec<Item> {
        let here = self.here;
        let last = here.text_back(1);
        let on_line = !here.is_fresh;
        if last == "." {
            return self.members();
        }
        if last == "@" {
            return statements::attributes();
        }
        if last == ":" {
            return types::names().map(|name| Item::new(name, ItemKind::Type)).collect();
        }
        if let Some(units) = self.units() {
            return units;
        }
        if here.begins() {
            return self.beginning();
        }
        if on_line && let Some(kind) = Kind::of_word(last) {
            return self.kinds(kind);
        }
        match last {
            "let" | "param" | "fn" | "for" | "as" if on_line => return vec![],
            "set" if on_line => return self.labels(),
            "place" if on_line => {
                return self.names(&["group", "shape", "asset", "light", "camera"]);
            }
            "expect" if on_line => return statements::expectations(),
            "use" if on_line => return vec![Item::new("plugin", ItemKind::Keyword)],
            "=" if here.head() == Some(&Head::Units) => return self.units_of_type(),
            _ => {}
        }
        let wants = here.back(1).is_none_or(|token| {
            token.is_operator() && token.text != "."
                || matches!(token.text, "(" | "[" | ",")
                || matches!(token.text, "in" | "if" | "assert")
        });
        if wants {
            return self.values();
        }
        let word = match here.text_back(2) {
            "plugin" => "version",
            "import" => "as",
            _ => "with",
        };
        vec![Item::new(word, ItemKind::Keyword)]
    }

    /// An item for what stands behind the place: brackets that stand there are not written again.
    fn fitted(&self, item: Item) -> Item {
        let is_called = self.here.after().is_some_and(|next| next.text == "(");
        if is_called && item.kind == ItemKind::Function { item.insert("") } else { item }
    }

    /// What may stand after `name.`.
    fn members(&self) -> Vec<Item> {
        let (before, rest) = dotted(&self.here.before[..self.here.before.len() - 1]);
        if rest.last().is_some_and(|token| token.text == "set") {
            let found = schema::givens_of_label(self.around, &before);
            return found.unwrap_or_default().into_iter().map(statements::param).collect();
        }
        let space = format!("{before}.");
        let own = statements::functions(|name| name.starts_with(&space));
        let mut out: Vec<Item> = own.into_iter().map(|item| item.without(&space)).collect();
        if let Some((path, document)) = self.around.module(&before) {
            let there = Around { path: &path, document: &document, ..self.around };
            let names = statements::names(&document, usize::MAX);
            out.extend(names.into_iter().map(|item| match there.object_named(&item.label) {
                Some(object) => item.detail(words(&object)),
                None => item,
            }));
        }
        out
    }

    /// What may stand where a statement, a field or an argument begins.
    fn beginning(&self) -> Vec<Item> {
        let here = self.here;
        let given = here.given();
        let params = |givens: Vec<Given>| -> Vec<Item> {
            let open = givens.into_iter().filter(|one| !given.contains(&one.name()));
            open.filter(|one| !is_old(*one)).map(statements::param).collect()
        };
        match here.head() {
            Some(Head::Units) => statements::dimensions(),
            Some(Head::Where) => statements::params_of(here.document),
            Some(Head::IncludeWith(file)) => {
                let file = self.around.project.document(&beside(self.around.path, file));
                file.map_or(vec![], |file| statements::params_of(&file))
            }
            Some(head @ (Head::Object { .. } | Head::Amend(_) | Head::Place)) => {
                let is_group = matches!(head, Head::Object { category, .. } if category == "group");
                let mut out = params(schema::givens(self.around, head));
                match head {
                    Head::Amend(_) => {}
                    _ if is_group => out.extend(statements::all()),
                    _ => out.extend(statements::in_objects()),
                }
                out
            }
            Some(Head::Record) => vec![],
            _ if here.document.text()[..here.word.start].trim().is_empty() => {
                vec![Item::new("scene 1", ItemKind::Keyword).detail("begins every scene")]
            }
            _ => {
                let mut out = statements::all();
                let fns = self.names(&[]).into_iter().filter(|i| i.kind == ItemKind::Function);
                out.extend(fns);
                out
            }
        }
    }

    fn kinds(&self, kind: Kind) -> Vec<Item> {
        let one = |entry: &luxel_core::registry::Entry| {
            let class = &entry.class;
            let required: Vec<&str> = class
                .params
                .iter()
                .filter(|param| param.required)
                .map(|param| param.name)
                .collect();
            let body = match required.split_first() {
                None => "{ $0 }".to_owned(),
                Some((first, [])) => format!("{{ {first} = $0 }}"),
                Some((first, rest)) => format!("{{ {first} = $0, {} = }}", rest.join(" = , ")),
            };
            let braces = self
                .here
                .after()
                .is_some_and(|next| next.text == "{" || next.kind == TokenKind::Text);
            let insert = if braces { String::new() } else { format!("{} {body}", class.name) };
            Item::new(class.name, ItemKind::Class)
                .detail(schema::summary(class))
                .doc(class.doc.trim())
                .insert(insert)
        };
        self.around.registry.of_kind(kind).map(one).collect()
    }

    fn labels(&self) -> Vec<Item> {
        let labels = self.here.document.labels();
        labels.into_iter().map(|label| Item::new(&*label, ItemKind::Name)).collect()
    }

    /// Names of the scene that stand before the place; objects only of some kinds, if any are named.
    fn names(&self, kinds: &[&str]) -> Vec<Item> {
        let here = self.here;
        let locals = here.locals().into_iter().map(|name| Item::new(name, ItemKind::Name).rank(1));
        let top =
            statements::names(here.document, here.word.start).into_iter().filter_map(|item| {
                let object = self.around.object_named(&item.label);
                match object {
                    Some(object) if kinds.is_empty() || kinds.contains(&&*object.0) => {
                        let rank = if kinds.is_empty() { 3 } else { 1 };
                        Some(item.detail(words(&object)).rank(rank))
                    }
                    Some(_) => None,
                    None => Some(item.rank(3)),
                }
            });
        locals.chain(top).collect()
    }
}

/// Whether it is kept for old scenes alone.
fn is_old(given: Given) -> bool {
    matches!(given, Given::Param(param, _) if !param.deprecated.is_empty())
}

/// Category and kind of an object.
fn words((category, kind): &ObjectSort) -> String {
    let words = [Some(category), kind.as_ref()];
    words.into_iter().flatten().map(String::as_str).collect::<Vec<_>>().join(" ")
}
