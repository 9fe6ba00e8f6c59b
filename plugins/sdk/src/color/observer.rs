//! The eye: CIE colour-matching functions, and the film's estimate of XYZ from four lanes.

use glam::{DVec3, Vec3};

use super::data::cie_1931_2deg::CIE_1931_2DEG;
use super::data::cie_1964_10deg::CIE_1964_10DEG;
use super::data::cie_2015_2deg::CIE_2015_2DEG;
use super::{BAND_NM, LAMBDA_MIN, Spectrum, Wavelengths};

/// Maximum luminous efficacy for photopic vision, lm/W: 683 at 540 THz, taken at 555 nm.
///
/// # Source
/// SI brochure, 9th edition; CIE 018:2019.
pub const K_CD: f64 = 683.002;

/// A standard observer of the CIE; the default is the one of 1931.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Observer {
    /// CIE 1931, 2°: photometry and every RGB space are defined by it.
    #[default]
    Cie1931,
    /// CIE 1964, 10°.
    Cie1964,
    /// CIE 170-2:2015, 2°, from cone fundamentals; the table is zero below 390 nm.
    Cie2015,
}

/// A table of x̄, ȳ, z̄ over 360 to 830 nm at 1 nm.
pub(crate) type MatchingTable = [[f32; 3]; 471];

impl Observer {
    /// x̄, ȳ, z̄ at `lambda` (nm), linear between the 1 nm entries; zero outside [360, 830] and at NaN.
    pub fn xyz_bar(self, lambda: f32) -> Vec3 {
        let x = lambda - LAMBDA_MIN;
        if !(0.0..=BAND_NM).contains(&x) {
            return Vec3::ZERO;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 ≤ x ≤ 470 by the test above"
        )]
        let i = (x as usize).min(469);
        let table = self.table();
        let (lo, hi) = (Vec3::from_array(table[i]), Vec3::from_array(table[i + 1]));
        lo + (hi - lo) * (x - i as f32)
    }

    /// ∫ȳ dλ over [360, 830] nm, nm; exact for the linear interpolation of [`Observer::xyz_bar`].
    pub const fn y_integral(self) -> f64 {
        const Y_1931: f64 = trapezoid_y(&CIE_1931_2DEG);
        const Y_1964: f64 = trapezoid_y(&CIE_1964_10DEG);
        const Y_2015: f64 = trapezoid_y(&CIE_2015_2DEG);
        match self {
            Self::Cie1931 => Y_1931,
            Self::Cie1964 => Y_1964,
            Self::Cie2015 => Y_2015,
        }
    }

    /// The table behind [`Observer::xyz_bar`].
    pub(crate) const fn table(self) -> &'static MatchingTable {
        match self {
            Self::Cie1931 => &CIE_1931_2DEG,
            Self::Cie1964 => &CIE_1964_10DEG,
            Self::Cie2015 => &CIE_2015_2DEG,
        }
    }
}

/// One path's estimate of XYZ: the mean over lanes of L·(x̄, ȳ, z̄)/pdf, over ∫ȳ dλ.
///
/// `l` holds radiance in the film's convention: spectral radiance times the band, L(λ) · 470 nm, in
/// W·m⁻²·sr⁻¹. An equal-energy source of total radiance 1 W·m⁻²·sr⁻¹ is then 1 in each lane and has
/// Y = 1; [`luminance_cd_m2`] turns Y into cd/m². Lanes of density zero (terminated) count nothing. NaN
/// and infinity propagate.
///
/// # Source
/// PBR4 §4.6.2, `PixelSensor`; Wilkie et al. 2014 with balanced single-wavelength weights.
pub fn to_xyz(observer: Observer, l: Spectrum, w: &Wavelengths) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for i in 0..4 {
        if w.pdf[i] > 0.0 {
            let bar = observer.xyz_bar(w.lambda[i]).as_dvec3();
            sum += bar * (f64::from(l[i]) / f64::from(w.pdf[i]));
        }
    }
    sum * (0.25 / observer.y_integral())
}

/// The luminance, cd/m², of a pixel of value `y` for the 1931 observer: 155.3 for each 1.
pub fn luminance_cd_m2(y: f64) -> f64 {
    y * (K_CD * Observer::Cie1931.y_integral() / f64::from(BAND_NM))
}

/// Trapezoid sum of ȳ at 1 nm.
const fn trapezoid_y(table: &MatchingTable) -> f64 {
    let mut sum = 0.5 * (table[0][1] as f64 + table[470][1] as f64);
    let mut i = 1;
    while i < 470 {
        sum += table[i][1] as f64;
        i += 1;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_watt_at_a_wavelength_gives_the_published_lumens() {
        // Truth photometry.monochrom, rel 1e-4.
        for (nm, lumens) in
            [(555.0, 683.0), (532.0, 604.4293192), (589.0, 525.3326601), (633.0, 160.7333952)]
        {
            let got = 683.0 * f64::from(Observer::Cie1931.xyz_bar(nm).y);
            assert!((got / lumens - 1.0).abs() < 1e-4, "{nm} nm: {got}");
        }
    }

    #[test]
    fn lookups_are_linear_between_entries_and_zero_outside() {
        let at = |nm| Observer::Cie1964.xyz_bar(nm);
        let middle = at(500.5) - (at(500.0) + at(501.0)) * 0.5;
        assert!(middle.abs().max_element() <= f32::EPSILON, "{middle}");
        assert_eq!(at(830.0), Vec3::from_array(CIE_1964_10DEG[470]));
        for nm in [359.9, 830.1, -1e30, f32::INFINITY, f32::NAN] {
            assert_eq!(at(nm), Vec3::ZERO);
        }
    }

    #[test]
    fn equal_energy_of_unit_radiance_has_unit_y() {
        // The mean over 64 strata of u of a smooth integrand; the rest is the midpoint rule's error,
        // under h² |f''| / 24 with h = 1/256 and |f''| < 60, and f32 rounding.
        for observer in [Observer::Cie1931, Observer::Cie1964, Observer::Cie2015] {
            let sum: DVec3 = (0_u8..64)
                .map(|i| {
                    let w = Wavelengths::sample((f32::from(i) + 0.5) / 256.0);
                    to_xyz(observer, Spectrum::ONE, &w)
                })
                .sum();
            let xyz = sum / 64.0;
            assert!((xyz.y - 1.0).abs() < 1e-4, "{observer:?}: {xyz}");
        }
    }

    #[test]
    fn a_terminated_path_counts_its_first_wavelength_four_times() {
        let mut w = Wavelengths::sample(0.4);
        let lone = Spectrum::new(1.0, 0.0, 0.0, 0.0);
        let before = to_xyz(Observer::Cie1931, lone, &w);
        w.terminate_secondary();
        let after = to_xyz(Observer::Cie1931, Spectrum::ONE, &w);
        assert!((after - before * 4.0).abs().max_element() < 1e-12);
    }
}
