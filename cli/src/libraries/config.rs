//! The user's `config.toml`.

use std::path::{Path, PathBuf};

use luxel_core::files::FileError;
use serde::Deserialize;

use crate::exit::{Exit, Failure};
use crate::files::read_limited;

/// Bytes of a configuration file, at most.
const MAX_BYTES: u64 = 1 << 20;

/// What the user has settled for good.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Config {
    /// Folders in which plugin libraries are looked for.
    #[serde(default)]
    pub(super) plugin_dirs: Vec<PathBuf>,
}

impl Config {
    /// That of a folder; nothing is settled where there is no file.
    ///
    /// # Errors
    /// A file that cannot be understood, with the line.
    pub(super) fn read(folder: Option<&Path>) -> Result<Self, Failure> {
        Ok(folder
            .map(|folder| read(&folder.join("config.toml")))
            .transpose()?
            .flatten()
            .unwrap_or_default())
    }
}

/// A TOML file; `None` if there is none.
///
/// # Errors
/// A file that cannot be read or does not say what is expected, with the line.
pub(super) fn read<T: for<'de> Deserialize<'de>>(path: &Path) -> Result<Option<T>, Failure> {
    let wrong = |why: String| {
        Failure::new(Exit::Input, format!("`{}` cannot be understood: {why}", path.display()))
    };
    let bytes = match read_limited(path, MAX_BYTES) {
        Ok(bytes) => bytes,
        Err(FileError::NotFound) => return Ok(None),
        Err(error) => return Err(wrong(error.to_string())),
    };
    let text = String::from_utf8(bytes).map_err(|_| wrong("it is not UTF-8".into()))?;
    toml::from_str(&text).map(Some).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start.min(text.len()));
        let line = text.bytes().take(start).filter(|byte| *byte == b'\n').count() + 1;
        let told = error.message().split_whitespace().collect::<Vec<_>>().join(" ");
        wrong(format!("line {line}: {told}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Folder;

    #[test]
    fn unknown_keys_and_wrong_types_are_told_with_their_line() {
        let folder = Folder::new("config");
        let read = |text: &str| {
            folder.write("config.toml", text.as_bytes());
            Config::read(Some(&folder.path(""))).map_err(|failure| failure.message)
        };
        assert_eq!(read("plugin_dirs = [\"/a\", \"/b\"]").unwrap().plugin_dirs.len(), 2);
        assert!(read("").unwrap().plugin_dirs.is_empty());
        for (text, parts) in [
            ("# mine\nplugin_dir = []\n", ["line 2", "plugin_dir"]),
            ("\n\nplugin_dirs = 3\n", ["line 3", "integer"]),
            ("plugin_dirs = [\"/a\",\n\n 7]\n", ["line 3", "integer"]),
            ("plugin_dirs = [", ["line 1", "array"]),
        ] {
            let told = read(text).unwrap_err();
            assert!(parts.iter().all(|part| told.contains(part)), "{text:?}: {told}");
        }
    }

    #[test]
    fn without_a_file_or_a_folder_nothing_is_settled() {
        let folder = Folder::new("no-config");
        assert!(Config::read(Some(&folder.path("none"))).unwrap().plugin_dirs.is_empty());
        assert!(Config::read(None).unwrap().plugin_dirs.is_empty());
    }
}
