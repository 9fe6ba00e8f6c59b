//! What was measured against what is expected: verdicts, and tables of them.
//!
//! A measured value x passes when |x − expected| ≤ 4·SE + tolerance, SE being its own standard error;
//! and it must be able to fail: 4·SE ≤ 2 % of what is expected + tolerance.

use std::fmt::Write;

use serde_json::{Value, json};

/// Standard errors that a value may be off.
const SIGMAS: f64 = 4.0;

/// Share of the expected value that they may reach, so that noise cannot buy a pass.
const RESOLUTION: f64 = 0.02;

/// Whether a value is as expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It is.
    Holds,
    /// It is not.
    Wrong,
    /// It is, but so noisy that it could hardly have failed.
    Noisy,
    /// Samples that were not finite were left out of it.
    NotFinite,
}

impl Verdict {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Holds => "ok",
            Self::Wrong => "WRONG",
            Self::Noisy => "NOISY",
            Self::NotFinite => "NOT FINITE",
        }
    }
}

/// A measured number with its standard error; zero where nothing is random.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// One number and what it ought to be.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// The truth, or the scene and its line.
    pub(super) id: String,
    /// Which of its cases.
    pub(super) case: String,
    pub(super) expected: f64,
    pub(super) measured: Measured,
    /// What is allowed beside standard errors.
    pub(super) tolerance: f64,
    pub(super) verdict: Verdict,
}

impl Row {
    /// A value held against what is expected.
    pub(super) fn new(
        (id, case): (&str, &str),
        expected: f64,
        measured: Measured,
        tolerance: f64,
    ) -> Self {
        let verdict = verdict(expected, measured, tolerance);
        Self { id: id.into(), case: case.into(), expected, measured, tolerance, verdict }
    }

    /// A value without noise, and the tolerance as a share of it and as an amount.
    pub(super) fn exact(
        id: &str,
        case: &str,
        (expected, value): (f64, f64),
        (rel, abs): (f64, f64),
    ) -> Self {
        let tolerance = abs.max(rel * expected.abs());
        Self::new((id, case), expected, Measured { value, error: 0.0 }, tolerance)
    }

    /// The same, known to lack samples that were not finite, if there are any.
    pub(super) fn without(self, bad: u64) -> Self {
        if bad == 0 { self } else { Self { verdict: Verdict::NotFinite, ..self } }
    }

    /// How many standard errors it is off; where more than noise may be, only what is beyond its tolerance,
    /// and nothing where the tolerance alone lets it pass.
    fn z(&self) -> Option<f64> {
        let Measured { value, error } = self.measured;
        let off = value - self.expected;
        let z = off / error;
        if z.abs() <= SIGMAS {
            return Some(z);
        }
        let beyond = off.abs() - self.tolerance;
        (error > 0.0 && beyond > 0.0).then(|| (beyond / error).copysign(off))
    }

    /// How many times the samples would tell, of a value that is too noisy: errors fall as their root.
    pub(super) fn times(&self) -> f64 {
        (self.measured.error * SIGMAS / allowed(self.expected, self.tolerance)).powi(2)
    }

    fn cells(&self) -> [String; 7] {
        let Self { id, case, expected, measured, .. } = self;
        let z = self.z().map_or("–".to_owned(), |z| format!("{z:+.1}"));
        let (value, error) = (short(measured.value), format!("{:.1e}", measured.error));
        let verdict = self.verdict.word().to_owned();
        [id.clone(), case.clone(), short(*expected), value, error, z, verdict]
    }

    /// The row as a JSON object.
    pub(super) fn json(&self) -> Value {
        json!({
            "id": self.id,
            "case": self.case,
            "expected": self.expected,
            "measured": self.measured.value,
            "standard_error": self.measured.error,
            "tolerance": self.tolerance,
            "z": self.z(),
            "verdict": self.verdict.word(),
        })
    }
}

fn verdict(expected: f64, Measured { value, error }: Measured, tolerance: f64) -> Verdict {
    let noise = SIGMAS * error;
    let near = (value - expected).abs() <= noise + tolerance;
    match near {
        // Nothing is near a number that is none.
        false => Verdict::Wrong,
        true if noise > allowed(expected, tolerance) => Verdict::Noisy,
        true => Verdict::Holds,
    }
}

