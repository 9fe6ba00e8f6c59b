//! Braces that close nothing because one further up is missing, or is one too many: one mistake, not one at
//! each end and one for each line between.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, SourceId, Span};

use super::around::is_category;
use super::closing::{indent, is_field, rewritten};
use super::cut::{Cut, Region};
use super::fault::mend;
use super::head::{BLOCKS, BRACES};
use super::lex::{Token, TokenKind, tokens};
use crate::prescan::{Fault, is_one};

/// Statements before a brace among which the mistake is looked for.
pub(crate) const STRAYS_LOOKED_AT: usize = 100;

/// Bytes that are looked at again, all in all, to find mends and whether they are any; of a larger text all of
/// it so often.
const READ_AGAIN: usize = 1 << 20;
const TIMES: usize = 8;
/// How many of them it takes to find the mend of a bracket, at most.
const MENDED: usize = 1 << 10;

/// How many bytes of a text may be looked at again.
pub(crate) fn looked_at_again(text: &str) -> usize {
    READ_AGAIN.max(TIMES * text.len())
}

/// A brace that is missing or one too many.
#[derive(Debug)]
pub(super) struct Slip {
    /// What is to blame: the end of a head, or the brace.
    at: Range<usize>,
    what: What,
    pub(super) mend: Mend,
}

