//! The table that a library shows: what it is, and what it offers.

use super::{Built, ByteSink, Class, ContextRef, FaultSink, ParamTable, Slice, Status, header};
use crate::params::Text;

/// What a library's table begins with: `LUXEL` and three bytes that text never holds.
pub const MAGIC: u64 = u64::from_le_bytes(*b"LUXEL\x0d\x1a\x00");
/// Grows where tables stop being readable by older hosts.
pub const ABI_MAJOR: u32 = 1;
/// Grows where tables gain entries at their end.
pub const ABI_MINOR: u32 = 0;
/// What the frozen types look like here.
pub const LAYOUT_HASH: u64 = header::HASH;

/// A library's panics unwind, and its tables catch them.
pub const PANIC_UNWIND: u32 = 0;
/// A library cannot panic: it is not Rust.
pub const PANIC_NONE: u32 = 1;
/// A library's panics end the process: refused.
pub const PANIC_ABORT: u32 = 2;

/// What a library shows under the symbol `luxel_plugin_v1_<stem>`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct LibraryTable {
    /// `MAGIC`.
    pub magic: u64,
    /// `ABI_MAJOR`.
    pub abi_major: u32,
    /// `ABI_MINOR`.
    pub abi_minor: u32,
    /// `LAYOUT_HASH`.
    pub layout_hash: u64,
    /// Bytes of this table as its maker knows it.
    pub size: usize,
    /// Its name.
    pub name: Text<'static>,
    /// Its version, as `1.2.3`.
    pub version: Text<'static>,
    /// What compiled it: information for people.
    pub compiler: Text<'static>,
    /// What a panic does: `PANIC_UNWIND`, `PANIC_NONE`, or `PANIC_ABORT`.
    pub panic: u32,
    /// What it offers.
    pub classes: Slice<ClassTable>,
    /// Called once, before anything else; may be null.
    pub begin: Option<unsafe extern "C" fn()>,
    /// Tells what the last panic on this thread said; may be null.
    pub last_panic: Option<unsafe extern "C" fn(&mut ByteSink)>,
}

// SAFETY: constants and functions.
unsafe impl Sync for LibraryTable {}

/// One plugin of a library.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ClassTable {
    /// Which kind, by its place in `Kind::ALL`.
    pub kind: u32,
    /// Bytes of its parameter struct, at most 256.
    pub size: u32,
    /// Its name in a scene.
    pub name: Text<'static>,
    /// Its manual page.
    pub doc: Text<'static>,
    /// Its parameters.
    pub params: Slice<ParamTable>,
    /// Computes the derived fields; null where there are none.
    pub prepare: Option<unsafe extern "C" fn(*mut u8) -> Status>,
    /// Its rules between parameters; may be null.
    pub check: Option<unsafe extern "C" fn(*const u8, &FaultSink) -> Status>,
    /// Builds the shared table; null where there is none.
    pub build:
        Option<unsafe extern "C" fn(*const u8, &ContextRef<'_>, &FaultSink, &mut Built) -> Status>,
    /// Frees a shared table.
    pub free: Option<unsafe extern "C" fn(*mut u8) -> Status>,
    /// Where the address of the shared table is written.
    pub shared_offset: u64,
    /// The table of its kind, which begins with its size.
    pub behaviour: *const u8,
}

// SAFETY: constants and functions.
unsafe impl Send for ClassTable {}
// SAFETY: as above.
unsafe impl Sync for ClassTable {}

/// The C form of several classes: what `export!` puts into a library.
pub const fn class_tables<const N: usize>(lists: &[&[Class]]) -> [ClassTable; N] {
    let mut out = [first(lists).table; N];
    let (mut i, mut list) = (0, 0);
    while list < lists.len() {
        let mut j = 0;
        while j < lists[list].len() {
            out[i] = lists[list][j].table;
            i += 1;
            j += 1;
        }
        list += 1;
    }
    out
}

const fn first(lists: &[&[Class]]) -> Class {
    let mut list = 0;
    while lists[list].is_empty() {
        list += 1;
    }
    lists[list][0]
}

/// How many classes there are in several lists.
pub const fn count(lists: &[&[Class]]) -> usize {
    let (mut n, mut list) = (0, 0);
    while list < lists.len() {
        n += lists[list].len();
        list += 1;
    }
    n
}

/// The table of a library with these lists of classes, named like the crate.
#[macro_export]
macro_rules! library_table {
    ($lists:expr) => {{
        const LISTS: &[&[$crate::abi::Class]] = $lists;
        const TABLES: &[$crate::abi::ClassTable] =
            &$crate::abi::class_tables::<{ $crate::abi::count(LISTS) }>(LISTS);
        $crate::abi::LibraryTable {
            magic: $crate::abi::MAGIC,
            abi_major: $crate::abi::ABI_MAJOR,
            abi_minor: $crate::abi::ABI_MINOR,
            layout_hash: $crate::abi::LAYOUT_HASH,
            size: ::core::mem::size_of::<$crate::abi::LibraryTable>(),
            name: $crate::params::Text::new(env!("CARGO_CRATE_NAME")),
            version: $crate::params::Text::new(env!("CARGO_PKG_VERSION")),
            compiler: $crate::params::Text::new("Rust"),
            panic: if cfg!(panic = "unwind") {
                $crate::abi::PANIC_UNWIND
            } else {
                $crate::abi::PANIC_ABORT
            },
            classes: $crate::abi::Slice::new(TABLES),
            begin: Some($crate::abi::begin),
            last_panic: Some($crate::abi::tell_last_panic),
        }
    }};
}

/// Makes a dynamic library of lists of classes: the one line by which a crate with
/// `crate-type = ["cdylib"]` differs from built-ins. The library's name is the crate's.
///
/// ```text
/// luxel_sdk::export!(&[CLASSES]);
/// ```
#[macro_export]
macro_rules! export {
    ($lists:expr) => {
        const _: () = {
            #[expect(unsafe_code, reason = "the host finds the table by its symbol")]
            #[unsafe(export_name = concat!("luxel_plugin_v1_", env!("CARGO_CRATE_NAME")))]
            static LIBRARY: $crate::abi::LibraryTable = $crate::library_table!($lists);
        };
    };
}

/// A library of a few plugins: `CLASSES`, and its export.
///
/// ```text
/// luxel_sdk::plugin! { material "mirror" => Mirror; }
/// ```
#[macro_export]
macro_rules! plugin {
    ($($kind:ident $name:literal => $ty:ty;)+) => {
        /// What this library offers.
        pub const CLASSES: &[$crate::abi::Class] =
            &[$($crate::abi::Class::$kind::<$ty>($name)),+];
        $crate::export!(&[CLASSES]);
    };
}
