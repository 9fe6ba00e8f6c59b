//! Whether a folder lies on another machine, whose writes make no events here.

use std::path::{Path, PathBuf};

use crate::files::read_limited;

/// Names of file systems whose files others write: proc(5), and what virtual machines share.
const REMOTE: [&str; 14] = [
    "nfs",
    "nfs4",
    "cifs",
    "smb3",
    "smbfs",
    "9p",
    "virtiofs",
    "vboxsf",
    "prl_fs",
    "ceph",
    "afs",
    "glusterfs",
    "lustre",
    "fuse",
];

/// Longer lists of mounts are not read.
const MAX_BYTES: u64 = 16 << 20;

/// Whether a folder is on a network mount; false where the system does not say.
pub(super) fn is_remote(folder: &Path) -> bool {
    let mounts = read_limited(Path::new("/proc/self/mountinfo"), MAX_BYTES);
    mounts.is_ok_and(|mounts| is_remote_by(&String::from_utf8_lossy(&mounts), folder))
}

fn is_remote_by(mounts: &str, folder: &Path) -> bool {
    let lines = mounts.lines().filter_map(|line| {
        let (about, system) = line.split_once(" - ")?;
        let place = PathBuf::from(unescaped(about.split(' ').nth(4)?));
        folder.starts_with(&place).then_some((place, system.split(' ').next()?))
    });
    // Of mounts over each other the last one counts.
    let nearest = lines.max_by_key(|(place, _)| place.components().count());
    nearest
        .is_some_and(|(_, system)| REMOTE.contains(&system.split('.').next().unwrap_or_default()))
}

/// Blanks and the like are written in octal.
fn unescaped(text: &str) -> String {
    [("\\040", " "), ("\\011", "\t"), ("\\012", "\n"), ("\\134", "\\")]
        .iter()
        .fold(text.to_owned(), |text, (code, letter)| text.replace(code, letter))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_mount_says_whether_a_folder_is_remote() {
        let mounts = "22 1 0:5 / / rw,relatime shared:1 - ext4 /dev/sda rw\n\
                      30 22 0:9 / /home/a\\040b rw - nfs4 host:/home rw,vers=4.2\n\
                      31 30 0:7 / /home/a\\040b/local rw - tmpfs none rw\n\
                      32 22 0:8 / /far rw master:2 - fuse.sshfs host: rw\n";
        let check = |folder: &str, expected| {
            assert_eq!(is_remote_by(mounts, Path::new(folder)), expected, "{folder}");
        };
        check("/home", false);
        check("/home/a b", true);
        check("/home/a b/scenes", true);
        check("/home/a b/local/x", false);
        check("/far/scenes", true);
        check("/farther", false);
    }
}
