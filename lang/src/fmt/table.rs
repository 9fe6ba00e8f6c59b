//! `#[ … ]` tables: rows as they were broken, numbers below each other by their decimal points.

use super::out::Out;
use super::{STEP, WIDTH};

/// A number of a table.
struct Cell<'a> {
    text: &'a str,
    /// Blanks since the one before.
    gap: usize,
    /// Columns before the decimal point.
    left: usize,
}

/// A column of numbers. Places are relative to the point of the first number of their row.
#[derive(Clone, Copy)]
struct Column {
    left: usize,
    right: usize,
    /// Where the points are, as long as all are at one place.
    point: Option<isize>,
    first_start: isize,
    last_end: isize,
    least_gap: usize,
}

/// What stands between the brackets.
fn body(text: &str) -> &str {
    text.strip_prefix("#[").and_then(|rest| rest.strip_suffix(']')).unwrap_or_default()
}

/// A table of one line as it is written.
pub(super) fn flat(text: &str) -> String {
    let body = body(text);
    if body.contains('/') {
        return format!("#[ {} ]", body.trim());
    }
    let mut out = String::with_capacity(text.len() + 2);
    out.push_str("#[");
    for cell in cells(body) {
        out.extend(std::iter::repeat_n(' ', cell.gap));
        out.push_str(cell.text);
    }
    out.push_str(if out.len() > 2 { " ]" } else { "]" });
    out
}

/// Whether a byte only separates numbers.
fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | b',')
}

/// Whether a line of a table holds nothing but what separates numbers.
fn is_empty(line: &str) -> bool {
    line.bytes().all(is_blank)
}

/// The numbers of a row; commas between them are blanks.
fn cells(row: &str) -> impl Iterator<Item = Cell<'_>> {
    let (bytes, mut at, mut first) = (row.as_bytes(), 0, true);
    std::iter::from_fn(move || {
        let mut gap = 0;
        while bytes.get(at).is_some_and(|b| is_blank(*b)) {
            gap += usize::from(bytes[at] != b',');
            at += 1;
        }
        let start = at;
        while bytes.get(at).is_some_and(|b| !is_blank(*b)) {
            at += 1;
        }
        let text = &row[start..at];
        let gap = if std::mem::take(&mut first) { 1 } else { gap.max(1) };
        let left = text.find(['.', 'e', 'E']).unwrap_or(text.len());
        (start < at).then_some(Cell { text, gap, left })
    })
}

/// Whether a table takes several lines: its bracket ends its first line, it has other rows, or a comment
/// in it goes to the end of its line.
pub(super) fn is_long(text: &str) -> bool {
    let rows = body(text).split_once('\n');
    let has_several = |(head, rest): (&str, &str)| is_empty(head) || !is_empty(rest);
    rows.is_some_and(has_several) || text.contains("//")
}

/// Whether a comment in a table goes over several lines, or up to its bracket.
fn has_long_comment(text: &str) -> bool {
    let mut rest = text;
    while let Some(at) = rest.find('/') {
        rest = &rest[at + 1..];
        let length = match rest.as_bytes().first() {
            Some(b'/') => rest.find('\n'),
            Some(b'*') => {
                let end = rest[1..].find("*/").map(|end| end + 3);
                if end.is_none_or(|end| rest[..end].contains('\n')) {
                    return true;
                }
                end
            }
            _ => Some(0),
        };
        rest = &rest[length.unwrap_or(rest.len())..];
    }
    false
}

/// Puts a table; `after` columns stand behind it. One with such a comment is kept to the letter.
pub(super) fn put(text: &str, out: &mut Out, after: usize) {
    if has_long_comment(text) {
        return out.comment(text);
    }
    if is_long(text) {
        return rows(body(text), out);
    }
    let flat = flat(text);
    let width = flat.chars().count();
    let column = if out.fresh { out.indent } else { out.column };
    if column + width + after <= WIDTH || flat.contains('/') {
        out.put(&flat, width);
    } else {
        rows(&wrapped(body(&flat), WIDTH - STEP - out.indent.min(WIDTH / 2)), out);
    }
}

