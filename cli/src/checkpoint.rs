//! What has been measured, kept on the disk while a render runs, so that another can go on with it.
//!
//! After a first line by which it is known comes a line of JSON that says of what it is, then the film,
//! and a hash over all.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use luxel_core::film::{Confidence, Film, Rect};
use luxel_core::render::{Goal, Options, can_go_on};
use luxel_core::stage::Stage;
use serde_json::{Value, json};

use crate::args::MOST_SECONDS;
use crate::exit::{Exit, Failure};
use crate::load::Loaded;
use crate::output::{Draft, Output, sweep, unwritable};

/// Whether and when what has been measured is kept.
#[derive(clap::Args, Clone, Copy, Debug)]
pub(crate) struct CheckpointArgs {
    /// Go on with OUT.checkpoint, to the same picture as if nothing had come between; begin anew if it
    /// is not there. --spp, --error and --time are as before if none is given, --time for what was left
    /// of it; a --time that is given is that of this run alone
    #[arg(long)]
    pub(crate) resume: bool,
    /// Seconds between two checkpoints, or four times as long as one takes; each waits a few seconds
    /// for what is being measured; 0 for none, not even after Ctrl-C [default: 60]
    #[arg(long = "checkpoint", value_name = "SECONDS", value_parser = seconds)]
    every: Option<Duration>,
}

impl CheckpointArgs {
    /// Time between two checkpoints; zero for none.
    fn every(self) -> Duration {
        self.every.unwrap_or(USUAL)
    }

    /// Whether somebody counts on checkpoints: who asks for them, or for a picture that takes longer than
    /// it is until the first.
    pub(crate) fn are_missed(self, goal: Goal) -> bool {
        let is_long = goal.error.is_some() || goal.time.is_some_and(|time| time >= self.every());
        !self.every().is_zero() && (self.every.is_some() || is_long)
    }
}

/// Time between two checkpoints if nobody says otherwise.
const USUAL: Duration = Duration::from_secs(60);

/// Time that may go into checkpoints: one part for so many of rendering.
const SHARE: u32 = 4;
/// Bytes of the first two lines, at most.
const MOST_HEAD: u64 = 4096;
/// Bytes of a hash.
const HASH: usize = blake3::OUT_LEN;

/// What every checkpoint begins with.
const MAGIC: &[u8] = b"luxel checkpoint\n";

/// Where a render is kept.
pub(crate) struct Checkpoint {
    place: PathBuf,
    about: Value,
    every: Option<Duration>,
    next: Option<Instant>,
    /// Seconds that the runs before this one have rendered.
    before: f64,
    /// Seconds that this run was given.
    given: Option<f64>,
}

/// What is there of an earlier render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Left {
    /// Nothing.
    Nothing,
    /// A checkpoint of another picture.
    Other,
    /// One that could be gone on with.
    Same,
}

/// How much was asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Asked {
    /// Samples of a pixel, if somebody said so.
    pub(crate) spp: Option<u32>,
    /// The error.
    pub(crate) error: Option<f64>,
    /// With which confidence, if not as one standard error.
    pub(crate) confidence: Option<Confidence>,
    /// Seconds: those of this run, or what is left of them for the next.
    pub(crate) time: Option<f64>,
}

/// What an earlier run has left.
#[derive(Debug, PartialEq)]
pub(crate) struct Before {
    /// What it measured.
    pub(crate) film: Film,
    /// What it was to become.
    pub(crate) asked: Asked,
    /// Seconds that it took, with those of the runs before it.
    pub(crate) seconds: f64,
}

impl Asked {
    /// What these options ask for.
    pub(crate) fn of(options: &Options) -> Self {
        let Goal { error, confidence, time } = options.goal;
        Self { spp: options.spp, error, confidence, time: time.map(|time| time.as_secs_f64()) }
    }

    /// The same for another run. One that had an error to reach and no time left goes on until then.
    pub(crate) fn ask(&self, options: &mut Options) {
        (options.spp, options.goal.error) = (self.spp, self.error);
        options.goal.confidence = self.confidence;
        let time = self.time.filter(|left| *left > 0.0 || self.error.is_none());
        options.goal.time = time.and_then(|left| Duration::try_from_secs_f64(left).ok());
    }
}

