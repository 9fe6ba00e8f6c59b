//! Measured complex indices of refraction of metals, by name.

use super::data::metals as table;
use super::name::same_name;
use super::{Curve, Outside};

/// A metal's index of refraction eta + i·k over [360, 830] nm.
#[derive(Clone, Debug, PartialEq)]
pub struct Metal {
    /// Real part, positive.
    pub eta: Curve,
    /// Extinction coefficient, positive.
    pub k: Curve,
}

/// A catalogue entry: symbol, names, rows of wavelength (nm), eta, k.
type Entry = (&'static str, &'static [&'static str], &'static [[f32; 3]]);

static METALS: [Entry; 9] = [
    ("Ag", &["silver"], &table::AG),
    ("Al", &["aluminium", "aluminum"], &table::AL),
    ("Au", &["gold"], &table::AU),
    ("Cr", &["chromium", "chrome"], &table::CR),
    ("Cu", &["copper"], &table::CU),
    ("Fe", &["iron"], &table::FE),
    ("Ni", &["nickel"], &table::NI),
    ("Ti", &["titanium"], &table::TI),
    ("W", &["tungsten"], &table::W),
];

/// The symbols and names [`metal`] knows, each symbol followed by its names.
pub fn metal_names() -> impl Iterator<Item = &'static str> {
    METALS
        .iter()
        .flat_map(|(symbol, names, _)| std::iter::once(*symbol).chain(names.iter().copied()))
}

/// Whether there is a metal of that symbol or name, without making its spectra.
pub fn is_metal(name: &str) -> bool {
    entry(name).is_some()
}

fn entry(name: &str) -> Option<&'static Entry> {
    METALS.iter().find(|e| same_name(name, e.0) || e.1.iter().any(|n| same_name(name, n)))
}

/// The metal of that symbol or name, or `None`; case and separators do not matter.
///
/// # Source
/// refractiveindex.info: Johnson and Christy 1972 and 1974, Rakić 1995 (Al), Weaver et al. 1975 (W).
pub fn metal(name: &str) -> Option<Metal> {
    let (_, _, rows) = entry(name)?;
    let column = |c: usize| {
        let points: Vec<_> = rows.iter().map(|r| (f64::from(r[0]), f64::from(r[c]))).collect();
        Curve::from_table(&points, Outside::Constant)
    };
    Some(Metal { eta: column(1), k: column(2) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_gives_a_metal_measured_over_the_entire_band() {
        for name in metal_names() {
            let m = metal(name).unwrap();
            assert!(m.eta.min() > 0.0 && m.k.min() > 0.0, "{name}");
        }
        for (symbol, _, rows) in &METALS {
            let (first, last) = (rows[0][0], rows[rows.len() - 1][0]);
            assert!(first <= 360.0 && 830.0 <= last, "{symbol}: {first} to {last} nm");
        }
        assert_eq!(metal("GOLD"), metal("Au"));
        assert_eq!(metal("unobtainium"), None);
    }

    #[test]
    fn gold_meets_its_published_rows() {
        let au = metal("au").unwrap();
        // The row at 616.8 nm, .21 and 3.272, lies between samples: lines differ from the polyline by
        // the change of slope there, under .01.
        assert!((au.eta.at(616.8) - 0.21).abs() < 0.01, "{}", au.eta.at(616.8));
        assert!((au.k.at(616.8) - 3.272).abs() < 0.01, "{}", au.k.at(616.8));
    }
}
