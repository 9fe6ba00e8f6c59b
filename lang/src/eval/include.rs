//! Scene files: reading, including and importing them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Near, SourceId, Span, near};
use luxel_core::files::FileError;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, Unit};

use super::emit::Labels;
use super::env::{Env, File, Override};
use super::exec::{Body, Place};
use super::resolve::resolve;
use super::value::{FieldValue, Module, Value};
use super::{Evaluator, OpenGroup};
use crate::syntax::{self, ExprNode, Name, Stmt, StmtNode, Tree};

/// A file, read once.
#[derive(Debug)]
pub(super) struct ReadFile {
    tree: Tree,
    units: BTreeMap<Dimension, f64>,
}

impl Evaluator<'_> {
    /// Evaluates the file that was asked for, with `--set`.
    pub(super) fn root(&mut self, path: &Path, set: &[(String, String)]) {
        self.open_groups.push(OpenGroup::default());
        let canonical = self.files.canonical(path);
        let text = match self.bytes(path) {
            Ok(bytes) => self.text(path, &bytes, None),
            Err(error) => {
                self.tell(unreadable(path, &error));
                None
            }
        };
        let Some((text, source)) = text else {
            if self.sources.first().is_none() {
                self.sources.add(path.to_string_lossy(), "");
            }
            self.damaged = true;
            self.unseen.thing = true;
            return;
        };
        self.chain.push((canonical, None));
        self.labels = Labels::of(&text);
        if let Some(declared) = self.declared(&text, source, set) {
            self.run_in_turns((&text, source), path, declared, set);
        } else {
            let read = self.read_text(&text, source);
            let overrides = self.settings(&read.tree, set);
            self.run(&read, path, overrides, true);
            self.apply_sets();
        }
        self.chain.pop();
    }

    /// The text of a file; `None` after a mistake.
    fn text(
        &mut self,
        path: &Path,
        bytes: &[u8],
        from: Option<Span>,
    ) -> Option<(Arc<str>, SourceId)> {
        let name = path.to_string_lossy();
        let limit = self.budgets.file_bytes;
        let total = self.bytes_read.saturating_add(bytes.len());
        if bytes.len() > limit || total > self.budgets.total_bytes {
            let (message, budget) = if bytes.len() > limit {
                let message = format!("{name} has {} bytes; the limit is {limit}", bytes.len());
                (message, "file_bytes")
            } else {
                let limit = self.budgets.total_bytes;
                (format!("all scene files have more than {limit} bytes"), "total_bytes")
            };
            self.tell(placed("E0504", from, message).help(self.budgets.allows(budget)));
            return None;
        }
        self.bytes_read = total;
        let text = match str::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                let at = error.valid_up_to();
                let text = String::from_utf8_lossy(&bytes[..at]).into_owned();
                let source = self.sources.add(name, text);
                let span = Span::new(source, at, at);
                let message = format!("byte {at} of the file is not UTF-8");
                self.tell(Diagnostic::error("E0003", span, message));
                return None;
            }
        };
        let text: Arc<str> = text.into();
        let known = self.sources.find(&name, &text).filter(|_| self.n_foreseen > 0);
        let source = known.unwrap_or_else(|| self.sources.add(name, text.clone()));
        Some((text, source))
    }

    fn read_text(&mut self, text: &str, source: SourceId) -> Rc<ReadFile> {
        let tree = syntax::parse(text, source, &self.budgets, &mut self.sink);
        resolve(&tree, text, &mut self.sink);
        self.stopped |= self.sink.is_full();
        let units = self.units(&tree.stmts);
        Rc::new(ReadFile { tree, units })
    }

    /// What bare numbers count in a file.
    pub(super) fn units(&mut self, stmts: &[Stmt]) -> BTreeMap<Dimension, f64> {
        let mut out = self.units_meant(stmts);
        let blocks = stmts.iter().filter(|stmt| !stmt.is_off());
        let fields = blocks.filter_map(|stmt| match &stmt.node {
            StmtNode::Units(fields) => Some(fields),
            _ => None,
        });
        let mut said = BTreeMap::new();
        for field in fields.flatten() {
            let Some(wanted) = super::types::dimension(&field.name.text).filter(|d| !d.is_none())
            else {
                let message = format!("`{}` is not something that has a unit", field.name.text);
                let known: Vec<_> = super::types::measured().collect();
                let found = Diagnostic::error("E0215", field.name.span, message)
                    .meant(field.name.span, near(&field.name.text, known.iter().copied()))
                    .help(format!("known are {}", known.join(", ")));
                self.tell(found);
                // What it was to be the unit of is not known: numbers without one are no mistakes.
                out.extend(super::types::measured().filter_map(super::types::dimension).map(one));
                continue;
            };
            let unit = match &field.value.node {
                ExprNode::Path(path) if path.len() == 1 => Unit::named(&path[0].text),
                _ => None,
            };
            match unit {
                Some(unit) if unit.dimension == wanted => {
                    if let Some(first) = said.insert(wanted, field.name.span) {
                        let message = format!("the unit of `{}` is given twice", field.name.text);
                        let found = Diagnostic::error("E0404", field.name.span, message);
                        self.tell(found.label(first, "first given here"));
                    }
                    out.insert(wanted, unit.scale);
                }
                Some(unit) => {
                    let message =
                        format!("{} is wanted, this is {}", wanted.name(), unit.dimension.name());
                    self.poison("E0202", field.value.span, message);
                    out.extend([one(wanted)]);
                }
                None => {
                    let span = field.value.span;
                    let message = format!("a unit's name is wanted, for {}", wanted.name());
                    let found = Diagnostic::error("E0204", span, message);
                    let fits =
                        |name| Unit::named(name).is_some_and(|unit| unit.dimension == wanted);
                    let near = syntax::suggest_unit(self.written(span));
                    let near = near.filter(|(name, _)| fits(name));
                    let near = near.map(|(name, grade)| Near { name, grade });
                    self.tell(found.meant(span, near));
                    out.extend([one(wanted)]);
                }
            }
        }
        out
    }

    /// A unit for everything, if a statement that cannot be read was meant to say units.
    fn units_meant(&self, stmts: &[Stmt]) -> BTreeMap<Dimension, f64> {
        let is_meant = |stmt: &Stmt| {
            matches!(stmt.node, StmtNode::Broken { .. } | StmtNode::Object(_))
                && syntax::says_units(self.written(stmt.span))
        };
        if !stmts.iter().any(is_meant)
            && !stmts.first().is_some_and(|stmt| self.follows_units(stmt))
        {
            return BTreeMap::new();
        }
        super::types::measured().filter_map(super::types::dimension).map(one).collect()
    }

    /// Whether what stands before the first statement, and is none, says units.
    fn follows_units(&self, first: &Stmt) -> bool {
        // Of statements that are read one by one it is not known what stands between them.
        if self.begun.contains_key(&first.span.source) {
            return false;
        }
        let text = self.sources.text(first.span.source);
        let before = text.get(..first.span.range().start).unwrap_or_default();
        let mut braces = memchr::memchr_iter(b'{', before.as_bytes());
        braces.next().is_some_and(|at| syntax::says_units(&before[at..]))
    }

    /// Evaluates a file that was read; gives its names.
    fn run(
        &mut self,
        read: &ReadFile,
        path: &Path,
        overrides: BTreeMap<Arc<str>, Override>,
        is_root: bool,
    ) -> Env {
        let env = Self::file_env(path, read.units.clone(), overrides, is_root);
        self.stmts(&read.tree.stmts, &env, &mut Body::new(Place::File));
        env
    }

    /// What stands around the statements of a file.
    pub(super) fn file_env(
        path: &Path,
        units: BTreeMap<Dimension, f64>,
        overrides: BTreeMap<Arc<str>, Override>,
        is_root: bool,
    ) -> Env {
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Env::new(Rc::new(File { folder, units, overrides, is_root }))
    }

    /// Whether a file is no scene by its name, which is told with how it is read.
    fn is_no_scene(&mut self, name: &Name) -> bool {
        let (file, path) = (&name.text, Path::new(&*name.text));
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let importer = if ending == "glb" { "gltf" } else { &ending };
        let how = match &*ending {
            "ply" => format!("shape mesh {{ file = \"{file}\", unit = 1 m }}"),
            "png" | "jpg" | "jpeg" | "exr" | "hdr" => {
                format!("texture image {{ file = \"{file}\" }}")
            }
            _ if self.registry.class(Kind::Importer, importer).is_some() => {
                format!("asset {importer} {{ file = \"{file}\", unit = 1 m }}")
            }
            _ => return false,
        };
        let found = Diagnostic::error("E0001", name.span, format!("\"{file}\" is no scene"));
        self.tell(found.help(format!("it is read by `{how}`")));
        true
    }

    /// The file that a statement names: its path and text. `None` after a mistake.
    fn open(&mut self, name: &Name, env: &Env) -> Option<(PathBuf, PathBuf, Rc<ReadFile>)> {
        if self.is_no_scene(name) {
            return None;
        }
        let path = env.file.folder.join(&*name.text);
        let canonical = self.files.canonical(&path);
        if let Some(at) = self.chain.iter().position(|(open, _)| *open == canonical) {
            self.cycle(at, name, &canonical);
            return None;
        }
        if self.chain.len() > self.budgets.include_depth {
            let message =
                format!("files include one another more than {} deep", self.budgets.include_depth);
            let found = Diagnostic::error("E0505", name.span, message);
            self.tell(found.help(self.budgets.allows("include_depth")));
            return None;
        }
        self.includes += 1;
        if self.includes > self.budgets.includes {
            let message = format!("files are included more than {} times", self.budgets.includes);
            self.over_budget("E0505", name.span, message, "includes");
            return None;
        }
        if let Some(read) = self.read.get(&canonical) {
            return Some((path, canonical, read.clone()));
        }
        let bytes = match self.bytes(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.unreadable(name, &path, &error);
                return None;
            }
        };
        let (text, source) = self.text(&path, &bytes, Some(name.span))?;
        let read = self.read_text(&text, source);
        self.read.insert(canonical.clone(), read.clone());
        Some((path, canonical, read))
    }

    /// Tells that a scene's file cannot be read.
    pub(super) fn unreadable(&mut self, name: &Name, path: &Path, error: &FileError) {
        let message = format!("\"{}\": {error}", name.text);
        let found = Diagnostic::error(code(error), name.span, message);
        self.tell(found.help(format!("looked for {}", path.display())));
    }

    fn cycle(&mut self, at: usize, name: &Name, canonical: &Path) {
        let names: Vec<String> = self.chain[at..]
            .iter()
            .map(|(path, _)| path)
            .chain([&canonical.to_path_buf()])
            .map(|path| path.display().to_string())
            .collect();
        let message = format!("files include one another in a circle: {}", names.join(" → "));
        let mut found = Diagnostic::error("E0106", name.span, message);
        let asked: Vec<Span> = self.chain[at..].iter().filter_map(|(_, span)| *span).collect();
        for span in asked {
            found = found.label(span, "which is included here");
        }
        self.tell(found);
    }

    /// `include "f" with { … }`: what the file emits, here.
    pub(super) fn include(&mut self, name: &Name, with: Vec<FieldValue>, env: &Env) {
        let Some((path, canonical, read)) = self.open(name, env) else {
            self.damaged = true;
            self.unseen.thing = true;
            return;
        };
        let params: Vec<&Name> = params(&read.tree).collect();
        let mut overrides = BTreeMap::new();
        for field in with {
            if !params.iter().any(|p| p.text == field.name.text) {
                if is_damaged(&read.tree) {
                    continue;
                }
                self.no_param(&field.name, &params);
                continue;
            }
            let given = Override { value: field.value, span: field.span };
            overrides.insert(field.name.text, given);
        }
        if self.enter(name.span) {
            self.chain.push((canonical, Some(name.span)));
            self.run(&read, &path, overrides, false);
            self.chain.pop();
        }
        self.leave();
    }

    fn no_param(&mut self, name: &Name, params: &[&Name]) {
        let message = format!("the file declares no parameter `{}`", name.text);
        let known = || params.iter().map(|p| &*p.text);
        let found = Diagnostic::error("E0111", name.span, message)
            .meant(name.span, near(&name.text, known()));
        self.tell(found);
    }

    /// `import "f" as n`: the file's names, and nothing that it emits.
    pub(super) fn import(&mut self, name: &Name, env: &Env) -> Value {
        let Some((path, canonical, read)) = self.open(name, env) else {
            self.unseen.thing = true;
            return Value::Poison;
        };
        if let Some(module) = self.imported.get(&canonical) {
            return Value::Module(module.clone());
        }
        let mut names = BTreeMap::new();
        if self.enter(name.span) {
            // What it emits goes into a group that is dropped, and fills no slot.
            let labels = std::mem::take(&mut self.labels);
            let has_asset = self.has_asset;
            self.quiet += 1;
            self.open_groups.push(OpenGroup::default());
            self.chain.push((canonical.clone(), Some(name.span)));
            names = self.run(&read, &path, BTreeMap::new(), false).names();
            self.chain.pop();
            self.open_groups.pop();
            self.quiet -= 1;
            (self.labels, self.has_asset) = (labels, has_asset);
        }
        self.leave();
        let module = Rc::new(Module { names, path: name.text.to_string() });
        self.imported.insert(canonical, module.clone());
        Value::Module(module)
    }
}

/// What is said of a scene that cannot be read.
pub fn unreadable(path: &Path, error: &FileError) -> Diagnostic {
    Diagnostic::unplaced(code(error), format!("{}: {error}", path.display()))
}

fn code(error: &FileError) -> &'static str {
    match error {
        FileError::Outside => "E0108",
        FileError::TooLarge(_) => "E0504",
        _ => "E0107",
    }
}

/// The names of the parameters that a file declares.
pub(super) fn params(tree: &Tree) -> impl Iterator<Item = &Name> {
    tree.stmts.iter().filter_map(|stmt| match &stmt.node {
        StmtNode::Param(def) => Some(&def.name),
        _ => None,
    })
}

/// The SI unit of a dimension.
fn one(dimension: Dimension) -> (Dimension, f64) {
    (dimension, 1.0)
}

/// Whether a statement could not be read: it may have declared anything.
pub(super) fn is_damaged(tree: &Tree) -> bool {
    tree.stmts.iter().any(Stmt::is_broken)
}

fn placed(code: &'static str, span: Option<Span>, message: String) -> Diagnostic {
    match span {
        Some(span) => Diagnostic::error(code, span, message),
        None => Diagnostic::unplaced(code, message),
    }
}
