//! The chi-square test that every warp of this room must pass.

use std::f64::consts::TAU;

use glam::Vec3;

use super::Rng;

/// One-sided normal quantile of the significance 1e-5 with which one test fails by chance.
const QUANTILE: f64 = 4.265;

/// Cells are joined until each expects this many samples, the usual limit of the approximation.
const MIN_EXPECTED: f64 = 5.0;

/// Cell of `x` in [0, 1] among `n`; 1 belongs to the last.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, n)")]
pub(super) fn fraction_cell(x: f64, n: usize) -> usize {
    ((x.max(0.0) * n as f64) as usize).min(n - 1)
}

/// A histogram of samples.
pub(super) struct Counts {
    cells: Vec<u32>,
}

impl Counts {
    pub(super) fn new(n: usize) -> Self {
        Self { cells: vec![0; n] }
    }

    pub(super) fn add(&mut self, cell: usize) {
        self.cells[cell] += 1;
    }

    /// Asserts that the probabilities sum to 1 and that the samples follow them.
    pub(super) fn check(&self, probability: impl Fn(usize) -> f64) {
        let n: f64 = self.cells.iter().map(|&c| f64::from(c)).sum();
        let (mut statistic, mut groups, mut integral) = (0.0, 0.0, 0.0);
        let (mut expected, mut found) = (0.0, 0.0);
        for (i, &c) in self.cells.iter().enumerate() {
            let p = probability(i);
            assert!(p > 0.0 || c == 0, "{c} samples in cell {i} of no probability");
            integral += p;
            expected += n * p;
            found += f64::from(c);
            if expected >= MIN_EXPECTED {
                statistic += (found - expected).powi(2) / expected;
                groups += 1.0;
                (expected, found) = (0.0, 0.0);
            }
        }
        // The sum of the midpoint rule, and of f32 densities, is good to a thousandth.
        assert!((integral - 1.0f64).abs() <= 1e-3, "the density integrates to {integral}");
        // Wilson & Hilferty 1931: the cube root of chi-square over k is nearly normal.
        let k: f64 = groups - 1.0;
        let spread = 2.0 / (9.0 * k);
        let critical = k * (1.0 - spread + QUANTILE * spread.sqrt()).powi(3);
        assert!(statistic <= critical, "chi-square {statistic} above {critical}, {k} degrees");
    }
}

/// Draws directions and compares them with `pdf` (sr⁻¹) over cells of equal solid angle.
pub(super) fn check_directions(
    seed: u64,
    sample: impl Fn([f32; 2]) -> Vec3,
    pdf: impl Fn(Vec3) -> f32,
) {
    let (rows, columns) = (16, 24);
    let mut counts = Counts::new(rows * columns);
    let mut rng = Rng::new(seed);
    for _ in 0..60_000 {
        let w = sample(rng.pair()).as_dvec3();
        let turn = (w.y.atan2(w.x) / TAU).rem_euclid(1.0);
        counts.add(fraction_cell(0.5 * w.z + 0.5, rows) * columns + fraction_cell(turn, columns));
    }
    // Midpoint rule with 12 × 12 points in each cell.
    let fine = 12;
    let solid_angle = 2.0 * TAU / (rows * columns * fine * fine) as f64;
    counts.check(|cell| {
        let (row, column) = (cell / columns, cell % columns);
        let mut sum = 0.0;
        for i in 0..fine * fine {
            let z = (row as f64 + ((i / fine) as f64 + 0.5) / fine as f64) / rows as f64;
            let turn = (column as f64 + ((i % fine) as f64 + 0.5) / fine as f64) / columns as f64;
            let z = 2.0 * z - 1.0;
            let (sin, cos) = (TAU * turn).sin_cos();
            let r = (1.0 - z * z).sqrt();
            sum += f64::from(pdf(glam::DVec3::new(r * cos, r * sin, z).as_vec3()));
        }
        sum * solid_angle
    });
}

#[test]
fn the_chi_square_test_itself_can_fail() {
    let mut counts = Counts::new(10);
    for i in 0..10_000 {
        counts.add(if i % 20 == 1 { 0 } else { i % 10 });
    }
    let wrong = std::panic::catch_unwind(|| counts.check(|_| 0.1));
    assert!(wrong.is_err());
}
