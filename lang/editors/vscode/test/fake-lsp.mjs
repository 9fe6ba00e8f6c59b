#!/usr/bin/env node
// A language server of a few answers, for tests of who asks: it knows that `spher` is no shape.

let held = Buffer.alloc(0);

process.stdin.on("data", (data) => {
  held = Buffer.concat([held, data]);
  for (;;) {
    const end = held.indexOf("\r\n\r\n");
    const length = Number(/Content-Length: (\d+)/i.exec(held.subarray(0, end).toString())?.[1]);
    if (end < 0 || held.length < end + 4 + length) return;
    const message = JSON.parse(held.subarray(end + 4, end + 4 + length).toString());
    held = held.subarray(end + 4 + length);
    take(message);
  }
});

function send(message) {
  const text = JSON.stringify({ jsonrpc: "2.0", ...message });
  process.stdout.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
}

function take({ id, method, params }) {
  if (method === "initialize") {
    const capabilities = { textDocumentSync: 1, completionProvider: {}, hoverProvider: true };
    send({ id, result: { capabilities, serverInfo: { name: "fake" } } });
  } else if (method === "textDocument/didOpen") {
    judge(params.textDocument.uri, params.textDocument.text);
  } else if (method === "textDocument/didChange") {
    judge(params.textDocument.uri, params.contentChanges.at(-1).text);
  } else if (method === "textDocument/completion") {
    const items = ["sphere", "box", "cylinder", "disk", "mesh"].map((label) => ({ label, kind: 7, detail: "shape" }));
    send({ id, result: items });
  } else if (method === "textDocument/hover") {
    send({ id, result: { contents: "a word" } });
  } else if (method === "exit") {
    process.exit(0);
  } else if (id !== undefined) {
    send({ id, result: null });
  }
}

function judge(uri, text) {
  const diagnostics = text.split("\n").flatMap((line, i) => {
    const at = line.search(/\bspher\b/);
    const range = { start: { line: i, character: at }, end: { line: i, character: at + 5 } };
    return at < 0 ? [] : [{ range, severity: 1, code: "E0401", source: "luxel", message: "no shape is called `spher`; did you mean `sphere`?" }];
  });
  send({ method: "textDocument/publishDiagnostics", params: { uri, diagnostics } });
}
