//! Lines that somebody has only begun to write: what is missing where they end.

use luxel_core::diag::Diagnostic;

use super::around::{Around, Place, is_category, told};
use super::head::opens_block;
use super::lex::{Token, TokenKind};
use super::make::nameless;
use crate::words::{BEFORE_NAMES, RESERVED, STATEMENTS};

impl Around<'_> {
    /// A word that begins a line behind what wants something more, near the place where reading stopped: how
    /// many tokens back.
    pub(super) fn swallowed(&self) -> Option<usize> {
        (0..=3).find(|back| {
            let word = self.before(*back).filter(|t| t.first_on_line && t.kind == TokenKind::Word);
            // The value of a function may begin below its head.
            let gives = word.is_some_and(|word| word.text == "if");
            let wants_more = || self.before(back + 1).is_some_and(Token::is_operator) && !gives;
            word.is_some() && (wants_more() || self.is_lone(self.at - back))
        })
    }

    /// An object that begins a line behind a `for` or `if` whose head ends the line before.
    pub(super) fn swallowed_by_head(&self) -> Option<usize> {
        let begins = |i: &usize| opens_block(self.word(*i)) && self.begins(*i);
        let start = (0..self.at).rev().find(begins)?;
        let mut head = (start + 1..self.at).take_while(|i| self.word(*i) != "{");
        head.find(|i| {
            let (token, before) = (&self.tokens[*i], &self.tokens[i - 1]);
            let wants_more = before.is_operator() || matches!(before.text, "for" | "if" | "in");
            let is_object = is_category(token.text) && self.is_word(i + 1);
            wants_more && is_object && token.first_on_line
        })
    }

    /// Whether a statement begins with token `i`, and before it stands a word that something must follow.
    fn is_lone(&self, i: usize) -> bool {
        let Some(before) = i.checked_sub(1) else { return false };
        let is_object = is_category(self.word(i)) && self.is_word(i + 1);
        let begins = is_object || STATEMENTS.contains(&self.word(i));
        let wants_more = match self.word(before) {
            "let" | "param" | "fn" | "place" | "include" | "import" | "set" => self.begins(before),
            "as" | "in" | "else" => true,
            _ => false,
        };
        begins && wants_more
    }
}

/// Why the place cannot be read, if a line was only begun there.
pub(super) fn unfinished(around: &Around<'_>) -> Option<Diagnostic> {
    keyword(around)
        .or_else(|| equals_first(around))
        .or_else(|| head(around))
        .or_else(|| parameter(around))
}

/// `let = tones [red, green]`, which is read up to the comma.
fn equals_first(around: &Around<'_>) -> Option<Diagnostic> {
    let i = around.tokens.iter().position(|token| token.kind != TokenKind::Doc)?;
    let (word, name) = (&around.tokens[i], around.tokens.get(i + 2)?);
    if !BEFORE_NAMES.contains(&word.text) || around.word(i + 1) != "=" || around.at <= i + 2 {
        return None;
    }
    let found = nameless(word.text, around.span(word));
    if word.text == "fn"
        || name.kind != TokenKind::Word
        || name.first_on_line
        || RESERVED.contains(&name.text)
    {
        return Some(found);
    }
    let both = around.span(&around.tokens[i + 1]).to(around.span(name));
    Some(found.guess(both, format!("{} =", name.text)))
}

/// `let`, and a line that begins another statement.
fn keyword(around: &Around<'_>) -> Option<Diagnostic> {
    let next = around.at - around.swallowed()?;
    let word = around.tokens.get(next.checked_sub(1)?).filter(|_| around.is_lone(next))?;
    let span = around.span(word);
    Some(match word.text {
        "include" | "import" => told(span, format!("a path is missing after `{}`", word.text))
            .help(format!("it is written `{} \"tools.scene\"`", word.text)),
        "in" => around.error("E0015", word, "a value is missing after `in`"),
        "else" => told(span, "the `{` of this `else` is missing")
            .help("a block stands between `{` and `}`"),
        text if BEFORE_NAMES.contains(&text) => nameless(text, span),
        text => told(span, format!("a name is missing after `{text}`")),
    })
}

/// `if` or `for i in 0..`, and a line that begins an object.
fn head(around: &Around<'_>) -> Option<Diagnostic> {
    let last = around.tokens.get(around.swallowed_by_head()?.checked_sub(1)?)?;
    let message = format!("a value is missing after `{}`", last.text);
    Some(around.error("E0015", last, message))
}

/// `{ radius }`
fn parameter(around: &Around<'_>) -> Option<Diagnostic> {
    let name = around.before(1).filter(|name| name.kind == TokenKind::Word)?;
    let ends = |token: &Token<'_>| token.first_on_line || matches!(token.text, "}" | "," | ";");
    let is_brace = around.open.last().map_or(around.place == Place::Fields, |open| {
        around.word(*open) == "{" && around.within(*open) == Place::Fields
    });
    let may_be_placed = around.is_in_group() && !is_category(name.text);
    let is_begun = is_brace && around.begins(around.at - 1) && !may_be_placed;
    if !is_begun || !around.current().is_none_or(ends) {
        return None;
    }
    let message = format!("`=` and a value are missing behind `{}`", name.text);
    let found = around.error("E0012", name, message);
    Some(if is_category(name.text) {
        found.help(format!("an object is written `{} NAME {{ … }}`", name.text))
    } else {
        found
    })
}