/// Which bytes become what.
pub(crate) type Mend = (Range<usize>, &'static str);

#[derive(Clone, Copy, Debug)]
enum What {
    /// A head with this first word opens no block.
    Unopened(&'static str),
    /// An object has no brace before its parameters.
    Bare,
    /// A brace ends what goes on.
    Early,
}

impl Slip {
    /// What is told of it.
    pub(super) fn told(&self, source: SourceId) -> Diagnostic {
        let span = |range: &Range<usize>| Span::new(source, range.start, range.end);
        let (code, message) = match self.what {
            What::Unopened(word) => ("E0023", format!("the `{{` of this `{word}` is missing")),
            What::Bare => ("E0023", BRACES.to_owned()),
            What::Early => ("E0010", EARLY.to_owned()),
        };
        let found = Diagnostic::error(code, span(&self.at), message);
        let found = match self.what {
            What::Unopened(_) => found.help("a block stands between `{` and `}`"),
            What::Bare | What::Early => found,
        };
        found.guess(span(&self.mend.0), self.mend.1)
    }
}

/// Finds what a `}` that closes nothing closes, or would if another one did not, and joins the statements in
/// between to one; `again` bytes may be looked at for that.
pub(super) fn join(text: &str, found: &mut Region, limit: usize, again: &mut usize) {
    let mut done = 0;
    let mut faults = std::mem::take(&mut found.faults);
    let strays = faults.extract_if(.., |fault| matches!(fault, Fault::Stray { .. }));
    let strays: Vec<Fault> = strays.collect();
    for stray in strays {
        let at = stray.at();
        let after = found.pieces.partition_point(|piece| piece.range.start < at);
        let first = after.saturating_sub(STRAYS_LOOKED_AT).max(done);
        let is_alone = text[at..].starts_with('}') && !text[at + 1..].starts_with('}');
        let mut search = Search { text, pieces: &found.pieces[first..after], limit, again };
        let slip = if is_alone { search.slip(at) } else { None };
        let other = slip.is_none().then(|| search.other(&mut faults)).flatten();
        let Some((begin, mend)) = slip.as_ref().map(|(i, slip)| (*i, slip.mend.clone())).or(other)
        else {
            faults.push(stray);
            continue;
        };
        let end = found.pieces[after - 1].range.end;
        let range = found.pieces[first + begin].range.start..end;
        let joined = Cut { range, faulty: true, mend: Some(Box::new(mend)) };
        found.pieces.splice(first + begin..after, [joined]);
        done = first + begin + 1;
        found.slips.extend(slip.map(|(_, slip)| slip));
    }
    faults.sort_by_key(Fault::at);
    found.faults = faults;
}

/// What is said of a brace that ends what goes on.
pub(crate) const EARLY: &str = "this `}` ends what goes on below it";

/// The statements up to a brace that closes nothing.
struct Search<'a> {
    text: &'a str,
    pieces: &'a [Cut],
    limit: usize,
    /// Bytes that may still be looked at.
    again: &'a mut usize,
}

impl Search<'_> {
    /// What most likely is wrong before the brace at `stray`, heads first, nearest first, and in which statement it
    /// begins.
    fn slip(&mut self, stray: usize) -> Option<(usize, Slip)> {
        let start = self.pieces.first()?.range.start;
        *self.again = self.again.checked_sub(stray - start)?;
        let tokens: Vec<Token<'_>> = tokens(self.text, start..stray).collect();
        let lines: Vec<&[Token<'_>]> = tokens.chunk_by(|_, next| !next.first_on_line).collect();
        let mut nearest = |slip: fn(&Self, &[Token<'_>], Option<usize>) -> Option<Slip>| {
            (0..lines.len()).rev().find_map(|i| {
                let next = lines.get(i + 1).map(|line| line[0].start);
                let slip = slip(self, lines[i], next)?;
                Some((self.begin(&slip.mend)?, slip))
            })
        };
        // A head without its brace is wrong in any case.
        nearest(Self::bare).or_else(|| nearest(Self::early))
    }

    /// A bracket of another kind that ends what goes on, of which that is told.
    fn other(&mut self, faults: &mut [Fault]) -> Option<(usize, Mend)> {
        let start = self.pieces.first()?.range.start;
        let end = self.pieces.last()?.range.end;
        faults.iter_mut().rev().find_map(|fault| {
            let Fault::Mismatch { open, at, .. } = *fault else { return None };
            if !(start..end).contains(&at) {
                return None;
            }
            *self.again = self.again.checked_sub(MENDED)?;
            let other = Fault::Mismatch { open, at, left: 0 };
            let mend = mend(self.text, &other)?;
            let begin = self.begin(&mend)?;
            *fault = other;
            Some((begin, mend))
        })
    }

    /// The statement in which a mend stands, if with it all from there on is one statement.
    fn begin(&mut self, (at, with): &Mend) -> Option<usize> {
        let begin = self.pieces.partition_point(|piece| piece.range.start <= at.start);
        let begin = begin.checked_sub(1)?;
        let range = self.pieces[begin].range.start..self.pieces.last()?.range.end;
        // What begins as a field is the rest of something further up.
        if is_field(&self.text[range.start..]) {
            return None;
        }
        *self.again = self.again.checked_sub(range.len())?;
        let own = at.start - range.start..at.end - range.start;
        let mended = rewritten(&self.text[range], 0, &[(own, *with)]).text;
        is_one(&mended, self.limit).then_some(begin)
    }

    /// How far the line of a byte is indented.
    fn depth(&self, at: usize) -> usize {
        let begin = self.text[..at].rfind('\n').map_or(0, |end| end + 1);
        indent(&self.text[begin..])
    }

    /// The brace that a line lacks, if the next begins at that byte.
    fn bare(&self, line: &[Token<'_>], next: Option<usize>) -> Option<Slip> {
        let (end, what) = unopened(line)?;
        let goes_on = next.is_some_and(|next| self.depth(next) > self.depth(line[0].start));
        let (at, behind) = (line[end].start..line[end].end(), line[end].end());
        let slip = Slip { at, what, mend: (behind..behind, " {") };
        (end + 1 < line.len() || goes_on).then_some(slip)
    }

    /// The brace that ends a line and what goes on below it: that begins a statement, and is none or stands
    /// within.
    fn early(&self, line: &[Token<'_>], next: Option<usize>) -> Option<Slip> {
        let (last, next) = (line.last().filter(|last| last.text == "}")?, next?);
        let i = self.pieces.binary_search_by_key(&next, |piece| piece.range.start).ok()?;
        let begun = self.depth(self.pieces[i.checked_sub(1)?].range.start);
        let at = last.start..last.end();
        let slip = Slip { at: at.clone(), what: What::Early, mend: (at, "") };
        (is_field(&self.text[next..]) || self.depth(next) > begun).then_some(slip)
    }
}

/// The last token of the head with which a line begins, if no brace follows where one should.
fn unopened(line: &[Token<'_>]) -> Option<(usize, What)> {
    let word = |i: usize| line.get(i).map_or("", |token| token.text);
    let is = |i: usize, kind: TokenKind| line.get(i).is_some_and(|token| token.kind == kind);
    // Behind `} else` a head may stand, and behind `let x =` an object's.
    let last_else = line.iter().rposition(|token| token.text == "else");
    let of_function = || line.iter().position(|token| token.text == "=").unwrap_or_default();
    let from = match (last_else, word(0), word(2)) {
        (Some(i), ..) => i + 1,
        (None, "let", "=") => 3,
        (None, ..) if word(1) == "=" && is(0, TokenKind::Word) => 2,
        (None, "fn", "(") if line.last().is_some_and(|last| last.text == "group") => {
            of_function() + 1
        }
        _ => 0,
    };
    if let Some(block) = BLOCKS.into_iter().find(|known| *known == word(from)) {
        let begins = |i: &usize| is_category(word(i + 1)) && line[*i].ends_operand();
        let end = (from + 1..line.len() - 1).find(begins);
        let head = &line[from..=end.unwrap_or(line.len() - 1)];
        let is_whole = head.len() > 2 && head.iter().all(|token| token.text != "{");
        let end = from + head.len() - 1;
        return (is_whole && line[end].ends_operand()).then_some((end, What::Unopened(block)));
    }
    if last_else.is_some_and(|i| i + 1 == line.len()) {
        return Some((line.len() - 1, What::Unopened("else")));
    }
    if word(from) == "fn" && is(1, TokenKind::Word) {
        // The brackets of its parameters end the line.
        let mut depth = 0_usize;
        let end = (2..line.len()).find(|i| {
            depth += usize::from(word(*i) == "(");
            depth = depth.saturating_sub(usize::from(word(*i) == ")"));
            depth == 0
        });
        let is_template = end.is_some_and(|end| end > 2 && end + 1 == line.len());
        return is_template.then_some((line.len() - 1, What::Unopened("fn")));
    }
    let is_group = word(from) == "group";
    if !is_category(word(from)) && !is_group {
        return None;
    }
    let mut end = from + usize::from(!is_group);
    while word(end + 1) == "." {
        end += 2;
    }
    let is_class = is_group || is(end, TokenKind::Word);
    end += usize::from(is(end + 1, TokenKind::Text));
    let goes_on = is(end + 1, TokenKind::Word) && word(end + 2) == "=";
    (is_class && (end + 1 == line.len() || goes_on)).then_some((end, What::Bare))
}
