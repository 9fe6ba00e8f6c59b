//! What leads to a file: every link on the way, and the folders in which one of them or the file
//! itself can be replaced.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::file::name;

/// As many links as Linux follows (`path_resolution(7)`).
const MAX_LINKS: u32 = 40;

/// The folders to listen in, and which names in them matter.
#[derive(Debug, Default)]
pub(super) struct Hops {
    /// Of each hop the parent and the grandparent, or the nearest that are there; without links.
    pub(super) folders: BTreeSet<PathBuf>,
    /// Names of links and folders: whatever happens to them may lead elsewhere.
    pub(super) ways: BTreeSet<OsString>,
    /// For each name of a file, its hops' included, the files that it concerns.
    pub(super) files: BTreeMap<OsString, BTreeSet<PathBuf>>,
    /// Where paths lead, links resolved.
    places: BTreeMap<PathBuf, PathBuf>,
}

impl Hops {
    /// Of all these files.
    pub(super) fn of<'a>(files: impl IntoIterator<Item = &'a Path>) -> Self {
        let mut hops = Self::default();
        for file in files {
            hops.add(file);
        }
        hops
    }

    fn add(&mut self, file: &Path) {
        let path = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
        let mut at = path;
        // The file's own links one by one, for each of them can be swapped.
        for _ in 0..MAX_LINKS {
            let folder = at.parent().map(|folder| self.place(folder, MAX_LINKS));
            let here = folder.map_or_else(|| at.clone(), |folder| folder.join(name(&at)));
            self.files.entry(name(&here)).or_default().insert(file.to_path_buf());
            self.hop(&here);
            match fs::read_link(&here) {
                Ok(target) => at = here.with_file_name("").join(target),
                Err(_) => break,
            }
        }
        let place = self.place(&at, MAX_LINKS);
        if place.is_dir() {
            self.folders.insert(place);
        }
    }

    /// Where a path leads; each link on the way is a hop.
    fn place(&mut self, path: &Path, links: u32) -> PathBuf {
        if let Some(place) = self.places.get(path) {
            return place.clone();
        }
        let place = match (path.components().next_back(), path.parent()) {
            (Some(Component::Normal(last)), Some(above)) => {
                let here = self.place(above, links).join(last);
                match fs::read_link(&here) {
                    Ok(target) if links > 0 => {
                        self.ways.insert(last.to_owned());
                        self.hop(&here);
                        let target = here.with_file_name("").join(target);
                        self.place(&target, links - 1)
                    }
                    _ => here,
                }
            }
            (Some(Component::ParentDir), Some(above)) => {
                let mut place = self.place(above, links);
                place.pop();
                place
            }
            (Some(Component::CurDir), Some(above)) => self.place(above, links),
            _ => path.to_path_buf(),
        };
        self.places.insert(path.to_path_buf(), place.clone());
        place
    }

    /// Something in a folder without links that may be replaced, or whose folder may.
    fn hop(&mut self, here: &Path) {
        let mut above = here.ancestors().skip(1);
        for folder in above.by_ref() {
            // What has the name of a missing folder is what would appear.
            self.ways.insert(name(folder));
            if folder.is_dir() {
                self.folders.insert(folder.to_path_buf());
                break;
            }
        }
        self.folders.extend(above.next().map(Path::to_path_buf));
    }
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;
    use crate::testing::Folder;

    /// The folders, below `root`, that are listened in for `file`.
    fn folders(root: &Path, file: &str) -> Vec<String> {
        let hops = Hops::of([root.join(file).as_path()]);
        let below = |folder: &PathBuf| Some(folder.strip_prefix(root).ok()?.display().to_string());
        hops.folders.iter().filter_map(below).collect()
    }

    #[test]
    fn parents_and_grandparents_of_every_hop_are_listened_in() {
        let folder = Folder::new("hops");
        let root = fs::canonicalize(folder.path("")).unwrap();
        folder.write("a/b/c/real.scene", b"");
        folder.write("x/y/z/other", b"");
        symlink("../../../a/b/c/real.scene", root.join("x/y/z/link.scene")).unwrap();
        symlink("x/y", root.join("way")).unwrap();
        assert_eq!(folders(&root, "a/b/c/real.scene"), ["a/b", "a/b/c"]);
        assert_eq!(folders(&root, "a/b/../b/c/real.scene"), ["a/b", "a/b/c"]);
        assert_eq!(folders(&root, "way/z/link.scene"), ["", "a/b", "a/b/c", "x/y", "x/y/z"]);
        assert_eq!(folders(&root, "a/none/at/all.scene"), ["", "a"]);
        let hops = Hops::of([root.join("way/z/link.scene").as_path()]);
        for name in ["link.scene", "real.scene"] {
            assert!(hops.files.contains_key(Path::new(name).as_os_str()), "{hops:?}");
        }
        for name in ["way", "z", "c"] {
            assert!(hops.ways.contains(Path::new(name).as_os_str()), "{hops:?}");
        }
    }

    #[test]
    fn links_in_circles_and_bombs_of_links_end() {
        let folder = Folder::new("hops-circles");
        let root = folder.path("");
        symlink("b", root.join("a")).unwrap();
        symlink("a", root.join("b")).unwrap();
        // Each name is two of the next: 2⁶⁰ in all, if they were not remembered.
        for n in 0..60 {
            symlink(format!("c{0}/c{0}", n + 1), root.join(format!("c{n}"))).unwrap();
        }
        let hops = Hops::of([root.join("a/x").as_path(), &root.join("c0/x"), &root.join("b")]);
        assert!(hops.folders.len() < 200 && !hops.folders.is_empty());
    }
}