impl Checkpoint {
    /// Beside the picture; `libraries` is what plugins may differ by.
    ///
    /// # Errors
    /// A file in its place that is none.
    pub(crate) fn new(
        args: CheckpointArgs,
        output: &Output,
        (stage, loaded): (&Stage, &Loaded),
        libraries: &str,
        (options, window): (&Options, Rect),
    ) -> Result<Self, Failure> {
        let asked = Asked::of(options);
        let about = json!({
            "luxel": env!("CARGO_PKG_VERSION"),
            "build": env!("LUXEL_BUILD"),
            "scene": blake3::Hash::from_bytes(stage.scene.measured_hash()).to_hex().to_string(),
            "files": loaded.files.hash_besides(&loaded.sources).to_hex().to_string(),
            "libraries": libraries,
            "seed": options.seed(stage),
            "window": [window.min.to_array(), window.size.to_array()],
            "spp": asked.spp,
            "error": asked.error,
            "confidence": asked.confidence.map(Confidence::share),
        });
        let every = Some(args.every()).filter(|every| !every.is_zero() && can_go_on(stage));
        let next = every.and_then(|every| Instant::now().checked_add(every));
        let place = output.exr.with_extension("checkpoint");
        let kept = Self { place, about, every, next, before: 0.0, given: asked.time };
        kept.head()?;
        // Here too: a render may end before it keeps anything.
        sweep(&kept.place);
        Ok(kept)
    }

    /// Where it is.
    pub(crate) fn place(&self) -> &Path {
        &self.place
    }

    /// What is there.
    ///
    /// # Errors
    /// As `new`.
    pub(crate) fn left(&self) -> Result<Left, Failure> {
        Ok(match self.head()? {
            None => Left::Nothing,
            Some(about) if self.difference(&about).is_none() => Left::Same,
            Some(_) => Left::Other,
        })
    }

    /// What the file that is there says of itself.
    fn head(&self) -> Result<Option<Value>, Failure> {
        let Some(file) = self.open()? else { return Ok(None) };
        let mut from = BufReader::new(file.take(MOST_HEAD));
        let (mut magic, mut about) = (vec![], vec![]);
        let read = from.read_until(b'\n', &mut magic);
        read.and_then(|_| from.read_until(b'\n', &mut about)).map_err(|e| self.wrong(&e))?;
        if magic != MAGIC {
            return Err(self.in_the_way("no checkpoint"));
        }
        Ok(Some(serde_json::from_slice(&about).unwrap_or_default()))
    }

    /// The file that is there, if it is a regular one.
    fn open(&self) -> Result<Option<File>, Failure> {
        match std::fs::metadata(&self.place) {
            Ok(about) if !about.is_file() => {
                return Err(self.in_the_way("no file"));
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            _ => {}
        }
        #[expect(clippy::disallowed_methods, reason = "our own file, read by no scene")]
        File::open(&self.place).map(Some).map_err(|error| self.wrong(&error))
    }

    fn in_the_way(&self, what: &str) -> Failure {
        let message = format!("`{}` is in the way: {what}", self.place.display());
        Failure::new(Exit::Input, message).help("choose another place: -o OUT")
    }

    fn wrong(&self, why: &dyn std::fmt::Display) -> Failure {
        let message = format!("cannot go on with `{}`: {why}", self.place.display());
        Failure::new(Exit::Input, message).help("without --resume the render begins anew")
    }

    /// What it is of, if it is of another picture.
    fn difference(&self, about: &Value) -> Option<&'static str> {
        let mut differences = DIFFERENCES.iter();
        differences.find(|(key, _)| about[key] != self.about[key]).map(|(_, what)| *what)
    }

