//! Separable filters over a plane of numbers.

/// Numbers row by row.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) values: Vec<f64>,
}

/// A product of a function of x and one of y, cut to a square.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Kernel {
    /// `radius` whole pixels on each side of the middle.
    #[expect(clippy::cast_possible_truncation, reason = "a few pixels")]
    pub(super) fn new(radius: f64, x: impl Fn(f64) -> f64, y: impl Fn(f64) -> f64) -> Self {
        let side = |f: &dyn Fn(f64) -> f64| {
            (-(radius as i32)..=radius as i32).map(|i| f(f64::from(i))).collect()
        };
        Self { x: side(&x), y: side(&y) }
    }

    pub(super) fn sum(&self) -> f64 {
        self.x.iter().sum::<f64>() * self.y.iter().sum::<f64>()
    }

    pub(super) fn scale(&mut self, by: f64) {
        self.x.iter_mut().for_each(|v| *v *= by);
    }

    /// Scales so that all that is positive sums to 1 and all that is negative to −1.
    pub(super) fn balance(&mut self) {
        let across: f64 = self.y.iter().sum();
        let (positive, negative) = self.x.iter().fold((0.0, 0.0), |(positive, negative), v| {
            (positive + f64::max(*v, 0.0), negative - f64::min(*v, 0.0))
        });
        for v in &mut self.x {
            *v /= across * if *v < 0.0 { negative } else { positive };
        }
    }

    /// The same along the other axis.
    pub(super) fn turned(self) -> Self {
        Self { x: self.y, y: self.x }
    }
}

impl Plane {
    /// The plane under a sum of kernels; beyond its borders it goes on as it ends there.
    pub(super) fn filtered(&self, kernels: &[Kernel]) -> Self {
        let mut values = vec![0.0; self.values.len()];
        for kernel in kernels {
            let rows = along(&self.values, self.width, 1, &kernel.x);
            let both = along(&rows, self.values.len() / self.width.max(1), self.width, &kernel.y);
            values.iter_mut().zip(both).for_each(|(sum, v)| *sum += v);
        }
        Self { width: self.width, values }
    }
}

/// Filters lines of `length` numbers, `step` apart.
fn along(values: &[f64], length: usize, step: usize, weights: &[f64]) -> Vec<f64> {
    let radius = weights.len() / 2;
    let one = |at: usize| {
        let place = at / step % length;
        let start = at - place * step;
        let terms = weights.iter().enumerate().map(|(i, weight)| {
            let from = (place + i).saturating_sub(radius).min(length - 1);
            weight * values[start + from * step]
        });
        terms.sum()
    };
    (0..values.len()).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_leaves_what_is_flat_and_moves_what_is_not() {
        let flat = Plane { width: 5, values: vec![2.0; 20] };
        let mut bell = Kernel::new(2.0, |x| 3.0 - x.abs(), |y| 3.0 - y.abs());
        bell.scale(1.0 / bell.sum());
        let same = flat.filtered(&[bell]);
        assert!(same.values.iter().all(|v| (v - 2.0).abs() < 1e-12));
        // A ramp in y under the slope in y.
        let ramp = Plane { width: 3, values: (0..15_u8).map(|i| f64::from(i / 3)).collect() };
        let mut slope = Kernel::new(1.0, |x| x, |_| 1.0);
        slope.balance();
        let flat = ramp.filtered(&[slope.clone()]);
        assert!(flat.values.iter().all(|v| v.abs() < 1e-12));
        let steep = ramp.filtered(&[slope.turned()]);
        assert!(steep.values[3..12].iter().all(|v| (v - 2.0).abs() < 1e-12), "{steep:?}");
        assert!((steep.values[0] - 1.0).abs() < 1e-12);
    }
}
