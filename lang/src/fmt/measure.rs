//! How wide pieces are, and which of them cannot share a line with others.

use super::piece::{Kind, Piece};
use super::table;

/// A bracket that is not yet closed.
struct Opened {
    at: usize,
    /// Lines before it.
    lines: u32,
    /// Statements or fields in it.
    starts: u32,
    /// Those among them that are no fields.
    others: u32,
}

/// Fills in what pieces are among each other.
pub(super) fn measure(pieces: &mut [Piece<'_>]) {
    brackets(pieces);
    let (mut at, mut hard) = (0, 0);
    let mut significant: Option<usize> = None;
    for i in 0..pieces.len() {
        let kept = breaks_line(pieces, i, significant);
        let gap = if i == 0 { 0 } else { gap(pieces, i) };
        let piece = &mut pieces[i];
        piece.kept = kept;
        piece.gap = gap;
        piece.at = at + u32::from(gap);
        piece.hard = hard + u32::from(kept);
        piece.width = width(piece);
        at = piece.at + piece.width;
        hard = piece.hard + u32::from(piece.is_long() || piece.broken);
        if !piece.is_comment() {
            significant = Some(i);
        }
    }
}

/// Joins brackets, and finds those which are to be broken.
fn brackets(pieces: &mut [Piece<'_>]) {
    let mut open: Vec<Opened> = vec![];
    let mut lines = 0;
    let mut last = Kind::Comma;
    for i in 0..pieces.len() {
        let piece = &pieces[i];
        lines += u32::from(piece.newlines);
        if let Some(inner) = open.last_mut() {
            let begins = matches!(last, Kind::Open | Kind::Comma) && piece.kind != Kind::Close;
            let ends_line = matches!(piece.kind, Kind::Line | Kind::Doc);
            let mut comments = pieces[..i].iter().rev().take_while(|it| it.is_comment());
            let own = piece.kind == Kind::Close && comments.any(|it| it.newlines > 0);
            let (newline, bracket) = (own || ends_line || piece.newlines > 0 && begins, inner.at);
            inner.starts += u32::from(piece.starts);
            inner.others += u32::from(piece.starts);
            let field = piece.kind == Kind::Assign && pieces[i - 1].starts;
            inner.others -= u32::from(field && inner.others > 0);
            pieces[bracket].broken |= newline && pieces[bracket].text != "{";
        }
        let piece = &pieces[i];
        if piece.is_long() {
            lines += 1;
        }
        match piece.kind {
            Kind::Open => open.push(Opened { at: i, lines, starts: 0, others: 0 }),
            Kind::Close => {
                if let Some(inner) = open.pop() {
                    close(pieces, i, &inner, lines);
                }
            }
            _ => {}
        }
        if !pieces[i].is_comment() {
            last = pieces[i].kind;
        }
    }
}

fn close(pieces: &mut [Piece<'_>], at: usize, inner: &Opened, lines: u32) {
    let place = |at| u32::try_from(at).expect("a file has fewer bytes than that");
    pieces[at].mate = place(inner.at);
    let open = &mut pieces[inner.at];
    open.mate = place(at);
    if open.text == "{" && at > inner.at + 1 {
        let several = inner.starts > 1 && inner.others > 0;
        open.broken = lines > inner.lines || several;
    }
}

/// Whether the line break that its author put before the piece is kept within an expression.
fn breaks_line(pieces: &[Piece<'_>], i: usize, before: Option<usize>) -> bool {
    let piece = &pieces[i];
    // Behind the comma of a vector of one the bracket follows.
    if piece.newlines == 0 || piece.starts || piece.kind == Kind::Close {
        return false;
    }
    let Some(before) = before.map(|at| &pieces[at]) else { return false };
    let after = matches!(
        before.kind,
        Kind::Binary(_)
            | Kind::Range(_)
            | Kind::Assign
            | Kind::Arrow
            | Kind::PlusMinus
            | Kind::Comma
    );
    after || ["else", "with", "where"].iter().any(|word| piece.is_keyword(word))
}

fn width(piece: &Piece<'_>) -> u32 {
    let columns = match piece.kind {
        Kind::Table => table::flat(piece.text).len(),
        Kind::Separator => 1,
        _ if piece.text.is_ascii() => piece.text.len(),
        _ => piece.text.chars().count(),
    };
    u32::try_from(columns).expect("a file has fewer bytes than that")
}

/// Blanks between a piece and the one before where both are on one line.
fn gap(pieces: &[Piece<'_>], i: usize) -> u8 {
    let (before, piece) = (&pieces[i - 1], &pieces[i]);
    let tight = match (before.kind, piece.kind) {
        (_, Kind::Comma | Kind::Pair | Kind::Separator | Kind::Colon) => true,
        _ if before.is_comment() || piece.is_comment() => false,
        // `0.. .5`: three points are no range.
        (Kind::Range(_), Kind::Number) if piece.text.starts_with('.') => false,
        // `m^2..` would be a number that goes on.
        (Kind::Unit, Kind::Range(_)) => !before.text.ends_with(|c: char| c.is_ascii_digit()),
        (Kind::Open, Kind::Close) => true,
        (Kind::Open, _) => before.text != "{",
        (_, Kind::Close) => piece.text != "}",
        // `- 1` in a list is an expression, `-1` a number; `a .b` is a member of a value, `a.b` a path.
        (Kind::Prefix, Kind::Number) | (Kind::Word, Kind::Dot) => {
            piece.blanks == 0 && piece.newlines == 0
        }
        (Kind::Dot | Kind::At | Kind::Range(_) | Kind::Prefix, _)
        | (_, Kind::Dot | Kind::Range(_)) => true,
        // A call or an index.
        (_, Kind::Open) => piece.text != "{" && before.ends_operand(),
        _ => false,
    };
    u8::from(!tight)
}
