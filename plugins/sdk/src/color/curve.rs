//! A function of wavelength at 1 nm, fast to evaluate: reflectance, emission, index of refraction.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;

use super::observer::Observer;
use super::{BAND_NM, LAMBDA_MIN, Spectrum, Wavelengths};

/// Samples at 360, 361, … 830 nm, and one guard equal to the last.
type Samples = [f32; 472];

/// A tabulated function of wavelength over [360, 830] nm, linear between samples at 1 nm.
///
/// Cheap to clone: the samples are shared. Values are finite and may be negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    samples: Arc<Samples>,
}

/// What a curve is where its points say nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// The nearest point's value: reflectance, index of refraction.
    Constant,
    /// Zero: emission.
    Zero,
}

/// Why points do not make a curve; each names the index of the first offender.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveError {
    /// No point at all.
    Empty,
    /// A wavelength or value is NaN, infinite, or beyond f32.
    NotFinite(usize),
    /// A wavelength is not greater than the one before.
    NotIncreasing(usize),
}

impl fmt::Display for CurveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "a spectrum needs at least one point"),
            Self::NotFinite(i) => write!(f, "point {i} of the spectrum is not a finite number"),
            Self::NotIncreasing(i) => {
                write!(f, "the wavelength of point {i} is not greater than the one before")
            }
        }
    }
}

impl std::error::Error for CurveError {}

impl Curve {
    /// The same value at every wavelength; `v` must be finite.
    pub fn constant(v: f32) -> Self {
        Self { samples: Arc::new([v; 472]) }
    }

    /// Joins points (wavelength in nm, value) by straight lines and samples them at 1 nm.
    ///
    /// A feature narrower than 1 nm is sampled, not averaged, and may be missed. Wavelengths outside
    /// [360, 830] are allowed and shape the lines that enter the range.
    ///
    /// # Errors
    /// When there is no point, one is not finite, or wavelengths do not increase.
    pub fn from_points(points: &[(f64, f64)], outside: Outside) -> Result<Self, CurveError> {
        let finite = |v: f64| v.abs() <= f64::from(f32::MAX);
        let (&first, &last) = points.first().zip(points.last()).ok_or(CurveError::Empty)?;
        if let Some(i) = points.iter().position(|p| !(finite(p.0) && finite(p.1))) {
            return Err(CurveError::NotFinite(i));
        }
        if let Some(i) = points.windows(2).position(|p| p[1].0 <= p[0].0) {
            return Err(CurveError::NotIncreasing(i + 1));
        }
        Ok(Self::from_fn(|nm| match outside {
            Outside::Zero if nm < first.0 || last.0 < nm => 0.0,
            _ => between(points, nm.clamp(first.0, last.0)),
        }))
    }

    /// As [`Curve::from_points`], for the tables of this crate.
    pub(crate) fn from_table(points: &[(f64, f64)], outside: Outside) -> Self {
        Self::from_points(points, outside).expect("a test reads every table")
    }

    /// Samples `f`, a function of the wavelength in nm, finite over [360, 830].
    #[expect(clippy::cast_possible_truncation, reason = "samples are f32")]
    pub fn from_fn(f: impl Fn(f64) -> f64) -> Self {
        let at = |i: usize| f(f64::from(LAMBDA_MIN) + i.min(470) as f64) as f32;
        Self { samples: Arc::new(std::array::from_fn(at)) }
    }

    /// The values at four wavelengths; those beyond [360, 830] nm, or NaN, as at the nearer end.
    pub fn eval(&self, w: &Wavelengths) -> Spectrum {
        Spectrum::from_array(w.lambda.to_array().map(|nm| self.at(nm)))
    }

    /// The value at `nm`; beyond [360, 830], or at NaN, as at the nearer end (at NaN, 360).
    #[inline]
    pub fn at(&self, nm: f32) -> f32 {
        let (i, t) = split(nm);
        let (lo, hi) = (self.samples[i], self.samples[i + 1]);
        lo + (hi - lo) * t
    }

    /// The samples and one guard, so that a row and the next always exist.
    #[inline]
    pub(super) fn table(&self) -> &[f32; 472] {
        &self.samples
    }

