//! Dispersion formulas of transparent materials, by name.

use super::name::same_name;
use super::{Curve, LAMBDA_MAX, LAMBDA_MIN, Spectrum, Wavelengths};

/// A transparent material's dispersion: n² = a + Σ bᵢ·λ² / (λ² − cᵢ), λ in µm.
///
/// # Source
/// Coefficients as in refractiveindex.info, cited at each entry of [`GLASSES`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    /// Name in the catalogue.
    pub name: &'static str,
    /// Other names.
    pub aliases: &'static [&'static str],
    /// n² less the terms, unitless; 1 in Sellmeier's own form.
    constant: f64,
    /// Pairs of strength (unitless) and squared resonance wavelength (µm²).
    terms: &'static [[f64; 2]],
}

/// The catalogue.
pub static GLASSES: [Glass; 7] = [
    // Schott catalogue 2017-01-20.
    Glass {
        name: "N-BK7",
        aliases: &["bk7"],
        constant: 1.0,
        terms: &[
            [1.03961212, 0.00600069867],
            [0.231792344, 0.0200179144],
            [1.01046945, 103.560653],
        ],
    },
    // Schott catalogue 2017-01-20.
    Glass {
        name: "N-LASF9",
        aliases: &["lasf9"],
        constant: 1.0,
        terms: &[[2.00029547, 0.0121426017], [0.298926886, 0.0538736236], [1.80691843, 156.530829]],
    },
    // Malitson 1965; 20 °C.
    Glass {
        name: "SiO2",
        aliases: &["fused_silica", "silica"],
        constant: 1.0,
        terms: &[
            [0.6961663, 0.0684043 * 0.0684043],
            [0.4079426, 0.1162414 * 0.1162414],
            [0.8974794, 9.896161 * 9.896161],
        ],
    },
    // Peter 1923; measured from 226 to 760 nm.
    Glass {
        name: "diamond",
        aliases: &[],
        constant: 1.0,
        terms: &[[0.3306, 0.1750 * 0.1750], [4.3356, 0.1060 * 0.1060]],
    },
    // Daimon and Masumura 2007; 20 °C.
    Glass {
        name: "H2O",
        aliases: &["water"],
        constant: 1.0,
        terms: &[
            [5.684027565e-1, 5.101829712e-3],
            [1.726177391e-1, 1.821153936e-2],
            [2.086189578e-2, 2.620722293e-2],
            [1.130748688e-1, 1.069792721e1],
        ],
    },
    // Dodge 1984; ordinary ray.
    Glass {
        name: "MgF2",
        aliases: &["magnesium_fluoride"],
        constant: 1.0,
        terms: &[
            [0.48755108, 0.04338408 * 0.04338408],
            [0.39875031, 0.09461442 * 0.09461442],
            [2.3120353, 23.793604 * 23.793604],
        ],
    },
    // Devore 1951, ordinary ray, measured from 430 nm: n² = 5.913 + .2441/(λ² − .0803), rewritten by
    // 1/(λ² − c) = (λ²/(λ² − c) − 1)/c.
    Glass {
        name: "TiO2",
        aliases: &["rutile"],
        constant: 5.913 - 0.2441 / 0.0803,
        terms: &[[0.2441 / 0.0803, 0.0803]],
    },
];

/// The glass of that name, or `None`; case and separators do not matter.
pub fn glass(name: &str) -> Option<&'static Glass> {
    let known =
        |g: &&Glass| same_name(name, g.name) || g.aliases.iter().any(|a| same_name(name, a));
    GLASSES.iter().find(known)
}

impl Glass {
    /// The index of refraction at `lambda_nm` in air, limited to [360, 830] nm; NaN counts as 360.
    pub fn eta(&self, lambda_nm: f64) -> f64 {
        let um = lambda_nm.max(f64::from(LAMBDA_MIN)).min(f64::from(LAMBDA_MAX)) * 1e-3;
        let l2 = um * um;
        let sum: f64 = self.terms.iter().map(|[b, c]| b * l2 / (l2 - c)).sum();
        (self.constant + sum).sqrt()
    }

    /// The index of refraction at the d line, 587.5618 nm: the one to quote, and for RGB mode.
    pub fn eta_d(&self) -> f64 {
        self.eta(587.5618)
    }

    /// The Abbe number, (eta(d) − 1)/(eta(F) − eta(C)): large is weak dispersion.
    pub fn abbe(&self) -> f64 {
        (self.eta_d() - 1.0) / (self.eta(486.1327) - self.eta(656.2725))
    }

    /// The index of refraction at four wavelengths.
    #[expect(clippy::cast_possible_truncation, reason = "lanes are f32")]
    pub fn eval(&self, w: &Wavelengths) -> Spectrum {
        Spectrum::from_array(w.lambda.to_array().map(|nm| self.eta(f64::from(nm)) as f32))
    }

    /// The index of refraction as a curve.
    pub fn curve(&self) -> Curve {
        Curve::from_fn(|nm| self.eta(nm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bk7_meets_the_catalogue() {
        // Truth dispersion.bk7, rel 1e-5.
        let bk7 = glass("bk7").unwrap();
        for (got, expected) in [
            (bk7.eta(486.1327), 1.5223762897312287),
            (bk7.eta(587.5618), 1.5168000345005883),
            (bk7.eta(656.2725), 1.5143223472613747),
            (bk7.abbe(), 64.16733623749799),
        ] {
            assert!((got / expected - 1.0).abs() < 1e-5, "{got} {expected}");
        }
    }

    #[test]
    fn others_meet_their_published_indices() {
        // Index at the d line as commonly quoted, to half a unit of the last digit.
        for (name, eta_d, tolerance) in [
            ("N-LASF9", 1.85025, 5e-6),
            ("fused silica", 1.4585, 5e-5),
            ("diamond", 2.417, 5e-4),
            ("water", 1.3334, 5e-5),
            ("MgF2", 1.3777, 5e-5),
            ("TiO2", 2.6143, 5e-5),
        ] {
            let got = glass(name).unwrap().eta_d();
            assert!((got - eta_d).abs() < tolerance, "{name}: {got}");
        }
        assert!((glass("N-LASF9").unwrap().abbe() - 32.17).abs() < 5e-3);
        assert_eq!(glass("vacuum"), None);
    }

    #[test]
    fn every_glass_is_finite_and_disperses_normally() {
        for g in &GLASSES {
            for nm in [f64::NAN, f64::NEG_INFINITY, 0.0, f64::INFINITY] {
                assert!((1.0..4.0).contains(&g.eta(nm)), "{}: {}", g.name, g.eta(nm));
            }
            let falls = g.curve().samples().windows(2).all(|p| p[1] <= p[0]);
            assert!(falls && g.abbe() > 0.0, "{}", g.name);
        }
    }
}
