//! From pictures with independent random numbers to variance and bias.
//!
//! A picture's error against the truth is what scatters between pictures, and what all of them have in
//! common. The first is their spread; the second the mean product of the errors of two different
//! pictures, in which independent noise cancels. Both are unbiased, and a reference that is itself
//! measured only adds its own known variance, which is taken off.

/// A number with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Number {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// Standard errors beyond which something is taken for real: of a hundred true zeros none is, with
/// probability 0.997.
pub(super) const SIGMAS: f64 = 4.0;

/// Pictures are in single precision: a bias below this is rounding.
const ROUNDING: f64 = 1e-6;

impl Number {
    /// Mean of independent values, of which there are two at least.
    pub(super) fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let n = values.clone().count() as f64;
        let value = values.clone().sum::<f64>() / n;
        let squares: f64 = values.map(|x| (x - value) * (x - value)).sum();
        Self { value, error: (squares / (n - 1.0) / n).sqrt() }
    }

    /// The square root, which is zero below.
    pub(super) fn root(self) -> Self {
        let value = self.value.max(0.0).sqrt();
        // To first order; near zero the root of the error.
        let error =
            if self.value > self.error { 0.5 * self.error / value } else { self.error.sqrt() };
        Self { value, error }
    }
}

/// Share of a picture's mean that a darker pixel's error is compared with, as `luxel render --error`.
const DARK: f64 = 0.1;

/// What pictures are compared with.
pub(super) struct Reference {
    /// Luminance of each pixel.
    mean: Vec<f64>,
    /// Variance of that.
    variance: Vec<f64>,
    /// What errors are divided by.
    scale: Vec<f64>,
    /// Pictures that it is the mean of; infinitely many where it is the truth.
    pictures: f64,
}

impl Reference {
    /// The mean of two pictures or more; `None` if they are black.
    pub(super) fn of(pictures: &[&[f32]]) -> Option<Self> {
        let n_pixels = pictures.first()?.len();
        let pixel = |i: usize| Number::of(pictures.iter().map(move |p| f64::from(p[i])));
        let pixels: Vec<Number> = (0..n_pixels).map(pixel).collect();
        let variance = pixels.iter().map(|pixel| pixel.error * pixel.error).collect();
        let mean = pixels.iter().map(|pixel| pixel.value).collect();
        Self::new(mean, variance, pictures.len() as f64)
    }

    /// A truth that is the same everywhere.
    pub(super) fn flat(luminance: f64, n_pixels: usize) -> Option<Self> {
        Self::new(vec![luminance; n_pixels], vec![0.0; n_pixels], f64::INFINITY)
    }

    fn new(mean: Vec<f64>, variance: Vec<f64>, pictures: f64) -> Option<Self> {
        let dark = DARK * mean.iter().sum::<f64>() / mean.len() as f64;
        let scale = mean.iter().map(|x| x.max(dark)).collect();
        (dark > 0.0).then_some(Self { mean, variance, scale, pictures })
    }

    /// Squared relative error of a picture, mean over the pixels, without what the reference adds.
    pub(super) fn squared_error(&self, picture: &[f32]) -> f64 {
        let error = |i: usize| (f64::from(picture[i]) - self.mean[i]) / self.scale[i];
        let squares: f64 = (0..self.mean.len()).map(|i| error(i) * error(i)).sum();
        squares / self.mean.len() as f64 - self.error() * self.error()
    }

    /// Standard error of what the squared errors of all pictures have in common, as they are against
    /// the same reference: the square of its noise, about the variance that is taken off.
    ///
    /// Of normal noise of variance s, known from K pictures: the square scatters by 2 s², the variance
    /// by 2 s² / (K − 1).
    pub(super) fn common_error(&self) -> f64 {
        let share = |(v, s): (&f64, &f64)| (v / (s * s)).powi(2);
        let squares: f64 = self.variance.iter().zip(&self.scale).map(share).sum();
        let known = 1.0 + 1.0 / (self.pictures - 1.0);
        (2.0 * squares * known).sqrt() / self.mean.len() as f64
    }

    /// Its own relative error, root mean square.
    pub(super) fn error(&self) -> f64 {
        let squares = self.variance.iter().zip(&self.scale).map(|(v, s)| v / (s * s));
        (squares.sum::<f64>() / self.mean.len() as f64).sqrt()
    }
}

/// How wrong pictures of one kind are: shares, squared, mean over the pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    /// What scatters.
    pub(super) variance: Number,
    /// What does not; may come out below zero where it is none.
    pub(super) bias2: Number,
}

