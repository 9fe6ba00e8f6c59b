//! Braces that never close: where they most likely do, by how far lines are indented.

use std::ops::Range;

use super::edits::{Edits, Mended};
use super::fault::mend;
use super::lex::{TokenKind, tokens};
use super::recover::fault;
use crate::prescan::{Fault, is_one, scan, scan_until};

/// Bytes of a statement that are looked at for where its braces most likely close.
const MOST: usize = 1 << 24;

/// Bytes behind a block whose lines do not tell where it ends, in which those of blocks in it are looked at.
const UNTOLD: usize = 1 << 18;

/// How a statement most likely ends in which braces never close.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Closing {
    /// Which braces, and before which byte each closes; these bytes are in order.
    pub(super) braces: Vec<(usize, usize)>,
    /// Where the next statement begins, if there is one.
    pub(super) end: Option<usize>,
}

/// A bracket that is open.
struct Open {
    at: usize,
    bracket: u8,
    /// How far the line is indented on which it stands.
    indent: usize,
    /// Whether lines tell where it ends, once its first content has been met: that stands on its own line or is
    /// indented further.
    tells_end: Option<bool>,
    /// Whether it begins what is chosen by an `if`.
    is_choice: bool,
}

impl Open {
    /// Whether a line that is indented so far and closes a block closes another one.
    fn is_right_of(&self, indent: usize) -> bool {
        self.bracket == b'{' && self.indent > indent
    }

    /// Whether a line that is indented so far stands behind the block.
    fn ends_before(&mut self, indent: usize) -> bool {
        let tells = *self.tells_end.get_or_insert(indent > self.indent);
        self.bracket == b'{' && tells && indent <= self.indent
    }

    /// Whether its lines do not tell where it ends, and it is as long as that at this byte.
    fn is_untold(&self, at: usize) -> bool {
        self.tells_end == Some(false) && at - self.at > UNTOLD
    }

    /// A line can only stand in the block, however far it is indented: it does not end.
    fn goes_on(&mut self) -> bool {
        self.tells_end = Some(true);
        false
    }
}

/// How the statement that begins at `start` most likely closes; `None` if its lines do not tell.
///
/// A block whose lines are indented ends before the first line that is indented no more than that of its
/// brace, or with the text; one that an `if` begins, before its `else`.
pub(super) fn closing(text: &str, start: usize, limit: usize) -> Option<Closing> {
    let mut braces = braces(text, start, limit)?;
    let closed = closed_by(&text[start..], [start, start], &braces);
    let next = scan_until(&closed.text, 0..closed.text.len(), 0, limit, &mut |at| at > 0).met;
    let end = next.map(|next| closed.edits.written(next..next).start);
    // What opens behind it is another statement's.
    braces.retain(|(open, _)| end.is_none_or(|end| *open < end));
    Some(Closing { braces, end })
}

/// A piece with the braces that never close in it closed, or without the brackets that close nothing and with
/// others for those that close another one, if nothing else is wrong with its brackets; it begins at byte
/// `base` of its text.
pub(super) fn closed(piece: &str, base: usize, limit: usize) -> Option<Mended> {
    let faults = scan(piece, 0..piece.len(), 0, limit).faults;
    let is_open = |fault: &Fault| matches!(fault, Fault::Unclosed { .. });
    let mends = faults.iter().map(|fault| mend(piece, fault)).collect::<Option<Vec<_>>>();
    let (mended, is_sure) = if let Some(mut mends) = mends.filter(|some| !some.is_empty()) {
        mends.sort_by_key(|(at, _)| at.start);
        let are_apart = mends.is_sorted_by(|(one, _), (next, _)| one.end <= next.start);
        (are_apart.then(|| rewritten(piece, base, &mends))?, false)
    } else if faults.iter().all(is_open) {
        (closed_by(piece, [0, base], &braces(piece, 0, limit)?), true)
    } else {
        return None;
    };
    // Where a bracket closes nothing, that which opens may be what is missing.
    (is_one(&mended.text, limit) && (is_sure || fault(&mended.text).is_none())).then_some(mended)
}

