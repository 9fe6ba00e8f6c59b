//! Where the statements of a text begin and end, as far as that can be known before they are read.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, SourceId, Span};

use super::closing::{Closing, closing, indent, is_field};
use super::strays::{Mend, Slip, join, looked_at_again};
use crate::budgets::Budgets;
use crate::prescan::{Fault, Scan, scan_until};

/// How often at least reading goes on after a bracket that never closes, and of how many bytes at most if it
/// does so more often: each time the rest of the text is looked through.
const RESUMED: usize = 8;
const RESUMED_BYTES: usize = 1 << 24;
/// The same at most, however short a text is.
const MOST_RESUMED: usize = 256;

/// How often reading goes on, in a text of so many bytes, after a bracket that never closes.
pub(crate) fn resume_limit(bytes: usize) -> usize {
    (RESUMED_BYTES / bytes.max(1)).clamp(RESUMED, MOST_RESUMED)
}

/// Bytes behind the last bracket that never closes in which its end is looked for, where nothing else tells.
const LOOKED_AT: usize = 1 << 22;

/// The bytes of one statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cut {
    pub(crate) range: Range<usize>,
    /// Something in it does not close.
    pub(crate) faulty: bool,
    /// What mends that, if it is a brace further up.
    pub(crate) mend: Option<Box<Mend>>,
}

/// The statements of a text, or of a part of it.
#[derive(Debug, Default)]
pub(crate) struct Cuts {
    pub(crate) pieces: Vec<Cut>,
    /// What does not close, and what stands before a first statement.
    pub(crate) faults: Vec<Diagnostic>,
    /// Brackets that never close, of each region the first.
    pub(crate) unclosed: Vec<usize>,
    /// The start that was known, at which cutting ended.
    pub(crate) met: Option<usize>,
}

/// The statements up to the end of the text, or up to a brace that never closes.
#[derive(Debug)]
pub(super) struct Region {
    /// Where the first statement begins; else where the region ends.
    pub(super) first: usize,
    pub(super) pieces: Vec<Cut>,
    /// What does not close and is worth telling.
    pub(super) faults: Vec<Fault>,
    /// The first bracket that never closes, or is taken for it.
    pub(super) unclosed: Option<usize>,
    /// Braces that are missing, or one too many, for others that close nothing.
    pub(super) slips: Vec<Slip>,
    /// A fault stands before the first statement.
    pub(super) junk_told: bool,
    /// Before which lines braces that never close most likely do.
    pub(super) closes: Vec<(usize, usize)>,
    /// Where to go on.
    pub(super) next: Option<usize>,
    /// The start that was known, which ended the region.
    pub(super) met: Option<usize>,
}

/// The regions of a text, one after another.
pub(super) struct Regions<'a> {
    text: &'a str,
    /// Brackets that may be open.
    limit: usize,
    /// Where the next begins.
    next: Option<usize>,
    /// How many may still follow.
    left: usize,
    /// Bytes that may still be looked at for braces that close nothing.
    again: usize,
    /// How many statements may still begin, and where one did beyond that.
    statements: usize,
    beyond: Option<usize>,
}

impl<'a> Regions<'a> {
    pub(super) fn new(text: &'a str, from: usize, budgets: &Budgets) -> Self {
        Self {
            text,
            limit: budgets.brackets,
            next: Some(from),
            left: resume_limit(text.len()),
            again: looked_at_again(text),
            statements: budgets.statements,
            beyond: None,
        }
    }

    /// The next, which ends at the first start that `is_known`, and where it begins.
    pub(super) fn cut(
        &mut self,
        is_known: &mut dyn FnMut(usize) -> bool,
    ) -> Option<(usize, Region)> {
        self.left = self.left.checked_sub(1)?;
        let from = self.next?;
        let found = region(self.text, from, self.limit, is_known);
        self.next = found.next.filter(|next| *next > from);
        Some((from, found))
    }

    /// The same up to where it is over, or as many statements as may be have begun, with statements joined
    /// that one mistake parts.
    pub(super) fn joined(&mut self, is_over: &dyn Fn() -> bool) -> Option<(usize, Region)> {
        let (mut left, mut beyond) = (self.statements, None);
        let (from, mut found) = self.cut(&mut |at| {
            beyond = Some(at).filter(|_| left == 0);
            left = left.saturating_sub(1);
            beyond.is_some() || is_over()
        })?;
        (self.statements, self.beyond) = (left, beyond);
        self.next = self.next.filter(|_| beyond.is_none());
        join(self.text, &mut found, self.limit, &mut self.again);
        Some((from, found))
    }

    /// What is told of a statement beyond as many as may be.
    pub(super) fn too_many(&self, source: SourceId, budgets: &Budgets) -> Option<Diagnostic> {
        let at = self.beyond?;
        let message = format!("more than {} statements in a file", budgets.statements);
        let found = Diagnostic::error("E0512", Span::new(source, at, at + 1), message);
        let found = found.help("a loop places many things; data belongs into a file or `#[ … ]`");
        Some(found.help(budgets.allows("statements")))
    }
}

