//! What a client is told of, and what the server can do.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use luxel_lang::editor::{Document, Project, reached};
use serde_json::{Value, json};

use super::Limits;
use super::convert::{Encoding, path_of};
use super::files::{Open, Opened};
use super::judge::{Job, Judge, Judged, Verdict};
use super::outline::{Asked, Outlines};
use super::queue::Queue;
use super::shape::LEGEND;
use super::wire::Refusal;
use crate::exit::{Failure, blaming};
use crate::libraries::Plugins;

/// Open files, and the files that each of them reads.
type Reads = BTreeMap<PathBuf, Vec<PathBuf>>;

/// The state of a session.
pub(super) struct Server {
    pub(super) files: Opened,
    pub(super) plugins: Arc<Plugins>,
    pub(super) encoding: Encoding,
    pub(super) client: Client,
    pub(super) outlines: Outlines,
    judge: Judge,
    /// Counts the edits.
    serial: u64,
    /// Scenes of which nothing newer has come yet, and whether to read their meshes and textures.
    pending: BTreeMap<PathBuf, bool>,
    /// What came of the scenes that are open.
    pub(super) judged: BTreeMap<PathBuf, Judged>,
    /// Files that something was told of.
    pub(super) published: BTreeSet<PathBuf>,
}

/// What the client can do.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Client {
    /// It fills in places of what is inserted.
    pub(super) snippets: bool,
    /// It shows an outline as a tree.
    pub(super) trees: bool,
}

impl Server {
    pub(super) fn new(queue: Arc<Queue>, plugins: Arc<Plugins>, limits: Limits) -> Self {
        Self {
            files: Opened::new(limits.clone()),
            judge: Judge::start(queue, plugins.clone(), limits),
            plugins,
            encoding: Encoding::Utf16,
            client: Client::default(),
            outlines: Outlines::default(),
            serial: 0,
            pending: BTreeMap::new(),
            judged: BTreeMap::new(),
            published: BTreeSet::new(),
        }
    }

    /// A message is about to be dealt with.
    pub(super) fn begin(&mut self) {
        self.files.look_again();
    }

    pub(super) fn initialize(&mut self, params: &Value) -> Value {
        let capable = |path: &str| params["capabilities"].pointer(path);
        let offered = capable("/general/positionEncodings").and_then(Value::as_array);
        if offered.is_some_and(|words| words.iter().any(|word| word == "utf-8")) {
            self.encoding = Encoding::Utf8;
        }
        let is = |path: &str| capable(path).and_then(Value::as_bool).unwrap_or(false);
        self.client = Client {
            snippets: is("/textDocument/completion/completionItem/snippetSupport"),
            trees: is("/textDocument/documentSymbol/hierarchicalDocumentSymbolSupport"),
        };
        let folders = params["workspaceFolders"].as_array().cloned().unwrap_or_default();
        let uris = folders.iter().map(|folder| &folder["uri"]).chain([&params["rootUri"]]);
        let mut folders: Vec<PathBuf> = uris.filter_map(Value::as_str).map(path_of).collect();
        folders.dedup();
        self.files.folders = folders;
        json!({
            "capabilities": self.capabilities(),
            "serverInfo": { "name": "luxel", "version": env!("CARGO_PKG_VERSION") },
        })
    }

    fn capabilities(&self) -> Value {
        json!({
            "positionEncoding": self.encoding.word(),
            "textDocumentSync": { "openClose": true, "change": 2, "save": { "includeText": false } },
            "completionProvider": { "triggerCharacters": [".", "\"", "=", " ", "(", "/", "{", ":", "@"] },
            "hoverProvider": true,
            "definitionProvider": true,
            "referencesProvider": true,
            "renameProvider": { "prepareProvider": true },
            "documentSymbolProvider": true,
            "foldingRangeProvider": true,
            "documentFormattingProvider": true,
            "colorProvider": true,
            "codeActionProvider": { "codeActionKinds": ["quickfix"] },
            "semanticTokensProvider": {
                "legend": { "tokenTypes": LEGEND, "tokenModifiers": ["declaration", "documentation"] },
                "full": true,
                "range": true,
            },
            "workspace": { "workspaceFolders": { "supported": true } },
        })
    }

