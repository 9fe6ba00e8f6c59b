//! What a plugin's parameters are: the schema that the derive makes, and the field types.
//!
//! A plugin is a plain struct that derives `Params`. The struct is the schema: the language checks
//! scenes against it, `describe` prints it, and the host writes values into the struct at the
//! offsets that it lists.

mod apart;
mod dimension;
mod kind;
mod fields;
mod schema;
mod unit;
mod refuse;
mod boundary;

pub use apart::{Unfinished, apart, leave};
pub use boundary::{
    Built, ContextRef, ContextTable, FaultSink, HANDLE, ParamTable, TYPES, param_tables,
};
pub use dimension::Dimension;
pub use fields::{
    Build, BuildContext, Choice, ComplexIor, Emission, Field, File, Look, Maybe, Plain, Quantity,
    ShapeSlot, Shared, Table, Text,
};
pub use kind::Kind;
pub use refuse::{
    choice_is_said, default_is_in_range, is_lent, name_is_free, range_is_ordered, unit_is_known,
};
pub use schema::{Fault, Param, Params, Preset, Role, SharedFns, SharedTable, Type};
pub use unit::{UNITS, Unit};
