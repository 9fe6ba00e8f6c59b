//! What a person did wrong where the grammar fits nothing: by the tokens around the place.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, Grade, Near, SourceId, Span, near};
use luxel_sdk::params::Unit;

use super::around::{Around, Place, is_category};
use super::borrowed::{borrowed, own_type};
use super::foreign::body_of_steps;
use super::habits::habit;
use super::head;
use super::lex::{Token, TokenKind, tokens};
use super::make::nameless;
use super::notation::{notation, remark};
use super::peers::{BEGINS, is_pbrt};
use super::unfinished::unfinished;
use super::wrapped::{choice, valued_body, wrapped};
use crate::words::{BEFORE_NAMES, OF_A_NUMBER, OF_A_TEXT, RESERVED, STATEMENTS};

/// A mistake with what is needed to go on after it.
pub(super) struct Explained {
    pub(super) diagnostic: Diagnostic,
    /// The byte at which reading stopped.
    pub(super) at: usize,
    /// The braces that are open there, outermost first, and what stands in them.
    pub(super) blocks: Vec<(usize, Place)>,
    /// Where a statement begins that the mistake swallowed.
    pub(super) resume: Option<usize>,
}

/// Tokens of a definition that are looked at for its range.
const LOOKED_AT: usize = 16;

/// What is said of `==` where a value is given.
pub(crate) const COMPARES: &str = "`==` compares; a value is given with `=`";
/// What is said of an `else` that nothing stands before.
pub(super) const LONE_ELSE: &str = "`else` without an `if` before it";

/// Explains why `text[chunk]` cannot be read as a statement; pest stopped at byte `at`.
pub(super) fn explain(
    text: &str,
    chunk: Range<usize>,
    at: usize,
    source: SourceId,
    place: Place,
) -> Explained {
    let tokens: Vec<Token<'_>> = tokens(text, chunk.clone()).collect();
    let index = tokens.iter().position(|t| t.end() > at).unwrap_or(tokens.len());
    let mut open = vec![];
    for (i, token) in tokens[..index].iter().enumerate() {
        match (token.kind, token.text) {
            (TokenKind::Mark, "(" | "[" | "{") => open.push(i),
            (TokenKind::Mark, ")" | "]" | "}") => {
                open.pop();
            }
            _ => {}
        }
    }
    let around = Around { text, tokens, at: index, open, source, end: chunk.end, place };
    let diagnostic = around.diagnose();
    // Of steps where a value is wanted, or of a choice, none is looked at for itself.
    let body = body_of_steps(&around).or_else(|| valued_body(&around));
    let is_skipped = body.is_some() || choice(&around).is_some() || own_type(&around).is_some();
    let blocks = around
        .open
        .iter()
        .filter(|_| !is_skipped)
        .filter(|i| around.tokens[**i].text == "{")
        .map(|i| (around.tokens[*i].start, around.within(*i)));
    let swallowed = around.swallowed().map(|back| around.at - back);
    let swallowed = swallowed.or_else(|| around.swallowed_by_head()).map(|i| &around.tokens[i]);
    let resume = swallowed.or_else(|| around.next_keyword());
    Explained {
        diagnostic,
        at: around.current().map_or(chunk.end, |t| t.start),
        blocks: blocks.collect(),
        resume: resume.filter(|_| around.open.is_empty() && !is_skipped).map(|t| t.start),
    }
}

impl<'a> Around<'a> {
    fn diagnose(&self) -> Diagnostic {
        self.number()
            .or_else(|| unfinished(self))
            .or_else(|| wrapped(self))
            .or_else(|| borrowed(self))
            .or_else(|| habit(self))
            .or_else(|| notation(self))
            .or_else(|| head::head(self))
            .or_else(|| self.statement_head())
            .or_else(|| self.reserved())
            .or_else(|| self.nameless_field())
            .or_else(|| self.equals())
            .or_else(|| self.dot_before_field())
            .or_else(|| self.missing_operand())
            .or_else(|| self.unit_behind_call())
            .or_else(|| self.unit_twice())
            .or_else(|| self.missing_brackets())
            .or_else(|| self.missing_comma())
            .or_else(|| self.missing_field_comma())
            .or_else(|| self.missing_comma_and_equals())
            .or_else(|| self.missing_equals())
            .or_else(|| self.untyped())
            .or_else(|| remark(self))
            .unwrap_or_else(|| self.unexpected())
    }

