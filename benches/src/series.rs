//! Repeated measurements.

/// Measurements of one thing, in any unit; at least one.
pub(crate) struct Series(Vec<f64>);

impl Series {
    /// Measures `n` times.
    pub(crate) fn of(n: usize, mut measure: impl FnMut() -> f64) -> Self {
        Self::from((0..n.max(1)).map(|_| measure()).collect())
    }

    /// Sorts what was measured. An empty list counts as one zero.
    pub(crate) fn from(mut values: Vec<f64>) -> Self {
        if values.is_empty() {
            values.push(0.0);
        }
        values.sort_by(f64::total_cmp);
        Self(values)
    }

    pub(crate) fn min(&self) -> f64 {
        self.0[0]
    }

    /// The middle; of an even number the upper one of the two.
    pub(crate) fn median(&self) -> f64 {
        self.0[self.0.len() / 2]
    }

    /// What so many of a hundred values do not exceed.
    pub(crate) fn percentile(&self, percent: usize) -> f64 {
        self.0[(self.0.len() * percent).div_ceil(100).max(1) - 1]
    }

    /// Range over median, in per cent.
    pub(crate) fn spread(&self) -> f64 {
        (self.0[self.0.len() - 1] - self.0[0]) / self.median() * 100.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_and_the_range_do_not_depend_on_the_order() {
        let series = Series::from(vec![4.0, 1.0, 2.0]);
        assert_eq!((series.min(), series.median(), series.spread()), (1.0, 2.0, 150.0));
        let percentiles = (series.percentile(33), series.percentile(34), series.percentile(99));
        assert_eq!(percentiles, (1.0, 2.0, 4.0));
    }
}
