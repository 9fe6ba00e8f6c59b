//! Whether a file may have changed, without reading it.

use std::fs;
use std::path::Path;
use std::time::SystemTime;

/// What the system says about a file: cheap to ask, but may stay the same for a tick of its clock
/// though the bytes change. `None` where there is nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Stamp(Option<About>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct About {
    len: u64,
    modified: Option<SystemTime>,
    identity: Identity,
    changed: (i64, i64),
}

/// Which file or folder it is, whatever its name: device and number, and when it was made, for
/// numbers are used again.
pub(crate) type Identity = (u64, u64, Option<SystemTime>);

impl Stamp {
    /// What it says now.
    pub(crate) fn of(path: &Path) -> Self {
        let about = |about: fs::Metadata| About {
            len: about.len(),
            modified: about.modified().ok(),
            identity: identity(&about),
            changed: changed(&about),
        };
        Self(fs::metadata(path).ok().map(about))
    }

    /// How long the file is, if there is one.
    pub(crate) fn len(&self) -> Option<u64> {
        self.0.as_ref().map(|about| about.len)
    }
}

#[cfg(unix)]
pub(crate) fn identity(about: &fs::Metadata) -> Identity {
    use std::os::unix::fs::MetadataExt;
    (about.dev(), about.ino(), about.created().ok())
}

#[cfg(not(unix))]
pub(crate) fn identity(about: &fs::Metadata) -> Identity {
    (0, 0, about.created().ok())
}

/// No program can set this time back, as it can that of the contents.
#[cfg(unix)]
fn changed(about: &fs::Metadata) -> (i64, i64) {
    use std::os::unix::fs::MetadataExt;
    (about.ctime(), about.ctime_nsec())
}

#[cfg(not(unix))]
fn changed(_: &fs::Metadata) -> (i64, i64) {
    (0, 0)
}
