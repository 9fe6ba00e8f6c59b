//! What there is to be shown: of each topic the latest message, for as many pages as look on.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::body::Bytes;
use serde_json::Value;
use tokio::sync::watch;
use tokio::time::Instant;

/// What a message is about; a new one takes the place of the last of its topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Topic {
    Title,
    Status,
    Problems,
    Params,
    Camera,
    Layers,
    Pixel,
    PictureA,
    PictureB,
}

impl Topic {
    /// In the order in which a page that has just come is told.
    pub(super) const ALL: [Self; 9] = [
        Self::Title,
        Self::Status,
        Self::Problems,
        Self::Params,
        Self::Camera,
        Self::Layers,
        Self::Pixel,
        Self::PictureA,
        Self::PictureB,
    ];

    /// Whether its messages are large and wait for the page to have drawn the last.
    pub(super) fn is_picture(self) -> bool {
        matches!(self, Self::PictureA | Self::PictureB)
    }
}

/// The latest message of each topic with its number, which grows.
pub(super) struct Board {
    notes: Mutex<[Note; Topic::ALL.len()]>,
    changed: watch::Sender<u64>,
    /// From when on better pictures of an edit are shown again.
    better_from: Mutex<Instant>,
}

#[derive(Default)]
struct Note {
    number: u64,
    bytes: Bytes,
    /// Of pictures, that of the edit that they show, and the number of its first one.
    generation: u64,
    first: u64,
}

/// A message that a page has not been told.
pub(super) struct News {
    pub(super) number: u64,
    pub(super) bytes: Bytes,
    /// Whether the page has no picture of this edit yet.
    pub(super) is_first: bool,
}

impl Board {
    pub(super) fn new() -> Self {
        let better_from = Mutex::new(Instant::now());
        Self { notes: Mutex::default(), changed: watch::Sender::new(0), better_from }
    }

    fn notes(&self) -> MutexGuard<'_, [Note; Topic::ALL.len()]> {
        self.notes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts up a picture of an edit, or another message of one topic.
    pub(super) fn pin(&self, topic: Topic, generation: u64, bytes: Bytes) {
        self.change(topic, |note| {
            let is_first = note.number == 0 || note.generation != generation;
            Some((generation, is_first, bytes))
        });
    }

    /// Puts up another form of the last message of its topic, if there is one.
    pub(super) fn alter(&self, topic: Topic, form: impl FnOnce(&[u8]) -> Option<Bytes>) {
        self.change(topic, |note| Some((note.generation, false, form(&note.bytes)?)));
    }

    /// The next message of a topic: its generation, whether it is the first of that, its bytes.
    fn change(&self, topic: Topic, next: impl FnOnce(&Note) -> Option<(u64, bool, Bytes)>) {
        let mut notes = self.notes();
        let note = &mut notes[topic as usize];
        let Some((generation, is_first, bytes)) = next(note) else { return };
        self.changed.send_modify(|number| {
            *number += 1;
            let first = if is_first { *number } else { note.first };
            *note = Note { number: *number, bytes, generation, first };
        });
    }

    /// Puts up a message in words.
    pub(super) fn tell(&self, topic: Topic, message: &Value) {
        self.pin(topic, 0, message.to_string().into());
    }

    /// The message of this topic if it is later than number `than`.
    pub(super) fn later(&self, topic: Topic, than: u64) -> Option<News> {
        let Note { number, bytes, first, .. } = &self.notes()[topic as usize];
        let news = || News { number: *number, bytes: bytes.clone(), is_first: *first > than };
        (*number > than).then(news)
    }

    /// Another edit is on its way: better pictures of the last wait so long, and leave it the machine.
    pub(super) fn expect(&self, patience: Duration) {
        *self.lock_better() = Instant::now() + patience;
    }

    /// From when on better pictures of an edit are shown.
    pub(super) fn better_from(&self) -> Instant {
        *self.lock_better()
    }

    fn lock_better(&self) -> MutexGuard<'_, Instant> {
        self.better_from.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether anybody is told of changes.
    pub(super) fn is_watched(&self) -> bool {
        self.changed.receiver_count() > 0
    }

    /// Tells of every change from now on.
    pub(super) fn subscribe(&self) -> watch::Receiver<u64> {
        self.changed.subscribe()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_message_of_a_topic_wins_and_is_told_once() {
        let board = Board::new();
        assert!(board.later(Topic::PictureA, 0).is_none());
        board.pin(Topic::PictureA, 1, Bytes::from_static(b"one"));
        board.pin(Topic::PictureA, 1, Bytes::from_static(b"two"));
        board.tell(Topic::Status, &"busy".into());
        let news = board.later(Topic::PictureA, 0).unwrap();
        assert_eq!(&news.bytes[..], b"two");
        assert!(board.later(Topic::PictureA, news.number).is_none());
        assert_eq!(&board.later(Topic::Status, 0).unwrap().bytes[..], b"\"busy\"");
    }

    #[test]
    fn a_page_is_told_what_is_its_first_picture_of_an_edit() {
        let board = Board::new();
        let pin = |generation| board.pin(Topic::PictureA, generation, Bytes::new());
        let news = |than| board.later(Topic::PictureA, than).unwrap();
        pin(1);
        let one = news(0);
        assert!(one.is_first);
        pin(1);
        assert!(!news(one.number).is_first);
        pin(2);
        pin(2);
        // Whoever missed its first has not seen it either.
        assert!(news(one.number).is_first);
        let two = news(0).number;
        pin(2);
        assert!(!news(two).is_first);
    }
}
