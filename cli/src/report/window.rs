//! The lines about some places of a text, long lines cut: a file may be one line of ten megabytes.

use std::ops::Range;

/// Lines longer than this are cut, bytes.
const LONG: usize = 400;
/// What is kept on either side of a place, bytes.
const AROUND: usize = 200;
/// Lines of a place that spans many.
const LINES: usize = 6;
/// Lines between two places that are still shown together.
const TOGETHER: usize = 20;
/// How far from a place the ends of its line are looked for, bytes.
const FAR: usize = 1 << 16;
/// Stands where something was cut.
const CUT: &str = "…";

/// A part of a text, with places in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Window {
    /// The lines, each at most about `LONG` bytes.
    pub(super) text: String,
    /// Where its first line starts in the whole text.
    pub(super) start: usize,
    /// Whether the front of a line is missing, so that its columns are not those of the file.
    pub(super) cut: bool,
    /// The places, as bytes of `text`.
    pub(super) spans: Vec<Range<usize>>,
}

/// What was kept of a line.
struct Piece {
    from: Range<usize>,
    to: usize,
}

impl Window {
    /// The lines about these places; `None` when they lie too far apart. Places are clipped to the
    /// text and to their first lines.
    pub(super) fn new(text: &str, spans: &[Range<usize>]) -> Option<Self> {
        let spans: Vec<_> = spans.iter().map(|span| clip(text, span)).collect();
        let first = spans.iter().map(|span| span.start).min()?;
        let last = spans.iter().map(|span| span.end).max()?;
        let start = line_start(text, first);
        let end = line_end(text, last);
        let lines: Vec<&str> = text[start..end].split('\n').take(TOGETHER + 2).collect();
        if lines.len() > TOGETHER {
            return None;
        }
        let mut window = Self { text: String::new(), start, cut: false, spans: vec![] };
        let mut pieces = vec![];
        let mut at = start;
        for line in lines {
            let piece = window.add(at, line, &spans);
            pieces.push(piece);
            at += line.len() + 1;
        }
        let place = |byte: usize| {
            let piece = pieces.iter().rfind(|piece| piece.from.start <= byte || piece.to == 0);
            piece.map_or(0, |Piece { from, to }| to + byte.clamp(from.start, from.end) - from.start)
        };
        window.spans = spans.iter().map(|span| place(span.start)..place(span.end)).collect();
        Some(window)
    }

    /// Adds a line, or what lies about the first place in it.
    fn add(&mut self, at: usize, line: &str, spans: &[Range<usize>]) -> Piece {
        if at != self.start {
            self.text.push('\n');
        }
        let mut kept = 0..line.len();
        if line.len() > LONG {
            let here = spans.iter().find(|span| span.start <= at + line.len() && span.end >= at);
            let middle = here.map_or(0, |span| span.start.saturating_sub(at));
            kept.start = boundary(line, middle.saturating_sub(AROUND));
            kept.end = boundary(line, (middle + AROUND).min(line.len()));
        }
        self.cut |= kept.start > 0;
        self.text.push_str(if kept.start > 0 { CUT } else { "" });
        let to = self.text.len();
        self.text.push_str(&line[kept.clone()]);
        self.text.push_str(if kept.end < line.len() { CUT } else { "" });
        Piece { from: at + kept.start..at + kept.end, to }
    }
}

fn clip(text: &str, span: &Range<usize>) -> Range<usize> {
    let start = boundary(text, span.start);
    let end = boundary(text, span.end.min(start + FAR)).max(start);
    let most = text[start..end].match_indices('\n').nth(LINES - 1);
    start..most.map_or(end, |(at, _)| end.min(start + at))
}

/// The character boundary at or before a byte.
fn boundary(text: &str, byte: usize) -> usize {
    let mut at = byte.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn line_start(text: &str, at: usize) -> usize {
    let far = boundary(text, at.saturating_sub(FAR));
    text[far..at].rfind('\n').map_or(far, |before| far + before + 1)
}

fn line_end(text: &str, at: usize) -> usize {
    let far = boundary(text, at + FAR);
    text[at..far].find('\n').map_or(far, |after| at + after)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(text: &str, place: Range<usize>) -> Window {
        Window::new(text, std::slice::from_ref(&place)).unwrap()
    }

    #[test]
    fn a_window_holds_the_lines_of_its_places() {
        let text = "one\ntwo three\nfour\nfive";
        let window = Window::new(text, &[8..13, 14..18]).unwrap();
        assert_eq!(window.text, "two three\nfour");
        assert_eq!(
            window.spans.iter().map(|s| &window.text[s.clone()]).collect::<Vec<_>>(),
            ["three", "four"]
        );
        assert_eq!(window.start, 4);
    }

    #[test]
    fn a_line_of_ten_megabytes_is_cut_about_its_place() {
        let mut text = "é".repeat(5_000_000);
        text.push_str(" radus = 5 ");
        let at = text.find("radus").unwrap();
        text.push_str(&"漢".repeat(1_000_000));
        let window = about(&text, at..at + 5);
        assert!(window.text.len() <= LONG + 2 * CUT.len(), "{}", window.text.len());
        assert_eq!(&window.text[window.spans[0].clone()], "radus");
        assert!(window.text.starts_with(CUT) && window.text.ends_with(CUT));
    }

    #[test]
    fn places_far_apart_do_not_share_a_window_and_long_ones_are_clipped() {
        let text = "x\n".repeat(100);
        assert_eq!(Window::new(&text, &[0..1, 150..151]), None);
        let window = about(&text, 0..200);
        assert_eq!(window.text.lines().count(), LINES);
    }

    #[test]
    fn empty_texts_and_places_past_the_end_are_shown_as_the_end() {
        assert_eq!(about("", 0..9).spans[0], 0..0);
        let window = about("é", 1..99);
        assert_eq!((window.text.as_str(), window.spans[0].clone()), ("é", 0..2));
        assert_eq!(about("a\n", 2..2).spans[0], 0..0);
    }
}
