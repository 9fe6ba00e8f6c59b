//! Colour: hero wavelengths, four-lane spectra, observers, RGB spaces, measured curves.
//!
//! Radiance lanes are `L(λ) · 470 nm` in W·m⁻²·sr⁻¹ ([`to_xyz`] says why). This room does no IO and
//! holds no state: every table is a constant of the program.

mod convert;
mod curve;
mod data;
mod glass;
mod illuminant;
mod metal;
mod name;
mod observer;
mod palette;
mod rgb;
mod spectrum;
mod uplift;
mod wavelengths;

pub use convert::{emission_rgb, ior_rgb, reflectance_rgb};
pub use curve::{Curve, CurveError, Outside};
pub use glass::{GLASSES, Glass, glass};
pub use illuminant::{
    blackbody, blackbody_radiance, daylight, illuminant, illuminant_names, is_blackbody,
    is_illuminant, planck,
};
pub use metal::{Metal, is_metal, metal, metal_names};
pub use observer::{K_CD, Observer, luminance_cd_m2, to_xyz};
pub use palette::Palette;
pub use rgb::{RgbSpace, bradford, srgb_decode, srgb_encode, xy_to_xyz, xyz_to_xy};
pub use spectrum::Spectrum;
pub use uplift::{uplift_illuminant, uplift_reflectance};
pub use wavelengths::{BAND_NM, LAMBDA_MAX, LAMBDA_MIN, Wavelengths};
