//! One client from `initialize` to `exit`.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use serde_json::{Value, json};

use super::Limits;
use super::answer;
use super::queue::{Event, Queue};
use super::server::Server;
use super::wire::{Code, Refusal, refuse, respond};
use crate::exit::{Exit, Failure, blaming};
use crate::libraries::Plugins;

/// How far a session is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    New,
    Running,
    ShutDown,
}

/// One client.
pub(super) struct Session {
    queue: Arc<Queue>,
    server: Server,
    stage: Stage,
}

impl Session {
    pub(super) fn new(queue: Arc<Queue>, plugins: Arc<Plugins>, limits: Limits) -> Self {
        let server = Server::new(queue.clone(), plugins, limits);
        Self { queue, server, stage: Stage::New }
    }

    /// Answers until the client leaves.
    pub(super) fn run(&mut self) -> Result<Exit, Failure> {
        loop {
            match self.queue.take() {
                Event::Message(message) => {
                    if let Some(exit) = self.message(&message)? {
                        return Ok(exit);
                    }
                }
                Event::Malformed(refusal) => refuse(&Value::Null, refusal)?,
                Event::Judged(verdict) => {
                    let told = blaming("", || self.server.judged(verdict));
                    told.and_then(|told| told).or_else(only_broken)?;
                }
                // Without `exit`, the client has gone unasked.
                Event::End => return Ok(Exit::Input),
            }
        }
    }

    /// Deals with a message; gives how to exit, if that was asked for.
    fn message(&mut self, message: &Value) -> Result<Option<Exit>, Failure> {
        let id = message.get("id").filter(|id| id.is_string() || id.is_i64() || id.is_u64());
        let shown = id.cloned().unwrap_or(Value::Null);
        let invalid = |why: &str| refuse(&shown, Refusal::new(Code::InvalidRequest, why));
        if !message.is_object() {
            invalid("a message is an object; there are no batches")?;
            return Ok(None);
        }
        let is_answer = message.get("method").is_none()
            && (message.get("result").is_some() || message.get("error").is_some());
        if is_answer {
            return Ok(None);
        }
        if message["jsonrpc"] != "2.0" {
            invalid("`jsonrpc` must be \"2.0\"")?;
            return Ok(None);
        }
        let Some(method) = message["method"].as_str() else {
            invalid("`method` must be a string")?;
            return Ok(None);
        };
        let params = &message["params"];
        match (id, message.get("id")) {
            (Some(id), _) => self.request(id, method, params)?,
            (None, Some(_)) => invalid("`id` must be a whole number or a string")?,
            (None, None) if method == "exit" => {
                let orderly = self.stage == Stage::ShutDown;
                return Ok(Some(if orderly { Exit::Fine } else { Exit::Input }));
            }
            (None, None) => self.notification(method, params)?,
        }
        Ok(None)
    }

    fn request(&mut self, id: &Value, method: &str, params: &Value) -> Result<(), Failure> {
        let cancelled = self.queue.begin(id);
        if (self.stage, method) == (Stage::Running, "textDocument/documentSymbol") {
            self.server.begin();
            return self.server.outline(id, params, cancelled, &self.queue).or_else(|refusal| {
                self.queue.end(id);
                refuse(id, refusal)
            });
        }
        let stop = || cancelled.load(Ordering::Relaxed);
        let answer = match (self.stage, method) {
            (Stage::New, "initialize") => {
                self.stage = Stage::Running;
                Ok(self.server.initialize(params))
            }
            (Stage::New, _) => {
                Err(Refusal::new(Code::NotInitialized, "the first request is `initialize`"))
            }
            (Stage::Running, "initialize") => {
                Err(Refusal::new(Code::InvalidRequest, "`initialize` was said already"))
            }
            (Stage::Running, "shutdown") => {
                self.stage = Stage::ShutDown;
                self.server.outlines.end();
                Ok(Value::Null)
            }
            (Stage::ShutDown, _) => {
                Err(Refusal::new(Code::InvalidRequest, "after `shutdown` comes `exit`"))
            }
            (Stage::Running, method) => {
                self.server.begin();
                let run = || answer::answer(&mut self.server, method, params, &stop);
                blaming("", run)
                    .unwrap_or_else(|failure| Err(Refusal::new(Code::Internal, failure.message)))
            }
        };
        self.queue.end(id);
        let late = stop() && self.stage == Stage::Running;
        let cancelled = || Err(Refusal::new(Code::Cancelled, "the request was cancelled"));
        respond(id, if late { cancelled() } else { answer })
    }

    fn notification(&mut self, method: &str, params: &Value) -> Result<(), Failure> {
        if self.stage != Stage::Running {
            return Ok(());
        }
        self.server.begin();
        let told = blaming("", || self.server.notification(method, params));
        told.and_then(|told| told).or_else(|failure| {
            let shown = json!({ "type": 1, "message": failure.message });
            super::wire::notify("window/logMessage", &shown)
        })
    }
}

/// A panic while telling is told; that nothing can be told ends the session.
fn only_broken(failure: Failure) -> Result<(), Failure> {
    if failure.exit == Exit::Ours {
        let shown = json!({ "type": 1, "message": failure.message });
        return super::wire::notify("window/logMessage", &shown);
    }
    Err(failure)
}
