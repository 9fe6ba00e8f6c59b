//! What a schema and its faults are on their way through the plugin boundary.
#![expect(unsafe_code, reason = "addresses from the other side of the boundary are read")]

mod context;
mod fault;
mod schema;

pub use context::{Built, ContextRef, ContextTable};
pub use fault::FaultSink;
pub use schema::{HANDLE, ParamTable, TYPES, param_tables};
