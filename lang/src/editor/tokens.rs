//! What each token is, for colouring.

use std::ops::Range;

use luxel_sdk::kind::Kind;

use super::document::Document;
use super::piece::Piece;
use super::symbols::{Role, Sort, Symbol};
use crate::eval::builtins;
use crate::syntax::{Token, TokenKind, tokens};
use crate::words::RESERVED;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// A word of the language.
    Keyword,
    /// A category of objects, or a type.
    Type,
    /// A kind of object.
    Class,
    /// A field or parameter of an object.
    Property,
    /// A name.
    Variable,
    /// A parameter of the file or of a function.
    Parameter,
    /// A function.
    Function,
    /// An imported file.
    Namespace,
    /// A unit.
    Unit,
    /// A number.
    Number,
    /// A string.
    Text,
    /// A doc comment.
    Doc,
    /// An attribute.
    Attribute,
}

/// A token with what it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coloured {
    /// Its bytes; tables may have several lines.
    pub range: Range<usize>,
    /// What it is.
    pub colour: Colour,
    /// Whether it is defined here.
    pub is_definition: bool,
}

/// The tokens that lie in `range`, in order; nothing more once `stop` says so.
pub fn coloured(
    document: &Document,
    range: &Range<usize>,
    stop: &dyn Fn() -> bool,
) -> Vec<Coloured> {
    let mut out = vec![];
    let first = document.pieces().partition_point(|piece| piece.end <= range.start);
    let head = document.pieces().first().map_or(document.text().len(), |piece| piece.start);
    if range.start < head {
        let words = tokens(document.text(), 0..head).filter(|token| token.text == "scene");
        out.extend(words.map(|token| plain(&token, Colour::Keyword)));
    }
    for piece in &document.pieces()[first..] {
        if piece.start >= range.end || stop() {
            break;
        }
        of_piece(document, piece, &mut out);
    }
    out.retain(|token| token.range.start < range.end && token.range.end > range.start);
    out
}

fn plain(token: &Token<'_>, colour: Colour) -> Coloured {
    Coloured { range: token.start..token.end(), colour, is_definition: false }
}

fn of_piece(document: &Document, piece: &Piece, out: &mut Vec<Coloured>) {
    let all: Vec<Token<'_>> = tokens(document.text(), piece.start..piece.end).collect();
    let symbols = piece.symbols();
    for (i, token) in all.iter().enumerate() {
        let start = token.start - piece.start;
        let symbol = symbols.binary_search_by_key(&start, |symbol| symbol.start).ok();
        let symbol = symbol.map(|i| &symbols[i]).filter(|_| token.kind == TokenKind::Word);
        let colour = match symbol {
            Some(symbol) => of_symbol(document, piece, symbol, 4),
            None => of_token(&all, i),
        };
        if let Some(colour) = colour {
            let is_definition = symbol.is_some_and(|s| matches!(s.role, Role::Definition(_)));
            out.push(Coloured { is_definition, ..plain(token, colour) });
        }
    }
}

fn of_symbol(document: &Document, piece: &Piece, symbol: &Symbol, steps: usize) -> Option<Colour> {
    let other = |piece: &Piece, start: usize| {
        let symbols = piece.symbols();
        let found = symbols.binary_search_by_key(&start, |symbol| symbol.start).ok()?;
        of_symbol(document, piece, &symbols[found], steps.checked_sub(1)?)
    };
    match &symbol.role {
        Role::Definition(Sort::Let | Sort::Item) | Role::Labelled => Some(Colour::Variable),
        Role::Definition(Sort::Param | Sort::ArgumentOf(_))
        | Role::Argument(_)
        | Role::ParamOf(_) => Some(Colour::Parameter),
        Role::Definition(Sort::Fn) => Some(Colour::Function),
        Role::Definition(Sort::Import(_)) => Some(Colour::Namespace),
        Role::Local(start) => other(piece, *start),
        Role::Top => match document.top_before(piece, &symbol.text) {
            Some(place) => {
                let piece = document.piece_at(place.start)?;
                other(piece, place.start - piece.start)
            }
            None => builtins::begins(&symbol.text).then_some(Colour::Function),
        },
        Role::Member(_) => Some(Colour::Property),
        Role::Label | Role::File => None,
    }
}

fn of_token(all: &[Token<'_>], i: usize) -> Option<Colour> {
    let token = &all[i];
    let before = i.checked_sub(1).map(|i| &all[i]);
    let next = all.get(i + 1).map_or("", |token| token.text);
    match token.kind {
        TokenKind::Doc => Some(Colour::Doc),
        TokenKind::Text => Some(Colour::Text),
        TokenKind::Number | TokenKind::Table => Some(Colour::Number),
        TokenKind::Mark => (token.text == "@").then_some(Colour::Attribute),
        TokenKind::Word => {
            let before_text = before.map_or("", |token| token.text);
            let on_line = !token.first_on_line;
            let number =
                before.is_some_and(|t| matches!(t.kind, TokenKind::Number | TokenKind::Table));
            match token.text {
                _ if before_text == "@" => Some(Colour::Attribute),
                word if RESERVED.contains(&word) => Some(Colour::Keyword),
                "where" | "plugin" | "version" if next != "=" => Some(Colour::Keyword),
                _ if number && on_line => Some(Colour::Unit),
                _ if matches!(before_text, ")" | "]") && on_line => Some(Colour::Unit),
                _ if next == "=" => Some(Colour::Property),
                _ if before_text == ":" => Some(Colour::Type),
                _ if Kind::of_word(before_text).is_some() && on_line => Some(Colour::Class),
                word if Kind::of_word(word).is_some() || word == "group" => Some(Colour::Type),
                _ if matches!(before_text, "/" | "*") => Some(Colour::Unit),
                _ if before_text == "expect" => Some(Colour::Keyword),
                _ => None,
            }
        }
    }
}
