//! Parts of documents that a command writes, between comments that name them:
//! `<!-- begin: NAME -->` and `<!-- end: NAME -->`, each on a line of its own.
//!
//! Shared by the tests and the benches, as a file that both take in.

use std::path::Path;

/// What stands between the comments of that name.
///
/// # Errors
/// A comment that is missing, stands twice, or ends before it begins.
pub(crate) fn part<'a>(text: &'a str, name: &str) -> Result<&'a str, String> {
    let place = |comment: &str| {
        let mut places = text.match_indices(comment).map(|(place, _)| place);
        match (places.next(), places.next()) {
            (Some(place), None) => Ok(place),
            (None, _) => Err(format!("no line `{}`", comment.trim())),
            (Some(_), Some(_)) => Err(format!("more than one line `{}`", comment.trim())),
        }
    };
    let begin = format!("\n<!-- begin: {name} -->\n");
    let (begins, ends) = (place(&begin)?, place(&format!("\n<!-- end: {name} -->\n"))?);
    let from = begins + begin.len();
    // The line break before the end is also that of the beginning where nothing stands between.
    text.get(from..ends + 1)
        .ok_or_else(|| format!("the end of `{name}` stands before its beginning"))
}

/// The text with `body` between the comments of that name.
///
/// # Errors
/// As `part`.
pub(crate) fn replaced(text: &str, name: &str, body: &str) -> Result<String, String> {
    let old = part(text, name)?;
    let from = old.as_ptr().addr() - text.as_ptr().addr();
    let (before, after) = (&text[..from], &text[from + old.len()..]);
    Ok(format!("{before}\n{}\n\n{after}", body.trim()))
}

/// Puts `body` between the comments of that name in a file: all of it or nothing, through a file
/// beside it.
///
/// # Errors
/// As `part`, and what the disk says, with the file's name.
#[expect(clippy::disallowed_methods, reason = "a document of the project is written anew")]
pub(crate) fn write(path: &Path, name: &str, body: &str) -> Result<(), String> {
    let told = |message: String| format!("{}: {message}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| told(error.to_string()))?;
    let text = replaced(&text, name, body).map_err(told)?;
    let beside = path.with_extension("part");
    let written = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, path));
    written.map_err(|error| told(error.to_string()))
}
