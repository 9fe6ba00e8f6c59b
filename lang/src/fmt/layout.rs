//! Pieces onto lines: what all rules share.

use super::out::Out;
use super::piece::{Kind, Piece};
use super::{WIDTH, table};

/// Pieces, and the text that becomes of them.
pub(super) struct Layout<'a> {
    pub(super) pieces: Vec<Piece<'a>>,
    pub(super) out: Out,
}

impl<'a> Layout<'a> {
    /// Of a file of about so many bytes.
    pub(super) fn new(pieces: Vec<Piece<'a>>, bytes: usize) -> Self {
        Self { pieces, out: Out::new(bytes) }
    }

    /// The whole text.
    pub(super) fn file(mut self) -> String {
        self.block(0, self.pieces.len(), 0);
        self.out.finish()
    }

    /// The counterpart of a bracket.
    pub(super) fn mate(&self, at: usize) -> usize {
        self.pieces[at].mate as usize
    }

    /// The piece after this one, or after the bracket that it opens.
    pub(super) fn next(&self, at: usize) -> usize {
        if self.pieces[at].kind == Kind::Open { self.mate(at) + 1 } else { at + 1 }
    }

    /// Columns of pieces on one line, without the blanks before the first.
    pub(super) fn width(&self, from: usize, to: usize) -> usize {
        if from >= to {
            return 0;
        }
        let last = &self.pieces[to - 1];
        (last.at + last.width - self.pieces[from].at) as usize
    }

    /// Whether something in the pieces keeps them from being on one line.
    pub(super) fn is_hard(&self, from: usize, to: usize) -> bool {
        let Some(last) = to.checked_sub(1).filter(|last| *last >= from) else { return false };
        let own = &self.pieces[last];
        own.hard > self.pieces[from].hard || self.breaks_after(last)
    }

    /// Whether the piece itself cannot be on one line.
    fn breaks_after(&self, at: usize) -> bool {
        let piece = &self.pieces[at];
        piece.is_long() || piece.broken
    }

    /// Whether pieces fit on one line from this column on, with `after` columns behind them.
    pub(super) fn fits(&self, from: usize, to: usize, column: usize, after: usize) -> bool {
        !self.is_hard(from, to) && column + self.width(from, to) + after <= WIDTH
    }

    /// Whether pieces fit onto the rest of the line.
    pub(super) fn fits_here(&self, from: usize, to: usize, after: usize) -> bool {
        if self.out.ends || from >= to {
            return from >= to;
        }
        self.fits(from, to, self.column(from), after)
    }

    /// The column at which a piece would begin on this line.
    pub(super) fn column(&self, at: usize) -> usize {
        if self.out.fresh {
            self.out.indent
        } else {
            self.out.column + usize::from(self.pieces[at].gap)
        }
    }

    /// Puts pieces on one line.
    pub(super) fn flat(&mut self, from: usize, to: usize, cont: usize) {
        (from..to).for_each(|at| self.atom(at, cont, 0));
    }

    /// Puts one piece on the line, or on a new one where the line has ended. `after` columns of
    /// something else stand behind it.
    pub(super) fn atom(&mut self, at: usize, cont: usize, after: usize) {
        if self.out.ends {
            self.out.newline(cont);
        }
        let (kind, text) = (self.pieces[at].kind, self.pieces[at].text);
        let (gap, pad, width) =
            (self.pieces[at].gap, self.pieces[at].pad, self.pieces[at].width as usize);
        match kind {
            Kind::Line | Kind::Doc => {
                if self.pieces[at].newlines > 0 && !self.out.fresh {
                    self.out.newline(cont);
                }
                self.out.remark(text);
            }
            _ => {
                self.out.blanks(usize::from(gap) + usize::from(pad));
                match kind {
                    Kind::Block => self.out.comment(text),
                    Kind::Separator => self.out.put(",", 1),
                    Kind::Table => table::put(text, &mut self.out, after),
                    _ => self.out.put(text, width),
                }
            }
        }
    }
}
