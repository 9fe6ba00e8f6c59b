//! The preview: a page on this machine that shows a picture as it was measured, in linear floats.
//!
//! What is here serves and tells; what exposes, compares and inspects is the page itself (`page/`).
//! Nobody but the browser of whoever holds the address gets an answer (`guard`).

mod args;
mod assets;
#[cfg(test)]
mod attacks;
mod board;
mod browser;
mod editor;
mod exact;
mod frame;
mod guard;
mod offer;
mod problem;
mod server;
mod session;

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver};
use std::thread::JoinHandle;

use luxel_core::stage;
use serde_json::json;
use tempfile::NamedTempFile;
use tokio::sync::oneshot;

use crate::exit::{Exit, Failure};
use crate::isolate::Address;
use board::{Board, Topic};
use guard::Gate;

pub(crate) use args::{EditorArgs, PageArgs};
pub(crate) use editor::Editor;
pub(crate) use exact::{Exact, told};
pub(crate) use frame::{Frame, Pixels, Side};
pub(crate) use offer::{Camera, Field, Param};
pub(crate) use problem::Problem;
pub(crate) use session::{Command, PACE, View};

/// What is known of one pixel beyond the picture: the answer to `Command::Pixel`.
#[derive(Clone, Debug, Default)]
pub(crate) struct PixelReply {
    /// The pixel, from the upper left of the whole picture.
    pub(crate) at: glam::UVec2,
    /// Which picture it belongs to.
    pub(crate) side: Side,
    /// Names and values in reading order: exact radiance, material, depth, normal, `file:line:column`.
    pub(crate) facts: Vec<(String, String)>,
    /// Of facts that are written somewhere: their name, `file:line:column`, and what opens that in
    /// an editor.
    pub(crate) places: Vec<(String, String, Option<String>)>,
}

/// What is on the page, for whoever has something to show, on any thread.
#[derive(Clone)]
pub(crate) struct Screen(Arc<Board>);

/// A page being served from a thread of its own. Dropped, the server ends.
pub(crate) struct Preview {
    address: Address,
    screen: Screen,
    commands: Receiver<Command>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
    /// Leads the browser to the page.
    leading: Option<NamedTempFile>,
}

impl Preview {
    /// Serves the page about a file on the loopback address from now on, in the place of an earlier one
    /// if there is one.
    ///
    /// # Errors
    /// A port that is taken; a system without threads or random numbers.
    pub(crate) fn start(
        args: &PageArgs,
        title: &str,
        again: Option<&Address>,
    ) -> Result<Self, Failure> {
        let port = again.map_or(args.port, |again| again.port);
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let taken = |error: std::io::Error| {
            let message = format!("cannot serve the preview on {address}: {error}");
            Failure::new(Exit::Input, message).help("another port: --port N, or 0 for any")
        };
        let listener = TcpListener::bind(address).map_err(taken)?;
        listener.set_nonblocking(true).map_err(taken)?;
        let port = listener.local_addr().map_err(taken)?.port();
        let token = match again {
            Some(again) => again.token.clone(),
            None => guard::token()?,
        };
        let gate = Gate::new(port, token.clone(), &args.allow_host)?;
        let address = Address { port, token };
        let board = Arc::new(Board::new());
        board.tell(Topic::Title, &json!({ "title": title }));
        let (sender, commands) = mpsc::sync_channel(session::WAITING_COMMANDS);
        let (stop, stopped) = oneshot::channel();
        let state = server::State::new(gate, board.clone(), sender);
        let thread = std::thread::Builder::new()
            .name("preview".into())
            .spawn(move || server::run(listener, state, stopped))
            .map_err(taken)?;
        let (screen, stop, thread) = (Screen(board), Some(stop), Some(thread));
        Ok(Self { address, screen, commands, stop, thread, leading: None })
    }

    /// Asks the desktop to show the page, where there is one.
    pub(crate) fn open(&mut self) {
        self.leading = browser::open(&self.url());
    }

    /// The page's address; whoever knows it sees the picture.
    pub(crate) fn url(&self) -> String {
        let Address { port, token } = &self.address;
        format!("http://127.0.0.1:{port}/?token={token}")
    }

    /// What its address is made of.
    pub(crate) fn address(&self) -> &Address {
        &self.address
    }

    /// Where pictures and words go.
    pub(crate) fn screen(&self) -> &Screen {
        &self.screen
    }

    /// What the page asks for. Commands that nobody takes are dropped once a few wait.
    pub(crate) fn commands(&self) -> &Receiver<Command> {
        &self.commands
    }
}

impl Screen {
    /// Whether a page looks on.
    pub(crate) fn is_watched(&self) -> bool {
        self.0.is_watched()
    }

    /// Shows a picture in place of the last one of its side. Pages that are slow miss those between.
    pub(crate) fn show(&self, frame: &Frame) {
        self.0.pin(frame.side.topic(), frame.generation, frame.encode().into());
    }

    /// Shows the last picture as a film wants it shown now.
    pub(crate) fn shown_as(&self, settings: &stage::Film) {
        self.0.alter(Side::A.topic(), |picture| frame::shown_as(picture, settings).map(Into::into));
    }

    /// Lays messages over the last good picture; none takes them away.
    pub(crate) fn problems(&self, problems: &[Problem]) {
        self.0.tell(Topic::Problems, &json!({ "problems": problems }));
    }

    /// Another edit is on its way: better pictures of the last wait a moment.
    pub(crate) fn expect(&self) {
        self.0.expect(PACE);
    }

    /// One line below the picture: what changed, samples, time left.
    pub(crate) fn status(&self, text: &str) {
        self.0.tell(Topic::Status, &json!({ "status": text }));
    }

    /// Answers the last question for a pixel.
    pub(crate) fn pixel(&self, reply: &PixelReply) {
        let PixelReply { at, side, facts, places } = reply;
        let at = at.to_array();
        let reply = json!({ "at": at, "side": side, "facts": facts, "places": places });
        self.0.tell(Topic::Pixel, &json!({ "pixel": reply }));
    }

    /// Offers what may be set, and says how a command line sets what is set now.
    pub(crate) fn params(&self, params: &[Param], line: &str) {
        self.0.tell(Topic::Params, &json!({ "params": params, "line": line }));
    }

    /// Offers the layers of the files, and says which is shown; none shows colour.
    pub(crate) fn layers(&self, names: &[&str], shown: Option<&str>) {
        self.0.tell(Topic::Layers, &json!({ "layers": names, "layer": shown }));
    }

    /// Tells where the camera stands; none cannot be moved.
    pub(crate) fn camera(&self, camera: Option<&Camera>) {
        self.0.tell(Topic::Camera, &json!({ "camera": camera }));
    }
}

impl Drop for Preview {
    fn drop(&mut self) {
        drop((self.stop.take(), self.leading.take()));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
