//! From text to statements: cut by the pre-scan, each piece read straight from its bytes or, if that
//! gives up, by pest; mistakes explained.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, SourceId, Span};
use pest::Parser;

use super::around::Place;
use super::build::Builder;
use super::cut::{Cut, Cuts, Region, Regions, region};
use super::direct::{self, Words};
use super::edits::Edits;
use super::fault;
use super::gaps::Gaps;
use super::lex::{Token, TokenKind, tokens};
use super::recover::{stopped, whole_before};
use super::strays::join;
use super::tree::{Expr, ExprNode, Stmt};
use super::weigh::too_large;
use super::{Rule, SceneParser};
use crate::budgets::Budgets;
use crate::prescan::scan;
use crate::shares;
use crate::sink::Sink;

/// A file, read.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Tree {
    pub(crate) stmts: Vec<Stmt>,
}

/// Reads one text; what cannot be read is told and leaves `StmtNode::Broken`.
pub(crate) fn parse(text: &str, source: SourceId, budgets: &Budgets, sink: &mut Sink) -> Tree {
    Reader::new(text, source, budgets, sink).tree()
}

/// The same by the grammar of record alone.
pub(crate) fn parse_by_pest(
    text: &str,
    source: SourceId,
    budgets: &Budgets,
    sink: &mut Sink,
) -> Tree {
    Reader { direct: None, ..Reader::new(text, source, budgets, sink) }.tree()
}

/// Who takes statements, some after others: what has been taken need not be kept.
pub(crate) struct Turns<'t> {
    /// Bytes of text that are read before what has been read is taken.
    pub(crate) bytes: usize,
    /// Takes some; whether more are wanted.
    pub(crate) take: &'t mut dyn FnMut(Vec<Stmt>) -> bool,
}

/// The same as `parse`, in turns.
pub(crate) fn parse_in_turns(
    text: &str,
    source: SourceId,
    budgets: &Budgets,
    sink: &mut Sink,
    turns: &mut Turns<'_>,
) {
    Reader::new(text, source, budgets, sink).file(turns);
}

/// What stands before the first statement of a text: where reading goes on, if it is of use, and what
/// is wrong so far.
pub(crate) fn read_head(text: &str, budgets: &Budgets) -> (Option<usize>, Vec<Diagnostic>) {
    let mut sink = Sink::new(budgets.diagnostics);
    let source = SourceId(0);
    let from = Reader::new(text, source, budgets, &mut sink).head();
    (from, sink.finish())
}

/// The bytes of the statements from `from` on, up to the first start that `is_known`, and what does
/// not close.
pub(crate) fn cut(
    text: &str,
    from: usize,
    budgets: &Budgets,
    is_known: &mut dyn FnMut(usize) -> bool,
) -> Cuts {
    let mut out = Cuts::default();
    let mut regions = Regions::new(text, from, budgets);
    while let Some((from, found)) = regions.cut(is_known) {
        let mut sink = Sink::new(budgets.diagnostics);
        let source = SourceId(0);
        Reader::new(text, source, budgets, &mut sink).region_faults(from, &found);
        out.unclosed.extend(found.unclosed);
        out.faults.extend(sink.finish());
        out.pieces.extend(found.pieces);
        out.met = found.met;
    }
    out
}

/// The bytes of the statements from `from` on, as `parse` reads them; of some once it is over.
pub(crate) fn cut_whole(
    text: &str,
    from: usize,
    budgets: &Budgets,
    is_over: &dyn Fn() -> bool,
) -> Vec<Cut> {
    let mut pieces = vec![];
    let mut regions = Regions::new(text, from, budgets);
    while let Some((_, found)) = regions.joined(is_over) {
        pieces.extend(found.pieces);
    }
    pieces
}

