//! Which request is answered by what.

use std::path::PathBuf;
use std::sync::Arc;

use luxel_lang::editor::Document;
use serde_json::Value;

use super::server::Server;
use super::wire::{Code, Refusal};

/// A file and a place in it that a request asks about.
pub(super) struct At {
    pub(super) path: PathBuf,
    pub(super) document: Arc<Document>,
    pub(super) byte: usize,
}

/// Answers a request; gives up when `stop` says so.
pub(super) fn answer(
    server: &mut Server,
    method: &str,
    params: &Value,
    stop: &dyn Fn() -> bool,
) -> Result<Value, Refusal> {
    if stop() {
        return Err(Refusal::new(Code::Cancelled, "the request was cancelled"));
    }
    match method {
        "textDocument/completion" => Ok(server.completion(&server.at(params)?)),
        "textDocument/hover" => Ok(server.hover(&server.at(params)?)),
        "textDocument/definition" => Ok(server.definition(&server.at(params)?)),
        "textDocument/references" => Ok(server.references(&server.at(params)?, params)),
        "textDocument/prepareRename" => server.prepare_rename(&server.at(params)?),
        "textDocument/rename" => server.rename(&server.at(params)?, params),
        "textDocument/foldingRange" => server.folding(params, stop),
        "textDocument/semanticTokens/full" | "textDocument/semanticTokens/range" => {
            server.tokens(params, stop)
        }
        "textDocument/documentColor" => server.colours(params, stop),
        "textDocument/colorPresentation" => server.presentation(params),
        "textDocument/formatting" => server.formatting(params),
        "textDocument/codeAction" => server.actions(params),
        other => Err(Refusal::new(Code::MethodNotFound, format!("there is no method `{other}`"))),
    }
}

impl Server {
    /// The file that a request asks about.
    ///
    /// # Errors
    /// If it is not open.
    pub(super) fn asked(&self, params: &Value) -> Result<(PathBuf, Arc<Document>), Refusal> {
        let uri = &params["textDocument"]["uri"];
        let Some(shown) = uri.as_str() else {
            return Err(Refusal::new(Code::InvalidParams, "`textDocument.uri` is missing"));
        };
        let unknown = || Refusal::new(Code::InvalidParams, format!("`{shown}` is not open"));
        self.document(uri).ok_or_else(unknown)
    }

    /// The place that a request asks about.
    fn at(&self, params: &Value) -> Result<At, Refusal> {
        let (path, document) = self.asked(params)?;
        let byte = self.encoding.byte(&document, &params["position"]);
        let none = || Refusal::new(Code::InvalidParams, "`position` wants `line` and `character`");
        Ok(At { path, byte: byte.ok_or_else(none)?, document })
    }

    /// The range that a request asks about.
    ///
    /// # Errors
    /// If there is none.
    pub(super) fn asked_range(
        &self,
        document: &Document,
        params: &Value,
    ) -> Result<std::ops::Range<usize>, Refusal> {
        let range = self.encoding.bytes(document, &params["range"]);
        range.ok_or_else(|| Refusal::new(Code::InvalidParams, "`range` wants `start` and `end`"))
    }
}
