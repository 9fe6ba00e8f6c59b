//! The built-in plugins of kind filter.

mod blackman_harris;
mod r#box;
mod gaussian;
mod profile;
mod triangle;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::filter::<blackman_harris::BlackmanHarris<'static>>("blackman_harris"),
    Class::filter::<gaussian::Gaussian<'static>>("gaussian"),
    Class::filter::<r#box::BoxFilter>("box"),
    Class::filter::<triangle::Triangle<'static>>("triangle"),
];
