//! JSON-RPC to the letter: framing, ids, codes of errors, cancellation, the end.

use serde_json::{Value, json};

use super::super::program::Folder;
use super::client::{Client, at, outcome, uri};

/// What a server says of one odd message, after which it must still answer.
fn odd(client: &mut Client, bytes: &[u8]) -> (Value, i64) {
    client.bytes(bytes);
    let message = client.hear().unwrap();
    let code = outcome(&message).unwrap_err().0;
    (message["id"].clone(), code)
}

fn framed(text: &str) -> Vec<u8> {
    format!("Content-Length: {}\r\n\r\n{text}", text.len()).into_bytes()
}

#[test]
fn malformed_messages_are_answered_and_the_next_are_heard() {
    let folder = Folder::new("lsp-malformed");
    let mut client = Client::new(&folder);
    for (text, code) in [
        ("{", -32700),
        ("\u{fffd}\u{0}", -32700),
        ("[]", -32600),
        ("3", -32600),
        (r#"[{"jsonrpc":"2.0","id":1,"method":"x"}]"#, -32600),
        (r#"{"jsonrpc":"1.0","method":"x"}"#, -32600),
        (r#"{"jsonrpc":"2.0","method":3}"#, -32600),
        (r#"{"jsonrpc":"2.0","id":{},"method":"shutdown"}"#, -32600),
        (r#"{"jsonrpc":"2.0","id":1.5,"method":"shutdown"}"#, -32600),
    ] {
        assert_eq!(odd(&mut client, &framed(text)), (Value::Null, code), "{text}");
    }
    assert_eq!(odd(&mut client, &framed(r#"{"id":7,"method":"x"}"#)), (json!(7), -32600));
    let strings = r#"{"jsonrpc":"2.0","id":"seven","method":"x"}"#;
    assert_eq!(odd(&mut client, &framed(strings)), (json!("seven"), -32601));
    assert_eq!(odd(&mut client, b"Content-Length: many\r\n\r\n").1, -32700);
    assert_eq!(odd(&mut client, b"Content-Type: x\r\n\r\n").1, -32700);
    assert_eq!(odd(&mut client, b"Content-Length: 2\r\n\r\n\xff\xfe").1, -32700);
    assert!(client.ask("shutdown", Value::Null).is_ok());
}

#[test]
fn requests_that_cannot_be_answered_are_refused_and_notifications_are_not_answered() {
    let folder = Folder::new("lsp-refused");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let place = json!({ "textDocument": { "uri": uri }, "position": at(0, 0) });
    let refused = |client: &mut Client, method: &str, params: &Value| {
        client.ask(method, params.clone()).unwrap_err().0
    };
    assert_eq!(refused(&mut client, "textDocument/hover", &place), -32602);
    client.open(&uri, "scene 1\n");
    assert_eq!(client.ask("textDocument/hover", place.clone()), Ok(Value::Null));
    for (method, params) in [
        ("textDocument/hover", json!({})),
        ("textDocument/hover", json!([1])),
        ("textDocument/hover", json!({ "textDocument": { "uri": uri } })),
        (
            "textDocument/hover",
            json!({ "textDocument": { "uri": uri }, "position": at(0, 0).get("x") }),
        ),
        ("textDocument/rename", place.clone()),
        ("textDocument/codeAction", place.clone()),
        ("textDocument/colorPresentation", json!({ "color": 3 })),
    ] {
        assert_eq!(refused(&mut client, method, &params), -32602, "{method} {params}");
    }
    assert_eq!(refused(&mut client, "textDocument/dance", &place), -32601);
    assert_eq!(refused(&mut client, "$/dance", &place), -32601);
    assert_eq!(refused(&mut client, "initialize", &json!({})), -32600);
    // Whatever they hold, notifications are heard in silence, and an answer to nothing too.
    for (method, params) in [
        ("textDocument/didOpen", json!(null)),
        ("textDocument/didChange", json!({ "textDocument": { "uri": 3 } })),
        (
            "textDocument/didChange",
            json!({ "textDocument": { "uri": "c:\\x" }, "contentChanges": 1 }),
        ),
        ("$/setTrace", json!({ "value": "off" })),
        ("dance", json!({})),
    ] {
        client.tell(method, params);
    }
    client.send(&json!({ "jsonrpc": "2.0", "id": 99, "result": null }));
    let before = client.heard.len();
    assert!(client.ask("shutdown", Value::Null).is_ok());
    let answers = client.heard[before..].iter().filter(|m| m.get("id").is_some()).count();
    assert_eq!(answers, 1, "one answer to one request: {:?}", &client.heard[before..]);
    assert_eq!(refused(&mut client, "textDocument/hover", &place), -32600);
    client.tell("exit", Value::Null);
    assert_eq!(client.leave(), 0);
}

#[test]
fn nothing_is_answered_before_initialize_and_without_shutdown_the_end_is_1() {
    let folder = Folder::new("lsp-order");
    let mut client = Client::raw(&folder);
    assert_eq!(client.ask("textDocument/hover", json!({})).unwrap_err().0, -32002);
    client.tell("textDocument/didOpen", json!({}));
    let answer = client.ask("initialize", json!({ "capabilities": {} })).unwrap();
    assert_eq!(answer["capabilities"]["positionEncoding"], "utf-16");
    client.tell("exit", Value::Null);
    assert_eq!(client.leave(), 1);
    let mut client = Client::raw(&folder);
    let utf8 = json!({ "general": { "positionEncodings": ["utf-32", "utf-8"] } });
    let answer = client.ask("initialize", json!({ "capabilities": utf8 })).unwrap();
    assert_eq!(answer["capabilities"]["positionEncoding"], "utf-8");
    assert_eq!(client.leave(), 1, "its input ends");
}

#[test]
fn a_request_that_waits_is_cancelled_at_once_and_answered_once() {
    let folder = Folder::new("lsp-cancel");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    // Reading this takes a while, during which requests wait.
    let text = format!("scene 1\n{}", "shape sphere { radius = 1 m }\n".repeat(10_000));
    let document = json!({ "uri": uri, "languageId": "luxel", "version": 1, "text": text });
    client.tell("textDocument/didOpen", json!({ "textDocument": document }));
    let place = json!({ "textDocument": { "uri": uri }, "position": at(0, 0) });
    let kept = client.begin("textDocument/hover", place.clone());
    let lost = client.begin("textDocument/hover", place);
    client.tell("$/cancelRequest", json!({ "id": lost }));
    client.tell("$/cancelRequest", json!({ "id": 12345 }));
    let answer = loop {
        let message = client.hear().unwrap();
        assert_ne!(message["id"], kept, "who waits longer is cancelled before who is answered");
        if message["id"] == lost {
            break message;
        }
    };
    assert_eq!(outcome(&answer).unwrap_err().0, -32800);
    let answers = |client: &Client, id: i64| {
        client.heard.iter().filter(|message| message["id"] == id).count()
    };
    assert!(client.ask("shutdown", Value::Null).is_ok());
    assert_eq!((answers(&client, kept), answers(&client, lost)), (1, 1));
}

#[test]
fn outlines_are_answered_once_whatever_comes_between() {
    let folder = Folder::new("lsp-outline");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let text = format!("scene 1\n{}", "shape sphere { radius = 1 m }\n".repeat(1_000));
    client.open(&uri, &text);
    let file = json!({ "textDocument": { "uri": uri } });
    let found = client.ask("textDocument/documentSymbol", file.clone()).unwrap();
    assert_eq!(found.as_array().unwrap().len(), 1_000);
    assert_eq!(found[999]["range"]["start"], at(1_000, 0));
    let asked: Vec<i64> =
        (0..3).map(|_| client.begin("textDocument/documentSymbol", file.clone())).collect();
    client.tell("$/cancelRequest", json!({ "id": asked[1] }));
    let start = json!({ "start": at(1, 0), "end": at(1, 0) });
    client.edit(&uri, 2, start, "let a = 1\n");
    let found = client.ask("textDocument/documentSymbol", file).unwrap();
    assert_eq!((found.as_array().unwrap().len(), &found[0]["name"]), (1_001, &json!("a")));
    assert!(client.ask("shutdown", Value::Null).is_ok());
    for id in asked {
        let answers: Vec<_> = client.heard.iter().filter(|message| message["id"] == id).collect();
        assert_eq!(answers.len(), 1);
        // One that was ready before the edit, or before it was cancelled, is of the text before.
        match outcome(answers[0]) {
            Ok(found) => assert_eq!(found.as_array().unwrap().len(), 1_000),
            Err((code, _)) => assert!([-32800, -32801].contains(&code), "{code}"),
        }
    }
}
