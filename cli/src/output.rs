//! Where pictures go: two files that appear whole or not at all.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::{self, Write as _};
use std::path::{Component, Path, PathBuf};

use crate::exit::{Exit, Failure};
use crate::files::{DiskFiles, identity};

/// The two files of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Output {
    /// What was measured, in linear floats.
    pub(crate) exr: PathBuf,
    /// How it looks.
    pub(crate) png: PathBuf,
}

impl Output {
    /// From `-o`, else the film's `file`, else the scene's name in the current folder.
    ///
    /// # Errors
    /// A film's `file` that would leave the current folder: only the person at the keyboard may
    /// say that.
    pub(crate) fn choose(
        given: Option<&Path>,
        film: Option<&str>,
        scene: &Path,
    ) -> Result<Self, Failure> {
        let stem = match (given, film) {
            (Some(path), _) => path.to_path_buf(),
            (None, Some(name)) => {
                let path = PathBuf::from(name);
                let stays = |part| matches!(part, Component::Normal(_) | Component::CurDir);
                if !path.components().all(stays) {
                    let message = format!("the film's file `{name}` lies outside this folder");
                    return Err(
                        Failure::new(Exit::Input, message).help("give the place yourself: -o OUT")
                    );
                }
                path
            }
            (None, None) => scene.file_stem().unwrap_or(OsStr::new("luxel")).into(),
        };
        let known = |e: &OsStr| ["exr", "png"].iter().any(|k| e.eq_ignore_ascii_case(k));
        let stem = if stem.extension().is_some_and(known) { stem.with_extension("") } else { stem };
        let is_folder = stem.to_string_lossy().ends_with(std::path::is_separator);
        if is_folder || stem.file_name().is_none() {
            let message = format!("`{}` is not a file name", stem.display());
            return Err(Failure::new(Exit::Usage, message).help("as in -o picture"));
        }
        Ok(Self { exr: with_suffix(&stem, ".exr"), png: with_suffix(&stem, ".png") })
    }

    /// Refuses to write over a file that is read.
    ///
    /// # Errors
    /// If it is one of the two.
    pub(crate) fn keep(&self, read: &Path) -> Result<(), Failure> {
        let place = |path: &Path| fs::canonicalize(path).ok();
        let found = place(read);
        if found.is_some() && [&self.exr, &self.png].into_iter().any(|path| place(path) == found) {
            let message = format!("the output would take the place of `{}`", read.display());
            return Err(Failure::new(Exit::Usage, message).help("choose another name"));
        }
        Ok(())
    }

    /// Tells before the work begins whether the files can be written.
    ///
    /// # Errors
    /// What stands in the way, naming the file.
    pub(crate) fn check(&self, files: &DiskFiles) -> Result<(), Failure> {
        for path in [&self.exr, &self.png] {
            if let Ok(place) = fs::canonicalize(path) {
                let reads = |asked: &PathBuf| fs::canonicalize(asked).is_ok_and(|p| p == place);
                if files.asked().keys().any(reads) {
                    let message = format!("the scene reads `{}`, its own output", path.display());
                    return Err(Failure::new(Exit::Input, message).help("choose another: -o OUT"));
                }
            }
            Draft::begin(path).map_err(|error| unwritable(path, &error))?;
        }
        Ok(())
    }
}

/// The failure of a file that cannot be written.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Failure {
    Failure::new(Exit::Input, format!("cannot write `{}`: {error}", path.display()))
}