/// Which braces close before which byte; `None` if none does so, a block is open at the end whose lines do not
/// tell, so many brackets are open, or it is too long to be looked at.
fn braces(text: &str, start: usize, limit: usize) -> Option<Vec<(usize, usize)>> {
    let line = |at: usize| text[..at].rfind('\n').map_or(0, |end| end + 1);
    let mut current = line(start);
    let mut indent = indent(&text[current..]);
    let (mut open, mut braces): (Vec<Open>, _) = (vec![], vec![]);
    let (mut is_choice, mut ends_block) = (false, false);
    for token in tokens(text, start..text.len()) {
        let is_untold = open.first().is_some_and(|first| first.is_untold(token.start));
        if token.start - start > MOST || is_untold {
            return None;
        }
        let mark = match token.text.as_bytes() {
            [mark] if token.kind == TokenKind::Mark => Some(*mark),
            _ => None,
        };
        let begun = Some(token).filter(|token| token.first_on_line).map(|it| line(it.start));
        let blank = |begun: &usize| text[*begun..token.start].trim().is_empty();
        current = begun.unwrap_or(current);
        if let Some(begun) = begun.filter(blank) {
            indent = token.start - begun;
            let ended = ended(&mut open, indent, &text[token.start..], token.text);
            braces.extend(ended.into_iter().map(|at| (at, begun)));
            if open.is_empty() && !braces.is_empty() {
                return Some(braces);
            }
        } else if let Some(open) = open.last_mut() {
            // What stands on the line of its brace.
            open.tells_end.get_or_insert(true);
        }
        if token.text == "else" && !ends_block {
            braces.extend(open.pop_if(|last| last.is_choice).map(|block| (block.at, token.start)));
        }
        ends_block = mark == Some(b'}');
        is_choice |= token.text == "if";
        match mark {
            Some(bracket @ (b'(' | b'[' | b'{')) => {
                if open.len() >= limit {
                    return None;
                }
                let is_choice = bracket == b'{' && std::mem::take(&mut is_choice);
                open.push(Open { at: token.start, bracket, indent, tells_end: None, is_choice });
            }
            Some(bracket @ (b')' | b']' | b'}')) => close(&mut open, bracket, current),
            _ => {}
        }
    }
    for block in open.iter().rev() {
        if block.bracket != b'{' || block.tells_end != Some(true) {
            return None;
        }
        braces.push((block.at, text.len()));
    }
    (!braces.is_empty()).then_some(braces)
}

/// The blocks that end before a line that is indented so far, by where they open: they are open no more.
fn ended(open: &mut Vec<Open>, indent: usize, line: &str, first: &str) -> Vec<usize> {
    let is_field = is_field(line);
    let (mut n_open, mut ended) = (open.len(), vec![]);
    while let Some(last) = open.last_mut() {
        let ends = match first {
            ")" | "]" => false,
            "}" => last.is_right_of(indent),
            // Fields stand in no file.
            _ if is_field && n_open == 1 => last.goes_on(),
            _ => last.ends_before(indent),
        };
        let Some(block) = open.pop_if(|_| ends) else { break };
        ended.push(block.at);
        n_open -= 1;
    }
    ended
}

/// Closes what a bracket on the line from byte `line` on closes. One of another kind leaves those inside it open,
/// or stands for one that opened on its line.
fn close(open: &mut Vec<Open>, bracket: u8, line: usize) {
    let opens =
        |open: &Open| matches!((open.bracket, bracket), (b'(', b')') | (b'[', b']') | (b'{', b'}'));
    let stands = |open: &[Open]| open.last().is_some_and(|last| last.at >= line);
    let end = open.iter().rposition(opens);
    let end = end.unwrap_or_else(|| open.len() - usize::from(stands(open)));
    open.truncate(end);
}

/// Whether a value is given to a name there, which no statement of a file does.
pub(super) fn is_field(line: &str) -> bool {
    let rest = line.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
    let is_given = |rest: &str| rest.starts_with('=') && !rest.starts_with("==");
    rest.len() < line.len() && is_given(rest.trim_start_matches([' ', '\t']))
}

/// How many blanks a line begins with.
pub(super) fn indent(line: &str) -> usize {
    line.len() - line.trim_start_matches([' ', '\t']).len()
}

