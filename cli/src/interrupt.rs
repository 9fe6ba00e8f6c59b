//! Ctrl-C: the first one asks for an orderly end, a later one gives up what is not yet saved.
//! A picture that is being written is always finished: no half file, no new EXR beside an old PNG.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use luxel_core::accel::Watch;

use crate::exit::{Exit, Failure};
use crate::report;

/// Interrupts within this time of the first are taken for the same one (a double press, a signal
/// sent to the whole group as well): most renders have ended in order by then.
const SAME: Duration = Duration::from_secs(2);

/// So long a scene that is being made ready has to end in order.
const LEAVE: Duration = Duration::from_millis(200);

/// What is told of a load that was cancelled.
pub(crate) const CANCELLED: &str =
    "interrupted before anything was measured: no picture was written";

/// What interrupts are answered with.
#[derive(Debug)]
struct Words {
    /// Before there is anything to be saved.
    left: &'static str,
    /// While it is being written.
    moment: &'static str,
    /// After it was.
    saved: &'static str,
}

/// Of a command that measures a picture.
const OF_PICTURE: Words = Words {
    left: CANCELLED,
    moment: "the picture is being written: one moment",
    saved: "interrupted again: the picture has been written",
};

/// Of a command that only writes files.
const OF_FILES: Words = Words {
    left: "interrupted: files not yet written are as they were",
    moment: "files are being written: one moment",
    saved: "interrupted again: the files have been written",
};

/// What an interrupt runs.
pub(crate) type Interrupt = Arc<dyn Fn() + Send + Sync>;

/// Whether Ctrl-C has been pressed, from now on; it does nothing else any more.
///
/// # Errors
/// If the system refuses the handler.
pub(crate) fn pressed() -> Result<Arc<AtomicBool>, Failure> {
    let pressed = Arc::new(AtomicBool::new(false));
    let shared = pressed.clone();
    on_each(move || shared.store(true, Ordering::Relaxed))?;
    Ok(pressed)
}

/// Calls `handler` at each Ctrl-C, which does nothing else any more.
///
/// # Errors
/// If the system refuses the handler.
pub(crate) fn on_each(handler: impl Fn() + Send + 'static) -> Result<(), Failure> {
    ctrlc::set_handler(handler)
        .map_err(|error| Failure::new(Exit::Ours, format!("cannot listen for Ctrl-C: {error}")))
}

/// How far the picture has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Phase {
    /// It is in memory only.
    #[default]
    Measuring,
    /// There is nothing of it yet: the scene is being read or made ready.
    Loading,
    /// It is on the disk, or on its way there.
    Saved,
}

/// What an interrupt does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    First,
    Again,
    Wait,
    Leave,
    GiveUp(&'static str),
}

#[derive(Debug)]
struct State {
    words: &'static Words,
    phase: Phase,
    /// Pictures on their way to the disk. The next one may be measured meanwhile.
    writing: usize,
    /// Of the scene that is made ready.
    loading: Arc<Watch>,
    first: Option<Instant>,
}

impl State {
    fn new(words: &'static Words) -> Self {
        Self { words, phase: Phase::default(), writing: 0, loading: Arc::default(), first: None }
    }

    fn answer(&mut self, now: Instant) -> Answer {
        if self.phase == Phase::Loading && self.writing == 0 {
            return Answer::Leave;
        }
        let Some(first) = self.first else {
            self.first = Some(now);
            return Answer::First;
        };
        match self.phase {
            _ if self.writing > 0 => Answer::Wait,
            _ if now.duration_since(first) < SAME => Answer::Again,
            Phase::Measuring | Phase::Loading => Answer::GiveUp(
                "interrupted again: what was measured is lost, the files are as they were",
            ),
            Phase::Saved => Answer::GiveUp(self.words.saved),
        }
    }
}

/// Knows whether a picture is being written, so that no interrupt cuts it in half.
#[derive(Clone, Debug)]
pub(crate) struct Guard(Arc<Mutex<State>>);

impl Default for Guard {
    fn default() -> Self {
        Self::with(&OF_PICTURE)
    }
}

/// While it lives, files are being written; afterwards they are whole.
pub(crate) struct Saving<'a>(&'a Guard);

impl Guard {
    fn with(words: &'static Words) -> Self {
        Self(Arc::new(Mutex::new(State::new(words))))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Of a command that has nothing to save before it writes its files: until then an interrupt leaves
    /// at once, and from then on it waits until they are whole.
    ///
    /// # Errors
    /// If the system refuses the handler.
    pub(crate) fn of_files() -> Result<Self, Failure> {
        let guard = Self::with(&OF_FILES);
        guard.loading(&Arc::default());
        guard.on_ctrl_c(|| report::note(OF_FILES.moment))?;
        Ok(guard)
    }

    /// Another file is about to be read: an interrupt leaves at once again, and one that came while the
    /// file before was written has waited for this.
    ///
    /// # Errors
    /// If there was such an interrupt.
    pub(crate) fn next_file(&self) -> Result<(), Failure> {
        let mut state = self.state();
        state.phase = Phase::Loading;
        match state.first {
            Some(_) => Err(Failure::new(Exit::Incomplete, state.words.left)),
            None => Ok(()),
        }
    }

    /// The picture is about to be written.
    pub(crate) fn saving(&self) -> Saving<'_> {
        let mut state = self.state();
        state.phase = Phase::Saved;
        state.writing += 1;
        Saving(self)
    }

