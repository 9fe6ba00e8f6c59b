//! What has been measured, kept on the disk while a render runs, so that another can go on with it.
//!
//! A line of JSON says of what it is; then comes the film, and a hash over both.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use luxel_core::film::{Film, Rect};
use luxel_core::render::{Options, can_go_on};
use luxel_core::stage::Stage;
use serde_json::{Value, json};

use crate::exit::{Exit, Failure};
use crate::load::Loaded;
use crate::output::{Draft, Output, unwritable};

/// Whether and when what has been measured is kept.
#[derive(clap::Args, Clone, Copy, Debug)]
pub(crate) struct CheckpointArgs {
    /// Go on with OUT.checkpoint, to the same picture as if nothing had come between; begin anew if it
    /// is not there
    #[arg(long)]
    pub(crate) resume: bool,
    /// Seconds between two checkpoints; 0 for none, not even after Ctrl-C
    #[arg(long = "checkpoint", value_name = "SECONDS", default_value = "60", value_parser = seconds)]
    every: Duration,
}

/// Time that may go into checkpoints: one part in so many.
const SHARE: u32 = 20;
/// Bytes of a hash.
const HASH: usize = blake3::OUT_LEN;

/// Where a render is kept.
pub(crate) struct Checkpoint {
    place: PathBuf,
    about: Value,
    every: Option<Duration>,
    next: Option<Instant>,
}

impl Checkpoint {
    /// Beside the picture; `libraries` is what plugins may differ by.
    pub(crate) fn new(
        args: CheckpointArgs,
        output: &Output,
        (stage, loaded): (&Stage, &Loaded),
        libraries: &str,
        (options, window): (&Options, Rect),
    ) -> Self {
        let about = json!({
            "luxel": env!("CARGO_PKG_VERSION"),
            "scene": blake3::Hash::from_bytes(stage.scene.measured_hash()).to_hex().to_string(),
            "files": loaded.files.hash_besides(&loaded.sources).to_hex().to_string(),
            "libraries": libraries,
            "seed": options.seed(stage),
            "window": [window.min.to_array(), window.size.to_array()],
        });
        let every = Some(args.every).filter(|every| !every.is_zero() && can_go_on(stage));
        let next = every.and_then(|every| Instant::now().checked_add(every));
        Self { place: output.exr.with_extension("checkpoint"), about, every, next }
    }

    /// Where it is.
    pub(crate) fn place(&self) -> &Path {
        &self.place
    }

    /// Whether there is one, of this picture or another.
    pub(crate) fn exists(&self) -> bool {
        self.place.exists()
    }

    /// The film that was left; nothing if there is none.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged, or is of another picture.
    pub(crate) fn read(&self) -> Result<Option<Film>, Failure> {
        let wrong = |why: &str| {
            let message = format!("cannot go on with `{}`: {why}", self.place.display());
            Failure::new(Exit::Input, message).help("without --resume the render begins anew")
        };
        #[expect(clippy::disallowed_methods, reason = "our own file, read by no scene")]
        let bytes = match std::fs::read(&self.place) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(wrong(&error.to_string())),
        };
        let (body, hash) =
            bytes.split_last_chunk::<HASH>().ok_or_else(|| wrong("it is damaged"))?;
        if blake3::hash(body) != *hash {
            return Err(wrong("it is damaged"));
        }
        let end =
            body.iter().position(|byte| *byte == b'\n').ok_or_else(|| wrong("it is damaged"))?;
        let about: Value = serde_json::from_slice(&body[..end]).unwrap_or_default();
        for (key, what) in DIFFERENCES {
            if about[key] != self.about[key] {
                return Err(wrong(&format!("it is of {what}")));
            }
        }
        Film::load(&body[end + 1..]).map(Some).map_err(|unreadable| wrong(unreadable.0))
    }

    /// Whether it is time for the next.
    pub(crate) fn is_due(&self) -> bool {
        self.next.is_some_and(|next| Instant::now() >= next)
    }

    /// Keeps the film, unless nothing is to be kept; returns whether.
    ///
    /// # Errors
    /// A file that cannot be written; the one before stays.
    pub(crate) fn keep(&mut self, film: &Film) -> Result<bool, Failure> {
        let Some(every) = self.every else { return Ok(false) };
        let start = Instant::now();
        let kept = self.write(film).map_err(|error| unwritable(&self.place, &error));
        self.next = Instant::now().checked_add(every.max(start.elapsed() * SHARE));
        kept.map(|()| true)
    }

    fn write(&self, film: &Film) -> io::Result<()> {
        let draft = Draft::begin(&self.place)?;
        let mut to = Hashing { to: BufWriter::new(&draft.file), hash: blake3::Hasher::new() };
        writeln!(to, "{}", self.about)?;
        film.save(&mut to)?;
        let hash = to.hash.finalize();
        to.write_all(hash.as_bytes())?;
        to.flush()?;
        drop(to);
        draft.finish()
    }

    /// The picture is whole: there is nothing to go on with.
    pub(crate) fn remove(&self) {
        // What is not there need not go.
        let _ = std::fs::remove_file(&self.place);
    }
}

