//! Mistakes that stand so near to one another that they are one.

use luxel_core::diag::{Diagnostic, Fix, Grade, Sources, Span};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Unit;

use super::line_of;
use crate::eval::BARE;
use crate::syntax::{QUOTED, tokens};
use crate::words::BEFORE_NAMES;

/// Tokens that stand between two mistakes of one slip at most.
const TOKENS: usize = 3;
/// Bytes between two mistakes that are looked at.
const BYTES: usize = 200;

/// Bytes between two brackets on one line that are looked at.
const LINE: usize = 1000;

/// What is told where something cannot be read.
const UNREAD: [&str; 9] =
    ["E0009", "E0010", "E0012", "E0013", "E0014", "E0015", "E0016", "E0017", "E0023"];

/// Takes out what is told next to something that cannot be read, unless how that is mended is sure; of two
/// such beside one another, the second. A sure mend beside which something else cannot be read is none.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let counts = |found: &Diagnostic| found.is_error() || found.code == "E0114";
    let errors = diagnostics.iter().enumerate().filter(|(_, found)| counts(found));
    let mut all: Vec<(Span, usize)> =
        errors.filter_map(|(i, found)| Some((found.span()?, i))).collect();
    all.sort_unstable();
    let mut is_out = vec![false; diagnostics.len()];
    let mut unsure = vec![];
    for pair in all.windows(2) {
        let [(before, i), (span, j)] = pair else { continue };
        if closes_what(&diagnostics[*i], &diagnostics[*j], sources) {
            if let Some(call) = call(&diagnostics[*i], &diagnostics[*j], sources) {
                for fix in &mut diagnostics[*i].fixes {
                    (fix.replacement, fix.grade) = (call.clone(), Grade::Guess);
                }
            }
            let out = if opens(&diagnostics[*i]) { *j } else { *i };
            is_out[out] = true;
            continue;
        }
        if is_swallowed(&diagnostics[*i], &diagnostics[*j], sources) {
            is_out[*i] = true;
            continue;
        }
        if is_within(&diagnostics[*i], &diagnostics[*j], sources) {
            is_out[*j] = true;
            if diagnostics[*i].code == "E0008" && is_alike(*before, *span, sources) {
                let again = Fix { span: *span, replacement: String::new(), grade: Grade::Guess };
                diagnostics[*i].fixes = vec![again];
            }
            continue;
        }
        let n = tokens_between(*before, *span, sources);
        let Some(n) = n.or_else(|| is_cut(*before, *span, sources).then_some(TOKENS)) else {
            continue;
        };
        let (first, second) = (&diagnostics[*i], &diagnostics[*j]);
        let is_sure = first.sure().is_some() && second.sure().is_some();
        let are_unread = is_unread(first) && is_unread(second) && !is_sure;
        if are_unread && (first.code, second.code) != ("E0016", "E0014") {
            is_out[*j] = true;
            unsure.push(*i);
        } else if follows(second, first, n, sources) {
            is_out[*j] = true;
        } else if follows(first, second, n, sources) {
            is_out[*i] = true;
        }
    }
    for i in unsure {
        diagnostics[i].fixes.iter_mut().for_each(|fix| fix.grade = Grade::Guess);
    }
    let mut is_out = is_out.into_iter();
    diagnostics.retain(|_| !is_out.next().unwrap_or_default());
}

/// Whether something cannot be read where it is told, and not far away.
pub(super) fn is_unread(found: &Diagnostic) -> bool {
    found.is_error() && UNREAD.contains(&found.code)
}

