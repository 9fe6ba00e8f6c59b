//! What names stand for, through imports and copies with changes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::registry::Registry;

use super::define::{MAX_DOTS, Project, beside};
use super::document::Document;
use super::piece::Piece;
use crate::eval::names::moved;
use crate::syntax::{Expr, ExprNode, FnParam, ListTy, StmtNode};

/// Copies of copies that are followed.
const MAX_STEPS: usize = 8;

/// Where something is asked, and what is known there.
#[derive(Clone, Copy)]
pub(super) struct Around<'a> {
    pub(super) project: &'a dyn Project,
    pub(super) path: &'a Path,
    pub(super) document: &'a Document,
    pub(super) registry: &'a Registry,
}

/// Category and kind of an object.
pub(super) type ObjectSort = (String, Option<String>);

impl Around<'_> {
    /// The file that a name imports, which may be one of an imported file.
    pub(super) fn module(self, name: &str) -> Option<(PathBuf, Arc<Document>)> {
        let mut names = name.split('.');
        let mut path = beside(self.path, &self.document.import(names.next()?)?);
        let mut document = self.project.document(&path)?;
        for (i, name) in names.enumerate() {
            path = beside(&path, &document.import(name).filter(|_| i < MAX_DOTS)?);
            document = self.project.document(&path)?;
        }
        Some((path, document))
    }

    /// What a name says in the file that defines it, an imported one if it has dots.
    fn there<T>(self, name: &str, say: impl FnOnce(Around<'_>, &str) -> Option<T>) -> Option<T> {
        let Some((space, name)) = name.rsplit_once('.') else { return say(self, name) };
        let (path, document) = self.module(space)?;
        say(Around { path: &path, document: &document, ..self }, name)
    }

    /// Category and kind of the object that a name stands for.
    pub(super) fn object_named(self, name: &str) -> Option<ObjectSort> {
        self.object_within(name, MAX_STEPS)
    }

    fn object_within(self, name: &str, steps: usize) -> Option<ObjectSort> {
        self.there(name, |there, name| {
            let piece = there.document.piece_at(there.document.top(name)?.start)?;
            let value = piece.read.stmts.iter().find_map(|stmt| match &stmt.node {
                StmtNode::Let { name: own, value, .. } if *own.text == *name => Some(value),
                _ => None,
            })?;
            there.object_of(value, steps)
        })
    }

    fn object_of(self, value: &Expr, steps: usize) -> Option<ObjectSort> {
        match &value.node {
            ExprNode::Object(object) => {
                let kind = object.kind.as_ref().map(|kind| kind.text.to_string());
                Some((object.category.text.to_string(), kind))
            }
            ExprNode::With { of, .. } => self.object_of(of, steps),
            ExprNode::Path(path) => {
                let words: Vec<&str> = path.iter().take(MAX_DOTS).map(|name| &*name.text).collect();
                self.object_within(&words.join("."), steps.checked_sub(1)?)
            }
            _ => None,
        }
    }

    /// How the function of a name is called.
    pub(super) fn function_named(self, name: &str) -> Option<Signature> {
        self.there(name, |there, name| {
            let piece = there.document.piece_at(there.document.top(name)?.start)?;
            Signature::of(there.document, piece).filter(|found| *found.name == *name)
        })
    }
}

/// How a function of a scene is called.
pub(super) struct Signature {
    pub(super) name: Arc<str>,
    pub(super) arguments: Vec<Argument>,
    pub(super) doc: String,
}

/// An argument of a function of a scene.
pub(super) struct Argument {
    pub(super) name: Arc<str>,
    /// Its type.
    ty: String,
    /// Its default as it is written.
    default: Option<String>,
}

impl Signature {
    /// That of the function that a statement defines.
    pub(super) fn of(document: &Document, piece: &Piece) -> Option<Self> {
        let def = piece.read.stmts.iter().find_map(|stmt| match &stmt.node {
            StmtNode::Fn(def) => Some(def),
            _ => None,
        })?;
        let argument = |param: &FnParam| {
            let ty = &param.ty.name.text;
            let written = |value: &Expr| {
                let text = &document.text()[moved(value.span, piece.start).range()];
                text.split_whitespace().collect::<Vec<_>>().join(" ")
            };
            Argument {
                name: param.name.text.clone(),
                ty: match param.ty.list {
                    ListTy::One => ty.to_string(),
                    ListTy::Any => format!("{ty}[]"),
                    ListTy::Exactly(n) => format!("{ty}[{n}]"),
                },
                default: param.default.as_ref().map(written),
            }
        };
        let arguments = def.params.iter().map(argument).collect();
        Some(Self { name: def.name.text.clone(), arguments, doc: piece.doc() })
    }

    /// How it is called: `ball(r: length, n: int = 2)`.
    pub(super) fn usage(&self) -> String {
        let arguments: Vec<String> = self.arguments.iter().map(Argument::usage).collect();
        format!("{}({})", self.name, arguments.join(", "))
    }
}

impl Argument {
    /// As it is declared: `n: int = 2`.
    pub(super) fn usage(&self) -> String {
        let default = self.default.as_ref().map_or(String::new(), |text| format!(" = {text}"));
        format!("{}: {}{default}", self.name, self.ty)
    }

    /// Its type and default in a few words.
    pub(super) fn facts(&self) -> String {
        match &self.default {
            Some(text) => format!("{}, default {text}", self.ty),
            None => format!("{}, required", self.ty),
        }
    }
}

impl Document {
    /// The file that a name imports.
    pub(super) fn import(&self, name: &str) -> Option<String> {
        use super::symbols::{Role, Sort};
        let piece = self.piece_at(self.top(name)?.start)?;
        piece.symbols().iter().find_map(|symbol| match &symbol.role {
            Role::Definition(Sort::Import(file)) if *symbol.text == *name => Some(file.to_string()),
            _ => None,
        })
    }
}
