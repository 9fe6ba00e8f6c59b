//! A file laid out anew.

use serde_json::{Value, json};

use super::server::Server;
use super::wire::{Code, Refusal};

impl Server {
    /// The lines that laying out changes, as one edit. The language has one way to write a scene: what
    /// the client wishes does not count.
    pub(super) fn formatting(&self, params: &Value) -> Result<Value, Refusal> {
        let (_, document) = self.asked(params)?;
        let old = document.text();
        let Ok(new) = luxel_lang::format(old, self.files.budgets()) else {
            let why = "the file is not laid out: it holds mistakes";
            return Err(Refusal::new(Code::RequestFailed, why));
        };
        if new == old {
            return Ok(json!([]));
        }
        // What is the same before and behind stays, by whole lines.
        let pairs = old.split_inclusive('\n').zip(new.split_inclusive('\n'));
        let start: usize = pairs.take_while(|(a, b)| a == b).map(|(line, _)| line.len()).sum();
        let (rest, made) = (&old[start..], &new[start..]);
        let pairs = rest.split_inclusive('\n').rev().zip(made.split_inclusive('\n').rev());
        let end: usize = pairs.take_while(|(a, b)| a == b).map(|(line, _)| line.len()).sum();
        let range = self.encoding.range(&document, &(start..old.len() - end));
        Ok(json!([{ "range": range, "newText": new[start..new.len() - end] }]))
    }
}
