//! Truths about lumens: of one wavelength, and of bodies that glow.

use std::f64::consts::PI;

use luxel_sdk::color::{K_CD, Observer, blackbody_radiance, luminance_cd_m2};

use crate::verify::row::Row;

/// Every row.
pub(super) fn rows() -> Vec<Row> {
    [monochrom(), efficacy(), platinum()].concat()
}

/// Lumens of one watt at one wavelength.
fn monochrom() -> Vec<Row> {
    let cases = [(555, 683.0), (532, 604.4293192), (589, 525.3326600999997), (633, 160.7333952)];
    let row = |(nm, expected): (u16, f64)| {
        let measured = K_CD * f64::from(Observer::Cie1931.xyz_bar(f32::from(nm)).y);
        Row::exact("photometry.monochrom", &format!("{nm} nm"), (expected, measured), (1e-4, 0.0))
    };
    cases.map(row).to_vec()
}

/// Of a black body, cd/m².
fn luminance(kelvin: f64) -> f64 {
    luminance_cd_m2(blackbody_radiance(kelvin).expect("it is hot").y())
}

/// Lumens of one watt of all that a black body sends, whose radiance is σT⁴/π.
fn efficacy() -> Vec<Row> {
    const SIGMA: f64 = 5.670_374_419e-8;
    let row = |(kelvin, expected): (f64, f64)| {
        let measured = luminance(kelvin) * PI / (SIGMA * kelvin.powi(4));
        let case = format!("{kelvin} K");
        Row::exact("photometry.blackbody_efficacy", &case, (expected, measured), (1e-3, 0.0))
    };
    [(2856.0, 16.446279810252257), (6500.0, 95.36314478970914)].map(row).to_vec()
}

/// Freezing platinum, by which the candela was defined in 1948: 60 of them a square centimetre.
fn platinum() -> Vec<Row> {
    let values = (59.64562172879829, luminance(2041.4) * 1e-4);
    vec![Row::exact("photometry.platinum", "cd/cm^2", values, (1e-2, 0.0))]
}
