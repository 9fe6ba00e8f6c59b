//! What the types of parameters and kinds are called in C.

use crate::kind::{Arrival, Lane};
use crate::wire::layout::{CType, c_types};

c_types! {
    crate::kind::Needs => "uint32_t", crate::kind::Lobe => "uint32_t",
    crate::kind::Wants => "uint32_t", crate::kind::ArrivalKind => "uint32_t",
    crate::params::Quantity => "uint32_t",
    crate::params::Maybe<f32> => "luxel_maybe_float",
    crate::params::Maybe<f64> => "luxel_maybe_double",
    super::Slice<crate::num::Ray> => "luxel_rays",
    super::Slice<crate::params::Text<'static>> => "luxel_texts",
    super::Slice<super::ParamTable> => "luxel_params",
    super::Slice<super::ClassTable> => "luxel_classes",
    crate::kind::Queue<crate::kind::Onward> => "luxel_onward_queue",
    crate::kind::Queue<crate::kind::Shadow> => "luxel_shadow_queue",
    crate::params::Text<'_> => "luxel_text", crate::params::Table<'_> => "luxel_doubles",
    crate::params::File<'_> => "luxel_text", super::MeshSink => "luxel_mesh_sink",
    super::ImportSink => "luxel_import_sink", super::FaultSink => "luxel_fault_sink",
    super::ContextTable => "luxel_context_table",
}

impl CType for *mut Lane {
    fn declare(name: &str) -> String {
        Lane::declare(&format!("*{name}"))
    }
}
impl CType for *mut Arrival {
    fn declare(name: &str) -> String {
        Arrival::declare(&format!("*{name}"))
    }
}
