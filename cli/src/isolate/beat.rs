//! What the child tells its parent, and how it hears from it.

use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use luxel_core::accel::Watch;
use luxel_core::render::Control;
use serde::{Deserialize, Serialize};

use super::again::{Address, Again};
use crate::exit::Exit;
use crate::files::{Asked, Watched};
use crate::interrupt::Interrupt;

/// What is being done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// Nothing yet.
    #[default]
    Starting,
    /// Libraries are looked for and opened.
    Opening,
    /// The scene is read.
    Loading,
    /// It is made ready to trace.
    Building,
    /// Samples are taken.
    Rendering,
    /// Plugins are judged.
    Judging,
    /// A picture is written: no plugin runs.
    Saving,
    /// There is nothing to do before a save.
    Waiting,
    /// All is done, the process is about to end.
    Ended,
}

impl Phase {
    /// As in "while …".
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Starting => "starting",
            Self::Opening => "opening plugin libraries",
            Self::Loading => "loading the scene",
            Self::Building => "building the scene",
            Self::Rendering => "rendering",
            Self::Judging => "judging plugins",
            Self::Saving => "writing the picture",
            Self::Waiting => "waiting for a save",
            Self::Ended => "ending",
        }
    }
}

/// How far a child has come.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Told {
    pub(super) phase: Phase,
    pub(super) samples: u64,
    /// Primitives that are in their place in the tree being built.
    pub(super) built: u64,
    /// Libraries that were opened, for people.
    pub(super) libraries: Vec<String>,
    /// Files that were asked for, with the hash of what was found. Names that are no Unicode are
    /// left out.
    pub(super) files: Vec<(String, Option<String>)>,
    /// Where its page is served.
    pub(super) page: Option<Address>,
    /// Nobody wants any more what is being done, and it has to end before anything else is.
    pub(super) is_overtaken: bool,
}

/// How far the work has come, for the process that watches over it; silent where there is none.
#[derive(Clone, Default)]
pub(crate) struct Beat(Option<Arc<Inner>>);

struct Inner {
    folder: PathBuf,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    told: Told,
    /// What was written last.
    written: Option<Told>,
    watched: Watched,
    asked: Option<Asked>,
    watch: Option<Arc<Watch>>,
    control: Option<Arc<Control>>,
    interrupt: Option<Interrupt>,
}

/// Between two reports.
const PERIOD: Duration = Duration::from_millis(200);

/// For leaving in order once the parent is gone; a library may hang even there.
const LEAVE: Duration = Duration::from_secs(2);

impl Beat {
    /// Nobody listens.
    pub(crate) fn silent() -> Self {
        Self(None)
    }

    /// Whether nobody listens.
    pub(crate) fn is_silent(&self) -> bool {
        self.0.is_none()
    }

    /// Tells the parent, which reads in this folder, and obeys it.
    pub(super) fn to_parent(folder: PathBuf) -> Self {
        let inner = Arc::new(Inner { folder, state: Mutex::default() });
        let (beating, listening) = (inner.clone(), inner.clone());
        std::thread::spawn(move || {
            loop {
                beating.tell(|_| {});
                std::thread::sleep(PERIOD);
            }
        });
        std::thread::spawn(move || listening.listen());
        Self(Some(inner))
    }

    /// What comes next.
    pub(crate) fn phase(&self, phase: Phase) {
        self.tell(|state| state.told.phase = phase);
    }

    /// These libraries are open, and these files decide about it.
    pub(crate) fn opened(&self, libraries: Vec<String>, watched: &Watched) {
        self.tell(|state| {
            state.told.libraries = libraries;
            state.watched.clone_from(watched);
        });
    }

    /// Files are asked for here from now on.
    pub(crate) fn reading(&self, asked: &Asked) {
        self.tell(|state| state.asked = Some(asked.clone()));
    }

    /// The scene is made ready to trace, followed here.
    pub(crate) fn building(&self, watch: &Arc<Watch>) {
        self.tell(|state| {
            state.told.phase = Phase::Building;
            state.watch = Some(watch.clone());
        });
    }

    /// Samples are counted here from now on.
    pub(crate) fn rendering(&self, control: &Arc<Control>) {
        self.tell(|state| state.control = Some(control.clone()));
    }

    /// The page is served here.
    pub(crate) fn serves(&self, page: &Address) {
        self.tell(|state| state.told.page = Some(page.clone()));
    }

    /// What a child before this one has left.
    pub(crate) fn again(&self) -> Option<Again> {
        let inner = self.0.as_ref()?;
        let bytes = crate::files::read_regular(&inner.folder.join(AGAIN)).ok()?;
        serde_json::from_slice(&bytes).ok()
    }

