//! A text that is being edited, with its statements: an edit reads only those that it changes.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use luxel_core::diag::{Diagnostic, Span};

use super::lines::Lines;
use super::piece::{Piece, placed};
use crate::budgets::Budgets;
use crate::eval::builtins;
use crate::eval::names::{Known, Placed, moved, resolve_placed};
use crate::prescan::FAULTS;
use crate::shares;
use crate::sink::Sink;
use crate::syntax::{Cut, Cuts, cut, read_head, resume_limit};

/// A scene file in an editor. Offsets are bytes of its text; spans have source 0.
#[derive(Clone, Debug)]
pub struct Document {
    text: String,
    lines: Lines,
    budgets: Budgets,
    /// Where statements may begin; `None` if the head forbids reading on.
    from: Option<usize>,
    /// What is wrong with the head.
    head: Vec<Diagnostic>,
    pieces: Vec<Piece>,
    /// What does not close, and what stands where no statement is.
    pub(super) faults: Vec<Diagnostic>,
    /// Brackets that never close, of each part of the file the first.
    unclosed: Vec<usize>,
    /// The names of all statements.
    known: Known,
    /// What is wrong with names.
    names: Arc<Sink>,
    /// What the file defines for all that stands after it, by name; found when it is asked for.
    tops: OnceLock<HashMap<Arc<str>, Range<usize>>>,
}

impl Document {
    /// Reads a text.
    pub fn new(text: impl Into<String>, budgets: &Budgets) -> Self {
        let text = text.into();
        let mut out = Self {
            lines: Lines::of(&text),
            text,
            budgets: *budgets,
            from: None,
            head: vec![],
            pieces: vec![],
            faults: vec![],
            unclosed: vec![],
            known: Known::default(),
            names: Arc::new(Sink::new(0)),
            tops: OnceLock::new(),
        };
        out.read_again();
        out
    }

    pub(super) fn budgets(&self) -> &Budgets {
        &self.budgets
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// How many lines it has: one more than it has line ends, of which a lone carriage return is one too.
    pub fn n_lines(&self) -> usize {
        self.lines.count()
    }

    /// The line, from 0, in which a byte stands.
    pub fn line_of(&self, byte: usize) -> usize {
        self.lines.of_byte(byte.min(self.text.len()))
    }

    /// The bytes of a line, without what ends it.
    pub fn line(&self, line: usize) -> Range<usize> {
        self.lines.range(line, &self.text)
    }

    /// What is wrong with what is written and with the names, as far as one file tells; at most as
    /// many as the budget allows.
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        let mut sink = Sink::new(self.budgets.diagnostics);
        let joined = self.joined();
        let is_joined = |at: usize| joined.iter().any(|(range, _)| range.contains(&at));
        let is_left =
            |found: &Diagnostic| found.span().is_none_or(|span| !is_joined(span.range().start));
        let odd = self.pieces.iter().filter(|piece| !piece.is_alone && !is_joined(piece.start));
        let own = odd.flat_map(|piece| {
            piece.read.diagnostics.iter().map(|found| placed(found.clone(), piece.start))
        });
        let faults = self.faults.iter().filter(|fault| is_left(fault));
        let around = self.head.iter().chain(faults).cloned();
        let mended = joined.iter().flat_map(|(_, told)| told.iter().cloned());
        for found in around.chain(mended).chain(own) {
            sink.push(found);
        }
        // Names in statements that are one are looked at when the file is loaded.
        let mut names = Sink::clone(&self.names);
        names.retain(&is_left);
        sink.absorb(names);
        sink.finish()
    }

