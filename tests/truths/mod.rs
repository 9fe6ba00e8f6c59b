//! Closed-form truths: what the renderer measures against what mathematics says.
//!
//! A measured value passes when |x − expected| ≤ 4·SE + max(abs, rel·|expected|), SE being its own
//! standard error; and it must be able to fail: 4·SE ≤ 2 % of what is expected.

mod colour;
mod scene;
mod unit;

use std::collections::BTreeSet;
use std::fmt::Write;

use crate::disk::{root, text};
use crate::generated;

/// Share of the expected value that four standard errors may reach, so that noise cannot buy a pass.
const RESOLUTION: f64 = 0.02;

/// One number and what it ought to be.
#[derive(Clone, Debug)]
struct Row {
    id: String,
    /// Which of the id's cases.
    case: String,
    expected: f64,
    measured: f64,
    /// Standard error; zero where nothing is random.
    error: f64,
    /// What is allowed beside four standard errors.
    tolerance: f64,
}

impl Row {
    /// A value without noise.
    fn exact(
        id: &str,
        case: &str,
        (expected, measured): (f64, f64),
        (rel, abs): (f64, f64),
    ) -> Self {
        let tolerance = abs.max(rel * expected.abs());
        Self { id: id.into(), case: case.into(), expected, measured, error: 0.0, tolerance }
    }

    fn verdict(&self) -> &'static str {
        let off = (self.measured - self.expected).abs();
        if !(off <= 4.0 * self.error + self.tolerance) {
            "WRONG"
        } else if 4.0 * self.error > RESOLUTION * self.expected.abs() + self.tolerance {
            "NOISY"
        } else {
            "ok"
        }
    }

    fn z(&self) -> String {
        let z = (self.measured - self.expected) / self.error;
        if self.error > 0.0 { format!("{z:+.1}") } else { "–".into() }
    }
}

/// The rows as the table that docs/accuracy.md shows.
fn table(rows: &[Row]) -> String {
    let mut out = String::from("| truth | case | expected | measured | SE | z | verdict |\n");
    out += "|---|---|---|---|---|---|---|\n";
    for row in rows {
        let Row { id, case, expected, measured, error, .. } = row;
        let (expected, measured) = (short(*expected), short(*measured));
        let (z, verdict) = (row.z(), row.verdict());
        writeln!(
            out,
            "| {id} | {case} | {expected} | {measured} | {error:.1e} | {z} | {verdict} |"
        )
        .unwrap();
    }
    out
}

/// Seven digits, with an exponent only where the number is far from 1.
fn short(x: f64) -> String {
    if x.abs() >= 1e-3 { format!("{x:.7}") } else { format!("{x:.6e}") }
}

#[test]
fn truths_hold() {
    let mut rows = scene::rows();
    rows.extend(colour::rows());
    rows.extend(unit::rows());
    println!("{}", table(&rows));
    let wrong: Vec<_> = rows.iter().filter(|row| row.verdict() != "ok").cloned().collect();
    assert!(rows.len() > 100, "only {} truths were tried", rows.len());
    assert!(wrong.is_empty(), "truths that do not hold:\n{}", table(&wrong));
    if is_asked_to_write() {
        generated::write(&root().join(PUBLISHED), "truths", &table(&rows)).unwrap();
    }
}

/// Where the table stands.
const PUBLISHED: &str = "docs/accuracy.md";

#[expect(clippy::disallowed_methods, reason = "whoever runs the test says so")]
fn is_asked_to_write() -> bool {
    std::env::var("LUXEL_WRITE_DOCS").is_ok_and(|value| value == "1")
}

#[test]
fn a_wrong_value_and_a_noisy_one_are_told() {
    let row = |measured, error| Row { error, ..Row::exact("", "", (1.0, measured), (1e-3, 0.0)) };
    assert_eq!(row(1.0009, 0.0).verdict(), "ok");
    assert_eq!(row(1.0011, 0.0).verdict(), "WRONG");
    assert_eq!(row(1.01, 0.003).verdict(), "ok");
    assert_eq!(row(1.01, 0.02).verdict(), "NOISY");
    assert_eq!(row(f64::NAN, 0.0).verdict(), "WRONG");
}

#[test]
fn every_truth_is_published_and_no_other() {
    let document = text(&root().join(PUBLISHED));
    let rows = generated::part(&document, "truths").unwrap().trim().lines().skip(2);
    let id = |row: &str| row.split('|').nth(1).map(|id| id.trim().to_owned());
    let published: BTreeSet<String> = rows.filter_map(id).collect();
    let ids = scene::cases().into_iter().map(|case| case.id);
    let ids = ids.chain(colour::IDS.map(str::to_owned));
    let ids: BTreeSet<String> = ids.chain(unit::rows().into_iter().map(|row| row.id)).collect();
    assert_eq!(published, ids, "LUXEL_WRITE_DOCS=1 cargo test -p luxel-tests truths");
}

#[test]
fn curves_of_errors_stand_where_the_bench_writes_them() {
    let document = text(&root().join(PUBLISHED));
    let curves = generated::part(&document, "errors").unwrap();
    // Of each of three tables a head, a line, and four rows of each of four shapes.
    assert_eq!(curves.lines().filter(|line| line.starts_with('|')).count(), 3 * (2 + 4 * 4));
}
