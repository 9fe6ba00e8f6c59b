//! Tables of published measurements, one origin and licence per file.

pub(crate) mod cie_1931_2deg;
pub(crate) mod cie_1964_10deg;
pub(crate) mod cie_2015_2deg;
pub(crate) mod daylight;
pub(crate) mod illuminants;
pub(crate) mod mallett_2019;
pub(crate) mod metals;
