//! A private copy of a library: what was hashed is what is opened, whatever happens to the file.

use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use luxel_core::files::FileError;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

use crate::files::open_regular;

/// Bytes of a library, at most.
const MAX_BYTES: u64 = 256 << 20;

/// A copy in a folder that nobody else can enter; gone when dropped.
#[derive(Debug)]
pub(super) struct PrivateCopy {
    /// Keeps the folder.
    _folder: TempDir,
    /// The copy.
    pub(super) path: PathBuf,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub(super) sha256: String,
    /// The same bytes' hash as watching knows it.
    pub(super) seen: blake3::Hash,
}

impl PrivateCopy {
    /// Copies a regular file, links followed. The name is new in this process with every generation:
    /// a name that was open before could give the library of that time.
    ///
    /// # Errors
    /// What stands in the way, in words.
    pub(super) fn take(file: &Path, stem: &str, generation: u32) -> Result<Self, String> {
        let (from, _) = open_regular(file, MAX_BYTES).map_err(|error| error.to_string())?;
        match Self::of(from, stem, generation) {
            Ok(Some(copy)) => Ok(copy),
            Ok(None) => Err(FileError::TooLarge(MAX_BYTES).to_string()),
            Err(error) => Err(format!("it cannot be copied: {error}")),
        }
    }

    /// Hashes what it writes, so that the hash is that of the copy.
    fn of(mut from: fs::File, stem: &str, generation: u32) -> io::Result<Option<Self>> {
        let folder = private_folder()?;
        let suffix = std::env::consts::DLL_SUFFIX;
        let name = format!("{stem}.{}.{generation}{suffix}", std::process::id());
        let path = folder.path().join(name);
        let mut to = fs::OpenOptions::new().write(true).create_new(true).open(&path)?;
        let (mut sha256, mut seen) = (Sha256::new(), blake3::Hasher::new());
        let mut buffer = vec![0; 1 << 16];
        let mut n_bytes = 0;
        loop {
            let n = from.read(&mut buffer)?;
            n_bytes += n as u64;
            if n == 0 {
                break;
            }
            if n_bytes > MAX_BYTES {
                return Ok(None);
            }
            sha256.update(&buffer[..n]);
            seen.update(&buffer[..n]);
            to.write_all(&buffer[..n])?;
        }
        let sha256 = hex(&sha256.finalize());
        Ok(Some(Self { _folder: folder, path, sha256, seen: seen.finalize() }))
    }
}

fn private_folder() -> io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix("luxel-plugin-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    builder.tempdir()
}

fn hex(bytes: &[u8]) -> String {
    let digit = |half: u8| char::from(b"0123456789abcdef"[usize::from(half & 15)]);
    bytes.iter().flat_map(|byte| [digit(byte >> 4), digit(*byte)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Folder;

    #[test]
    fn a_copy_is_hashed_named_by_generation_and_removed() {
        let folder = Folder::new("copy");
        folder.write("libabc.so", b"abc");
        let copy = PrivateCopy::take(&folder.path("libabc.so"), "abc", 7).unwrap();
        // FIPS 180-2, appendix B.1.
        let truth = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(copy.sha256, truth);
        assert_eq!(copy.seen, blake3::hash(b"abc"));
        let name = copy.path.file_name().unwrap().to_string_lossy().into_owned();
        assert!(name.starts_with("abc.") && name.contains(".7."), "{name}");
        folder.write("libabc.so", b"abd");
        let place = copy.path.clone();
        assert_eq!(open_regular(&place, 9).unwrap().1, 3);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let about = fs::metadata(place.parent().unwrap()).unwrap();
            assert_eq!(about.permissions().mode() & 0o777, 0o700);
        }
        drop(copy);
        assert!(!place.exists() && !place.parent().unwrap().exists());
    }

    #[test]
    fn folders_missing_files_and_huge_ones_are_refused() {
        let folder = Folder::new("copy-refused");
        folder.write("libdir.so/inside", b"");
        let why = |name| PrivateCopy::take(&folder.path(name), "x", 0).unwrap_err();
        assert!(why("libdir.so").contains("folder"));
        assert!(why("libnone.so").contains("no such file"));
        // Without any blocks on the disk.
        let mut huge = fs::OpenOptions::new();
        let huge = huge.write(true).create_new(true).open(folder.path("libhuge.so")).unwrap();
        huge.set_len(MAX_BYTES + 1).unwrap();
        assert!(why("libhuge.so").contains("bytes"), "{}", why("libhuge.so"));
    }
}