/// A part of a text, which begins at byte `start` of it and `base` of what was written, with braces that
/// close before these bytes.
fn closed_by(part: &str, [start, base]: [usize; 2], braces: &[(usize, usize)]) -> Mended {
    let mut text = String::with_capacity(part.len() + 3 * braces.len());
    let mut edits = Edits::new(base);
    let mut done = 0;
    for line in braces.chunk_by(|(_, one), (_, other)| one == other) {
        let at = line[0].1 - start;
        text.push_str(&part[done..at]);
        let from = text.len();
        // A remark at the end goes on to the end of its line.
        text.push_str(if at == part.len() { "\n" } else { "" });
        text.push_str(&"}".repeat(line.len()));
        text.push('\n');
        edits.replace(at..at, from..text.len());
        done = at;
    }
    text.push_str(&part[done..]);
    Mended { text, edits }
}

/// A piece some of whose bytes became others, in order; it begins at byte `base` of its text.
pub(super) fn rewritten(piece: &str, base: usize, mends: &[(Range<usize>, &str)]) -> Mended {
    let (mut text, mut edits) = (String::with_capacity(piece.len()), Edits::new(base));
    let mut done = 0;
    for (old, new) in mends {
        text.push_str(&piece[done..old.start]);
        let start = text.len();
        text.push_str(new);
        edits.replace(old.clone(), start..text.len());
        done = old.end;
    }
    text.push_str(&piece[done..]);
    Mended { text, edits }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text with its braces closed, and what stands behind the statement.
    fn ended(text: &str) -> Option<(String, &str)> {
        let Closing { braces, end } = closing(text, 0, 100)?;
        Some((closed_by(text, [0, 0], &braces).text, end.map_or("", |end| &text[end..])))
    }

    #[test]
    fn a_block_ends_before_the_first_line_that_is_indented_no_more_than_its_own() {
        let (group, ball) = ("group {\n", "  shape ball {\n    r = 1\n");
        let cases = [
            (
                format!("{group}{ball}  shape\n}}\nlet a\n"),
                format!("{group}{ball}}}\n  shape\n}}\nlet a\n"),
                "let a\n",
            ),
            (format!("{group}{ball}  }}\nlet a"), format!("{group}{ball}  }}\n}}\nlet a"), "let a"),
            (format!("{group}{ball}let a"), format!("{group}{ball}}}}}\nlet a"), "let a"),
            (format!("{group}{ball}  // b"), format!("{group}{ball}  // b\n}}}}\n"), ""),
            // Lines in brackets may be indented as they like.
            (
                format!("{group}  c = [\n1,\n2]\nlet b"),
                format!("{group}  c = [\n1,\n2]\n}}\nlet b"),
                "let b",
            ),
        ];
        for (text, wanted, rest) in &cases {
            assert_eq!(ended(text), Some((wanted.clone(), *rest)), "{text}");
        }
    }

    #[test]
    fn lines_that_are_not_indented_tell_nothing() {
        for text in [
            "group {\nshape ball {\nr = 1\n}\nlet a",
            "group {",
            "group { a = (",
            "group { a {\n b = [\n",
        ] {
            assert_eq!(ended(text), None, "{text}");
        }
    }

    #[test]
    fn a_block_whose_lines_tell_nothing_is_not_looked_through_for_long() {
        let text = |n: usize| {
            let ball = "shape ball {\n  r = 1\nlet a = 1\n";
            format!("group {{\n{ball}{}}}\nlet b", "let c = 1\n".repeat(n))
        };
        let (short, long) = (text(10), text(UNTOLD / 10 + 10));
        assert_eq!(ended(&short).map(|(_, rest)| rest), Some("let b"));
        assert_eq!(ended(&long), None);
    }

    #[test]
    fn a_piece_in_which_more_is_wrong_with_brackets_is_not_closed() {
        let closes = |piece: &str| closed(piece, 7, 100).is_some();
        assert!(closes("group {\n  a = 1\n"));
        assert!(closes("let a = 1\n}\n") && !closes("group a = 1\n}\n"));
        for piece in [
            "group {\n  a = 1 }\n",
            "group {\n  a = (1]\n",
            "group {\n  a = \"b\n",
            "group {\n  a = (1\n",
        ] {
            assert!(!closes(piece), "{piece}");
        }
    }
}
