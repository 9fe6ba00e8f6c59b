//! Classes: how a host finds a plugin's schema and behaviour behind plain pointers.
//!
//! A class is a table of constants and functions. The host keeps the bytes of a parameter struct,
//! writes fields at the schema's offsets, and asks the class for a view of the bytes as a trait
//! object. The C boundary wraps the same table (docs/decisions/0003).
#![expect(unsafe_code, reason = "views turn the host's bytes back into the plugin's struct")]

#[cfg(test)]
mod tests;

use std::marker::PhantomData;

use crate::kind::{
    Camera, Filter, Importer, Integrator, Kind, Light, Material, MaterialRef, Medium,
    PathIntegrator, Phase, PhaseRef, Sampler, Shape, Texture,
};
use crate::params::{
    Build, BuildContext, Fault, Field, Param, Params, SharedFns, SharedTable, Type,
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
    const fn base<T: Params>(kind: Kind, name: &'static str, view: View) -> Self {
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
        }
    }

    /// Settings without behaviour, read by the host.
    pub const fn settings<T: Params>(kind: Kind, name: &'static str) -> Self {
        Self::base::<T>(kind, name, View::Settings)
    }

    /// An importer.
    pub const fn importer<T>(name: &'static str) -> Self
    where
        T: Params + Importer,
        for<'x> T::At<'x>: Importer,
    {
        unsafe fn view<'a, T: Params>(p: *const u8, _: Life<'a>) -> &'a (dyn Importer + 'a)
        where
            for<'x> T::At<'x>: Importer,
        {
            // SAFETY: the caller lends a valid struct of this class for 'a.
            unsafe { &*p.cast::<T::At<'a>>() }
        }
        unsafe fn check<T: Importer>(p: *const u8) -> Result<(), Fault> {
            // SAFETY: the caller passes a valid struct of this class.
            unsafe { &*p.cast::<T>() }.check()
        }
        Self {
            check: check::<T>,
            ..Self::base::<T>(Kind::Importer, name, View::Importer(view::<T>))
        }
    }

    /// An integrator.
    pub const fn integrator<T>(name: &'static str) -> Self
    where
        T: Params + PathIntegrator,
        for<'x> T::At<'x>: PathIntegrator,
    {
        unsafe fn view<'a, T: Params>(p: *const u8, _: Life<'a>) -> &'a (dyn Integrator + 'a)
        where
            for<'x> T::At<'x>: PathIntegrator,
        {
            // SAFETY: the caller lends a valid struct of this class for 'a.
            unsafe { &*p.cast::<T::At<'a>>() }
        }
        unsafe fn check<T: PathIntegrator>(p: *const u8) -> Result<(), Fault> {
            // SAFETY: the caller passes a valid struct of this class.
            unsafe { &*p.cast::<T>() }.check()
        }
        unsafe fn prepare<T: PathIntegrator>(p: *mut u8) {
            // SAFETY: the caller passes a valid struct of this class, not shared.
            unsafe { &mut *p.cast::<T>() }.prepare();
        }
        Self {
            check: check::<T>,
            prepare: if T::DERIVED { Some(prepare::<T>) } else { None },
            ..Self::base::<T>(Kind::Integrator, name, View::Integrator(view::<T>))
        }
    }
}

macro_rules! class {
    ($doc:literal, $fun:ident, $kind:ident) => {
        impl Class {
            #[doc = $doc]
            pub const fn $fun<T>(name: &'static str) -> Self
            where
                T: Params + $kind,
                for<'x> T::At<'x>: $kind,
            {
                unsafe fn view<'a, T: Params>(p: *const u8, _: Life<'a>) -> &'a (dyn $kind + 'a)
                where
                    for<'x> T::At<'x>: $kind,
                {
                    // SAFETY: the caller lends a valid struct of this class for 'a.
                    unsafe { &*p.cast::<T::At<'a>>() }
                }
                unsafe fn check<T: $kind>(p: *const u8) -> Result<(), Fault> {
                    // SAFETY: the caller passes a valid struct of this class.
                    unsafe { &*p.cast::<T>() }.check()
                }
                unsafe fn prepare<T: $kind>(p: *mut u8) {
                    // SAFETY: the caller passes a valid struct of this class, not shared.
                    unsafe { &mut *p.cast::<T>() }.prepare();
                }
                Self {
                    check: check::<T>,
                    prepare: if T::DERIVED { Some(prepare::<T>) } else { None },
                    ..Self::base::<T>(Kind::$kind, name, View::$kind(view::<T>))
                }
            }
        }
    };
}
class!("A shape.", shape, Shape);
class!("A material.", material, Material);
class!("A texture.", texture, Texture);
class!("A light.", light, Light);
class!("A medium.", medium, Medium);
class!("A phase function.", phase, Phase);
class!("A camera.", camera, Camera);
class!("A sampler.", sampler, Sampler);
class!("A filter.", filter, Filter);

/// Builds an object's shared table from its struct: what the derive puts into `SharedFns`.
///
/// # Safety
/// `p` is the address of a valid struct whose type is `P` but for lifetimes.
///
/// # Errors
/// What the plugin's `build` found.
pub unsafe fn build_shared<P, T>(
    p: *const u8,
    context: &dyn BuildContext,
) -> Result<SharedTable, Vec<Fault>>
where
    P: Build<T>,
    T: Send + Sync + 'static,
{
    // SAFETY: the caller passes a valid struct of this type.
    let params = unsafe { &*p.cast::<P>() };
    let table = Box::new(params.build(context)?);
    Ok(SharedTable { address: (&raw const *table).cast(), owner: table })
}
