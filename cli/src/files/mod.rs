//! Files on disk, as scenes may see them.

mod known;
mod stamp;

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use luxel_core::diag::Sources;
use luxel_core::files::{FileError, Files, Marks, Whole, hash_whole, normalise, read_whole};
use luxel_core::scene::Hash;

pub(crate) use known::Known;
pub(crate) use stamp::{Identity, Stamp, identity};

/// Bytes of one file, at most: far above any mesh, below what would take a machine down.
const MAX_BYTES: u64 = 4 << 30;

/// Hash of a file's bytes, or of the names of the libraries in a folder; `None` when it could not be
/// read.
pub(crate) type Seen = Option<blake3::Hash>;

/// Paths with what was last seen there.
pub(crate) type Watched = BTreeMap<PathBuf, Seen>;

/// What has been asked for so far, as others may see it.
pub(crate) type Asked = Arc<Mutex<Watched>>;

/// Reads below the scene's folder and the folders that were allowed, and remembers what was asked.
#[derive(Debug)]
pub(crate) struct DiskFiles {
    allowed: Vec<PathBuf>,
    asked: Asked,
    /// Of what was read, the hash of its bytes: in one load a file is one thing.
    read: Mutex<BTreeMap<PathBuf, Hash>>,
    known: Known,
    /// Set once nothing more is to be read.
    stop: Arc<AtomicBool>,
}

impl DiskFiles {
    /// Files for one scene: its own folder, those below `allow`, and the scene itself, which may be a link
    /// to another folder, may be read.
    pub(crate) fn new(scene: &Path, allow: &[PathBuf]) -> Self {
        let own = match scene.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let allowed = [own, scene].into_iter().chain(allow.iter().map(PathBuf::as_path));
        // A folder that does not exist holds nothing that could be allowed; a file allows itself alone.
        let allowed = allowed.filter_map(|folder| fs::canonicalize(folder).ok()).collect();
        let (asked, read, known, stop) = Default::default();
        Self { allowed, asked, read, known, stop }
    }

    /// The same, that read nothing more once this is set.
    pub(crate) fn until(self, stop: Arc<AtomicBool>) -> Self {
        Self { stop, ..self }
    }

    /// The same, for whoever watches files and knows what is in them.
    pub(crate) fn knowing(self, known: &Known) -> Self {
        Self { known: known.clone(), ..self }
    }

    /// The same, which puts the paths that are asked for here, and takes out what is there.
    pub(crate) fn telling(self, asked: &Asked) -> Self {
        lock(asked).clear();
        Self { asked: asked.clone(), ..self }
    }

    /// The paths that are asked for, now and later.
    pub(crate) fn shared(&self) -> &Asked {
        &self.asked
    }

    /// Every path that was asked for, with the hash of what was found there.
    pub(crate) fn asked(&self) -> Watched {
        lock(&self.asked).clone()
    }

    /// One hash over the contents of all files that were read.
    pub(crate) fn hash(&self) -> blake3::Hash {
        let mut hasher = blake3::Hasher::new();
        for seen in self.asked().values().flatten() {
            hasher.update(seen.as_bytes());
        }
        hasher.finalize()
    }

    /// The same over those that are not among some texts.
    pub(crate) fn hash_besides(&self, texts: &Sources) -> blake3::Hash {
        let texts: Vec<_> = texts.texts().map(|text| blake3::hash(text.as_bytes())).collect();
        let mut hasher = blake3::Hasher::new();
        for seen in self.asked().values().flatten().filter(|seen| !texts.contains(seen)) {
            hasher.update(seen.as_bytes());
        }
        hasher.finalize()
    }

    /// Where a file is, if it may be read.
    fn place(&self, path: &Path) -> Result<PathBuf, FileError> {
        let place = fs::canonicalize(path).map_err(|error| FileError::from(&error))?;
        let allowed = self.allowed.iter().any(|folder| place.starts_with(folder));
        if allowed { Ok(place) } else { Err(FileError::Outside) }
    }

    /// Whether a file is there that may not be read.
    pub(crate) fn forbids(&self, path: &Path) -> bool {
        self.place(path) == Err(FileError::Outside)
    }

