//! Classes: how a host finds a plugin's schema and behaviour behind plain pointers.
//!
//! A class is a table of constants and functions. The host keeps the bytes of a parameter struct,
//! writes fields at the schema's offsets, and asks the class for a view of the bytes as a trait
//! object. The C boundary wraps the same table (docs/decisions/0003).
#![expect(unsafe_code, reason = "views turn the host's bytes back into the plugin's struct")]

mod library;
mod header;
mod c_types;
mod shared;

#[cfg(test)]
mod tests;

use std::any::Any;
use std::marker::PhantomData;

use crate::kind::{
    Camera, Filter, Importer, Integrator, Kind, Light, Material, Medium, PathIntegrator, Phase,
    Picture, PictureIntegrator, Sampler, Shape, Texture,
};
use crate::params::{Fault, Field, Param, Params, SharedFns, Text, Type};

pub use header::header;
pub use library::{
    ABI_MAJOR, ABI_MINOR, ClassTable, LAYOUT_HASH, LibraryTable, MAGIC, PANIC_ABORT, PANIC_NONE,
    PANIC_UNWIND, class_tables, count,
};
pub use shared::{build_shared, build_shared_abi, free_shared};

pub use crate::kind::table::{
    CameraTable, FilterTable, HostRef, HostTable, ImportSink, ImportValueTable, ImporterTable,
    IntegratorTable, Lanes, LightTable, MaterialRef, MaterialTable, MediumTable, MeshSink,
    PathsRef, PathsTable, PhaseRef, PhaseTable, PictureJobRef, PictureJobTable, RoundRef,
    SamplerRef, SamplerTable, SamplesRef, SceneSphere, ShapeRef, ShapeTable, TextureRef,
    TextureTable, Triangles,
};
pub use crate::params::{
    Built, ContextRef, ContextTable, FaultSink, HANDLE, ParamTable, TYPES, param_tables,
};
pub use crate::wire::{
    Answer, ByteSink, Slice, Status, TellPanic, begin, guarded, last_panic, tell_last_panic,
};

/// A lifetime as a value: how long the bytes behind a view are lent.
pub type Life<'a> = PhantomData<&'a ()>;

// SAFETY: the host writes a live material, which is never null.
unsafe impl Field for MaterialRef<'_> {
    const TYPE: Type = Type::Object(Kind::Material);
}
// SAFETY: the host writes a live phase function, which is never null.
unsafe impl Field for PhaseRef<'_> {
    const TYPE: Type = Type::Object(Kind::Phase);
}
// SAFETY: the host writes a live texture; zero bytes are none.
unsafe impl Field for TextureRef<'_> {
    const TYPE: Type = Type::Object(Kind::Texture);
}

// SAFETY: the host writes a live shape, which is never null.
unsafe impl Field for ShapeRef<'_> {
    const TYPE: Type = Type::Part;
}

