//! Parts of the tree that both readers make alike, from what they have read.

use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::Unit;

use super::tree::{Doc, Expr, ExprNode, Form, ListTy, Name, Ty};

/// What is said where no name follows a word that wants one.
pub(super) fn nameless(word: &str, at: Span) -> Diagnostic {
    Diagnostic::error("E0019", at, format!("a name is missing after `{word}`"))
}

/// A doc comment, its slashes included.
pub(super) fn doc(text: &str, span: Span) -> Doc {
    let text = text.trim_start_matches('/').trim_end();
    Doc { text: text.strip_prefix(' ').unwrap_or(text).to_owned(), span }
}

/// The lines of doc comments as one text.
pub(super) fn lines(docs: &[Doc]) -> String {
    let lines: Vec<&str> = docs.iter().map(|doc| doc.text.trim()).collect();
    lines.join("\n")
}

/// A type as it is written, perhaps with brackets.
pub(super) fn ty(text: &str, span: Span) -> Ty {
    let Some((name, list)) = text.split_once('[') else {
        return Ty { name: Name { text: text.into(), span }, list: ListTy::One };
    };
    let list = list.trim_end_matches(']').parse().map_or(ListTy::Any, ListTy::Exactly);
    let start = span.range().start;
    let span = Span::new(span.source, start, start + name.len());
    Ty { name: Name { text: name.into(), span }, list }
}

/// What stands between the quotes of a string, its escapes resolved; the grammar and the pre-scan let
/// only known ones through.
pub(super) fn unescape(body: &str) -> Arc<str> {
    if !body.contains('\\') {
        return body.into();
    }
    let mut out = String::with_capacity(body.len());
    let mut chars = body.chars();
    while let Some(c) = chars.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        match chars.next() {
            Some('n') => out.push('\n'),
            Some('t') => out.push('\t'),
            Some('u') => {
                let digits: String =
                    chars.by_ref().skip(1).take_while(|digit| *digit != '}').collect();
                let code = u32::from_str_radix(&digits, 16).ok().and_then(char::from_u32);
                out.push(code.unwrap_or(char::REPLACEMENT_CHARACTER));
            }
            Some(other) => out.push(other),
            None => {}
        }
    }
    out.into()
}

/// Words joined by dots that stand for a value.
pub(super) fn path(words: Box<[Name]>) -> ExprNode {
    match &words[..] {
        [word] if &*word.text == "true" => ExprNode::Bool(true),
        [word] if &*word.text == "false" => ExprNode::Bool(false),
        _ => ExprNode::Path(words),
    }
}

/// What stands between brackets.
pub(super) enum Inside {
    /// Literal numbers; the span is that of them all.
    Numbers(Arc<[f64]>, Span),
    Items(Box<[Expr]>),
}

/// Brackets with what is in them; `comma` says whether one stands after the last item.
pub(super) fn bracketed(
    inside: Inside,
    comma: bool,
    unit: Option<Arc<Unit>>,
    form: Form,
) -> ExprNode {
    let single = form == Form::Tuple && !comma;
    match inside {
        Inside::Numbers(data, span) if data.len() == 1 && single => {
            let inner = Expr { span, node: ExprNode::Number(data[0], None) };
            ExprNode::Paren { inner: Box::new(inner), unit }
        }
        Inside::Numbers(data, _) => ExprNode::Numbers { data, unit, form },
        Inside::Items(items) if single => match <Box<[Expr; 1]>>::try_from(items) {
            Ok(one) => {
                let [inner] = *one;
                ExprNode::Paren { inner: Box::new(inner), unit }
            }
            Err(items) => ExprNode::Items { items, unit, form },
        },
        Inside::Items(items) => ExprNode::Items { items, unit, form },
    }
}
