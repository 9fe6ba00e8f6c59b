//! Which medium a ray is in.

/// The closed shapes that a ray is inside of, in the order in which it entered them.
///
/// Each entry names the placement and the medium that fills it. Overlapping shapes: the last one
/// entered counts. A ray that has entered more than eight at once forgets the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MediumStack {
    entries: [(u32, Option<u32>); Self::DEPTH],
    len: u8,
}

impl MediumStack {
    const DEPTH: usize = 8;

    /// Enters a placement that is filled with `interior`.
    pub fn enter(&mut self, placement: u32, interior: Option<u32>) {
        if self.len as usize == Self::DEPTH {
            self.entries.copy_within(1.., 0);
            self.len -= 1;
        }
        self.entries[self.len as usize] = (placement, interior);
        self.len += 1;
    }

    /// Leaves a placement; nothing happens if it was never entered.
    pub fn leave(&mut self, placement: u32) {
        let entries = &self.entries[..self.len as usize];
        if let Some(at) = entries.iter().rposition(|(inside, _)| *inside == placement) {
            self.entries.copy_within(at + 1.., at);
            self.len -= 1;
        }
    }

    /// Whether it is inside no shape.
    pub fn is_outside(&self) -> bool {
        self.len == 0
    }

    /// The medium around the ray; `outside` where it is in no shape.
    pub fn current(&self, outside: Option<u32>) -> Option<u32> {
        match self.len {
            0 => outside,
            n => self.entries[n as usize - 1].1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlapping_shapes_leave_in_any_order() {
        let mut stack = MediumStack::default();
        stack.enter(1, Some(10));
        stack.enter(2, None);
        assert_eq!(stack.current(Some(0)), None);
        stack.leave(1);
        assert_eq!(stack.current(Some(0)), None);
        stack.leave(2);
        stack.leave(2);
        assert_eq!(stack.current(Some(0)), Some(0));
        assert!(stack.is_outside());
    }

    #[test]
    fn the_ninth_entry_forgets_the_first() {
        let mut stack = MediumStack::default();
        for i in 0..9 {
            stack.enter(i, Some(i));
        }
        assert_eq!(stack.current(None), Some(8));
        for i in (1..9).rev() {
            stack.leave(i);
        }
        assert_eq!(stack.current(Some(99)), Some(99));
    }
}
