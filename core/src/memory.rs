//! Large memory, in large pages, and given back beside the work: the system takes back 134 MB in some
//! 10 ms, and a load that is given up has several times as much.
#![expect(unsafe_code, reason = "an allocator's promises are unsafe to make")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, SyncSender};
use std::thread;

/// The system's allocator, but that what is large is asked for in large pages, and given back by a thread
/// of its own. A program that wants it names it as its `global_allocator`, and lets it begin.
///
/// At most 1 GB waits there to be given back, in at most 256 blocks; what would be more is given back at
/// once, as without it.
#[derive(Debug, Default)]
pub struct Memory {
    queue: OnceLock<SyncSender<Block>>,
    /// Bytes that are to be given back.
    pending: AtomicUsize,
}

/// Memory that nobody uses any more.
#[derive(Debug)]
struct Block {
    at: *mut u8,
    layout: Layout,
}

// SAFETY: nobody else has it any more, and the system's allocator takes memory of any thread.
unsafe impl Send for Block {}

/// From how many bytes on memory is large: two milliseconds' work to give back. What is smaller glibc comes
/// to keep for the next who asks, which is sooner still (its `M_MMAP_THRESHOLD` grows to this much).
const LARGE: usize = 32 << 20;
/// From how many bytes on large pages are asked for: of 2 MiB each, as most processors have them, so that
/// what is not written to in the last one is little.
const IN_LARGE_PAGES: usize = 4 << 20;
/// Bytes that may wait.
const MOST: usize = 1 << 30;
/// Blocks that may wait.
const BLOCKS: usize = 256;
/// Bytes that are given back at a time, a large page or as many small ones: as long as it takes, two tenths
/// of a millisecond at most, no thread of the program is given memory by the system.
#[cfg(target_os = "linux")]
const PIECE: usize = 2 << 20;

impl Memory {
    /// All is given back at once.
    pub const fn new() -> Self {
        Self { queue: OnceLock::new(), pending: AtomicUsize::new(0) }
    }

    /// From now on a thread gives back what is large, if the system lets it begin.
    pub fn begin(&'static self) {
        let (queue, blocks) = mpsc::sync_channel(BLOCKS);
        let give_back = move || {
            for block in blocks {
                self.give_back(&block);
            }
        };
        let begun = thread::Builder::new().name("gives back".to_owned()).spawn(give_back);
        if begun.is_ok() {
            // There is one already if it had begun, and this one ends.
            let _ = self.queue.set(queue);
        }
    }

    /// How many bytes wait to be given back.
    pub fn pending(&self) -> usize {
        self.pending.load(Ordering::Acquire)
    }

    /// Whether somebody else will give it back.
    fn leaves(&self, at: *mut u8, layout: Layout) -> bool {
        let Some(queue) = self.queue.get().filter(|_| layout.size() >= LARGE) else { return false };
        let before = self.pending.fetch_add(layout.size(), Ordering::AcqRel);
        let leaves = before + layout.size() <= MOST && queue.try_send(Block { at, layout }).is_ok();
        if !leaves {
            self.pending.fetch_sub(layout.size(), Ordering::AcqRel);
        }
        leaves
    }

    fn give_back(&self, block: &Block) {
        block.empty();
        // SAFETY: it came from there with this layout, and was left to be given back once.
        unsafe { System.dealloc(block.at, block.layout) };
        self.pending.fetch_sub(block.layout.size(), Ordering::AcqRel);
    }
}

impl Block {
    /// Gives its pages back, piece by piece: other threads are given memory in between.
    #[cfg(target_os = "linux")]
    fn empty(&self) {
        let (page, first) = (rustix::param::page_size(), self.at.addr());
        // Whole pages, as others may have the rest.
        let end = (first + self.layout.size()) / page * page;
        let mut start = first.next_multiple_of(page);
        while start < end {
            // A large page that is cut is copied into small ones.
            let next = (start + 1).next_multiple_of(PIECE).min(end);
            let piece = self.at.wrapping_add(start - first).cast();
            let advice = rustix::mm::Advice::LinuxDontNeed;
            // SAFETY: these pages lie within the block, of which nobody wants to know anything any more.
            let _ = unsafe { rustix::mm::madvise(piece, next - start, advice) };
            start = next;
        }
    }

    /// Elsewhere all of it is given back as a whole.
    #[cfg(not(target_os = "linux"))]
    fn empty(&self) {}
}

/// Asks for large pages: where each page of 4 KiB is asked for alone when it is first written to, that
/// takes a seventh of the time in which the tree of a large mesh is built.
///
/// Of all pages that hold some of it: what the system was asked of in part it moves no more as a whole, and
/// memory that grows would be copied.
#[cfg(target_os = "linux")]
fn in_large_pages(at: *mut u8, size: usize) -> *mut u8 {
    if size >= IN_LARGE_PAGES && !at.is_null() {
        let page = rustix::param::page_size();
        let before = at.addr() % page;
        let length = (before + size).next_multiple_of(page);
        let advice = rustix::mm::Advice::LinuxHugepage;
        // SAFETY: what the pages hold stays, whoever's it is. A system that has no others says so.
        let _ = unsafe { rustix::mm::madvise(at.wrapping_sub(before).cast(), length, advice) };
    }
    at
}

/// Elsewhere the system chooses.
#[cfg(not(target_os = "linux"))]
fn in_large_pages(at: *mut u8, _: usize) -> *mut u8 {
    at
}

