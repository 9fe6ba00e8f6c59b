//! What stands around a place of a text, by its tokens alone: also where the text cannot be read.

use std::ops::Range;

use luxel_sdk::kind::Kind;

use super::document::Document;
use crate::syntax::{Token, TokenKind, tokens};

/// In what a place lies.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Inside {
    Code,
    Comment,
    /// The bytes of the string so far, without its opening quote.
    Text(Range<usize>),
}

/// What stands around a place.
pub(super) struct Context<'d> {
    pub(super) document: &'d Document,
    pub(super) inside: Inside,
    /// The tokens before the word at the place, from the start of the statement.
    pub(super) before: Vec<Token<'d>>,
    /// The word at the place; empty if there is none.
    pub(super) word: Range<usize>,
    /// The brackets that are open, outermost first.
    pub(super) frames: Vec<Frame>,
    /// Whether a line begins between the token before and the word.
    pub(super) is_fresh: bool,
    end: usize,
}

/// An open bracket.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) what: Head,
    /// The first token in it, among those before.
    pub(super) first: usize,
}

/// What a bracket belongs to.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Head {
    /// `category kind "label" {`
    Object {
        category: String,
        kind: Option<String>,
    },
    /// `name with {`
    Amend(String),
    /// `include "file" with {`
    IncludeWith(String),
    /// `place name {`
    Place,
    Units,
    /// `where {`
    Where,
    /// The statements of a loop, a condition or a function.
    Block,
    Record,
    /// `function(`
    Call(String),
    Paren,
    List,
}

impl<'d> Context<'d> {
    /// What stands around a byte.
    pub(super) fn at(document: &'d Document, at: usize) -> Self {
        let text = document.text();
        let piece = document.piece_at(at);
        let (start, end) = piece.map_or((0, text.len()), |piece| (piece.start, piece.end));
        let end = end.max(at);
        let mut before: Vec<Token<'d>> = tokens(text, start..at).collect();
        let mut inside = Inside::Code;
        let mut word = at..at;
        let last = before.last().copied();
        match last {
            Some(last) if last.kind == TokenKind::Doc && last.end() == at => {
                inside = Inside::Comment;
            }
            Some(last)
                if last.kind == TokenKind::Text && last.end() == at && !is_closed(last.text) =>
            {
                inside = Inside::Text(last.start + 1..at);
                before.pop();
            }
            Some(last) if last.kind == TokenKind::Word && last.end() == at => {
                word = last.start..at;
                before.pop();
            }
            _ if is_comment(&text[last.map_or(start, |last| last.end())..at]) => {
                inside = Inside::Comment;
            }
            _ => {}
        }
        let is_word = |c: &char| c.is_ascii_alphanumeric() || *c == '_';
        if inside == Inside::Code {
            word.end += text[at..].chars().take_while(is_word).count();
        }
        let gap = before.last().map_or(start, Token::end);
        let is_fresh = text[gap..word.start].contains('\n');
        let frames = frames(&before);
        Self { document, inside, before, word, frames, is_fresh, end }
    }

    /// The word at the place.
    pub(super) fn word(&self) -> &'d str {
        &self.document.text()[self.word.clone()]
    }

    /// The token `back` places before the word, from 1.
    pub(super) fn back(&self, back: usize) -> Option<&Token<'d>> {
        self.before.len().checked_sub(back).map(|i| &self.before[i])
    }

    /// Its text; empty if there is none.
    pub(super) fn text_back(&self, back: usize) -> &'d str {
        self.back(back).map_or("", |token| token.text)
    }

    /// What the innermost bracket belongs to.
    pub(super) fn head(&self) -> Option<&Head> {
        self.frames.last().map(|frame| &frame.what)
    }

    /// Whether a statement, a field or an argument may begin at the word.
    pub(super) fn begins(&self) -> bool {
        let block = !matches!(self.head(), Some(Head::Call(_) | Head::Paren | Head::List));
        match self.back(1) {
            None => true,
            Some(last) => {
                block
                    && (matches!(last.text, "{" | "," | ";")
                        || self.is_fresh && last.ends_operand()
                        || last.kind == TokenKind::Doc
                        || self.text_back(2) == "@")
            }
        }
    }

    /// The token after the word, if it is on its line.
    pub(super) fn after(&self) -> Option<Token<'d>> {
        let found = tokens(self.document.text(), self.word.end..self.end).next();
        found.filter(|token| !token.first_on_line)
    }

    /// How many arguments without names stand before the place in the innermost brackets.
    pub(super) fn n_unnamed(&self) -> usize {
        let Some(frame) = self.frames.last() else { return 0 };
        let (mut depth, mut named, mut out) = (0_usize, false, 0);
        for token in &self.before[frame.first..] {
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                "=" if depth == 0 => named = true,
                "," if depth == 0 => out += usize::from(!std::mem::take(&mut named)),
                _ => {}
            }
        }
        out
    }

    /// The names that the innermost brackets give values to.
    pub(super) fn given(&self) -> Vec<&'d str> {
        let Some(frame) = self.frames.last() else { return vec![] };
        let rest = tokens(self.document.text(), self.word.end..self.end);
        let all: Vec<Token<'d>> = self.before[frame.first..].iter().copied().chain(rest).collect();
        let (mut depth, mut out) = (0_usize, vec![]);
        for pair in all.windows(2) {
            match pair[0].text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" if depth == 0 => break,
                ")" | "]" | "}" => depth -= 1,
                name if depth == 0 && pair[1].text == "=" => out.push(name),
                _ => {}
            }
        }
        out
    }

    /// Names that the statement itself defines before the place, as far as its brackets are open.
    pub(super) fn locals(&self) -> Vec<&'d str> {
        let mut scopes = vec![Scope::default()];
        for (i, token) in self.before.iter().enumerate() {
            let back = |back: usize| i.checked_sub(back).map_or("", |i| self.before[i].text);
            if let Some(scope) = scopes.last_mut()
                && (token.first_on_line || matches!(token.text, "," | ";"))
            {
                scope.end();
            }
            match token.text {
                "[" | "{" => scopes.push(Scope::default()),
                "]" | "}" if scopes.len() > 1 => {
                    scopes.pop();
                }
                "(" => scopes.iter_mut().for_each(|scope| scope.n_round += 1),
                ")" => scopes.iter_mut().for_each(|scope| scope.n_round -= 1),
                name if token.kind == TokenKind::Word => {
                    let next = self.before.get(i + 1).map_or("", |token| token.text);
                    // In what its loop runs over it is not known yet.
                    let begins = |token: &Token<'_>| matches!(token.text, "{" | "=>");
                    let is_item = (back(1) == "for" || back(1) == "," && back(3) == "for")
                        && self.before[i..].iter().take(HEAD).any(begins);
                    let is_argument = next == ":" && matches!(back(1), "(" | ",");
                    let Some(scope) = scopes.last_mut() else { continue };
                    if is_item || is_argument {
                        scope.names.push(name);
                    } else if back(1) == "let" {
                        scope.begun = Some(name);
                    }
                }
                _ => {}
            }
        }
        if let Some(scope) = scopes.last_mut().filter(|_| self.is_fresh) {
            scope.end();
        }
        scopes.into_iter().flat_map(|scope| scope.names).collect()
    }
}

