//! How far apart two pictures are, whatever the reason. The second is the reference.

use glam::DVec3;

use super::pair::Pair;
use super::welch::lanes;

/// Relative errors divide by the reference's luminance, and by no less than this share of its mean.
pub(super) const FLOOR: f64 = 0.01;

/// Measures of the pixels that are finite in both pictures.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Numbers {
    /// Mean of squared differences, over pixels and channels; NaN of no pixel.
    pub(super) mse: f64,
    /// What the standard errors let one expect of it between equal pictures; nothing if a pixel does
    /// not say how wrong it is.
    pub(super) expected_mse: Option<f64>,
    /// The same as `mse`, each pixel relative to the reference's luminance.
    pub(super) rel_mse: f64,
    /// The largest distance of two values, counted in floats of 32 bits between them.
    pub(super) max_ulp: u32,
    /// Pixels with a value that is not finite, of either picture.
    pub(super) not_finite: [usize; 2],
    /// Pixels that are finite in one picture alone.
    pub(super) finite_in_one: usize,
}

impl Numbers {
    pub(super) fn of(pair: &Pair) -> Self {
        let floor = FLOOR * mean_luminance(pair);
        let (mut found, mut n, mut noise) = (Self::default(), 0.0, 0.0);
        for [a, b] in pair.pixels() {
            let bad = [a, b].map(|value| !value.rgb.is_finite());
            for (count, bad) in found.not_finite.iter_mut().zip(bad) {
                *count += usize::from(bad);
            }
            found.finite_in_one += usize::from(bad[0] != bad[1]);
            if bad != [false; 2] {
                continue;
            }
            let square = (a.rgb - b.rgb).length_squared() / 3.0;
            let scale = lanes(b.rgb).x.max(floor);
            n += 1.0;
            found.mse += square;
            // Where all is black there is nothing to be relative to.
            found.rel_mse += if square > 0.0 { square / (scale * scale) } else { 0.0 };
            noise += (a.se.length_squared() + b.se.length_squared()) / 3.0;
            found.max_ulp = found.max_ulp.max(ulps(a.rgb, b.rgb));
        }
        // Of no pixel at all there is none: NaN.
        found.mse /= n;
        found.rel_mse /= n;
        found.expected_mse = Some(noise / n).filter(|noise| noise.is_finite());
        found
    }
}

/// Mean luminance of the reference, over the pixels that are finite.
pub(super) fn mean_luminance(pair: &Pair) -> f64 {
    let finite = pair.pixels().filter(|[_, b]| b.rgb.is_finite());
    let (sum, n) = finite.fold((0.0, 0.0), |(sum, n), [_, b]| (sum + lanes(b.rgb).x, n + 1.0));
    sum / f64::max(n, 1.0)
}

fn ulps(a: DVec3, b: DVec3) -> u32 {
    #[expect(clippy::cast_possible_truncation, reason = "the values were 32-bit floats")]
    let apart = |(a, b): (f64, f64)| place(a as f32).abs_diff(place(b as f32));
    a.to_array().into_iter().zip(b.to_array()).map(apart).max().unwrap_or(0)
}

/// The how many-th float it is, counted from zero.
fn place(x: f32) -> i32 {
    let magnitude = (x.abs().to_bits()).cast_signed();
    if x.is_sign_negative() { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;
    use luxel_core::film::Rect;

    use super::*;
    use crate::compare::pair::tests::flat;

    fn pair(a: f32, b: f32) -> Pair {
        let size = UVec2::splat(4);
        let window = Rect::new(UVec2::ZERO, size);
        Pair::new(flat(size, window, a, 0.3), flat(size, window, b, 0.4)).unwrap()
    }

    #[test]
    fn flat_pictures_have_the_numbers_of_one_pixel() {
        let found = Numbers::of(&pair(3.0, 2.0));
        assert!((found.mse - 1.0).abs() < 1e-12 && (found.rel_mse - 0.25).abs() < 1e-12);
        // 0.3² + 0.4², rounded to floats of 32 bits.
        assert!((found.expected_mse.unwrap() - 0.25).abs() < 1e-6);
        // From 2 to 3 is half of a factor of two: 2^22 floats.
        assert_eq!(found.max_ulp, 1 << 22);
        assert_eq!(Numbers::of(&pair(-0.0, 0.0)).max_ulp, 0);
        assert_eq!(Numbers::of(&pair(-1e-45, 1e-45)).max_ulp, 2);
    }

    #[test]
    fn a_dark_reference_divides_by_no_less_than_its_floor() {
        let mut pair = pair(1.0, 1.0);
        // One black pixel of sixteen: the mean is 15/16.
        pair.b.rgb[..3].fill(0.0);
        let expected = (1.0 / (FLOOR * 15.0 / 16.0)).powi(2) / 16.0;
        assert!((Numbers::of(&pair).rel_mse / expected - 1.0).abs() < 1e-9);
        pair.b.rgb.fill(0.0);
        pair.a.rgb.fill(0.0);
        assert!(Numbers::of(&pair).rel_mse <= 0.0);
    }

    #[test]
    fn values_that_are_not_finite_are_counted_and_left_out() {
        let mut pair = pair(1.0, 1.0);
        pair.a.rgb[0] = f32::NAN;
        pair.a.rgb[3] = f32::INFINITY;
        pair.b.rgb[4] = f32::NAN;
        let found = Numbers::of(&pair);
        assert_eq!((found.not_finite, found.finite_in_one), ([2, 1], 1));
        assert!(found.mse <= 0.0);
        // Of no pixel at all there is none.
        pair.a.rgb.fill(f32::NAN);
        let found = Numbers::of(&pair);
        assert!(found.mse.is_nan() && found.rel_mse.is_nan() && found.expected_mse.is_none());
    }
}
