//! A statement with the mends that are sure, so that what else is wrong with it is found too.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, Fix, Span};

/// Mends of one statement, at most.
const MENDS: usize = 16;

/// What of a text was replaced, in order, and apart.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Edits {
    /// Where the text that is read now begins in the one that was written.
    base: usize,
    edits: Vec<Edit>,
}

/// Bytes that were written, and those that stand for them now.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Edit {
    old: Range<usize>,
    new: Range<usize>,
}

impl Edits {
    /// None yet, of a text that begins at byte `base` of what was written.
    pub(super) fn new(base: usize) -> Self {
        Self { base, edits: vec![] }
    }

    /// Bytes of the text for which others stand now, behind all others that were replaced.
    pub(super) fn replace(&mut self, old: Range<usize>, new: Range<usize>) {
        let old = self.base + old.start..self.base + old.end;
        self.edits.push(Edit { old, new });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.edits.is_empty()
    }

    /// The bytes that were written where these stand now.
    pub(super) fn written(&self, now: Range<usize>) -> Range<usize> {
        let start = self.place(now.start, |edit| edit.new.end <= now.start).start;
        // What was taken out behind it is none of it.
        let is_before = |edit: &Edit| edit.new.end <= now.end && edit.new.start < now.end;
        start..self.place(now.end, is_before).end.max(start)
    }

    /// The same of a place.
    pub(super) fn span(&self, now: Span) -> Span {
        let written = self.written(now.range());
        Span::new(now.source, written.start, written.end)
    }

    /// The same of all places that something is told of.
    pub(super) fn told(&self, mut found: Diagnostic) -> Diagnostic {
        found.labels.iter_mut().for_each(|label| label.span = self.span(label.span));
        found.fixes.iter_mut().for_each(|fix| fix.span = self.span(fix.span));
        found
    }

    /// What was written where a byte stands now: no byte, or what a mend has replaced. Which mends stand before
    /// it is given.
    fn place(&self, at: usize, is_before: impl Fn(&Edit) -> bool) -> Range<usize> {
        let i = self.edits.partition_point(is_before);
        if let Some(within) = self.edits.get(i).filter(|edit| edit.new.start < at) {
            return within.old.clone();
        }
        let before = i.checked_sub(1).map(|i| &self.edits[i]);
        let at = before.map_or(self.base + at, |edit| at - edit.new.end + edit.old.end);
        at..at
    }

    /// With one more mend of a text; `None` if it overlaps or touches another, or there are enough.
    fn with(&self, text: &str, fix: &Fix) -> Option<Self> {
        let (now, new) = (fix.span.range(), &*fix.replacement);
        let i = self.edits.partition_point(|edit| edit.new.end < now.start);
        let is_apart = self.edits.get(i).is_none_or(|edit| now.end < edit.new.start);
        if !is_apart || self.edits.len() >= MENDS {
            return None;
        }
        let (old, end) = (self.written(now.clone()), now.start + new.len());
        let around = match kept(&text[now.clone()], new) {
            Some(kept) => {
                let stays = now.start + kept.old..now.start + kept.old + kept.length;
                let (stays, start) = (self.written(stays), now.start + kept.new);
                vec![
                    Edit { old: old.start..stays.start, new: now.start..start },
                    Edit { old: stays.end..old.end, new: start + kept.length..end },
                ]
            }
            None => vec![Edit { old, new: now.start..end }],
        };
        let mut edits = self.edits.clone();
        for edit in &mut edits[i..] {
            let moved = |at: usize| at - now.len() + new.len();
            edit.new = moved(edit.new.start)..moved(edit.new.end);
        }
        edits.splice(i..i, around);
        Some(Self { edits, ..*self })
    }
}

/// Where in a text and in what replaces it something stands that stays in its place.
struct Kept {
    old: usize,
    new: usize,
    length: usize,
}

/// What stays of a text: all, if something is put around it, or what stands behind another first word.
fn kept(old: &str, new: &str) -> Option<Kept> {
    if old.is_empty() {
        return None;
    }
    let all = || new.find(old).map(|at| Kept { old: 0, new: at, length: old.len() });
    let rest = || {
        let (_, rest) = new.split_once(' ').filter(|(_, rest)| !rest.is_empty())?;
        let (at, length) = (old.find(rest)?, rest.len());
        Some(Kept { old: at, new: new.len() - length, length })
    };
    all().or_else(rest)
}

/// A statement as it was written, or with mends that are sure.
#[derive(Clone, Debug)]
pub(super) struct Mended {
    pub(super) text: String,
    pub(super) edits: Edits,
}

impl Mended {
    /// The statement with one more mend, if what was found has a sure one.
    pub(super) fn with(&self, found: &Diagnostic) -> Option<Self> {
        let fix = found.sure()?;
        Some(Self { text: fix.applied(&self.text), edits: self.edits.with(&self.text, fix)? })
    }
}

#[cfg(test)]
mod tests {
    use luxel_core::diag::SourceId;

    use super::*;

    fn fixed(mended: &Mended, span: Range<usize>, new: &str) -> Option<Mended> {
        let span = Span::new(SourceId(0), span.start, span.end);
        mended.with(&Diagnostic::error("E0001", span, "x").fix(span, new))
    }

    #[test]
    fn places_are_those_that_were_written() {
        let begun = Mended { text: "(0 1 0) ** x".into(), edits: Edits::new(100) };
        assert_eq!(begun.edits.written(3..8), 103..108);
        let one = fixed(&begun, 8..10, "^").unwrap();
        let two = fixed(&one, 2..2, ",").unwrap();
        let three = fixed(&two, 5..5, ",").unwrap();
        assert_eq!(three.text, "(0, 1, 0) ^ x");
        for (now, written) in [
            // Before, at and behind what was put in.
            (0..1, 100..101),
            (2..3, 102..102),
            (1..4, 101..103),
            (4..5, 103..104),
            // What was replaced, and behind it.
            (10..11, 108..110),
            (9..12, 107..111),
            (12..13, 111..112),
            (13..13, 112..112),
        ] {
            assert_eq!(three.edits.written(now.clone()), written, "{now:?}");
        }
        let around = fixed(&begun, 10..12, ", x =").unwrap();
        assert_eq!(around.text, "(0 1 0) **, x =");
        assert_eq!(around.edits.written(11..13), 110..112, "what stays is where it was");
        assert_eq!(around.edits.written(13..15), 112..112);
        let behind = fixed(&begun, 0..7, "= 0 1 0").unwrap();
        assert_eq!(behind.text, "= 0 1 0 ** x");
        for (now, written) in
            [(0..1, 100..101), (2..3, 101..102), (6..7, 105..106), (8..10, 108..110)]
        {
            assert_eq!(behind.edits.written(now.clone()), written, "{now:?}");
        }
        assert!(fixed(&three, 6..6, " ").is_none(), "touches a mend");
        assert!(fixed(&three, 9..12, " ").is_none(), "overlaps a mend");
        let mut many = Mended { text: "x".repeat(100), edits: Edits::new(0) };
        for i in 0..MENDS {
            many = fixed(&many, 3 * i..3 * i, "y").unwrap();
        }
        assert!(fixed(&many, 90..90, "y").is_none());
    }
}
