//! What may be written, and what is told of what is written.

use std::borrow::Cow;
use std::path::Path;

use luxel_lang::editor::{Item, ItemKind, OnDisk, complete, hover};
use serde_json::{Value, json};

use super::answer::At;
use super::files::names_beside;
use super::server::Server;
use crate::libraries::{Found, State};

impl Server {
    pub(super) fn completion(&self, at: &At) -> Value {
        let mut found = complete(&self.files, &at.path, at.byte, &self.plugins.registry);
        let mut range = found.range.clone();
        match &found.on_disk {
            Some(OnDisk::Files { written, ends }) => {
                let names = names_beside(&at.path, written, ends);
                range.start += written.rfind('/').map_or(0, |at| at + 1);
                found.items = names.into_iter().map(Item::file).collect();
            }
            Some(OnDisk::Libraries) => {
                let unloaded = self.plugins.libraries.iter();
                let unloaded = unloaded.filter(|found| !matches!(found.state, State::Loaded(_)));
                let item = |library: &Found| Item::library(&library.stem, library.state.words().0);
                found.items.extend(unloaded.map(item));
            }
            None => {}
        }
        let range = self.encoding.range(&at.document, &range);
        let items = found.items.iter().map(|item| self.item(item, &range));
        json!({ "isIncomplete": false, "items": items.collect::<Vec<_>>() })
    }

    fn item(&self, item: &Item, range: &Value) -> Value {
        // A name may look like a place to fill in.
        let place = item.insert.find("$0");
        let is_snippet = self.client.snippets && place.is_some();
        let text = match place {
            _ if item.insert.is_empty() => item.label.clone(),
            Some(_) if is_snippet => item.insert.replace('}', "\\}"),
            Some(place) => item.insert[..place].to_owned(),
            None => item.insert.clone(),
        };
        let mut out = json!({
            "label": item.label,
            "kind": kind(item.kind),
            "sortText": format!("{}{}", item.rank, item.label),
            "textEdit": { "range": range, "newText": text },
            "insertTextFormat": if is_snippet { 2 } else { 1 },
        });
        if !item.detail.is_empty() {
            out["detail"] = json!(item.detail);
        }
        if !item.doc.is_empty() {
            out["documentation"] = json!({ "kind": "markdown", "value": item.doc });
        }
        out
    }

    pub(super) fn hover(&self, at: &At) -> Value {
        let Some(found) = hover(&self.files, &at.path, at.byte, &self.plugins.registry) else {
            return Value::Null;
        };
        let evaluated = || {
            found.of.and_then(|place| self.value(&place.path, place.range.0).map(Cow::into_owned))
        };
        let value = found.value.or_else(evaluated);
        let code = format!("```scene\n{}\n```", found.code);
        let value = value.map(|value| format!("{}: {value}", found.value_is));
        let words = Some(found.text).filter(|text| !text.is_empty());
        let parts: Vec<String> = [Some(code), value, words].into_iter().flatten().collect();
        let text = parts.join("\n\n");
        json!({
            "contents": { "kind": "markdown", "value": text },
            "range": self.encoding.range(&at.document, &found.range),
        })
    }

    /// The value that a name had in the last evaluation.
    fn value(&self, path: &Path, at: usize) -> Option<Cow<'_, str>> {
        self.judged.values().find_map(|judged| judged.values.at(path, at))
    }
}

/// The protocol's number for an item.
fn kind(kind: ItemKind) -> u8 {
    match kind {
        ItemKind::Keyword => 14,
        ItemKind::Category => 22,
        ItemKind::Class => 7,
        ItemKind::Param => 10,
        ItemKind::Name => 6,
        ItemKind::Function => 3,
        ItemKind::Unit => 11,
        ItemKind::Value => 12,
        ItemKind::Type => 25,
        ItemKind::File => 17,
    }
}