/// Reads the statement of a piece; spans count from its first byte.
pub(crate) fn read_piece(
    text: &str,
    faulty: bool,
    source: SourceId,
    budgets: &Budgets,
) -> (Vec<Stmt>, Vec<Diagnostic>) {
    let mut sink = Sink::new(budgets.diagnostics);
    let mut reader = Reader::new(text, source, budgets, &mut sink);
    if faulty {
        reader.unclosed(0..text.len());
    } else {
        reader.chunk(0..text.len(), Place::File);
    }
    (reader.out.stmts, sink.finish())
}

/// Some statements, up to a brace at `stray` that closes nothing: those that are one if another brace is mended, and
/// what is told of that; `again` bytes may be looked at for it.
pub(crate) fn joined_at(
    text: &str,
    range: Range<usize>,
    stray: usize,
    budgets: &Budgets,
    again: &mut usize,
) -> Option<(Range<usize>, Vec<Diagnostic>)> {
    let text = &text[..range.end];
    let mut found = region(text, range.start, budgets.brackets, &mut |_| false);
    join(text, &mut found, budgets.brackets, again);
    let is_it = |piece: &&Cut| piece.mend.is_some() && piece.range.contains(&stray);
    let piece = found.pieces.iter().find(is_it)?.clone();
    let is_within = |at: usize| piece.range.contains(&at);
    found.slips.retain(|slip| is_within(slip.mend.0.start));
    found.faults.retain(|fault| is_within(fault.at()));
    found.junk_told = true;
    let mut sink = Sink::new(budgets.diagnostics);
    let mut reader = Reader::new(text, SourceId(0), budgets, &mut sink);
    reader.region_faults(range.start, &found);
    reader.pieces(std::slice::from_ref(&piece));
    Some((piece.range, sink.finish()))
}

/// Reads the statement of a piece; what is wrong with it is not told.
pub(crate) fn read_at(text: &str, piece: &Cut, source: SourceId, budgets: &Budgets) -> Vec<Stmt> {
    let mut sink = Sink::new(budgets.diagnostics);
    let mut reader = Reader::new(text, source, budgets, &mut sink);
    reader.pieces(std::slice::from_ref(piece));
    reader.out.stmts
}

/// Reads a statement straight from its bytes where that is possible, or by the grammar of record alone
/// if there are no words.
pub(super) fn read_as(
    direct: Option<Words>,
    text: &str,
    piece: Range<usize>,
    budgets: &Budgets,
) -> (Vec<Stmt>, Vec<Diagnostic>) {
    let mut sink = Sink::new(budgets.diagnostics);
    let mut reader = Reader { direct, ..Reader::new(text, SourceId(0), budgets, &mut sink) };
    reader.chunk(piece, Place::File);
    (reader.out.stmts, sink.finish())
}

/// Reads one text in one piece, without recovery: the oracle of `parse`.
#[cfg(any(test, feature = "fuzz"))]
pub(super) fn parse_whole(
    text: &str,
    source: SourceId,
    budgets: &Budgets,
    sink: &mut Sink,
) -> Option<Tree> {
    let file = SceneParser::parse(Rule::file, text).ok()?.next()?;
    let mut builder = Builder::new((source, 0), sink, budgets);
    let stmts = file
        .into_inner()
        .filter(|part| part.as_rule() == Rule::stmt)
        .map(|part| builder.stmt(part))
        .collect();
    Some(Tree { stmts })
}

/// Reads an expression that begins at byte `start` and ends with the text.
pub(crate) fn parse_expr(
    text: &str,
    start: usize,
    source: SourceId,
    budgets: &Budgets,
    sink: &mut Sink,
) -> Option<Expr> {
    let faults = scan(text, start..text.len(), 0, budgets.brackets).faults;
    let pairs = SceneParser::parse(Rule::one_expr, &text[start..]).ok();
    let pair = pairs.filter(|_| faults.is_empty())?.next()?.into_inner().next()?;
    let mut builder = Builder::new((source, start), sink, budgets);
    let expr = builder.expr(pair);
    (expr.node != ExprNode::Broken).then_some(expr)
}

