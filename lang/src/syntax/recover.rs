//! What is done about a statement that cannot be read.

use std::ops::Range;

use luxel_core::diag::Diagnostic;
use pest::Parser;
use pest::error::InputLocation;

use super::around::Place;
use super::build::Builder;
use super::closing::{closed, rewritten};
use super::defined::perhaps_defined;
use super::edits::{Edits, Mended};
use super::explain::explain;
use super::gaps::Gaps;
use super::headless::{Headed, headed};
use super::lex::{TokenKind, tokens};
use super::parse::Reader;
use super::strays::Mend;
use super::tree::{Stmt, StmtNode};
use super::{Rule, SceneParser};
use crate::prescan::scan;

/// Bytes of a statement up to which what is right in it is read although something is wrong.
const REPAIRED: usize = 1 << 18;

/// In how many enclosing blocks statements after a mistake are still looked at.
const BLOCKS_LOOKED_AT: usize = 8;

/// The byte at which reading stopped.
pub(super) fn stopped(error: &pest::error::Error<Rule>) -> usize {
    let (InputLocation::Pos(at) | InputLocation::Span((at, _))) = error.location;
    at
}

/// Where a statement cannot be read further, if it cannot.
pub(super) fn fault(text: &str) -> Option<usize> {
    SceneParser::parse(Rule::one_stmt, text).err().map(|error| stopped(&error))
}

/// Where the line begins at whose first character a statement cannot be read further, if what stands
/// before that line is one as it is.
pub(super) fn whole_before(text: &str, at: usize, chunk: &Range<usize>) -> Option<usize> {
    let before = &text[chunk.start..at];
    let line = chunk.start + before.rfind('\n')? + 1;
    let is_first = text[line..at].trim().is_empty();
    (is_first && fault(&text[chunk.start..line]).is_none()).then_some(line)
}

