//! Where libraries are looked for, and which files count as one.
//!
//! The command line, the environment and the user's configuration name folders; a scene, its folder
//! and the working directory do not.

use std::collections::{BTreeMap, BTreeSet};
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use super::config::Config;
use super::note::Notes;
use super::surroundings::Surroundings;
use crate::args::PluginArgs;
use crate::exit::Failure;

/// Letters of a stem, at most: it is part of the name of a symbol.
const MAX_STEM: usize = 64;

/// The folders in order, each once.
pub(super) fn folders(
    args: &PluginArgs,
    surroundings: &Surroundings,
    config: &Config,
    notes: &mut Notes,
) -> Vec<PathBuf> {
    let mut folders = vec![];
    for folder in &args.dirs {
        let place = std::path::absolute(folder).unwrap_or_else(|_| folder.clone());
        if !place.is_dir() {
            notes.warn(format!("there is no plugin folder `{}`", folder.display()));
        }
        // A watch waits for one that is not there yet.
        folders.push(place);
    }
    let path = surroundings.plugin_path.iter().flat_map(std::env::split_paths);
    let path = path.filter(|folder| folder.as_os_str() != "").map(|f| (f, "LUXEL_PLUGIN_PATH"));
    let settled = config.plugin_dirs.iter().map(|folder| (folder.clone(), "`plugin_dirs`"));
    for (folder, origin) in path.chain(settled) {
        if folder.is_absolute() {
            folders.push(folder);
        } else {
            let folder = folder.display();
            notes.warn(format!(
                "`{folder}` of {origin} is not searched: it depends on the folder in which luxel is \
                 started; an absolute path is wanted"
            ));
        }
    }
    let mut known = BTreeSet::new();
    folders.retain(|folder| known.insert(fs::canonicalize(folder).unwrap_or(folder.clone())));
    folders
}

/// The libraries of folders by stem; of two with the same stem that of the first folder.
pub(super) fn candidates(folders: &[PathBuf], notes: &mut Notes) -> BTreeMap<String, PathBuf> {
    let mut found = BTreeMap::<String, PathBuf>::new();
    for folder in folders {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
        paths.retain(|path| is_library(path));
        paths.sort_unstable();
        for path in paths {
            match stem_of(&path) {
                Err(why) => notes.warn(format!("`{}` is not opened: {why}", path.display())),
                Ok(stem) => {
                    if let Some(first) = found.get(&stem) {
                        let (path, first) = (path.display(), first.display());
                        notes.warn(format!("`{path}` is not opened: `{first}` comes first"));
                    } else {
                        found.insert(stem, path);
                    }
                }
            }
        }
    }
    found
}

/// Whether the libraries of a file's folder are found without being told of it.
///
/// # Errors
/// A configuration that cannot be understood.
pub(crate) fn is_searched(file: &Path, surroundings: &Surroundings) -> Result<bool, Failure> {
    let config = Config::read(surroundings.folder.as_deref())?;
    let folders = folders(&PluginArgs::default(), surroundings, &config, &mut Notes::default());
    let file = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
    let own = file.parent().unwrap_or(&file);
    Ok(folders.iter().any(|folder| is_same(folder, own)))
}

/// Whether two paths lead to the same place.
pub(super) fn is_same(a: &Path, b: &Path) -> bool {
    a == b || fs::canonicalize(a).is_ok_and(|a| fs::canonicalize(b).is_ok_and(|b| a == b))
}

/// Whether a file's name ends like that of a library.
pub(crate) fn is_library(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.len() > DLL_SUFFIX.len() && name.ends_with(DLL_SUFFIX)
}

/// A library's stem: its file's name without `lib` and extension.
///
/// # Errors
/// A name that no library may have, with those that one may.
pub(crate) fn stem_of(path: &Path) -> Result<String, String> {
    let name = path.file_name().and_then(OsStr::to_str).unwrap_or_default();
    let stem = name.strip_prefix(DLL_PREFIX).and_then(|rest| rest.strip_suffix(DLL_SUFFIX));
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    match stem {
        Some(stem) if (1..=MAX_STEM).contains(&stem.len()) && stem.chars().all(legal) => {
            Ok(stem.to_owned())
        }
        _ => Err(format!(
            "a plugin library is called `{}`, with a name of a to z, 0 to 9 and _",
            file_name("name")
        )),
    }
}

/// The file's name of a stem.
pub(super) fn file_name(stem: &str) -> String {
    format!("{DLL_PREFIX}{stem}{DLL_SUFFIX}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Folder;

    #[test]
    fn only_plain_names_are_those_of_libraries() {
        let stem = |name: &str| stem_of(Path::new(name));
        assert_eq!(stem(&file_name("gyroid_2")), Ok("gyroid_2".into()));
        assert_eq!(stem(&format!("/a/b/{}", file_name("x"))), Ok("x".into()));
        for bad in ["Gyroid", "a-b", "", "a.b", "é", "a b", &"a".repeat(65)] {
            let told = stem(&file_name(bad)).unwrap_err();
            assert!(told.contains("a to z"), "{bad}: {told}");
        }
        assert!(stem("gyroid.txt").is_err() && stem("..").is_err() && stem("/").is_err());
    }

    #[test]
    fn the_first_folder_wins_and_odd_names_are_told_once() {
        let folder = Folder::new("search");
        for name in ["a/one", "a/Two", "b/one", "b/three"] {
            let (folder_name, stem) = name.split_once('/').unwrap();
            folder.write(&format!("{folder_name}/{}", file_name(stem)), b"");
        }
        folder.write("a/notes.txt", b"");
        let folders = [folder.path("a"), folder.path("none"), folder.path("b")];
        let mut notes = Notes::default();
        let found = candidates(&folders, &mut notes);
        let stems: Vec<_> = found.keys().map(String::as_str).collect();
        assert_eq!(stems, ["one", "three"]);
        assert!(found["one"].starts_with(folder.path("a")));
        let told = notes.messages();
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].contains(&file_name("Two")) && told[0].contains("a to z"), "{told:?}");
        assert!(told[1].contains("comes first"), "{told:?}");
    }

    #[cfg(unix)]
    #[test]
    fn relative_folders_come_from_the_command_line_alone() {
        let folder = Folder::new("folders");
        folder.write("a/x", b"");
        let args = PluginArgs {
            dirs: vec![folder.path("a"), "src".into(), "none".into()],
            ..Default::default()
        };
        let plugin_path = Some(std::ffi::OsString::from(".:/usr/none::lib:/usr"));
        let surroundings = Surroundings { folder: None, plugin_path };
        let config = Config { plugin_dirs: vec!["plugins".into(), "/usr/".into()] };
        let mut notes = Notes::default();
        let found = folders(&args, &surroundings, &config, &mut notes);
        assert!(found.iter().all(|folder| folder.is_absolute()), "{found:?}");
        assert_eq!(found.len(), 5, "{found:?}");
        let told = notes.messages();
        assert_eq!(told.len(), 4, "{told:?}");
        assert!(told[0].contains("no plugin folder `none`"), "{told:?}");
        assert!(told[1].starts_with("`.` of LUXEL_PLUGIN_PATH"), "{told:?}");
        assert!(told[3].starts_with("`plugins` of `plugin_dirs`"), "{told:?}");
    }
}