/// Bytes of a statement that are read once more, all in all, to find its further mistakes.
const AGAIN: usize = 1 << 16;

pub(super) struct Reader<'a> {
    pub(super) text: &'a str,
    pub(super) source: SourceId,
    pub(super) budgets: &'a Budgets,
    pub(super) sink: &'a mut Sink,
    /// Words that were met, if statements are read straight from their bytes where that is possible.
    pub(super) direct: Option<Words>,
    /// Where the statement that is being read cannot be read: the innermost statements around mistakes.
    pub(super) wrong: Vec<Range<usize>>,
    /// What was mended of what was written.
    pub(super) edits: Edits,
    /// Bytes that may still be read once more to find further mistakes of the statement.
    pub(super) again: usize,
    pub(super) out: Tree,
}

impl<'a> Reader<'a> {
    pub(super) fn new(
        text: &'a str,
        source: SourceId,
        budgets: &'a Budgets,
        sink: &'a mut Sink,
    ) -> Self {
        let (direct, out) = (Some(Words::default()), Tree::default());
        let (wrong, edits, again) = (vec![], Edits::default(), AGAIN);
        Self { text, source, budgets, sink, direct, wrong, edits, again, out }
    }
}

impl Reader<'_> {
    pub(super) fn span(&self, range: Range<usize>) -> Span {
        self.edits.span(Span::new(self.source, range.start, range.end))
    }

    fn tree(&mut self) -> Tree {
        let mut stmts = vec![];
        let mut take = |some| {
            stmts.extend(some);
            true
        };
        self.file(&mut Turns { bytes: usize::MAX, take: &mut take });
        Tree { stmts }
    }

    fn file(&mut self, turns: &mut Turns<'_>) {
        let Some(from) = self.head() else { return };
        let mut regions = Regions::new(self.text, from, self.budgets);
        while let Some((from, found)) = regions.joined(&self.sink.over()) {
            self.region_faults(from, &found);
            let turn = |cut: &Cut| cut.range.start / turns.bytes;
            for pieces in found.pieces.chunk_by(|one, next| turn(one) == turn(next)) {
                if !self.turn(pieces, turns.take) {
                    return;
                }
            }
        }
        if let Some(found) = regions.too_many(self.source, self.budgets) {
            self.sink.push(found);
        }
    }

    /// Reads the statements of some pieces on several threads; whether more are wanted.
    fn turn(&mut self, pieces: &[Cut], take: &mut dyn FnMut(Vec<Stmt>) -> bool) -> bool {
        let (text, source, budgets) = (self.text, self.source, self.budgets);
        let (empty, is_direct) = (self.sink.like(), self.direct.is_some());
        let read = |pieces: &[Cut]| {
            let mut sink = empty.like();
            let direct = is_direct.then(Words::default);
            let mut reader = Reader { direct, ..Reader::new(text, source, budgets, &mut sink) };
            reader.pieces(pieces);
            (reader.out.stmts, sink)
        };
        for (stmts, sink) in shares::map(pieces, |piece| piece.range.len(), read) {
            if self.sink.is_full() || !take(stmts) {
                return false;
            }
            self.sink.absorb(sink);
        }
        true
    }

    /// Reads the statements of some pieces.
    fn pieces(&mut self, pieces: &[Cut]) {
        for piece in pieces {
            if self.sink.is_full() {
                return;
            }
            self.again = AGAIN;
            if let Some(mend) = &piece.mend {
                self.with_mend(piece.range.clone(), mend);
            } else if piece.faulty {
                self.unclosed(piece.range.clone());
            } else {
                self.chunk(piece.range.clone(), Place::File);
            }
        }
    }

    /// Tells what is wrong with a region beside its statements.
    fn region_faults(&mut self, from: usize, found: &Region) {
        for fault in &found.faults {
            let limit = self.budgets.brackets;
            let told = fault::told(self.text, self.source, limit, fault, &found.closes);
            self.sink.push(told);
        }
        for slip in &found.slips {
            self.sink.push(slip.told(self.source));
        }
        if !found.junk_told {
            self.before_first(from, found.first);
        }
    }

    /// What stands before the first statement must be nothing.
    fn before_first(&mut self, from: usize, first: usize) {
        let is_doc = |token: &Token<'_>| token.kind == TokenKind::Doc;
        let all = || tokens(self.text, from..first);
        let Some(token) = all().find(|it| !is_doc(it)).or_else(|| all().next()) else { return };
        let span = self.span(token.start..token.end());
        if is_doc(&token) {
            let message = "this doc comment is attached to nothing";
            self.sink.push(Diagnostic::warning("E0022", span, message));
        } else if token.text == "else" {
            self.sink.push(Diagnostic::error("E0020", span, super::explain::LONE_ELSE));
        } else {
            let found: String = token.text.chars().take(40).collect();
            let message = format!("`{found}` cannot begin a statement");
            let told = Diagnostic::error("E0023", span, message);
            let parts = matches!(token.text, "," | ";");
            self.sink.push(if parts { told.fix(span, "") } else { told });
        }
    }

    /// Reads one statement. Only one of the file itself becomes part of the tree.
    pub(super) fn chunk(&mut self, chunk: Range<usize>, place: Place) {
        let keep = place == Place::File;
        let text = &self.text[chunk.clone()];
        if self.is_too_large(&chunk) {
            if keep {
                self.broken(chunk);
            }
            return;
        }
        if let Some(words) = &mut self.direct
            && let Some(stmt) =
                direct::read(self.text, chunk.clone(), self.source, self.budgets, words)
        {
            self.out.stmts.extend(Some(stmt).filter(|_| keep));
            return;
        }
        match SceneParser::parse(Rule::one_stmt, text) {
            Ok(pairs) => {
                let mut builder = self.builder(chunk.start);
                let mut stmts = vec![];
                for part in pairs.flat_map(pest::iterators::Pair::into_inner) {
                    match part.as_rule() {
                        Rule::stmt if keep => stmts.push(builder.stmt(part)),
                        Rule::stmt => {}
                        _ => builder.dangling(&part),
                    }
                }
                self.out.stmts.extend(stmts);
            }
            Err(error) => {
                // Whatever stands behind an `else` that begins a statement.
                let is_else = tokens(text, 0..text.len()).next().is_some_and(|t| t.text == "else");
                let at = chunk.start + if is_else { 0 } else { stopped(&error) };
                if let Some(line) = whole_before(self.text, at, &chunk) {
                    self.chunk(chunk.start..line, place);
                    self.chunk(line..chunk.end, place);
                    return;
                }
                if self.mended(at, &chunk, place) {
                    return;
                }
                // What stands after it on its last line comes after it.
                let after = keep.then_some(self.out.stmts.len());
                self.recover(at, chunk.clone(), place);
                if let Some(after) = after {
                    let later = self.out.stmts.split_off(after);
                    self.salvage(&chunk, at);
                    self.out.stmts.extend(later);
                }
            }
        }
    }

    pub(super) fn builder(&mut self, base: usize) -> Builder<'_> {
        let (source, budgets, edits) = (self.source, self.budgets, self.edits.clone());
        let gaps = Gaps::default();
        Builder { source, base, sink: self.sink, budgets, gaps, edits, begun: None }
    }

    /// Whether a statement would take too much to read, which is told.
    fn is_too_large(&mut self, chunk: &Range<usize>) -> bool {
        let found = too_large(self.text, chunk, self.source, self.budgets);
        let is_found = found.is_some();
        if let Some(found) = found {
            self.sink.push(self.edits.told(found));
        }
        is_found
    }
}
