//! Why a mesh cannot be traced.

use std::error::Error;
use std::fmt;

/// What is wrong with the arrays given to [`MeshBvh::build`](super::MeshBvh::build).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildError {
    /// A coordinate of this point is NaN or infinite.
    NonFinitePoint {
        /// Position in the array of points.
        point: usize,
    },
    /// A triangle names a point that does not exist.
    IndexOutOfRange {
        /// Position in the array of triangles.
        triangle: usize,
        /// The index it holds.
        index: u32,
        /// How many points there are.
        n_points: usize,
    },
    /// More triangles than a leaf reference can number.
    TooManyTriangles {
        /// How many were given.
        n_triangles: usize,
        /// How many there may be.
        limit: usize,
    },
    /// More points than indices can name.
    TooManyPoints {
        /// How many were given.
        n_points: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The [`Watch`](super::Watch) was cancelled.
    Cancelled,
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinitePoint { point } => write!(f, "point {point} is not finite"),
            Self::IndexOutOfRange { triangle, index, n_points } => {
                write!(f, "triangle {triangle} uses point {index}, but there are {n_points} points")
            }
            Self::TooManyTriangles { n_triangles, limit } => {
                write!(f, "{n_triangles} triangles in one mesh, the limit is {limit}")
            }
            Self::TooManyPoints { n_points, limit } => {
                write!(f, "{n_points} points in one mesh, the limit is {limit}")
            }
            Self::Cancelled => f.write_str("cancelled"),
        }
    }
}

impl Error for BuildError {}
