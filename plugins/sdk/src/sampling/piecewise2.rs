//! Piecewise-constant densities over the unit square: images as importance.

use super::piecewise::Piecewise1;
use super::weights::{WeightError, largest, relative};

/// A density over [0, 1)² that is constant on each texel of an image: a marginal over rows and a
/// conditional along each.
///
/// # Source
/// PBR4 §A.4.2 and §A.5.6.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise2 {
    rows: Vec<Piecewise1>,
    marginal: Piecewise1,
    mean: f64,
}

/// A draw from a [`Piecewise2`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piecewise2Sample {
    /// The place in [0, 1)²: across, then down the image.
    pub uv: [f64; 2],
    /// Density with respect to area of the unit square; its integral is 1.
    pub pdf: f64,
    /// Column and row of the texel.
    pub texel: [usize; 2],
}

impl Piecewise2 {
    /// A density proportional to `weights`, `width` to a row, first row at v = 0; uniform if all
    /// are zero.
    ///
    /// Keeps 12 to 16 bytes for each weight.
    ///
    /// # Errors
    /// If a side is zero, if the number of weights is not a multiple of `width`, or if a weight is
    /// negative, infinite or NaN.
    pub fn new(weights: &[f64], width: usize) -> Result<Self, WeightError> {
        Self::new_while(weights, width, || true)
    }

    /// The same, as long as it is wanted, which is asked before each row.
    ///
    /// # Errors
    /// As `new`; that it is not wanted any more.
    pub fn new_while(
        weights: &[f64],
        width: usize,
        is_wanted: impl Fn() -> bool,
    ) -> Result<Self, WeightError> {
        if width == 0 || weights.is_empty() {
            return Err(WeightError::Empty);
        }
        if !weights.len().is_multiple_of(width) {
            return Err(WeightError::Size);
        }
        let rows = || {
            weights.chunks_exact(width).enumerate().map(|(i, row)| {
                if is_wanted() { Ok((i * width, row)) } else { Err(WeightError::Unwanted) }
            })
        };
        let mut most: f64 = 0.0;
        for row in rows() {
            let (first, row) = row?;
            most = most.max(largest(row).map_err(|error| error.after(first))?);
        }
        let along: Vec<_> =
            rows().map(|row| Piecewise1::new(row?.1)).collect::<Result<_, WeightError>>()?;
        // In units of the largest weight, so that no row overflows.
        let sum = |row: &[f64]| row.iter().map(|&w| relative(w, most)).sum();
        let sums: Vec<f64> =
            rows().map(|row| Ok(sum(row?.1))).collect::<Result<_, WeightError>>()?;
        let marginal = Piecewise1::new(&sums)?;
        let mean = if most > 0.0 { most * (marginal.integral() / width as f64) } else { 0.0 };
        Ok(Self { rows: along, marginal, mean })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.rows[0].n_steps(), self.rows.len()]
    }

    /// Bytes of memory that it takes.
    pub fn bytes(&self) -> usize {
        self.rows.iter().chain([&self.marginal]).map(Piecewise1::bytes).sum()
    }

    /// The integral of the weights as a function over [0, 1)²: their mean.
    pub fn integral(&self) -> f64 {
        self.mean
    }

    /// Draws a place; `u` in [0, 1)², and anything else counts as the nearer end.
    pub fn sample(&self, u: [f64; 2]) -> Piecewise2Sample {
        let v = self.marginal.sample(u[1]);
        let across = self.rows[v.index].sample(u[0]);
        Piecewise2Sample {
            uv: [across.x, v.x],
            pdf: across.pdf * v.pdf,
            texel: [across.index, v.index],
        }
    }

    /// Density at `uv`; 0 outside [0, 1)².
    pub fn pdf(&self, uv: [f64; 2]) -> f64 {
        match self.marginal.step(uv[1]) {
            Some(row) => self.rows[row].pdf(uv[0]) * self.marginal.pdf(uv[1]),
            None => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::Counts;

    const WEIGHTS: [f64; 12] = [0.0, 1.0, 2.0, 0.5, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.25, 0.25];

    #[test]
    fn samples_follow_the_image() {
        let d = Piecewise2::new(&WEIGHTS, 4).unwrap();
        assert_eq!(d.size(), [4, 3]);
        // Five bounds and five places in each row, four of both beside them.
        let (f64s, u32s) = (3 * 5 + 4, 3 * 5 + 5);
        let rows = 4 * size_of::<Piecewise1>();
        assert_eq!(d.bytes(), 8 * f64s + 4 * u32s + rows);
        assert!((d.integral() - 8.0 / 12.0).abs() <= 4.0 * f64::EPSILON);
        let mut counts = Counts::new(12);
        let mut rng = Rng::new(24);
        for _ in 0..20_000 {
            let s = d.sample([rng.f64(), rng.f64()]);
            let texel = s.texel[1] * 4 + s.texel[0];
            counts.add(texel);
            // Density is weight over mean; a handful of roundings.
            assert!((s.pdf / (WEIGHTS[texel] * 1.5) - 1.0).abs() <= 16.0 * f64::EPSILON);
            assert!((d.pdf(s.uv) - s.pdf).abs() <= 0.0);
        }
        counts.check(|i| WEIGHTS[i] / 8.0);
    }

    #[test]
    fn a_single_bright_texel_is_always_found() {
        let mut weights = vec![0.0; 64 * 32];
        weights[20 * 64 + 63] = 1e300;
        let d = Piecewise2::new(&weights, 64).unwrap();
        for u in [[0.0, 0.0], [0.5, 0.99], [f64::NAN, 2.0]] {
            assert_eq!(d.sample(u).texel, [63, 20]);
        }
        assert!(d.integral().is_finite() && d.pdf([0.0, 0.0]) <= 0.0);
    }

    #[test]
    fn black_images_are_uniform_and_misshapen_ones_refused() {
        let d = Piecewise2::new(&[0.0; 6], 3).unwrap();
        assert!((d.pdf([0.9, 0.1]) - 1.0).abs() <= f64::EPSILON);
        assert!(d.pdf([0.5, 1.0]) <= 0.0);
        assert_eq!(Piecewise2::new(&[1.0; 6], 4), Err(WeightError::Size));
        assert_eq!(Piecewise2::new(&[1.0; 6], 0), Err(WeightError::Empty));
        assert_eq!(Piecewise2::new(&[], 1), Err(WeightError::Empty));
        assert_eq!(Piecewise2::new(&[1.0, -1.0], 1), Err(WeightError::Invalid(1)));
        assert_eq!(Piecewise2::new(&[1.0, 1.0, 1.0, -1.0], 2), Err(WeightError::Invalid(3)));
    }

    #[test]
    fn what_is_not_wanted_any_more_is_left_off_at_the_next_row() {
        let made = |most: usize| {
            let asked = std::cell::Cell::new(0);
            let is_wanted = || asked.replace(asked.get() + 1) < most;
            (Piecewise2::new_while(&WEIGHTS, 4, is_wanted), asked.get())
        };
        let (whole, asked) = made(usize::MAX);
        assert_eq!((whole, asked), (Piecewise2::new(&WEIGHTS, 4), 9));
        for most in 0..9 {
            assert_eq!(made(most), (Err(WeightError::Unwanted), most + 1));
        }
    }
}