fn with_suffix(stem: &Path, suffix: &str) -> PathBuf {
    let mut name = stem.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// A file in the making, beside the one whose place it will take. Dropped before `finish`, it
/// leaves no trace.
#[derive(Debug)]
pub(crate) struct Draft {
    temporary: PathBuf,
    place: PathBuf,
    /// Where the bytes go.
    pub(crate) file: fs::File,
}

/// Puts a text in the place of a file: all of it or nothing, and with the file's permissions.
///
/// # Errors
/// What the disk says.
pub(crate) fn replace(file: &Path, text: &str) -> io::Result<()> {
    let mut draft = Draft::begin(file)?;
    draft.file.set_permissions(fs::metadata(file)?.permissions())?;
    draft.file.write_all(text.as_bytes())?;
    draft.finish()
}

/// So many drafts of one file may there be at a time, of this process or left by one of its number.
const MOST_DRAFTS: u32 = 8;

/// `.NAME.PROCESS.N.tmp`
fn temporary(place: &Path, n: u32) -> OsString {
    let mut name = OsString::from(".");
    name.push(place.file_name().unwrap_or_default());
    name.push(format!(".{}.{n}.tmp", std::process::id()));
    name
}

/// Whether some process would give a draft of the file `of` this name.
fn is_temporary(name: &OsStr, of: &OsStr) -> bool {
    let rest = name.as_encoded_bytes().strip_prefix(b".");
    let rest = rest.and_then(|rest| rest.strip_prefix(of.as_encoded_bytes()));
    let numbers = rest.and_then(|rest| rest.strip_prefix(b".")?.strip_suffix(b".tmp"));
    let is_number = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
    let parts: Vec<_> = numbers.unwrap_or_default().split(|byte| *byte == b'.').collect();
    parts.len() == 2 && parts.into_iter().all(is_number)
}

/// Where a file is written: through links, also to what is not there yet, so that what they point to is
/// replaced and not the link.
fn behind_links(path: &Path) -> PathBuf {
    const MOST: usize = 40;
    let mut place = path.to_path_buf();
    for _ in 0..MOST {
        let Ok(to) = fs::read_link(&place) else { break };
        place = place.parent().unwrap_or(Path::new("")).join(to);
    }
    fs::canonicalize(&place).unwrap_or(place)
}

/// Removes what processes that were killed have left of drafts of a file. A draft that a process is
/// still at work on is locked by it, and stays; so does everything where nothing can be locked.
pub(crate) fn sweep(path: &Path) {
    let place = behind_links(path);
    let (Some(folder), Some(of)) = (place.parent(), place.file_name()) else { return };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| is_temporary(&entry.file_name(), of)) {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        // What is no file, a pipe say, is not even opened.
        let left = is_file.then(|| fs::OpenOptions::new().write(true).open(entry.path()));
        // Removed while locked: who made it a moment ago finds out that it is gone.
        if let Some(Ok(left)) = left
            && left.try_lock().is_ok()
            && is_at(&left, &entry.path())
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a file is the one that stands there: it may have taken another's place since it was opened.
fn is_at(file: &fs::File, path: &Path) -> bool {
    let [opened, there] = [file.metadata(), fs::symlink_metadata(path)];
    opened.is_ok_and(|opened| there.is_ok_and(|there| identity(&opened) == identity(&there)))
}

/// Makes the file, and locks it for as long as this process lives.
fn make(temporary: &Path) -> io::Result<fs::File> {
    let file = fs::OpenOptions::new().write(true).create_new(true).open(temporary)?;
    let is_swept = matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock));
    // Another process may have taken it for one that was left, before it was locked.
    if is_swept || !is_at(&file, temporary) {
        return Err(io::ErrorKind::AlreadyExists.into());
    }
    Ok(file)
}

impl Draft {
    /// Opens a temporary file in the folder of `path`, and removes those that were left there.
    ///
    /// # Errors
    /// The system's; also when something other than a writable, regular file is in the place.
    pub(crate) fn begin(path: &Path) -> io::Result<Self> {
        let place = behind_links(path);
        if let Ok(about) = fs::metadata(&place) {
            if !about.is_file() {
                return Err(io::Error::other("something that is not a file is in its place"));
            }
            if about.permissions().readonly() {
                return Err(io::Error::other("the file in its place is read-only"));
            }
        }
        sweep(&place);
        let open = |n| {
            let temporary = place.with_file_name(temporary(&place, n));
            make(&temporary).map(|file| (temporary, file))
        };
        // Whether a file can be written is asked while a picture before is being written to it.
        let mut opened = open(0);
        for n in 1..MOST_DRAFTS {
            match opened {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => opened = open(n),
                _ => break,
            }
        }
        let (temporary, file) = opened?;
        Ok(Self { temporary, place, file })
    }

