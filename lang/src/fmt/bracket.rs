//! Brackets that do not fit on a line, or are not to.

use super::STEP;
use super::layout::Layout;
use super::piece::{Kind, Piece};

/// An item between commas: pieces `from..comma`, and comments behind the comma up to `to`.
#[derive(Clone, Copy, Debug)]
struct Item {
    from: usize,
    comma: usize,
    to: usize,
}

impl Layout<'_> {
    /// Puts the bracket at `open` and all in it, of nothing no lines; `after` columns stand behind it.
    pub(super) fn bracket(&mut self, open: usize, after: usize) {
        if self.mate(open) == open + 1 {
            return self.flat(open, open + 2, self.out.indent);
        }
        match self.pieces[open].text {
            "{" => self.braces(open),
            _ => self.list(open, after),
        }
    }

    fn braces(&mut self, open: usize) {
        let (close, base) = (self.mate(open), self.out.indent);
        let inner = base + STEP;
        self.atom(open, base, 0);
        let mut at = open + 1;
        while self.is_remark(at) {
            self.atom(at, inner, 0);
            at += 1;
        }
        let first = (at..close).find(|at| !self.pieces[*at].is_comment());
        if first.is_none_or(|first| self.pieces[first].starts) {
            self.block(at, close, inner);
        } else {
            self.out.newline(inner);
            self.sequence(at, close, inner + STEP, 0);
        }
        self.out.newline(base);
        self.atom(close, base, 0);
    }

    /// Whether the piece is a comment with which its line ends.
    fn is_remark(&self, at: usize) -> bool {
        let piece = &self.pieces[at];
        let last = self.pieces.get(at + 1).is_none_or(|next| next.newlines > 0);
        piece.newlines == 0 && (piece.kind == Kind::Line || piece.kind == Kind::Block && last)
    }

    fn list(&mut self, open: usize, after: usize) {
        let (close, base) = (self.mate(open), self.out.indent);
        self.atom(open, base, 0);
        let mut first = open + 1;
        while self.is_remark(first) {
            self.atom(first, base, 0);
            first += 1;
        }
        let items = self.list_items(first, close);
        if !self.pieces[open].broken {
            let single = matches!(&items[..], [item] if self.ends_in_bracket(item));
            let begins = items.first().is_none_or(|item| self.begins_here(item));
            if begins && (self.is_hard(open + 1, close) || single) {
                return self.inline(&items, close, after);
            }
        } else if self.pieces[first].newlines == 0 && first < close {
            let hang = self.out.column + usize::from(self.pieces[first].gap);
            // The comma of a vector of one stands before the bracket.
            let comma = items.last().is_some_and(|it| self.pieces[it.comma].kind == Kind::Comma);
            let tail = after + 1 + usize::from(comma);
            if items.iter().all(|item| self.fits(item.from, item.comma, hang, tail)) {
                self.rows(&items, hang, after + 1, false);
                if self.out.ends {
                    self.out.newline(hang);
                }
                return self.atom(close, hang, 0);
            }
        }
        let inner = base + STEP;
        self.out.newline(inner);
        if !self.pieces[open].broken && self.fits(open + 1, close, inner, 0) {
            self.flat(open + 1, close, inner);
        } else {
            let each = !self.pieces[open].broken && !self.is_narrow(&items);
            self.rows(&items, inner, 0, each);
        }
        self.out.newline(base);
        self.atom(close, base, 0);
    }

    fn list_items(&self, first: usize, close: usize) -> Vec<Item> {
        let (mut items, mut from, mut at) = (vec![], first, first);
        while at < close {
            if self.pieces[at].kind == Kind::Comma {
                let mut to = at + 1;
                while to < close && self.is_remark(to) {
                    to += 1;
                }
                items.push(Item { from, comma: at, to });
                (from, at) = (to, to);
            } else {
                at = self.next(at);
            }
        }
        if from < close {
            items.push(Item { from, comma: close, to: close });
        }
        items
    }

    /// Whether an item is a bracket with nothing but a name before it.
    fn ends_in_bracket(&self, item: &Item) -> bool {
        let mut at = item.from;
        while at < item.comma {
            let piece = &self.pieces[at];
            match piece.kind {
                Kind::Open => return self.mate(at) + 1 == item.comma,
                Kind::Word | Kind::Dot | Kind::Text => at += 1,
                _ => return false,
            }
        }
        false
    }

    /// Whether an item has room here up to where its first line may end.
    fn begins_here(&self, item: &Item) -> bool {
        let opening = self.opening(item.from, item.comma, 0);
        self.column(item.from) + opening <= super::WIDTH
    }

    /// Whether several items have room on a line.
    fn is_narrow(&self, items: &[Item]) -> bool {
        let narrow = super::WIDTH / 3;
        items.len() > 1 && items.iter().all(|it| self.width(it.from, it.comma) <= narrow)
    }

    /// Puts items and the closing bracket without breaking the line between them.
    fn inline(&mut self, items: &[Item], close: usize, after: usize) {
        let cont = self.inner();
        for item in items {
            let last = item.comma == close;
            self.sequence(item.from, item.comma, cont, if last { after + 1 } else { 1 });
            let end = if last { item.comma } else { item.to };
            (item.comma..end).for_each(|at| self.atom(at, cont, 0));
        }
        self.atom(close, cont, 0);
    }

    /// Puts items in the rows that their author gave them, or each on its own line; rows that are too
    /// long are divided.
    /// `after` columns stand behind the last.
    fn rows(&mut self, items: &[Item], indent: usize, after: usize, each: bool) {
        let mut several = false;
        let refilled = self.is_narrow(items) && self.has_long_row(items, indent);
        for (i, item) in items.iter().enumerate() {
            let last = i + 1 == items.len();
            let comma = self.pieces[item.comma].kind == Kind::Comma;
            let tail = if last { after } else { 0 } + usize::from(comma);
            let mut core = item.comma;
            while !comma && core > item.from && self.pieces[core - 1].is_comment() {
                core -= 1;
            }
            let wished = if refilled { 0 } else { self.pieces[item.from].newlines };
            if i > 0 && !self.out.fresh {
                let fits = self.fits_here(item.from, self.beside(core, item.comma), tail);
                if wished > 1 {
                    self.out.blank_line();
                }
                if wished > 0 || each || several || !fits {
                    self.out.newline(indent);
                }
            }
            self.leading(item.from, core, indent);
            let line = self.out.line();
            self.sequence(self.first(item.from, core), core, indent + STEP, tail);
            several = self.out.line() != line;
            if comma {
                (item.comma..item.to).for_each(|at| self.atom(at, indent, 0));
            } else {
                self.trailing(core, item.to, indent);
            }
        }
    }

    /// Where the comments end that stand beside what ends at `core`.
    fn beside(&self, core: usize, to: usize) -> usize {
        let is_beside = |piece: &Piece<'_>| piece.kind == Kind::Block && piece.newlines == 0;
        core + self.pieces[core..to].iter().take_while(|piece| is_beside(piece)).count()
    }

    /// Whether a row that their author made of these items, all of them short, is too long.
    fn has_long_row(&self, items: &[Item], indent: usize) -> bool {
        if items.iter().any(|item| self.is_hard(item.from, item.to)) {
            return false;
        }
        let same_row = |_: &Item, b: &Item| self.pieces[b.from].newlines == 0;
        let mut rows = items.chunk_by(same_row);
        rows.any(|row| {
            indent + self.width(row[0].from, row[row.len() - 1].comma) + 1 > super::WIDTH
        })
    }

    /// The first piece that does not stand on a line of its own.
    fn first(&self, from: usize, to: usize) -> usize {
        let own = |at: &usize| {
            let piece = &self.pieces[*at];
            piece.is_comment() && self.pieces.get(at + 1).is_some_and(|next| next.newlines > 0)
        };
        (from..to).find(|at| !own(at)).unwrap_or(to)
    }

    /// Puts comments on lines of their own.
    fn leading(&mut self, from: usize, to: usize, indent: usize) {
        for at in from..self.first(from, to) {
            self.atom(at, indent, 0);
            self.out.newline(indent);
        }
    }

    /// Puts the comments after the last item.
    fn trailing(&mut self, from: usize, to: usize, indent: usize) {
        for at in from..to {
            if self.pieces[at].newlines > 0 && !self.out.fresh {
                self.out.newline(indent);
            }
            self.atom(at, indent, 0);
        }
    }
}
