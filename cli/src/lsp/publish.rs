//! Diagnostics to the client.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Severity};
use luxel_lang::editor::Document;
use serde_json::{Value, json};

use super::convert::uri_of;
use super::judge::{Bytes, Judged, Told};
use super::server::Server;
use super::wire::notify;
use crate::exit::Failure;

/// The protocol's marks of what is not needed, and of what is old.
const UNNECESSARY: [&str; 2] = ["E0114", "E0420"];
const DEPRECATED: &str = "E0410";

impl Judged {
    /// Everything that is wrong.
    pub(super) fn all(&self) -> impl Iterator<Item = &Told> {
        self.told.iter().chain(self.built.iter().flatten())
    }

    /// Moves what stands behind an edit of a file, and drops what it touches.
    pub(super) fn edit(&mut self, path: &Path, range: &Range<usize>, length: usize) {
        let moved = |(file, bytes): &mut Bytes| {
            if file != path || bytes.end < range.start {
                return true;
            }
            let shift = |at: usize| (at + range.start + length).saturating_sub(range.end);
            let is_behind = bytes.start > range.end;
            *bytes = shift(bytes.start)..shift(bytes.end);
            is_behind
        };
        let kept = |told: &mut Told| {
            told.labels.retain_mut(|(place, _)| moved(place));
            told.fixes.retain_mut(|mend| moved(&mut mend.place));
            !told.is_placed || moved(&mut told.place)
        };
        self.told.retain_mut(kept);
        self.built.iter_mut().for_each(|built| built.retain_mut(kept));
        self.values.edit(path, range, length);
    }
}

impl Server {
    /// The URI of a file, as the client writes it if it is open.
    pub(super) fn uri(&self, path: &Path) -> String {
        self.files.open.get(path).map_or_else(|| uri_of(path), |open| open.uri.clone())
    }

    /// Everything that is known to be wrong with a file.
    pub(super) fn told(&self, path: &Path) -> Vec<Told> {
        let own = self.files.open.get(path).map(|open| open.document.diagnostics());
        let mut out: Vec<Told> = own
            .unwrap_or_default()
            .into_iter()
            .map(|found| Told::new(found, path, &|_| path.to_owned()))
            .collect();
        let others = self.judged.values().flat_map(Judged::all);
        for told in others.filter(|told| told.place.0 == path) {
            if !out.iter().any(|own| own.code == told.code && own.place == told.place) {
                out.push(told.clone());
            }
        }
        out
    }

    /// Of what came of a scene, leaves what open files do not tell by themselves at any time.
    /// How many more there are counts those too, and is left out.
    pub(super) fn without_own(&self, mut judged: Judged) -> Judged {
        judged.told.retain(|told| told.code != "E0508");
        for (path, open) in &self.files.open {
            let own = open.document.diagnostics();
            judged.told.retain(|told| {
                let is_it = |own: &Diagnostic| {
                    let same = own.span().is_some_and(|span| span.range() == told.place.1);
                    own.code == told.code && same && told.is_placed
                };
                told.place.0 != *path || !own.iter().any(is_it)
            });
        }
        judged
    }

    /// Tells what is wrong with one file.
    ///
    /// # Errors
    /// If nothing can be told any more.
    pub(super) fn publish(&mut self, path: &Path) -> Result<(), Failure> {
        let told = self.told(path);
        let open = self.files.open.get(path);
        if told.is_empty() && open.is_none() && !self.published.remove(path) {
            return Ok(());
        }
        if !told.is_empty() {
            self.published.insert(path.to_owned());
        }
        // Of a file that is no text, everything is shown at its start.
        let document = self
            .any_document(path)
            .unwrap_or_else(|| Arc::new(Document::new("", self.files.budgets())));
        let shown: Vec<Value> = told.iter().map(|told| self.shown(told, &document)).collect();
        let mut params = json!({ "uri": self.uri(path), "diagnostics": shown });
        if let Some(open) = open {
            params["version"] = json!(open.version);
        }
        notify("textDocument/publishDiagnostics", &params)
    }

    /// Tells what is wrong with every file.
    ///
    /// # Errors
    /// If nothing can be told any more.
    pub(super) fn publish_all(&mut self) -> Result<(), Failure> {
        let told = self.judged.values().flat_map(Judged::all);
        let mut files: BTreeSet<PathBuf> = told.map(|told| told.place.0.clone()).collect();
        files.extend(self.files.open.keys().cloned());
        files.extend(self.published.iter().cloned());
        files.iter().try_for_each(|path| self.publish(path))
    }

    /// Where a diagnostic is shown: what belongs nowhere, at the first line.
    pub(super) fn place_of(told: &Told, document: &Document) -> Range<usize> {
        if told.is_placed { told.place.1.clone() } else { document.line(0) }
    }

    /// A diagnostic as the protocol writes it.
    pub(super) fn shown(&self, told: &Told, document: &Document) -> Value {
        let lines: Vec<&str> =
            [&told.message].into_iter().chain(&told.help).map(String::as_str).collect();
        // A file without a camera is often one that others include.
        let severity = match told.severity {
            Severity::Error if told.code == "E0409" && !told.is_placed => 3,
            Severity::Error => 1,
            Severity::Warning => 2,
        };
        let mut out = json!({
            "range": self.encoding.range(document, &Self::place_of(told, document)),
            "severity": severity,
            "code": told.code,
            "source": "luxel",
            "message": lines.join("\nhelp: "),
        });
        let related: Vec<Value> = told.labels.iter().filter_map(|l| self.related(l)).collect();
        if !related.is_empty() {
            out["relatedInformation"] = json!(related);
        }
        if UNNECESSARY.contains(&told.code) {
            out["tags"] = json!([1]);
        } else if told.code == DEPRECATED {
            out["tags"] = json!([2]);
        }
        out
    }

    fn related(&self, ((path, range), text): &(Bytes, String)) -> Option<Value> {
        let document = self.any_document(path)?;
        let text = if text.is_empty() { "see here" } else { text };
        Some(json!({
            "location": { "uri": self.uri(path), "range": self.encoding.range(&document, range) },
            "message": text,
        }))
    }
}