    fn fetch(&self, path: &Path) -> Result<Whole, FileError> {
        let (file, length) = open_regular(&self.place(path)?, MAX_BYTES)?;
        read_whole(file, length, MAX_BYTES, &self.stop)
    }

    fn note(&self, path: &Path, seen: Seen) {
        // What was there first counts: who saw another is told of a change.
        lock(&self.asked).entry(path.to_path_buf()).or_insert(seen);
    }
}

impl Files for DiskFiles {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        match self.fetch(path) {
            Ok((bytes, hash)) => {
                lock(&self.read).insert(path.to_path_buf(), hash);
                self.note(path, Some(hash.into()));
                Ok(bytes)
            }
            // It is not known what is there.
            Err(FileError::Unwanted) => Err(FileError::Unwanted),
            // A folder, or a file that may not be read, is no news if it stays as it is.
            Err(error) => {
                let seen = seen(path, &self.stop).filter(|_| self.fetch(path).is_err());
                self.note(path, seen);
                Err(error)
            }
        }
    }

    fn hash(&self, path: &Path) -> Option<Hash> {
        if let Some(hash) = lock(&self.read).get(path) {
            return Some(*hash);
        }
        let known = self.known.seen(path).flatten().filter(|_| self.place(path).is_ok());
        if known.is_some() {
            self.note(path, known);
            return known.map(Hash::from);
        }
        self.read(path).ok()?;
        lock(&self.read).get(path).copied()
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        fs::canonicalize(path).unwrap_or_else(|_| normalise(path))
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is there now.
pub(crate) fn look(path: &Path) -> Seen {
    seen(path, &AtomicBool::new(false))
}

/// The same, unless it is not wanted any more.
fn seen(path: &Path, stop: &AtomicBool) -> Seen {
    marked(path, stop).0
}

/// What is there now, with what tells soon that it has changed.
pub(crate) fn look_and_mark(path: &Path) -> (Seen, Marks) {
    marked(path, &AtomicBool::new(false))
}

fn marked(path: &Path, stop: &AtomicBool) -> (Seen, Marks) {
    if path.is_dir() {
        let entries = fs::read_dir(path).ok();
        let names = entries.map(|entries| names_of_libraries(entries.flatten()));
        return (names, Marks::default());
    }
    let file = open_regular(path, MAX_BYTES);
    let found = file.and_then(|(file, length)| hash_whole(file, length, MAX_BYTES, stop));
    found.map_or_else(|_| (None, Marks::default()), |(hash, marks)| (Some(hash.into()), marks))
}

/// Whether something else than what has these marks is there now for sure.
pub(crate) fn has_changed(path: &Path, marks: &Marks) -> bool {
    let differ = |file| marks.differ(file, MAX_BYTES, &AtomicBool::new(false));
    let file = open_regular(path, MAX_BYTES).map(|(file, _)| file);
    file.and_then(differ).unwrap_or(false)
}

/// Other files come and go in a folder of libraries and concern nobody.
fn names_of_libraries(entries: impl Iterator<Item = fs::DirEntry>) -> blake3::Hash {
    let mut names: Vec<_> = entries.map(|entry| entry.file_name().into_encoded_bytes()).collect();
    names.retain(|name| name.ends_with(std::env::consts::DLL_SUFFIX.as_bytes()));
    names.sort_unstable();
    // No file that is empty is a folder of none.
    let names = names.iter().flat_map(|name| name.iter().copied().chain([0]));
    blake3::hash(&b"folder\0".iter().copied().chain(names).collect::<Vec<u8>>())
}

/// The bytes of a regular file.
pub(crate) fn read_regular(path: &Path) -> Result<Vec<u8>, FileError> {
    read_limited(path, MAX_BYTES)
}

/// The bytes of a regular file, if it has at most so many.
pub(crate) fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let (file, length) = open_regular(path, limit)?;
    let mut bytes = Vec::with_capacity(length);
    file.take(limit + 1).read_to_end(&mut bytes).map_err(|error| FileError::from(&error))?;
    if bytes.len() as u64 > limit { Err(FileError::TooLarge(limit)) } else { Ok(bytes) }
}