/// Cuts `text[from..]` up to the first start that `is_known`.
pub(super) fn region(
    text: &str,
    from: usize,
    limit: usize,
    is_known: &mut dyn FnMut(usize) -> bool,
) -> Region {
    let mut found = scan_until(text, from..text.len(), 0, limit, is_known);
    let Closing { braces: closes, end: resume } = end_of(text, from, &mut found, limit);
    let unclosed = found.faults.iter().filter_map(Fault::unclosed).min();
    let end = resume.or(found.met).unwrap_or(text.len());
    let first = found.starts.first().copied().unwrap_or(end);
    let junk_told = found.faults.iter().any(|fault| fault.at() < first);
    let stops = found.starts.iter().skip(1).copied().chain([end]);
    let ranges = found.starts.iter().copied().zip(stops).filter(|(start, _)| *start < end);
    let mut places: Vec<usize> = found.faults.iter().map(Fault::at).collect();
    places.sort_unstable();
    let holds = |range: &Range<usize>| {
        let next = places.partition_point(|at| *at < range.start);
        places.get(next).is_some_and(|at| range.contains(at))
    };
    let pieces = ranges.map(|(start, stop)| {
        let range = start..stop.min(end);
        Cut { faulty: holds(&range), range, mend: None }
    });
    let pieces: Vec<Cut> = pieces.collect();
    let told = |fault: &Fault| {
        fault.unclosed().is_none() && resume.is_none_or(|resume| fault.at() < resume)
    };
    let mut faults: Vec<Fault> = found.faults.into_iter().filter(told).collect();
    let alone = unclosed.filter(|_| closes.is_empty());
    let together = closes.chunk_by(|(_, one), (_, other)| one == other);
    let opens = together.map(|braces| braces[0].0).chain(alone);
    faults.extend(opens.clone().map(|open| Fault::Unclosed { open }));
    faults.sort_by_key(Fault::at);
    // One that is closed further down may be taken for the one that is not.
    let unclosed = unclosed.into_iter().chain(opens).min();
    let (slips, met) = (vec![], found.met);
    Region { first, pieces, faults, unclosed, slips, junk_told, closes, next: resume, met }
}

/// Where brackets that never close most likely do. Those that nest too deep are such brackets, if the first
/// of them most likely closes before that.
fn end_of(text: &str, from: usize, found: &mut Scan, limit: usize) -> Closing {
    let deep = |fault: &Fault| match fault {
        Fault::TooDeep { at } => Some(*at),
        _ => None,
    };
    let Some(at) = found.faults.iter().find_map(deep) else {
        let unclosed: Vec<usize> = found.faults.iter().filter_map(Fault::unclosed).collect();
        return ending(text, from, &found.starts, &unclosed, limit);
    };
    let ending = ending(text, from, &found.starts, &found.open, limit);
    if ending.end.is_none_or(|end| end > at) {
        return Closing::default();
    }
    found.faults.retain(|fault| deep(fault).is_none());
    found.faults.extend(found.open.iter().map(|open| Fault::Unclosed { open: *open }));
    ending
}

/// Where these brackets most likely close, of statements that begin there.
fn ending(text: &str, from: usize, starts: &[usize], unclosed: &[usize], limit: usize) -> Closing {
    let begins = |open: &usize| match starts.partition_point(|start| start <= open) {
        0 => from,
        i => starts[i - 1],
    };
    let is_brace = |open: &usize| text[*open..].starts_with('{');
    // Lines tell only where braces close.
    let first = unclosed.iter().min().filter(|_| unclosed.iter().any(is_brace));
    if let Some(found) = first.and_then(|open| closing(text, begins(open), limit)) {
        return found;
    }
    let likely = likely_end(text, unclosed);
    Closing { braces: likely.into_iter().collect(), end: likely.map(|(_, end)| end) }
}

/// A block that never closes, how far the line of its brace is indented, and where it may end.
struct Block {
    open: usize,
    indent: usize,
    end: Option<usize>,
}

/// The first of blocks that never close that may end, where nothing else tells, and where: before the first
/// line that is indented no more than the line of its brace.
fn likely_end(text: &str, unclosed: &[usize]) -> Option<(usize, usize)> {
    let mut blocks = blocks(text, unclosed);
    let (first, last) = (blocks.first()?.open, blocks.last()?.open);
    let mut at = first + text[first..].find('\n')? + 1;
    let (mut n_passed, mut most) = (0, None);
    for line in text[at..].split_inclusive('\n') {
        if at > last + LOOKED_AT || blocks[0].end.is_some() {
            break;
        }
        let passed = blocks[n_passed..].iter().take_while(|block| block.open < at).count();
        n_passed += passed;
        if passed > 0 {
            most = deepest(&blocks[..n_passed]);
        }
        let indent = indent(line);
        if most.is_some_and(|most| indent <= most) && begins_statement(line) {
            let ends = |block: &&mut Block| block.end.is_none() && indent <= block.indent;
            blocks[..n_passed].iter_mut().filter(ends).for_each(|block| block.end = Some(at));
            most = deepest(&blocks[..n_passed]);
        }
        at += line.len();
    }
    blocks.iter().find_map(|block| Some((block.open, block.end?)))
}

/// Blocks by their braces, in order.
fn blocks(text: &str, unclosed: &[usize]) -> Vec<Block> {
    let mut opens = unclosed.to_vec();
    opens.sort_unstable();
    let (mut looked_at, mut line) = (0, 0);
    let block = |open: usize| {
        line = text[looked_at..open].rfind('\n').map_or(line, |at| looked_at + at + 1);
        looked_at = open;
        Block { open, indent: indent(&text[line..open]), end: None }
    };
    opens.into_iter().map(block).collect()
}

/// How far the one is indented that is so furthest, of those that have no end yet.
fn deepest(blocks: &[Block]) -> Option<usize> {
    let left = blocks.iter().filter(|block| block.end.is_none());
    left.map(|block| block.indent).max()
}

/// Whether a line begins what may be a statement of a file.
fn begins_statement(line: &str) -> bool {
    let line = line.trim_start();
    let first = line.chars().next();
    let begins = first.is_some_and(|c| c.is_ascii_alphabetic() || matches!(c, '@' | '/'));
    begins && !is_field(line)
}
