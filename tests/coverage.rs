//! How often intervals hold the truth: of integrals with known values, each found 1000 times over.

use std::f64::consts::PI;
use std::fmt::Write;

use glam::DVec3;
use luxel_core::film::{Pixel, half_width_95};
use luxel_sdk::sampling::{Rng, sobol_owen_2d};

use crate::published;

/// Runs of each case.
const RUNS: u32 = 1000;
/// Samples of a run: the ends of parts, and one between.
const COUNTS: [u32; 5] = [16, 64, 100, 256, 1024];
/// From so many samples on intervals are to hold the truth 93 times in 100, where nothing is seldom.
const LEAST: u32 = 64;
/// Pairs of numbers of a sample.
const PAIRS: usize = 4;

type Numbers = [[f64; 2]; PAIRS];

/// What is integrated over the unit cube.
struct Integrand {
    name: &'static str,
    f: fn(&Numbers) -> f64,
    truth: f64,
    /// Whether a sample says seldom what counts, so that intervals may miss more often than one in 14.
    is_skewed: bool,
}

/// How much of the cube sends light to the skewed pixel.
const SELDOM: f64 = 0.02;

const INTEGRANDS: [Integrand; 5] = [
    Integrand { name: "smooth, 4xy", f: |u| 4.0 * u[0][0] * u[0][1], truth: 1.0, is_skewed: false },
    Integrand {
        name: "edge, a quarter of a disc",
        f: |u| f64::from(u[0][0].hypot(u[0][1]) < 1.0),
        truth: PI / 4.0,
        is_skewed: false,
    },
    Integrand {
        name: "path, a product over eight dimensions",
        f: |u| u.iter().flatten().map(|x| 0.5 + x).product(),
        truth: 1.0,
        is_skewed: false,
    },
    Integrand {
        name: "peak, x^-0.4",
        f: |u| 0.6 * u[0][0].max(1e-12).powf(-0.4),
        truth: 1.0,
        is_skewed: true,
    },
    Integrand {
        name: "caustic, 50 in one of 50 samples",
        f: |u| {
            if u[0][0] * 0.5 + u[1][0] * 0.5 < (SELDOM / 2.0).sqrt() { 1.0 / SELDOM } else { 0.0 }
        },
        truth: 1.0,
        is_skewed: true,
    },
];

#[derive(Clone, Copy)]
enum Points {
    Independent,
    Sobol,
}

impl Points {
    fn numbers(self, run: u32, sample: u32) -> Numbers {
        std::array::from_fn(|pair| {
            let seed = u64::from(run) << 8 | pair as u64;
            match self {
                Self::Sobol => sobol_owen_2d(sample, seed).map(f64::from),
                Self::Independent => {
                    let mut rng = Rng::new(seed << 24 | u64::from(sample));
                    [rng.f64(), rng.f64()]
                }
            }
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Sobol => "Sobol'",
        }
    }
}

/// One line of the table.
struct Row {
    of: &'static str,
    points: Points,
    n: u32,
    /// Share of the runs whose interval holds the truth.
    coverage: f64,
    /// Root mean square of the standard errors over that of the errors.
    said_over_true: f64,
    is_skewed: bool,
}

fn rows() -> Vec<Row> {
    let cases = INTEGRANDS.iter().flat_map(|f| [(f, Points::Independent), (f, Points::Sobol)]);
    cases.flat_map(|(f, points)| rows_of(f, points)).collect()
}

fn rows_of(integrand: &Integrand, points: Points) -> Vec<Row> {
    let mut held = [0_u32; COUNTS.len()];
    let mut squares = [(0.0, 0.0); COUNTS.len()];
    for run in 0..RUNS {
        let mut pixel = Pixel::NONE;
        for sample in 0..COUNTS[COUNTS.len() - 1] {
            pixel.push(DVec3::splat((integrand.f)(&points.numbers(run, sample))));
            let Some(i) = COUNTS.iter().position(|n| *n == pixel.n) else { continue };
            let (error, said) = (pixel.mean.x - integrand.truth, pixel.standard_error().x);
            held[i] += u32::from(error.abs() <= said * half_width_95(pixel.n));
            squares[i].0 += said * said;
            squares[i].1 += error * error;
        }
    }
    let row = |i: usize| Row {
        of: integrand.name,
        points,
        n: COUNTS[i],
        coverage: f64::from(held[i]) / f64::from(RUNS),
        said_over_true: (squares[i].0 / squares[i].1).sqrt(),
        is_skewed: integrand.is_skewed,
    };
    (0..COUNTS.len()).map(row).collect()
}

fn table(rows: &[Row]) -> String {
    let mut out = String::from("| integrand | points | samples | coverage | said / true error |\n");
    out += "|---|---|---|---|---|\n";
    for Row { of, points, n, coverage, said_over_true, .. } in rows {
        let points = points.name();
        let percent = coverage * 100.0;
        writeln!(out, "| {of} | {points} | {n} | {percent:.1} % | {said_over_true:.2} |").unwrap();
    }
    out
}

#[test]
fn intervals_hold_the_truth_as_often_as_is_published() {
    let found = rows();
    let table = table(&found);
    println!("{table}");
    for row in &found {
        let Row { of, n, coverage, .. } = row;
        let counts = !row.is_skewed && *n >= LEAST;
        assert!(!counts || *coverage >= 0.93, "{of}, {n} samples: {coverage}\n{table}");
        // Where nothing is seldom, what is said is never much less than what is true: 1000 errors
        // tell their spread to 2.2 %, four times which is allowed.
        assert!(row.is_skewed || row.said_over_true > 0.91, "{of}, {n} samples\n{table}");
    }
    published::hold("accuracy.md", "coverage", &table);
}
