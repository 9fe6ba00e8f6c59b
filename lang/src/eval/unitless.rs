//! How a number without a unit is given one.

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::{Dimension, Unit};

use super::Evaluator;
use crate::syntax::parse_number;

/// What is written in brackets again to be given a unit; longer texts are not shown a second time.
const SHORT: usize = 60;

/// What is written where a unit is missing.
#[derive(Debug, PartialEq, Eq)]
enum Written {
    /// A number, or brackets around some: a unit stands behind.
    Numbers,
    /// A name or a call, which is multiplied by a unit.
    Whole,
    /// Several things with something between them: they are put in brackets first.
    Parts,
    /// What no unit behind it or before it would mend.
    Other,
}

impl Evaluator<'_> {
    /// Offers each of some units for a value that has none.
    pub(super) fn with_units(
        &self,
        mut diagnostic: Diagnostic,
        span: Span,
        units: &[&str],
    ) -> Diagnostic {
        let (written, end) = (self.written(span), Span { start: span.end, ..span });
        let form = Written::of(written);
        if let Some((kept, divisor)) = divided(written, units) {
            let start = span.range().start + kept;
            let unit = Span::new(span.source, start, span.range().end);
            let help = format!("what measures the same, divided by `{divisor}`, is a number alone");
            return diagnostic.help(help).guess(unit, "");
        }
        for unit in units {
            diagnostic = match form {
                Written::Numbers => diagnostic.guess(end, format!(" {unit}")),
                Written::Whole => diagnostic.guess(end, format!(" * 1 {unit}")),
                Written::Parts => diagnostic.guess(span, format!("({written}) * 1 {unit}")),
                Written::Other => diagnostic,
            };
        }
        diagnostic
    }

    /// Offers parts of a unit, if what is written is a number over one with that unit, which is wanted, or a
    /// vector of such.
    pub(super) fn with_part(
        &self,
        diagnostic: Diagnostic,
        span: Span,
        is_wanted: impl Fn(Dimension) -> bool,
    ) -> Diagnostic {
        let written = self.written(span);
        let is_wanted = |unit: &str| Unit::parse(unit).is_ok_and(|unit| is_wanted(unit.dimension));
        let part = |item| quotient(item).filter(|(.., unit)| is_wanted(unit));
        let inner = written.strip_prefix('(').and_then(|it| it.strip_suffix(')'));
        let inner = inner.filter(|inner| !inner.contains(['(', '[', '"', '\n']));
        let items = || inner.unwrap_or(written).split(',');
        let Some((number, divisor, unit)) = items().find_map(part) else { return diagnostic };
        let help = format!("a unit belongs to the number before it: {number} / ({divisor} {unit})");
        let whole = |(number, divisor, unit)| format!("{number} {unit} / {divisor}");
        let mended = items().map(|item| part(item).map_or(item.trim().to_owned(), whole));
        let mended = mended.collect::<Vec<_>>().join(", ");
        let mended = if inner.is_some() { format!("({mended})") } else { mended };
        diagnostic.help(help).guess(span, mended)
    }

    /// Offers a power times a unit, if what is written is a power whose exponent has that unit: `10^-2 m`.
    pub(super) fn with_base(&self, diagnostic: Diagnostic, span: Span) -> Diagnostic {
        let written = self.written(span);
        let of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | '_' | ' ');
        let Some((base, exponent)) = written.split_once('^') else { return diagnostic };
        let unit = exponent.trim_start_matches(of_number);
        let power = exponent[..exponent.len() - unit.len()].trim();
        let are_numbers =
            [base.trim(), power.trim_start_matches('-')].map(|it| parse_number(it.as_bytes()));
        if are_numbers.iter().any(Option::is_none) || Unit::parse(unit).is_err() {
            return diagnostic;
        }
        let help = "a unit belongs to the number before it, here the exponent";
        let is_ten = base.trim() == "10" && !power.contains('.');
        let mended = if is_ten {
            format!("1e{power} {unit}")
        } else {
            format!("{}^{power} * 1 {unit}", base.trim())
        };
        diagnostic.help(help).guess(span, mended)
    }
}