impl Reader<'_> {
    /// Reads what is left of a statement of the file that cannot be read near byte `at`, which has been told.
    pub(super) fn salvage(&mut self, chunk: &Range<usize>, at: usize) {
        let is_worth = self.edits.is_empty() && chunk.len() <= REPAIRED && !self.sink.is_full();
        let piece = Some(&self.text[chunk.clone()]).filter(|_| is_worth);
        let headed = piece.and_then(|piece| headed(piece, chunk.start, at - chunk.start));
        let Some(Headed { mended, brace }) = headed else {
            let stmt = self.repaired(chunk);
            return self.out.stmts.push(stmt);
        };
        // The names of its head.
        self.broken(chunk.start..chunk.start + brace);
        let whole = 0..mended.text.len();
        self.read_mended(mended, whole, Place::File);
    }

    /// A statement of the file without the inner statements that cannot be read: more mistakes may be
    /// found in the rest.
    pub(super) fn repaired(&mut self, chunk: &Range<usize>) -> Stmt {
        let is_own =
            |range: &mut Range<usize>| chunk.start <= range.start && range.end <= chunk.end;
        let wrong = self.wrong.extract_if(.., is_own).collect();
        let gaps = Gaps::new(wrong, |range| self.broken_stmt(range));
        let is_worth = chunk.len() <= REPAIRED && !self.sink.is_full();
        let text = Some(chunk).filter(|_| is_worth).and_then(|chunk| gaps.filled(self.text, chunk));
        let pairs = text.as_ref().and_then(|text| SceneParser::parse(Rule::one_stmt, text).ok());
        let stmt = pairs.and_then(|pairs| {
            let mut parts = pairs.flat_map(pest::iterators::Pair::into_inner);
            let stmt = parts.find(|part| part.as_rule() == Rule::stmt)?;
            let mut builder = Builder { gaps, ..self.builder(chunk.start) };
            let stmt = builder.stmt(stmt);
            builder.gaps.are_filled().then_some(stmt)
        });
        stmt.unwrap_or_else(|| self.broken_stmt(chunk.clone()))
    }

    /// Mends what is wrong with a statement near byte `at`, and further on, as long as the mend is sure;
    /// tells it, and reads what comes of it. False, and nothing told, where the first mistake has none.
    pub(super) fn mended(&mut self, at: usize, chunk: &Range<usize>, place: Place) -> bool {
        let length = if self.edits.is_empty() { chunk.len() } else { self.text.len() };
        if length > self.again || self.sink.is_full() {
            return false;
        }
        let (mut mended, mut part, mut at) = if self.edits.is_empty() {
            let (text, edits) = (self.text[chunk.clone()].to_owned(), Edits::new(chunk.start));
            (Mended { text, edits }, 0..chunk.len(), at - chunk.start)
        } else {
            let (text, edits) = (self.text.to_owned(), self.edits.clone());
            (Mended { text, edits }, chunk.clone(), at)
        };
        let mut told = vec![];
        loop {
            let found = explain(&mended.text, part.clone(), at, self.source, place).diagnostic;
            let Some(next) = mended.with(&found) else { break };
            let Some(again) = self.again.checked_sub(next.text.len()) else { break };
            self.again = again;
            let end = part.end + next.text.len() - mended.text.len();
            let fault = fault(&next.text[part.start..end]).map(|to| part.start + to);
            let written = |of: &Mended, at: usize| of.edits.written(at..at).start;
            // Two statements where one was written.
            let is_apart = fault.is_some_and(|to| whole_before(&next.text, to, &part).is_some());
            let is_further = |to: usize| {
                let begins = |of: &Mended, found: &Diagnostic| {
                    found.span().map(|span| written(of, span.range().start))
                };
                let left =
                    || explain(&next.text, part.start..end, to, self.source, place).diagnostic;
                written(&next, to) > written(&mended, at)
                    || begins(&next, &left()) > begins(&mended, &found)
            };
            if !is_apart && fault.is_some_and(|to| !is_further(to)) {
                break;
            }
            told.push(mended.edits.told(found));
            (mended, part.end) = (next, end);
            let Some(to) = fault.filter(|_| !is_apart) else { break };
            at = to;
        }
        if told.is_empty() {
            return false;
        }
        for found in told {
            self.sink.push(found);
        }
        self.read_mended(mended, part, place);
        if place != Place::File {
            self.wrong.push(chunk.clone());
        }
        true
    }

    /// Reads a part of what mends made of a statement.
    fn read_mended(&mut self, Mended { text, edits }: Mended, part: Range<usize>, place: Place) {
        let (mut sink, again) = (self.sink.like(), self.again);
        let read = Reader::new(&text, self.source, self.budgets, &mut sink);
        let mut reader = Reader { direct: None, edits, again, ..read };
        reader.chunk(part, place);
        self.again = reader.again;
        self.out.stmts.append(&mut reader.out.stmts);
        self.sink.absorb(sink);
    }

    /// Reads a statement with something of it mended, which has been told.
    pub(super) fn with_mend(&mut self, chunk: Range<usize>, (at, with): &Mend) {
        let own = at.start - chunk.start..at.end - chunk.start;
        let mended = rewritten(&self.text[chunk.clone()], chunk.start, &[(own, *with)]);
        self.read_likely(mended);
    }

    /// Reads what most likely is meant by a statement.
    fn read_likely(&mut self, mended: Mended) {
        let (whole, first) = (0..mended.text.len(), self.out.stmts.len());
        self.read_mended(mended, whole, Place::File);
        self.out.stmts[first..].iter_mut().for_each(|stmt| stmt.is_likely = true);
    }

    /// Reads a statement with whose brackets something is wrong, which has been told: closed where it most
    /// likely does, if only that is missing.
    pub(super) fn unclosed(&mut self, chunk: Range<usize>) {
        let is_worth = chunk.len() <= REPAIRED && !self.sink.is_full();
        let piece = Some(&self.text[chunk.clone()]).filter(|_| is_worth);
        match piece.and_then(|piece| closed(piece, chunk.start, self.budgets.brackets)) {
            Some(mended) => self.read_likely(mended),
            None => self.broken(chunk),
        }
    }

    /// Explains a mistake near byte `at` and reads the statements after it, in its block and in those
    /// around it.
    pub(super) fn recover(&mut self, at: usize, chunk: Range<usize>, place: Place) {
        let found = explain(self.text, chunk.clone(), at, self.source, place);
        let here = found.at;
        self.sink.push(self.edits.told(found.diagnostic));
        if self.sink.is_full() {
            return;
        }
        let mut blocks = found.blocks;
        blocks.reverse();
        blocks.truncate(BLOCKS_LOOKED_AT);
        let mut after = here;
        let mut wrong = Some(chunk.clone());
        for (open, within) in blocks {
            let scan = scan(self.text, open..chunk.end, 1, self.budgets.brackets);
            let close = self.matching(open, chunk.end);
            // The innermost block has the statement around the mistake.
            if wrong.take().is_some() {
                let next = scan.starts.partition_point(|start| *start <= here);
                let end = scan.starts.get(next).copied().unwrap_or(close).min(close);
                let start = next.checked_sub(1).map_or(open + 1, |i| scan.starts[i]);
                self.wrong.push(start..end);
            }
            let inner: Vec<usize> =
                scan.starts.into_iter().filter(|s| *s > after && *s < close).collect();
            let ends = inner.iter().skip(1).copied().chain([close]);
            for (start, stop) in inner.iter().copied().zip(ends) {
                self.chunk(start..stop, within);
            }
            after = after.max(close);
        }
        self.wrong.extend(wrong);
        // A statement that was swallowed by an operator at the end of the line before.
        if let Some(start) = found.resume.filter(|start| *start > chunk.start) {
            let starts = scan(self.text, start..chunk.end, 0, self.budgets.brackets).starts;
            let ends = starts.iter().skip(1).copied().chain([chunk.end]);
            for (start, stop) in starts.iter().copied().zip(ends) {
                self.chunk(start..stop, place);
            }
        }
    }

    /// The bracket that closes the one at `open`, or `end`.
    fn matching(&self, open: usize, end: usize) -> usize {
        let mut depth = 0_usize;
        for token in tokens(self.text, open..end).filter(|t| t.kind == TokenKind::Mark) {
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth == 0 {
                return token.start;
            }
        }
        end
    }

    /// Keeps a statement that cannot be read, with the names that it may define.
    pub(super) fn broken(&mut self, chunk: Range<usize>) {
        let stmt = self.broken_stmt(chunk);
        self.out.stmts.push(stmt);
    }

    fn broken_stmt(&self, chunk: Range<usize>) -> Stmt {
        let span = self.span(chunk.clone());
        let mut defines = perhaps_defined(self.text, chunk, self.source);
        defines.iter_mut().for_each(|name| name.span = self.edits.span(name.span));
        let node = StmtNode::Broken { defines };
        Stmt { span, docs: Box::default(), attrs: Box::default(), node, is_likely: false }
    }
}
