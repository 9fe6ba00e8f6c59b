//! Where a name comes from, across includes and imports; who else uses it; and another name for it.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::files::{FileError, normalise};
use luxel_sdk::params::Unit;

use super::document::Document;
use super::piece::Piece;
use super::symbols::{Role, Sort, Symbol};
use crate::syntax::StmtNode;
use crate::words::RESERVED;

/// Names behind one another's dots that are followed: far more than files that import one another.
pub(super) const MAX_DOTS: usize = 64;

/// The files that an editor knows.
pub trait Project {
    /// The file at a path as it is now: an open one as it is being edited.
    fn document(&self, path: &Path) -> Option<Arc<Document>>;

    /// Files that may refer to others: those that are open, and those beside them.
    fn files(&self) -> Vec<PathBuf>;

    /// How many bytes a file of any kind has.
    ///
    /// # Errors
    /// Why a scene could not read it.
    fn size(&self, path: &Path) -> Result<u64, FileError>;
}

/// Bytes of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The file.
    pub path: PathBuf,
    /// The bytes; none stand for the file as a whole.
    pub range: (usize, usize),
}

/// A name of a file, with the statement that it stands in.
pub(super) struct Found<'d> {
    pub(super) piece: &'d Piece,
    pub(super) symbol: &'d Symbol,
}

/// The name at a byte, or directly before it.
pub(super) fn symbol_at(document: &Document, at: usize) -> Option<Found<'_>> {
    let find = |near: usize| {
        let piece = document.piece_at(near)?;
        let holds = |symbol: &&Symbol| {
            let range = symbol.range(piece.start);
            range.start <= at && at <= range.end
        };
        let symbol = piece.symbols().iter().rev().find(holds)?;
        Some(Found { piece, symbol })
    };
    find(at).or_else(|| find(at.checked_sub(1)?))
}

/// Where what is named at a byte is defined.
pub fn definition(project: &dyn Project, path: &Path, at: usize) -> Option<Place> {
    let document = project.document(path)?;
    let found = symbol_at(&document, at)?;
    resolve(project, path, &document, &found)
}

/// Where a name is defined.
pub(super) fn resolve(
    project: &dyn Project,
    path: &Path,
    document: &Document,
    Found { piece, symbol }: &Found<'_>,
) -> Option<Place> {
    let here =
        |range: Range<usize>| Place { path: path.to_owned(), range: (range.start, range.end) };
    let other = |start: usize| Some(Found { piece, symbol: beginning(piece, start)? });
    match &symbol.role {
        Role::Definition(_) => Some(here(symbol.range(piece.start))),
        Role::Local(start) => Some(here(other(*start)?.symbol.range(piece.start))),
        Role::Top => document.top_before(piece, &symbol.text).map(here),
        Role::Member(_) => {
            let (first, names) = before_dots(piece, symbol)?;
            let place = resolve(project, path, document, &Found { piece, symbol: first })?;
            names.iter().try_fold(place, |module, name| member(project, &module, name))
        }
        Role::Argument(of) => {
            let function = resolve(project, path, document, &other(*of)?)?;
            argument(project, &function, &symbol.text)
        }
        Role::ParamOf(file) => top_of(project, &beside(path, file), &symbol.text),
        Role::Label | Role::Labelled => label(project, path, &symbol.text),
        Role::File => Some(Place { path: beside(path, &symbol.text), range: (0, 0) }),
    }
}

/// The name of a statement that begins at a byte of it.
fn beginning(piece: &Piece, start: usize) -> Option<&Symbol> {
    let symbols = piece.symbols();
    let i = symbols.binary_search_by_key(&start, |symbol| symbol.start).ok()?;
    Some(&symbols[i])
}

/// What stands before the first of the dots before a name, and the names after each of them.
fn before_dots<'d>(piece: &'d Piece, last: &'d Symbol) -> Option<(&'d Symbol, Vec<&'d str>)> {
    let (mut first, mut names) = (last, vec![]);
    while let Role::Member(of) = first.role {
        names.push(&*first.text);
        first = beginning(piece, of).filter(|_| names.len() <= MAX_DOTS)?;
    }
    names.reverse();
    Some((first, names))
}

/// Where a name of the file is defined that is imported at a place.
fn member(project: &dyn Project, module: &Place, name: &str) -> Option<Place> {
    let (file, of) = at_place(project, module, |symbol| match &symbol.role {
        Role::Definition(Sort::Import(file)) => Some(file.clone()),
        _ => None,
    })?;
    top_of(project, &beside(&of, &file), name)
}

/// The file that another one names.
pub(super) fn beside(path: &Path, name: &str) -> PathBuf {
    normalise(&path.parent().unwrap_or(Path::new("")).join(name))
}

fn top_of(project: &dyn Project, path: &Path, name: &str) -> Option<Place> {
    let range = project.document(path)?.top(name)?;
    Some(Place { path: path.to_owned(), range: (range.start, range.end) })
}

/// Something of the name at a place, and the file that it stands in.
fn at_place<T>(
    project: &dyn Project,
    place: &Place,
    what: impl Fn(&Symbol) -> Option<T>,
) -> Option<(T, PathBuf)> {
    let document = project.document(&place.path)?;
    let found = symbol_at(&document, place.range.0)?;
    Some((what(found.symbol)?, place.path.clone()))
}

/// Where a function that is defined at a place declares an argument.
fn argument(project: &dyn Project, function: &Place, name: &str) -> Option<Place> {
    let document = project.document(&function.path)?;
    let piece = document.piece_at(function.range.0)?;
    let own = function.range.0 - piece.start;
    let role = Role::Definition(Sort::ArgumentOf(own));
    let found = piece.symbols().iter().find(|s| s.role == role && *s.text == *name)?;
    let range = found.range(piece.start);
    Some(Place { path: function.path.clone(), range: (range.start, range.end) })
}

