//! Number conversions that lose something on purpose, each with its reason in one place.

/// To single precision, rounding to nearest; out of range becomes infinite.
#[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
pub(crate) fn narrow(x: f64) -> f32 {
    x as f32
}

/// A whole number that a schema has put in the range of `u32`; others saturate, NaN is 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and schemas bound what comes here"
)]
pub(crate) fn whole(x: f64) -> u32 {
    x as u32
}

/// An index or count that fits 32 bits.
///
/// # Panics
/// From 2³² on: lists are bounded far below by the budgets.
pub(crate) fn index(n: usize) -> u32 {
    u32::try_from(n).expect("lists hold fewer than 2^32 items")
}
