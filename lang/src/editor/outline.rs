//! What a file holds, as a tree of names.

use std::ops::Range;

use super::document::Document;
use crate::eval::names::moved;
use crate::syntax::{Block, Expr, ExprNode, Object, Stmt, StmtNode};

/// What an entry of an outline is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryKind {
    /// A value with a name.
    Name,
    /// A parameter.
    Param,
    /// A function.
    Function,
    /// Another file.
    File,
    /// An object.
    Object,
    /// A loop or a condition.
    Block,
}

/// A name of the file with what stands in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What is shown.
    pub name: String,
    /// What it is, in a word or two.
    pub detail: String,
    /// What it is.
    pub kind: EntryKind,
    /// The statement.
    pub range: Range<usize>,
    /// Its name, which lies in `range`.
    pub selection: Range<usize>,
    /// What stands in it.
    pub children: Vec<Entry>,
}

/// What a file holds, in order; nothing more once `stop` says so.
pub fn outline(document: &Document, stop: &dyn Fn() -> bool) -> Vec<Entry> {
    let pieces = document.pieces().iter().take_while(|_| !stop());
    pieces
        .flat_map(|piece| {
            piece.read.stmts.iter().filter_map(|stmt| entry(document.text(), stmt, piece.start))
        })
        .collect()
}

fn entry(text: &str, stmt: &Stmt, start: usize) -> Option<Entry> {
    let range = moved(stmt.span, start).range();
    let length = text.get(range.clone())?.trim_end().len();
    let range = range.start..range.start + length;
    let made = |name: &str, detail: &str, kind, at, children| {
        let selection = moved(at, start).range();
        let detail = detail.to_owned();
        Some(Entry {
            name: name.to_owned(),
            detail,
            kind,
            range: range.clone(),
            selection,
            children,
        })
    };
    match &stmt.node {
        StmtNode::Let { name, value, .. } => {
            let (detail, children) = match &value.node {
                ExprNode::Object(object) => (head(object), entries(text, &object.body, start)),
                _ => (word(value).to_owned(), vec![]),
            };
            made(&name.text, &detail, EntryKind::Name, name.span, children)
        }
        StmtNode::Param(def) => {
            made(&def.name.text, &def.ty.name.text, EntryKind::Param, def.name.span, vec![])
        }
        StmtNode::Fn(def) => made(&def.name.text, "", EntryKind::Function, def.name.span, vec![]),
        StmtNode::Import { path, name } => {
            made(&name.text, &path.text, EntryKind::File, name.span, vec![])
        }
        StmtNode::Include { path, .. } => {
            made(&path.text, "include", EntryKind::File, path.span, vec![])
        }
        StmtNode::Object(object) => {
            let shown = head(object);
            let name = object.label.as_ref().map_or(shown.as_str(), |label| &label.text);
            let detail = if object.label.is_some() { shown.as_str() } else { "" };
            let name = if name.is_empty() { &shown } else { name };
            made(name, detail, EntryKind::Object, object.head(), entries(text, &object.body, start))
        }
        StmtNode::For { item, body, .. } => {
            let name = format!("for {}", item.text);
            made(&name, "", EntryKind::Block, item.span, entries(text, body, start))
        }
        StmtNode::If { arms, otherwise } => {
            let blocks = arms.iter().map(|(_, block)| block).chain(otherwise.as_deref());
            let children = blocks.flat_map(|block| entries(text, block, start)).collect();
            made("if", "", EntryKind::Block, arms.first()?.0.span, children)
        }
        _ => None,
    }
}

fn entries(text: &str, block: &Block, start: usize) -> Vec<Entry> {
    block.stmts.iter().filter_map(|stmt| entry(text, stmt, start)).collect()
}

fn head(object: &Object) -> String {
    match &object.kind {
        Some(kind) => format!("{} {}", object.category.text, kind.text),
        None => object.category.text.to_string(),
    }
}

fn word(value: &Expr) -> &'static str {
    match &value.node {
        ExprNode::Number(..) => "number",
        ExprNode::Text(_) => "text",
        ExprNode::Numbers { .. } | ExprNode::Items { .. } | ExprNode::Comp(_) => "list",
        _ => "",
    }
}
