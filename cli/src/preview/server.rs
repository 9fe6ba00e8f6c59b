//! The server: one thread, a few connections, small requests.

use std::collections::VecDeque;
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;
use std::time::Duration;

use axum::Router;
use axum::extract::{Request, State as Shared, WebSocketUpgrade};
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpStream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};
use tokio::task::AbortHandle;

use super::assets::assets;
use super::board::Board;
use super::guard::Gate;
use super::session::{self, Command};

/// Connections at a time: a few windows. Beyond these who has not shown the token yet makes room, who came
/// first before others; who has shown it does not, and more wait.
const CONNECTIONS: usize = 64;
/// A request's head has to arrive within this time, or the connection is closed.
const HEAD: Duration = Duration::from_secs(5);
/// Bytes of a request's head, and what is read ahead.
const HEAD_BYTES: usize = 16 << 10;
/// Between two attempts when the system has no connection to give.
const BREATH: Duration = Duration::from_millis(50);

/// What all connections share.
#[derive(Clone)]
pub(super) struct State {
    gate: Arc<Gate>,
    board: Arc<Board>,
    commands: SyncSender<Command>,
}

impl State {
    pub(super) fn new(gate: Gate, board: Arc<Board>, commands: SyncSender<Command>) -> Self {
        Self { gate: Arc::new(gate), board, commands }
    }
}

/// Serves until `stop` is sent or dropped.
pub(super) fn run(listener: TcpListener, state: State, stop: oneshot::Receiver<()>) {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    // Without a runtime there is no preview; the renderer goes on.
    let Ok(runtime) = runtime else { return };
    runtime.block_on(async {
        tokio::select! {
            () = accept(listener, state) => {}
            _ = stop => {}
        }
    });
    runtime.shutdown_background();
}

async fn accept(listener: TcpListener, state: State) {
    let Ok(listener) = tokio::net::TcpListener::from_std(listener) else { return };
    let app = app(state);
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut strangers = VecDeque::<Stranger>::new();
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(BREATH).await;
            continue;
        };
        strangers.retain(|one| !one.task.is_finished() && !one.is_known.load(Ordering::Relaxed));
        if places.available_permits() == 0 {
            strangers.pop_front().inspect(|first| first.task.abort());
        }
        let Ok(place) = places.clone().acquire_owned().await else { return };
        let visit = Visit { _place: Arc::new(place), is_known: Arc::default() };
        let (app, is_known) = (app.clone(), visit.is_known.clone());
        let task = tokio::spawn(serve(stream, app, visit)).abort_handle();
        strangers.push_back(Stranger { task, is_known });
    }
}

/// A connection that may make room for others.
struct Stranger {
    task: AbortHandle,
    is_known: Arc<AtomicBool>,
}

/// What goes with a connection, as a socket too.
#[derive(Clone)]
struct Visit {
    /// It is free again when the connection ends.
    _place: Arc<OwnedSemaphorePermit>,
    /// Whether the token was shown.
    is_known: Arc<AtomicBool>,
}

/// One connection.
async fn serve(stream: TcpStream, app: Router, visit: Visit) {
    let app = app.layer(axum::Extension(visit));
    let _ = stream.set_nodelay(true);
    // An error here is the other end's: it has gone, or what it says is no HTTP.
    let _ = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD)
        .max_buf_size(HEAD_BYTES)
        .keep_alive(false)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(app))
        .with_upgrades()
        .await;
}

fn app(state: State) -> Router {
    let mut app = Router::new().route("/ws", get(socket));
    for asset in assets(state.gate.token()) {
        let path = asset.path;
        let answer = move || {
            let asset = asset.clone();
            async move { ([(header::CONTENT_TYPE, asset.kind)], asset.body) }
        };
        app = app.route(path, get(answer));
    }
    app.layer(from_fn_with_state(state.clone(), guarded)).with_state(state)
}

/// Every request passes here, those for nothing that exists too.
async fn guarded(Shared(state): Shared<State>, request: Request, next: Next) -> Response {
    match state.gate.check(&request) {
        Ok(host) => {
            let visit = request.extensions().get::<Visit>();
            visit.inspect(|visit| visit.is_known.store(true, Ordering::Relaxed));
            with_headers(next.run(request).await, &host)
        }
        Err(code) => with_headers(code.into_response(), ""),
    }
}

fn with_headers(mut response: Response, host: &str) -> Response {
    let mut policy = "default-src 'none'; script-src 'self'; style-src 'self'; img-src data:; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        .to_owned();
    if !host.is_empty() {
        // `'self'` does not mean sockets in every browser.
        policy.extend(["; connect-src ws://", host, " wss://", host]);
    }
    let headers = response.headers_mut();
    let policy = HeaderValue::try_from(policy).expect("an allowed host holds no odd characters");
    headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    for (name, value) in [
        ("allow", "GET"),
        ("cache-control", "no-store"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
        ("referrer-policy", "no-referrer"),
        ("x-content-type-options", "nosniff"),
        ("x-frame-options", "DENY"),
    ] {
        headers.insert(HeaderName::from_static(name), HeaderValue::from_static(value));
    }
    response
}

/// The way for pictures. The connection keeps its place for as long as the socket lives.
async fn socket(
    Shared(state): Shared<State>,
    axum::Extension(visit): axum::Extension<Visit>,
    upgrade: Result<WebSocketUpgrade, axum::extract::ws::rejection::WebSocketUpgradeRejection>,
) -> Response {
    let Ok(upgrade) = upgrade else { return StatusCode::BAD_REQUEST.into_response() };
    let upgrade = upgrade.max_message_size(session::ASKED_BYTES);
    upgrade.on_upgrade(move |socket| async move {
        session::run(socket, &state.board, &state.commands).await;
        drop(visit);
    })
}
