//! Mends of mistakes.

use luxel_core::diag::Grade;
use luxel_lang::editor::Document;
use serde_json::{Map, Value, json};

use super::judge::{Mend, Told};
use super::server::Server;
use super::wire::Refusal;

/// Characters of a text that a title shows.
const SHOWN: usize = 40;

impl Server {
    pub(super) fn actions(&self, params: &Value) -> Result<Value, Refusal> {
        let (path, document) = self.asked(params)?;
        let range = self.asked_range(&document, params)?;
        let only = params["context"]["only"].as_array();
        let wanted = only.is_none_or(|kinds| {
            kinds.iter().filter_map(Value::as_str).any(|kind| matches!(kind, "" | "quickfix"))
        });
        let touched = |told: &Told| {
            let place = Self::place_of(told, &document);
            place.start <= range.end && range.start <= place.end
        };
        let told = self.told(&path).into_iter().filter(|told| wanted && touched(told));
        Ok(told.flat_map(|told| self.mends(&told, &document)).collect())
    }

    fn mends(&self, told: &Told, document: &Document) -> Vec<Value> {
        let shown = self.shown(told, document);
        let is_only = told.fixes.len() == 1;
        let one = |Mend { place, text, grade }: &Mend| {
            let document = self.any_document(&place.0)?;
            let old = document.text().get(place.1.clone())?;
            let range = self.encoding.range(&document, &place.1);
            let mut changes = Map::new();
            changes.insert(self.uri(&place.0), json!([{ "range": range, "newText": text }]));
            Some(json!({
                "title": title(old, text),
                "kind": "quickfix",
                "diagnostics": [shown],
                "isPreferred": is_only && *grade == Grade::Sure,
                "edit": { "changes": changes },
            }))
        };
        told.fixes.iter().filter_map(one).collect()
    }
}

/// What a mend does.
fn title(old: &str, new: &str) -> String {
    let short = |text: &str| {
        let text = text.trim();
        let mut out: String = text.chars().take(SHOWN).collect();
        if out.len() < text.len() {
            out.push('…');
        }
        out
    };
    match (old.is_empty(), new.is_empty()) {
        _ if new.trim().is_empty() && new.contains('\n') => "begin a new line".to_owned(),
        (true, _) => format!("insert `{}`", short(new)),
        (_, true) => format!("remove `{}`", short(old)),
        _ => format!("replace `{}` by `{}`", short(old), short(new)),
    }
}