/// How bytes are seen as a plugin of each kind.
///
/// # Safety
/// Each function takes the address of a valid parameter struct of its class, lent for `'a`.
#[derive(Clone, Copy)]
#[expect(missing_docs, reason = "one variant per kind, named like it")]
pub enum View {
    Shape(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Shape + 'a)),
    Material(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Material + 'a)),
    Texture(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Texture + 'a)),
    Light(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Light + 'a)),
    Medium(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Medium + 'a)),
    Phase(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Phase + 'a)),
    Camera(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Camera + 'a)),
    Sampler(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Sampler + 'a)),
    Filter(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Filter + 'a)),
    Integrator(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Integrator + 'a)),
    Importer(for<'a> unsafe fn(*const u8, Life<'a>) -> &'a (dyn Importer + 'a)),
    /// Settings that the host itself reads: no behaviour.
    Settings,
}

/// One plugin: its name, manual, schema and behaviour.
#[derive(Clone, Copy)]
pub struct Class {
    /// What it is.
    pub kind: Kind,
    /// Its name in a scene: `[a-z0-9_]+`.
    pub name: &'static str,
    /// Its manual page.
    pub doc: &'static str,
    /// Its parameters.
    pub params: &'static [Param],
    /// Size of its struct, bytes.
    pub size: usize,
    /// How its derived fields are computed, if it has any.
    pub prepare: Option<unsafe fn(*mut u8)>,
    /// Its rules between parameters.
    pub check: unsafe fn(*const u8) -> Result<(), Fault>,
    /// How its shared table is built, if it has one.
    pub shared: Option<SharedFns>,
    /// Its behaviour.
    pub view: View,
    /// The same, as it crosses the boundary.
    pub table: ClassTable,
    /// What the host knows of a class that came from a library; `None` for others.
    pub host: Option<&'static (dyn Any + Send + Sync)>,
}

impl std::fmt::Debug for Class {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.kind, self.name)
    }
}

#[expect(clippy::unnecessary_wraps, reason = "it stands where classes check")]
unsafe fn no_check(_: *const u8) -> Result<(), Fault> {
    Ok(())
}

impl Class {
    /// Whether this is the same class of the same origin: of the same generation, if it came from a
    /// library.
    pub fn is_same(&self, other: &Self) -> bool {
        let origin = |class: &Self| class.host.map(|host| std::ptr::from_ref(host).cast::<()>());
        (self.kind, self.name) == (other.kind, other.name) && origin(self) == origin(other)
    }

    const fn base<T: Params>(kind: Kind, name: &'static str, view: View) -> Self {
        let table = ClassTable {
            kind: kind as u32,
            #[expect(clippy::cast_possible_truncation, reason = "at most 256, says the derive")]
            size: size_of::<T>() as u32,
            name: Text::new(name),
            doc: Text::new(T::DOC),
            params: Slice::new(T::TABLE),
            prepare: None,
            check: None,
            build: None,
            free: None,
            shared_offset: 0,
            behaviour: std::ptr::null(),
        };
        Self {
            kind,
            name,
            doc: T::DOC,
            params: T::SCHEMA,
            size: size_of::<T>(),
            prepare: None,
            check: no_check,
            shared: T::SHARED,
            view,
            table: match T::SHARED {
                None => table,
                Some(shared) => ClassTable {
                    build: Some(shared.build_abi),
                    free: Some(shared.free_abi),
                    shared_offset: shared.offset as u64,
                    ..table
                },
            },
            host: None,
        }
    }

    /// Settings without behaviour, read by the host.
    pub const fn settings<T: Params>(kind: Kind, name: &'static str) -> Self {
        Self::base::<T>(kind, name, View::Settings)
    }
}

/// A parameter struct that is its own behaviour.
type Itself<T> = T;

macro_rules! class {
    ($doc:literal, $fun:ident, $kind:ident, $trait:ident, $table:ident $(, $prepare:ident)?) => {
        class!($doc, $fun, $kind, $trait as Itself, $table $(, $prepare)?);
    };
    (
        $doc:literal, $fun:ident, $kind:ident, $trait:ident as $seen:ident, $table:ident
        $(, $prepare:ident)?
    ) => {
        impl Class {
            #[doc = $doc]
            pub const fn $fun<T>(name: &'static str) -> Self
            where
                T: Params + $trait,
                for<'x> T::At<'x>: $trait,
            {
                unsafe fn view<'a, T: Params>(p: *const u8, _: Life<'a>) -> &'a (dyn $kind + 'a)
                where
                    for<'x> T::At<'x>: $trait,
                {
                    // SAFETY: the caller lends a valid struct of this class for 'a.
                    unsafe { &*p.cast::<$seen<T::At<'a>>>() }
                }
                unsafe fn check<T: $trait>(p: *const u8) -> Result<(), Fault> {
                    // SAFETY: the caller passes a valid struct of this class.
                    unsafe { &*p.cast::<T>() }.check()
                }
                unsafe extern "C" fn check_abi<T: $trait>(
                    p: *const u8,
                    faults: &FaultSink,
                ) -> Status {
                    guarded(|| {
                        // SAFETY: the caller passes a valid struct of this class.
                        let found = unsafe { check::<T>(p) };
                        faults.judge(found.err().as_slice())
                    })
                }
                let base = Self::base::<T>(Kind::$kind, name, View::$kind(view::<T>));
                let behaviour = std::ptr::from_ref($table::of::<$seen<T>>()).cast();
                let table = ClassTable { check: Some(check_abi::<T>), behaviour, ..base.table };
                let class = Self { check: check::<T>, table, ..base };
                $(if T::DERIVED {
                    unsafe fn $prepare<T: $trait>(p: *mut u8) {
                        // SAFETY: the caller passes a valid struct of this class, not shared.
                        unsafe { &mut *p.cast::<T>() }.prepare();
                    }
                    unsafe extern "C" fn prepare_abi<T: $trait>(p: *mut u8) -> Status {
                        guarded(|| {
                            // SAFETY: as above.
                            unsafe { $prepare::<T>(p) };
                            Status::OK
                        })
                    }
                    let table = ClassTable { prepare: Some(prepare_abi::<T>), ..class.table };
                    return Self { prepare: Some($prepare::<T>), table, ..class };
                })?
                class
            }
        }
    };
}
class!("A shape.", shape, Shape, Shape, ShapeTable, prepare);
class!("A material.", material, Material, Material, MaterialTable, prepare);
class!("A texture.", texture, Texture, Texture, TextureTable, prepare);
class!("A light.", light, Light, Light, LightTable, prepare);
class!("A medium.", medium, Medium, Medium, MediumTable, prepare);
class!("A phase function.", phase, Phase, Phase, PhaseTable, prepare);
class!("A camera.", camera, Camera, Camera, CameraTable, prepare);
class!("A sampler.", sampler, Sampler, Sampler, SamplerTable, prepare);
class!("A filter.", filter, Filter, Filter, FilterTable, prepare);
class!("An integrator.", integrator, Integrator, PathIntegrator, IntegratorTable, prepare);
class!(
    "An integrator that owns the whole picture.",
    picture_integrator,
    Integrator,
    PictureIntegrator as Picture,
    IntegratorTable,
    prepare
);
class!("An importer.", importer, Importer, Importer, ImporterTable);