    /// `range` becomes `with`. Both ends are brought onto characters and into the text.
    pub fn edit(&mut self, range: Range<usize>, with: &str) {
        let was_cut_short = self.is_cut_short();
        let start = floor(&self.text, range.start);
        let range = start..floor(&self.text, range.end).max(start);
        self.text.replace_range(range.clone(), with);
        self.lines.edit(&range, with.len(), &self.text);
        let before = self.from;
        (self.from, self.head) = read_head(&self.text, &self.budgets);
        self.tops = OnceLock::new();
        match (before, self.from) {
            (Some(old), Some(new)) if !was_cut_short => {
                let is_same_head = old == new && range.start > old;
                self.read_around(&range, with.len(), is_same_head);
                if self.is_cut_short() {
                    self.read_again();
                }
            }
            _ => self.read_again(),
        }
    }

    /// Whether so much does not close that cutting may have ended early: where it did depends on all
    /// that stands before.
    fn is_cut_short(&self) -> bool {
        let faults = self.budgets.diagnostics.min(FAULTS);
        self.unclosed.len() >= resume_limit(self.text.len()) || self.faults.len() >= faults
    }

    fn read_again(&mut self) {
        (self.from, self.head) = read_head(&self.text, &self.budgets);
        let found = match self.from {
            Some(from) => cut(&self.text, from, &self.budgets, &mut |_| false),
            None => Cuts::default(),
        };
        (self.faults, self.unclosed) = (found.faults, found.unclosed);
        self.known = Known::default();
        let read = |cut: &Cut| {
            let range = &cut.range;
            Piece::new(&self.text, range.start, range.end, cut.faulty, &self.budgets)
        };
        let all = |cuts: &[Cut]| cuts.iter().map(read).collect::<Vec<_>>();
        let shares = shares::map(&found.pieces, |cut| cut.range.len(), all);
        self.pieces = shares.into_iter().flatten().collect();
        self.resolve();
    }

    /// Reads what an edit may have changed: from the statement before it up to the first statement
    /// after it that begins where one began.
    fn read_around(&mut self, range: &Range<usize>, length: usize, is_same_head: bool) {
        let before = |at: usize| self.pieces.partition_point(|piece| piece.start < at);
        // A bracket that did not close may close now.
        let touched = self.unclosed.first().map_or(range.start, |open| (open + 1).min(range.start));
        // Where a string ends that its line does not end depends on the rest of the line.
        let line = self.line(self.line_of(range.start)).start;
        let begun = self.pieces.get(before(line).saturating_sub(1)..before(touched));
        let torn = begun
            .unwrap_or_default()
            .iter()
            .find(|piece| piece.faulty)
            .map(|piece| piece.start + 1);
        let touched = torn.map_or(touched, |torn| torn.min(touched));
        // One further back, for a statement whose first word changes may begin no more.
        let first = before(touched).checked_sub(2).filter(|_| is_same_head);
        let shift = |at: usize| at - range.end + range.start + length;
        let after = self.pieces.partition_point(|piece| piece.start < range.end);
        let after_piece = first.map(|first| self.pieces[first].start);
        let from = after_piece.or(self.from).unwrap_or_default();
        let known = &self.pieces[after..];
        // Where a bracket most likely closes depends on how far its line is indented.
        let mut is_known = |at: usize| {
            self.line(self.line_of(at)).start > range.start + length
                && known.binary_search_by(|piece| shift(piece.start).cmp(&at)).is_ok()
        };
        let found = cut(&self.text, from, &self.budgets, &mut is_known);
        let kept = match found.met {
            Some(at) => self.pieces.partition_point(|p| p.start < range.end || shift(p.start) < at),
            None => self.pieces.len(),
        };
        self.keep_faults(after_piece, range, found.met, &shift);
        self.put(first.unwrap_or(0)..kept, range, found, &shift);
    }

