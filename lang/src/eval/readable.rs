//! Values as people read them: seven digits, and a unit in which they are neither tiny nor huge.

use std::sync::LazyLock;

use luxel_sdk::params::{Dimension, UNITS, Unit};

use super::value::{FieldValue, Range, Value};
use crate::syntax::Form;

/// Elements that are shown, at most.
const SHOWN: usize = 4;

/// Units of more than one name.
const COMPOUND: [&str; 11] =
    ["m^2", "m^3", "1/m", "W/m^2", "W/sr", "W/m^2/sr", "lm/W", "deg/s", "rad/s", "m/s", "kg/m^3"];

/// Units that values are not told in: others of their dimension say more.
const UNSAID: [&str; 6] = ["um", "inch", "ft", "EV", "rad", "rad/s"];

/// A value as a person would write it, lists by their first elements.
pub(super) fn readable(value: &Value) -> String {
    shown(value, &mut (SHOWN * SHOWN))
}

/// The same, of a value in which others stand that are shown as long as there is room for some.
fn shown(value: &Value, room: &mut usize) -> String {
    match value {
        Value::Number(x, dimension) => in_units(&[*x], *dimension, &|numbers| number(numbers[0])),
        Value::Numbers(n) => {
            let first = &n.data[..n.data.len().min(SHOWN)];
            in_units(first, n.dimension, &|numbers| {
                let first: Vec<String> = numbers.iter().map(|x| number(*x)).collect();
                listed(first, n.data.len(), n.form)
            })
        }
        Value::Items(items) => {
            let first = fitting(&items.items, room).iter().map(|item| shown(item, room)).collect();
            listed(first, items.items.len(), items.form)
        }
        Value::Record(record) => {
            let first = fitting(&record.fields, room);
            let one =
                |field: &FieldValue| format!("{} = {}", field.name.text, shown(&field.value, room));
            let mut parts: Vec<String> = first.iter().map(one).collect();
            if record.fields.len() > first.len() {
                parts.push("…".to_owned());
            }
            format!("{{ {} }}", parts.join(", "))
        }
        Value::Range(range) => of_range(range),
        other => other.show(),
    }
}

/// The first of some values, as many as there is room for.
fn fitting<'a, T>(values: &'a [T], room: &mut usize) -> &'a [T] {
    let n = values.len().min(SHOWN).min(*room);
    *room -= n;
    &values[..n]
}

/// Seven digits, which is what a 32-bit number tells apart, without zeros at the end.
pub(crate) fn number(x: f64) -> String {
    let x = rounded(x);
    let is_plain = (1e-4..1e9).contains(&x.abs()) || x.abs() <= 0.0 || !x.is_finite();
    if is_plain { x.to_string() } else { format!("{x:e}") }
}

/// A number of a dimension in SI units.
pub(crate) fn si(x: f64, dimension: Dimension) -> String {
    if dimension.is_none() { number(x) } else { format!("{} {}", number(x), si_unit(dimension)) }
}

/// With seven digits. Most numbers have no more, and of these it takes long to find all that are none.
fn rounded(x: f64) -> f64 {
    let shortest = format!("{x:e}");
    let digits = shortest.bytes().take_while(|byte| *byte != b'e').filter(u8::is_ascii_digit);
    if digits.count() <= 7 { x } else { format!("{x:.6e}").parse().unwrap_or(x) }
}

fn listed(mut first: Vec<String>, length: usize, form: Form) -> String {
    if length > first.len() {
        first.push(format!("… {length} in all"));
    }
    let parts = first.join(", ");
    if form == Form::List { format!("[{parts}]") } else { format!("({parts})") }
}

fn of_range(range: &Range) -> String {
    let dots = if range.inclusive { "..=" } else { ".." };
    in_units(&[range.start, range.end], range.dimension, &|numbers| {
        format!("{}{dots}{}", number(numbers[0]), number(numbers[1]))
    })
}

/// Numbers in SI units in the unit that people would choose, and in SI units if that is another.
fn in_units(numbers: &[f64], dimension: Dimension, shown: &dyn Fn(&[f64]) -> String) -> String {
    if dimension.is_none() {
        return shown(numbers);
    }
    let in_si = format!("{} {}", shown(numbers), si_unit(dimension));
    let most = numbers.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    match chosen(dimension, most) {
        Some((name, unit)) if !is_si(&unit) => {
            let scaled: Vec<f64> = numbers.iter().map(|x| x / unit.scale).collect();
            format!("{} {name} = {in_si}", shown(&scaled))
        }
        _ => in_si,
    }
}

