//! Statements, each on a line of its own.

use super::layout::Layout;
use super::piece::{Kind, Piece};
use super::{STEP, WIDTH};

/// What stands on lines of its own in a block; pieces `from..to`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) from: usize,
    pub(super) to: usize,
    /// One past the last piece that is no comment at the end of the line; `from` for a comment alone.
    pub(super) core: usize,
}

impl Layout<'_> {
    /// Puts statements and comments on lines of their own.
    pub(super) fn block(&mut self, from: usize, to: usize, indent: usize) {
        let entries = self.entries(from, to);
        self.align(&entries, indent);
        for (i, entry) in entries.iter().enumerate() {
            if i > 0 && self.pieces[entry.from].newlines > 1 {
                self.out.blank_line();
            }
            self.out.newline(indent);
            self.statement(entry, indent);
        }
    }

    fn statement(&mut self, entry: &Entry, indent: usize) {
        let pad: usize = (entry.from..entry.core.min(entry.from + 16))
            .map(|at| usize::from(self.pieces[at].pad))
            .sum();
        // A comment alone ends no statement.
        let comma = usize::from(entry.core > entry.from && self.keeps_comma(entry.core));
        if self.fits_here(entry.from, entry.core, pad + comma) {
            self.flat(entry.from, entry.core, indent);
        } else {
            self.divide(entry.from, entry.core, indent + STEP, comma);
        }
        if comma > 0 {
            self.out.put(",", 1);
        }
        for at in entry.core..entry.to {
            if self.pieces[at].kind != Kind::Separator {
                self.atom(at, indent, 0);
            }
        }
    }

    /// Whether the comma at the end of a statement stays: without it `where` would continue an `expect`.
    fn keeps_comma(&self, core: usize) -> bool {
        let is_between = |piece: &&Piece<'_>| piece.is_comment() || piece.kind == Kind::Separator;
        let is_comma = |piece: &Piece<'_>| piece.kind == Kind::Separator && !piece.text.is_empty();
        let between = self.pieces[core..].iter().take_while(is_between).count();
        let (between, next) = self.pieces[core..].split_at(between);
        next.first().is_some_and(|next| next.text == "where") && between.iter().any(is_comma)
    }

    fn entries(&self, from: usize, to: usize) -> Vec<Entry> {
        let (mut entries, mut at) = (vec![], from);
        while at < to {
            let piece = &self.pieces[at];
            let leads = piece.kind == Kind::Block && self.is_joined(at + 1, to);
            if piece.kind == Kind::Separator {
                at += 1;
            } else if piece.is_comment() && !leads {
                entries.push(Entry { from: at, core: at, to: at + 1 });
                at += 1;
            } else {
                let entry = self.entry(at, to);
                entries.push(entry);
                at = entry.to;
            }
        }
        entries
    }

    /// Whether the piece is of a statement and on the line of the one before.
    fn is_joined(&self, at: usize, to: usize) -> bool {
        at < to && self.pieces[at].newlines == 0 && self.pieces[at].kind != Kind::Separator
    }

    /// The statement whose line begins with piece `from`.
    fn entry(&self, from: usize, to: usize) -> Entry {
        let mut at = from;
        while at < to && self.pieces[at].is_comment() {
            at += 1;
        }
        let (mut core, mut started) = (at, false);
        while at < to && !(started && self.pieces[at].starts) {
            started |= !self.pieces[at].is_comment();
            let next = self.next(at);
            if !self.pieces[at].is_comment() && self.pieces[at].kind != Kind::Separator {
                core = next;
            }
            at = next;
        }
        let (end, mut separated) = (at, false);
        at = core;
        while at < end {
            let piece = &self.pieces[at];
            let leads = piece.kind == Kind::Block && separated && self.is_joined(at + 1, to);
            if piece.newlines > 0 || piece.kind == Kind::Doc || leads {
                break;
            }
            separated |= piece.kind == Kind::Separator && !piece.text.is_empty();
            at += 1;
        }
        Entry { from, core, to: at }
    }

    /// Whether the statement is to be on one line.
    pub(super) fn is_flat(&self, entry: &Entry, indent: usize) -> bool {
        self.fits(entry.from, entry.core, indent, 0) && indent <= WIDTH
    }
}
