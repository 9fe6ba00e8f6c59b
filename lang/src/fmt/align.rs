//! `=` and `{` below each other, where the author of one line began it.

use super::WIDTH;
use super::block::Entry;
use super::layout::Layout;
use super::piece::Kind;

/// What lines must have in common to be aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alike<'a> {
    /// `name =`
    Field,
    /// `let name =`, `param name: type =` or `set label.field =`, on one line
    Definition(&'a str),
    /// `category kind "label" {` on one line
    Object(&'a str),
}

/// So many columns may a line be moved.
const FARTHEST: usize = 10;

/// A line and the piece that may be moved.
struct Line<'a> {
    alike: Alike<'a>,
    moved: usize,
    /// Columns before it.
    head: usize,
}

impl<'a> Layout<'a> {
    /// Moves what is to be moved in the lines of a block.
    pub(super) fn align(&mut self, entries: &[Entry], indent: usize) {
        let mut at = 0;
        while at < entries.len() {
            let mut run: Vec<Line<'a>> = vec![];
            let (mut least, mut most) = (usize::MAX, 0);
            while let Some(line) = entries.get(at + run.len()).and_then(|it| self.line(it, indent))
            {
                let joined = |first: &Line<'_>| {
                    let entry = &entries[at + run.len()];
                    first.alike == line.alike && self.pieces[entry.from].newlines < 2
                };
                (least, most) = (least.min(line.head), most.max(line.head));
                if !run.first().is_none_or(joined) || most - least > FARTHEST {
                    break;
                }
                run.push(line);
            }
            self.align_run(&entries[at..at + run.len()], &run, indent);
            at += run.len().max(1);
        }
    }

    fn align_run(&mut self, entries: &[Entry], run: &[Line<'_>], indent: usize) {
        // Its author began it, or the line is one that did not exist.
        let wished = |(i, line): (usize, &Line<'_>)| {
            let moved = &self.pieces[line.moved];
            let new =
                i > 0 && line.alike == Alike::Field && self.pieces[entries[i].from].newlines == 0;
            new || moved.blanks > 1 && moved.newlines == 0
        };
        if run.len() < 2 || !run.iter().enumerate().any(wished) {
            return;
        }
        let widest = run.iter().map(|line| line.head).max().unwrap_or(0);
        let fits = |(entry, line): (&Entry, &Line<'_>)| {
            let width = self.width(entry.from, entry.core) + widest - line.head;
            line.alike == Alike::Field || indent + width <= WIDTH
        };
        if entries.iter().zip(run).all(fits) {
            for line in run {
                let pad = u16::try_from(widest - line.head).unwrap_or(0);
                self.pieces[line.moved].pad = pad;
            }
        }
    }

    /// What may be moved in a line.
    fn line(&self, entry: &Entry, indent: usize) -> Option<Line<'a>> {
        let Entry { from, core, .. } = *entry;
        let first = self.pieces.get(from).filter(|_| core > from)?;
        let (alike, wanted) = match first.kind {
            Kind::Word if self.pieces[from + 1].kind == Kind::Assign => {
                (Alike::Field, Kind::Assign)
            }
            _ if !self.is_flat(entry, indent) => return None,
            Kind::Word => (Alike::Object(first.text), Kind::Open),
            Kind::Keyword if matches!(first.text, "let" | "param" | "set") => {
                (Alike::Definition(first.text), Kind::Assign)
            }
            _ => return None,
        };
        let mut moved = from;
        while self.pieces[moved].kind != wanted {
            let known = matches!(
                self.pieces[moved].kind,
                Kind::Word | Kind::Keyword | Kind::Dot | Kind::Colon | Kind::Text
            );
            let list = self.pieces[moved].is_open("[") && wanted == Kind::Assign;
            moved = if known || list { self.next(moved) } else { return None };
            if moved >= core {
                return None;
            }
        }
        let brace = wanted != Kind::Open || self.pieces[moved].is_open("{");
        brace.then(|| Line { alike, moved, head: self.width(from, moved) })
    }
}
