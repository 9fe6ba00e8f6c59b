//! A client that reads every byte that the server writes, and forgives none.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::Duration;

use serde_json::{Value, json};

use crate::cli::program::Folder;

/// A server that says nothing for so long will never say what is waited for.
const PATIENCE: Duration = Duration::from_secs(60);

/// A server and what was heard of it.
pub(super) struct Client {
    child: Child,
    input: Option<ChildStdin>,
    /// What it writes, message by message, or what is wrong with how it writes.
    output: Receiver<Result<Vec<u8>, String>>,
    next: i64,
    /// Every message in order, for the test of a whole session.
    pub(super) heard: Vec<Value>,
}

impl Client {
    /// A server in a folder that nothing was said to.
    pub(super) fn raw(folder: &Folder) -> Self {
        Self::raw_with(folder, &[])
    }

    /// The same, started with these options.
    pub(super) fn raw_with(folder: &Folder, options: &[&str]) -> Self {
        let mut child = folder.talk(&[&["lsp"], options].concat());
        let input = child.stdin.take();
        let output = listen(BufReader::new(child.stdout.take().unwrap()));
        Self { child, input, output, next: 0, heard: vec![] }
    }

    /// A server that is ready.
    pub(super) fn new(folder: &Folder) -> Self {
        Self::ready(Self::raw(folder), folder)
    }

    /// The server made ready.
    pub(super) fn ready(mut client: Self, folder: &Folder) -> Self {
        let root = uri(folder, "");
        let trees = json!({ "hierarchicalDocumentSymbolSupport": true });
        let capabilities = json!({ "textDocument": { "documentSymbol": trees } });
        let params = json!({ "processId": null, "rootUri": root.trim_end_matches('/'), "capabilities": capabilities });
        client.ask("initialize", params).unwrap();
        client.tell("initialized", json!({}));
        client
    }