impl Estimate {
    /// Of two pictures or more.
    pub(super) fn of(pictures: &[&[f32]], reference: &Reference) -> Self {
        let n = pictures.len() as f64;
        let Reference { mean, variance, scale, .. } = reference;
        let (mut of_picture, mut common) = (vec![0.0; pictures.len()], vec![]);
        for i in 0..mean.len() {
            let errors = pictures.iter().map(|p| (f64::from(p[i]) - mean[i]) / scale[i]);
            let (sum, squares) = errors.clone().fold((0.0, 0.0), |(s, q), e| (s + e, q + e * e));
            let own = variance[i] / (scale[i] * scale[i]);
            // Each pixel is an independent witness, also of the reference's noise.
            common.push((sum * sum - squares) / (n * (n - 1.0)) - own);
            for (of_picture, error) in of_picture.iter_mut().zip(errors) {
                let from_mean = error - sum / n;
                *of_picture += from_mean * from_mean * n / (n - 1.0) / mean.len() as f64;
            }
        }
        Self {
            variance: Number::of(of_picture.iter().copied()),
            bias2: Number::of(common.iter().copied()),
        }
    }

    /// The squared bias where there is one for certain, else zero.
    pub(super) fn known_bias2(&self) -> f64 {
        if self.is_biased() { self.bias2.value } else { 0.0 }
    }

    pub(super) fn is_biased(&self) -> bool {
        self.bias2.value > self.unseen().powi(2)
    }

    /// A bias below this would not have been seen.
    pub(super) fn unseen(&self) -> f64 {
        (SIGMAS * self.bias2.error).sqrt().max(ROUNDING)
    }

    /// Relative error, root mean square.
    pub(super) fn rmse(&self) -> f64 {
        (self.variance.value + self.known_bias2()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform numbers in [-1, 1): of variance 1/3.
    struct Noise(u64);

    impl Noise {
        fn next(&mut self) -> f64 {
            // Knuth's MMIX generator, of which the upper bits are good.
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            f64::from(u32::try_from(self.0 >> 32).unwrap()) / f64::from(1_u32 << 31) - 1.0
        }

        #[expect(clippy::cast_possible_truncation, reason = "pictures are in single precision")]
        fn picture(&mut self, mean: f64) -> Vec<f32> {
            (0..4096).map(|_| (mean + 0.3 * self.next()) as f32).collect()
        }

        fn pictures(&mut self, n: usize, mean: f64) -> Vec<Vec<f32>> {
            (0..n).map(|_| self.picture(mean)).collect()
        }
    }

    fn refs(pictures: &[Vec<f32>]) -> Vec<&[f32]> {
        pictures.iter().map(Vec::as_slice).collect()
    }

    fn near(number: Number, truth: f64) {
        let off = (number.value - truth).abs();
        assert!(off <= SIGMAS * number.error, "{number:?} {truth}");
    }

    #[test]
    fn variance_and_bias_come_apart_also_against_a_noisy_reference() {
        let mut noise = Noise(1);
        let reference = noise.pictures(16, 2.0);
        let reference = Reference::of(&refs(&reference)).unwrap();
        // 0.09 / 3 over 16 pictures, relative to 2.
        assert!((reference.error() - (0.03_f64 / 16.0).sqrt() / 2.0).abs() < 1e-3);
        let pictures = noise.pictures(16, 2.1);
        let estimate = Estimate::of(&refs(&pictures), &reference);
        near(estimate.variance, 0.03 / 4.0);
        near(estimate.bias2, 0.05 * 0.05);
        let both = Number::of(pictures.iter().map(|picture| reference.squared_error(picture)));
        let error = both.error.hypot(reference.common_error());
        near(Number { error, ..both }, 0.03 / 4.0 + 0.05 * 0.05);
        assert!(estimate.is_biased() && estimate.unseen() < 0.05, "{estimate:?}");
        let right = Estimate::of(&refs(&noise.pictures(16, 2.0)), &reference);
        near(right.bias2, 0.0);
        assert!(!right.is_biased() && right.known_bias2().abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn true_zeros_are_told_as_bias_no_oftener_than_said() {
        let mut noise = Noise(2);
        let reference = Reference::flat(1.0, 4096).unwrap();
        // Of 200, one with probability 0.6 %.
        let runs = (0..200).map(|_| Estimate::of(&refs(&noise.pictures(4, 1.0)), &reference));
        assert_eq!(runs.filter(Estimate::is_biased).count(), 0);
    }

    #[test]
    fn dark_pixels_are_compared_with_a_tenth_of_the_mean_and_black_ones_with_nothing() {
        let picture: Vec<f32> = [vec![0.0; 50], vec![2.0; 50]].concat();
        let reference = Reference::of(&[&picture, &picture]).unwrap();
        assert!(
            (reference.scale[0] - 0.1).abs() < 1e-12 && (reference.scale[99] - 2.0).abs() < 1e-12
        );
        assert!(Reference::flat(0.0, 4).is_none());
        assert!(Reference::of(&[&[0.0, 0.0], &[0.0, 0.0]]).is_none());
    }
}