    /// Deals with what is not answered; what it does not know it leaves.
    ///
    /// # Errors
    /// If nothing can be told any more.
    pub(super) fn notification(&mut self, method: &str, params: &Value) -> Result<(), Failure> {
        let document = &params["textDocument"];
        let path = document["uri"].as_str().map(path_of);
        match (method, path) {
            ("textDocument/didOpen", Some(path)) => {
                let text = document["text"].as_str().unwrap_or_default();
                let open = Open {
                    uri: document["uri"].as_str().unwrap_or_default().to_owned(),
                    version: document["version"].as_i64().unwrap_or_default(),
                    document: Arc::new(Document::new(text, self.files.budgets())),
                };
                self.files.open.insert(path.clone(), open);
                self.changed(&path, true)
            }
            ("textDocument/didChange", Some(path)) => self.change(&path, params),
            ("textDocument/didSave", Some(path)) => self.changed(&path, true),
            ("textDocument/didClose", Some(path)) => {
                self.files.open.remove(&path);
                self.judged.remove(&path);
                self.changed(&path, false)
            }
            ("workspace/didChangeWatchedFiles", _) => {
                let open: Vec<PathBuf> = self.files.open.keys().cloned().collect();
                open.iter().try_for_each(|path| self.changed(path, true))
            }
            ("workspace/didChangeWorkspaceFolders", _) => {
                self.change_folders(&params["event"]);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn change_folders(&mut self, event: &Value) {
        let paths = |of: &str| -> Vec<PathBuf> {
            let folders = event[of].as_array().cloned().unwrap_or_default();
            folders.iter().filter_map(|folder| folder["uri"].as_str()).map(path_of).collect()
        };
        let removed = paths("removed");
        self.files.folders.retain(|folder| !removed.contains(folder));
        self.files.folders.extend(paths("added"));
    }

    fn change(&mut self, path: &Path, params: &Value) -> Result<(), Failure> {
        let (encoding, budgets) = (self.encoding, *self.files.budgets());
        self.outlines.give_up(path);
        let Some(open) = self.files.open.get_mut(path) else { return Ok(()) };
        let document = Arc::make_mut(&mut open.document);
        let mut broken = Ok(());
        for change in params["contentChanges"].as_array().into_iter().flatten() {
            let Some(text) = change["text"].as_str() else { continue };
            let range = match change.get("range").filter(|range| !range.is_null()) {
                Some(range) => encoding.bytes(document, range),
                None => Some(0..document.text().len()),
            };
            let Some(range) = range else { continue };
            for judged in self.judged.values_mut() {
                judged.edit(path, &range, text.len());
            }
            let edited = blaming("", || document.edit(range, text));
            if let Err(failure) = edited {
                *document = Document::new(document.text(), &budgets);
                broken = Err(failure);
            }
        }
        if let Some(version) = params["textDocument"]["version"].as_i64() {
            open.version = version;
        }
        self.changed(path, false)?;
        broken
    }

    /// Begins to answer with the outline of a file.
    ///
    /// # Errors
    /// If the file is not open, or there is no thread for it.
    pub(super) fn outline(
        &mut self,
        id: &Value,
        params: &Value,
        cancelled: Arc<AtomicBool>,
        queue: &Arc<Queue>,
    ) -> Result<(), Refusal> {
        let (path, document) = self.asked(params)?;
        let (uri, id, queue) = (self.uri(&path), id.clone(), queue.clone());
        let (encoding, is_tree) = (self.encoding, self.client.trees);
        self.outlines.begin(Asked { id, path, uri, document, encoding, is_tree, cancelled, queue })
    }

    /// Tells what is wrong with a file at once, and has the scenes that read it evaluated.
    fn changed(&mut self, path: &Path, whole: bool) -> Result<(), Failure> {
        self.publish(path)?;
        self.serial += 1;
        let reads = self.reads();
        let scenes = roots(&reads);
        self.pending.retain(|root, _| scenes.contains(root));
        for root in roots_of(&reads, path) {
            *self.pending.entry(root).or_default() |= whole;
        }
        // What no other file reads any more is a scene of its own.
        for root in scenes.into_iter().filter(|root| !self.judged.contains_key(root)) {
            self.pending.insert(root, true);
        }
        let texts = Arc::new(self.files.texts());
        self.judge.put(Job { serial: self.serial, roots: self.pending.clone(), texts });
        Ok(())
    }

    /// The open files, and what each of them reads.
    fn reads(&self) -> Reads {
        let open = self.files.open.keys().cloned();
        open.map(|root| (root.clone(), reached(&self.files, &root))).collect()
    }

    /// Takes what came of an evaluation, unless it is of older texts.
    ///
    /// # Errors
    /// If nothing can be told any more.
    pub(super) fn judged(&mut self, verdict: Verdict) -> Result<(), Failure> {
        if verdict.serial != self.serial {
            return Ok(());
        }
        self.begin();
        for judged in verdict.roots {
            let mut judged = self.without_own(judged);
            // What is wrong with meshes and textures holds until they are read again.
            let before = self.judged.remove(&judged.root).and_then(|before| before.built);
            judged.built = judged.built.or(before);
            self.pending.remove(&judged.root);
            self.judged.insert(judged.root.clone(), judged);
        }
        // A file that another one reads now is no scene of its own any more.
        let roots = roots(&self.reads());
        self.judged.retain(|root, _| roots.contains(root));
        self.publish_all()
    }

    /// A file by its URI.
    pub(super) fn document(&self, uri: &Value) -> Option<(PathBuf, Arc<Document>)> {
        let path = path_of(uri.as_str()?);
        let document = self.files.open.get(&path)?.document.clone();
        Some((path, document))
    }

    /// The document at a path, open or not.
    pub(super) fn any_document(&self, path: &Path) -> Option<Arc<Document>> {
        self.files.document(path)
    }
}

/// The files to evaluate when one has changed: those that read it and that no other reads.
fn roots_of(reads: &Reads, path: &Path) -> Vec<PathBuf> {
    let is_read =
        |file: &PathBuf| reads.iter().any(|(root, files)| root != file && files.contains(file));
    let concerned = || {
        let readers = reads.iter().filter(|(_, files)| files.iter().any(|file| file == path));
        readers.map(|(root, _)| root)
    };
    let roots: Vec<PathBuf> = concerned().filter(|root| !is_read(root)).cloned().collect();
    // Files that include one another in a circle: one of them tells it.
    if roots.is_empty() { concerned().take(1).cloned().collect() } else { roots }
}

/// Every file that is evaluated.
fn roots(reads: &Reads) -> BTreeSet<PathBuf> {
    reads.keys().flat_map(|path| roots_of(reads, path)).collect()
}