    /// What was left; nothing if there is none.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged, or is of another picture.
    pub(crate) fn read(&self) -> Result<Option<Before>, Failure> {
        let wrong = |why: &str| self.wrong(&why);
        let Some(mut file) = self.open()? else { return Ok(None) };
        let mut bytes = vec![];
        file.read_to_end(&mut bytes).map_err(|error| self.wrong(&error))?;
        let damaged = || wrong("it is damaged");
        let (body, hash) = bytes.split_last_chunk::<HASH>().ok_or_else(damaged)?;
        if blake3::hash(body) != *hash {
            return Err(damaged());
        }
        let body = body.strip_prefix(MAGIC).ok_or_else(damaged)?;
        let end = body.iter().position(|byte| *byte == b'\n').ok_or_else(damaged)?;
        let about: Value = serde_json::from_slice(&body[..end]).map_err(|_| damaged())?;
        if let Some(what) = self.difference(&about) {
            return Err(wrong(&format!("it is of {what}")));
        }
        let film = Film::load(&body[end + 1..]).map_err(|unreadable| wrong(unreadable.0))?;
        let spp = about["spp"].as_u64().and_then(|spp| spp.try_into().ok());
        let [error, time, seconds] =
            ["error", "time_left", "seconds"].map(|key| about[key].as_f64());
        let confidence = about["confidence"].as_f64().and_then(Confidence::new);
        let asked = Asked { spp, error, confidence, time };
        Ok(Some(Before { film, asked, seconds: seconds.unwrap_or(0.0) }))
    }

    /// From now on this is asked for, after so many seconds of other runs.
    pub(crate) fn asks(&mut self, asked: Asked, before: f64) {
        (self.about["spp"], self.about["error"]) = (json!(asked.spp), json!(asked.error));
        self.about["confidence"] = json!(asked.confidence.map(Confidence::share));
        (self.given, self.before) = (asked.time, before);
    }

    /// Seconds that the runs before this one have rendered.
    pub(crate) fn before(&self) -> f64 {
        self.before
    }

    /// Whether it is time for the next.
    pub(crate) fn is_due(&self) -> bool {
        self.next.is_some_and(|next| Instant::now() >= next)
    }

    /// Keeps the film after so many seconds of this run, unless nothing is to be kept; returns whether.
    ///
    /// # Errors
    /// A file that cannot be written; the one before stays.
    pub(crate) fn keep(&mut self, film: &Film, seconds: f64) -> Result<bool, Failure> {
        let Some(every) = self.every else { return Ok(false) };
        self.about["seconds"] = json!(self.before + seconds);
        self.about["time_left"] = json!(self.given.map(|given| (given - seconds).max(0.0)));
        let start = Instant::now();
        let kept = self.write(film).map_err(|error| unwritable(&self.place, &error));
        self.next = Instant::now().checked_add(every.max(start.elapsed() * SHARE));
        kept.map(|()| true)
    }

    fn write(&self, film: &Film) -> io::Result<()> {
        let draft = Draft::begin(&self.place)?;
        let mut to = Hashing { to: BufWriter::new(&draft.file), hash: blake3::Hasher::new() };
        to.write_all(MAGIC)?;
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
        if self.every.is_some() {
            // What is not there need not go.
            let _ = std::fs::remove_file(&self.place);
        }
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let found = text.parse().ok().filter(|s: &f64| (0.0..=MOST_SECONDS).contains(s));
    found.map(Duration::from_secs_f64).ok_or_else(|| "expected seconds, as in 60, or 0".into())
}

/// What two renders may differ by, in the order in which it is told.
const DIFFERENCES: [(&str, &str); 7] = [
    ("luxel", "another version"),
    ("build", "another build of the program"),
    ("seed", "another seed"),
    ("window", "another size or crop"),
    ("scene", "another scene, of one that has been edited since, or of other --set or --aov"),
    ("files", "other textures or meshes"),
    ("libraries", "other plugin libraries"),
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
        let about = json!({ "seed": seed });
        Checkpoint { place, about, every, next: None, before: 0.0, given: None }
    }

    fn film() -> Film {
        Film::new(UVec2::splat(20), Rect::new(UVec2::ZERO, UVec2::splat(20)))
    }

