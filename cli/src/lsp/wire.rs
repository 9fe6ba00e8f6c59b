//! Messages as bytes: `Content-Length` and JSON.

use std::io::{self, BufRead, Read};

use serde::Serialize;
use serde_json::{Value, json};

use super::queue::{Event, Queue};
use crate::exit::Failure;
use crate::report;

/// Bytes of one message, at most: a whole scene file with every character escaped.
const MAX_BYTES: u64 = 512 << 20;

/// Bytes from which on a length is a mistake, and not what is to be passed over.
const NEVER: u64 = 16 << 30;

/// The protocol's codes of errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Code {
    Parse = -32700,
    InvalidRequest = -32600,
    MethodNotFound = -32601,
    InvalidParams = -32602,
    Internal = -32603,
    NotInitialized = -32002,
    RequestFailed = -32803,
    Cancelled = -32800,
    ContentModified = -32801,
}

/// Why a request is not answered with a result.
#[derive(Clone, Debug)]
pub(super) struct Refusal {
    pub(super) code: Code,
    pub(super) message: String,
}

impl Refusal {
    pub(super) fn new(code: Code, message: impl Into<String>) -> Self {
        Self { code, message: message.into() }
    }
}

/// Reads messages into the queue until there are no more.
pub(super) fn read(mut input: impl BufRead, queue: &Queue) {
    while let Ok(Some(Told { wrong, bytes })) = message(&mut input) {
        if let Some(why) = wrong {
            queue.put(malformed(why));
        }
        if let Some(bytes) = bytes {
            queue.put(match serde_json::from_slice(&bytes) {
                Ok(value) => Event::Message(value),
                Err(error) => malformed(format!("the message is not JSON: {error}")),
            });
        }
    }
    queue.put(Event::End);
}

/// What came up to the end of a message.
struct Told {
    /// What is wrong with its head. The message may be right all the same: a line of something else that has
    /// got between two.
    wrong: Option<String>,
    /// The message, if its head says where it ends.
    bytes: Option<Vec<u8>>,
}

impl Told {
    fn nothing(why: String) -> Self {
        Self { wrong: Some(why), bytes: None }
    }
}

fn malformed(why: String) -> Event {
    Event::Malformed(Refusal::new(Code::Parse, why))
}

/// The next message, or why there is none; `None` at the end.
fn message(input: &mut impl BufRead) -> io::Result<Option<Told>> {
    let (mut length, mut line, mut wrong) = (None, vec![], None);
    loop {
        line.clear();
        if input.by_ref().take(MAX_BYTES).read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end_matches(['\r', '\n']);
        if text.is_empty() {
            break;
        }
        // After a head that was wrong, the next one may follow on the same line.
        let lower = text.to_ascii_lowercase();
        match lower.find("content-length:") {
            Some(at) => {
                wrong = wrong.or((at > 0).then(|| "something stands before the header".to_owned()));
                let number = lower[at + "content-length:".len()..].trim().parse::<u64>();
                length = number.ok();
                if length.is_none() {
                    wrong = Some("`Content-Length` wants a number".to_owned());
                }
            }
            None if text.contains(':') && !text.contains('{') => {}
            None => wrong = Some("a header has the form `Name: value`".to_owned()),
        }
    }
    let Some(length) = length else {
        let why = wrong.unwrap_or_else(|| "the header has no `Content-Length`".to_owned());
        return Ok(Some(Told::nothing(why)));
    };
    if length > NEVER {
        return Ok(Some(Told::nothing(format!("nobody sends a message of {length} bytes"))));
    }
    if length > MAX_BYTES {
        io::copy(&mut input.by_ref().take(length), &mut io::sink())?;
        let why = format!("a message of {length} bytes; the limit is {MAX_BYTES}");
        return Ok(Some(Told::nothing(why)));
    }
    let mut bytes = vec![];
    let found = input.by_ref().take(length).read_to_end(&mut bytes)?;
    if (found as u64) < length {
        return Ok(None);
    }
    Ok(Some(Told { wrong, bytes: Some(bytes) }))
}

/// Sends a message.
///
/// # Errors
/// If standard output cannot be written.
pub(super) fn send(message: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(message).expect("messages have keys that are text");
    report::out(&format!("Content-Length: {}\r\n\r\n{text}", text.len()))
}

/// An answer that is no error.
#[derive(Serialize)]
struct Answer<'a, T> {
    jsonrpc: &'static str,
    id: &'a Value,
    result: T,
}

/// Answers a request.
///
/// # Errors
/// As `send`.
pub(super) fn respond<T: Serialize>(id: &Value, answer: Result<T, Refusal>) -> Result<(), Failure> {
    match answer {
        Ok(result) => send(&Answer { jsonrpc: "2.0", id, result }),
        Err(refusal) => refuse(id, refusal),
    }
}

/// Answers a request with an error.
///
/// # Errors
/// As `send`.
pub(super) fn refuse(id: &Value, Refusal { code, message }: Refusal) -> Result<(), Failure> {
    send(&json!({
        "jsonrpc": "2.0",
        "id": id,
        "error": { "code": code as i32, "message": message },
    }))
}

/// Tells something that is not answered.
///
/// # Errors
/// As `send`.
pub(super) fn notify(method: &str, params: &Value) -> Result<(), Failure> {
    send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What comes of some bytes: methods, and messages of refusals.
    fn heard(bytes: &str) -> Vec<String> {
        let queue = Queue::default();
        read(bytes.as_bytes(), &queue);
        let mut out = vec![];
        loop {
            match queue.take() {
                Event::Message(value) => out.push(value["method"].as_str().unwrap().to_owned()),
                Event::Malformed(refusal) => out.push(refusal.message),
                Event::Judged(_) => {}
                Event::End => return out,
            }
        }
    }

    fn framed(text: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{text}", text.len())
    }

    #[test]
    fn messages_are_read_with_any_headers_and_to_the_byte() {
        let a = r#"{"method":"é"}"#;
        let typed = format!("Content-Type: x\r\ncontent-length:{}\r\n\r\n{a}", a.len());
        assert_eq!(heard(&format!("{}{typed}", framed(a))), ["é", "é"]);
        assert_eq!(heard(&framed(a)[..20]), Vec::<String>::new());
    }

    #[test]
    fn what_is_malformed_is_told_and_reading_goes_on() {
        let good = framed(r#"{"method":"a"}"#);
        let check = |bytes: &str, told: &str| {
            let found = heard(&format!("{bytes}{good}"));
            assert!(found[0].contains(told), "{found:?}");
            assert_eq!(found.last().unwrap(), "a", "{found:?}");
        };
        check(&framed("{"), "the message is not JSON");
        check("Content-Length: x\r\n\r\n", "`Content-Length` wants a number");
        check("Content-Length: 99999999999999\r\n\r\n", "nobody sends a message");
        check("Content-Type: x\r\n\r\n", "the header has no `Content-Length`");
        check("hello\r\n\r\n", "a header has the form `Name: value`");
        let found = heard(&format!("{{\"method\":\"lost\"}}{good}{good}"));
        assert_eq!(found, ["something stands before the header", "a", "a"]);
        assert_eq!(heard(&format!("hello\n{good}")), ["a header has the form `Name: value`", "a"]);
    }
}