    fn statement_head(&self) -> Option<Diagnostic> {
        let first = self.tokens.iter().find(|t| t.kind != TokenKind::Doc)?;
        let second = self.tokens.get(1);
        if is_pbrt(first.text) && second.is_none_or(|t| t.text != "=") {
            let message = format!("`{}` looks like pbrt's language", first.text);
            let found = self.error("E0021", first, message);
            return Some(found.help(BEGINS));
        }
        let current = self.current()?;
        if let Some(lone) = [first, current].into_iter().find(|t| t.text == "else") {
            return Some(self.error("E0020", lone, LONE_ELSE.to_owned()));
        }
        let before = self.before(1)?;
        let start = (0..self.at).rev().find(|i| self.begins(*i)).unwrap_or(0);
        let after = self.tokens.get(self.at + 1);
        let is_on_line =
            |t: &Token<'_>| t.begins_operand() && !t.first_on_line && !is_category(t.text);
        let is_range = before.ends_operand() && after.is_some_and(is_on_line);
        if current.text == ":" && self.word(start) == "for" && is_range {
            let found = self.error("E0023", current, head::RANGE);
            return Some(found.guess(self.span(current), ".."));
        }
        if current.text == ":" && head::opens_block(self.word(start)) {
            let found = self.error("E0023", current, "a block stands between `{` and `}`");
            return Some(found.help("what is to be done stands in it, not behind `:`"));
        }
        let is_nameless = match before.text {
            "fn" => current.text == "(",
            _ => current.text == ":",
        };
        if is_nameless && BEFORE_NAMES.contains(&before.text) {
            return Some(nameless(before.text, self.span(before)));
        }
        if current.text == ":" && before.kind == TokenKind::Word {
            let message = "a value is given with `=`, not with `:`";
            let found = self.error("E0017", current, message);
            // `y: int = 3` says a type.
            if self.is_word(self.at + 1) && self.word(self.at + 2) == "=" {
                let start = Span::new(self.source, before.start, before.start);
                let help = "a name with a type is defined with `let` or `param`";
                let value = (self.at..).take_while(|i| !self.begins(*i) || *i == self.at);
                let has_range = value.take(LOOKED_AT).any(|i| self.word(i) == "in");
                let word = if has_range { "param " } else { "let " };
                return Some(found.help(help).guess(start, word));
            }
            return Some(self.colon(current, before, found));
        }
        None
    }

    /// With what stands for a `:` behind a word.
    fn colon(&self, colon: &Token<'_>, word: &Token<'_>, found: Diagnostic) -> Diagnostic {
        let gap = Span::new(self.source, word.end(), colon.end());
        if self.open.last().is_some_and(|open| self.word(*open) == "[") {
            let found = self.error("E0023", colon, "no `:` stands in a list");
            return found.help("pairs stand in brackets: `[(400 nm, 0.5), (700 nm, 1)]`");
        }
        // `shape: sphere { … }` where objects stand.
        let next = self.tokens.get(self.at + 1).filter(|t| t.kind == TokenKind::Word);
        let opens = self.word(self.at + 2) == "{" && self.inner() != Place::Fields;
        match next.filter(|_| opens && is_category(word.text)) {
            Some(kind) => {
                let gap = gap.to(Span::new(self.source, kind.start, kind.start));
                let message = format!("no `:` stands between `{}` and its kind", word.text);
                self.error("E0023", colon, message).fix(gap, " ")
            }
            None if word.end() < colon.start => found.fix(self.span(colon), "="),
            None => found.fix(gap, " ="),
        }
    }

