//! The latest of what one thread has for another: who is slow misses what came between.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// Gives the latest letter to a thread of its own, one after another. Dropped, it waits until the last
/// has been dealt with.
pub(super) struct Mailbox<T> {
    shared: Arc<Shared<T>>,
    thread: Option<JoinHandle<()>>,
}

struct Shared<T> {
    letter: Mutex<Letter<T>>,
    changed: Condvar,
}

struct Letter<T> {
    latest: Option<T>,
    is_last: bool,
}

impl<T: Send + 'static> Mailbox<T> {
    /// From now on `deal` is given the latest letter.
    pub(super) fn new(mut deal: impl FnMut(T) + Send + 'static) -> Self {
        let letter = Mutex::new(Letter { latest: None, is_last: false });
        let shared = Arc::new(Shared { letter, changed: Condvar::new() });
        let its = shared.clone();
        let thread = std::thread::spawn(move || {
            while let Some(letter) = its.take() {
                deal(letter);
            }
        });
        Self { shared, thread: Some(thread) }
    }
}

impl<T> Mailbox<T> {
    /// Nobody wants to know any more what has not been dealt with.
    pub(super) fn clear(&self) {
        self.shared.lock().latest = None;
    }

    /// Takes the place of a letter that has not been dealt with.
    pub(super) fn put(&self, letter: T) {
        self.shared.lock().latest = Some(letter);
        self.shared.changed.notify_one();
    }
}

impl<T> Shared<T> {
    fn lock(&self) -> MutexGuard<'_, Letter<T>> {
        self.letter.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next letter; `None` when there will be none.
    fn take(&self) -> Option<T> {
        let is_waiting = |letter: &mut Letter<T>| letter.latest.is_none() && !letter.is_last;
        let letter = self.changed.wait_while(self.lock(), is_waiting);
        letter.unwrap_or_else(PoisonError::into_inner).latest.take()
    }
}

impl<T> Drop for Mailbox<T> {
    fn drop(&mut self) {
        self.shared.lock().is_last = true;
        self.shared.changed.notify_one();
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    #[test]
    fn who_is_slow_gets_the_latest_and_the_last_is_never_lost() {
        let (dealt, told) = mpsc::channel();
        let (go, wait) = mpsc::channel::<()>();
        let mailbox = Mailbox::new(move |letter: u32| {
            dealt.send(letter).unwrap();
            wait.recv().unwrap();
        });
        mailbox.put(1);
        assert_eq!(told.recv(), Ok(1));
        (2..=9).for_each(|letter| mailbox.put(letter));
        go.send(()).unwrap();
        go.send(()).unwrap();
        drop(mailbox);
        assert_eq!(told.iter().collect::<Vec<_>>(), [9]);
    }
}
