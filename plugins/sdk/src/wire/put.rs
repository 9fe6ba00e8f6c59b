//! Results into the place where the caller reads them: field by field, as they are read.

use std::mem::MaybeUninit;

use crate::color::Spectrum;

/// A result of a table's function.
///
/// Copied as a whole, pieces are read that were written in two: the processor then waits for both to
/// reach its cache (measured: 5 ns for an `Eval`). What is asked for at every hit writes its fields.
pub(crate) trait Put: Copy {
    /// Writes it where the caller wants it.
    #[inline(always)]
    fn put(self, out: &mut MaybeUninit<Self>) {
        out.write(self);
    }
}

/// Results that are copied as they are.
macro_rules! put_whole {
    ($($ty:ty),* $(,)?) => { $(impl $crate::wire::Put for $ty {})* };
}
pub(crate) use put_whole;

/// Results that are written field by field.
macro_rules! put_fields {
    ($($ty:ty { $($field:ident),* })*) => { $(
        impl $crate::wire::Put for $ty {
            #[inline(always)]
            fn put(self, out: &mut std::mem::MaybeUninit<Self>) {
                let out = out.as_mut_ptr();
                $(
                    // SAFETY: a field of the caller's place, which is valid for writes.
                    unsafe { (&raw mut (*out).$field).write(self.$field) };
                )*
            }
        }
    )* };
}
pub(crate) use put_fields;

put_whole!(f32, f64, u32, u64, glam::DVec2, glam::DVec3, Spectrum);
impl<T: Copy, const N: usize> Put for [T; N] {}
