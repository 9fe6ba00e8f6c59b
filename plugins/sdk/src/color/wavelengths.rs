//! Hero wavelengths: four wavelengths per path, one drawn, three at equal strides of the random number.
//!
//! Wilkie et al. 2014, "Hero wavelength spectral sampling"; density of PBR4 §4.5.4.

use super::Spectrum;

/// Shortest wavelength carried, nm.
pub const LAMBDA_MIN: f32 = 360.0;
/// Longest wavelength carried, nm.
pub const LAMBDA_MAX: f32 = 830.0;
/// Width of the band, nm: a radiance lane is spectral radiance times this.
pub const BAND_NM: f32 = LAMBDA_MAX - LAMBDA_MIN;

/// Centre of the density, nm (PBR4 §4.5.4).
const CENTRE: f64 = 538.0;
/// Steepness of the density, nm⁻¹ (PBR4 §4.5.4).
const STEEPNESS: f64 = 0.0072;
/// tanh(`STEEPNESS` · (`CENTRE` − `LAMBDA_MIN`)).
const TANH_MIN: f64 = 0.856_910_625_469_828;
/// tanh(`STEEPNESS` · (`LAMBDA_MAX` − `CENTRE`)).
const TANH_MAX: f64 = 0.970_591_346_940_269_8;

/// The four wavelengths of one path and their densities.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Wavelengths {
    /// Wavelengths, nm, in [360, 830].
    pub lambda: Spectrum,
    /// Density of each, nm⁻¹; zero for one that no longer counts.
    pub pdf: Spectrum,
}

impl Wavelengths {
    /// Draws four wavelengths by their importance to the eye from `u` in [0, 1).
    ///
    /// Each has the density [`Wavelengths::density`]; they are stratified among each other. A NaN gives
    /// NaN wavelengths, at which curves still evaluate without a panic.
    ///
    /// # Source
    /// PBR4 §4.5.4, by tanh rather than cosh: t = tanh(k(c − λ)) is uniform, the density k(1 − t²)/Σ.
    #[expect(clippy::cast_possible_truncation, reason = "constants rounded to working precision")]
    pub fn sample(u: f32) -> Self {
        const SPAN: f32 = (TANH_MIN + TANH_MAX) as f32;
        const K: f32 = STEEPNESS as f32;
        let mut lambda = [0.0; 4];
        let mut pdf = [0.0; 4];
        for (i, stride) in [0.0, 0.25, 0.5, 0.75].into_iter().enumerate() {
            let v = if u + stride < 1.0 { u + stride } else { u + stride - 1.0 };
            let t = TANH_MIN as f32 - SPAN * v;
            let atanh = 0.5 * ((1.0 + t) / (1.0 - t)).ln();
            lambda[i] = (CENTRE as f32 - atanh / K).clamp(LAMBDA_MIN, LAMBDA_MAX);
            pdf[i] = K * (1.0 - t * t) / SPAN;
        }
        Self { lambda: Spectrum::from_array(lambda), pdf: Spectrum::from_array(pdf) }
    }

    /// The density with which [`Wavelengths::sample`] draws `lambda` (nm), nm⁻¹: zero outside
    /// [360, 830], one over that range in total.
    pub fn density(lambda: f64) -> f64 {
        if !(f64::from(LAMBDA_MIN)..=f64::from(LAMBDA_MAX)).contains(&lambda) {
            return 0.0;
        }
        let sech = (STEEPNESS * (lambda - CENTRE)).cosh().recip();
        STEEPNESS * sech * sech / (TANH_MIN + TANH_MAX)
    }

    /// Ends wavelengths 1 to 3, for a path whose direction depends on the first: their density
    /// becomes zero and the first stands for all four. A second call changes nothing.
    ///
    /// # Source
    /// PBR4 §4.5.4, `TerminateSecondary`.
    pub fn terminate_secondary(&mut self) {
        if !self.secondary_terminated() {
            self.pdf = Spectrum::new(self.pdf[0] * 0.25, 0.0, 0.0, 0.0);
        }
    }

    /// Whether only the first wavelength still counts.
    pub fn secondary_terminated(&self) -> bool {
        self.pdf.0.truncate().y <= 0.0 && self.pdf[2] <= 0.0 && self.pdf[3] <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_integrates_to_one() {
        // The constants are what their names say, so the antiderivative spans one to rounding.
        assert!(((STEEPNESS * 178.0).tanh() - TANH_MIN).abs() < 4.0 * f64::EPSILON);
        assert!(((STEEPNESS * 292.0).tanh() - TANH_MAX).abs() < 4.0 * f64::EPSILON);
        // Simpson at 0.5 nm: h⁴/180 · ∫|f⁗| < 1e-9.
        let h = 0.5;
        let sum: f64 = (0..=940)
            .map(|i| {
                let weight = if i == 0 || i == 940 { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
                weight * Wavelengths::density(360.0 + h * f64::from(i))
            })
            .sum();
        assert!((sum * h / 3.0 - 1.0).abs() < 1e-8, "{}", sum * h / 3.0);
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "test input")]
    fn samples_are_in_range_and_carry_their_density() {
        for i in 0..=4096 {
            let u = (f64::from(i) / 4096.0).min(1.0 - 2f64.powi(-24)) as f32;
            let w = Wavelengths::sample(u);
            for lane in 0..4 {
                let lambda = w.lambda[lane];
                assert!((LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda));
                // 1 − t² ≥ .058 loses a factor 17 of f32 precision, and so does λ through atanh.
                let exact = Wavelengths::density(f64::from(lambda));
                let rel = (f64::from(w.pdf[lane]) / exact - 1.0).abs();
                assert!(rel < 64.0 * f64::from(f32::EPSILON), "{lambda} nm: {rel}");
            }
        }
    }

    #[test]
    fn half_the_samples_lie_below_the_median_sample() {
        let median = f64::from(Wavelengths::sample(0.5).lambda[0]);
        // Midpoint rule: h²/24 · |Δp'| · width < 1e-7; f32 rounding of the median < 3e-5 nm · 4e-3.
        let h = (median - 360.0) / 2000.0;
        let below: f64 =
            (0..2000).map(|i| h * Wavelengths::density(360.0 + h * (f64::from(i) + 0.5))).sum();
        assert!((below - 0.5).abs() < 5e-7, "{below}");
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "a quarter is exact")]
    fn terminating_twice_quarters_the_density_once() {
        let mut w = Wavelengths::sample(0.3);
        let before = w.pdf[0];
        w.terminate_secondary();
        w.terminate_secondary();
        assert!(w.secondary_terminated());
        assert_eq!(w.pdf.to_array(), [before * 0.25, 0.0, 0.0, 0.0]);
    }
}