    /// Whether a picture is on its way to the disk.
    pub(crate) fn is_saving(&self) -> bool {
        self.state().writing > 0
    }

    /// Whether the end was asked for.
    pub(crate) fn is_interrupted(&self) -> bool {
        self.state().first.is_some()
    }

    /// A scene is about to be read and made ready, followed by `watch`: there is nothing to be saved.
    pub(crate) fn loading(&self, watch: &Arc<Watch>) {
        let mut state = self.state();
        (state.phase, state.loading) = (Phase::Loading, watch.clone());
    }

    /// The next picture is about to be measured.
    pub(crate) fn measuring(&self) {
        self.state().phase = Phase::Measuring;
    }

    /// Calls `first` at the first interrupt; a later one ends the program with a word on what was
    /// kept, at once or when the picture in hand is written. Termination counts as one. Gives what
    /// does the same as an interrupt.
    ///
    /// # Errors
    /// If the system refuses the handler.
    pub(crate) fn on_ctrl_c(
        &self,
        first: impl Fn() + Send + Sync + 'static,
    ) -> Result<Interrupt, Failure> {
        let guard = self.clone();
        let handler: Interrupt = Arc::new(move || {
            // Held to the end: nothing begins to be written while the program is on its way out.
            let mut state = guard.state();
            match state.answer(Instant::now()) {
                Answer::First => first(),
                Answer::Again => {}
                Answer::Leave => {
                    state.loading.cancel();
                    // Whatever is not reached by it, a plugin perhaps, is left where it is.
                    std::thread::sleep(LEAVE);
                    leave(state.words.left);
                }
                Answer::Wait => report::note(state.words.moment),
                Answer::GiveUp(word) => leave(word),
            }
        });
        let heard = handler.clone();
        on_each(move || heard())?;
        Ok(handler)
    }
}

fn leave(word: &str) -> ! {
    report::note(word);
    #[expect(
        clippy::disallowed_methods,
        clippy::exit,
        reason = "asked for, and nothing is left to save"
    )]
    std::process::exit(Exit::Incomplete as i32)
}

impl Drop for Saving<'_> {
    fn drop(&mut self) {
        self.0.state().writing -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_interrupt_gives_up_only_what_nothing_can_save() {
        let (guard, now) = (Guard::default(), Instant::now());
        let after = |seconds| guard.state().answer(now + Duration::from_secs(seconds));
        let lost = |answer, word| matches!(answer, Answer::GiveUp(said) if said.contains(word));
        assert_eq!(after(0), Answer::First);
        assert_eq!(after(0), Answer::Again);
        assert!(lost(after(2), "lost"));
        let saving = guard.saving();
        assert_eq!(after(0), Answer::Wait);
        assert_eq!(after(9), Answer::Wait);
        drop(saving);
        assert!(lost(after(9), "has been written"));
        guard.measuring();
        assert!(lost(after(9), "lost"));
        guard.loading(&Arc::default());
        assert_eq!(after(0), Answer::Leave);
    }

    #[test]
    fn a_command_that_writes_at_its_end_is_left_before_and_not_while_it_writes() {
        let (guard, now) = (Guard::default(), Instant::now());
        guard.loading(&Arc::default());
        assert_eq!(guard.state().answer(now), Answer::Leave);
        let _whole = guard.saving();
        assert_eq!(guard.state().answer(now), Answer::First);
        assert_eq!(guard.state().answer(now + SAME), Answer::Wait);
    }

    #[test]
    fn between_two_files_a_command_is_left_at_once_and_for_what_came_while_it_wrote() {
        let (guard, now) = (Guard::with(&OF_FILES), Instant::now());
        for _ in 0..2 {
            assert!(guard.next_file().is_ok());
            assert_eq!(guard.state().answer(now), Answer::Leave);
            drop(guard.saving());
        }
        let whole = guard.saving();
        assert_eq!(guard.state().answer(now), Answer::First);
        drop(whole);
        let saved = Answer::GiveUp("interrupted again: the files have been written");
        assert_eq!(guard.state().answer(now + SAME), saved);
        let left = guard.next_file().expect_err("it was interrupted");
        let words = "interrupted: files not yet written are as they were";
        assert_eq!((left.exit, &*left.message), (Exit::Incomplete, words));
        assert_eq!(OF_FILES.moment, "files are being written: one moment");
    }

    #[test]
    fn no_interrupt_gives_up_while_any_picture_is_being_written() {
        let (guard, now) = (Guard::default(), Instant::now());
        let after = |seconds| guard.state().answer(now + Duration::from_secs(seconds));
        assert_eq!(after(0), Answer::First);
        let (one, two) = (guard.saving(), guard.saving());
        guard.measuring();
        drop(one);
        assert_eq!(after(9), Answer::Wait);
        guard.loading(&Arc::default());
        assert_eq!(after(9), Answer::Wait);
        guard.measuring();
        drop(two);
        assert!(matches!(after(9), Answer::GiveUp(word) if word.contains("lost")));
    }
}
