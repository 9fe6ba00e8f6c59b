//! One table of C functions per kind, made from the kind's trait, and handles that call them.
//!
//! Every function takes the address of a parameter struct first, writes what it finds to `out`, and
//! returns a status; where it is not `OK`, `out` holds nothing. Tables grow at their end alone.
#![expect(unsafe_code, reason = "addresses from the other side of the boundary are read")]

mod camera;
mod filter;
mod importer;
mod integrator;
mod light;
mod material;
mod medium;
mod phase;
mod picture;
mod sampler;
mod shape;
mod texture;

use super::{
    CameraRay, Escaped, Eval, FreeFlight, Hit, LightSample, Needs, NormalDerivatives,
    Parallelogram, Raster, Sample, ShapeSample, Surface, Wants,
};
use crate::num::Bounds3;
use crate::wire::{put_fields, put_whole};

pub use camera::CameraTable;
pub use filter::FilterTable;
pub use importer::{ImportSink, ImporterTable, Value as ImportValueTable};
pub use integrator::{HostRef, HostTable, IntegratorTable, Lanes, RoundRef, SceneSphere};
pub use light::LightTable;
pub use material::{MaterialRef, MaterialTable};
pub use medium::MediumTable;
pub use phase::{PhaseRef, PhaseTable};
pub use picture::{PathsRef, PathsTable, PictureJobRef, PictureJobTable};
pub use sampler::{SamplerRef, SamplerTable, SamplesRef};
pub use shape::{MeshSink, ShapeRef, ShapeTable, Triangles};
pub use texture::{TextureRef, TextureTable};

/// Writes a table down once: the struct, its C form, the functions that a plugin puts into it, and
/// methods that call it.
macro_rules! table {
    (
        $(#[doc = $about:literal])*
        $trait:ident => $table:ident $c_name:literal {
            $(
                $(#[doc = $doc:literal])*
                fn $name:ident($me:ident $(, $arg:ident: $ty:ty)*) -> $out:ty $body:block
            )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Copy)]
        #[repr(C)]
        pub struct $table {
            /// Bytes of this table as its maker knows it.
            pub size: usize,
            $(
                $(#[doc = $doc])*
                pub $name: unsafe extern "C" fn(
                    at: *const u8, $($arg: $ty,)* out: &mut std::mem::MaybeUninit<$out>,
                ) -> $crate::wire::Status,
            )*
        }

        impl $table {
            /// The names of its functions, in order.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($name)),*];

            $(
                $(#[doc = $doc])*
                ///
                /// # Safety
                /// `at` is the address of a struct of the class that the table belongs to.
                ///
                /// # Errors
                /// The status, where it is neither a result nor nothing.
                #[inline(always)]
                pub unsafe fn $name(
                    &self, at: *const u8 $(, $arg: $ty)*
                ) -> $crate::wire::Answer<$out> {
                    let mut out = std::mem::MaybeUninit::uninit();
                    // SAFETY: the caller passes what this table's class was made for.
                    match unsafe { (self.$name)(at, $($arg,)* &mut out) } {
                        // SAFETY: the callee has written a result.
                        $crate::wire::Status::OK => Ok(Some(unsafe { out.assume_init() })),
                        $crate::wire::Status::NOTHING => Ok(None),
                        status => Err(status),
                    }
                }
            )*

            /// The table of a type that is one.
            pub const fn of<T: $trait>() -> &'static Self {
                &Self {
                    size: size_of::<Self>(),
                    $($name: {
                        unsafe extern "C" fn shim<T: $trait>(
                            at: *const u8, $($arg: $ty,)* out: &mut std::mem::MaybeUninit<$out>,
                        ) -> $crate::wire::Status {
                            let ask = |$me: &T| $body;
                            // SAFETY: the host calls with a valid struct of this class.
                            unsafe { $crate::wire::answer(at, out, ask) }
                        }
                        shim::<T>
                    },)*
                }
            }
        }

        impl $crate::wire::layout::CType for $table {
            fn declare(name: &str) -> String {
                format!(concat!($c_name, " {}"), name)
            }
        }

        impl $crate::wire::layout::Described for $table {
            fn describe(out: &mut String) {
                use $crate::wire::layout::{CType, argument, comment};
                comment(out, "", &[$($about),*]);
                out.push_str("typedef struct {\n");
                out.push_str("    /* Bytes of this table. */\n    size_t size;\n");
                $(
                    comment(out, "    ", &[$($doc),*]);
                    let mut arguments = vec!["const void *at".to_owned()];
                    $(arguments.push(argument::<$ty>(stringify!($arg)));)*
                    arguments.push(<$out as CType>::declare("*out"));
                    out.push_str(&format!(
                        "    luxel_status (*{})({});\n", stringify!($name), arguments.join(", ")
                    ));
                )*
                out.push_str(concat!("} ", $c_name, ";\n\n"));
            }
        }
    };
}
use table;

put_whole!(
    Needs,
    Wants,
    Bounds3,
    FreeFlight,
    Surface,
    ShapeSample,
    CameraRay,
    Escaped,
    PhaseRef<'static>,
    SceneSphere,
    Raster,
    Parallelogram,
    NormalDerivatives,
);
put_fields! {
    Eval { f, pdf }
    Sample { weight, wi, pdf, eta, lobe }
    Hit { t, at, face }
    LightSample { le, wi, distance, pdf, delta }
}