/// Whether something is said only because of something else, so many tokens away.
fn follows(found: &Diagnostic, cause: &Diagnostic, n: usize, sources: &Sources) -> bool {
    let word = || found.span().and_then(|at| sources.text(at.source).get(at.range()));
    let is_unit = || word().is_some_and(|word| Unit::named(word).is_some());
    let is_category = || word().is_some_and(|word| Kind::of_word(word).is_some());
    let is_unsure = found.sure().is_none() && cause.sure().is_none();
    match (found.code, cause.code) {
        // A unit's own name is unknown only because the rest of it is.
        ("E0101", "E0101" | "E0204" | "E0214" | "E0014" | "E0016" | "E0023") if is_unit() => true,
        ("E0101", "E0023") if is_category() => true,
        // `radius = 6 material m = gold`
        ("E0402", "E0204") => n == 0 && is_unit(),
        // `material = radius`, and on the next line `gold = 1 m`
        ("E0402", "E0101") => n == 0 && found.sure().is_none(),
        // `scene let`, and below it `1 gold = metal("Au")`
        ("E0023", "E0001") => n <= 1 && found.sure().is_none(),
        // `material diffuse { { reflectance = 1 }`
        ("E0403", "E0008") => n <= 1,
        // `wall((1, 0, 0) (0, 0, 1), c)`
        ("E0403", "E0214") => cause.fixes.iter().any(|fix| fix.replacement == ","),
        // `chance(3 b)`, and `shape: sphere { radius = 1 m }` in a file
        ("E0403", "E0204") | ("E0017", "E0113") => true,
        // `[for for i in 0..3 => i]`, `(2 *q a, 3)`, `[0, 1. 2]`, `f(1. i)`, `rgb.srgb rgb.srgb(1, 1, 1)`
        // `group box "a" {`, and `move(x) cmshape`, below which `cone {` stands
        // and `assert a < 8 cm"too large",`
        ("E0014", "E0019" | "E0016" | "E0023")
        | ("E0204", "E0016")
        | ("E0114", "E0014" | "E0214")
        | ("E0401", "E0401" | "E0204") => n == 0,
        ("E0014", "E0101") => n == 0 && cause.sure().is_none(),
        // `spectrum = scale`, and on the next line `plain = glow`; and `place box ball {`
        ("E0402", "E0214") | ("E0401", "E0101") => n == 0 && is_unsure,
        ("E0101", "E0012" | "E0013" | "E0014" | "E0015" | "E0016" | "E0017" | "E0023") => {
            n == 0 && is_unsure
        }
        ("E0401", "E0019" | "E0023") => found.sure().is_none(),
        // `"flat" = smooth`
        ("E0214" | "E0416", "E0023") if cause.message == QUOTED => true,
        // `ring(30 ,mm i)`, and `let = ball wide(1 m)`
        ("E0201", "E0012") | ("E0114", "E0019") => n <= 2,
        // `f[3)`
        ("E0214", "E0009") => is_unsure && touches(found, cause),
        // Vectors in which several numbers have a unit already, `(30 cm - 45) cm`, and `wall(-275, 275, 0)`.
        ("E0203", "E0203") => {
            let is_of_unit = n <= 1 && cause.message.starts_with(BARE);
            let is_one = found.message == cause.message || is_of_unit || holds(found, cause);
            found.sure().is_none() && is_one
        }
        ("E0214", "E0214") => found.sure().is_none() && found.message == cause.message,
        // `reach(bk ,)`
        ("E0403", "E0101") => is_unsure && holds(found, cause),
        (code, "E0012" | "E0013" | "E0014" | "E0015" | "E0016" | "E0017" | "E0023") => {
            is_unsure && ["E01", "E02", "E04"].iter().any(|group| code.starts_with(group))
        }
        _ => false,
    }
}

/// Whether what cannot be read is a part of something before it that cannot be read either: a line below a
/// definition that is indented further, a brace in one that does not close, or what stands where such a one may end.
fn is_within(cause: &Diagnostic, found: &Diagnostic, sources: &Sources) -> bool {
    let (Some(before), Some(at)) = (cause.span(), found.span()) else { return false };
    if !is_unread(found) || found.sure().is_some() || before.source != at.source {
        return false;
    }
    let text = sources.text(at.source);
    if cause.code == "E0008" && found.code == "E0023" {
        let end = cause.labels.get(1).map(|label| label.span);
        let is_end = end.and_then(|end| tokens_between(end, at, sources)).is_some_and(|n| n <= 1);
        return is_end
            || is_alike(before, at, sources) && line_of(before, sources) == line_of(at, sources);
    }
    let is_opened_there = found.labels.get(1).is_some_and(|open| open.span == before);
    if found.code == "E0009" && is_unread(cause) && is_opened_there {
        return true;
    }
    let is_below = || {
        let between = text.get(before.range().end..line_of(at, sources)).unwrap_or_default();
        let is_next =
            !between.is_empty() && between.len() <= LINE && !between.trim_end().contains('\n');
        let line = text.get(line_of(before, sources)..).unwrap_or_default().trim_start();
        let defines = BEFORE_NAMES.iter().any(|word| line.starts_with(word));
        is_next && defines && indent(text, before, sources) < indent(text, at, sources)
    };
    let is_open = || {
        text.get(before.range().end..).is_some_and(|behind| {
            behind.lines().next().is_some_and(|line| line.trim_end().ends_with('='))
        })
    };
    let is_header = cause.code == "E0019" || is_unread(cause) && cause.sure().is_some();
    (is_unread(cause) && cause.sure().is_none() || is_header && is_open()) && is_below()
}

/// Whether the same is written in two places.
fn is_alike(one: Span, other: Span, sources: &Sources) -> bool {
    let written = |at: Span| sources.text(at.source).get(at.range());
    written(one) == written(other)
}

