//! Welch's test of sums of pixels: whether they differ by more than their standard errors allow.
//!
//! Jung, Hanika and Dachsbacher, "Detecting Bias in Monte Carlo Renderers using Welch's t-test",
//! JCGT 9(2), 2020.

use glam::{DVec3, DVec4};
use luxel_core::film::degrees_of_freedom;
use luxel_sdk::color::RgbSpace;

use super::pair::Value;
use super::student::two_sided;

/// What is tested.
pub(super) const LANES: [&str; 4] = ["luminance", "R", "G", "B"];

/// Luminance and the channels of linear sRGB.
pub(super) fn lanes(rgb: DVec3) -> DVec4 {
    let weights = RgbSpace::LinearSrgb.luminance_weights();
    DVec4::new(weights.dot(rgb), rgb.x, rgb.y, rgb.z)
}

/// The difference of two sums over the same pixels, with the variance of either.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Pixels.
    pub(super) n: f64,
    /// Of the first picture less the second.
    difference: DVec4,
    /// Of the second picture.
    reference: DVec4,
    variance: DVec4,
    /// Welch and Satterthwaite's: squares of variances over their degrees of freedom.
    square: DVec4,
}

/// A float of 32 bits is off by this share of itself at most.
const ROUNDING: f64 = (f32::EPSILON / 2.0) as f64;

/// The standard error of `n` samples that are all equal, beside another picture of the pixel whose
/// samples are not: if nothing differs, samples of both scatter alike, and these have missed it.
fn missed(other: &Value, n: u32) -> DVec3 {
    other.se * (f64::from(other.n) / f64::from(n)).sqrt()
}

impl Sums {
    /// Adds a pixel that says how wrong it may be, in both pictures.
    pub(super) fn add(&mut self, [a, b]: [Value; 2]) {
        self.n += 1.0;
        self.difference += lanes(a.rgb) - lanes(b.rgb);
        self.reference += lanes(b.rgb);
        for (Value { rgb, se, n }, other) in [(a, b), (b, a)] {
            let known = DVec3::select(se.cmpgt(DVec3::ZERO), se, missed(&other, n));
            // Errors of the channels taken as fully correlated: for luminance an upper bound.
            let error = lanes(known);
            let rounding = lanes(rgb.abs()) * ROUNDING;
            let variance = error * error;
            self.variance += variance + rounding * rounding;
            self.square += variance * variance / degrees_of_freedom(n);
        }
    }

    /// Means and their tests, lane by lane.
    pub(super) fn tested(&self) -> [Tested; 4] {
        [0, 1, 2, 3].map(|i| {
            let n = self.n.max(1.0);
            let (difference, variance) = (self.difference[i], self.variance[i]);
            let dof = variance * variance / self.square[i];
            let se = variance.sqrt();
            // Without any noise, and without a difference, there is nothing to test.
            let p = (se > 0.0).then(|| two_sided(difference / se, dof));
            Tested {
                difference: difference / n,
                reference: self.reference[i] / n,
                se: se / n,
                dof: if dof.is_nan() { f64::INFINITY } else { dof },
                p,
            }
        })
    }
}

/// A mean difference and how likely chance alone makes one as large.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tested {
    pub(super) difference: f64,
    /// Mean of the second picture.
    pub(super) reference: f64,
    pub(super) se: f64,
    pub(super) dof: f64,
    /// Two-sided; nothing where nothing is random and nothing differs.
    pub(super) p: Option<f64>,
}

impl Tested {
    pub(super) fn relative(&self) -> f64 {
        self.difference / self.reference
    }

    pub(super) fn z(&self) -> f64 {
        if self.p.is_some() { self.difference / self.se } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a pixel of 16 samples, which have 15.
    fn value(v: f64, se: f64, n: u32) -> Value {
        Value { rgb: DVec3::splat(v), se: DVec3::splat(se), n }
    }

    #[test]
    fn equal_pixels_have_degrees_that_add_up_and_unequal_ones_those_of_the_worst() {
        let mut sums = Sums::default();
        for _ in 0..64 {
            sums.add([value(1.0, 0.1, 16), value(1.0, 0.1, 16)]);
        }
        let tested = sums.tested();
        for lane in tested {
            assert!((lane.dof / (2.0 * 64.0 * 15.0) - 1.0).abs() < 1e-9, "{}", lane.dof);
            assert!((lane.se / (0.1 * (2.0 / 64.0_f64).sqrt()) - 1.0).abs() < 1e-9);
            assert!(lane.p.unwrap() > 0.999);
        }
        sums.add([value(1.0, 100.0, 16), value(1.0, 0.1, 16)]);
        assert!((sums.tested()[2].dof - 15.0).abs() < 0.01);
    }

    #[test]
    fn a_difference_counts_against_its_error_in_the_lane_where_it_is() {
        let mut sums = Sums::default();
        for _ in 0..64 {
            let mut a = value(1.0, 0.1, 64);
            a.rgb.z += 0.1;
            sums.add([a, value(1.0, 0.1, 64)]);
        }
        let [luminance, red, _, blue] = sums.tested();
        // 0.1 over 0.1·√(2/64).
        assert!((blue.z() - 5.656_854).abs() < 1e-5 && blue.p.unwrap() < 1e-7, "{blue:?}");
        assert!((blue.relative() - 0.1).abs() < 1e-12);
        assert!(red.z().abs() < 1e-12);
        assert!(luminance.z() > 0.3 && luminance.z() < 0.5, "{luminance:?}");
    }

    #[test]
    fn equal_samples_beside_scattered_ones_have_missed_something() {
        // A tenth of the samples meet a light of 1; none of 16 does with a probability of 0.19.
        let many = value(0.1, 0.3 / 1000.0, 1_000_000);
        for pixel in [[value(0.0, 0.0, 16), many], [many, value(0.0, 0.0, 16)]] {
            let mut sums = Sums::default();
            sums.add(pixel);
            let tested = sums.tested()[1];
            assert!((tested.z().abs() - 4.0 / 3.0).abs() < 1e-4, "{tested:?}");
        }
    }

    #[test]
    fn what_is_not_random_may_differ_by_rounding_and_no_more() {
        let one = |a, b| {
            let mut sums = Sums::default();
            sums.add([value(a, 0.0, 4), value(b, 0.0, 4)]);
            sums.tested()[1]
        };
        assert!(one(0.0, 0.0).p.is_none());
        assert!(one(1.0, 1.0 + ROUNDING).p.unwrap() > 0.3);
        assert!(one(1.0, 1.0 + 30.0 * ROUNDING).p.unwrap() < 1e-9);
    }
}
