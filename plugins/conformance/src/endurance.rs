//! Making and dropping objects leaves nothing behind.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use luxel_core::files::{FileError, Files};
use luxel_core::object::ColorMode;

use crate::report::Judge;
use crate::subject::Subject;

/// How much memory the process holds, in bytes; `None` where that cannot be told.
pub type Memory = fn() -> Option<u64>;

/// The check.
const CHECK: &str = "created and dropped 10^4 times";

/// Objects that are made between two looks.
const TIMES: u32 = 10_000;

/// What pools and tables of the system take once they have.
const WARM_UP: u32 = 1_000;

/// Bytes for each object that are no leak: the least block that can be asked for takes 16 or more.
const FORGIVEN: u64 = 8;

/// Looks; memory that grows each time is a leak, and once is a pool.
const LOOKS: usize = 3;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    let Some(memory) = subject.options.memory else { return };
    let Some(set) = subject.sets.first() else { return };
    let files = Once { files: subject.bench.files(), read: Mutex::default() };
    let make = |times: u32| {
        for _ in 0..times {
            // It could be made before.
            drop(subject.bench.build_of(&files, &subject.class, &set.given, ColorMode::Rgb));
        }
    };
    make(WARM_UP);
    leaves_nothing(memory, &mut || make(TIMES), judge);
}

/// What a file held.
type Bytes = Result<Arc<[u8]>, FileError>;

/// Reads each file once: the suite's own files remember every time that they are asked.
struct Once<'a> {
    files: &'a dyn Files,
    read: Mutex<BTreeMap<PathBuf, Bytes>>,
}

impl Files for Once<'_> {
    fn read(&self, path: &Path) -> Bytes {
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.entry(path.to_path_buf()).or_insert_with(|| self.files.read(path)).clone()
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        self.files.canonical(path)
    }
}

fn leaves_nothing(memory: Memory, make: &mut dyn FnMut(), judge: &mut Judge) {
    let mut least = u64::MAX;
    for _ in 0..LOOKS {
        let Some(before) = memory() else { return untold(judge) };
        make();
        let Some(after) = memory() else { return untold(judge) };
        least = least.min(after.saturating_sub(before));
        if least <= FORGIVEN * u64::from(TIMES) {
            break;
        }
    }
    let holds = least <= FORGIVEN * u64::from(TIMES);
    // What the allocator keeps differs from run to run; that it is little does not.
    let of_each = if holds { 0 } else { least / u64::from(TIMES) };
    judge.holds(CHECK, holds, || format!("{of_each} bytes stay of each object"));
}

fn untold(judge: &mut Judge) {
    judge.skip(CHECK, "this system does not tell how much memory a process holds");
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::reference::CLASSES;

    thread_local!(static HELD: Cell<u64> = const { Cell::new(1 << 30) });

    fn verdict(memory: Memory, of_each: &[u64]) -> String {
        let mut judge = Judge::new(&CLASSES[0]);
        let mut of_each = of_each.iter();
        let mut make = || {
            let more = of_each.next().expect("no more looks than that") * u64::from(TIMES);
            HELD.set(HELD.get() + more);
        };
        leaves_nothing(memory, &mut make, &mut judge);
        let report = crate::Report::of(vec![judge]);
        format!("{:?} {}", report.rows[0].verdict, report.rows[0].detail)
    }

    #[test]
    fn only_memory_that_grows_each_time_is_a_leak() {
        let held: Memory = || Some(HELD.get());
        assert_eq!(verdict(held, &[0]), "Pass 0 bytes stay of each object");
        assert_eq!(verdict(held, &[500, 3]), "Pass 0 bytes stay of each object");
        assert_eq!(verdict(held, &[48, 32, 40]), "Fail 32 bytes stay of each object");
        assert!(verdict(|| None, &[]).starts_with("Skip"));
    }
}
