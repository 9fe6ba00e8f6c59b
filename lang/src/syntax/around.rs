//! The tokens around the place of a mistake, and what encloses it.

use luxel_core::diag::{Diagnostic, SourceId, Span};
use luxel_sdk::kind::Kind;

use super::lex::{Token, TokenKind};

/// Bytes of a text that are written once more for a mend, at most.
pub(super) const SHORT: usize = 200;

/// What statements stand in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    File,
    /// A block of statements.
    Block,
    /// The parameters of an object, the fields of a record or arguments.
    Fields,
}

/// What stands around the place of a mistake.
pub(super) struct Around<'a> {
    pub(super) text: &'a str,
    pub(super) tokens: Vec<Token<'a>>,
    /// The token at which reading stopped; the number of tokens at the end.
    pub(super) at: usize,
    /// Brackets that are open there, by token, outermost first.
    pub(super) open: Vec<usize>,
    pub(super) source: SourceId,
    pub(super) end: usize,
    /// What the statement stands in.
    pub(super) place: Place,
}

impl<'a> Around<'a> {
    pub(super) fn current(&self) -> Option<&Token<'a>> {
        self.tokens.get(self.at)
    }

    /// The token `back` places before the current one.
    pub(super) fn before(&self, back: usize) -> Option<&Token<'a>> {
        self.at.checked_sub(back).and_then(|i| self.tokens.get(i))
    }

    /// The text of a token; empty if there is none.
    pub(super) fn word(&self, i: usize) -> &'a str {
        self.tokens.get(i).map_or("", |t| t.text)
    }

    pub(super) fn is_word(&self, i: usize) -> bool {
        self.tokens.get(i).is_some_and(|t| t.kind == TokenKind::Word)
    }

    pub(super) fn span(&self, token: &Token<'_>) -> Span {
        Span::new(self.source, token.start, token.end())
    }

    pub(super) fn error(
        &self,
        code: &'static str,
        token: &Token<'_>,
        message: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::error(code, self.span(token), message)
    }

    /// The bracket that closes token `open`.
    pub(super) fn closing(&self, open: usize) -> Option<usize> {
        let mut depth = 0_usize;
        (open..self.tokens.len()).find(|i| {
            match self.word(*i) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth == 0
        })
    }

    /// The bracket that token `close` closes.
    pub(super) fn opening(&self, close: usize) -> Option<usize> {
        let mut depth = 0_usize;
        let open = (0..=close).rev().find(|i| {
            match self.word(*i) {
                ")" | "]" | "}" => depth += 1,
                "(" | "[" | "{" => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth == 0
        });
        open.filter(|open| *open < close)
    }

    /// Whether a statement or a field may begin with token `i`.
    pub(super) fn begins(&self, i: usize) -> bool {
        let Some(before) = i.checked_sub(1) else { return true };
        matches!(self.word(before), "{" | "}" | "," | ";")
            || self.tokens.get(i).is_some_and(|t| t.first_on_line)
    }

    /// The first token of the statement or field of the place, outside round and square brackets.
    pub(super) fn statement(&self) -> usize {
        let brackets = self.open.iter().rev().take_while(|open| self.word(**open) != "{");
        let mut first = brackets.last().copied().unwrap_or(self.at);
        while first > 0 && !self.begins(first) {
            first = self.opening(first - 1).unwrap_or(first - 1);
        }
        first
    }

    /// What stands in a bracket, without what stands in others in it.
    pub(super) fn held(&self, open: usize) -> impl Iterator<Item = &Token<'a>> {
        let close = self.closing(open).unwrap_or(self.tokens.len());
        let mut depth = 0_usize;
        self.tokens[open + 1..close].iter().filter(move |token| {
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => return depth == 0,
            }
            false
        })
    }

    /// Whether token `i` is the first of its argument.
    pub(super) fn begins_argument(&self, i: usize) -> bool {
        i > 0 && matches!(self.word(i - 1), "(" | ",")
    }

    /// What the place of the mistake is in.
    pub(super) fn inner(&self) -> Place {
        self.open.last().map_or(self.place, |open| self.within(*open))
    }

    /// What stands in the bracket that token `open` is.
    pub(super) fn within(&self, open: usize) -> Place {
        let is_fields = self.word(open) != "{" || self.holds_fields(open);
        if is_fields { Place::Fields } else { Place::Block }
    }

    /// Whether the place is in a group, in which objects stand beside fields.
    pub(super) fn is_in_group(&self) -> bool {
        self.open.last().is_some_and(|open| {
            let mut words = (0..*open).rev().filter(|i| self.tokens[*i].kind != TokenKind::Text);
            words.next().is_some_and(|i| self.word(i) == "group")
        })
    }

    /// Whether the brace that token `open` is belongs to an object or a record.
    fn holds_fields(&self, open: usize) -> bool {
        let Some(mut last) = open.checked_sub(1) else { return false };
        if self.tokens[last].kind == TokenKind::Text && last > 0 {
            last -= 1;
        }
        // The name of a class may have parts.
        while last > 1 && self.word(last - 1) == "." {
            last -= 2;
        }
        let is_object = is_category(self.word(last))
            || last > 0 && self.is_word(last) && is_category(self.word(last - 1));
        is_object || matches!(self.word(last), "=" | "with" | "where" | "units")
    }
}

/// Whether a word stands in a text right behind another, or behind a sign, blanks aside.
pub(super) fn stands_behind(word: &str, before: &str, text: &[u8]) -> bool {
    let is_of_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    memchr::memmem::find_iter(text, word).any(|at| {
        let ends = text.get(at + word.len()).is_none_or(|byte| !is_of_word(byte));
        let begins = !text[..at].last().is_some_and(is_of_word);
        begins && ends && text[..at].trim_ascii_end().ends_with(before.as_bytes())
    })
}

/// Whether an object may begin with the word.
pub(super) fn is_category(word: &str) -> bool {
    Kind::of_word(word).is_some()
}

/// Whether objects of a category are of use only where they are given: by themselves they stand nowhere.
pub(super) fn stands_nowhere(category: &str) -> bool {
    use Kind::{Material, Medium, Phase, Texture};
    matches!(Kind::of_word(category), Some(Material | Medium | Phase | Texture))
}

/// Something that is not expected there.
pub(super) fn told(span: Span, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error("E0023", span, message)
}
