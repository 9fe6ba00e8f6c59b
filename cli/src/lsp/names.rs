//! Where names come from and go to.

use luxel_lang::editor::{self, Place};
use serde_json::{Map, Value, json};

use super::answer::At;
use super::server::Server;
use super::wire::{Code, Refusal};

impl Server {
    pub(super) fn definition(&self, at: &At) -> Value {
        let found = editor::definition(&self.files, &at.path, at.byte);
        found.and_then(|place| self.location(&place)).unwrap_or_default()
    }

    pub(super) fn references(&self, at: &At, params: &Value) -> Value {
        let own = params["context"]["includeDeclaration"].as_bool().unwrap_or(true);
        let defined = editor::definition(&self.files, &at.path, at.byte).filter(|_| !own);
        let found = editor::references(&self.files, &at.path, at.byte);
        let found = found.iter().filter(|place| Some(*place) != defined.as_ref());
        found.filter_map(|place| self.location(place)).collect()
    }

    pub(super) fn prepare_rename(&self, at: &At) -> Result<Value, Refusal> {
        let (place, name) = editor::renamable(&self.files, &at.path, at.byte).map_err(refused)?;
        let range = self.encoding.range(&at.document, &(place.range.0..place.range.1));
        Ok(json!({ "range": range, "placeholder": name }))
    }

    pub(super) fn rename(&self, at: &At, params: &Value) -> Result<Value, Refusal> {
        let Some(new) = params["newName"].as_str() else {
            return Err(Refusal::new(Code::InvalidParams, "`newName` is missing"));
        };
        let places = editor::rename(&self.files, &at.path, at.byte, new).map_err(refused)?;
        let mut changes = Map::new();
        for place in places {
            let Some(location) = self.location(&place) else { continue };
            let edits = changes.entry(self.uri(&place.path)).or_insert_with(|| json!([]));
            if let Some(edits) = edits.as_array_mut() {
                edits.push(json!({ "range": location["range"], "newText": new }));
            }
        }
        Ok(json!({ "changes": changes }))
    }

    /// A place as the protocol writes it; `None` if its file cannot be read.
    fn location(&self, place: &Place) -> Option<Value> {
        let document = self.any_document(&place.path)?;
        let range = self.encoding.range(&document, &(place.range.0..place.range.1));
        Some(json!({ "uri": self.uri(&place.path), "range": range }))
    }
}

fn refused(why: String) -> Refusal {
    Refusal::new(Code::RequestFailed, why)
}
