//! What the distributions ask of their weights.

use std::fmt;

/// Why a table of weights makes no distribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightError {
    /// There are no weights at all, or a side of an image is zero.
    Empty,
    /// The weight at this place is negative, infinite or NaN.
    Invalid(usize),
    /// An image's sides do not multiply to its number of weights, or a row has 2³² of them.
    Size,
    /// It was not wanted any more before it was made.
    Unwanted,
}

impl fmt::Display for WeightError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "a distribution needs at least one weight"),
            Self::Invalid(i) => write!(f, "weight {i} is negative, infinite or not a number"),
            Self::Size => write!(f, "the number of weights fits neither its sides nor a row"),
            Self::Unwanted => write!(f, "it is not wanted any more"),
        }
    }
}

impl std::error::Error for WeightError {}

impl WeightError {
    /// The same of weights before which so many stand.
    pub(super) fn after(self, first: usize) -> Self {
        if let Self::Invalid(i) = self { Self::Invalid(first + i) } else { self }
    }
}

/// The largest weight, after checking all; 0 if all are zero.
pub(super) fn largest(weights: &[f64]) -> Result<f64, WeightError> {
    if weights.is_empty() {
        return Err(WeightError::Empty);
    }
    let bad = weights.iter().position(|&w| !(w >= 0.0 && w.is_finite()));
    match bad {
        Some(i) => Err(WeightError::Invalid(i)),
        None => Ok(weights.iter().copied().fold(0.0, f64::max)),
    }
}

/// `weight` in units of `largest`; all equal if every weight is zero.
pub(super) fn relative(weight: f64, largest: f64) -> f64 {
    if largest > 0.0 { weight / largest } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_weights_are_named_by_place() {
        assert_eq!(largest(&[]), Err(WeightError::Empty));
        assert_eq!(largest(&[1.0, f64::NAN]), Err(WeightError::Invalid(1)));
        assert_eq!(largest(&[-1.0]), Err(WeightError::Invalid(0)));
        assert_eq!(largest(&[0.0, 2.0, f64::INFINITY]), Err(WeightError::Invalid(2)));
        assert!(WeightError::Invalid(7).to_string().contains("weight 7"));
    }
}
