//! The types that a parameter may have, beyond numbers and glam's vectors.
//!
//! Each is plain data: the host writes it, the plugin reads it. What borrows (`Text`, `Table`,
//! `File`, `Shared`) borrows host memory that outlives the struct it stands in.
#![expect(unsafe_code, reason = "field types state the layout that the host writes")]

use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::{Fault, Kind, Type};
use crate::color::Spectrum;
use crate::wire::Slice;

/// A type that the host may write at an offset.
///
/// # Safety
/// `TYPE` says which bit patterns the host writes; all of them must be valid values.
#[diagnostic::on_unimplemented(
    message = "a parameter cannot be of type `{Self}`",
    label = "not a type that the host can write",
    note = "parameters are f32, f64, u32, bool, Vec2, Vec3, DVec3, Spectrum, ComplexIor, Emission, \
            Maybe<f32>, Text, File, Table, Look, MaterialRef, PhaseRef, ShapeRef, TextureRef, or derive `Choice`"
)]
pub unsafe trait Field: Copy {
    /// How it is stored.
    const TYPE: Type;
}

/// A `#[repr(u32)]` enum without data whose variants count from 0; implemented by the derive.
///
/// # Safety
/// Every index below `WORDS.len()` must be a valid value.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a choice between words",
    label = "needs to be an enum that derives `Choice`"
)]
pub unsafe trait Choice: Copy {
    /// The words in a scene, in order.
    const WORDS: &'static [Text<'static>];
}

/// A type whose all-zero bytes are a valid value: what a derived field may hold.
///
/// # Safety
/// All-zero bytes must be valid.
#[diagnostic::on_unimplemented(
    message = "a derived field cannot be of type `{Self}`",
    label = "zero bytes are no value of it, as far as is known",
    note = "derived fields are numbers, bool, vectors, matrices, Spectrum, and arrays of these"
)]
pub unsafe trait Plain: Copy {}

macro_rules! fields {
    ($($t:ty => $kind:ident),* $(,)?) => { $(
        // SAFETY: the host writes exactly this type at a field of this kind.
        unsafe impl Field for $t { const TYPE: Type = Type::$kind; }
    )* };
}
fields! {
    f32 => Float, f64 => Double, u32 => Int, bool => Bool, Vec2 => Vec2, Vec3 => Vec3,
    DVec3 => DVec3, Spectrum => Spectrum, ComplexIor => ComplexIor, Text<'_> => Text,
    File<'_> => File, Table<'_> => Table, Look => Look, Maybe<f32> => MaybeFloat,
    Emission => Emission,
}

macro_rules! plain {
    ($($t:ty),* $(,)?) => { $(
        // SAFETY: zero bytes are the number zero, false, or absent.
        unsafe impl Plain for $t {}
    )* };
}
plain!(f32, f64, u32, u64, bool, Vec2, Vec3, DVec3, glam::DMat3, glam::Mat3, Spectrum);
// SAFETY: an array of plain values is plain.
unsafe impl<T: Plain, const N: usize> Plain for [T; N] {}

/// A metal's index of refraction, eta − i·k, per lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ComplexIor {
    /// Real part.
    pub eta: Spectrum,
    /// Extinction.
    pub k: Spectrum,
}

/// Which amount of light the scene gave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum Quantity {
    /// A plain factor on an absolute spectrum: `scale`.
    #[default]
    Scale = 0,
    /// W or lm, in all directions together.
    Power = 1,
    /// W·m⁻²·sr⁻¹ or nit.
    Radiance = 2,
    /// W·sr⁻¹ or cd.
    Intensity = 3,
    /// W·m⁻² or lx, on a surface that faces the light.
    Illuminance = 4,
}

impl Quantity {
    /// Every quantity with its parameter's name and the units it takes.
    pub const ALL: [(Self, &'static str, &'static str); 5] = [
        (Self::Scale, "scale", ""),
        (Self::Power, "power", "W|lm"),
        (Self::Radiance, "radiance", "W/m^2/sr|nit"),
        (Self::Intensity, "intensity", "W/sr|cd"),
        (Self::Illuminance, "illuminance", "W/m^2|lx"),
    ];
}

/// Emitted light at the wavelengths of the path: spectrum times amount.
///
/// Lanes are in the amount's SI unit per band of 470 nm (see `color`): an equal-energy source of
/// 1 W·m⁻²·sr⁻¹ has 1 in every lane. A photometric amount has been turned into a radiometric one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Emission {
    /// The light, in the unit of `quantity`.
    pub spectrum: Spectrum,
    /// What was given.
    pub quantity: Quantity,
}

/// Where something stands, what it faces and which way is up, in world or local space, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Look {
    /// Position.
    pub from: DVec3,
    /// A point straight ahead; differs from `from`.
    pub to: DVec3,
    /// Up; not parallel to the view.
    pub up: DVec3,
}

impl Look {
    /// The orthonormal frame (right, up, backward): the camera looks along −backward.
    pub fn axes(&self) -> (DVec3, DVec3, DVec3) {
        let backward = (self.from - self.to).normalize();
        let right = self.up.cross(backward).normalize();
        (right, backward.cross(right), backward)
    }
}

/// A value that may be absent: a number that a scene leaves out, a sample that there is none of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Maybe<T> {
    /// Whether there is one.
    pub given: bool,
    /// The value, if there is one; else any.
    pub value: T,
}

impl<T> Maybe<T> {
    /// A value.
    pub const fn some(value: T) -> Self {
        Self { given: true, value }
    }

    /// The value, if there is one.
    #[inline(always)]
    pub fn as_ref(&self) -> Option<&T> {
        if self.given { Some(&self.value) } else { None }
    }