/// A regular file to be read and its length, if it has at most so many bytes; a pipe or a device would
/// wait for ever or never end.
pub(crate) fn open_regular(path: &Path, limit: u64) -> Result<(fs::File, usize), FileError> {
    let about = fs::metadata(path).map_err(|error| FileError::from(&error))?;
    if !about.is_file() {
        let what = if about.is_dir() { "it is a folder" } else { "it is not a regular file" };
        return Err(FileError::Unreadable(what.into()));
    }
    if about.len() > limit {
        return Err(FileError::TooLarge(limit));
    }
    #[expect(clippy::disallowed_methods, reason = "the one place where files are opened")]
    let file = fs::File::open(path).map_err(|error| FileError::from(&error))?;
    let length = usize::try_from(about.len()).map_err(|_| FileError::TooLarge(limit))?;
    Ok((file, length))
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::sync::atomic::Ordering;

    use super::*;
    use crate::testing::Folder;

    #[test]
    fn only_the_scenes_folder_and_allowed_ones_are_read() {
        let folder = Folder::new("files");
        folder.write("scenes/a.scene", b"scene 1");
        folder.write("scenes/sub/mesh.obj", b"v");
        folder.write("other/secret", b"x");
        let scene = folder.path("scenes/a.scene");
        let files = DiskFiles::new(&scene, &[]);
        assert_eq!(&*files.read(&scene).unwrap(), b"scene 1");
        assert_eq!(&*files.read(&folder.path("scenes/sub/mesh.obj")).unwrap(), b"v");
        let secret = folder.path("scenes/../other/secret");
        assert_eq!(files.read(&secret), Err(FileError::Outside));
        let allowed = DiskFiles::new(&scene, &[folder.path("other")]);
        assert_eq!(&*allowed.read(&secret).unwrap(), b"x");
        let missing = folder.path("scenes/none.obj");
        assert_eq!(files.read(&missing), Err(FileError::NotFound));
        assert_eq!(files.asked().get(&missing), Some(&None));
        assert_eq!(files.asked().len(), 4);
        assert!(files.read(&folder.path("scenes/sub")).is_err());
        assert!(files.asked().iter().all(|(path, seen)| look(path) == *seen), "nothing is news");
    }

    #[test]
    fn an_empty_file_is_no_folder_of_nothing() {
        let folder = Folder::new("empty-or-folder");
        folder.write("empty", b"");
        folder.write("folder/other", b"");
        folder.write(&format!("library/a{}", std::env::consts::DLL_SUFFIX), b"");
        let found = ["empty", "folder", "library", "none"].map(|name| look(&folder.path(name)));
        assert_eq!(HashSet::from(found).len(), 4);
    }

    #[test]
    fn what_is_not_wanted_any_more_is_neither_read_nor_noted() {
        let folder = Folder::new("unwanted-files");
        folder.write("a.ply", b"ply");
        let (path, none) = (folder.path("a.ply"), folder.path("none"));
        let stop = Arc::new(AtomicBool::new(false));
        let files = DiskFiles::new(&path, &[]).until(stop.clone());
        stop.store(true, Ordering::Relaxed);
        assert_eq!(files.read(&path), Err(FileError::Unwanted));
        assert_eq!(Files::hash(&files, &path), None);
        assert_eq!(files.read(&none), Err(FileError::NotFound));
        assert_eq!(files.asked(), Watched::from([(none, None)]), "nobody knows what is there");
    }

    #[test]
    fn folders_and_devices_are_refused_and_not_waited_for() {
        let folder = Folder::new("devices");
        let refused = |path: &Path| matches!(read_regular(path), Err(FileError::Unreadable(_)));
        assert!(refused(&folder.path("")));
        assert!(!cfg!(unix) || refused(Path::new("/dev/zero")));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_leads_outside_is_refused() {
        let folder = Folder::new("links");
        folder.write("scenes/a.scene", b"scene 1");
        folder.write("secret", b"x");
        let link = folder.path("scenes/link");
        std::os::unix::fs::symlink(folder.path("secret"), &link).unwrap();
        let files = DiskFiles::new(&folder.path("scenes/a.scene"), &[]);
        assert_eq!(files.read(&link), Err(FileError::Outside));
    }
}