// SAFETY: all memory is the system allocator's, which keeps the promises; what is left to the thread is
// given back there later, and used by nobody until then.
unsafe impl GlobalAlloc for Memory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promises are those that are asked for.
        let at = unsafe { System.alloc(layout) };
        in_large_pages(at, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promises are those that are asked for.
        let at = unsafe { System.alloc_zeroed(layout) };
        in_large_pages(at, layout.size())
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        if !self.leaves(at, layout) {
            // SAFETY: it came from there with this layout.
            unsafe { System.dealloc(at, layout) }
        }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: it came from there with this layout.
        let at = unsafe { System.realloc(at, layout, size) };
        in_large_pages(at, size)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn layout(size: usize) -> Layout {
        Layout::from_size_align(size, 16).unwrap()
    }

    /// Memory that holds a letter everywhere.
    fn filled(memory: &Memory, size: usize, letter: u8) -> *mut u8 {
        // SAFETY: the layout is not empty.
        let at = unsafe { memory.alloc(layout(size)) };
        assert!(!at.is_null());
        // SAFETY: so many bytes have just been given.
        unsafe { at.write_bytes(letter, size) };
        at
    }

    fn holds(at: *const u8, size: usize, letter: u8) -> bool {
        // SAFETY: whoever asks has filled it.
        unsafe { std::slice::from_raw_parts(at, size) }.iter().all(|byte| *byte == letter)
    }

    fn give_up(memory: &Memory, at: *mut u8, size: usize) {
        // SAFETY: it came from there with this layout.
        unsafe { memory.dealloc(at, layout(size)) }
    }

    #[test]
    fn large_memory_is_left_to_another_within_bounds() {
        let memory = Memory::new();
        let (queue, blocks) = mpsc::sync_channel(2);
        memory.queue.set(queue).unwrap();
        let free = |size| {
            let at = filled(&memory, size, 1);
            give_up(&memory, at, size);
            memory.pending()
        };
        assert_eq!(free(LARGE - 1), 0);
        assert_eq!(free(LARGE), LARGE);
        assert_eq!(free(2 * LARGE), 3 * LARGE);
        assert_eq!(free(LARGE), 3 * LARGE, "the queue was full");
        for n in [2, 1] {
            memory.give_back(&blocks.recv().unwrap());
            assert_eq!(memory.pending(), if n == 2 { 2 * LARGE } else { 0 });
        }
        memory.pending.store(MOST - LARGE, Ordering::SeqCst);
        assert_eq!(free(LARGE + 1), MOST - LARGE, "too much waited");
        assert!(blocks.try_recv().is_err());
    }

    #[test]
    fn nothing_waits_where_it_has_not_begun() {
        let memory = Memory::new();
        let at = filled(&memory, LARGE, 1);
        give_up(&memory, at, LARGE);
        assert_eq!(memory.pending(), 0);
    }

    #[test]
    fn what_is_given_back_takes_nothing_of_what_is_kept() {
        static MEMORY: Memory = Memory::new();
        MEMORY.begin();
        let sizes = [LARGE, LARGE + 1, 40_000, LARGE + 4097, LARGE + 12_345, 40_001];
        let made = (0..12u8).map(|i| {
            let size = sizes[usize::from(i) % sizes.len()];
            (filled(&MEMORY, size, i), size, i)
        });
        let made: Vec<_> = made.collect();
        let (kept, given): (Vec<_>, _) = made.into_iter().partition(|(_, _, i)| i % 2 == 0);
        for (at, size, _) in given {
            give_up(&MEMORY, at, size);
        }
        while MEMORY.pending() > 0 {
            thread::sleep(Duration::from_millis(1));
        }
        for (at, size, letter) in kept {
            // SAFETY: it came from there with this layout.
            let at = unsafe { MEMORY.realloc(at, layout(size), size + 4097) };
            assert!(holds(at, size, letter), "{letter}");
            give_up(&MEMORY, at, size + 4097);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    #[expect(clippy::disallowed_methods, reason = "what the system knows of this process")]
    fn large_memory_is_one_piece_to_the_system_so_that_it_grows_where_it_is() {
        let memory = Memory::new();
        let at = filled(&memory, LARGE, 3);
        let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
        let ends = |line: &str| {
            let (start, end) = line.split_once(' ').unwrap().0.split_once('-').unwrap();
            [start, end].map(|end| usize::from_str_radix(end, 16).unwrap())
        };
        let piece =
            |at: usize| maps.lines().position(|line| (ends(line)[0]..ends(line)[1]).contains(&at));
        assert_eq!(piece(at.addr()), piece(at.addr() + LARGE - 1));
        assert!(piece(at.addr()).is_some());
        give_up(&memory, at, LARGE);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_pages_of_a_block_are_given_back_before_it_is() {
        let (memory, size) = (Memory::new(), 3 * PIECE + 123);
        let at = filled(&memory, size, 9);
        Block { at, layout: layout(size) }.empty();
        // Pages that have been given back are zeros where they are looked at again.
        let start = at.addr().next_multiple_of(rustix::param::page_size()) - at.addr();
        assert!(holds(at, start, 9));
        let within = at.wrapping_add(start);
        // The last page is shared with whoever has what follows.
        assert!(holds(within, 3 * PIECE - rustix::param::page_size() - start, 0));
        give_up(&memory, at, size);
    }
}