/// Every unit, with its name.
static ALL: LazyLock<Vec<(&str, Unit)>> = LazyLock::new(|| {
    let compound = COMPOUND.iter().filter_map(|name| Some((*name, Unit::parse(name).ok()?)));
    UNITS.iter().copied().chain(compound).collect()
});

/// Those that values are told in, the largest first.
static FALLING: LazyLock<Vec<(&str, Unit)>> = LazyLock::new(|| {
    let mut all = ALL.clone();
    all.retain(|(name, _)| !UNSAID.contains(name));
    all.sort_by(|(_, a), (_, b)| b.scale.total_cmp(&a.scale));
    all
});

/// The largest unit of which the number is one or more, else the smallest.
fn chosen(dimension: Dimension, most: f64) -> Option<(&'static str, Unit)> {
    let mut fit = FALLING.iter().filter(|(_, unit)| unit.dimension == dimension);
    let found = fit.clone().find(|(_, unit)| rounded(most / unit.scale) >= 1.0);
    found.or(fit.next_back()).copied().filter(|_| most > 0.0)
}

fn is_si(unit: &Unit) -> bool {
    (unit.scale - 1.0).abs() <= f64::EPSILON
}

fn si_unit(dimension: Dimension) -> String {
    let found = ALL.iter().find(|(_, unit)| unit.dimension == dimension && is_si(unit));
    found.map_or_else(|| dimension.to_string(), |(name, _)| (*name).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(x: f64, unit: &str) -> String {
        let unit = Unit::parse(unit).unwrap();
        readable(&Value::Number(x * unit.scale, unit.dimension))
    }

    #[test]
    fn numbers_have_seven_digits_and_no_rounding_errors() {
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(1.0 / 3.0), "0.3333333");
        assert_eq!(number(-123_456_789.0), "-123456800");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(1.5e-7), "1.5e-7");
        assert_eq!(number(6.02214076e23), "6.022141e23");
        assert_eq!((number(f64::NAN), number(f64::INFINITY)), ("NaN".into(), "inf".into()));
    }

    #[test]
    fn units_are_those_that_people_say() {
        assert_eq!(of(5.0, "mm"), "5 mm = 0.005 m");
        assert_eq!(of(35.0, "cm"), "35 cm = 0.35 m");
        assert_eq!(of(0.0, "cm"), "0 m");
        assert_eq!(of(2.5, "m"), "2.5 m");
        assert_eq!(of(1.0, "inch"), "2.54 cm = 0.0254 m");
        assert_eq!(of(500.0, "nm"), "500 nm = 5e-7 m");
        assert_eq!(of(-9.0, "km"), "-9 km = -9000 m");
        assert_eq!(of(30.0, "deg"), "30 deg = 0.5235988 rad");
        assert_eq!(of(1.0, "rad"), "57.29578 deg = 1 rad");
        assert_eq!(of(90.0, "deg/s"), "90 deg/s = 1.570796 rad/s");
        assert_eq!(of(1.0 / 48.0, "s"), "20.83333 ms = 0.02083333 s");
        assert_eq!(of(15.0, "W/m^2/sr"), "15 W/m^2/sr");
        assert_eq!(of(3.0, "lm"), "3 lm");
        assert_eq!(of(2.0, "m*s^2"), "2 m*s^2");
        assert_eq!(of(0.5, "EV"), "0.5");
    }

    #[test]
    fn lists_show_their_first_elements_in_one_unit() {
        let length = Dimension::LENGTH;
        let list = |data: &[f64], form| readable(&Value::numbers(data, length, form));
        assert_eq!(list(&[0.1, 0.0, 0.25], Form::Tuple), "(10, 0, 25) cm = (0.1, 0, 0.25) m");
        let many = list(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], Form::List);
        assert_eq!(many, "[1, 2, 3, 4, … 6 in all] m");
        let range = Range { start: 0.0, end: 9.0, inclusive: true, dimension: Dimension::NONE };
        assert_eq!(readable(&Value::Range(range)), "0..=9");
        let mixed = vec![Value::plain(1.0), Value::Text("a".into())];
        assert_eq!(readable(&Value::list(mixed, Form::Tuple)), "(1, \"a\")");
        let twice = |inner: Value| Value::list(vec![inner.clone(), inner], Form::List);
        let nested = (0..40).fold(Value::Bool(true), |inner, _| twice(inner));
        let shown = readable(&nested);
        assert!(shown.starts_with("[[[[[[[[[… 2 in all], [… 2 in all]]"), "{shown}");
    }
}
