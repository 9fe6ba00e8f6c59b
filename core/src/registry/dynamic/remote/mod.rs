//! Objects of a class from a library, as the host sees them: each call crosses the boundary.
//!
//! Two words stand before the library's struct: its class, and the object's own watch. What a view
//! points to begins with them, so that built-ins and foreign objects look alike to the host.

mod camera;
mod conduct;
mod filter;
mod importer;
mod integrator;
mod light;
mod material;
mod medium;
mod phase;
mod sampler;
mod shape;
mod texture;

use std::borrow::Cow;
use std::marker::PhantomData;
use std::mem::MaybeUninit;

use luxel_sdk::abi::{Answer, Built, ClassTable, ContextRef, FaultSink, Life, Status, View};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{BuildContext, Fault, SharedTable, Text};

use super::Remote;
use super::watch::Watch;

pub(crate) use conduct::Conduct;
pub(super) use medium::THROUGH;
pub(super) use shape::NOWHERE;

/// Bytes before the library's struct. A multiple of its greatest alignment.
pub(super) const HEAD: usize = size_of::<Head>();

/// What stands before the library's struct.
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) struct Head {
    class: &'static Remote,
    watch: *const Watch,
}

impl Head {
    /// The words of an object: its class and its watch, which it keeps alive.
    pub(crate) fn new(class: &'static Remote, watch: &Watch) -> Self {
        Self { class, watch }
    }

    fn watch(&self) -> &Watch {
        // SAFETY: the object owns its watch and outlives every view of it.
        unsafe { &*self.watch }
    }

    /// The address of the library's struct.
    #[inline(always)]
    fn at(&self) -> *const u8 {
        std::ptr::from_ref(self).wrapping_add(1).cast()
    }

    /// The behaviour's table.
    ///
    /// # Safety
    /// `T` is the table of the class's kind.
    #[inline(always)]
    unsafe fn table<T>(&self) -> &'static T {
        // SAFETY: the caller says so; the table was adopted when the library was opened.
        unsafe { &*self.class.behaviour.cast::<T>() }
    }

    /// What a call answered; nothing after a panic, which ends the render.
    #[inline(always)]
    fn found<T>(&self, answer: Answer<T>) -> Option<T> {
        match answer {
            Ok(found) => found,
            Err(status) => {
                self.failed(status);
                None
            }
        }
    }

    /// Whether a call has left a result. For calls at every hit, which read the result where it was
    /// written, field by field: copied as a whole it is waited for (measured: 12 ns for an `Eval`).
    #[inline(always)]
    fn is_ok(&self, status: Status) -> bool {
        if status == Status::OK {
            return true;
        }
        if status != Status::NOTHING {
            self.failed(status);
        }
        false
    }

    #[cold]
    fn failed(&self, status: Status) {
        let said = self.class.library.last_panic();
        let told = match (status, said.is_empty()) {
            // Whoever kept no place of it said no more than its message.
            (Status::PANICKED, false) if !said.contains("panicked") => format!("panicked: {said}"),
            (Status::PANICKED, false) => said,
            (Status::PANICKED, true) => "panicked".to_owned(),
            (other, _) => format!("answered with the unknown status {}", other.0),
        };
        self.watch().fail(&told);
    }

    /// A result that no object of the kind may give: the render ends.
    #[cold]
    fn wrong(&self, told: &str) {
        self.watch().fail(told);
    }

    /// Whether the object has failed before, and is not to be called again.
    #[inline(always)]
    fn is_poisoned(&self) -> bool {
        self.watch().has_failed()
    }
}

/// Whether the byte of a `bool` in a result is one: what writes it may be C, and may leave it out.
///
/// # Safety
/// `offset` is that of a `bool` in the result.
#[inline(always)]
unsafe fn is_bool<T>(result: &MaybeUninit<T>, offset: usize) -> bool {
    // SAFETY: inside the result, says the caller; any byte is one.
    let byte = unsafe { result.as_ptr().cast::<u8>().wrapping_add(offset).read_volatile() };
    byte <= 1
}

