//! Pictures, one after another, until Ctrl-C.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use luxel_core::accel::Watch;
use luxel_core::film::Film;
use luxel_core::render::{Control, Options, Outcome};
use luxel_core::stage::Stage;

use crate::exit::{Exit, Failure};
use crate::interrupt::Guard;
use crate::libraries::Plugins;
use crate::load::Course;
use crate::measure;

/// What Ctrl-C ends: the picture in hand, or the building of a scene.
#[derive(Default)]
struct Stop {
    pressed: AtomicBool,
    control: Mutex<Arc<Control>>,
    watch: Arc<Watch>,
}

impl Stop {
    fn control(&self) -> MutexGuard<'_, Arc<Control>> {
        self.control.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// With what pictures are made.
pub(crate) struct Run {
    pub(crate) plugins: Plugins,
    /// Samples, seed and threads, where the command line says them.
    pub(crate) options: Options,
    /// Keeps an interrupt from what is being written.
    pub(super) guard: Guard,
    stop: Arc<Stop>,
    /// Whether a line tells how far a picture is.
    line: bool,
}

/// What is told of a run that was interrupted.
const INTERRUPTED: &str = "interrupted: what had not been measured by then is not told";

impl Run {
    /// From now on, Ctrl-C ends the picture in hand and begins no other; a later one leaves at once.
    ///
    /// # Errors
    /// If the system refuses to tell of it.
    pub(crate) fn new(plugins: Plugins, options: Options) -> Result<Self, Failure> {
        let stop = Arc::<Stop>::default();
        let heard = stop.clone();
        let guard = Guard::default();
        guard.on_ctrl_c(move || {
            heard.pressed.store(true, Ordering::Relaxed);
            heard.watch.cancel();
            heard.control().cancel();
        })?;
        Ok(Self { plugins, options, guard, stop, line: true })
    }

    /// The same, for whoever tells of its course in another way.
    pub(crate) fn silent(self) -> Self {
        Self { line: false, ..self }
    }

    /// How scenes are read and made ready.
    pub(crate) fn course(&self) -> Course {
        Course { watch: self.stop.watch.clone(), line: true, ..Course::default() }
    }

    /// The failure of what was interrupted, if it was.
    pub(crate) fn interrupted(&self) -> Option<Failure> {
        let pressed = self.stop.pressed.load(Ordering::Relaxed);
        pressed.then(|| Failure::new(Exit::Incomplete, INTERRUPTED))
    }

    /// The whole picture of a stage, or that of a part.
    ///
    /// # Errors
    /// Ctrl-C; a failure in a plugin; what `measure` says.
    pub(crate) fn film(
        &self,
        (name, stage): (&Path, &Stage),
        options: &Options,
    ) -> Result<Film, Failure> {
        let control = Arc::new(Control::default());
        self.stop.control().clone_from(&control);
        // Pressed in between, it has told the one before.
        if let Some(failure) = self.interrupted() {
            return Err(failure);
        }
        let empty = measure::empty(stage, options)?;
        let of = (name, stage);
        let measured = measure::measure(of, empty, options, &control, self.line, &mut |_, _| {})?;
        match measured.outcome {
            Outcome::Complete => Ok(measured.film),
            Outcome::Cancelled => Err(Failure::new(Exit::Incomplete, INTERRUPTED)),
            Outcome::Failed => {
                let told = stage.failures().iter().map(ToString::to_string).collect::<Vec<_>>();
                let message = format!("{}: {}", name.display(), told.join("; "));
                Err(Failure::new(Exit::Input, message))
            }
        }
    }
}
