//! Work that is given up as soon as something else is wanted, whether it looks for that or not.

use std::sync::mpsc::{self, RecvTimeoutError, TryRecvError};
use std::thread::{Scope, ScopedJoinHandle};
use std::time::Duration;

use luxel_core::render::{Courtesy, give_way};

use super::changes::Noticed;
use crate::exit::{Exit, Failure};
use crate::isolate::Beat;

/// So long work that was asked to end is waited for.
const GRACE: Duration = Duration::from_millis(5);

/// Between two looks at work that has to end.
const MOMENT: Duration = Duration::from_millis(1);

/// What came of an attempt.
#[derive(Debug)]
pub(super) enum Ended<T> {
    /// The work is done.
    Done(T),
    /// It was not wanted any more.
    Left(Noticed),
}

/// Work on threads of its own.
pub(super) struct Attempts<'scope, 'env> {
    scope: &'scope Scope<'scope, 'env>,
    beat: Beat,
    /// Whether its threads let others go first.
    courtesy: Option<Courtesy>,
    /// What did not end when it was asked to: a decoder, or a plugin, that does not look. One at most, so
    /// that what nobody wants does not fill the machine.
    left: Option<ScopedJoinHandle<'scope, ()>>,
}

impl<'scope, 'env> Attempts<'scope, 'env> {
    pub(super) fn new(
        scope: &'scope Scope<'scope, 'env>,
        beat: Beat,
        courtesy: Option<Courtesy>,
    ) -> Self {
        Self { scope, beat, courtesy, left: None }
    }

    /// Does some work for as long as `look`, which waits a moment, notices nothing; then `cancel` asks it
    /// to end, and what it gives is of no interest.
    ///
    /// # Errors
    /// Those of the work; one of ours if it ends in a panic.
    pub(super) fn run<T: Send + 'scope>(
        &mut self,
        work: impl FnOnce() -> Result<T, Failure> + Send + 'scope,
        mut look: impl FnMut() -> Noticed,
        cancel: impl FnOnce(),
    ) -> Result<Ended<T>, Failure> {
        let lost = || Failure::new(Exit::Ours, "the scene could not be made ready");
        let (give, take) = mpsc::channel();
        let courtesy = self.courtesy;
        let thread = self.scope.spawn(move || {
            courtesy.into_iter().for_each(give_way);
            // Whoever has left does not take it.
            let _ = give.send(work());
        });
        let noticed = loop {
            match take.try_recv() {
                Ok(done) => return done.map(Ended::Done),
                Err(TryRecvError::Disconnected) => {
                    // The panic has been told.
                    let _ = thread.join();
                    return Err(lost());
                }
                Err(TryRecvError::Empty) => {}
            }
            match look() {
                Noticed::Nothing => {}
                noticed => break noticed,
            }
        };
        cancel();
        if let Err(RecvTimeoutError::Timeout) = take.recv_timeout(GRACE) {
            return Ok(Ended::Left(self.leave(thread, noticed, look)));
        }
        let _ = thread.join();
        Ok(Ended::Left(noticed))
    }

    /// Leaves work to itself. Where there is such already, one of the two has to end first, unless the end
    /// of all is asked for.
    fn leave(
        &mut self,
        thread: ScopedJoinHandle<'scope, ()>,
        mut noticed: Noticed,
        mut look: impl FnMut() -> Noticed,
    ) -> Noticed {
        let both = self.left.take().into_iter().chain([thread]);
        let mut both: Vec<_> = both.filter(|thread| !thread.is_finished()).collect();
        let _waits = (both.len() > 1).then(|| self.beat.overtaken());
        while both.len() > 1 && noticed != Noticed::Stop {
            std::thread::sleep(MOMENT);
            if look() == Noticed::Stop {
                noticed = Noticed::Stop;
            }
            both.retain(|thread| !thread.is_finished());
        }
        self.left = both.pop();
        noticed
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
    use std::thread::sleep;

    use super::*;

    const LONG: Duration = Duration::from_millis(400);

    /// Notices a save at the first look.
    fn save() -> Noticed {
        Noticed::Save
    }

    #[test]
    fn work_that_nothing_comes_between_is_done() {
        std::thread::scope(|scope| {
            let mut attempts = Attempts::new(scope, Beat::silent(), None);
            let ended = attempts.run(
                || {
                    sleep(LONG / 40);
                    Ok(7)
                },
                || {
                    sleep(LONG / 400);
                    Noticed::Nothing
                },
                || panic!("nobody asks it to end"),
            );
            assert!(matches!(ended, Ok(Ended::Done(7))), "{ended:?}");
        });
    }

    #[test]
    fn work_that_does_not_look_is_left_before_it_ends() {
        let ends = AtomicBool::new(false);
        std::thread::scope(|scope| {
            let mut attempts = Attempts::new(scope, Beat::silent(), None);
            let deaf = || {
                while !ends.load(Ordering::SeqCst) {
                    sleep(Duration::from_micros(100));
                }
                Ok(())
            };
            let ended = attempts.run(deaf, save, || {});
            assert!(matches!(ended, Ok(Ended::Left(Noticed::Save))), "{ended:?}");
            assert!(attempts.left.as_ref().is_some_and(|left| !left.is_finished()));
            ends.store(true, Ordering::SeqCst);
        });
    }

    #[test]
    fn two_at_most_go_on_that_do_not_look() {
        let (running, most) = (AtomicU32::new(0), AtomicU32::new(0));
        let deaf = || {
            most.fetch_max(running.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
            sleep(LONG);
            running.fetch_sub(1, Ordering::SeqCst);
            Ok(())
        };
        std::thread::scope(|scope| {
            let mut attempts = Attempts::new(scope, Beat::silent(), None);
            for _ in 0..4 {
                let ended = attempts.run(deaf, save, || {});
                assert!(matches!(ended, Ok(Ended::Left(_))), "{ended:?}");
            }
        });
        assert!(most.into_inner() <= 2);
    }

    #[test]
    fn work_that_looks_ends_when_it_is_asked_to() {
        let asked = AtomicBool::new(false);
        std::thread::scope(|scope| {
            let mut attempts = Attempts::new(scope, Beat::silent(), None);
            let work = || {
                while !asked.load(Ordering::SeqCst) {
                    sleep(Duration::from_micros(100));
                }
                Ok(())
            };
            let ended = attempts.run(work, save, || asked.store(true, Ordering::SeqCst));
            assert!(matches!(ended, Ok(Ended::Left(Noticed::Save))), "{ended:?}");
            assert!(attempts.left.is_none(), "it has ended");
            let ended = attempts.run(
                || -> Result<(), Failure> { panic!("on purpose") },
                || {
                    sleep(LONG / 400);
                    Noticed::Nothing
                },
                || {},
            );
            assert!(matches!(ended, Err(failure) if failure.exit == Exit::Ours));
        });
    }
}
