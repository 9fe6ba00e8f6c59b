//! What there is to be shown: of each topic the latest message, for as many pages as look on.

use std::sync::{Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use serde_json::Value;
use tokio::sync::watch;

/// What a message is about; a new one takes the place of the last of its topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Topic {
    Title,
    Status,
    Problems,
    Params,
    Camera,
    Pixel,
    PictureA,
    PictureB,
}

impl Topic {
    /// In the order in which a page that has just come is told.
    pub(super) const ALL: [Self; 8] = [
        Self::Title,
        Self::Status,
        Self::Problems,
        Self::Params,
        Self::Camera,
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
    notes: Mutex<[(u64, Bytes); Topic::ALL.len()]>,
    changed: watch::Sender<u64>,
}

impl Board {
    pub(super) fn new() -> Self {
        Self { notes: Mutex::default(), changed: watch::Sender::new(0) }
    }

    fn notes(&self) -> MutexGuard<'_, [(u64, Bytes); Topic::ALL.len()]> {
        self.notes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts up a message.
    pub(super) fn pin(&self, topic: Topic, bytes: Bytes) {
        let mut notes = self.notes();
        self.changed.send_modify(|number| {
            *number += 1;
            notes[topic as usize] = (*number, bytes);
        });
    }

    /// Puts up a message in words.
    pub(super) fn tell(&self, topic: Topic, message: &Value) {
        self.pin(topic, message.to_string().into());
    }

    /// The message of this topic if it is later than number `than`.
    pub(super) fn later(&self, topic: Topic, than: u64) -> Option<(u64, Bytes)> {
        let (number, bytes) = &self.notes()[topic as usize];
        (*number > than).then(|| (*number, bytes.clone()))
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
        board.pin(Topic::PictureA, Bytes::from_static(b"one"));
        board.pin(Topic::PictureA, Bytes::from_static(b"two"));
        board.pin(Topic::Status, Bytes::from_static(b"busy"));
        let (number, bytes) = board.later(Topic::PictureA, 0).unwrap();
        assert_eq!(&bytes[..], b"two");
        assert!(board.later(Topic::PictureA, number).is_none());
        assert_eq!(&board.later(Topic::Status, 0).unwrap().1[..], b"busy");
    }
}
