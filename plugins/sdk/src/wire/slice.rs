//! Values in a row, and where bytes go.

/// Values in a row, lent for as long as its maker says.
#[derive(Debug)]
#[repr(C)]
pub struct Slice<T> {
    pub(crate) items: *const T,
    pub(crate) len: usize,
}

impl<T> Clone for Slice<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Slice<T> {}
// SAFETY: a shared, read-only borrow.
unsafe impl<T: Sync> Send for Slice<T> {}
// SAFETY: as above.
unsafe impl<T: Sync> Sync for Slice<T> {}

impl<T> Slice<T> {
    /// Lends values.
    pub const fn new(items: &[T]) -> Self {
        Self { items: items.as_ptr(), len: items.len() }
    }

    /// How many there are said to be.
    pub const fn len(self) -> usize {
        self.len
    }

    /// Whether there are said to be none.
    pub const fn is_empty(self) -> bool {
        self.len == 0
    }

    /// Whether they stand nowhere.
    pub const fn is_null(self) -> bool {
        self.items.is_null()
    }

    /// The values; none where the address is null.
    ///
    /// # Safety
    /// Whoever made it lends the values for `'a`.
    pub const unsafe fn get<'a>(self) -> &'a [T] {
        if self.items.is_null() || self.len == 0 {
            return &[];
        }
        // SAFETY: the caller says that they are lent.
        unsafe { std::slice::from_raw_parts(self.items, self.len) }
    }
}

/// Where bytes that the host read go, or the words that say why there are none.
#[repr(C)]
pub struct ByteSink {
    /// Copies the bytes; `owner` comes first.
    pub take: unsafe extern "C" fn(*mut u8, Slice<u8>),
    /// Who asked.
    pub owner: *mut u8,
}

/// Tells what the last panic on this thread said.
pub type TellPanic = unsafe extern "C" fn(&mut ByteSink);
