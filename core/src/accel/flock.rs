//! Rays side by side through the trees of meshes.
//!
//! First all that are at a node look at it, then all that are at a leaf look at a block of it. In either
//! phase no branch depends on what a ray finds but for hits, so the processor works at several rays at
//! once, and while one waits for memory the others go on.
//!
//! Source: none as a whole; Wald, Slusallek, Benthin and Wagner 2001 trace rays side by side in step, of
//! which those that are done idle. Here each is replaced at once.

use super::mesh::MeshWalk;
use super::node::Child;
use super::processor::Processor;
use super::stack::Stack;

/// Walks side by side, each in a slot of its own.
#[derive(Debug)]
pub struct Flock<'t, 'r> {
    slots: Vec<(MeshWalk<'t>, Stack<'r, f32>)>,
    at_nodes: Slots,
    at_leaves: Slots,
    /// Those that will be over in the next round.
    ending: Slots,
    over: Slots,
}

impl<'t, 'r> Flock<'t, 'r> {
    /// Slots at most.
    pub const MOST: usize = 32;

    /// Without a walk.
    pub fn new() -> Self {
        let none = || Slots { numbers: [0; Self::MOST], n: 0 };
        Self {
            slots: Vec::with_capacity(Self::MOST),
            at_nodes: none(),
            at_leaves: none(),
            ending: none(),
            over: none(),
        }
    }

    /// Starts a walk in the next slot: that of number 0 comes first. The stack is the slot's.
    ///
    /// # Panics
    /// With more than [`Flock::MOST`] slots.
    pub fn add(&mut self, walk: MeshWalk<'t>, stack: Stack<'r, f32>) {
        let slot = self.slots.len();
        assert!(slot < Self::MOST, "callers have no more stacks than that");
        self.slots.push((walk, stack));
        self.start(slot);
    }

    /// Starts a walk in the slot of one that is over, which was begun in the same way.
    ///
    /// # Panics
    /// Where there is no such slot.
    #[inline(always)]
    pub fn replace(&mut self, slot: usize, walk: MeshWalk<'t>) {
        self.slots[slot].0 = walk;
        self.start(slot);
    }

    #[inline(always)]
    fn start(&mut self, slot: usize) {
        let (walk, stack) = &mut self.slots[slot];
        stack.clear();
        stack.push_if(true, Child::OVER, f32::NEG_INFINITY);
        walk.prefetch();
        self.at_nodes.add_if(true, slot);
    }

    /// Takes each walk one or two steps on; false where none is on its way. `ANY` as they began. `ask`
    /// is given each triangle that is the nearest so far, with its slot, to ask for the memory of what
    /// will be wanted of it; and once more, with `true`, a round before its walk is given as over. Where
    /// any hit is enough nothing is wanted.
    #[inline(always)]
    pub fn advance<const ANY: bool>(
        &mut self,
        processor: Processor,
        ask: impl Fn(usize, u32, bool),
    ) -> bool {
        let Self { slots, at_nodes, at_leaves, ending, over } = self;
        let is_on = at_nodes.n + at_leaves.n + ending.n > 0;
        for i in 0..ending.take() {
            over.add_if(true, ending.at(i));
        }
        for i in 0..at_nodes.take() {
            let slot = at_nodes.at(i);
            let (walk, stack) = &mut slots[slot];
            walk.at_node(processor, stack);
            at_nodes.add_if(!walk.current.is_leaf(), slot);
            at_leaves.add_if(walk.current.is_leaf(), slot);
        }
        for i in 0..at_leaves.take() {
            let slot = at_leaves.at(i);
            let (walk, stack) = &mut slots[slot];
            let nearer = |triangle| ask(slot, triangle, false);
            if walk.current == Child::OVER || walk.at_block::<ANY>(stack, nearer) {
                if !ANY && let Some(triangle) = walk.nearest() {
                    ask(slot, triangle, true);
                }
                ending.add_if(true, slot);
                continue;
            }
            at_nodes.add_if(!walk.current.is_leaf(), slot);
            at_leaves.add_if(walk.current.is_leaf(), slot);
        }
        is_on
    }