    /// Tells until dropped that what is being done has to end, for nobody wants it any more.
    pub(crate) fn overtaken(&self) -> impl Drop + use<> {
        struct Until(Beat);
        impl Drop for Until {
            fn drop(&mut self) {
                self.0.tell(|state| state.told.is_overtaken = false);
            }
        }
        self.tell(|state| state.told.is_overtaken = true);
        Until(self.clone())
    }

    /// This answers a wish to stop.
    pub(crate) fn on_stop(&self, interrupt: Interrupt) {
        self.tell(|state| state.interrupt = Some(interrupt));
    }

    /// Tells the end when dropped, also by a panic.
    pub(crate) fn until_the_end(&self) -> impl Drop {
        struct End(Beat);
        impl Drop for End {
            fn drop(&mut self) {
                self.0.phase(Phase::Ended);
            }
        }
        End(self.clone())
    }

    fn tell(&self, change: impl FnOnce(&mut State)) {
        if let Some(inner) = &self.0 {
            inner.tell(change);
        }
    }
}

impl Inner {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes what has changed. What cannot be written now is written later.
    fn tell(&self, change: impl FnOnce(&mut State)) {
        let mut state = self.state();
        change(&mut state);
        state.refresh();
        if state.written.as_ref() != Some(&state.told)
            && write(&self.folder, FILE, &state.told).is_ok()
        {
            state.written = Some(state.told.clone());
        }
    }

    /// A byte asks for an end; the end of the pipe means that nobody waits any more.
    fn listen(&self) {
        let mut byte = [0];
        while let Ok(1) = io::stdin().read(&mut byte) {
            let interrupt = self.state().interrupt.clone();
            match interrupt {
                Some(interrupt) => interrupt(),
                // There is nothing yet that would be worth an orderly end.
                None => leave(),
            }
        }
        while self.state().told.phase == Phase::Saving {
            std::thread::sleep(Duration::from_millis(10));
        }
        leave();
    }
}

fn leave() -> ! {
    std::thread::spawn(|| {
        std::thread::sleep(LEAVE);
        std::process::abort();
    });
    #[expect(
        clippy::disallowed_methods,
        clippy::exit,
        reason = "asked for by the parent, or alone"
    )]
    std::process::exit(Exit::Incomplete as i32)
}

impl State {
    fn refresh(&mut self) {
        if let Some(control) = &self.control {
            self.told.samples = control.samples_done();
        }
        if let Some(watch) = &self.watch {
            self.told.built = watch.standing().done;
        }
        let mut all = self.watched.clone();
        if let Some(asked) = &self.asked {
            all.extend(asked.lock().unwrap_or_else(PoisonError::into_inner).clone());
        }
        let named = all.into_iter().filter_map(|(path, seen)| {
            Some((path.to_str()?.to_owned(), seen.map(|hash| hash.to_hex().to_string())))
        });
        self.told.files = named.collect();
    }
}

const FILE: &str = "beat.json";

/// What the child before has left.
const AGAIN: &str = "again.json";

/// Leaves for the child of this folder what one before it has left.
pub(super) fn leave_to(folder: &Path, again: &Again) -> io::Result<()> {
    write(folder, AGAIN, again)
}

/// The file appears whole.
fn write(folder: &Path, name: &str, value: &impl Serialize) -> io::Result<()> {
    let draft = folder.join("draft");
    let mut file = fs::OpenOptions::new().write(true).create(true).truncate(true).open(&draft)?;
    file.write_all(&serde_json::to_vec(value)?)?;
    drop(file);
    fs::rename(draft, folder.join(name))
}

/// What a child told last in this folder.
pub(super) fn read(folder: &Path) -> Option<Told> {
    let bytes = crate::files::read_regular(&folder.join(FILE)).ok()?;
    serde_json::from_slice(&bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_is_read_again_and_the_end_is_told_by_dropping() {
        let folder = tempfile::tempdir().unwrap();
        let inner = Inner { folder: folder.path().into(), state: Mutex::default() };
        let beat = Beat(Some(Arc::new(inner)));
        let watched = Watched::from([("a".into(), None), ("b".into(), Some(blake3::hash(b"b")))]);
        beat.opened(vec!["crash 0.1.0".into()], &watched);
        let end = beat.until_the_end();
        beat.phase(Phase::Building);
        let told = read(folder.path()).unwrap();
        assert_eq!((told.phase, told.libraries), (Phase::Building, vec!["crash 0.1.0".to_owned()]));
        assert_eq!(told.files[1].1, Some(blake3::hash(b"b").to_hex().to_string()));
        drop(end);
        assert_eq!(read(folder.path()).unwrap().phase, Phase::Ended);
    }
}
