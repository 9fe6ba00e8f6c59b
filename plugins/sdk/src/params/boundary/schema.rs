//! A schema as plain data, as it crosses the boundary.

use super::super::{Param, Preset, Text, Type};
use crate::wire::Slice;

/// One parameter of a class.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ParamTable {
    /// The name in a scene.
    pub name: Text<'static>,
    /// What it does.
    pub doc: Text<'static>,
    /// How it is stored: `TYPES` in order; a handle is 32 and its kind.
    pub ty: u32,
    /// What it stands for, by its place in `Role`.
    pub role: u32,
    /// Its unit.
    pub unit: Text<'static>,
    /// Which default there is: 0 none, 1 numbers, 2 a choice, 3 text.
    pub preset: u32,
    /// 1 required, 2 textured.
    pub flags: u32,
    /// The default: numbers; the first is the index of a choice.
    pub numbers: [f64; 4],
    /// The default: text.
    pub text: Text<'static>,
    /// Least legal value, SI.
    pub min: f64,
    /// Greatest legal value, SI.
    pub max: f64,
    /// The words of a choice.
    pub choices: Slice<Text<'static>>,
    /// Exactly one parameter of a group is given.
    pub group: Text<'static>,
    /// Its new name, where it is only kept for old scenes.
    pub deprecated: Text<'static>,
    /// Where it stands in the struct.
    pub offset: u64,
}

/// How parameters are stored, by their number in the boundary; handles come after.
pub const TYPES: [Type; 17] = [
    Type::Float,
    Type::Double,
    Type::Int,
    Type::Bool,
    Type::Vec2,
    Type::Vec3,
    Type::DVec3,
    Type::Spectrum,
    Type::ComplexIor,
    Type::Choice,
    Type::Text,
    Type::File,
    Type::Table,
    Type::Look,
    Type::MaybeFloat,
    Type::Emission,
    Type::Part,
];
/// What a handle's type is, before its kind is added.
pub const HANDLE: u32 = 32;

const fn type_number(ty: Type) -> u32 {
    match ty {
        Type::Float => 0,
        Type::Double => 1,
        Type::Int => 2,
        Type::Bool => 3,
        Type::Vec2 => 4,
        Type::Vec3 => 5,
        Type::DVec3 => 6,
        Type::Spectrum => 7,
        Type::ComplexIor => 8,
        Type::Choice => 9,
        Type::Text => 10,
        Type::File => 11,
        Type::Table => 12,
        Type::Look => 13,
        Type::MaybeFloat => 14,
        Type::Emission => 15,
        Type::Part => 16,
        Type::Object(kind) => HANDLE + kind as u32,
    }
}

/// A schema as it crosses the boundary: what the derive writes down beside it.
pub const fn param_tables<const N: usize>(schema: &'static [Param]) -> [ParamTable; N] {
    let mut out = [param_table(&schema[0]); N];
    let mut i = 1;
    while i < N {
        out[i] = param_table(&schema[i]);
        i += 1;
    }
    out
}

const fn param_table(param: &Param) -> ParamTable {
    let none = ([0.0; 4], Text::new(""));
    let (preset, (numbers, text)) = match param.default {
        Preset::Absent => (0, none),
        Preset::Numbers(numbers) => (1, (numbers, none.1)),
        Preset::Index(index) => (2, ([index as f64, 0.0, 0.0, 0.0], none.1)),
        Preset::Text(text) => (3, (none.0, Text::new(text))),
    };
    ParamTable {
        name: Text::new(param.name),
        doc: Text::new(param.doc),
        ty: type_number(param.ty),
        role: param.role as u32,
        unit: Text::new(param.unit),
        preset,
        flags: param.required as u32 + 2 * param.textured as u32,
        numbers,
        text,
        min: param.min,
        max: param.max,
        choices: Slice::new(param.choices),
        group: Text::new(param.group),
        deprecated: Text::new(param.deprecated),
        offset: param.offset as u64,
    }
}
