//! One page that looks on: pictures at its pace, words at once.

use std::sync::mpsc::SyncSender;
use std::time::Duration;

use axum::body::Bytes;
use axum::extract::ws::{Message, Utf8Bytes, WebSocket};
use serde::Deserialize;
use tokio::time::{Instant, sleep_until, timeout};

use super::board::{Board, Topic};
use super::frame::Side;

/// What a page asks of the program.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Command {
    /// What is known of a pixel; answered with `Preview::pixel`.
    Pixel {
        /// From the upper left of the whole picture.
        at: [u32; 2],
        /// In which picture.
        side: Side,
    },
    /// Another value for a `param` of the scene.
    Set {
        /// Of which.
        name: String,
        /// As `--set` takes it; none takes back what was set here.
        value: Option<String>,
    },
    /// Stands the camera elsewhere.
    Camera {
        /// In the world; none stands it where the file does.
        view: Option<View>,
    },
    /// Every `param` as the file says.
    ResetParams,
    /// Shows a layer of the files.
    Layer {
        /// Its name; none shows colour.
        name: Option<String>,
    },
}

/// Where the camera is to stand, in the world.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct View {
    /// Its place, metres.
    pub(crate) from: [f64; 3],
    /// Straight ahead, metres.
    pub(crate) to: [f64; 3],
    /// Which way is up.
    pub(crate) up: [f64; 3],
    /// How many times as much is to be seen as the file says, of a camera whose rays are parallel; 1
    /// if absent.
    pub(crate) zoom: Option<f64>,
}

/// What a page says.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Said {
    /// The oldest picture that was sent is on the screen, or given up for a later one.
    Drawn,
    Ask(Command),
}

/// Bytes that a page may say at once.
pub(super) const ASKED_BYTES: usize = 4 << 10;
/// Commands that wait for the program; further ones are dropped.
pub(super) const WAITING_COMMANDS: usize = 64;
/// At most ten pictures of an edit a second.
pub(crate) const PACE: Duration = Duration::from_millis(100);
/// A page that takes nothing for so long is given up; tests have less patience.
const PATIENCE: Duration = Duration::from_millis(if cfg!(test) { 500 } else { 30_000 });

/// The pictures that a page has been sent and not drawn yet.
#[derive(Debug, Default)]
struct Drawing {
    n: usize,
    /// Whether the last of them is an edit's first.
    is_first: bool,
}

impl Drawing {
    /// Whether the next may be sent: the first picture of an edit waits for the first of another alone, for
    /// a page gives up better pictures of the edit before.
    fn takes(&self, is_first: bool) -> bool {
        self.n == 0 || is_first && !self.is_first
    }

    fn begin(&mut self, is_first: bool) {
        self.n += 1;
        self.is_first = is_first;
    }

    fn end(&mut self) {
        self.n = self.n.saturating_sub(1);
    }
}

/// Tells the page everything until it goes.
pub(super) async fn run(mut socket: WebSocket, board: &Board, commands: &SyncSender<Command>) {
    let mut changes = board.subscribe();
    let mut told = [0; Topic::ALL.len()];
    let (mut drawing, mut next) = (Drawing::default(), Instant::now());
    loop {
        let _ = changes.borrow_and_update();
        let better = next.max(board.better_from());
        let early = Instant::now() < better;
        for topic in Topic::ALL {
            let Some(news) = board.later(topic, told[topic as usize]) else { continue };
            // Whoever edits waits for the first picture, and for no pace.
            let waits = !drawing.takes(news.is_first) || early && !news.is_first;
            if topic.is_picture() && waits {
                continue;
            }
            if send(&mut socket, topic, news.bytes).await.is_none() {
                return;
            }
            told[topic as usize] = news.number;
            if topic.is_picture() {
                drawing.begin(news.is_first);
                next = Instant::now() + PACE;
            }
        }
        tokio::select! {
            changed = changes.changed() => if changed.is_err() { return },
            () = sleep_until(better), if drawing.takes(false) && early => {}
            said = socket.recv() => match said {
                Some(Ok(Message::Text(text))) => match serde_json::from_str(&text) {
                    Ok(Said::Drawn) => drawing.end(),
                    Ok(Said::Ask(command)) => { let _ = commands.try_send(command); }
                    // Not one of our pages.
                    Err(_) => return,
                },
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                _ => return,
            },
        }
    }
}

/// `None` when the page has gone or takes nothing any more.
async fn send(socket: &mut WebSocket, topic: Topic, bytes: Bytes) -> Option<()> {
    let message = if topic.is_picture() {
        Message::Binary(bytes)
    } else {
        Message::Text(Utf8Bytes::try_from(bytes).ok()?)
    };
    timeout(PATIENCE, socket.send(message)).await.ok()?.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edits_first_picture_waits_for_no_better_one_of_the_edit_before() {
        let mut drawing = Drawing::default();
        assert!(drawing.takes(true) && drawing.takes(false));
        drawing.begin(true);
        assert!(!drawing.takes(true) && !drawing.takes(false));
        drawing.end();
        drawing.begin(false);
        assert!(drawing.takes(true) && !drawing.takes(false));
        drawing.begin(true);
        assert!(!drawing.takes(true) && !drawing.takes(false));
        // The better one is given up, the first is still to be drawn.
        drawing.end();
        assert!(!drawing.takes(true) && !drawing.takes(false));
        drawing.end();
        drawing.end();
        assert!(drawing.takes(true) && drawing.takes(false));
    }

    #[test]
    fn what_a_page_says_is_understood_or_refused() {
        let pixel = r#"{"ask":{"pixel":{"at":[3,4],"side":"b"}}}"#;
        let expected = Command::Pixel { at: [3, 4], side: Side::B };
        let Ok(Said::Ask(command)) = serde_json::from_str(pixel) else { panic!("refused") };
        assert_eq!(command, expected);
        assert!(matches!(serde_json::from_str(r#""drawn""#), Ok(Said::Drawn)));
        let set = r#"{"ask":{"set":{"name":"r","value":"2 m"}}}"#;
        let expected = Command::Set { name: "r".into(), value: Some("2 m".into()) };
        let Ok(Said::Ask(command)) = serde_json::from_str(set) else { panic!("refused") };
        assert_eq!(command, expected);
        let view = r#"{"ask":{"camera":{"view":{"from":[0,1,2.5],"to":[0,0,0],"up":[0,1,0]}}}}"#;
        let Ok(Said::Ask(Command::Camera { view: Some(view) })) = serde_json::from_str(view) else {
            panic!("refused")
        };
        assert!((view.from[2] - 2.5).abs() < 1e-12);
        let back = r#"{"ask":{"camera":{"view":null}}}"#;
        assert!(matches!(
            serde_json::from_str(back),
            Ok(Said::Ask(Command::Camera { view: None }))
        ));
        assert!(matches!(
            serde_json::from_str(r#"{"ask":"reset_params"}"#),
            Ok(Said::Ask(Command::ResetParams))
        ));
        let odd = r#"{"ask":{"camera":{"view":{"from":[0,1],"to":[0,0,0],"up":[0,1,0]}}}}"#;
        for wrong in [
            odd,
            r#"{"ask":{"set":{"name":1}}}"#,
            "",
            "drawn",
            r#"{"ask":{"pixel":{"at":[-1,4],"side":"a"}}}"#,
            "[]",
        ] {
            assert!(serde_json::from_str::<Said>(wrong).is_err(), "{wrong}");
        }
    }
}
