//! What waits to be answered. Who reads may cancel a request that waits, and answers it at once.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use serde_json::Value;

use super::judge::Verdict;
use super::wire::{Code, Refusal, refuse};

/// Something that happened.
pub(super) enum Event {
    /// A message came.
    Message(Value),
    /// Bytes came that are no message.
    Malformed(Refusal),
    /// Scenes were evaluated.
    Judged(Verdict),
    /// No more messages come.
    End,
}

/// Events in order.
#[derive(Default)]
pub(super) struct Queue {
    waiting: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    events: VecDeque<Event>,
    /// Requests that are being answered, and whether they were cancelled.
    current: Vec<(Value, Arc<AtomicBool>)>,
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds an event; that a request is cancelled is seen to at once.
    pub(super) fn put(&self, event: Event) {
        if let Event::Message(message) = &event
            && message["method"] == "$/cancelRequest"
        {
            self.cancel(&message["params"]["id"]);
            return;
        }
        self.lock().events.push_back(event);
        self.changed.notify_one();
    }

    fn cancel(&self, id: &Value) {
        let mut state = self.lock();
        for (_, cancelled) in state.current.iter().filter(|(current, _)| current == id) {
            cancelled.store(true, Ordering::Relaxed);
        }
        let is_it = |event: &Event| match event {
            Event::Message(message) => {
                message.get("method").is_some() && message.get("id") == Some(id)
            }
            _ => false,
        };
        let Some(at) = state.events.iter().position(is_it) else { return };
        state.events.remove(at);
        drop(state);
        let refusal = Refusal::new(Code::Cancelled, "the request was cancelled");
        // A client that cannot be told has gone, which the next event says.
        let _ = refuse(id, refusal);
    }

    /// Waits for the next event.
    pub(super) fn take(&self) -> Event {
        let mut state = self.lock();
        loop {
            if let Some(event) = state.events.pop_front() {
                return event;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Says that a request is being answered; gives what tells that it was cancelled.
    pub(super) fn begin(&self, id: &Value) -> Arc<AtomicBool> {
        let cancelled = Arc::new(AtomicBool::new(false));
        self.lock().current.push((id.clone(), cancelled.clone()));
        cancelled
    }

    /// Says that it is answered.
    pub(super) fn end(&self, id: &Value) {
        let mut state = self.lock();
        if let Some(at) = state.current.iter().position(|(current, _)| current == id) {
            state.current.remove(at);
        }
    }
}
