//! Plugins from dynamic libraries: opened once, verified, never unloaded.
//!
//! A library's bytes are trusted before they come here: its constructors run when it is opened.
#![expect(unsafe_code, reason = "what a library shows is read through its C tables")]
#![expect(
    clippy::cast_ptr_alignment,
    reason = "owners of sinks and objects, given back as they were"
)]

mod adopt;
mod inspect;
mod remote;
mod schema;
mod watch;

use std::fmt;
use std::mem::offset_of;
use std::path::Path;
use std::sync::Arc;

use luxel_sdk::abi::{
    ABI_MAJOR, ByteSink, Class, ClassTable, LAYOUT_HASH, LibraryTable, MAGIC, PANIC_ABORT, Slice,
};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, SharedFns};

pub use inspect::inspect;
pub(crate) use remote::{Conduct, FAILED, Head};
pub use watch::{Alarm, Watch};

/// What the symbol of a library's table begins with; its file's stem follows.
pub const SYMBOL: &str = "luxel_plugin_v1_";

/// A library that was opened and found sound. It stays in memory as long as the process lives.
#[derive(Clone, Debug)]
pub struct Library {
    /// The name it gives itself.
    pub name: String,
    /// Its version, as `1.2.3`.
    pub version: String,
    /// Major and minor version of the boundary that it was built for.
    pub abi: (u32, u32),
    /// What compiled it: information for people.
    pub compiler: String,
    /// How many libraries of this stem were opened before it in this process.
    pub generation: u32,
    /// What it offers.
    pub classes: Vec<Class>,
}

/// Why a library cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// What was found and what would be right, lower case, no full stop.
    pub message: String,
}

impl LoadError {
    fn new(message: impl Into<String>) -> Self {
        Self { message: message.into() }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for LoadError {}

/// What all classes of a library share.
#[derive(Debug)]
struct Shared {
    name: String,
    version: String,
    last_panic: Option<unsafe extern "C" fn(&mut ByteSink)>,
}

impl Shared {
    /// What the last panic on this thread said, in the library or in what it called; may be empty.
    fn last_panic(&self) -> String {
        unsafe extern "C" fn take(owner: *mut u8, bytes: Slice<u8>) {
            // SAFETY: the sink's own owner.
            let out = unsafe { &mut *owner.cast::<String>() };
            // SAFETY: the library lends the bytes to this call.
            *out = String::from_utf8_lossy(unsafe { bytes.get() }).into_owned();
        }
        let mut said = luxel_sdk::abi::last_panic();
        if let (Some(last_panic), true) = (self.last_panic, said.is_empty()) {
            let mut sink = ByteSink { take, owner: (&raw mut said).cast() };
            // SAFETY: the library's own function; the sink lives.
            unsafe { last_panic(&mut sink) };
        }
        said
    }
}

/// What the host keeps about a class from a library.
pub(crate) struct Remote {
    table: ClassTable,
    /// The table of its kind, complete.
    behaviour: *const u8,
    params: &'static [Param],
    library: Arc<Shared>,
}

// SAFETY: constants and functions.
unsafe impl Send for Remote {}
// SAFETY: as above.
unsafe impl Sync for Remote {}

impl Remote {
    /// Who an object of this class is, for messages: `velvet 0.1.0`.
    pub(crate) fn origin(&self) -> String {
        format!("{} {}", self.library.name, self.library.version)
    }
}

/// What the host keeps about a class, if it came from a library.
pub(crate) fn remote(class: &Class) -> Option<&'static Remote> {
    class.host?.downcast_ref()
}

impl Library {
    /// Opens a private copy of a library and verifies what it offers. `stem` is the file's name
    /// without folder, `lib` and extension: the table's symbol is `luxel_plugin_v1_<stem>`.
    ///
    /// Code of the library runs: whoever calls has made sure that it is trusted.
    ///
    /// # Errors
    /// What is wrong with the library, with the first class at fault.
    pub fn open(copy: &Path, stem: &str, generation: u32) -> Result<Self, LoadError> {
        let library = load(copy).map_err(|error| {
            // The system's own words stand below the error.
            let cause = std::error::Error::source(&error).map(|cause| format!(": {cause}"));
            LoadError::new(format!("not loaded: {error}{}", cause.unwrap_or_default()))
        })?;
        let symbol = format!("{SYMBOL}{stem}");
        // SAFETY: the type is that of an address; what stands there is checked before use.
        let found = unsafe { library.get::<*const LibraryTable>(symbol.as_bytes()) };
        let table = found.ok().map(|symbol| *symbol);
        // Never unloaded: a thread may still hold what the library gave it.
        std::mem::forget(library);
        let Some(table) = table.filter(|table| !table.is_null()) else {
            return Err(LoadError::new(format!("no Luxel plugin: it has no symbol `{symbol}`")));
        };
        // SAFETY: the symbol's name says that a table stands there, and its first fields are
        // checked before the others are read.
        unsafe { verify(table, generation) }
    }

