//! Colours and spectra as a scene describes them, before anyone knows their role.

use std::sync::Arc;

/// A colour or spectrum as described.
#[derive(Clone, Debug, PartialEq)]
pub enum Color {
    /// Linear sRGB; other spaces have been converted. May lie outside [0, 1].
    Rgb([f64; 3]),
    /// The same number at every wavelength.
    Constant(f64),
    /// Values at increasing wavelengths, nm.
    Curve(Arc<[(f64, f64)]>),
    /// The shape of a black body's spectrum at a temperature in kelvin.
    Blackbody(f64),
    /// A CIE illuminant by name.
    Illuminant(Arc<str>),
    /// A measured metal by name: eta and k.
    Metal(Arc<str>),
    /// A measured glass by name: eta.
    Glass(Arc<str>),
    /// How often waves of each wavelength fit into a length in metres.
    Waves(f64),
    /// Another one, times a number.
    Scaled(Arc<Color>, f64),
}

impl Color {
    /// Times a number; factors are folded into one.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        match self {
            Self::Rgb(c) => Self::Rgb(c.map(|x| x * factor)),
            Self::Constant(x) => Self::Constant(x * factor),
            Self::Waves(length) => Self::Waves(length * factor),
            Self::Scaled(inner, before) => Self::Scaled(inner.clone(), before * factor),
            other => Self::Scaled(Arc::new(other.clone()), factor),
        }
    }
}
