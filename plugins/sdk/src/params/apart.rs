//! Work that nobody waits for once it is not wanted any more.

use std::fmt;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// Between two looks at whether it is still wanted.
const PATIENCE: Duration = Duration::from_millis(1);

/// Threads that work at this moment.
static BUSY: AtomicUsize = AtomicUsize::new(0);

/// Why work came to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfinished {
    /// It is not wanted any more.
    Unwanted,
    /// There is no thread for it, or it ended in a panic.
    Failed,
}

impl fmt::Display for Unfinished {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unwanted => "it is not wanted any more",
            Self::Failed => "there is no thread that does it",
        })
    }
}

impl std::error::Error for Unfinished {}

/// Does some work on a thread of its own, for as long as `is_wanted` says so, which is asked once a
/// millisecond: for a decoder, or a read, that cannot be stopped.
///
/// Once it is not wanted it is left to come to its end, and a flag that it is given is set, for parts of it
/// that can end earlier. At most as many threads as the machine has cores work so: more wait for one of
/// them. The work must not wait for other such work.
///
/// # Errors
/// Why it came to nothing.
pub fn apart<T: Send + 'static>(
    is_wanted: &dyn Fn() -> bool,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> Result<T, Unfinished> {
    let (busy, is_over) = (Busy::begin(is_wanted)?, Arc::new(AtomicBool::new(false)));
    let ((give, take), own) = (mpsc::channel(), is_over.clone());
    let work = move || {
        let made = work(&own);
        drop(busy);
        // Whoever has left does not take it.
        let _ = give.send(made);
    };
    let named = thread::Builder::new().name("apart".to_owned());
    named.spawn(work).map_err(|_| Unfinished::Failed)?;
    loop {
        match take.recv_timeout(PATIENCE) {
            Ok(made) => return Ok(made),
            Err(RecvTimeoutError::Timeout) if is_wanted() => {}
            Err(RecvTimeoutError::Timeout) => {
                is_over.store(true, Ordering::Relaxed);
                return Err(Unfinished::Unwanted);
            }
            Err(RecvTimeoutError::Disconnected) => return Err(Unfinished::Failed),
        }
    }
}

/// Gives a value's memory back on a thread of its own: many small pieces of it take tens of milliseconds,
/// for which nobody who has given up a load should wait.
pub fn leave<T: Send + 'static>(value: T) {
    // Without a thread it is dropped here.
    let _ = thread::Builder::new().name("leaves".to_owned()).spawn(move || drop(value));
}

/// A thread that works, as one of few.
struct Busy;

impl Busy {
    /// Waits until it may be begun, or is not wanted any more.
    fn begin(is_wanted: &dyn Fn() -> bool) -> Result<Self, Unfinished> {
        let most = thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let one_more = |n: usize| (n < most).then_some(n + 1);
        while BUSY.fetch_update(Ordering::Relaxed, Ordering::Relaxed, one_more).is_err() {
            if !is_wanted() {
                return Err(Unfinished::Unwanted);
            }
            thread::sleep(PATIENCE);
        }
        Ok(Self)
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        BUSY.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;

    const LONG: Duration = Duration::from_secs(60);

    #[test]
    fn what_it_comes_to_is_given() {
        assert_eq!(apart(&|| true, |_| 7), Ok(7));
        assert_eq!(
            apart(&|| true, |_| -> u32 { panic!("as it is meant to") }),
            Err(Unfinished::Failed)
        );
    }

    #[test]
    fn what_is_left_is_dropped_elsewhere() {
        struct Told(mpsc::Sender<thread::ThreadId>);
        impl Drop for Told {
            fn drop(&mut self) {
                self.0.send(thread::current().id()).unwrap();
            }
        }
        let (give, take) = mpsc::channel();
        leave(Told(give));
        assert_ne!(take.recv_timeout(LONG).unwrap(), thread::current().id());
    }

    #[test]
    fn work_that_does_not_end_is_left_and_few_go_on_beside() {
        let most = thread::available_parallelism().unwrap().get();
        let is_wanted = Arc::new(AtomicBool::new(true));
        let (begun, told) = <(Arc<AtomicUsize>, Arc<AtomicUsize>)>::default();
        let (release, released) = mpsc::channel::<()>();
        let released = Arc::new(std::sync::Mutex::new(released));
        let one = || {
            let (is_wanted, released) = (is_wanted.clone(), released.clone());
            let (begun, told) = (begun.clone(), told.clone());
            let work = move |is_over: &AtomicBool| {
                begun.fetch_add(1, Ordering::SeqCst);
                // Until the sender is dropped.
                let _ = released.lock().unwrap().recv();
                told.fetch_add(usize::from(is_over.load(Ordering::Relaxed)), Ordering::SeqCst);
            };
            thread::spawn(move || apart(&|| is_wanted.load(Ordering::SeqCst), work))
        };
        let all: Vec<_> = (0..most + 2).map(|_| one()).collect();
        let since = Instant::now();
        while begun.load(Ordering::SeqCst) < most {
            assert!(since.elapsed() < LONG, "they are not begun");
            thread::sleep(PATIENCE);
        }
        assert!(all.iter().all(|one| !one.is_finished()));
        is_wanted.store(false, Ordering::SeqCst);
        for one in all {
            assert_eq!(one.join().unwrap(), Err(Unfinished::Unwanted));
        }
        assert_eq!(begun.load(Ordering::SeqCst), most, "more were begun");
        drop(release);
        while Arc::strong_count(&begun) > 1 {
            assert!(since.elapsed() < LONG, "they do not end");
            thread::sleep(PATIENCE);
        }
        assert_eq!(told.load(Ordering::SeqCst), most);
    }
}