    #[test]
    fn what_was_kept_is_read_and_nothing_else_is_left() {
        let folder = Folder::new("checkpoint");
        let mut kept = checkpoint(&folder, 1);
        assert_eq!((kept.read().unwrap(), kept.left().unwrap()), (None, Left::Nothing));
        assert!(!kept.is_due());
        let confidence = Confidence::new(0.9);
        let asked = Asked { spp: Some(7), error: Some(0.25), confidence, time: Some(4.0) };
        kept.asks(asked, 30.0);
        kept.keep(&film(), 1.5).unwrap();
        assert_eq!(folder.names(), ["a.checkpoint"]);
        let asked = Asked { time: Some(2.5), ..asked };
        assert_eq!(kept.read().unwrap(), Some(Before { film: film(), asked, seconds: 31.5 }));
        assert_eq!(kept.left().unwrap(), Left::Same);
        assert_eq!(checkpoint(&folder, 2).left().unwrap(), Left::Other);
        kept.remove();
        assert!(folder.names().is_empty());
    }

    #[test]
    fn the_next_run_has_what_is_left_of_the_time_or_goes_on_until_the_error_is_reached() {
        let time = |error, time| {
            let mut options = Options::default();
            Asked { error, time, ..Asked::default() }.ask(&mut options);
            (options.goal.error, options.goal.time)
        };
        let half = Some(Duration::from_millis(500));
        assert_eq!(time(None, Some(0.5)), (None, half));
        assert_eq!(time(None, Some(0.0)), (None, Some(Duration::ZERO)));
        assert_eq!(time(Some(0.25), Some(0.5)), (Some(0.25), half));
        assert_eq!(time(Some(0.25), Some(0.0)), (Some(0.25), None));
        assert_eq!(time(Some(0.25), None), (Some(0.25), None));
    }

    #[test]
    fn checkpoints_are_missed_where_they_are_asked_for_or_the_picture_takes_long() {
        let missed = |every: Option<u64>, goal| {
            let every = every.map(Duration::from_secs);
            CheckpointArgs { resume: false, every }.are_missed(goal)
        };
        let time = |seconds| Goal { time: Some(Duration::from_secs(seconds)), ..Goal::default() };
        let error = Goal { error: Some(0.01), ..Goal::default() };
        assert!(missed(None, time(60)) && missed(None, error) && missed(Some(5), Goal::default()));
        assert!(
            !missed(None, Goal::default()) && !missed(None, time(59)) && !missed(Some(0), error)
        );
    }

    #[test]
    fn one_of_another_build_is_refused_and_one_of_before_builds_had_names() {
        let folder = Folder::new("checkpoint-build");
        let of = |about: Value| Checkpoint { about, ..checkpoint(&folder, 1) };
        let build = |build: &str| json!({ "seed": 1, "luxel": "0.1.0", "build": build });
        for before in [build("0123456789abcdef"), json!({ "seed": 1, "luxel": "0.1.0" })] {
            of(before).keep(&film(), 1.0).unwrap();
            let now = of(build("fedcba9876543210"));
            let why = now.read().unwrap_err().message;
            assert!(why.ends_with("it is of another build of the program"), "{why}");
            assert_eq!(now.left().unwrap(), Left::Other);
        }
        of(build("fedcba9876543210")).keep(&film(), 1.0).unwrap();
        assert!(of(build("fedcba9876543210")).read().unwrap().is_some());
    }

    #[test]
    fn another_picture_and_a_damaged_file_are_refused() {
        let folder = Folder::new("checkpoint-bad");
        let mut kept = checkpoint(&folder, 1);
        kept.keep(&film(), 1.0).unwrap();
        let why = |checkpoint: &Checkpoint| checkpoint.read().unwrap_err().message;
        assert!(why(&checkpoint(&folder, 2)).ends_with("it is of another seed"));
        #[expect(clippy::disallowed_methods, reason = "tests look at files")]
        let mut bytes = std::fs::read(kept.place()).unwrap();
        bytes[100] ^= 1;
        folder.write("a.checkpoint", &bytes);
        assert!(why(&kept).ends_with("it is damaged"), "{}", why(&kept));
        folder.write("a.checkpoint", b"a diary");
        assert!(kept.left().unwrap_err().message.ends_with("is in the way: no checkpoint"));
        folder.write("b.checkpoint/inside", b"");
        let place = folder.path("b.checkpoint");
        assert!(Checkpoint { place, ..kept }.left().is_err());
    }
}