/// A `bool` that is none.
const NO_BOOL: &str = "gave neither yes nor no where one of them is wanted";

/// Writes a view of each kind: the bytes of an object as a host-side type that begins with `Head`.
macro_rules! views {
    ($($kind:ident => $ty:path),* $(,)?) => {
        /// How bytes of this kind are seen.
        pub(super) fn view(kind: Kind) -> View {
            match kind {
                $(Kind::$kind => {
                    unsafe fn seen<'a>(
                        p: *const u8, _: Life<'a>,
                    ) -> &'a (dyn luxel_sdk::kind::$kind + 'a) {
                        // SAFETY: the host lends an object of this class, which begins with a head.
                        unsafe { &*p.cast::<$ty>() }
                    }
                    View::$kind(seen)
                })*
                Kind::Film => View::Settings,
            }
        }
    };
}
views! {
    Shape => shape::RemoteShape,
    Material => material::RemoteMaterial,
    Texture => texture::RemoteTexture,
    Light => light::RemoteLight,
    Medium => medium::RemoteMedium,
    Phase => phase::RemotePhase,
    Camera => camera::RemoteCamera,
    Sampler => sampler::RemoteSampler,
    Filter => filter::RemoteFilter,
    Integrator => integrator::RemoteIntegrator,
    Importer => importer::RemoteImporter,
}

/// The table through which libraries call an object that may itself be foreign: materials, phase
/// functions and shapes, the kinds that others hold.
pub(super) fn relay(kind: Kind) -> *const u8 {
    use luxel_sdk::abi::{MaterialTable, PhaseTable, ShapeTable};
    match kind {
        Kind::Material => {
            std::ptr::from_ref(MaterialTable::of::<material::RemoteMaterial>()).cast()
        }
        Kind::Phase => std::ptr::from_ref(PhaseTable::of::<phase::RemotePhase>()).cast(),
        Kind::Shape => std::ptr::from_ref(ShapeTable::of::<shape::RemoteShape>()).cast(),
        _ => std::ptr::null(),
    }
}

/// # Safety
/// `p` is the address of an object of a foreign class.
unsafe fn head<'a>(p: *const u8) -> &'a Head {
    // SAFETY: the caller says so.
    unsafe { &*p.cast::<Head>() }
}

/// Computes the derived fields.
///
/// # Safety
/// `p` is the address of an object of a foreign class with a `prepare`, not shared.
pub(super) unsafe fn prepare(p: *mut u8) {
    // SAFETY: the caller says so.
    let head = unsafe { *head(p) };
    let Some(prepare) = head.class.table.prepare else { return };
    if head.is_poisoned() {
        return;
    }
    // SAFETY: the struct stands behind the head, inside the same block.
    let at = unsafe { p.add(HEAD) };
    // SAFETY: a valid struct of the library's class, not shared.
    let status = unsafe { prepare(at) };
    if status != Status::OK {
        head.failed(status);
    }
}

/// The library's rules between parameters.
///
/// # Safety
/// `p` is the address of an object of a foreign class.
pub(super) unsafe fn check(p: *const u8) -> Result<(), Fault> {
    // SAFETY: the caller says so.
    let head = unsafe { head(p) };
    let Some(check) = head.class.table.check else { return Ok(()) };
    let mut faults = Faults::of(head.class);
    // SAFETY: a valid struct of the library's class; the sink lives.
    let status = unsafe { check(head.at(), &faults.sink()) };
    faults.verdict(head, status).map_or(Ok(()), |mut faults| Err(faults.swap_remove(0)))
}

