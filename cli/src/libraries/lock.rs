//! `plugins.lock`: the libraries whose code the user lets run, by the hash of their bytes.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::config;
use crate::exit::{Exit, Failure};
use crate::output::{Draft, unwritable};

/// What is trusted.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Lock {
    /// One entry per file.
    #[serde(default, rename = "plugin")]
    pub(crate) entries: Vec<Entry>,
}

/// A library that is trusted. Its stem and hash decide; the rest is for people.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Entry {
    /// Its file's name without `lib` and extension.
    pub(crate) stem: String,
    /// The name it gives itself.
    pub(crate) name: String,
    /// Its version.
    pub(crate) version: String,
    /// The version of the boundary that it was built for.
    pub(crate) abi: String,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub(crate) sha256: String,
    /// Where it was when it was trusted.
    pub(crate) path: PathBuf,
}

impl Lock {
    /// The lock's file in a configuration folder.
    pub(crate) fn file(folder: &Path) -> PathBuf {
        folder.join("plugins.lock")
    }

    /// The lock of a configuration folder; nothing is trusted where there is none.
    ///
    /// # Errors
    /// A file that cannot be understood, with the line: nothing is opened on a guess.
    pub(crate) fn read(folder: Option<&Path>) -> Result<Self, Failure> {
        let Some(folder) = folder else { return Ok(Self::default()) };
        Ok(config::read(&Self::file(folder))?.unwrap_or_default())
    }

    /// Whether these bytes under this stem are trusted.
    pub(crate) fn trusts(&self, stem: &str, sha256: &str) -> bool {
        self.of_stem(stem).any(|entry| entry.sha256.eq_ignore_ascii_case(sha256))
    }

    /// The entries of a stem.
    pub(crate) fn of_stem(&self, stem: &str) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.stem == stem)
    }

    /// Adds an entry in place of an older one of the same file, which it returns.
    pub(crate) fn put(&mut self, entry: Entry) -> Option<Entry> {
        let old = self.entries.iter_mut().find(|old| old.path == entry.path);
        if let Some(old) = old {
            return Some(std::mem::replace(old, entry));
        }
        self.entries.push(entry);
        None
    }

    /// Writes the lock into a configuration folder, whole or not at all, for the user alone.
    ///
    /// # Errors
    /// The system's, with the file.
    pub(crate) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let place = Self::file(folder);
        let text = toml::to_string(self).map_err(|error| {
            Failure::new(Exit::Input, format!("`{}` cannot be written: {error}", place.display()))
        })?;
        let written = private_folder(folder).and_then(|()| {
            let mut draft = Draft::begin(&place)?;
            for_the_user_alone(&draft.file)?;
            draft.file.write_all(HEAD.as_bytes())?;
            draft.file.write_all(text.as_bytes())?;
            draft.finish()
        });
        written.map_err(|error| unwritable(&place, &error))
    }
}

const HEAD: &str = "\
# Plugin libraries whose code may run as you. Written by `luxel plugin trust` and `distrust`.

";

fn private_folder(folder: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

#[cfg(unix)]
fn for_the_user_alone(file: &fs::File) -> io::Result<()> {
    file.set_permissions(std::os::unix::fs::PermissionsExt::from_mode(0o600))
}

/// The folder of the user's settings is private already.
#[cfg(not(unix))]
fn for_the_user_alone(_: &fs::File) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Folder;

    pub(super) fn entry(stem: &str, sha256: &str) -> Entry {
        let [name, version, abi] = [stem, "1.2.3", "1.0"].map(str::to_owned);
        let path = format!("/plugins/lib{stem}.so").into();
        Entry { stem: stem.into(), name, version, abi, sha256: sha256.into(), path }
    }

    #[test]
    fn what_was_written_is_read_and_only_these_bytes_are_trusted() {
        let folder = Folder::new("lock");
        let place = folder.path("made/here");
        let mut lock = Lock::default();
        assert_eq!(lock.put(entry("gyroid", "ab")), None);
        assert_eq!(lock.put(entry("velvet", "cd")), None);
        let old = lock.put(entry("gyroid", "ef"));
        assert_eq!(old, Some(entry("gyroid", "ab")));
        lock.write(&place).unwrap();
        let read = Lock::read(Some(&place)).unwrap();
        assert_eq!(read.entries, lock.entries);
        assert!(read.trusts("gyroid", "EF") && read.trusts("velvet", "cd"));
        assert!(!read.trusts("gyroid", "ab") && !read.trusts("gyroid", "cd"));
        assert!(!Lock::read(Some(&folder.path("none"))).unwrap().trusts("gyroid", "ef"));
    }

    #[cfg(unix)]
    #[test]
    fn the_lock_is_for_the_user_alone() {
        use std::os::unix::fs::PermissionsExt;
        let folder = Folder::new("lock-mode");
        Lock::default().write(&folder.path("own")).unwrap();
        let mode = |path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(Lock::file(&folder.path("own"))), 0o600);
        assert_eq!(mode(folder.path("own")), 0o700);
    }

    #[test]
    fn a_damaged_lock_is_told_and_trusts_nothing() {
        let folder = Folder::new("lock-damaged");
        folder.write("plugins.lock", b"[[plugin]]\nstem = \"a\"\nsha = \"b\"\n");
        let told = Lock::read(Some(&folder.path(""))).unwrap_err().message;
        assert!(told.contains("plugins.lock") && told.contains("line 3"), "{told}");
    }
}