/// One row as several, divided at wide gaps if there are any.
fn wrapped(row: &str, width: usize) -> String {
    let wide = if cells(row).any(|cell| cell.gap > 1) { 2 } else { 1 };
    let (mut text, mut line, mut group) = (String::from("\n"), 0, String::new());
    let mut close = |group: &mut String, gap: usize| {
        if line > 0 && line + gap + group.len() > width {
            text.push('\n');
            line = 0;
        }
        let gap = if line > 0 { gap } else { 0 };
        text.extend(std::iter::repeat_n(' ', gap));
        text.push_str(group);
        line += gap + group.len();
        group.clear();
    };
    let mut gap_before = 0;
    for cell in cells(row) {
        if cell.gap >= wide && !group.is_empty() {
            close(&mut group, gap_before);
            gap_before = cell.gap;
        } else if !group.is_empty() {
            group.extend(std::iter::repeat_n(' ', cell.gap));
        }
        group.push_str(cell.text);
    }
    close(&mut group, gap_before);
    text.push('\n');
    text
}

/// Puts the rows of a table and its brackets.
fn rows(body: &str, out: &mut Out) {
    let base = out.indent;
    let (head, rest) = body.split_once('\n').unwrap_or((body, ""));
    let hangs = !is_empty(head);
    out.put("#[", 2);
    let indent = if hangs { out.column + 1 } else { base + STEP };
    let columns = columns(body).filter(|columns| {
        let sum: usize = columns.iter().map(|it| it.left + it.right + it.least_gap).sum();
        indent + sum <= WIDTH
    });
    let mut blank = false;
    if hangs {
        out.blanks(1);
        row(head, columns.as_deref(), out);
    }
    let mut any = hangs;
    for line in rest.split('\n') {
        if is_empty(line) {
            blank = any;
            continue;
        }
        if std::mem::take(&mut blank) {
            out.blank_line();
        }
        out.newline(indent);
        row(line, columns.as_deref(), out);
        any = true;
    }
    // A comment at the end would swallow the bracket.
    let commented =
        body.rsplit('\n').find(|line| !is_empty(line)).is_some_and(|line| line.contains('/'));
    if hangs && !commented {
        out.blanks(1);
    } else {
        out.newline(base);
    }
    out.put("]", 1);
}

fn row(line: &str, columns: Option<&[Column]>, out: &mut Out) {
    if line.contains('/') {
        let line = line.trim();
        return out.put(line, line.chars().count());
    }
    let (mut behind, mut first) = (0, true);
    for (i, cell) in cells(line).enumerate() {
        let (before, after) = match columns.map(|columns| &columns[i]) {
            Some(column) => {
                let right = cell.text.len() - cell.left;
                let gap = if first { 0 } else { column.least_gap };
                (gap + column.left - cell.left, column.right - right)
            }
            None => (if first { 0 } else { cell.gap }, 0),
        };
        out.put("", 0);
        out.blanks(behind + before);
        out.put(cell.text, cell.text.len());
        (behind, first) = (after, false);
    }
}

/// The columns of a table; none if there are comments in it.
///
/// Where points are below each other already, the gap between two columns is what is between their
/// widest numbers; else it is the least in a row.
fn columns(body: &str) -> Option<Vec<Column>> {
    let mut columns: Vec<Column> = vec![];
    if body.contains('/') {
        return None;
    }
    for line in body.split('\n') {
        let (mut end, mut origin) = (0_isize, 0_isize);
        for (i, cell) in cells(line).enumerate() {
            let [gap, left, length] =
                [cell.gap, cell.left, cell.text.len()].map(usize::cast_signed);
            let start = if i == 0 { 0 } else { end + gap };
            origin = if i == 0 { left } else { origin };
            end = start + length;
            let right = cell.text.len() - cell.left;
            let (start, end, point) = (start - origin, end - origin, start + left - origin);
            match columns.get_mut(i) {
                Some(column) => {
                    column.left = column.left.max(cell.left);
                    column.right = column.right.max(right);
                    column.point = column.point.filter(|at| *at == point);
                    column.first_start = column.first_start.min(start);
                    column.last_end = column.last_end.max(end);
                    column.least_gap = column.least_gap.min(cell.gap);
                }
                None => columns.push(Column {
                    left: cell.left,
                    right,
                    point: Some(point),
                    first_start: start,
                    last_end: end,
                    least_gap: cell.gap,
                }),
            }
        }
    }
    if columns.iter().all(|column| column.point.is_some()) {
        for i in 1..columns.len() {
            let gap = columns[i].first_start - columns[i - 1].last_end;
            columns[i].least_gap = usize::try_from(gap).unwrap_or(1).max(1);
        }
    }
    Some(columns)
}