    /// Puts the file in its place, once its bytes are safe on the disk.
    ///
    /// # Errors
    /// The system's, a full disk among them; the file that was there before stays.
    pub(crate) fn finish(self) -> io::Result<()> {
        self.file.sync_all()?;
        fs::rename(&self.temporary, &self.place)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // After `finish` nothing has that name any more.
        let _ = fs::remove_file(&self.temporary);
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;
    use crate::testing::Folder;

    #[expect(clippy::disallowed_methods, reason = "tests look at files")]
    fn bytes(path: &Path) -> Vec<u8> {
        fs::read(path).unwrap()
    }

    #[test]
    fn a_draft_that_is_not_finished_leaves_the_old_file_and_no_other() {
        let folder = Folder::new("draft");
        folder.write("a.exr", b"old");
        let mut draft = Draft::begin(&folder.path("a.exr")).unwrap();
        draft.file.write_all(b"half of the new").unwrap();
        assert_eq!(folder.names().len(), 2);
        drop(draft);
        assert_eq!(folder.names(), ["a.exr"]);
        assert_eq!(bytes(&folder.path("a.exr")), b"old");
        let mut draft = Draft::begin(&folder.path("a.exr")).unwrap();
        draft.file.write_all(b"new").unwrap();
        draft.finish().unwrap();
        assert_eq!(folder.names(), ["a.exr"]);
        assert_eq!(bytes(&folder.path("a.exr")), b"new");
    }

    #[test]
    fn two_drafts_of_one_file_leave_each_other_alone() {
        let folder = Folder::new("two-drafts");
        let begin = || Draft::begin(&folder.path("a.exr")).unwrap();
        let mut first = begin();
        first.file.write_all(b"first").unwrap();
        drop(begin());
        first.finish().unwrap();
        assert_eq!(folder.names(), ["a.exr"]);
        assert_eq!(bytes(&folder.path("a.exr")), b"first");
    }

    #[test]
    fn what_killed_runs_left_is_removed_and_nothing_else() {
        let folder = Folder::new("stale");
        // Of numbers that a process had, that none can have, and that this one has.
        let mine = format!(".a.exr.{}.7.tmp", std::process::id());
        let left = [".a.exr.1.0.tmp", ".a.exr.99999999999.3.tmp", mine.as_str()];
        let others = [
            ".a.exr.tmp",
            ".a.exr.1.tmp",
            ".a.exr.1.0.2.tmp",
            ".a.exr.1.x.tmp",
            ".a.exr..0.tmp",
            ".a.exr.1.0.tmp.bak",
            ".ba.exr.1.0.tmp",
            "a.exr.1.0.tmp",
        ];
        for name in left.iter().chain(&others) {
            folder.write(name, b"half");
        }
        folder.write(".a.exr.2.0.tmp/inside", b"");
        let live = Draft::begin(&folder.path("a.exr")).unwrap();
        drop(Draft::begin(&folder.path("a.exr")).unwrap());
        let mut expected: Vec<String> = others.map(String::from).into();
        let name = live.temporary.file_name().unwrap();
        expected.extend([".a.exr.2.0.tmp".into(), name.to_str().unwrap().into()]);
        let mut found = folder.names();
        found.sort();
        expected.sort();
        assert_eq!(found, expected);
    }

    #[cfg(unix)]
    #[test]
    fn a_file_is_written_through_links_also_to_what_is_not_there_yet() {
        let folder = Folder::new("links");
        folder.write("far/other", b"");
        let link = |to: &str, from: &str| {
            std::os::unix::fs::symlink(to, folder.path(from)).unwrap();
        };
        link("b.exr", "a.exr");
        link("far/c.exr", "b.exr");
        for content in [b"first", b"other"] {
            let mut draft = Draft::begin(&folder.path("a.exr")).unwrap();
            draft.file.write_all(content).unwrap();
            draft.finish().unwrap();
            assert_eq!(bytes(&folder.path("far/c.exr")), content);
            assert!(folder.path("a.exr").is_symlink() && folder.path("b.exr").is_symlink());
        }
    }

    #[test]
    fn folders_in_the_place_and_missing_folders_are_told() {
        let folder = Folder::new("places");
        folder.write("a.exr/inside", b"");
        assert!(Draft::begin(&folder.path("a.exr")).is_err());
        assert!(Draft::begin(&folder.path("none/b.exr")).is_err());
        assert!(!cfg!(unix) || Draft::begin(Path::new("/dev/full")).is_err());
    }

    #[test]
    fn what_is_read_is_not_written_over() {
        let folder = Folder::new("keep");
        folder.write("a.exr", b"old");
        let output = Output { exr: folder.path("a.exr"), png: folder.path("a.png") };
        let wrong = output.keep(&folder.path("./a.exr")).unwrap_err();
        assert!(wrong.exit == Exit::Usage && wrong.message.contains("would take the place of"));
        output.keep(&folder.path("b.exr")).unwrap();
    }

    #[test]
    fn the_output_is_named_by_the_person_then_the_film_then_the_scene() {
        let name = |given: Option<&str>, film| {
            Output::choose(given.map(Path::new), film, Path::new("scenes/box.scene"))
                .map(|output| output.exr.display().to_string())
                .map_err(|failure| failure.exit)
        };
        assert_eq!(name(None, None).unwrap(), "box.exr");
        assert_eq!(name(None, Some("film.exr")).unwrap(), "film.exr");
        assert_eq!(name(Some("out/v1.2"), Some("film.exr")).unwrap(), "out/v1.2.exr");
        assert_eq!(name(Some("out.PNG"), None).unwrap(), "out.exr");
        assert_eq!(name(None, Some("../up.exr")), Err(Exit::Input));
        assert_eq!(name(None, Some("/etc/x.exr")), Err(Exit::Input));
        assert_eq!(name(Some("/"), None), Err(Exit::Usage));
    }
}