    /// A word of the language where a value is wanted, on the same line.
    fn reserved(&self) -> Option<Diagnostic> {
        let (current, before) = (self.current()?, self.before(1)?);
        let wanted = before.is_operator() || matches!(before.text, "(" | "[" | ",");
        if !wanted || current.first_on_line || !RESERVED.contains(&current.text) {
            return None;
        }
        let message = format!("`{}` is a word of the language, not a value", current.text);
        Some(self.error("E0019", current, message))
    }

    /// `{ = 1 m }`
    fn nameless_field(&self) -> Option<Diagnostic> {
        let (equals, before) = (self.current()?, self.before(1)?);
        let begins = equals.first_on_line || matches!(before.text, "{" | "," | ";");
        let is_it = equals.text == "=" && begins && self.inner() == Place::Fields;
        let message = "a name is missing before `=`";
        is_it.then(|| self.error("E0023", equals, message))
    }

    /// `= =` and `==` where a value is given.
    fn equals(&self) -> Option<Diagnostic> {
        let current = self.current()?;
        let before = self.before(1)?;
        if current.text == "=" && before.text == "=" {
            let message = "`=` is written twice".to_owned();
            let span = self.span(current);
            return Some(self.error("E0013", current, message).fix(span, ""));
        }
        let near = [self.at, self.at - 1, self.at + 1];
        let doubled = near.into_iter().find(|i| self.word(*i) == "==" && self.gives(*i))?;
        let doubled = &self.tokens[doubled];
        Some(self.error("E0013", doubled, COMPARES.to_owned()).fix(self.span(doubled), "="))
    }

    /// Whether a value is given to what stands before token `sign`: not in `elif i == 1`.
    fn gives(&self, sign: usize) -> bool {
        let Some(name) = sign.checked_sub(1).filter(|i| self.is_word(*i)) else { return false };
        let Some(word) = name.checked_sub(1).filter(|_| !self.begins(name)) else { return true };
        let defines = BEFORE_NAMES.contains(&self.word(word));
        !self.is_word(word) || defines || self.word(word) == "set"
    }

