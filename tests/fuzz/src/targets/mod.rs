//! What must hold of any bytes. Each target judges one input, says whether it was of use, and panics
//! if something else holds. The fuzzer and the project's tests run the same code.

pub(crate) mod bytes;
mod cost;
pub(crate) mod damage;
pub(crate) mod evaluate;
pub(crate) mod film;
pub(crate) mod import;
pub(crate) mod nested;
pub(crate) mod readers;
mod told;

use std::path::Path;
use std::sync::OnceLock;

use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_lang::{Budgets, Loaded, Settings};

/// Every class that a scene may name.
pub(crate) fn registry() -> &'static Registry {
    static REGISTRY: OnceLock<Registry> = OnceLock::new();
    REGISTRY.get_or_init(|| {
        let mut registry = Registry::new();
        for classes in luxel_builtin::CLASSES {
            registry.add("builtin", classes).expect("each class stands once");
        }
        registry
    })
}

/// A scene and the files beside it: a line `// file: name` begins another.
fn files(bytes: &[u8]) -> MemoryFiles {
    const MARK: &[u8] = b"// file: ";
    let (mut files, mut name, mut held) = (MemoryFiles::default(), "a.scene".to_owned(), vec![]);
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        if let Some(next) = line.strip_prefix(MARK) {
            files = files.with(name, std::mem::take(&mut held));
            name = String::from_utf8_lossy(next).trim().to_owned();
        } else {
            held.extend_from_slice(line);
        }
    }
    files.with(name, held)
}

fn load(bytes: &[u8], budgets: Budgets) -> Loaded {
    let settings = Settings { budgets, ..Settings::default() };
    luxel_lang::load(Path::new("a.scene"), &files(bytes), registry(), &settings)
}

/// Runs on a thread with so many bytes of stack.
fn on_stack<T: Send>(bytes: usize, run: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(bytes).spawn_scoped(scope, run);
        let done = thread.expect("a thread can be made").join();
        done.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
