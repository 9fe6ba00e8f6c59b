//! Values that may be written at a place.

use luxel_sdk::params::{Param, Type};

use super::super::context::Head;
use super::super::schema::{self, Given};
use super::super::statements;
use super::{Asked, Item, ItemKind};
use crate::manual;

/// Functions that make transforms.
const TRANSFORMS: [&str; 6] = ["move", "rotate", "scale", "matrix", "motion", "spin"];

impl Asked<'_> {
    /// What may be a value at the place.
    pub(super) fn values(&self) -> Vec<Item> {
        if let Some(Given::Param(param, _)) = schema::given_to(self.around, self.here) {
            return self.values_of(param);
        }
        if self.is_transform() {
            let make = statements::functions(|name| TRANSFORMS.contains(&name));
            let first = make.into_iter().map(|item| item.rank(0));
            return first.chain(self.names(&["-"])).collect();
        }
        let mut out = self.names(&[]);
        if let Some(Head::Call(callee)) = self.here.head()
            && matches!(self.here.text_back(1), "(" | ",")
        {
            out.extend(self.arguments(callee));
        }
        out.extend(statements::functions(|_| true));
        out.extend(statements::categories());
        out.extend(["true", "false", "if"].map(|word| Item::new(word, ItemKind::Keyword).rank(7)));
        out
    }

    /// Whether a transform is given there, or the first of a list of them.
    fn is_transform(&self) -> bool {
        let back = 1 + usize::from(self.here.text_back(1) == "[");
        self.here.text_back(back) == "=" && self.here.text_back(back + 1) == "transform"
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

    /// Arguments of a function that are not given yet.
    fn arguments(&self, callee: &str) -> Vec<Item> {
        let item = |name: &str| Item::new(format!("{name} = "), ItemKind::Param).rank(2);
        let all: Vec<Item> = match self.around.function_named(callee) {
            Some(function) => {
                let doc = format!("```scene\nfn {}\n```\n\n{}", function.usage(), function.doc);
                let of = |argument: &super::super::named::Argument| {
                    item(&argument.name).detail(argument.facts()).doc(doc.trim())
                };
                function.arguments.iter().map(of).collect()
            }
            None => manual::function(callee).map_or(vec![], |function| {
                let of = |name: &&str| {
                    item(name).detail(format!("of {}", function.usage)).doc(function.text())
                };
                function.arguments.iter().map(of).collect()
            }),
        };
        let given = self.here.given();
        let is_open =
            |item: &Item| !given.iter().any(|name| item.label.strip_suffix(" = ") == Some(name));
        all.into_iter().skip(self.here.n_unnamed()).filter(is_open).collect()
    }
}
