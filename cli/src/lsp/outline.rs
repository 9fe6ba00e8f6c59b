//! The outline of a file, put into words beside the edits: one of a large file takes longer than a
//! letter may wait. An edit of the file gives it up; the client asks again.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, JoinHandle};

use luxel_lang::editor::{Document, Entry, EntryKind, outline};
use serde::Serialize;
use serde_json::Value;

use super::convert::Encoding;
use super::queue::Queue;
use super::wire::{Code, Refusal, respond};
use crate::exit::blaming;

/// A request for an outline.
pub(super) struct Asked {
    pub(super) id: Value,
    pub(super) path: PathBuf,
    pub(super) uri: String,
    pub(super) document: Arc<Document>,
    pub(super) encoding: Encoding,
    /// The client shows a tree.
    pub(super) is_tree: bool,
    /// Whether the client takes the request back.
    pub(super) cancelled: Arc<AtomicBool>,
    pub(super) queue: Arc<Queue>,
}

/// Outlines that are being made.
#[derive(Default)]
pub(super) struct Outlines(Vec<Running>);

struct Running {
    path: PathBuf,
    outdated: Arc<AtomicBool>,
    /// Hears that the text is not looked at any more: its other end is gone.
    is_read: Receiver<()>,
    thread: JoinHandle<()>,
}

impl Outlines {
    /// Answers beside what comes next.
    ///
    /// # Errors
    /// If there is no thread for it; it is not answered then.
    pub(super) fn begin(&mut self, asked: Asked) -> Result<(), Refusal> {
        self.0.retain(|running| !running.thread.is_finished());
        let (path, outdated) = (asked.path.clone(), Arc::new(AtomicBool::new(false)));
        let (reading, is_read) = channel();
        let told = outdated.clone();
        let thread = Builder::new().name("outline".to_owned());
        let refused =
            |error| Refusal::new(Code::Internal, format!("no thread can be had: {error}"));
        let thread = thread.spawn(move || asked.answer(&told, reading)).map_err(refused)?;
        self.0.push(Running { path, outdated, is_read, thread });
        Ok(())
    }

    /// Gives up those of a file that changes; its text is not held any more.
    pub(super) fn give_up(&self, path: &Path) {
        for running in self.0.iter().filter(|running| running.path == path) {
            running.outdated.store(true, Ordering::Relaxed);
            // Nothing is ever sent: this waits for the end of reading.
            let _ = running.is_read.recv();
        }
    }

    /// Waits until all are answered.
    pub(super) fn end(&mut self) {
        for running in self.0.drain(..) {
            // What went wrong there was answered there.
            let _ = running.thread.join();
        }
    }
}

impl Asked {
    fn answer(self, outdated: &AtomicBool, reading: Sender<()>) {
        let Self { id, uri, document, encoding, is_tree, cancelled, queue, .. } = self;
        let stop = || cancelled.load(Ordering::Relaxed) || outdated.load(Ordering::Relaxed);
        let words = Words { document: &document, encoding, stop: &stop };
        let rows = blaming("", || {
            let entries = outline(&document, &stop);
            if is_tree { Rows::Tree(words.rows(entries)) } else { words.flat(entries, &uri) }
        });
        drop((document, reading));
        queue.end(&id);
        let answer = if outdated.load(Ordering::Relaxed) {
            Err(Refusal::new(Code::ContentModified, "the file has changed"))
        } else if cancelled.load(Ordering::Relaxed) {
            Err(Refusal::new(Code::Cancelled, "the request was cancelled"))
        } else {
            rows.map_err(|failure| Refusal::new(Code::Internal, failure.message))
        };
        // A client that cannot be told has gone, which the next event says.
        let _ = respond(&id, answer);
    }
}

/// An outline as the protocol writes it.
#[derive(Serialize)]
#[serde(untagged)]
enum Rows<'a> {
    Tree(Vec<Row>),
    List(Vec<Symbol<'a>>),
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Row {
    name: String,
    detail: String,
    kind: u8,
    range: Lines,
    selection_range: Lines,
    children: Vec<Row>,
}

#[derive(Serialize)]
struct Symbol<'a> {
    name: String,
    kind: u8,
    location: Location<'a>,
}

#[derive(Serialize)]
struct Location<'a> {
    uri: &'a str,
    range: Lines,
}

#[derive(Serialize)]
struct Lines {
    start: Position,
    end: Position,
}

#[derive(Serialize)]
struct Position {
    line: usize,
    character: usize,
}

/// What puts entries into words.
struct Words<'a> {
    document: &'a Document,
    encoding: Encoding,
    stop: &'a dyn Fn() -> bool,
}

impl Words<'_> {
    fn rows(&self, entries: Vec<Entry>) -> Vec<Row> {
        let wanted = entries.into_iter().take_while(|_| !(self.stop)());
        let row = |entry: Entry| Row {
            kind: kind(entry.kind),
            range: self.lines(&entry.range),
            selection_range: self.lines(&entry.selection),
            name: entry.name,
            detail: entry.detail,
            children: self.rows(entry.children),
        };
        wanted.map(row).collect()
    }

    fn flat<'a>(&self, entries: Vec<Entry>, uri: &'a str) -> Rows<'a> {
        let mut out = vec![];
        self.flatten(entries, uri, &mut out);
        Rows::List(out)
    }

    fn flatten<'a>(&self, entries: Vec<Entry>, uri: &'a str, out: &mut Vec<Symbol<'a>>) {
        for entry in entries.into_iter().take_while(|_| !(self.stop)()) {
            let location = Location { uri, range: self.lines(&entry.range) };
            out.push(Symbol { name: entry.name, kind: kind(entry.kind), location });
            self.flatten(entry.children, uri, out);
        }
    }

    fn lines(&self, range: &Range<usize>) -> Lines {
        let position = |byte| {
            let (line, character) = self.encoding.place(self.document, byte);
            Position { line, character }
        };
        Lines { start: position(range.start), end: position(range.end) }
    }
}

fn kind(kind: EntryKind) -> u8 {
    match kind {
        EntryKind::Name => 13,
        EntryKind::Param => 14,
        EntryKind::Function => 12,
        EntryKind::File => 1,
        EntryKind::Object => 19,
        EntryKind::Block => 3,
    }
}