/// Builds the shared table.
///
/// # Safety
/// `p` is the address of an object of a foreign class with a `build`.
pub(super) unsafe fn build(
    p: *const u8,
    context: &dyn BuildContext,
) -> Result<SharedTable, Vec<Fault>> {
    // SAFETY: the caller says so.
    let head = unsafe { head(p) };
    let ClassTable { build: Some(build), free, .. } = head.class.table else {
        unreachable!("a class without `build` has no shared table")
    };
    let mut faults = Faults::of(head.class);
    let mut out = Built { address: std::ptr::null(), owner: std::ptr::null_mut() };
    // SAFETY: a valid struct of the library's class; context and sinks live.
    let status = unsafe { build(head.at(), &ContextRef::new(&context), &faults.sink(), &mut out) };
    if let Some(found) = faults.verdict(head, status) {
        return Err(found);
    }
    if out.address.is_null() {
        head.wrong("built no shared table");
        let message = head.watch().told().unwrap_or_default();
        return Err(vec![Fault { field: "", code: FAILED, message }]);
    }
    Ok(SharedTable { address: out.address, owner: Box::new(Owned { owner: out.owner, free }) })
}

/// What stands for a library's own `free`, which `build` has taken along.
///
/// # Safety
/// Sound for any caller.
pub(super) unsafe extern "C" fn free_nothing(_: *mut u8) -> Status {
    Status::OK
}

/// A library's shared table, freed by the library.
struct Owned {
    owner: *mut u8,
    free: Option<unsafe extern "C" fn(*mut u8) -> Status>,
}

// SAFETY: the SDK demands of shared tables that they are `Send + Sync`.
unsafe impl Send for Owned {}
// SAFETY: as above.
unsafe impl Sync for Owned {}

impl Drop for Owned {
    fn drop(&mut self) {
        if let Some(free) = self.free {
            // SAFETY: made by the same class's `build`, and freed here alone.
            unsafe { free(self.owner) };
        }
    }
}

/// Faults that a library tells.
struct Faults<'a> {
    class: &'static Remote,
    found: Vec<Fault>,
    lent: PhantomData<&'a ()>,
}

/// A plugin that failed.
pub(crate) const FAILED: &str = "E0421";
/// Codes of faults that plugins tell. What they make up counts as out of range.
const CODES: [&str; 5] = ["E0405", "E0411", "E0412", "E0413", "E0415"];

/// Faults of one object that are told.
const MOST_FAULTS: usize = 100;
/// Bytes of a message: more is none.
const MOST_TEXT: usize = 1 << 20;

/// A library's words, which need not be UTF-8.
fn said(text: Text<'_>) -> Cow<'_, str> {
    if text.bytes().len() > MOST_TEXT {
        return Cow::Borrowed("a text that is too long");
    }
    // SAFETY: the library lends it to this call.
    String::from_utf8_lossy(unsafe { text.bytes().get() })
}

impl Faults<'_> {
    fn of(class: &'static Remote) -> Self {
        Self { class, found: vec![], lent: PhantomData }
    }

    fn sink(&mut self) -> FaultSink {
        unsafe extern "C" fn take(owner: *mut u8, field: Text<'_>, code: Text<'_>, told: Text<'_>) {
            // SAFETY: the sink's own owner, which outlives it.
            let faults = unsafe { &mut *owner.cast::<Faults<'_>>() };
            faults.take(&said(field), &said(code), said(told).into_owned());
        }
        FaultSink { take, owner: std::ptr::from_mut(self).cast() }
    }

    fn take(&mut self, field: &str, code: &str, message: String) {
        let known = self.class.params.iter().map(|param| param.name);
        let field = known.into_iter().find(|name| *name == field).unwrap_or("");
        let code = CODES.into_iter().find(|known| *known == code).unwrap_or(CODES[0]);
        if self.found.len() < MOST_FAULTS {
            self.found.push(Fault { field, code, message });
        }
    }

    /// What was told; a panic, and a refusal without a word, is a fault too.
    fn verdict(self, head: &Head, status: Status) -> Option<Vec<Fault>> {
        let mut found = self.found;
        if status == Status::OK {
            return None;
        }
        if status != Status::REFUSED {
            head.failed(status);
            let message = head.watch().told().unwrap_or_default();
            found.push(Fault { field: "", code: FAILED, message });
        }
        if found.is_empty() {
            let message = "the plugin refuses this object and does not say why".to_owned();
            found.push(Fault { field: "", code: CODES[0], message });
        }
        Some(found)
    }
}
