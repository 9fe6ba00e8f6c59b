//! A sound library of this process, to be altered: what a buggy compiler or a careless hand makes.
#![expect(unsafe_code, reason = "tables are altered as no safe code could")]

use glam::Vec3;
use luxel_core::registry::dynamic::{Library, LoadError};
use luxel_sdk::abi::{
    Built, Class, ClassTable, ContextRef, FaultSink, LibraryTable, MaterialTable, ParamTable,
    Slice, Status,
};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Material, Sample};
use luxel_sdk::params::Text;
use luxel_sdk::{Choice, Params};

/// A word of its own.
#[derive(Clone, Copy, Choice)]
#[repr(u32)]
enum Word {
    /// The first.
    One,
    /// The second.
    Two,
}

/// A material that is what it says.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Honest {
    /// How much.
    #[param(default = 0.5, min = 0, max = 1, textured)]
    amount: f32,
    /// Which of them.
    #[param(default = Word::One, choice)]
    word: Word,
    /// How far.
    #[param(default = 1.0, unit = "m", min = 0)]
    far: f64,
}

impl Material for Honest {
    fn eval(&self, _: Vec3, _: Vec3) -> Eval {
        Eval::ZERO
    }
    fn sample(&self, _: Vec3, _: [f32; 3]) -> Option<Sample> {
        let far = self.far > f64::from(self.amount) && self.word as u32 == 0;
        Some(Sample::delta(Vec3::Z, Spectrum::splat(f32::from(u8::from(far)))))
    }
}

const CLASS: Class = Class::material::<Honest>("honest");

/// The parameters of the class, by name.
pub(super) const AMOUNT: usize = 0;
pub(super) const WORD: usize = 1;
pub(super) const FAR: usize = 2;

/// A library of one class, taken apart.
pub(super) struct Forge {
    pub(super) library: LibraryTable,
    pub(super) class: ClassTable,
    pub(super) params: Vec<ParamTable>,
    /// The table of the material: its size, then `needs`, `eval` and `sample`.
    pub(super) table: Vec<usize>,
    /// How often it offers its class.
    pub(super) times: usize,
}

impl Forge {
    fn new() -> Self {
        let library = luxel_sdk::library_table!(&[&[CLASS]]);
        // The hook of a library's panics would be that of these tests.
        let library = LibraryTable { begin: None, last_panic: None, ..library };
        // SAFETY: a table of the SDK's own making.
        let params = unsafe { CLASS.table.params.get() }.to_vec();
        let n = size_of::<MaterialTable>() / size_of::<usize>();
        // SAFETY: the same; a size and addresses.
        let table = unsafe { std::slice::from_raw_parts(CLASS.table.behaviour.cast(), n) }.to_vec();
        Self { library, class: CLASS.table, params, table, times: 1 }
    }

    /// Its objects have a shared table, whose address is written there.
    pub(super) fn share(&mut self, at: u64) {
        unsafe extern "C" fn build(
            _: *const u8,
            _: &ContextRef<'_>,
            _: &FaultSink,
            _: &mut Built,
        ) -> Status {
            Status::OK
        }
        self.class.build = Some(build);
        self.class.shared_offset = at;
    }

    fn put_together(self) -> &'static LibraryTable {
        let Self { library, class, params, table, times } = self;
        let params = if class.params.is_null() && !class.params.is_empty() {
            class.params
        } else {
            Slice::new(params.leak())
        };
        let behaviour =
            if class.behaviour.is_null() { class.behaviour } else { table.leak().as_ptr().cast() };
        let class = ClassTable { params, behaviour, ..class };
        let classes = Slice::new(vec![class; times].leak());
        Box::leak(Box::new(LibraryTable { classes, ..library }))
    }
}

/// What the host says of the library after a change.
pub(super) fn opened(change: impl FnOnce(&mut Forge)) -> Result<Library, LoadError> {
    let mut forge = Forge::new();
    change(&mut forge);
    Library::linked(forge.put_together())
}

/// A text that may stand anywhere and hold anything.
pub(super) fn text(ptr: *const u8, len: usize) -> Text<'static> {
    // SAFETY: `Text` is an address and a length; the host is to mistrust both.
    unsafe { std::mem::transmute::<(*const u8, usize), Text<'static>>((ptr, len)) }
}

/// A text of these bytes, UTF-8 or not.
pub(super) fn bytes(bytes: &'static [u8]) -> Text<'static> {
    text(bytes.as_ptr(), bytes.len())
}

/// Values that may stand anywhere.
pub(super) fn slice<T>(ptr: *const T, len: usize) -> Slice<T> {
    // SAFETY: `Slice` is an address and a length; the host is to mistrust both.
    unsafe { std::mem::transmute::<(*const T, usize), Slice<T>>((ptr, len)) }
}