/// The first object of that label, in a file or one that it includes.
pub(super) fn label(project: &dyn Project, path: &Path, name: &str) -> Option<Place> {
    reached(project, path).into_iter().find_map(|path| {
        let document = project.document(&path)?;
        document.pieces().iter().find_map(|piece| {
            let is_it = |s: &&Symbol| s.role == Role::Label && *s.text == *name;
            let range = piece.symbols().iter().find(is_it)?.range(piece.start);
            Some(Place { path: path.clone(), range: (range.start, range.end) })
        })
    })
}

/// The files that a file names, itself first, each once.
pub fn reached(project: &dyn Project, path: &Path) -> Vec<PathBuf> {
    let mut out = vec![path.to_owned()];
    let mut next = 0;
    while let Some(path) = out.get(next).cloned() {
        next += 1;
        let Some(document) = project.document(&path) else { continue };
        let stmts = document.pieces().iter().flat_map(|piece| &piece.read.stmts);
        for stmt in stmts.filter(|stmt| !stmt.is_off()) {
            if let StmtNode::Include { path: name, .. } | StmtNode::Import { path: name, .. } =
                &stmt.node
            {
                let file = beside(&path, &name.text);
                if !out.contains(&file) {
                    out.push(file);
                }
            }
        }
    }
    out
}

/// Every place that means what is named at a byte, its definition included, in order.
pub fn references(project: &dyn Project, path: &Path, at: usize) -> Vec<Place> {
    let Some(target) = definition(project, path, at) else { return vec![] };
    let is_file = target.range.0 == target.range.1;
    let name = at_place(project, &target, |symbol| Some(symbol.text.clone())).map(|(name, _)| name);
    let mut files: BTreeSet<PathBuf> = project.files().into_iter().collect();
    files.extend(reached(project, path));
    let mut out = BTreeSet::new();
    for path in files {
        let Some(document) = project.document(&path) else { continue };
        for piece in document.pieces() {
            let may = |s: &&Symbol| {
                if is_file { s.role == Role::File } else { Some(&s.text) == name.as_ref() }
            };
            for symbol in piece.symbols().iter().filter(may) {
                let found = Found { piece, symbol };
                if resolve(project, &path, &document, &found).as_ref() == Some(&target) {
                    let range = symbol.range(piece.start);
                    out.insert(Place { path: path.clone(), range: (range.start, range.end) });
                }
            }
        }
    }
    out.into_iter().collect()
}

/// What can be renamed at a byte: its bytes without quotes, and its name.
///
/// # Errors
/// Why nothing can.
pub fn renamable(project: &dyn Project, path: &Path, at: usize) -> Result<(Place, String), String> {
    let nothing = || "nothing here has a name of its own".to_owned();
    let document = project.document(path).ok_or_else(nothing)?;
    let found = symbol_at(&document, at).ok_or_else(nothing)?;
    if found.symbol.role == Role::File {
        return Err("a file is not renamed from here".to_owned());
    }
    let Some(_) = resolve(project, path, &document, &found) else {
        return Err(format!("`{}` is not defined in any scene file", found.symbol.text));
    };
    let place = bare(&document, Place { path: path.to_owned(), range: ends(&found) });
    Ok((place, found.symbol.text.to_string()))
}

fn ends(found: &Found<'_>) -> (usize, usize) {
    let range = found.symbol.range(found.piece.start);
    (range.start, range.end)
}

/// A place without its quotes.
fn bare(document: &Document, mut place: Place) -> Place {
    if document.text().as_bytes().get(place.range.0) == Some(&b'"') {
        place.range = (place.range.0 + 1, place.range.1 - 1);
    }
    place
}

/// Every place that must be given the new name.
///
/// # Errors
/// Why it cannot be had.
pub fn rename(
    project: &dyn Project,
    path: &Path,
    at: usize,
    new: &str,
) -> Result<Vec<Place>, String> {
    let (_, old) = renamable(project, path, at)?;
    let document = project.document(path).ok_or("there is no such file")?;
    let is_label = symbol_at(&document, at)
        .is_some_and(|found| matches!(found.symbol.role, Role::Label | Role::Labelled));
    allowed(new, is_label)?;
    let places = references(project, path, at);
    let files: BTreeSet<&PathBuf> = places.iter().map(|place| &place.path).collect();
    for path in files.into_iter().filter(|_| new != old) {
        let Some(document) = project.document(path) else { continue };
        let mut symbols = document.pieces().iter().flat_map(Piece::symbols);
        if symbols.any(|symbol| &*symbol.text == new && symbol.role != Role::File) {
            return Err(format!("`{new}` has a meaning already in {}", path.display()));
        }
    }
    let bare = |place: Place| {
        let document = project.document(&place.path);
        document.map_or(place.clone(), |document| bare(&document, place))
    };
    Ok(places.into_iter().map(bare).collect())
}

/// Whether something may have that name.
fn allowed(name: &str, is_label: bool) -> Result<(), String> {
    let mut chars = name.chars();
    let begins = chars.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !begins || !chars.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Err(format!("`{name}` is not a name: letters, digits and `_`, no digit first"));
    }
    if RESERVED.contains(&name) && !is_label {
        return Err(format!("`{name}` is a word of the language and cannot be a name"));
    }
    if Unit::named(name).is_some() && !is_label {
        return Err(format!("`{name}` is a unit and cannot be a name"));
    }
    Ok(())
}
