//! Expressions and the heads of statements: where a line may end, and where it does.

use super::layout::Layout;
use super::piece::Kind;
use super::{STEP, WIDTH};

/// Where a sequence may be divided into lines: what holds it together least first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Joint {
    /// Before `where`.
    Where,
    /// After the comma of `assert`.
    Comma,
    /// After `=`.
    Assign,
    /// After `=>`.
    Arrow,
    /// Before `if` and what the items of a list are chosen by.
    If,
    /// Before `in` and a range or list.
    In,
    /// After `±`.
    PlusMinus,
    /// Before `else`.
    Else,
    /// After an operator of this strength.
    Operator(u8),
    /// Before `with`.
    With,
}

impl Joint {
    /// Whether the line ends before it, not after.
    fn is_before(self) -> bool {
        matches!(self, Self::Where | Self::If | Self::In | Self::With | Self::Else)
    }
}

impl Layout<'_> {
    /// Puts pieces, what continues on further lines indented by `cont`. `after` columns of something
    /// else stand behind them.
    pub(super) fn sequence(&mut self, from: usize, to: usize, cont: usize, after: usize) {
        if self.out.ends {
            self.out.newline(cont);
        }
        if self.fits_here(from, to, after) {
            self.flat(from, to, cont);
        } else {
            self.divide(from, to, cont, after);
        }
    }

    /// Puts pieces that are not all on one line.
    pub(super) fn divide(&mut self, from: usize, to: usize, cont: usize, after: usize) {
        match (self.weakest(from, to), self.block_of(from, to)) {
            (Some(joint), _) => self.divided(joint, from, to, cont, after),
            (None, Some(brace)) => {
                let rest = self.head(from, brace);
                self.items(rest, to, cont, after);
            }
            (None, None) => self.items(from, to, cont, after),
        }
    }

    /// The joint at which the pieces are divided first.
    fn weakest(&self, from: usize, to: usize) -> Option<Joint> {
        // What joins the head of a block divides it alone.
        let controls = self.block_of(from, to).is_some();
        let (mut weakest, mut seen, mut at) = (None, false, from);
        while at < to {
            let next = self.next(at);
            // A part ends in the joint that divides it from the next.
            let joint = self.joint(at, seen).filter(|joint| {
                (joint.is_before() || next < to)
                    && (!controls || matches!(joint, Joint::Arrow | Joint::Else))
            });
            weakest = match (weakest, joint) {
                (Some(a), Some(b)) => Some(std::cmp::min::<Joint>(a, b)),
                (a, b) => a.or(b),
            };
            seen = true;
            at = next;
        }
        weakest
    }

    /// The brace after the head of a loop or of an arm of a condition.
    fn block_of(&self, from: usize, to: usize) -> Option<usize> {
        let mut at = from;
        while at < to && (self.pieces[at].is_comment() || self.pieces[at].kind == Kind::At) {
            at += if self.pieces[at].is_comment() { 1 } else { 2 };
        }
        let first = self.pieces[..to].get(at);
        let controls = |word: &&str| first.is_some_and(|first| first.is_keyword(word));
        // The head of a list has none.
        if !["if", "for", "else"].iter().any(controls) || self.pieces[to - 1].kind == Kind::Arrow {
            return None;
        }
        while at < to {
            let amends = || self.before(at).is_some_and(|it| self.pieces[it].is_keyword("with"));
            if self.pieces[at].is_open("{") && !amends() {
                return Some(at);
            }
            at = self.next(at);
        }
        None
    }

    /// Puts the head of a block, and the block too if the last line of the head is indented: then each
    /// brace has a line of its own. Gives where the rest begins.
    fn head(&mut self, from: usize, brace: usize) -> usize {
        let base = self.out.indent;
        let empty = self.mate(brace) == brace + 1;
        let after = if empty { " {}" } else { " {" };
        self.sequence(from, brace, self.inner(), after.len());
        if !self.out.ends && self.out.indent == base {
            return brace;
        }
        self.out.newline(base);
        self.bracket(brace, 0);
        self.next(brace)
    }

    /// The last piece before this one that is no comment.
    fn before(&self, at: usize) -> Option<usize> {
        (0..at).rev().find(|at| !self.pieces[*at].is_comment())
    }

    /// What joint a piece is; the first of a sequence is none that stands before something.
    fn joint(&self, at: usize, seen: bool) -> Option<Joint> {
        let piece = &self.pieces[at];
        match piece.kind {
            Kind::Comma => Some(Joint::Comma),
            Kind::Assign => Some(Joint::Assign),
            Kind::Arrow => Some(Joint::Arrow),
            Kind::PlusMinus => Some(Joint::PlusMinus),
            Kind::Binary(strength) | Kind::Range(strength) => Some(Joint::Operator(strength)),
            Kind::Keyword if seen && piece.text == "where" => {
                let record = self.pieces.get(at + 1).is_some_and(|next| next.is_open("{"));
                (record || piece.newlines > 0).then_some(Joint::Where)
            }
            Kind::Keyword if seen && piece.newlines > 0 && piece.text == "with" => {
                Some(Joint::With)
            }
            Kind::Keyword if seen && piece.text == "in" => Some(Joint::In),
            Kind::Keyword if seen && piece.text == "else" => Some(Joint::Else),
            Kind::Keyword if seen && piece.text == "if" => {
                self.before(at).filter(|it| self.pieces[*it].ends_operand()).map(|_| Joint::If)
            }
            _ => None,
        }
    }

    /// Puts pieces that are divided at every joint of one sort.
    fn divided(&mut self, joint: Joint, from: usize, to: usize, cont: usize, after: usize) {
        let free = !self.is_hard(from, to);
        // Where an `else` stands below its `if` behind a remark.
        let base = (joint == Joint::Else && self.out.fresh).then_some(self.out.indent);
        let (mut start, mut one_line) = (from, true);
        while start < to {
            let end = self.part(joint, start, to, start == from);
            let tail = if end == to { after } else { 0 };
            if let Some(base) = base.filter(|_| start > from && self.out.ends) {
                self.out.newline(base);
            }
            // `else` follows the brace that has a line of its own.
            let may = start > from && (joint != Joint::Else || one_line);
            let mut cont = cont;
            if may && self.divides(joint, start, end, (cont, tail), free) {
                self.out.newline(cont);
                cont += if matches!(joint, Joint::If | Joint::In) { STEP } else { 0 };
            }
            let line = self.out.line();
            self.sequence(start, end, cont, tail);
            one_line = self.out.line() == line;
            start = end;
        }
    }

    /// Where the part that begins at `start` ends.
    fn part(&self, joint: Joint, start: usize, to: usize, first: bool) -> usize {
        let mut at = start;
        while at < to {
            let here = self.joint(at, at > start) == Some(joint);
            if here && joint.is_before() {
                break;
            }
            at = self.next(at);
            // What is behind the first `=` is its value.
            if here && !joint.is_before() && (first || joint != Joint::Assign) {
                break;
            }
        }
        at
    }

    /// Whether a part begins a line.
    fn divides(
        &self,
        joint: Joint,
        from: usize,
        to: usize,
        (cont, tail): (usize, usize),
        free: bool,
    ) -> bool {
        if self.out.ends {
            return false;
        }
        if self.pieces[from].newlines > 0 {
            return true;
        }
        if self.fits_here(from, to, tail) && joint != Joint::Else {
            return false;
        }
        match joint {
            Joint::With => false,
            Joint::If => true,
            Joint::Else if free && !self.is_block_before(from) => true,
            Joint::Assign if self.pieces[from].is_keyword("if") => !self.is_hard(from, to),
            Joint::Assign if self.fits(from, to, cont, tail) && self.is_below(from, to) => true,
            Joint::Assign | Joint::Else => self.is_roomier(from, to, cont, tail),
            _ => self.fits(from, to, cont, tail) || self.is_roomier(from, to, cont, tail),
        }
    }

    /// Whether a value stands rather below its name than with its brackets broken: one of several
    /// operands, or without brackets.
    fn is_below(&self, from: usize, to: usize) -> bool {
        let joint = self.weakest(from, to);
        matches!(joint, Some(Joint::In | Joint::PlusMinus | Joint::Operator(_)))
            || !self.has_brackets(from, to)
    }

    /// Whether what pieces begin with has room on a line of its own, but none here.
    fn is_roomier(&self, from: usize, to: usize, cont: usize, after: usize) -> bool {
        let joint = self.weakest(from, to);
        let end = joint.map_or(to, |joint| self.part(joint, from, to, true));
        let after = if end == to { after } else { 0 };
        let opening = self.opening(from, end, after);
        let whole = joint.is_some() && !self.is_hard(from, end);
        let gains = |width| self.column(from) + width > WIDTH && cont + width <= WIDTH;
        gains(opening) || whole && gains(self.width(from, end) + after)
    }

    /// Columns up to the first place where the line may end.
    pub(super) fn opening(&self, from: usize, to: usize, after: usize) -> usize {
        for at in from..to {
            let piece = &self.pieces[at];
            let joint = self.joint(at, at > from);
            let before = joint.is_some_and(Joint::is_before) || self.may_begin(at);
            return match piece.kind {
                Kind::Table => (piece.at - self.pieces[from].at) as usize + "#[".len(),
                _ if before || piece.is_long() => self.width(from, at),
                Kind::Open => self.width(from, at + 1),
                _ if joint.is_some() => self.width(from, at + 1),
                _ => continue,
            };
        }
        self.width(from, to) + after
    }

    fn is_block_before(&self, at: usize) -> bool {
        self.before(at).is_some_and(|close| {
            let open = self.mate(close);
            (open..close)
                .skip(1)
                .find(|at| !self.pieces[*at].is_comment())
                .is_some_and(|first| self.pieces[first].starts)
        })
    }

    fn has_brackets(&self, from: usize, to: usize) -> bool {
        self.pieces[from..to].iter().any(|piece| piece.kind == Kind::Open)
    }

    /// Puts pieces without a joint: brackets that do not fit are broken.
    fn items(&mut self, from: usize, to: usize, cont: usize, after: usize) {
        let mut at = from;
        while at < to {
            let next = self.next(at);
            let tail = self.tail(next, to, after);
            let open = self.pieces[at].kind == Kind::Open;
            let kept = self.pieces[at].kept && at > from && !self.out.fresh;
            if self.out.ends || kept || at > from && self.is_late(at, tail) {
                self.out.newline(cont);
            }
            if open && !self.fits_here(at, next, tail) {
                self.bracket(at, tail);
            } else if open {
                self.flat(at, next, cont);
            } else {
                self.atom(at, cont, tail);
            }
            at = next;
        }
    }

    /// Whether a word that may begin a line has no room on this one.
    fn is_late(&self, at: usize, after: usize) -> bool {
        self.may_begin(at) && !self.fits_here(at, at + 1, after)
    }

    fn may_begin(&self, at: usize) -> bool {
        ["with", "as"].iter().any(|word| self.pieces[at].is_keyword(word))
    }

    /// Columns up to where the line may end next, or more than a line has.
    fn tail(&self, from: usize, to: usize, after: usize) -> usize {
        let mut at = from;
        // What is beyond a line is not looked at: each piece looks ahead anew.
        while at < to && self.width(from, at) <= WIDTH {
            let piece = &self.pieces[at];
            if piece.kind == Kind::Open {
                return usize::from(self.pieces[from].gap) + self.width(from, at + 1);
            }
            if self.may_begin(at) || self.is_hard(from, at + 1) {
                break;
            }
            at += 1;
        }
        let gap = if at > from { usize::from(self.pieces[from].gap) } else { 0 };
        gap + self.width(from, at) + if at == to { after } else { 0 }
    }

    /// The indentation of what is in a bracket that is opened on this line.
    pub(super) fn inner(&self) -> usize {
        self.out.indent + STEP
    }
}