/// Whether the bracket that closes an open one stands in a text behind it on its line that does not end.
fn is_swallowed(open: &Diagnostic, text: &Diagnostic, sources: &Sources) -> bool {
    let (Some(before), Some(at)) = (open.span(), text.span()) else { return false };
    let is_line = before.source == at.source && line_of(before, sources) == line_of(at, sources);
    (open.code, text.code) == ("E0008", "E0005") && is_line
}

/// Bytes before the first word of the line of a place.
fn indent(text: &str, at: Span, sources: &Sources) -> usize {
    let line = text.get(line_of(at, sources)..).unwrap_or_default();
    line.len() - line.trim_start_matches([' ', '\t']).len()
}

/// Whether what is told holds something else that is.
fn holds(found: &Diagnostic, other: &Diagnostic) -> bool {
    let (Some(outer), Some(inner)) = (found.span(), other.span()) else { return false };
    outer != inner && outer.start <= inner.start && inner.end <= outer.end
}

/// Whether a bracket that another one closes opens right behind something that is told.
fn touches(found: &Diagnostic, cause: &Diagnostic) -> bool {
    let end = found.span().map(|span| (span.source, span.end));
    cause.labels.iter().any(|label| Some((label.span.source, label.span.start)) == end)
}

/// Whether a mistake tells by itself what a bracket behind it closes: of a name, only where its
/// bracket is, and of a comma never.
fn opens(cause: &Diagnostic) -> bool {
    match cause.code {
        "E0101" => cause.fixes.iter().any(|fix| fix.replacement.contains(['(', '['])),
        "E0014" => false,
        _ => true,
    }
}

/// What a name may be which begins as one that is surely meant and lacks the bracket that another closes: `lean(b`
/// for `leanb`.
fn call(found: &Diagnostic, close: &Diagnostic, sources: &Sources) -> Option<String> {
    let at = found.span().filter(|_| found.code == "E0101")?;
    let (name, meant) = (sources.text(at.source).get(at.range())?, &found.sure()?.replacement);
    let argument = name.strip_prefix(meant.as_str())?;
    let begins = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let close = close.span().and_then(|at| sources.text(at.source).get(at.range()))?;
    let open = if close.starts_with(']') { '[' } else { '(' };
    argument.starts_with(begins).then(|| format!("{meant}{open}{argument}"))
}

/// Whether a bracket that closes nothing closes what a mistake before it has left open.
fn closes_what(cause: &Diagnostic, found: &Diagnostic, sources: &Sources) -> bool {
    let (Some(before), Some(at)) = (cause.span(), found.span()) else { return false };
    let text = sources.text(at.source);
    let bracket = text.get(at.range()).unwrap_or_default();
    let is_stray = found.code == "E0010" || found.code == "E0023" && bracket == "}";
    if before.source != at.source || !is_stray {
        return false;
    }
    let between = text.get(before.range().end..at.range().start).filter(|it| it.len() <= LINE);
    let is_line = || between.is_some_and(|it| !it.contains('\n'));
    // With which the next line begins.
    let is_next = || between.is_some_and(|it| !it.trim_end().contains('\n'));
    match cause.code {
        "E0101" => {
            let is_open = cause.sure().is_none() || call(cause, found, sources).is_some();
            is_open && !bracket.starts_with('}') && is_next()
        }
        // `if a 2 m } else { 1 m }`
        "E0014" => bracket == "}" && is_line(),
        "E0023" => cause.sure().is_none() && (bracket.starts_with('}') || is_line()),
        _ => false,
    }
}

/// Whether the first of two places is a `;`, behind which on its line the other stands: what it cuts apart is one.
fn is_cut(a: Span, b: Span, sources: &Sources) -> bool {
    let text = sources.text(a.source);
    let between = text.get(a.range().end..b.range().start).filter(|_| a.source == b.source);
    text.get(a.range()) == Some(";")
        && between.is_some_and(|it| it.len() <= LINE && !it.contains('\n'))
}

/// How many tokens stand between two places, of which the first begins first; `None` if more than a few, or
/// if they stand on two lines and are not beside one another.
fn tokens_between(a: Span, b: Span, sources: &Sources) -> Option<usize> {
    if a.source != b.source {
        return None;
    }
    if b.start <= a.end {
        return Some(0);
    }
    let between = a.range().end..b.range().start;
    let text = sources.text(a.source);
    let written = text.get(between.clone()).filter(|written| written.len() <= BYTES)?;
    let most = if written.contains('\n') { 1 } else { TOKENS };
    let n = tokens(text, between).take(most + 1).count();
    (n <= most).then_some(n)
}
