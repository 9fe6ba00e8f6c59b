//! Signs and letters that stand for others: editors set them, or other notations have them.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, told};
use super::lex::{Token, TokenKind};

/// Signs that editors and other notations write, and what stands here for them.
const SIGNS: [(&str, &str, &str); 16] = [
    ("–", "-", "this dash is no minus sign"),
    ("—", "-", "this dash is no minus sign"),
    ("−", "-", "this minus sign is not the keyboard's"),
    ("‐", "-", "this hyphen is no minus sign"),
    ("×", "*", "a product is written with `*`"),
    ("·", "*", "a product is written with `*`"),
    ("⋅", "*", "a product is written with `*`"),
    ("÷", "/", "a quotient is written with `/`"),
    ("≤", "<=", "this comparison is written `<=`"),
    ("≥", ">=", "this comparison is written `>=`"),
    ("≠", "!=", "this comparison is written `!=`"),
    ("…", "..", "a range is written with `..`"),
    ("²", "^2", "a power is written with `^`"),
    ("³", "^3", "a power is written with `^`"),
    ("°", " deg", "degrees are written `deg`"),
    ("π", "pi", "this number is called `pi`"),
];

/// What is said of other measures of temperature.
pub(super) const KELVIN: &str = "a temperature is measured in kelvin";

/// Quotes beside the keyboard's two.
const QUOTES: [&str; 9] = ["“", "”", "„", "‟", "«", "»", "‘", "’", "'"];

/// Why the place cannot be read, if a sign or letter there stands for another one.
pub(super) fn sign(around: &Around<'_>) -> Option<Diagnostic> {
    typed(around).or_else(|| quotes(around)).or_else(|| lettered(around)).or_else(|| nought(around))
}

/// A sign of typography, or a blank that is none to the grammar.
fn typed(around: &Around<'_>) -> Option<Diagnostic> {
    let mark = around.current()?;
    let c = mark.text.chars().next()?;
    if c.is_whitespace() || matches!(c, '\u{200B}'..='\u{200D}' | '\u{2060}') {
        let message = format!("this blank (U+{:04X}) is none to the language", u32::from(c));
        return Some(told(around.span(mark), message).fix(around.span(mark), " "));
    }
    if let Some(found) = temperature(around).or_else(|| letter(around, c)) {
        return Some(found);
    }
    let (_, here, message) = SIGNS.iter().find(|(sign, ..)| *sign == mark.text)?;
    // `2π`
    let is_factor = c == 'π' && around.before(1).is_some_and(|t| t.kind == TokenKind::Number);
    let here = if is_factor { &" * pi" } else { here };
    Some(told(around.span(mark), *message).fix(around.span(mark), *here))
}

/// `20 °C`
fn temperature(around: &Around<'_>) -> Option<Diagnostic> {
    let mark = around.current().filter(|mark| mark.text == "°")?;
    let scale = around.tokens.get(around.at + 1).filter(|t| !t.first_on_line)?;
    let span = around.span(mark).to(around.span(scale));
    let found = told(span, KELVIN);
    match scale.text {
        "C" => {
            let number = around.before(1).filter(|t| t.kind == TokenKind::Number);
            let kelvin = number.and_then(|number| Some((number, kelvin(number.text)?)));
            let Some((number, kelvin)) = kelvin else { return Some(found) };
            Some(found.guess(around.span(number).to(span), kelvin))
        }
        "F" => Some(found),
        "K" => {
            let from = around.before(1).map_or(span.range().start, Token::end);
            let all = Span::new(around.source, from, scale.end());
            Some(told(span, "kelvin are no degrees").fix(all, " K"))
        }
        _ => None,
    }
}

/// So many degrees Celsius in kelvin.
pub(super) fn kelvin(degrees: &str) -> Option<String> {
    let degrees: f64 = degrees.parse().ok()?;
    Some(format!("{} K", ((degrees + 273.15) * 100.0).round() / 100.0))
}

/// `größe`
fn letter(around: &Around<'_>, c: char) -> Option<Diagnostic> {
    let mark = around.current().filter(|_| c.is_alphabetic() && c != 'π')?;
    let touches =
        around.before(1).is_some_and(|t| t.kind == TokenKind::Word && t.end() == mark.start)
            || around
                .tokens
                .get(around.at + 1)
                .is_some_and(|t| t.kind == TokenKind::Word && t.start == mark.end());
    let found = told(around.span(mark), format!("`{c}` stands in no name"));
    touches.then(|| found.help("names are made of the letters a to z and A to Z, digits and `_`"))
}

/// `'a'`, `“a”`
fn quotes(around: &Around<'_>) -> Option<Diagnostic> {
    let mark = around.current().filter(|mark| QUOTES.contains(&mark.text))?;
    let found = told(around.span(mark), "a string stands between `\"`");
    let line = around.text[mark.end()..around.end].split('\n').next()?;
    let end = QUOTES.iter().chain(&["\""]).filter_map(|quote| line.find(quote)).min();
    let Some(length) = end else { return Some(found) };
    let quote = line[length..].chars().next().map_or(0, char::len_utf8);
    let all = Span::new(around.source, mark.start, mark.end() + length + quote);
    Some(found.guess(all, format!("\"{}\"", &line[..length])))
}

/// `f"text"`
fn lettered(around: &Around<'_>) -> Option<Diagnostic> {
    let back = around.at.saturating_sub(1);
    [back, around.at].into_iter().find_map(|i| {
        let (letter, text) = (around.tokens.get(i)?, around.tokens.get(i + 1)?);
        // `8 cm"too large"` lacks a comma.
        let is_unit = i > 0 && around.tokens[i - 1].kind == TokenKind::Number;
        let touch = letter.end() == text.start && letter.text.len() <= 2 && !is_unit;
        if letter.kind != TokenKind::Word || text.kind != TokenKind::Text || !touch {
            return None;
        }
        let span = around.span(letter);
        let found = told(span, "no letter stands before a string");
        // With the letter, `{k}` is another text elsewhere, and `\n` may be.
        Some(match text.text {
            text if text.contains('{') => found
                .help("a string stands for itself: nothing is put in for `{…}`")
                .guess(span, ""),
            text if text.contains('\\') => found.guess(span, ""),
            _ => found.fix(span, ""),
        })
    })
}

/// `O.25`
fn nought(around: &Around<'_>) -> Option<Diagnostic> {
    let (letter, rest) = (around.before(1)?, around.current()?);
    let is_fraction = rest.kind == TokenKind::Number && rest.text.starts_with('.');
    let is_it = matches!(letter.text, "O" | "o") && letter.end() == rest.start && is_fraction;
    let span = around.span(letter);
    is_it.then(|| told(span, "this is a letter, and no nought").fix(span, "0"))
}