    /// The next word of the language that begins a line outside brackets, or of an object that no `=`
    /// stands before.
    fn next_keyword(&self) -> Option<&Token<'a>> {
        let mut depth = 0_usize;
        let i = (self.at + 1..self.tokens.len()).find(|i| {
            let token = &self.tokens[*i];
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
            let is_object = is_category(token.text) && self.is_word(i + 1);
            let begins = is_object && self.word(i - 1) != "=" || STATEMENTS.contains(&token.text);
            depth == 0 && token.first_on_line && begins
        });
        i.map(|i| &self.tokens[i])
    }

    /// An operator with nothing after it.
    fn missing_operand(&self) -> Option<Diagnostic> {
        let operator = match self.swallowed() {
            Some(back) => self.before(back + 1)?,
            None => self.before(1)?,
        };
        let on_line = |t: &Token<'_>| t.begins_operand() && t.kind != TokenKind::Word;
        let follows = self.swallowed().is_none() && self.current().is_some_and(on_line);
        if follows || !operator.is_operator() {
            return None;
        }
        let message = format!("a value is missing after `{}`", operator.text);
        Some(self.error("E0015", operator, message))
    }

    /// `[scale 2, move at]` and `metal "Au"`
    fn missing_brackets(&self) -> Option<Diagnostic> {
        let (current, callee) = (self.current()?, self.before(1)?);
        let is_text = current.kind == TokenKind::Text;
        let of_this = if is_text { &OF_A_TEXT[..] } else { &OF_A_NUMBER };
        let is_moved = callee.text == "move" && current.kind == TokenKind::Word;
        let is_callee = of_this.contains(&callee.text) || is_moved;
        let before = self.before(2)?;
        let opens = before.is_operator() || matches!(before.text, "[" | "," | "(");
        let next = self.tokens.get(self.at + 1);
        let is_word = matches!(current.kind, TokenKind::Word | TokenKind::Text)
            && next.is_none_or(|t| t.first_on_line || matches!(t.text, ")" | "]" | "}" | ","));
        let is_value = is_word || current.kind == TokenKind::Number;
        if !is_callee || !opens || !is_value || current.first_on_line {
            return None;
        }
        let unit = next.filter(|t| !is_word && Unit::named(t.text).is_some());
        let end = unit.unwrap_or(current).end();
        let message = format!("what is given to `{}` stands in brackets", callee.text);
        let all = Span::new(self.source, callee.end(), end);
        let found = self.error("E0023", current, message);
        Some(found.guess(all, format!("({})", &self.text[current.start..end])))
    }

    /// `max(1, 2) m`
    fn unit_behind_call(&self) -> Option<Diagnostic> {
        [self.at, self.at.wrapping_sub(1)].into_iter().find_map(|i| self.unit_at(i))
    }

    fn unit_at(&self, i: usize) -> Option<Diagnostic> {
        let (unit, close) = (self.tokens.get(i)?, i.checked_sub(1)?);
        let open = self.opening(close).filter(|open| self.word(*open) == "(")?;
        let callee = open.checked_sub(1).filter(|callee| self.is_word(*callee))?;
        let is_unit = unit.kind == TokenKind::Word && Unit::named(unit.text).is_some();
        let here = || self.place == Place::Fields;
        let is_brace = self.open.last().map_or_else(here, |open| self.word(*open) == "{");
        if !is_unit || unit.first_on_line || is_brace && self.begins(callee) {
            return None;
        }
        let callee = self.word(callee);
        let message = format!(
            "a unit stands behind a number or the brackets of a vector, not behind `{callee}(…)`"
        );
        let found = self.error("E0203", unit, message);
        let end = self.tokens[close].end();
        let is_vector = self.tokens[open..close].iter().any(|token| token.text == ",");
        if is_vector && callee == "move" {
            let start = self.tokens[open].start;
            let all = Span::new(self.source, start, unit.end());
            return Some(found.fix(all, format!("({} {})", &self.text[start..end], unit.text)));
        }
        Some(found.guess(Span::new(self.source, end, unit.start), " * 1 "))
    }

    /// `1 m m`
    fn unit_twice(&self) -> Option<Diagnostic> {
        let is_unit = |t: &&Token<'_>| !t.first_on_line && Unit::named(t.text).is_some();
        // Reading stops at it, or behind it.
        let at = [self.at, self.at.checked_sub(1)?].into_iter().find(|i| {
            let both = i.checked_sub(1).and_then(|before| self.tokens.get(before..=*i));
            both.is_some_and(|both| both.iter().all(|token| is_unit(&token)))
        })?;
        let (unit, again) = (&self.tokens[at - 1], &self.tokens[at]);
        let value = self.tokens.get(at.checked_sub(2)?)?;
        let is_value = value.kind == TokenKind::Number || matches!(value.text, ")" | "]");
        let next = self.tokens.get(at + 1);
        let ends = next.is_none_or(|t| t.first_on_line || matches!(t.text, "," | "}" | ")" | "]"));
        let found = self.error("E0203", again, "a number has one unit");
        let gap = Span::new(self.source, unit.end(), again.end());
        (is_value && ends).then(|| found.guess(gap, ""))
    }

    /// `radius 5 cm`
    fn missing_equals(&self) -> Option<Diagnostic> {
        if self.open.last().is_some_and(|open| self.word(*open) == "[") {
            return None;
        }
        // The word may stand one or two tokens before the place, as in `material gold }`, or before brackets
        // that end there.
        let bracket = self.at.checked_sub(1).and_then(|close| self.opening(close));
        let before_bracket = bracket.map(|open| (self.at - open + 1, self.at - open));
        for (word_at, value_at) in [(1, 0), (2, 1)].into_iter().chain(before_bracket) {
            let Some(word) = self.before(word_at).filter(|t| t.kind == TokenKind::Word) else {
                continue;
            };
            let Some(value) = self.before(value_at) else { continue };
            let begins = match self.before(word_at + 1) {
                None => true,
                Some(t) => {
                    matches!(t.text, "{" | "," | ";" | "let" | "set" | "param")
                        || word.first_on_line
                }
            };
            if !begins || !value.begins_operand() || value.first_on_line || value.text == "{" {
                continue;
            }
            // `lte x = 5`, `fro i in list`, `palce x`: a misspelt word of the language.
            let after = self.tokens.get(self.at + 1 - value_at).map_or("", |t| t.text);
            let names = value.kind == TokenKind::Word && matches!(after, "=" | "in");
            let is_first = self.open.is_empty() && near(word.text, RESERVED).is_some();
            if names || is_first || RESERVED.contains(&word.text) {
                continue;
            }
            let gap = Span::new(self.source, word.end(), word.end());
            let message = format!("`=` is missing between `{}` and its value", word.text);
            // Elsewhere a statement may be meant, and after a category an object.
            let is_field = self.inner() == Place::Fields
                || matches!(self.before(word_at + 1).map_or("", |t| t.text), "let" | "set");
            let sure = is_field && !is_category(word.text);
            let grade = if sure { Grade::Sure } else { Grade::Guess };
            return Some(self.error("E0012", value, message).mend(gap, " =", grade));
        }
        None
    }

    /// `fn f(a) = a`
    fn untyped(&self) -> Option<Diagnostic> {
        let (current, before) = (self.current()?, self.before(1)?);
        let in_head = self.open.len() == 1 && self.tokens.first().is_some_and(|t| t.text == "fn");
        let ends = matches!(current.text, ")" | "," | "=");
        if !in_head || !ends || before.kind != TokenKind::Word {
            return None;
        }
        let message = format!("the parameter `{}` needs a type", before.text);
        let found = self
            .error("E0024", before, message)
            .help(format!("write `{}: length`, `float`, `int`, `angle`, …", before.text));
        // Reading stopped at the first of them.
        let others = (self.at + 1..self.closing(self.open[0])?).filter(|i| {
            let ends = matches!(self.word(i + 1), ")" | ",");
            self.is_word(*i) && self.word(i - 1) == "," && ends
        });
        Some(others.fold(found, |found, i| found.label(self.span(&self.tokens[i]), "and this")))
    }

    fn unexpected(&self) -> Diagnostic {
        let Some(current) = self.current() else {
            let end = self.tokens.last().map_or(self.end, Token::end);
            let span = match self.tokens.last() {
                Some(last) => self.span(last),
                None => Span::new(self.source, end, end),
            };
            let found = Diagnostic::error("E0023", span, "the statement ends too soon");
            return self.with_pattern(found);
        };
        if let Some(found) = head::second(self) {
            return found;
        }
        let first = self.tokens.iter().position(|t| t.kind != TokenKind::Doc).unwrap_or(self.at);
        let word = self.word(first);
        let is_slip = |near: &Near<'_>| near.name != word && word.len() > 2;
        if let Some(near) = near(word, RESERVED).filter(is_slip) {
            return head::begins_nothing(self, first, near);
        }
        let message = format!("`{}` is not expected here", short(current.text));
        self.with_pattern(self.error("E0023", current, message))
    }

    /// Says how the statement is written that cannot be read.
    fn with_pattern(&self, found: Diagnostic) -> Diagnostic {
        match head::pattern(self) {
            Some(pattern) => found.help(pattern),
            None => found,
        }
    }
}

/// The first characters of a token.
pub(super) fn short(text: &str) -> String {
    let mut out: String = text.chars().take(32).collect();
    if out.len() < text.len() {
        out.push('…');
    }
    out
}