    /// The 471 samples at 360, 361, … 830 nm.
    pub fn samples(&self) -> &[f32] {
        &self.samples[..471]
    }

    /// The curve with each sample passed through `f`, which gets the wavelength (nm) and the value.
    #[must_use]
    pub fn map(&self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self::from_fn(|nm| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "nm is one of 360, … 830"
            )]
            let i = (nm - f64::from(LAMBDA_MIN)) as usize;
            f(nm, f64::from(self.samples[i]))
        })
    }

    /// The product with another curve, sample by sample; the caller sees to it that it stays finite.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        Self { samples: Arc::new(std::array::from_fn(|i| self.samples[i] * other.samples[i])) }
    }

    /// The smallest value.
    pub fn min(&self) -> f32 {
        self.samples.iter().copied().fold(f32::INFINITY, f32::min)
    }

    /// The largest value.
    pub fn max(&self) -> f32 {
        self.samples.iter().copied().fold(f32::NEG_INFINITY, f32::max)
    }

    /// The mean over [360, 830] nm: of a radiance curve, the radiance in W·m⁻²·sr⁻¹.
    pub fn mean(&self) -> f64 {
        self.integral(|_| 1.0) / f64::from(BAND_NM)
    }

    /// Y of the 1931 observer, ∫cȳ dλ / ∫ȳ dλ: 1 for the constant 1.
    pub fn y(&self) -> f64 {
        self.to_xyz(Observer::Cie1931).y
    }

    /// XYZ, ∫c·(x̄, ȳ, z̄) dλ / ∫ȳ dλ: what [`super::to_xyz`] estimates, exactly.
    pub fn to_xyz(&self, observer: Observer) -> DVec3 {
        let table = observer.table();
        let channel = |c: usize| self.integral(|i| f64::from(table[i][c]));
        DVec3::new(channel(0), channel(1), channel(2)) / observer.y_integral()
    }

    /// ∫ c·g dλ in nm, `g` given at each sample: exact for two functions linear between samples,
    /// (f₀g₀ + f₁g₁)/3 + (f₀g₁ + f₁g₀)/6 per nm.
    pub(crate) fn integral(&self, g: impl Fn(usize) -> f64) -> f64 {
        let f = |i: usize| f64::from(self.samples[i]);
        (0..470)
            .map(|i| {
                let (g0, g1) = (g(i), g(i + 1));
                (f(i) * (2.0 * g0 + g1) + f(i + 1) * (g0 + 2.0 * g1)) / 6.0
            })
            .sum()
    }
}

/// The sample at or below `nm`, in [0, 470], and the fraction of a nm above it; ends are held, NaN is 360.
#[inline]
pub(crate) fn split(nm: f32) -> (usize, f32) {
    #[expect(clippy::manual_clamp, reason = "`clamp` keeps NaN, `max` drops it")]
    let x = (nm - LAMBDA_MIN).max(0.0).min(BAND_NM);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 ≤ x ≤ 470; `max` turns NaN into 0"
    )]
    let i = (x as usize).min(470);
    (i, x - i as f32)
}

/// The value of the polyline at `nm`, within the range of `points`.
fn between(points: &[(f64, f64)], nm: f64) -> f64 {
    let i = points.partition_point(|p| p.0 <= nm).max(1);
    let (lo, hi) = (points[i - 1], points.get(i).copied().unwrap_or(points[i - 1]));
    if hi.0 <= lo.0 { lo.1 } else { lo.1 + (hi.1 - lo.1) * ((nm - lo.0) / (hi.0 - lo.0)) }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "samples and held ends are copied")]
mod tests {
    use super::*;

    #[test]
    fn points_are_met_and_joined_by_lines() {
        let c = Curve::from_points(&[(400.0, 1.0), (410.0, 3.0)], Outside::Constant).unwrap();
        for (nm, v) in [(360.0, 1.0), (400.0, 1.0), (402.5, 1.5), (410.0, 3.0), (830.0, 3.0)] {
            assert!((c.at(nm) - v).abs() <= 2.0 * f32::EPSILON, "{nm}: {}", c.at(nm));
        }
        let c = Curve::from_points(&[(400.0, 1.0), (410.0, 3.0)], Outside::Zero).unwrap();
        assert_eq!([360.0, 399.0, 411.0, 830.0].map(|nm| c.at(nm)), [0.0; 4]);
        assert_eq!((c.at(410.0), c.min(), c.max()), (3.0, 0.0, 3.0));
    }

