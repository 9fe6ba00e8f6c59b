//! A list that grows on the host's side of the plugin boundary alone.

use std::fmt;
use std::ops::Deref;

/// What is asked for, in order. The host makes it; whoever fills it lets the host's own code grow it.
#[repr(C)]
pub struct Queue<T: Copy> {
    pub(crate) items: *mut T,
    pub(crate) len: usize,
    pub(crate) capacity: usize,
    /// Makes room for more items than `capacity`.
    pub(crate) grow: unsafe extern "C" fn(*mut Self),
}

// SAFETY: the items belong to the queue, as those of a `Vec` do.
unsafe impl<T: Copy + Send> Send for Queue<T> {}
// SAFETY: as above.
unsafe impl<T: Copy + Sync> Sync for Queue<T> {}

impl<T: Copy> Default for Queue<T> {
    fn default() -> Self {
        let mut none = std::mem::ManuallyDrop::new(Vec::new());
        Self { items: none.as_mut_ptr(), len: 0, capacity: 0, grow: grow::<T> }
    }
}

/// Doubles the room of a queue that this code has made.
unsafe extern "C" fn grow<T: Copy>(queue: *mut Queue<T>) {
    // SAFETY: the caller passes its queue, which it has borrowed for writing.
    let queue = unsafe { &mut *queue };
    // SAFETY: pointer and capacity are those of a vector that was forgotten.
    let mut items = unsafe { Vec::from_raw_parts(queue.items, queue.len, queue.capacity) };
    items.reserve(queue.capacity.max(64));
    let mut items = std::mem::ManuallyDrop::new(items);
    (queue.items, queue.capacity) = (items.as_mut_ptr(), items.capacity());
}

/// Items of a queue that is filled by code which may not know an end.
const MOST: usize = 1 << 20;

/// The same up to a limit; there the queue begins anew, and shows that it is full.
unsafe extern "C" fn grow_to_limit<T: Copy>(queue: *mut Queue<T>) {
    // SAFETY: as above.
    let room = unsafe { (*queue).capacity };
    if room >= MOST {
        // SAFETY: as above; fewer items are valid too.
        unsafe { (*queue).len = 0 };
        return;
    }
    // SAFETY: as above.
    unsafe { grow(queue) }
}

impl<T: Copy> Queue<T> {
    /// From now on the queue has a limit, for whoever fills it without an end.
    pub fn limit(&mut self) {
        self.grow = grow_to_limit::<T>;
    }

    /// Whether it has come to its limit: what it holds is then not all that was asked for.
    pub fn is_full(&self) -> bool {
        self.capacity >= MOST
    }

    /// One more item, at the end.
    #[inline(always)]
    pub fn push(&mut self, item: T) {
        if self.len == self.capacity {
            // SAFETY: `grow` came with the queue, which is borrowed for writing.
            unsafe { (self.grow)(self) };
        }
        // SAFETY: there is room for more than `len` items.
        let end = unsafe { self.items.add(self.len) };
        // SAFETY: as above; nobody else refers to what lies beyond `len`.
        unsafe { end.write(item) };
        self.len += 1;
    }

    /// Forgets everything, keeps the memory.
    pub fn clear(&mut self) {
        self.len = 0;
    }
}

impl<T: Copy> Deref for Queue<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        // SAFETY: `len` items have been written.
        unsafe { std::slice::from_raw_parts(self.items, self.len) }
    }
}

impl<T: Copy> Drop for Queue<T> {
    fn drop(&mut self) {
        // SAFETY: pointer and capacity are those of a vector that was forgotten.
        drop(unsafe { Vec::from_raw_parts(self.items, self.len, self.capacity) });
    }
}

impl<T: Copy + fmt::Debug> fmt::Debug for Queue<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.deref().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_queue_with_a_limit_ends_and_says_so() {
        let mut queue = Queue::default();
        queue.limit();
        (0..MOST / 4).for_each(|i| queue.push(i));
        assert!(!queue.is_full() && queue.len() == MOST / 4);
        (0..8 * MOST).for_each(|i| queue.push(i));
        assert!(queue.is_full() && queue.capacity < 4 * MOST && queue.len() <= queue.capacity);
    }

    #[test]
    fn a_queue_keeps_what_is_pushed_in_order_and_its_memory_when_cleared() {
        let mut queue = Queue::default();
        assert!(queue.is_empty());
        (0..1000).for_each(|i| queue.push(i));
        assert!(queue.iter().copied().eq(0..1000));
        let room = queue.capacity;
        queue.clear();
        assert!(queue.is_empty() && queue.capacity == room);
    }
}