    /// Puts what was cut anew in the place of old pieces.
    fn put(
        &mut self,
        places: Range<usize>,
        range: &Range<usize>,
        found: Cuts,
        shift: &impl Fn(usize) -> usize,
    ) {
        let old = &self.pieces[places.clone()];
        let read = |cut: &Cut| {
            let Range { start, end } = cut.range;
            let there = old.binary_search_by(|piece| piece.start.cmp(&start)).ok().map(|i| &old[i]);
            let whole = |piece: &&Piece| {
                piece.end == end && end <= range.start && piece.faulty == cut.faulty
            };
            there
                .filter(whole)
                .cloned()
                .unwrap_or_else(|| Piece::new(&self.text, start, end, cut.faulty, &self.budgets))
        };
        let new: Vec<Piece> = found.pieces.iter().map(read).collect();
        let same = self.is_stood_for(places.clone(), &new);
        self.faults.extend(found.faults);
        let later =
            self.unclosed.iter().filter(|open| **open >= range.end).map(|open| shift(*open));
        let later = later.filter(|open| found.met.is_some_and(|met| *open >= met));
        self.unclosed = found.unclosed.into_iter().chain(later).collect();
        for piece in &mut self.pieces[places.end..] {
            (piece.start, piece.end) = (shift(piece.start), shift(piece.end));
        }
        self.pieces.splice(places, new);
        if !same {
            self.resolve();
        }
    }

    /// Whether the names are as they were, and nothing was wrong with them.
    fn is_stood_for(&self, old: Range<usize>, new: &[Piece]) -> bool {
        let old = &self.pieces[old];
        let mut pairs = old.iter().zip(new);
        self.names.kept().is_empty()
            && old.len() == new.len()
            && pairs
                .all(|(old, new)| old.read.facts == new.read.facts || old.is_alone && new.is_alone)
    }

    /// Keeps the faults outside the part that was cut anew, in their new places.
    fn keep_faults(
        &mut self,
        from: Option<usize>,
        range: &Range<usize>,
        met: Option<usize>,
        shift: &impl Fn(usize) -> usize,
    ) {
        self.faults.retain_mut(|fault| {
            let Some(at) = fault.span().map(|span| span.range().start) else { return false };
            if from.is_some_and(|from| at < from) {
                return true;
            }
            let moved = at >= range.end && met.is_some_and(|met| shift(at) >= met);
            if moved {
                fault.place(|span| {
                    let range = span.range();
                    Span::new(span.source, shift(range.start), shift(range.end))
                });
            }
            moved
        });
    }

    /// Looks at the names of all statements.
    fn resolve(&mut self) {
        let mut sink = Sink::new(self.budgets.diagnostics);
        self.pieces.iter_mut().for_each(|piece| piece.number(&mut self.known));
        let at = |i: usize| {
            let piece: &Piece = &self.pieces[i];
            let (text, read) = (&self.text[piece.start..piece.end], &piece.read);
            let (stmts, facts, numbered) = (&*read.stmts, &read.facts, &piece.numbered);
            Placed { start: piece.start, text, stmts, facts, numbered }
        };
        let all = self.pieces.iter().map(|piece| &piece.numbered);
        resolve_placed(&self.known, &all, &at, &mut sink);
        self.names = Arc::new(sink);
    }

    /// Where the file defines a name for all that stands after it.
    pub(super) fn top(&self, name: &str) -> Option<Range<usize>> {
        let tops = self.tops.get_or_init(|| {
            let mut tops = HashMap::new();
            for piece in &self.pieces {
                for name in &piece.read.facts.defines {
                    let span = moved(name.span, piece.start);
                    tops.entry(name.text.clone()).or_insert(span.range());
                }
            }
            tops
        });
        tops.get(name).cloned()
    }

    /// The same for a use in a statement. What stands before it counts; of what stands later, only
    /// what every scene does not have: then it is used too early.
    pub(super) fn top_before(&self, piece: &Piece, name: &str) -> Option<Range<usize>> {
        let place = self.top(name)?;
        (place.start < piece.start || !builtins::begins(name)).then_some(place)
    }

    /// The statements, in order.
    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The statement at a byte: the last that begins at or before it.
    pub(super) fn piece_at(&self, at: usize) -> Option<&Piece> {
        let next = self.pieces.partition_point(|piece| piece.start <= at);
        self.pieces.get(next.checked_sub(1)?)
    }
}

/// The last boundary of a character at or before a byte.
fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}