    /// Takes a value, or none: the old one is then left as it is.
    #[inline(always)]
    pub fn set(&mut self, value: Option<T>) {
        self.given = value.is_some();
        if let Some(value) = value {
            self.value = value;
        }
    }
}

impl<T: Copy> Maybe<T> {
    /// The value, if there is one.
    pub fn get(self) -> Option<T> {
        if self.given { Some(self.value) } else { None }
    }
}

impl<T: Default> From<Option<T>> for Maybe<T> {
    fn from(value: Option<T>) -> Self {
        let given = value.is_some();
        Self { given, value: value.unwrap_or_default() }
    }
}

/// Text, lent by the host for as long as the object lives.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Text<'a> {
    pub(crate) ptr: *const u8,
    pub(crate) len: usize,
    lent: PhantomData<&'a str>,
}

/// Numbers, lent by the host for as long as the object lives.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Table<'a> {
    ptr: *const f64,
    len: usize,
    lent: PhantomData<&'a [f64]>,
}

// SAFETY: both are shared, read-only borrows.
unsafe impl Send for Text<'_> {}
// SAFETY: as above.
unsafe impl Sync for Text<'_> {}
// SAFETY: as above.
unsafe impl Send for Table<'_> {}
// SAFETY: as above.
unsafe impl Sync for Table<'_> {}

impl fmt::Debug for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.get().fmt(f)
    }
}

impl<'a> Text<'a> {
    /// Lends text.
    pub const fn new(text: &'a str) -> Self {
        Self { ptr: text.as_ptr(), len: text.len(), lent: PhantomData }
    }

    /// The bytes, which a foreign library may have filled with anything.
    pub const fn bytes(self) -> Slice<u8> {
        Slice { items: self.ptr, len: self.len }
    }

    /// The same text, for whoever knows how long it is lent.
    pub(crate) const fn for_as_long_as_it_lives(self) -> Text<'static> {
        Text { ptr: self.ptr, len: self.len, lent: PhantomData }
    }

    /// The text; empty when none was given.
    pub fn get(&self) -> &'a str {
        if self.len == 0 {
            return "";
        }
        // SAFETY: made by `new` from a live `str`, or zero bytes (length 0).
        let bytes = unsafe { std::slice::from_raw_parts(self.ptr, self.len) };
        // SAFETY: the bytes were a `str`.
        unsafe { std::str::from_utf8_unchecked(bytes) }
    }
}

impl<'a> Table<'a> {
    /// Lends numbers.
    pub const fn new(numbers: &'a [f64]) -> Self {
        Self { ptr: numbers.as_ptr(), len: numbers.len(), lent: PhantomData }
    }

    /// The numbers, in SI units; empty when none were given.
    pub fn get(&self) -> &'a [f64] {
        if self.len == 0 {
            return &[];
        }
        // SAFETY: made by `new` from a live slice, or zero bytes (length 0).
        unsafe { std::slice::from_raw_parts(self.ptr, self.len) }
    }
}

/// A file that the scene names. Its bytes are read through `BuildContext` while the object's
/// shared table is built; nothing of it is kept.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct File<'a> {
    /// The path, joined to the folder of the scene file that names it; empty when none was given.
    pub path: Text<'a>,
}

/// What building may ask of the host.
pub trait BuildContext {
    /// The bytes of a file that a parameter names.
    ///
    /// # Errors
    /// Why it cannot be read, ready for a message.
    fn read(&self, path: &str) -> Result<Arc<[u8]>, String>;

    /// Bytes of another file that the file at `base` names, relative to it.
    ///
    /// # Errors
    /// As `read`.
    fn read_beside(&self, base: &str, path: &str) -> Result<Arc<[u8]>, String>;

    /// Tells the author of something odd that does not stop the build.
    fn warn(&self, message: &str);

    /// Whether the work is no longer wanted: give up soon, with any result.
    fn cancelled(&self) -> bool {
        false
    }

    /// Tells that what is built keeps so many bytes of memory, more than what was told before. By this is
    /// judged what is kept for later; of who tells nothing, the bytes that were read count.
    fn holds(&self, _bytes: usize) {}
}

/// How an object makes the table that its copies share: a decoded image, a mesh, a distribution.
#[diagnostic::on_unimplemented(
    message = "nothing makes the shared table of `{Self}`",
    label = "needs `impl Build<{T}>`"
)]
pub trait Build<T> {
    /// Makes the table from the parameters. Textured and wavelength-dependent fields hold their
    /// defaults here: a table must not depend on them.
    ///
    /// # Errors
    /// All faults that were found.
    fn build(&self, context: &dyn BuildContext) -> Result<T, Vec<Fault>>;
}

/// A table that the object owns and all copies of its struct read.
#[repr(C)]
pub struct Shared<'a, T> {
    ptr: *const T,
    lent: PhantomData<&'a T>,
}

impl<T> Clone for Shared<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Shared<'_, T> {}
// SAFETY: a shared borrow of `T`.
unsafe impl<T: Sync> Send for Shared<'_, T> {}
// SAFETY: as above.
unsafe impl<T: Sync> Sync for Shared<'_, T> {}

impl<'a, T> Shared<'a, T> {
    /// Lends a table: for tests of a plugin without a host.
    pub const fn new(table: &'a T) -> Self {
        Self { ptr: table, lent: PhantomData }
    }
}

impl<T> Deref for Shared<'_, T> {
    type Target = T;
    fn deref(&self) -> &T {
        assert!(!self.ptr.is_null(), "a shared table was read before it was built");
        // SAFETY: the host wrote the address of a live table.
        unsafe { &*self.ptr }
    }
}

/// A shape that the host holds for this object: the plugin only states that it takes one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct ShapeSlot(pub u32);

// SAFETY: the host writes a number.
unsafe impl Field for ShapeSlot {
    const TYPE: Type = Type::Object(Kind::Shape);
}