    /// Takes over a table of this process: for tests, and for plugins that are linked in.
    ///
    /// # Errors
    /// As `open`.
    pub fn linked(table: &'static LibraryTable) -> Result<Self, LoadError> {
        // SAFETY: a reference to a table.
        unsafe { verify(table, 0) }
    }
}

#[cfg(unix)]
fn load(path: &Path) -> Result<libloading::Library, libloading::Error> {
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: the caller trusts the library's code. Everything is bound now: a symbol that is
    // missing is an error here, not later.
    unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) }.map(Into::into)
}

#[cfg(not(unix))]
fn load(path: &Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: the caller trusts the library's code.
    unsafe { libloading::Library::new(path) }
}

/// # Safety
/// A `T` stands at this offset.
unsafe fn field<T>(table: *const LibraryTable, offset: usize) -> T {
    // SAFETY: the caller says so.
    unsafe { table.wrapping_byte_add(offset).cast::<T>().read_unaligned() }
}

/// # Safety
/// `table` is the address of what claims to be a library's table, which is never unloaded.
unsafe fn verify(table: *const LibraryTable, generation: u32) -> Result<Library, LoadError> {
    // SAFETY: the caller says so; the magic number comes first in every version.
    let magic: u64 = unsafe { field(table, offset_of!(LibraryTable, magic)) };
    if magic != MAGIC {
        return Err(LoadError::new(format!(
            "no Luxel plugin: its table begins with {magic:#018x}, not with {MAGIC:#018x}"
        )));
    }
    // SAFETY: a table with this magic has the versions next.
    let major: u32 = unsafe { field(table, offset_of!(LibraryTable, abi_major)) };
    if major != ABI_MAJOR {
        return Err(LoadError::new(format!(
            "built for version {major} of the plugin boundary, this program has {ABI_MAJOR}: build \
             it again with this version of luxel-sdk"
        )));
    }
    // SAFETY: this major version has the layout hash next.
    let hash: u64 = unsafe { field(table, offset_of!(LibraryTable, layout_hash)) };
    if hash != LAYOUT_HASH {
        return Err(LoadError::new(format!(
            "its types are laid out differently ({hash:#018x}, here {LAYOUT_HASH:#018x}): build it \
             again with this version of luxel-sdk, for this processor"
        )));
    }
    // SAFETY: this major version has the size next.
    let size: usize = unsafe { field(table, offset_of!(LibraryTable, size)) };
    if size < size_of::<LibraryTable>() || !table.is_aligned() {
        return Err(LoadError::new(format!("its table is only {size} bytes long")));
    }
    // SAFETY: of this layout, whole and aligned.
    let table = unsafe { &*table };
    if table.panic >= PANIC_ABORT {
        return Err(LoadError::new(
            "built with panic = \"abort\", so that a panic would end this program: build it with \
             panic = \"unwind\"",
        ));
    }
    // SAFETY: the caller says that the library stays.
    unsafe { read(table, generation) }
}

