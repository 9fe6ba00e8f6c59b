//! What may be written at a place.

use std::ops::Range;
use std::path::Path;

use luxel_core::registry::Registry;
use luxel_sdk::color;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Type, UNITS};

use super::context::{Context, Head, Inside, dotted};
use super::define::{Project, beside};
use super::document::Document;
use super::schema::{self, Given};
use super::statements;
use crate::eval::types;
use crate::manual;
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
    /// The folder whose files may be written too, as far as it is written; only those that end so.
    pub files: Option<(String, Vec<&'static str>)>,
}

/// What may be written at a byte of a file.
pub fn complete(project: &dyn Project, path: &Path, at: usize, registry: &Registry) -> Completion {
    let Some(document) = project.document(path) else { return Completion::default() };
    let here = Context::at(&document, at);
    let asked = Asked { project, path, registry, here: &here };
    match &here.inside {
        Inside::Comment => Completion::default(),
        Inside::Text(range) => asked.in_text(range),
        Inside::Code => {
            let items = asked.in_code();
            Completion { range: here.word.clone(), items, files: None }
        }
    }
}

struct Asked<'a> {
    project: &'a dyn Project,
    path: &'a Path,
    registry: &'a Registry,
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
        if last == ":" {
            return types::names().map(|name| Item::new(name, ItemKind::Type)).collect();
        }
        if on_line && self.follows_number() {
            return self.units();
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
            _ => {}
        }
        let wants = here.back(1).is_none_or(|token| {
            token.is_operator() && token.text != "."
                || matches!(token.text, "(" | "[" | ",")
                || matches!(token.text, "in" | "if" | "assert")
        });
        if wants { self.values() } else { vec![Item::new("with", ItemKind::Keyword)] }
    }

    /// Whether a unit may follow what stands before: a number, or a bracket that closes.
    fn follows_number(&self) -> bool {
        self.here.back(1).is_some_and(|last| {
            last.kind == TokenKind::Number || last.kind == TokenKind::Table || {
                let inside = self.here.text_back(2).starts_with(|c: char| c.is_ascii_digit());
                matches!(last.text, ")" | "]") && inside
            }
        })
    }

    /// Units; those that are wanted stand first.
    fn units(&self) -> Vec<Item> {
        let equals = self.here.before.iter().rposition(|token| token.text == "=");
        let name = equals.and_then(|i| i.checked_sub(1)).map(|i| self.here.before[i].text);
        let frame = self.here.frames.iter().rev().map(|frame| &frame.what);
        let mut objects = frame.filter(|head| matches!(head, Head::Object { .. } | Head::Amend(_)));
        let given = objects.next().and_then(|head| {
            let givens = schema::givens(self.registry, self.here.document, head);
            givens.into_iter().find(|given| Some(given.name()) == name)
        });
        let (mut wanted, mut first) = (None, vec![]);
        if let Some(Given::Param(param)) = given {
            wanted = schema::dimension(param);
            let whole = param.unit.split('|').filter(|unit| unit.contains(['/', '^']));
            first = whole.map(|unit| Item::new(unit, ItemKind::Unit).rank(0)).collect();
        }
        first.extend(UNITS.iter().map(|(name, unit)| {
            let fits = wanted == Some(unit.dimension);
            let rank = if fits { 1 } else { 6 };
            Item::new(*name, ItemKind::Unit).detail(unit.dimension.name()).rank(rank)
        }));
        first
    }

    /// What may stand after `name.`.
    fn members(&self) -> Vec<Item> {
        let (before, rest) = dotted(&self.here.before[..self.here.before.len() - 1]);
        if rest.last().is_some_and(|token| token.text == "set") {
            let found = schema::givens_of_label(self.registry, self.project, self.path, &before);
            return found.unwrap_or_default().into_iter().map(statements::param).collect();
        }
        let space = format!("{before}.");
        let own = statements::functions(|name| name.starts_with(&space));
        let mut out: Vec<Item> = own.into_iter().map(|item| item.without(&space)).collect();
        if let Some(file) = self.here.document.import(&before)
            && let Some(module) = self.project.document(&beside(self.path, &file))
        {
            out.extend(statements::names(&module, usize::MAX));
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
                let file = self.project.document(&beside(self.path, file));
                file.map_or(vec![], |file| statements::params_of(&file))
            }
            Some(head @ (Head::Object { .. } | Head::Amend(_) | Head::Place)) => {
                let is_group = matches!(head, Head::Object { category, .. } if category == "group");
                let mut out = params(schema::givens(self.registry, here.document, head));
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
        self.registry.of_kind(kind).map(one).collect()
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
                let object = schema::object_named(here.document, &item.label, 8);
                match object {
                    Some((word, kind)) if kinds.is_empty() || kinds.contains(&&*word) => {
                        let detail = format!("{word} {}", kind.unwrap_or_default());
                        Some(item.detail(detail.trim()).rank(if kinds.is_empty() { 3 } else { 1 }))
                    }
                    Some(_) => None,
                    None => Some(item.rank(3)),
                }
            });
        locals.chain(top).collect()
    }

    /// What may be a value at the place.
    fn values(&self) -> Vec<Item> {
        let given = schema::given_to(self.registry, self.here);
        if let Some(Given::Param(param)) = given {
            return self.values_of(param);
        }
        let mut out = self.names(&[]);
        if let Some(Head::Call(callee)) = self.here.head() {
            out.extend(self.arguments(callee));
        }
        out.extend(statements::functions(|_| true));
        out.extend(statements::categories());
        out.extend(["true", "false", "if"].map(|word| Item::new(word, ItemKind::Keyword).rank(7)));
        out
    }

    fn values_of(&self, param: &Param) -> Vec<Item> {
        let quoted = |word: &str| Item::new(format!("\"{word}\""), ItemKind::Value).rank(0);
        match param.ty {
            Type::Bool => ["true", "false"].map(|word| Item::new(word, ItemKind::Value)).to_vec(),
            Type::Choice => param.words().map(quoted).collect(),
            Type::Text | Type::File => vec![Item::new("\"\"", ItemKind::Value).insert("\"$0\"")],
            Type::Look => statements::functions(|name| name == "look_at"),
            Type::Object(kind) => self.objects(kind.word()),
            Type::Part => self.objects("shape"),
            Type::ComplexIor => {
                let mut out = statements::functions(|name| name == "metal");
                out.extend(self.names(&["-"]));
                out
            }
            Type::Spectrum | Type::Emission => {
                let mut out = statements::functions(statements::is_colour);
                if param.textured {
                    out.extend(self.objects("texture"));
                } else {
                    out.extend(self.names(&["-"]));
                }
                out
            }
            _ => {
                let textured = if param.textured { "texture" } else { "-" };
                let mut out = self.names(&[textured]);
                out.extend(
                    manual::default(param)
                        .map(|text| Item::new(text, ItemKind::Value).detail("the default").rank(0)),
                );
                out.extend(statements::functions(|name| !statements::is_colour(name)));
                out
            }
        }
    }

    /// Names of a kind of object, and a new one.
    fn objects(&self, word: &str) -> Vec<Item> {
        let mut out = self.names(&[word]);
        out.push(Item::new(word, ItemKind::Category).insert(format!("{word} $0")).rank(2));
        out
    }

    /// Names of a function's arguments.
    fn arguments(&self, callee: &str) -> Vec<Item> {
        let item = |name: &str| {
            Item::new(format!("{name} = "), ItemKind::Param).detail(format!("of {callee}")).rank(2)
        };
        let own = self.here.document.arguments(callee);
        let builtin = manual::function(callee).map_or(vec![], |function| function.arguments);
        own.iter().map(|name| item(name)).chain(builtin.into_iter().map(item)).collect()
    }

    fn in_text(&self, range: &Range<usize>) -> Completion {
        let here = self.here;
        let text = here.document.text();
        let mut out = Completion { range: range.clone(), ..Completion::default() };
        let items = |names: &mut dyn Iterator<Item = &str>| -> Vec<Item> {
            names.map(|name| Item::new(name, ItemKind::Value)).collect()
        };
        let written = || text[range.clone()].to_owned();
        let last = here.text_back(1);
        match here.head() {
            Some(Head::Call(callee)) if matches!(last, "(" | "=") => match callee.as_str() {
                "metal" => out.items = items(&mut color::metal_names()),
                "glass" => out.items = items(&mut color::GLASSES.iter().map(|glass| glass.name)),
                "illuminant" => out.items = items(&mut color::illuminant_names()),
                "spectrum.file" => out.files = Some((written(), vec![])),
                _ => {}
            },
            _ if matches!(last, "include" | "import" | "same_as") => {
                out.files = Some((written(), vec![".scene"]));
            }
            _ => match schema::given_to(self.registry, here) {
                Some(Given::Param(param)) if param.ty == Type::File => {
                    out.files = Some((written(), vec![]));
                }
                Some(Given::Param(param)) => out.items = items(&mut param.words()),
                _ => {}
            },
        }
        out
    }
}

/// Whether it is kept for old scenes alone.
fn is_old(given: Given) -> bool {
    matches!(given, Given::Param(param) if !param.deprecated.is_empty())
}

impl Document {
    /// The file that a name imports.
    fn import(&self, name: &str) -> Option<String> {
        use super::symbols::{Role, Sort};
        let piece = self.piece_at(self.top(name)?.start)?;
        piece.symbols().iter().find_map(|symbol| match &symbol.role {
            Role::Definition(Sort::Import(file)) if *symbol.text == *name => Some(file.to_string()),
            _ => None,
        })
    }
}
