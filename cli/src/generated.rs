//! Parts of documents that a command writes, between comments that name them:
//! `<!-- begin: NAME -->` and `<!-- end: NAME -->`, each on a line of its own.
//!
//! Shared with the tests and the benches, as a file that they take in.

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
