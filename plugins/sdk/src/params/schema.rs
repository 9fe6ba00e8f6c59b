//! The schema: what the derive writes down about each parameter.

use super::{BuildContext, Built, ContextRef, FaultSink, Kind, ParamTable, Text};
use crate::wire::Status;

/// How a parameter is stored in the struct, and so what the host writes at its offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// `f32`.
    Float,
    /// `f64`.
    Double,
    /// `u32`.
    Int,
    /// `bool`.
    Bool,
    /// Two `f32`: `glam::Vec2`.
    Vec2,
    /// Three `f32`: `glam::Vec3`.
    Vec3,
    /// Three `f64`: `glam::DVec3`.
    DVec3,
    /// Four lanes.
    Spectrum,
    /// A complex index of refraction: `ComplexIor`.
    ComplexIor,
    /// A `#[repr(u32)]` enum, by index.
    Choice,
    /// `Text`.
    Text,
    /// `File`: the bytes of a file, while the object is built.
    File,
    /// `Table` of `f64`.
    Table,
    /// `Look`: where a camera or a spot stands, what it looks at and what is up.
    Look,
    /// `Maybe<f32>`.
    MaybeFloat,
    /// `Emission`: a spectrum and exactly one of several amounts.
    Emission,
    /// A handle to another object.
    Object(Kind),
    /// A handle to a shape of which this one is made: `ShapeRef`.
    Part,
}

/// What a number stands for: decides its range and how colours are turned into spectra.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// A number as it is; a colour is uplifted as an unbounded reflectance.
    Plain,
    /// A fraction of light in [0, 1].
    Reflectance,
    /// A source of light: colours are uplifted relative to D65.
    Illuminant,
    /// An index of refraction; in `rgb` mode one number, at 587.6 nm. A material is told it relative
    /// to what lies around the shape.
    Ior,
    /// A metal's index of refraction, kept per channel, and relative as `Ior` is.
    ComplexIor,
    /// A medium's coefficient, m⁻¹, not negative.
    Coefficient,
    /// A length in metres, told as how many waves of each wavelength it is long.
    Waves,
    /// Something that is counted: whole numbers, also in a vector.
    Count,
}

/// A parameter's value when the scene gives none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// There is none: the scene must give it, or it may stay absent (see `Param::required`).
    Absent,
    /// Numbers, as many as the type holds; a spectrum takes the first for all lanes.
    Numbers([f64; 4]),
    /// A choice by index.
    Index(u32),
    /// Text.
    Text(&'static str),
}

/// One parameter, as the language, the manual, the editor and the host see it.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// The name in a scene.
    pub name: &'static str,
    /// What it does; the manual's text.
    pub doc: &'static str,
    /// How it is stored.
    pub ty: Type,
    /// Its unit, `""` for a plain number; several that are accepted stand as `W|lm`.
    pub unit: &'static str,
    /// What it stands for.
    pub role: Role,
    /// The value when none is given.
    pub default: Preset,
    /// Least legal value, in SI units.
    pub min: f64,
    /// Greatest legal value, in SI units.
    pub max: f64,
    /// The words of a choice.
    pub choices: &'static [Text<'static>],
    /// Exactly one parameter of a group is given; `""` for none.
    pub group: &'static str,
    /// Whether the scene must give it.
    pub required: bool,
    /// Whether a texture may drive it.
    pub textured: bool,
    /// Its new name, where this one is only kept for old scenes; else `""`.
    pub deprecated: &'static str,
    /// Where the host writes it in the struct.
    pub offset: usize,
}

impl Param {
    /// The words of a choice.
    pub fn words(&self) -> impl Iterator<Item = &'static str> + Clone {
        self.choices.iter().map(Text::get)
    }
}

/// What is wrong with a value that no schema can tell: the field, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The parameter at fault; empty for the object as a whole.
    pub field: &'static str,
    /// The catalogue's code.
    pub code: &'static str,
    /// What was found and what would be right, lower case, no full stop.
    pub message: String,
}

impl Fault {
    /// A value that is out of its legal range given the other values (E0405).
    pub fn range(field: &'static str, message: impl Into<String>) -> Self {
        Self { field, code: "E0405", message: message.into() }
    }

    /// A file that is missing or cannot be understood (E0413).
    pub fn file(field: &'static str, message: impl Into<String>) -> Self {
        Self { field, code: "E0413", message: message.into() }
    }

    /// Numbers of a mesh that do not fit together (E0411).
    pub fn mesh(field: &'static str, message: impl Into<String>) -> Self {
        Self { field, code: "E0411", message: message.into() }
    }
}

/// How an object's shared table is made and dropped; written by the derive.
#[derive(Clone, Copy)]
pub struct SharedFns {
    /// Where the host writes the pointer to the table.
    pub offset: usize,
    /// Builds the table from the struct's bytes. The pointer is to a live struct of the class.
    pub build: unsafe fn(*const u8, &dyn BuildContext) -> Result<SharedTable, Vec<Fault>>,
    /// The same, as it crosses the boundary.
    pub build_abi:
        unsafe extern "C" fn(*const u8, &ContextRef<'_>, &FaultSink, &mut Built) -> Status,
    /// Frees what `build_abi` built.
    pub free_abi: unsafe extern "C" fn(*mut u8) -> Status,
}

/// A table that an object owns: built once, read by every copy of the struct.
pub struct SharedTable {
    /// What the struct's `Shared` field points to.
    pub address: *const u8,
    /// Keeps it alive.
    pub owner: Box<dyn std::any::Any + Send + Sync>,
}

/// A struct that is its own schema. Only `#[derive(Params)]` implements it.
///
/// # Safety
/// `SCHEMA` must describe the fields exactly: for each `Param`, writing any legal value of `ty` at
/// `offset` leaves the struct valid. All other fields must be valid when all their bytes are zero.
/// The struct is `Copy`, at most 256 bytes, aligned to at most 16.
#[expect(unsafe_code, reason = "the host writes fields at the offsets that the schema lists")]
pub unsafe trait Params: Copy + Send + Sync {
    /// The same struct with another lifetime for what it borrows from the host.
    type At<'x>: Params + 'x;
    /// The type's doc comment: its manual page.
    const DOC: &'static str;
    /// Every parameter, in the struct's order.
    const SCHEMA: &'static [Param];
    /// The same, as it crosses the boundary.
    const TABLE: &'static [ParamTable];
    /// Whether it has derived fields, which `prepare` fills.
    const DERIVED: bool;
    /// How its shared table is built, if it has one.
    const SHARED: Option<SharedFns>;
}