/// What four standard errors may reach.
fn allowed(expected: f64, tolerance: f64) -> f64 {
    RESOLUTION * expected.abs() + tolerance
}

/// What the columns are.
const HEAD: [&str; 7] = ["truth", "case", "expected", "measured", "SE", "z", "verdict"];

/// The rows as a table of a document.
pub(super) fn document(rows: &[Row]) -> String {
    let line = |cells: &[String; 7]| format!("| {} |\n", cells.join(" | "));
    let rows: String = rows.iter().map(|row| line(&row.cells())).collect();
    format!("{}|{}\n{rows}", line(&HEAD.map(str::to_owned)), "---|".repeat(HEAD.len()))
}

/// The rows in columns, for the terminal.
pub(super) fn columns(rows: &[Row]) -> String {
    let all: Vec<_> =
        std::iter::once(HEAD.map(str::to_owned)).chain(rows.iter().map(Row::cells)).collect();
    let width = |i: usize| all.iter().map(|cells| cells[i].chars().count()).max().unwrap_or(0);
    let widths: [usize; 7] = std::array::from_fn(width);
    let mut out = String::new();
    for cells in &all {
        let mut line = String::new();
        for (cell, width) in cells.iter().zip(widths) {
            let _ = write!(line, "{cell:width$}  ");
        }
        out += line.trim_end();
        out.push('\n');
    }
    out
}

/// Seven digits, with an exponent only where the number is far from 1.
fn short(x: f64) -> String {
    if x.abs() >= 1e-3 { format!("{x:.7}") } else { format!("{x:.6e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(value: f64, error: f64) -> Row {
        Row::new(("a", "b"), 1.0, Measured { value, error }, 1e-3)
    }

    #[test]
    fn a_wrong_value_and_a_noisy_one_are_told() {
        assert_eq!(row(1.0009, 0.0).verdict, Verdict::Holds);
        assert_eq!(row(1.0011, 0.0).verdict, Verdict::Wrong);
        assert_eq!(row(1.01, 0.003).verdict, Verdict::Holds);
        assert_eq!(row(1.01, 0.02).verdict, Verdict::Noisy);
        assert_eq!(row(1.09, 0.02).verdict, Verdict::Wrong);
        assert_eq!(row(f64::NAN, 0.0).verdict, Verdict::Wrong);
        assert_eq!(row(1.0, f64::NAN).verdict, Verdict::Wrong);
        assert_eq!(row(1.0, f64::INFINITY).verdict, Verdict::Noisy);
        assert_eq!(row(1.0, 0.0).without(3).verdict, Verdict::NotFinite);
    }

    #[test]
    fn tables_show_every_figure() {
        let rows = [
            row(1.01, 0.003),
            row(1.0005, 1e-6),
            row(1.003, 4e-4),
            Row::exact("c", "", (1e-9, 1e-9), (1e-3, 0.0)),
        ];
        let told = "\
| truth | case | expected | measured | SE | z | verdict |
|---|---|---|---|---|---|---|
| a | b | 1.0000000 | 1.0100000 | 3.0e-3 | +3.3 | ok |
| a | b | 1.0000000 | 1.0005000 | 1.0e-6 | – | ok |
| a | b | 1.0000000 | 1.0030000 | 4.0e-4 | +5.0 | WRONG |
| c |  | 1.000000e-9 | 1.000000e-9 | 0.0e0 | – | ok |
";
        assert_eq!(document(&rows), told);
        let told = "\
truth  case  expected     measured     SE      z     verdict
a      b     1.0000000    1.0100000    3.0e-3  +3.3  ok
a      b     1.0000000    1.0005000    1.0e-6  –     ok
a      b     1.0000000    1.0030000    4.0e-4  +5.0  WRONG
c            1.000000e-9  1.000000e-9  0.0e0   –     ok
";
        assert_eq!(columns(&rows), told);
        let json = rows[0].json();
        assert_eq!(
            (json["verdict"].as_str(), json["standard_error"].as_f64()),
            (Some("ok"), Some(0.003))
        );
    }
}
