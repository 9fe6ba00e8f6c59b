//! Units behind numbers, and what is said of words that are none.

use std::ops::Range;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Grade, Span, nearest};
use luxel_sdk::params::{UNITS, Unit};
use pest::iterators::Pair;

use super::Rule;
use super::around::is_category;
use super::build::Builder;
use super::head::begins_statement;
use super::joins::condition;
use super::signs::{KELVIN, kelvin};
use super::statement::{is_suffix, of_suffix};
use super::tree::Name;

impl Builder<'_> {
    /// `640x480` with its place, if a unit of that kind stands behind a number.
    fn size(&self, pair: &Pair<'_, Rule>) -> Option<(Span, String)> {
        let (unit, height) = (self.span(pair), pair.as_str().strip_prefix(['x', 'X'])?);
        let before = &pair.get_input()[..pair.as_span().start()];
        let digits = before.bytes().rev().take_while(u8::is_ascii_digit).count();
        if digits == 0 || height.is_empty() || !height.bytes().all(|b| b.is_ascii_digit()) {
            return None;
        }
        let size = format!("({}, {height})", &before[before.len() - digits..]);
        let range = unit.range();
        Some((Span::new(unit.source, range.start - digits, range.end), size))
    }

    /// `0x10` with its place, if a unit of that kind stands behind a zero.
    fn hexadecimal(&self, pair: &Pair<'_, Rule>) -> Option<(Span, String)> {
        let (unit, digits) = (self.span(pair), pair.as_str().strip_prefix(['x', 'X'])?);
        let before = pair.get_input()[..pair.as_span().start()].strip_suffix('0')?;
        let number = u64::from_str_radix(digits, 16).ok()?;
        let is_zero = !before.ends_with(|c: char| c.is_ascii_digit() || c == '.');
        let range = unit.range();
        is_zero.then(|| (Span::new(unit.source, range.start - 1, range.end), number.to_string()))
    }

    /// The unit that a token names; `None` if it is none, which is told.
    pub(super) fn unit(&mut self, pair: &Pair<'_, Rule>) -> Option<Arc<Unit>> {
        let text = pair.as_str();
        let bad = match Unit::parse(text) {
            Ok(unit) => return Some(Arc::new(unit)),
            Err(bad) => bad,
        };
        let span = self.span(pair);
        if let Some(found) = self.of_word(pair, span) {
            self.sink.push(found);
            return None;
        }
        if is_category(text) {
            self.sink.push(self.statement_as_unit(pair, span));
            self.begun = Some((pair.as_span().end(), Name { text: text.into(), span }));
            return None;
        }
        if let Some(found) = self.scaled(pair, &bad) {
            self.sink.push(found);
            return None;
        }
        let mut diagnostic = no_unit(span, &bad);
        if let Some((all, number)) = self.hexadecimal(pair) {
            let found = Diagnostic::error("E0016", all, "numbers are written in decimal");
            self.sink.push(found.guess(all, number));
            return None;
        }
        if let Some((all, size)) = self.size(pair) {
            self.sink.push(diagnostic.help("a size is a vector").guess(all, size));
            return None;
        }
        if let Some(powered) = with_power(&bad).filter(|_| bad == text) {
            diagnostic = diagnostic.help("powers are written with `^`").fix(span, powered);
        } else if let Some((unit, grade)) = suggest_unit(&bad) {
            diagnostic = diagnostic.help(format!("did you mean `{unit}`?"));
            if bad == text {
                diagnostic = diagnostic.mend(span, unit, grade);
            }
        } else {
            diagnostic = diagnostic.help(
                "units are written as `cm`, `deg` or `W/m^2/sr`; a variable is multiplied by `*`",
            );
        }
        self.sink.push(diagnostic);
        None
    }

    /// What is told of a word that people put there and that is not only misspelt.
    fn of_word(&self, pair: &Pair<'_, Rule>, span: Span) -> Option<Diagnostic> {
        let text = pair.as_str();
        // `(a > 1) and (b > 1)`
        if let Some(found) = condition(span, text) {
            return Some(found);
        }
        Some(match text {
            _ if is_suffix(text) => of_suffix(span),
            "then" => {
                let message = "no `then` stands between a condition and its block";
                Diagnostic::error("E0204", span, message).fix(span, "")
            }
            "px" | "pixel" | "pixels" => {
                let all = self.written(blank_before(pair).start..pair.as_span().end());
                let message = format!("there is no unit `{text}`: pixels are counted");
                Diagnostic::error("E0204", span, message).fix(all, "")
            }
            "C" | "degC" | "celsius" | "degF" => self.temperature(pair, span),
            _ => return None,
        })
    }

    /// `5 MW`, `3 kHz`: a unit behind a prefix that it is not written with.
    fn scaled(&self, pair: &Pair<'_, Rule>, bad: &str) -> Option<Diagnostic> {
        let rest = pair.as_str().strip_prefix(bad)?;
        let (power, unit) = scale(bad)?;
        let blank = blank_before(pair).start;
        let number = number_before(&pair.get_input()[..blank]);
        let (found, help) =
            (no_unit(self.span(pair), bad), "the power of ten stands in the number");
        if number.is_empty() {
            return Some(found.help(format!("{help}: 1 {bad} is `1{power} {unit}`")));
        }
        let all = self.written(blank - number.len()..pair.as_span().end());
        let meant = format!("{number}{power} {unit}{rest}");
        Some(found.help(format!("{help}: `{meant}`")).guess(all, meant))
    }

    /// `20 C`, `68 degF`
    fn temperature(&self, pair: &Pair<'_, Rule>, span: Span) -> Diagnostic {
        let found = Diagnostic::error("E0204", span, KELVIN);
        let blank = blank_before(pair).start;
        let number = number_before(&pair.get_input()[..blank]);
        let kelvin = kelvin(number).filter(|_| !pair.as_str().ends_with('F'));
        let Some(kelvin) = kelvin else { return found };
        found.guess(self.written(blank - number.len()..pair.as_span().end()), kelvin)
    }

    /// `let b = 4 shape sphere { … }`
    fn statement_as_unit(&self, pair: &Pair<'_, Rule>, span: Span) -> Diagnostic {
        let gap = self.written(blank_before(pair));
        Diagnostic::error("E0204", span, begins_statement(pair.as_str())).guess(gap, "; ")
    }
}

