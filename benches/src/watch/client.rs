//! `luxel watch --preview` as a program, and a page that looks on, without a browser.

use std::io::{BufRead, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

use serde_json::Value;
use tungstenite::protocol::Role;
use tungstenite::{Bytes, Message, WebSocket};

use crate::process::Luxel;

/// Patience with one message.
const LONGEST: Duration = Duration::from_secs(60);

/// What a page was told, and when it had all of it.
pub(super) struct Told {
    pub(super) at: Instant,
    pub(super) what: What,
}

/// What a page may be told.
#[derive(Debug)]
pub(super) enum What {
    /// A picture of the edit with this number.
    Picture { generation: u64, step: u64 },
    /// The line below the picture.
    Status(String),
    /// So many messages over the picture.
    Problems(usize),
    /// Something else.
    Other,
}

/// The program and its page.
pub(super) struct Watching {
    child: Child,
    told: Receiver<Told>,
}

impl Watching {
    /// Starts the program with a scene and looks on.
    ///
    /// # Errors
    /// It does not start, or serves no page.
    pub(super) fn start(luxel: &Luxel, scene: &Path, more: &[&str]) -> Result<Self, String> {
        let mut command = Command::new(&luxel.program);
        command.args(["watch", "--preview", "--no-open", "--quiet"]).args(more);
        command.arg("-o").arg(scene.with_extension("out")).arg(scene);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| error.to_string())?;
        let said = child.stderr.take().expect("it was asked for");
        let mut said = BufReader::new(said).lines();
        let url = said.find_map(|line| Some(line.ok()?.split_once("preview: ")?.1.to_owned()));
        let mut watching = Self { child, told: mpsc::channel().1 };
        let url = url.ok_or("`luxel watch` serves no page")?;
        // What it says later is of no interest, but has to go somewhere.
        std::thread::spawn(move || said.for_each(drop));
        let (sender, told) = mpsc::channel();
        let mut socket = connect(&url)?;
        std::thread::spawn(move || {
            while let Ok(message) = socket.read() {
                let at = Instant::now();
                let what = understood(&message);
                if matches!(what, What::Picture { .. })
                    && socket.send(Message::text("\"drawn\"")).is_err()
                {
                    return;
                }
                if sender.send(Told { at, what }).is_err() {
                    return;
                }
            }
        });
        watching.told = told;
        Ok(watching)
    }

    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }

    /// The next thing told.
    ///
    /// # Errors
    /// The program has ended, or says nothing.
    pub(super) fn next(&self) -> Result<Told, String> {
        self.told.recv_timeout(LONGEST).map_err(|_| "`luxel watch` says nothing".to_owned())
    }

    /// What is told until a moment.
    pub(super) fn until(&self, end: Instant) -> impl Iterator<Item = Told> {
        let next = move || {
            let left = end.saturating_duration_since(Instant::now());
            self.told.recv_timeout(left).ok()
        };
        std::iter::from_fn(next)
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The handshake by hand: the server's `connection: upgrade, close` is none to tungstenite.
fn connect(url: &str) -> Result<WebSocket<TcpStream>, String> {
    let path = url.trim().trim_start_matches("http://").replacen("/?", "/ws?", 1);
    let (address, path) = path.split_once('/').ok_or("no address")?;
    let told = |error: std::io::Error| format!("{address}: {error}");
    let mut stream = TcpStream::connect(address).map_err(told)?;
    stream.set_nodelay(true).map_err(told)?;
    let request = format!(
        "GET /{path} HTTP/1.1\r\nHost: {address}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
    );
    stream.write_all(request.as_bytes()).map_err(told)?;
    let mut answer = vec![];
    while !answer.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte).map_err(told)?;
        answer.extend(byte);
    }
    if !answer.starts_with(b"HTTP/1.1 101 ") {
        return Err(format!("{address}: {}", String::from_utf8_lossy(&answer)));
    }
    Ok(WebSocket::from_raw_socket(stream, Role::Client, None))
}

fn understood(message: &Message) -> What {
    match message {
        Message::Binary(bytes) => picture(bytes).unwrap_or(What::Other),
        Message::Text(text) => serde_json::from_str(text).map_or(What::Other, |said| words(&said)),
        _ => What::Other,
    }
}

fn picture(bytes: &Bytes) -> Option<What> {
    let length = u32::from_le_bytes(bytes.get(4..8)?.try_into().ok()?) as usize;
    let head: Value = serde_json::from_slice(bytes.get(8..8 + length)?).ok()?;
    let number = |name: &str| head[name].as_u64();
    Some(What::Picture { generation: number("generation")?, step: number("step")? })
}

fn words(said: &Value) -> What {
    match (&said["status"], &said["problems"]) {
        (Value::String(status), _) => What::Status(status.clone()),
        (_, Value::Array(problems)) => What::Problems(problems.len()),
        _ => What::Other,
    }
}