    /// Sends bytes as they are.
    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(bytes).unwrap();
        input.flush().unwrap();
    }

    /// Sends a message.
    pub(super) fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.bytes(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    /// Tells something.
    pub(super) fn tell(&mut self, method: &str, params: Value) {
        let mut message = json!({ "jsonrpc": "2.0", "method": method });
        message["params"] = params;
        self.send(&message);
    }

    /// Sends a request without waiting; gives its number.
    pub(super) fn begin(&mut self, method: &str, params: Value) -> i64 {
        self.next += 1;
        let id = self.next;
        let mut message = json!({ "jsonrpc": "2.0", "id": id, "method": method });
        message["params"] = params;
        self.send(&message);
        id
    }

    /// Asks and waits: the result, or code and message of an error.
    pub(super) fn ask(&mut self, method: &str, params: Value) -> Result<Value, (i64, String)> {
        let id = self.begin(method, params);
        loop {
            let message = self.hear().expect("the server answers");
            if message.get("id") == Some(&json!(id)) {
                return outcome(&message);
            }
        }
    }

    /// The next message, which must be one to the letter; `None` when the server has gone.
    pub(super) fn hear(&mut self) -> Option<Value> {
        let bytes = match self.output.recv_timeout(PATIENCE) {
            Ok(message) => message.unwrap_or_else(|wrong| panic!("{wrong}")),
            Err(RecvTimeoutError::Disconnected) => return None,
            Err(RecvTimeoutError::Timeout) => panic!("silence after {:?}", self.heard.last()),
        };
        let message: Value = serde_json::from_slice(&bytes).unwrap();
        assert_eq!(message["jsonrpc"], "2.0", "{message}");
        let known = ["jsonrpc", "id", "method", "params", "result", "error"];
        assert!(message.as_object().unwrap().keys().all(|key| known.contains(&key.as_str())));
        let is_response = message.get("id").is_some();
        assert_ne!(is_response, message.get("method").is_some(), "{message}");
        let parts = [message.get("result").is_some(), message.get("error").is_some()];
        assert_eq!(
            parts.iter().filter(|part| **part).count(),
            usize::from(is_response),
            "{message}"
        );
        self.heard.push(message.clone());
        Some(message)
    }

    /// Opens a file and hears what is told of it at once.
    pub(super) fn open(&mut self, uri: &str, text: &str) -> Value {
        let document = json!({ "uri": uri, "languageId": "luxel", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
        self.told(uri)
    }

    /// Replaces a range; hears what is told at once. Of older texts, something may be told before.
    pub(super) fn edit(&mut self, uri: &str, version: i64, range: Value, text: &str) -> Value {
        let mut change = json!([{ "text": text }]);
        change[0]["range"] = range;
        let document = json!({ "uri": uri, "version": version });
        let params = json!({ "textDocument": document, "contentChanges": change });
        self.tell("textDocument/didChange", params);
        loop {
            let told = self.told(uri);
            if told["version"] == version {
                return told;
            }
        }
    }

    /// The next diagnostics of a file.
    pub(super) fn told(&mut self, uri: &str) -> Value {
        loop {
            let message = self.hear().expect("diagnostics are told");
            if message["params"]["uri"] == uri {
                assert_eq!(message["method"], "textDocument/publishDiagnostics");
                return message["params"].clone();
            }
        }
    }

    /// Waits until what is told of a file has all of these codes, and no others.
    pub(super) fn until(&mut self, uri: &str, wanted: &[&str]) -> Value {
        loop {
            let told = self.told(uri);
            let codes: Vec<_> = codes(&told);
            if codes == wanted {
                return told;
            }
        }
    }

    /// Closes the server's input and gives its exit code.
    pub(super) fn leave(mut self) -> i32 {
        drop(self.input.take());
        while self.hear().is_some() {}
        self.child.wait().unwrap().code().unwrap()
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Reads messages as they come, in a thread of its own.
fn listen(mut output: BufReader<ChildStdout>) -> Receiver<Result<Vec<u8>, String>> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        while let Some(message) = framed(&mut output).transpose() {
            let is_last = message.is_err();
            if sender.send(message).is_err() || is_last {
                return;
            }
        }
    });
    receiver
}

/// The bytes of one message behind its header; none at the end.
fn framed(output: &mut impl BufRead) -> Result<Option<Vec<u8>>, String> {
    let mut line = || {
        let mut line = String::new();
        output.read_line(&mut line).map(|_| line).map_err(|error| error.to_string())
    };
    let head = line()?;
    if head.is_empty() {
        return Ok(None);
    }
    let length = head.strip_prefix("Content-Length: ").and_then(|it| it.strip_suffix("\r\n"));
    let length = length.and_then(|it| it.parse().ok()).ok_or(format!("the header {head:?}"))?;
    let empty = line()?;
    if empty != "\r\n" {
        return Err(format!("{empty:?} instead of the blank line that ends the header"));
    }
    let mut bytes = vec![0; length];
    output.read_exact(&mut bytes).map_err(|error| error.to_string())?;
    Ok(Some(bytes))
}

/// The result of a response, or code and message of its error.
pub(super) fn outcome(message: &Value) -> Result<Value, (i64, String)> {
    match message.get("error") {
        Some(error) => {
            Err((error["code"].as_i64().unwrap(), error["message"].as_str().unwrap().to_owned()))
        }
        None => Ok(message["result"].clone()),
    }
}

/// The codes of diagnostics, in order.
pub(super) fn codes(told: &Value) -> Vec<&str> {
    let found = told["diagnostics"].as_array().unwrap();
    found.iter().map(|found| found["code"].as_str().unwrap()).collect()
}

/// The URI of a file in a folder.
pub(super) fn uri(folder: &Folder, name: &str) -> String {
    let path = folder.path(name).to_str().unwrap().to_owned();
    format!("file://{}", path.replace('%', "%25").replace(' ', "%20"))
}

/// A position.
pub(super) fn at(line: u64, character: u64) -> Value {
    json!({ "line": line, "character": character })
}

/// A range in one line.
pub(super) fn span(line: u64, start: u64, end: u64) -> Value {
    json!({ "start": at(line, start), "end": at(line, end) })
}
