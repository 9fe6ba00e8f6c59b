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
    /// Before `in` and the range of a parameter.
    In,
    /// After `=>`.
    Arrow,
    /// Before `with`.
    With,
    /// After `±`.
    PlusMinus,
    /// Before `else`.
    Else,
    /// After an operator of this strength.
    Operator(u8),
}

impl Joint {
    /// Whether the line ends before it, not after.
    fn is_before(self) -> bool {
        matches!(self, Self::Where | Self::In | Self::With | Self::Else)
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
        match self.weakest(from, to) {
            Some(joint) => self.divided(joint, from, to, cont, after),
            None => self.items(from, to, cont, after),
        }
    }

    /// The joint at which the pieces are divided first.
    fn weakest(&self, from: usize, to: usize) -> Option<Joint> {
        // The operators of a condition or a loop's head are not for dividing it, but where it stands in
        // brackets and alone.
        let head = |at: usize| {
            let piece = &self.pieces[at];
            piece.kind == Kind::Keyword && matches!(piece.text, "if" | "for" | "else")
        };
        let mut at = from;
        while at + 2 < to && self.pieces[at].kind == Kind::At {
            at += 2;
        }
        let is_alone = from < to && self.pieces[to - 1].kind == Kind::Arrow;
        let controls = at < to && head(at) && !is_alone;
        let (mut weakest, mut seen, mut at) = (None, false, from);
        while at < to {
            let next = self.next(at);
            // A part ends in the joint that divides it from the next.
            let joint = self.joint(at, seen).filter(|joint| {
                (joint.is_before() || next < to)
                    && (!controls || matches!(joint, Joint::Arrow | Joint::Else))
                    && (!is_alone || matches!(joint, Joint::In | Joint::Operator(_)))
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

    /// What joint a piece is; the first of a sequence is none that stands before something.
    fn joint(&self, at: usize, seen: bool) -> Option<Joint> {
        let piece = &self.pieces[at];
        match piece.kind {
            Kind::Comma => Some(Joint::Comma),
            Kind::Assign => Some(Joint::Assign),
            Kind::Arrow => Some(Joint::Arrow),
            Kind::PlusMinus => Some(Joint::PlusMinus),
            Kind::Binary(strength) => Some(Joint::Operator(strength)),
            Kind::Keyword if seen && piece.text == "where" => {
                let record = self.pieces.get(at + 1).is_some_and(|next| next.is_open("{"));
                (record || piece.newlines > 0).then_some(Joint::Where)
            }
            Kind::Keyword if seen && piece.newlines > 0 && piece.text == "with" => {
                Some(Joint::With)
            }
            Kind::Keyword if seen && piece.text == "in" => Some(Joint::In),
            Kind::Keyword if seen && piece.text == "else" => Some(Joint::Else),
            _ => None,
        }
    }

    /// Puts pieces that are divided at every joint of one sort.
    fn divided(&mut self, joint: Joint, from: usize, to: usize, cont: usize, after: usize) {
        let free = !self.is_hard(from, to);
        let (mut start, mut one_line) = (from, true);
        while start < to {
            let end = self.part(joint, start, to, start == from);
            let tail = if end == to { after } else { 0 };
            // `else` follows the brace that has a line of its own.
            let may = start > from && (joint != Joint::Else || one_line);
            if may && self.divides(joint, start, end, (cont, tail), free) {
                self.out.newline(cont);
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
            Joint::In => true,
            Joint::Else => free && !self.is_block_before(from),
            Joint::Assign if self.pieces[from].is_keyword("if") => !self.is_hard(from, to),
            // Rather within brackets than before them, but for those of an operand.
            Joint::Assign => {
                let parts = matches!(self.weakest(from, to), Some(Joint::In | Joint::Operator(_)));
                (parts || !self.has_brackets(from, to)) && self.fits(from, to, cont, tail)
            }
            _ => self.fits(from, to, cont, tail),
        }
    }

    fn is_block_before(&self, at: usize) -> bool {
        let close = (0..at).rev().find(|at| !self.pieces[*at].is_comment());
        close.is_some_and(|close| {
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
            if self.out.ends || kept {
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

    /// Columns up to where the line may end next, or more than a line has.
    fn tail(&self, from: usize, to: usize, after: usize) -> usize {
        let mut at = from;
        // What is beyond a line is not looked at: each piece looks ahead anew.
        while at < to && self.width(from, at) <= WIDTH {
            let piece = &self.pieces[at];
            if piece.kind == Kind::Open {
                return usize::from(self.pieces[from].gap) + self.width(from, at + 1);
            }
            if self.is_hard(from, at + 1) {
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
