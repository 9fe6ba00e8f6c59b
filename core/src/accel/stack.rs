//! What a walk through a tree has still to visit.
#![expect(unsafe_code, reason = "room that is not cleared for each ray")]

use std::hint::select_unpredictable;
use std::mem::MaybeUninit;

use super::node::{Child, WIDTH};

/// One more than a tree may ask for: builders bound the depth.
const ROOM: usize = 640;

/// Entries that a walk through a tree of this many levels can need: a node takes itself off the
/// stack and puts all its children on it, written in one piece.
fn need(depth: usize) -> usize {
    (WIDTH - 1) * depth + 2 * WIDTH
}

/// Whether a stack has room for a tree of this many levels.
pub(super) fn is_enough_for(depth: usize) -> bool {
    need(depth) < ROOM
}

/// Room for what is still to be visited, and where the ray enters it. It is not cleared when it is
/// made: a ray would pay for that more than for a small tree.
#[derive(Debug)]
pub struct Room<T: Copy> {
    children: [MaybeUninit<Child>; ROOM],
    entries: [MaybeUninit<T>; ROOM],
}

/// A stack in its room, apart from it so that its length stays in a register.
#[derive(Debug)]
pub struct Stack<'a, T: Copy> {
    room: &'a mut Room<T>,
    len: usize,
}

/// Room for the children of one node on top of a stack.
#[cfg(target_arch = "x86_64")]
pub(super) struct Top<'a, T> {
    pub(super) children: &'a mut [MaybeUninit<Child>; WIDTH],
    pub(super) entries: &'a mut [MaybeUninit<T>; WIDTH],
}

impl<T: Copy> Default for Room<T> {
    #[inline(always)]
    fn default() -> Self {
        Self {
            children: [const { MaybeUninit::uninit() }; ROOM],
            entries: [const { MaybeUninit::uninit() }; ROOM],
        }
    }
}

impl<T: Copy> Room<T> {
    /// An empty stack.
    #[inline(always)]
    pub fn stack(&mut self) -> Stack<'_, T> {
        Stack { room: self, len: 0 }
    }
}

/// For instructions that write eight children at once.
#[cfg(target_arch = "x86_64")]
impl<T: Copy> Stack<'_, T> {
    /// Where eight more would stand.
    ///
    /// # Panics
    /// Beyond the room.
    #[inline(always)]
    pub(super) fn top(&mut self) -> Top<'_, T> {
        let range = self.len..self.len + WIDTH;
        let children = (&mut self.room.children[range.clone()]).try_into();
        let entries = (&mut self.room.entries[range]).try_into();
        Top {
            children: children.expect("the range has this length"),
            entries: entries.expect("the range has this length"),
        }
    }

    /// Keeps so many of what was written at [`Stack::top`].
    ///
    /// # Safety
    /// The first `n` children and entries have been written.
    #[inline(always)]
    pub(super) unsafe fn keep(&mut self, n: usize) {
        self.len += n;
    }
}

impl<T: Copy> Stack<'_, T> {
    /// Forgets what it holds.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Writes a value and keeps it if `kept`: without a branch, which could not be foreseen.
    ///
    /// # Panics
    /// Beyond the room.
    #[inline(always)]
    pub(super) fn push_if(&mut self, kept: bool, child: Child, entry: T) {
        self.room.children[self.len].write(child);
        self.room.entries[self.len].write(entry);
        self.len += usize::from(kept);
    }

    /// Forgets those whose entry is not as it has to be.
    #[inline(always)]
    pub(super) fn keep_if(&mut self, keeps: impl Fn(T) -> bool) {
        for i in 0..std::mem::take(&mut self.len) {
            let (child, entry) = self.at(i);
            self.push_if(keeps(entry), child, entry);
        }
    }

    /// What was kept last; if `stays`, that is left where it is, and this is `instead`. Without a branch.
    ///
    /// # Panics
    /// Where nothing is kept.
    #[inline(always)]
    pub(super) fn pop_unless(&mut self, stays: bool, instead: Child) -> Child {
        assert!(self.len > 0, "something is kept");
        let (last, _) = self.at(self.len - 1);
        self.len -= usize::from(!stays);
        select_unpredictable(stays, instead, last)
    }

    /// How many are kept.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// What was kept last.
    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<(Child, T)> {
        self.pop_above(0)
    }

    /// The same, but for the first `n`, which stay.
    #[inline(always)]
    pub(super) fn pop_above(&mut self, n: usize) -> Option<(Child, T)> {
        if self.len <= n {
            return None;
        }
        self.len -= 1;
        Some(self.at(self.len))
    }

    /// An entry that is kept, or was until now.
    #[inline(always)]
    fn at(&self, i: usize) -> (Child, T) {
        // SAFETY: entries are written before they are counted, in their order, and stay written.
        let child = unsafe { self.room.children[i].assume_init() };
        // SAFETY: as above.
        let entry = unsafe { self.room.entries[i].assume_init() };
        (child, entry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back_last_first() {
        let mut room = Room::default();
        let mut stack = room.stack();
        for (kept, value) in [(true, 1), (false, 2), (true, 3), (false, 4)] {
            stack.push_if(kept, Child::node(value), value);
        }
        let mut pop = || stack.pop().map(|(child, value)| (child.index(), value));
        assert_eq!([pop(), pop(), pop()], [Some((3, 3)), Some((1, 1)), None]);
    }

    #[test]
    fn some_are_forgotten_and_the_others_keep_their_order() {
        let mut room = Room::default();
        let mut stack = room.stack();
        (0..6).for_each(|value| stack.push_if(true, Child::node(value), value));
        stack.keep_if(|value| value % 2 == 1);
        let mut pop = || stack.pop().map(|(child, value)| (child.index(), value));
        assert_eq!([pop(), pop(), pop(), pop()], [Some((5, 5)), Some((3, 3)), Some((1, 1)), None]);
    }

    #[test]
    fn the_last_is_taken_unless_it_stays() {
        let mut room = Room::default();
        let mut stack = room.stack();
        (0..2).for_each(|value| stack.push_if(true, Child::node(value), value));
        let mut pop = |stays| stack.pop_unless(stays, Child::OVER);
        assert_eq!([pop(true), pop(false)], [Child::OVER, Child::node(1)]);
        assert_eq!([pop(true), pop(false)], [Child::OVER, Child::node(0)]);
        assert_eq!(stack.len(), 0);
    }

    #[test]
    fn the_first_stay_where_only_those_above_are_asked_for() {
        let mut room = Room::default();
        let mut stack = room.stack();
        (0..3).for_each(|value| stack.push_if(true, Child::node(value), value));
        let mut above = |n| stack.pop_above(n).map(|(_, value)| value);
        assert_eq!(
            [above(2), above(2), above(1), above(0), above(0)],
            [Some(2), None, Some(1), Some(0), None]
        );
    }
}