    #[test]
    fn lookups_beyond_the_range_hold_the_ends() {
        let c = Curve::from_fn(|nm| nm);
        for nm in [f32::NEG_INFINITY, -1.0, f32::NAN] {
            assert_eq!(c.at(nm), 360.0);
        }
        for nm in [830.0, 830.1, f32::MAX, f32::INFINITY] {
            assert_eq!(c.at(nm), 830.0);
        }
    }

    #[test]
    fn bad_points_are_named() {
        let check = |points: &[(f64, f64)], expected| {
            assert_eq!(Curve::from_points(points, Outside::Constant), Err(expected));
        };
        check(&[], CurveError::Empty);
        check(&[(400.0, 1.0), (f64::NAN, 1.0)], CurveError::NotFinite(1));
        check(&[(400.0, 1e39)], CurveError::NotFinite(0));
        check(&[(400.0, 1.0), (400.0, 2.0)], CurveError::NotIncreasing(1));
        assert_eq!(
            CurveError::NotIncreasing(1).to_string(),
            "the wavelength of point 1 is not greater than the one before"
        );
    }

    #[test]
    fn extreme_points_make_finite_curves() {
        let m = f64::from(f32::MAX);
        let c = Curve::from_points(&[(-m, -m), (m, m)], Outside::Constant).unwrap();
        assert!(c.samples().iter().all(|v| v.is_finite()));
        let tiny =
            Curve::from_points(&[(500.0, 1.0), (500.0 + 1e-12, 2.0)], Outside::Zero).unwrap();
        assert_eq!((tiny.at(500.0), tiny.at(501.0)), (1.0, 0.0));
    }

    #[test]
    fn integrals_of_lines_are_exact() {
        // ∫λ² over the range by two linear factors: (830³ − 360³)/3 less nothing.
        let c = Curve::from_fn(|nm| nm);
        let got = c.integral(|i| 360.0 + i as f64);
        let exact = (830f64.powi(3) - 360f64.powi(3)) / 3.0;
        assert!((got / exact - 1.0).abs() < 470.0 * f64::EPSILON);
        assert!((c.mean() - 595.0).abs() < 1e-10);
        assert!((Curve::constant(1.0).y() - 1.0).abs() < 470.0 * f64::EPSILON);
    }

    #[test]
    fn equal_energy_has_the_chromaticity_of_the_tables() {
        // Truth colour.E_white, abs 5e-5.
        let xy = crate::color::xyz_to_xy(Curve::constant(1.0).to_xyz(Observer::Cie1931));
        assert!((xy.x - 0.33331438077735187).abs() < 5e-5, "{xy}");
        assert!((xy.y - 0.33328770579931666).abs() < 5e-5, "{xy}");
    }

    #[test]
    fn four_lanes_estimate_what_the_curve_integrates() {
        // 4096 strata of u; a bump of 40 nm has |f''| < 5e3 in u, so the midpoint rule is within
        // 5e3 / 24 / 4096² = 1.3e-5 and f32 lookups within 1e-5 of the exact integral.
        let bump = Curve::from_fn(|nm| (-((nm - 470.0) / 40.0).powi(2)).exp());
        for observer in [Observer::Cie1931, Observer::Cie1964, Observer::Cie2015] {
            let sum: DVec3 = (0_u16..1024)
                .map(|i| {
                    let w = Wavelengths::sample((f32::from(i) + 0.5) / 4096.0);
                    crate::color::to_xyz(observer, bump.eval(&w), &w)
                })
                .sum();
            let off = sum / 1024.0 - bump.to_xyz(observer);
            assert!(off.abs().max_element() < 5e-5, "{observer:?}: {off}");
        }
    }
}