/// # Safety
/// `table` is a library's table of this layout.
unsafe fn read(table: &'static LibraryTable, generation: u32) -> Result<Library, LoadError> {
    let of = |what: &'static str| move |why| LoadError::new(format!("its {what} {why}"));
    // SAFETY: the library stays, here and below.
    let name = unsafe { schema::name(table.name) }.map_err(of("name"))?;
    // SAFETY: as above.
    let version = unsafe { schema::text(table.version) }.map_err(of("version"))?;
    // SAFETY: as above.
    let compiler = unsafe { schema::text(table.compiler) }.map_err(of("compiler"))?;
    // SAFETY: as above.
    let tables = unsafe { schema::items(table.classes, 1 << 12) }.map_err(of("list of classes"))?;
    let library = Arc::new(Shared {
        name: name.to_owned(),
        version: version.to_owned(),
        last_panic: table.last_panic,
    });
    if let Some(begin) = table.begin {
        // SAFETY: the library's own function, called once.
        unsafe { begin() };
    }
    let mut classes: Vec<Class> = vec![];
    for (i, table) in tables.iter().enumerate() {
        // SAFETY: as above.
        let class = unsafe { class(table, &library) }
            .map_err(|why| LoadError::new(format!("class {}: {why}", i + 1)))?;
        if classes.iter().any(|other| (other.kind, other.name) == (class.kind, class.name)) {
            let message = format!("it offers {} `{}` twice", class.kind, class.name);
            return Err(LoadError::new(message));
        }
        classes.push(class);
    }
    Ok(Library {
        name: name.to_owned(),
        version: version.to_owned(),
        abi: (table.abi_major, table.abi_minor),
        compiler: compiler.to_owned(),
        generation,
        classes,
    })
}

/// # Safety
/// `table` is a class of a library that stays.
unsafe fn class(table: &'static ClassTable, library: &Arc<Shared>) -> Result<Class, String> {
    let kind = Kind::ALL.get(table.kind as usize).map(|(kind, _)| *kind);
    let kind = kind.filter(|kind| *kind != Kind::Film);
    let kind = kind.ok_or_else(|| format!("{} is no kind of plugin", table.kind))?;
    // SAFETY: the caller says so, here and below.
    let name = unsafe { schema::name(table.name) }.map_err(|why| format!("its name {why}"))?;
    let of = |why: String| format!("{kind} `{name}`: {why}");
    // SAFETY: as above.
    let doc = unsafe { schema::text(table.doc) }.map_err(|why| of(format!("its doc {why}")))?;
    if doc.is_empty() {
        return Err(of("it has no doc: it is the manual page".to_owned()));
    }
    let size = table.size as usize;
    if size > schema::MOST_STRUCT {
        return Err(of(format!("its parameters take {size} bytes, at most 256 are allowed")));
    }
    // SAFETY: as above.
    let params = unsafe { schema::params(kind, table) }.map_err(of)?;
    let shared = match table.build {
        Some(build) => Some(SharedFns {
            offset: schema::shared_offset(table, &params).map_err(of)?,
            build: remote::build,
            build_abi: build,
            free_abi: remote::free_nothing,
        }),
        None => None,
    };
    // SAFETY: as above.
    let behaviour = unsafe { adopt::adopt(kind, table.behaviour) }.map_err(of)?;
    let params: &'static [Param] = params.leak();
    let kept: &'static Remote =
        Box::leak(Box::new(Remote { table: *table, behaviour, params, library: library.clone() }));
    Ok(Class {
        kind,
        name,
        doc,
        params,
        size: size + remote::HEAD,
        prepare: table.prepare.map(|_| remote::prepare as _),
        check: remote::check,
        shared,
        view: remote::view(kind),
        table: ClassTable { behaviour: remote::relay(kind), ..*table },
        host: Some(kept),
    })
}