/// Tokens of the head of a loop that are looked at.
const HEAD: usize = 64;

/// Names of a block.
#[derive(Default)]
struct Scope<'d> {
    names: Vec<&'d str>,
    /// What a `let` defines whose value has not ended.
    begun: Option<&'d str>,
    /// Round brackets that are open since it began.
    n_round: isize,
}

impl Scope<'_> {
    /// A value ends here, unless brackets are open.
    fn end(&mut self) {
        if self.n_round <= 0 {
            self.names.extend(self.begun.take());
        }
    }
}

fn is_closed(string: &str) -> bool {
    let escapes = string.trim_end_matches('"').chars().rev().take_while(|c| *c == '\\').count();
    string.len() > 1 && string.ends_with('"') && escapes % 2 == 0
}

/// Whether what stands between tokens ends in a comment.
fn is_comment(gap: &str) -> bool {
    let line = gap.rsplit('\n').next().unwrap_or_default();
    let block = gap.rfind("/*").is_some_and(|open| !gap[open + 2..].contains("*/"));
    block || line.contains("//")
}

fn frames(tokens: &[Token<'_>]) -> Vec<Frame> {
    let mut out: Vec<Frame> = vec![];
    for (i, token) in tokens.iter().enumerate().filter(|(_, t)| t.kind == TokenKind::Mark) {
        match token.text {
            "{" => out.push(Frame { what: brace(&tokens[..i]), first: i + 1 }),
            "(" => {
                let callee = dotted(&tokens[..i]).0;
                let what = if callee.is_empty() { Head::Paren } else { Head::Call(callee) };
                out.push(Frame { what, first: i + 1 });
            }
            "[" => out.push(Frame { what: Head::List, first: i + 1 }),
            ")" | "]" | "}" => {
                out.pop();
            }
            _ => {}
        }
    }
    out
}

/// The words joined by dots at the end of tokens, and what stands before them.
pub(super) fn dotted<'t, 'd>(tokens: &'t [Token<'d>]) -> (String, &'t [Token<'d>]) {
    let Some((last, mut rest)) = tokens.split_last() else { return (String::new(), tokens) };
    if last.kind != TokenKind::Word {
        return (String::new(), tokens);
    }
    let mut words = vec![last.text];
    while let [before @ .., word, dot] = rest
        && dot.text == "."
        && word.kind == TokenKind::Word
    {
        words.push(word.text);
        rest = before;
    }
    words.reverse();
    (words.join("."), rest)
}

/// What a brace belongs to, by the tokens before it.
pub(super) fn brace(tokens: &[Token<'_>]) -> Head {
    let last = tokens.last().map_or("", |token| token.text);
    if matches!(last, "=" | "(" | "[" | "," | ":" | "=>") {
        return Head::Record;
    }
    let unlabelled = match tokens.split_last() {
        Some((label, rest)) if label.kind == TokenKind::Text => rest,
        _ => tokens,
    };
    let (word, rest) = dotted(unlabelled);
    let before = rest.last().map_or("", |token| token.text);
    match (word.as_str(), before) {
        ("units", _) => return Head::Units,
        ("where", _) => return Head::Where,
        ("with", _) => {
            return match rest {
                [.., word, file] if word.text == "include" => {
                    Head::IncludeWith(file.text.trim_matches('"').to_owned())
                }
                _ => Head::Amend(dotted(rest).0),
            };
        }
        (_, "place") => return Head::Place,
        _ => {}
    }
    let is_category = |word: &str| word == "group" || Kind::of_word(word).is_some();
    if is_category(before) && !word.is_empty() {
        return Head::Object { category: before.to_owned(), kind: Some(word) };
    }
    if is_category(&word) {
        return Head::Object { category: word, kind: None };
    }
    Head::Block
}