    /// The number of a slot whose walk is over, and the walk; each is given once.
    #[inline(always)]
    pub fn landed(&mut self) -> Option<(usize, &MeshWalk<'t>)> {
        self.over.n = self.over.n.checked_sub(1)?;
        let slot = self.over.at(self.over.n);
        Some((slot, &self.slots[slot].0))
    }
}

impl Default for Flock<'_, '_> {
    fn default() -> Self {
        Self::new()
    }
}

/// Numbers of slots, none twice.
#[derive(Debug)]
struct Slots {
    numbers: [u8; Flock::MOST],
    n: usize,
}

impl Slots {
    /// Writes a number and keeps it if it is to be: without a branch. Numbers that were taken and are
    /// not read yet stay, as no more are kept than were read.
    #[inline(always)]
    fn add_if(&mut self, kept: bool, slot: usize) {
        #[expect(clippy::cast_possible_truncation, reason = "slots are few")]
        let number = slot as u8;
        self.numbers[self.n % Flock::MOST] = number;
        self.n += usize::from(kept);
    }

    /// How many there are, to be read and kept anew.
    #[inline(always)]
    fn take(&mut self) -> usize {
        std::mem::take(&mut self.n)
    }

    #[inline(always)]
    fn at(&self, i: usize) -> usize {
        usize::from(self.numbers[i % Flock::MOST])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::soup::{Rng, soup};
    use crate::accel::{Direction, MeshBvh, Precision, Query, Watch};

    /// Holds what many rays meet side by side against what each meets alone, when a quarter of the way
    /// is done.
    fn check(tree: &MeshBvh, rng: &mut Rng) {
        let rays: Vec<_> = (0..20 * Flock::MOST)
            .filter_map(|_| {
                let (o, d) = (rng.point() * 2.0, rng.point());
                Some((o.as_dvec3(), Direction::new(d.as_dvec3())?))
            })
            .collect();
        for precision in Precision::ALL {
            let query = |(o, direction)| Query {
                o,
                direction,
                t_max: f64::INFINITY,
                skip: None,
                precision,
                share: 0.25,
            };
            let queries: Vec<_> = rays.iter().map(|(o, d)| query((*o, d))).collect();
            for processor in Processor::all() {
                let name = processor.name();
                let alone = queries.iter().map(|query| tree.intersect(processor, query));
                let alone: Vec<_> = alone.collect();
                assert!(alone.iter().filter(|found| found.0.is_some()).count() > 2 * Flock::MOST);
                let nearest = tree.flocked::<false>(processor, &queries);
                assert_eq!(nearest, alone, "{precision:?}, {name}");
                let any = tree.flocked::<true>(processor, &queries);
                let is_hit = |found: &(_, u32)| Option::is_some(&found.0);
                assert!(
                    any.iter().map(is_hit).eq(alone.iter().map(is_hit)),
                    "{precision:?}, {name}"
                );
            }
        }
    }

    #[test]
    fn many_rays_meet_what_each_meets_alone() {
        let mut rng = Rng(51);
        let (points, indices) = soup(2000, 0.2, &mut rng);
        check(&MeshBvh::build(&points, &indices).unwrap(), &mut rng);
    }

    #[test]
    fn many_rays_meet_moving_triangles_as_each_meets_them_alone() {
        let mut rng = Rng(52);
        let (points, indices) = soup(2000, 0.2, &mut rng);
        let last: Vec<_> = points.iter().map(|p| *p + rng.point() * 0.1).collect();
        let moving = (points.as_slice(), last.as_slice());
        let tree = MeshBvh::build_moving(moving, &indices, [0.0, 1.0], &Watch::default()).unwrap();
        check(&tree, &mut rng);
    }
}
