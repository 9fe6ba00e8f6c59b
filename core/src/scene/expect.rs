//! What a scene's file says of its picture, so that it can be tested.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use crate::diag::Span;
use crate::film::Rect;

/// Something that is to be true of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// What.
    pub claim: Claim,
    /// Values of parameters under which it is said, as `--set` takes them; others are as they are.
    pub given: Vec<(String, String)>,
    /// Where it is written.
    pub span: Span,
}

/// What is to be true.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// The mean of some pixels.
    Mean {
        /// Which.
        of: Area,
        /// What it is to be.
        value: Expected,
        /// How far it may be off beside its noise; `None` where the file says nothing.
        tolerance: Option<f64>,
    },
    /// The picture is that of another scene, up to noise.
    SameAs {
        /// The other scene, as it is written.
        name: Arc<str>,
        /// Its file.
        path: PathBuf,
    },
}

/// Some pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// All of them.
    Whole,
    /// Those of a rectangle.
    Region(Rect),
}

/// A value that is expected, in the unit of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// A luminance.
    Luminance(f64),
    /// Linear sRGB, each channel for itself.
    Rgb([f64; 3]),
}

impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.claim {
            Claim::Mean { of, value, tolerance } => {
                write!(f, "{of} = {value}")?;
                tolerance.iter().try_for_each(|tolerance| write!(f, " ± {tolerance}"))?;
            }
            Claim::SameAs { name, .. } => write!(f, "same_as {name:?}")?,
        }
        for (i, (name, value)) in self.given.iter().enumerate() {
            let before = if i == 0 { " where {" } else { "," };
            write!(f, "{before} {name} = {value}")?;
        }
        if self.given.is_empty() { Ok(()) } else { write!(f, " }}") }
    }
}

impl fmt::Display for Area {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Region(Rect { min, size }) = self else { return write!(f, "mean") };
        if size.x == 1 && size.y == 1 {
            return write!(f, "pixel ({}, {})", min.x, min.y);
        }
        write!(f, "region ({}, {}, {}, {})", min.x, min.y, size.x, size.y)
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Luminance(y) => write!(f, "{y}"),
            Self::Rgb([r, g, b]) => write!(f, "({r}, {g}, {b})"),
        }
    }
}
