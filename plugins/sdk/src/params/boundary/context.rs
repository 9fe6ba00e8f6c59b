//! What building may ask of the host, through the boundary.
#![expect(clippy::cast_ptr_alignment, reason = "addresses that this file made, given back")]

use std::marker::PhantomData;
use std::sync::Arc;

use super::super::{BuildContext, Text};
use crate::wire::{ByteSink, Slice, Status, guarded};

/// The host's functions, as C.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ContextTable {
    /// Bytes of this table as its maker knows it.
    pub size: usize,
    /// Reads a file that a parameter names (`base` empty), or one that the file at `base` names.
    pub read: unsafe extern "C" fn(
        at: *const u8,
        base: Text<'_>,
        path: Text<'_>,
        sink: &mut ByteSink,
    ) -> Status,
    /// Tells the author of something odd.
    pub warn: unsafe extern "C" fn(at: *const u8, message: Text<'_>) -> Status,
    /// Whether the work is no longer wanted.
    pub cancelled: unsafe extern "C" fn(at: *const u8) -> Status,
    /// Takes note that what is built keeps so many bytes more.
    pub holds: unsafe extern "C" fn(at: *const u8, bytes: usize) -> Status,
}

/// What building may ask of the host, lent for one call.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ContextRef<'a> {
    pub(crate) table: &'a ContextTable,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

const TABLE: ContextTable =
    ContextTable { size: size_of::<ContextTable>(), read, warn, cancelled, holds };

/// # Safety
/// `at` is what `ContextRef::new` made.
unsafe fn host<'a>(at: *const u8) -> &'a dyn BuildContext {
    // SAFETY: the caller says so.
    unsafe { *at.cast::<&dyn BuildContext>() }
}

/// A library's text, if it is one.
fn words(text: Text<'_>) -> Option<&str> {
    if text.bytes().len() > 1 << 20 {
        return None;
    }
    // SAFETY: the library lends it to the call.
    std::str::from_utf8(unsafe { text.bytes().get() }).ok()
}

unsafe extern "C" fn read(
    at: *const u8,
    base: Text<'_>,
    path: Text<'_>,
    sink: &mut ByteSink,
) -> Status {
    // SAFETY: the handle's own address.
    let host = unsafe { host(at) };
    let give = |bytes: &[u8]| {
        // SAFETY: function and owner were made together by whoever asks.
        unsafe { (sink.take)(sink.owner, Slice::new(bytes)) }
    };
    guarded(|| {
        let (Some(base), Some(path)) = (words(base), words(path)) else {
            give(b"a path that is not UTF-8");
            return Status::REFUSED;
        };
        let found = if base.is_empty() { host.read(path) } else { host.read_beside(base, path) };
        match found {
            Ok(bytes) => {
                give(&bytes);
                Status::OK
            }
            Err(message) => {
                give(message.as_bytes());
                Status::REFUSED
            }
        }
    })
}

unsafe extern "C" fn warn(at: *const u8, message: Text<'_>) -> Status {
    // SAFETY: the handle's own address.
    let host = unsafe { host(at) };
    guarded(|| {
        host.warn(words(message).unwrap_or("a warning that is not UTF-8"));
        Status::OK
    })
}

unsafe extern "C" fn cancelled(at: *const u8) -> Status {
    // SAFETY: the handle's own address.
    let host = unsafe { host(at) };
    guarded(|| if host.cancelled() { Status::OK } else { Status::NOTHING })
}

unsafe extern "C" fn holds(at: *const u8, bytes: usize) -> Status {
    // SAFETY: the handle's own address.
    let host = unsafe { host(at) };
    guarded(|| {
        host.holds(bytes);
        Status::OK
    })
}

impl<'a> ContextRef<'a> {
    /// Lends a context to a library.
    pub fn new(context: &'a &'a dyn BuildContext) -> Self {
        Self { table: &TABLE, at: std::ptr::from_ref(context).cast(), lent: PhantomData }
    }

    fn ask(&self, base: &str, path: &str) -> Result<Arc<[u8]>, String> {
        unsafe extern "C" fn take(owner: *mut u8, bytes: Slice<u8>) {
            // SAFETY: the owner is the vector below.
            let out = unsafe { &mut *owner.cast::<Vec<u8>>() };
            // SAFETY: the bytes are lent for this call.
            out.extend_from_slice(unsafe { bytes.get() });
        }
        let mut out = Vec::new();
        let mut sink = ByteSink { take, owner: (&raw mut out).cast() };
        // SAFETY: the handle lends the host; the sink lives.
        let read =
            || unsafe { (self.table.read)(self.at, Text::new(base), Text::new(path), &mut sink) };
        match { read }() {
            Status::OK => Ok(out.into()),
            _ => Err(String::from_utf8_lossy(&out).into_owned()),
        }
    }
}

impl BuildContext for ContextRef<'_> {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
        self.ask("", path)
    }

    fn read_beside(&self, base: &str, path: &str) -> Result<Arc<[u8]>, String> {
        self.ask(base, path)
    }

    fn warn(&self, message: &str) {
        // SAFETY: the handle lends the host.
        unsafe { (self.table.warn)(self.at, Text::new(message)) };
    }

    fn cancelled(&self) -> bool {
        // SAFETY: as above.
        unsafe { (self.table.cancelled)(self.at) == Status::OK }
    }

    fn holds(&self, bytes: usize) {
        // SAFETY: as above.
        unsafe { (self.table.holds)(self.at, bytes) };
    }
}

/// An object's shared table on its way through the boundary.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Built {
    /// What the struct's `Shared` field points to.
    pub address: *const u8,
    /// What frees it: `ClassTable::free` takes it.
    pub owner: *mut u8,
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    /// Notes what it is asked.
    #[derive(Default)]
    struct Noting(Mutex<Vec<String>>);

    impl Noting {
        fn note(&self, what: String) {
            self.0.lock().unwrap().push(what);
        }
    }

    impl BuildContext for Noting {
        fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
            Ok(path.as_bytes().into())
        }
        fn read_beside(&self, base: &str, path: &str) -> Result<Arc<[u8]>, String> {
            Err(format!("no {path} beside {base}"))
        }
        fn warn(&self, message: &str) {
            self.note(format!("warned: {message}"));
        }
        fn cancelled(&self) -> bool {
            self.0.lock().unwrap().len() > 1
        }
        fn holds(&self, bytes: usize) {
            self.note(format!("holds {bytes}"));
        }
    }

    #[test]
    fn what_a_library_asks_and_tells_comes_to_the_host() {
        let host = Noting::default();
        let lent: &dyn BuildContext = &host;
        let library = ContextRef::new(&lent);
        assert_eq!(library.read("a.ply").as_deref(), Ok(&b"a.ply"[..]));
        let missing = library.read_beside("a.gltf", "a.bin");
        assert_eq!(missing.unwrap_err(), "no a.bin beside a.gltf");
        library.holds(usize::MAX);
        assert!(!library.cancelled());
        library.warn("odd");
        assert!(library.cancelled());
        let noted = host.0.lock().unwrap();
        assert_eq!(*noted, [format!("holds {}", usize::MAX), "warned: odd".to_owned()]);
    }
}
