//! Lines in the making.

use super::WIDTH;

/// A comment at the end of a line.
struct Remark {
    /// Where the blanks before it go.
    at: usize,
    line: usize,
    column: usize,
    indent: usize,
    /// Columns of its first line.
    width: usize,
}

impl Remark {
    /// Whether it ends in time behind so many columns.
    fn fits(&self, column: usize) -> bool {
        column + GAP + self.width <= WIDTH
    }
}

/// Columns between a line and the comment at its end.
const GAP: usize = 2;

/// Text with its last line's state.
#[derive(Default)]
pub(super) struct Out {
    text: String,
    line: usize,
    /// Columns of the last line.
    pub(super) column: usize,
    /// By how much the last line is indented.
    pub(super) indent: usize,
    /// Whether nothing but blanks is on the last line.
    pub(super) fresh: bool,
    /// Whether the line ends here: a comment reaches to its end.
    pub(super) ends: bool,
    remarks: Vec<Remark>,
}

impl Out {
    /// Room for about this many bytes.
    pub(super) fn new(bytes: usize) -> Self {
        Self { text: String::with_capacity(bytes + bytes / 8), fresh: true, ..Self::default() }
    }

    /// The number of the last line.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// Begins a line.
    pub(super) fn newline(&mut self, indent: usize) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.line += 1;
        (self.column, self.indent, self.fresh, self.ends) = (0, indent, true, false);
    }

    /// Leaves a line empty.
    pub(super) fn blank_line(&mut self) {
        self.text.push('\n');
        self.line += 1;
    }

    /// Appends blanks, except where a line begins.
    pub(super) fn blanks(&mut self, n: usize) {
        if !self.fresh {
            self.text.extend(std::iter::repeat_n(' ', n));
            self.column += n;
        }
    }

    /// Appends what has so many columns and no line break.
    pub(super) fn put(&mut self, text: &str, width: usize) {
        if self.fresh {
            self.text.extend(std::iter::repeat_n(' ', self.indent));
            (self.column, self.fresh) = (self.indent, false);
        }
        self.text.push_str(text);
        self.column += width;
    }

    /// Appends a comment, which may have several lines; those are kept to the letter.
    pub(super) fn comment(&mut self, text: &str) {
        let mut lines = text.split('\n').map(|line| line.trim_end_matches('\r'));
        let first = lines.next().unwrap_or_default();
        self.put(first, first.chars().count());
        for line in lines {
            self.text.push('\n');
            self.line += 1;
            self.text.push_str(line);
            self.column = line.chars().count();
        }
    }

    /// Appends a comment that ends the line and stands apart from it.
    pub(super) fn remark(&mut self, text: &str) {
        let Self { line, column, indent, .. } = *self;
        if !self.fresh {
            let width = text.lines().next().unwrap_or("").chars().count();
            self.remarks.push(Remark { at: self.text.len(), line, column, indent, width });
            self.blanks(GAP);
        }
        self.comment(text);
        self.ends = true;
    }

    /// The text, remarks of lines that follow each other below each other, unless one would pass the
    /// margin for it.
    pub(super) fn finish(mut self) -> String {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        let follows = |a: &Remark, b: &Remark| a.line + 1 == b.line && a.indent == b.indent;
        let remarks = std::mem::take(&mut self.remarks);
        if !remarks.windows(2).any(|pair| follows(&pair[0], &pair[1])) {
            return self.text;
        }
        let mut out = String::with_capacity(self.text.len() + self.text.len() / 16);
        let mut from = 0;
        for run in remarks.chunk_by(follows) {
            let widest = run.iter().map(|it| it.column).filter(|column| *column <= WIDTH).max();
            let widest = widest.unwrap_or(0);
            let passes = run.iter().any(|it| it.fits(it.column) && !it.fits(widest));
            for remark in run {
                out.push_str(&self.text[from..remark.at]);
                let pad = if passes { 0 } else { widest.saturating_sub(remark.column) };
                out.extend(std::iter::repeat_n(' ', pad));
                from = remark.at;
            }
        }
        out.push_str(&self.text[from..]);
        out
    }
}