/// More than a year is never.
const MOST_SECONDS: f64 = 4e7;

fn seconds(text: &str) -> Result<Duration, String> {
    let found = text.parse().ok().filter(|s: &f64| (0.0..=MOST_SECONDS).contains(s));
    found.map(Duration::from_secs_f64).ok_or_else(|| "expected seconds, as in 60, or 0".into())
}

/// What two renders may differ by, in the order in which it is told.
const DIFFERENCES: [(&str, &str); 6] = [
    ("luxel", "another version"),
    ("scene", "another scene, or of one that has been edited since"),
    ("files", "other textures or meshes"),
    ("libraries", "other plugin libraries"),
    ("seed", "another seed"),
    ("window", "another size or crop"),
];

/// Writes, and remembers what.
struct Hashing<W> {
    to: W,
    hash: blake3::Hasher,
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.to.write(bytes)?;
        self.hash.update(&bytes[..n]);
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::testing::Folder;

    fn checkpoint(folder: &Folder, seed: u32) -> Checkpoint {
        let place = folder.path("a.checkpoint");
        let every = Some(Duration::from_secs(60));
        Checkpoint { place, about: json!({ "seed": seed }), every, next: None }
    }

    fn film() -> Film {
        Film::new(UVec2::splat(20), Rect::new(UVec2::ZERO, UVec2::splat(20)))
    }

    #[test]
    fn what_was_kept_is_read_and_nothing_else_is_left() {
        let folder = Folder::new("checkpoint");
        let mut kept = checkpoint(&folder, 1);
        assert_eq!(kept.read().unwrap(), None);
        assert!(!kept.is_due());
        kept.keep(&film()).unwrap();
        assert_eq!(folder.names(), ["a.checkpoint"]);
        assert_eq!(kept.read().unwrap(), Some(film()));
        kept.remove();
        assert!(folder.names().is_empty() && !kept.exists());
    }

    #[test]
    fn another_picture_and_a_damaged_file_are_refused() {
        let folder = Folder::new("checkpoint-bad");
        let mut kept = checkpoint(&folder, 1);
        kept.keep(&film()).unwrap();
        let why = |checkpoint: &Checkpoint| checkpoint.read().unwrap_err().message;
        assert!(why(&checkpoint(&folder, 2)).ends_with("it is of another seed"));
        #[expect(clippy::disallowed_methods, reason = "tests look at files")]
        let mut bytes = std::fs::read(kept.place()).unwrap();
        bytes[100] ^= 1;
        folder.write("a.checkpoint", &bytes);
        assert!(why(&kept).ends_with("it is damaged"), "{}", why(&kept));
        folder.write("a.checkpoint", b"short");
        assert!(why(&kept).ends_with("it is damaged"));
    }
}
