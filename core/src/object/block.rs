//! Bytes of a parameter struct, aligned, written field by field.
#![expect(unsafe_code, reason = "fields are written at the offsets of the plugin's schema")]

use std::mem::MaybeUninit;

use luxel_sdk::params::Field;

/// Size and alignment of the pieces that blocks are made of.
pub(super) const CHUNK: usize = 64;

/// A piece of a block: bytes that may be padding.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
pub(super) struct Chunk(pub(super) [MaybeUninit<u8>; CHUNK]);

/// The bytes of one parameter struct.
pub(super) struct Block(Box<[Chunk]>);

// SAFETY: parameter structs are `Send + Sync`, and nothing writes to a built block.
unsafe impl Send for Block {}
// SAFETY: as above.
unsafe impl Sync for Block {}

impl Block {
    /// Zero bytes for a struct of `size` bytes.
    pub(super) fn zeroed(size: usize) -> Self {
        let zero = Chunk([MaybeUninit::new(0); CHUNK]);
        Self(vec![zero; size.div_ceil(CHUNK).max(1)].into_boxed_slice())
    }

    /// The pieces, to be copied.
    pub(super) fn chunks(&self) -> &[Chunk] {
        &self.0
    }

    /// The address of the struct.
    pub(super) fn address(&self) -> *const u8 {
        self.0.as_ptr().cast()
    }

    /// The address of the struct, to be prepared.
    pub(super) fn address_mut(&mut self) -> *mut u8 {
        self.0.as_mut_ptr().cast()
    }

    /// Writes a field. The schema says that a `T` stands there.
    pub(super) fn write<T: Field>(&mut self, offset: usize, value: T) {
        self.write_raw(offset, value);
    }

    /// Writes any plain value. The schema says that a `T` stands there.
    pub(super) fn write_raw<T: Copy>(&mut self, offset: usize, value: T) {
        assert!(offset + size_of::<T>() <= self.0.len() * CHUNK, "a field outside its struct");
        // SAFETY: the offset is inside the block, as just asserted.
        let at = unsafe { self.address_mut().add(offset) };
        // SAFETY: the bytes are ours alone; an unaligned write has no other requirement.
        unsafe { at.cast::<T>().write_unaligned(value) }
    }
}