fn no_unit(span: Span, name: &str) -> Diagnostic {
    Diagnostic::error("E0204", span, format!("there is no unit `{name}`"))
}

/// Digits with which a text ends, perhaps with a point; none if they are an exponent.
fn number_before(text: &str) -> &str {
    let rest = text.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
    let is_exponent = rest.trim_end_matches(['+', '-']).ends_with(['e', 'E']);
    if is_exponent { "" } else { &text[rest.len()..] }
}

/// The power of ten and the unit that a word with a prefix of the SI stands for.
fn scale(word: &str) -> Option<(&'static str, &str)> {
    const PREFIXES: [(&str, &str); 12] = [
        ("T", "e12"),
        ("G", "e9"),
        ("M", "e6"),
        ("k", "e3"),
        ("h", "e2"),
        ("d", "e-1"),
        ("c", "e-2"),
        ("m", "e-3"),
        ("u", "e-6"),
        ("µ", "e-6"),
        ("n", "e-9"),
        ("p", "e-12"),
    ];
    PREFIXES.iter().find_map(|(prefix, power)| {
        let unit = word.strip_prefix(prefix).filter(|unit| Unit::named(unit).is_some())?;
        Some((*power, unit))
    })
}

/// The blanks before what stands behind a number.
fn blank_before(pair: &Pair<'_, Rule>) -> Range<usize> {
    let before = &pair.get_input()[..pair.as_span().start()];
    before.trim_end_matches([' ', '\t']).len()..before.len()
}

/// The unit that a misspelt one stands for: full names are sure, slips of the pen are guessed.
pub(crate) fn suggest_unit(text: &str) -> Option<(&'static str, Grade)> {
    const FULL: [(&str, &str); 21] = [
        ("meter", "m"),
        ("metre", "m"),
        ("kilometer", "km"),
        ("centimeter", "cm"),
        ("centimetre", "cm"),
        ("millimeter", "mm"),
        ("millimetre", "mm"),
        ("nanometer", "nm"),
        ("nanometre", "nm"),
        ("degree", "deg"),
        ("radian", "rad"),
        ("second", "s"),
        ("kelvin", "K"),
        ("watt", "W"),
        ("lumen", "lm"),
        ("candela", "cd"),
        ("in", "inch"),
        // `inches`
        ("inche", "inch"),
        ("foot", "ft"),
        ("feet", "ft"),
        ("lux", "lx"),
    ];
    let lower = text.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let full = FULL.iter().find(|(name, _)| *name == singular).map(|(_, unit)| *unit);
    let case = UNITS.iter().find(|(name, _)| name.to_lowercase() == lower).map(|(name, _)| *name);
    let slip = || nearest(text, UNITS.iter().map(|(name, _)| *name)).filter(|_| text.len() > 2);
    let near = case.or_else(slip);
    full.map(|unit| (unit, Grade::Sure)).or(near.map(|unit| (unit, Grade::Guess)))
}

/// `mm2` as it is written here, if that is a power of a unit.
fn with_power(unit: &str) -> Option<String> {
    let name = unit.trim_end_matches(|c: char| c.is_ascii_digit());
    let power = &unit[name.len()..];
    let is_one = power.len() == 1 && Unit::named(name).is_some();
    is_one.then(|| format!("{name}^{power}"))
}
