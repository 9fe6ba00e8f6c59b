//! C files, compiled as a person would do it.
#![expect(clippy::disallowed_methods, reason = "tests write sources and ask for the compiler")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicU32, Ordering};

use luxel_core::registry::dynamic::{Library, LoadError};

use crate::disk::root;

/// A folder of one test's own, removed in the end.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let n = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("luxel-c-{}-{n}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(super) fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// A library's path, called as the system wants.
    pub(super) fn library(&self, stem: &str) -> PathBuf {
        let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
        self.path(&format!("{prefix}{stem}{suffix}"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// The compiler's answer to one command: `cc`, or what `CC` names, with every warning an error.
fn compile(flags: &[&str], source: &Path, out: &Path) -> Output {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let mut command = Command::new(&compiler);
    command.args(["-std=c11", "-Wall", "-Wextra", "-pedantic", "-Werror"]).args(flags);
    command.arg("-I").arg(root().join("plugins/sdk/include"));
    command.arg("-o").arg(out).arg(source).arg("-lm");
    command.output().unwrap_or_else(|error| panic!("{compiler} does not run: {error}"))
}

fn succeeded(done: &Output, what: &str) {
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{what}: {}\n{said}", done.status);
}

/// Makes a dynamic library of a source.
pub(super) fn library(source: &Path, flags: &[&str], out: &Path) {
    let flags = [&["-shared", "-fPIC"], flags].concat();
    succeeded(&compile(&flags, source, out), "the library does not compile");
}

/// Makes a program of a source, with the sanitizers in it, and runs it.
pub(super) fn run_sanitized(source: &Path, out: &Path) {
    let sanitized = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    let done = compile(&sanitized, source, out);
    succeeded(&done, "the compiler has no sanitizers, or the program does not compile");
    succeeded(&Command::new(out).output().unwrap(), "the program found a fault");
}

/// The library of a source, compiled and opened.
pub(super) fn opened(
    folder: &Folder,
    source: &Path,
    stem: &str,
    flags: &[&str],
) -> Result<Library, LoadError> {
    let out = folder.library(stem);
    library(source, flags, &out);
    Library::open(&out, stem, 0)
}