/// A number, what it is divided by, and the unit of that: `1/2 m`.
fn quotient(written: &str) -> Option<(&str, &str, &str)> {
    let (number, divisor) = written.split_once('/')?;
    let (divisor, unit) = divisor.trim().split_once(' ')?;
    let number = number.trim();
    let are_numbers = [number, divisor].iter().all(|it| parse_number(it.as_bytes()).is_some());
    are_numbers.then_some((number, divisor, unit.trim()))
}

impl Written {
    fn of(text: &str) -> Self {
        let is_call = |pair: &[u8]| pair[1] == b'(' && is_of_name(pair[0]);
        let has_calls = text.as_bytes().windows(2).any(is_call);
        match text.as_bytes() {
            number if parse_number(number).is_some() => Self::Numbers,
            [b'#', b'[', .., b']'] if is_plain(text) => Self::Numbers,
            [b'(' | b'[', .., b')' | b']'] if is_one(text) && !has_calls => Self::Numbers,
            [b'[', ..] | [] => Self::Other,
            [first, ..] if is_of_name(*first) && is_one(text) => Self::Whole,
            _ if text.len() <= SHORT && is_plain(text) && !text.contains('\n') => Self::Parts,
            _ => Self::Other,
        }
    }
}

/// Of a name that is divided by a number with one of some units, the bytes before that unit, and the divisor.
fn divided<'a>(written: &'a str, units: &[&str]) -> Option<(usize, &'a str)> {
    let (name, divisor) = written.split_once('/')?;
    let divisor = divisor.trim_start();
    let (number, unit) = divisor.split_once(' ')?;
    let is_name = name.trim_end().bytes().all(|byte| is_of_name(byte) || byte == b'.');
    let is_number = parse_number(number.as_bytes()).is_some()
        && !name.starts_with(|c: char| c.is_ascii_digit());
    let is_unit = units.contains(&unit.trim_start());
    let kept = written.len() - (divisor.len() - number.len());
    (is_name && is_number && is_unit).then_some((kept, divisor))
}

fn is_of_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Neither text nor comments, in which brackets need not be what they are elsewhere.
fn is_plain(text: &str) -> bool {
    !text.contains('"') && !text.contains("//") && !text.contains("/*")
}

/// Whether nothing stands between two things outside of brackets, nor behind a bracket that closes.
fn is_one(text: &str) -> bool {
    let (mut depth, mut is_closed) = (0_usize, false);
    is_plain(text)
        && text.bytes().all(|byte| {
            let is_outside = depth == 0;
            match byte {
                b'(' | b'[' => depth += 1,
                b')' | b']' => depth = depth.saturating_sub(1),
                _ => {}
            }
            let is_first = !is_closed;
            is_closed |= depth == 0 && matches!(byte, b')' | b']');
            let may_stand = is_of_name(byte) || matches!(byte, b'.' | b'(' | b'[');
            !is_outside || is_first && may_stand
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_decides_how_it_is_given_a_unit() {
        for (text, form) in [
            ("5", Written::Numbers),
            ("-1.5e3", Written::Numbers),
            ("1_000", Written::Numbers),
            ("(0, r, -2)", Written::Numbers),
            ("[(0, 1, 2), (r + 1, 0, 0)]", Written::Numbers),
            ("(0,\n  1)", Written::Numbers),
            ("#[0 1\n 2]", Written::Numbers),
            ("r", Written::Whole),
            ("abs(-r)", Written::Whole),
            ("box.sizes[i + 1]", Written::Whole),
            ("r + h", Written::Parts),
            ("r / 2", Written::Parts),
            ("-r", Written::Parts),
            ("(a + b) / (c)", Written::Parts),
            ("f(a) + f(b)", Written::Parts),
            ("if a > 1 { 1 } else { 2 }", Written::Parts),
            ("[(0, move(x)), (1, move(y))]", Written::Other),
            ("r + // half\n h", Written::Other),
            ("r +\n h", Written::Other),
            ("", Written::Other),
        ] {
            assert_eq!(Written::of(text), form, "{text}");
        }
    }
}
