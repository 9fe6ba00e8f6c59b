//! What a walk through a tree has still to visit.
#![expect(unsafe_code, reason = "room that is not cleared for each ray")]

use std::mem::MaybeUninit;

/// One more than a tree may ask for: builders bound the depth.
const ROOM: usize = 257;

/// Room for a stack of small values. It is not cleared when it is made: a ray would pay for that more
/// than for a small tree.
pub(super) struct Room<T: Copy>([MaybeUninit<T>; ROOM]);

/// A stack in its room, apart from it so that its length stays in a register.
pub(super) struct Stack<'a, T: Copy> {
    room: &'a mut [MaybeUninit<T>; ROOM],
    len: usize,
}

impl<T: Copy> Room<T> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; ROOM])
    }

    /// An empty stack for at most `need` entries at once.
    ///
    /// # Panics
    /// For a tree that needs more than there is: builders bound that.
    #[inline(always)]
    pub(super) fn stack(&mut self, need: usize) -> Stack<'_, T> {
        assert!(need < ROOM, "builders bound the depth of trees");
        Stack { room: &mut self.0, len: 0 }
    }
}

impl<T: Copy> Stack<'_, T> {
    /// Writes a value and keeps it if `kept`: without a branch, which could not be foreseen.
    ///
    /// # Panics
    /// Beyond the room.
    #[inline(always)]
    pub(super) fn push_if(&mut self, kept: bool, value: T) {
        self.room[self.len].write(value);
        self.len += usize::from(kept);
    }

    /// The value that was kept last.
    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<T> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: `push_if` wrote this entry before it counted it.
        Some(unsafe { self.room[self.len].assume_init() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back_last_first() {
        let mut room = Room::new();
        let mut stack = room.stack(3);
        for (kept, value) in [(true, 1), (false, 2), (true, 3), (false, 4)] {
            stack.push_if(kept, value);
        }
        assert_eq!([stack.pop(), stack.pop(), stack.pop()], [Some(3), Some(1), None]);
    }
}
