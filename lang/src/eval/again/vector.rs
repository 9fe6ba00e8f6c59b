//! Vectors that are written out, as `(1.2 m, r, -3.25 m)`: of which of their numbers names change only some.

use std::ops::Range;

use luxel_sdk::params::{Dimension, Param, Unit};

use super::formula::MOST_ITEMS;

/// The items of a text that is a vector, by their bytes.
///
/// `None` of any other text, or if it is not known that each of them measures what its parameter does,
/// whatever a name among them comes to be: then bare numbers may stand there, which count in units of the file, and
/// bare zeros.
pub(super) fn items(text: &str, dimension: Dimension) -> Option<Vec<Range<usize>>> {
    let inside = text.strip_prefix('(')?.strip_suffix(')')?;
    if inside.contains(['"', '{']) || inside.contains("//") || inside.contains("/*") {
        return None;
    }
    let (mut depth, mut start, mut out) = (0_usize, 1, vec![]);
    for (at, byte) in text.bytes().enumerate().skip(1) {
        match byte {
            b'(' | b'[' => depth += 1,
            b')' | b']' if depth > 0 => depth -= 1,
            // The first bracket is closed by the last.
            b')' if depth == 0 && at + 1 < text.len() => return None,
            b',' | b')' if depth == 0 => {
                out.push(start..at);
                start = at + 1;
            }
            _ => {}
        }
    }
    let is_whole = start == text.len() && (2..=MOST_ITEMS).contains(&out.len());
    let mut literals = out.iter().filter_map(|item| literal(&text[item.clone()])).peekable();
    let is_measured = dimension.is_none() || literals.peek().is_some();
    (is_whole && is_measured && literals.all(|measure| measure == dimension)).then_some(out)
}

/// What a number measures that is written out.
pub(super) fn literal(text: &str) -> Option<Dimension> {
    let text = text.trim();
    let text = text.strip_prefix('-').unwrap_or(text);
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let unit = text.trim_start_matches(is_part);
    let number = &text[..text.len() - unit.len()];
    number.parse::<f64>().ok()?;
    match unit.trim_start() {
        "" => Some(Dimension::NONE),
        unit => Some(Unit::parse(unit).ok()?.dimension),
    }
}

/// What the numbers of a parameter measure, if that is one thing.
pub(super) fn dimension(param: &Param) -> Option<Dimension> {
    if param.unit.is_empty() {
        return Some(Dimension::NONE);
    }
    Unit::parse(param.unit).ok().map(|unit| unit.dimension)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_those_of_one_vector_that_all_measure_the_same() {
        let of = |text: &str, measure| {
            let items = items(text, measure)?;
            Some(items.iter().map(|item| text[item.clone()].trim()).collect::<Vec<_>>().join("|"))
        };
        let length = Dimension::LENGTH;
        for (text, wanted) in [
            ("(1.2 m, r, -3 mm)", Some("1.2 m|r|-3 mm")),
            ("(f(a, [b, c]), -(r), 1 m)", Some("f(a, [b, c])|-(r)|1 m")),
            ("(0, r, 1 m)", None),
            ("( r, r )", None),
            ("(1, r)", None),
            ("(1 s, r)", None),
            ("(1 m)", None),
            ("(1 m, r) * (2)", None),
            ("(1 m, r) m", None),
            ("(1 m, r, r, r, r)", None),
            ("(1 m, /* , */ r)", None),
            ("(1 m, r // )\n)", None),
            ("(1 m, f(\",\"))", None),
            ("(1 m, r))", None),
            ("((1 m, r)", None),
            ("", None),
            (")(", None),
        ] {
            assert_eq!(of(text, length).as_deref(), wanted, "{text}");
        }
        assert_eq!(of("(r, r)", Dimension::NONE).as_deref(), Some("r|r"));
    }

    #[test]
    fn a_number_that_is_written_out_measures_what_its_unit_does() {
        for (text, wanted) in [
            ("1", Some(Dimension::NONE)),
            (" - 2.5 cm ", None),
            ("-2.5cm", Some(Dimension::LENGTH)),
            ("3 m/s^2", Some(Dimension::LENGTH / Dimension::TIME / Dimension::TIME)),
            ("3 r", None),
            ("r", None),
            ("1e3", None),
            ("", None),
            ("- m", None),
        ] {
            assert_eq!(literal(text), wanted, "{text}");
        }
    }
}
