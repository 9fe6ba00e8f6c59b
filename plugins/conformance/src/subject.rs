//! The class under judgement with the objects that were made of it.

use luxel_core::object::Resolved;
use luxel_sdk::abi::Class;
use luxel_sdk::sampling::Rng;

use crate::Options;
use crate::report::Judge;
use crate::sweep::{Bench, Set};
use crate::values::Level;

/// A class and its parameter sets.
pub(crate) struct Subject<'a> {
    pub(crate) bench: &'a Bench,
    pub(crate) class: Class,
    pub(crate) sets: Vec<Set>,
    pub(crate) options: Options,
}

/// Threads that ask one object at once.
const THREADS: usize = 4;

impl Subject<'_> {
    /// The sets for which all checks are made, each with its own random numbers.
    pub(crate) fn usual(&self) -> impl Iterator<Item = (&Set, Rng)> {
        self.all().filter(|(set, _)| set.level == Level::Usual)
    }

    /// Every set, each with its own random numbers.
    pub(crate) fn all(&self) -> impl Iterator<Item = (&Set, Rng)> {
        let numbered = self.sets.iter().zip(0u64..);
        numbered.map(|(set, i)| (set, Rng::new(self.options.seed.wrapping_add(i))))
    }

    /// Asks the first objects on several threads at once: the same bits for everyone.
    pub(crate) fn concurrent(
        &self,
        judge: &mut Judge,
        probe: impl Fn(Resolved<'_>) -> Vec<u32> + Sync,
    ) {
        for set in self.sets.iter().filter(|set| set.level == Level::Usual).take(3) {
            let alone = set.ask(&probe);
            let probe = &probe;
            let same = std::thread::scope(|scope| {
                let ask = || set.ask(probe);
                let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(ask)).collect();
                threads.into_iter().all(|thread| thread.join().is_ok_and(|bits| bits == alone))
            });
            judge.holds("same bits on all threads", same, || set.label.clone());
        }
    }
}
