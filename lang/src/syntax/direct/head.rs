//! Names, and the heads of objects.

use std::ops::Range;

use luxel_core::diag::Span;

use super::Reader;
use super::cursor::{Cursor, begins_word};
use crate::syntax::make;
use crate::syntax::tree::{Name, Object};
use crate::words::RESERVED;

/// Whether a word of the language can be neither kind nor unit.
pub(super) fn is_keyword(word: &str) -> bool {
    word == "where" || RESERVED.contains(&word)
}

/// Whether no object and no value begins with the word.
pub(super) fn is_reserved(word: &str) -> bool {
    !matches!(word, "true" | "false") && RESERVED.contains(&word)
}

/// Where the words of an object's head stand.
pub(super) struct Head {
    category: Range<usize>,
    kind: Option<Range<usize>>,
    label: Option<Range<usize>>,
}

impl Head {
    /// The first byte.
    pub(super) fn start(&self) -> usize {
        self.category.start
    }
}

impl Cursor<'_> {
    /// Takes words joined by dots.
    fn dotted(&mut self) -> bool {
        if self.word().is_none() {
            return false;
        }
        loop {
            let end = self.at;
            if !self.takes(b'.') || self.word().is_none() {
                self.at = end;
                return true;
            }
        }
    }

    /// Takes what `take` does after blanks on the line; nothing if it says no.
    fn apart(&mut self, take: impl FnOnce(&mut Self) -> bool) -> Option<Range<usize>> {
        let before = self.at;
        let is_apart = self.blanks();
        let start = self.at;
        if is_apart && take(self) {
            return Some(start..self.at);
        }
        self.at = before;
        None
    }

    /// Takes the kind and label of an object, both perhaps missing, if its brace follows.
    fn after_category(&mut self, category: Range<usize>) -> Option<Head> {
        let start = self.at;
        let kind = self.apart(|cursor| {
            let is_other = { *cursor }.word().is_some_and(|word| !is_keyword(word));
            is_other && cursor.dotted()
        });
        let label = self.apart(|cursor| cursor.quoted().is_some());
        let end = self.at;
        self.lines();
        let is_head = self.peek() == Some(b'{');
        self.at = if is_head { end } else { start };
        is_head.then_some(Head { category, kind, label })
    }
}

impl Reader<'_> {
    /// The word or words at a place.
    pub(super) fn placed(&mut self, range: Range<usize>) -> Name {
        let span = Span::new(self.source, range.start, range.end);
        Name { text: self.words.get(self.cursor.slice(range)), span }
    }

    /// A word.
    pub(super) fn name(&mut self) -> Option<Name> {
        self.cursor.skip();
        let start = self.cursor.at;
        self.cursor.word()?;
        Some(self.placed(start..self.cursor.at))
    }

    /// A name that is being defined.
    pub(super) fn definition(&mut self) -> Option<Name> {
        self.name().filter(|name| !RESERVED.contains(&&*name.text))
    }

    /// Words joined by dots.
    pub(super) fn path(&mut self) -> Option<Box<[Name]>> {
        let mut words = vec![self.name()?];
        while self.cursor.peek() == Some(b'.') && self.cursor.ahead(1).is_some_and(begins_word) {
            self.cursor.at += 1;
            words.push(self.name()?);
        }
        Some(words.into())
    }

    /// The head of an object, if one stands here.
    pub(super) fn head(&mut self) -> Option<Head> {
        let start = self.cursor.at;
        let is_free = self.cursor.word().is_some_and(|word| word != "where" && !is_reserved(word));
        let category = start..self.cursor.at;
        let head = self.cursor.after_category(category).filter(|_| is_free);
        if head.is_none() {
            self.cursor.at = start;
        }
        head
    }

    /// Whether what follows a word makes it the category of an object, which stands where none may.
    pub(super) fn is_stray_head(&self) -> bool {
        let mut cursor = self.cursor;
        let head = cursor.after_category(0..0);
        head.is_some_and(|head| head.kind.is_some() || head.label.is_some())
    }

    /// The object whose head was read.
    pub(super) fn object(&mut self, head: Head) -> Option<Object> {
        let label = match head.label {
            Some(range) if range.len() > self.budgets.string + 2 => return None,
            Some(range) => {
                let body = self.cursor.slice(range.start + 1..range.end - 1);
                Some(Name { text: make::unescape(body), ..self.placed(range) })
            }
            None => None,
        };
        let kind = head.kind.map(|range| self.placed(range));
        let category = self.placed(head.category);
        Some(Object { category, kind, label, body: self.block()? })
    }
}
