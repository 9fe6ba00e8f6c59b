//! What a library's file says of itself, before any of its code runs.

use object::{Object, ObjectSegment};

use super::{LoadError, SYMBOL};

/// Whether these bytes are a whole dynamic library that shows a plugin's table.
///
/// # Errors
/// What is wrong, as far as it can be told without opening the library.
pub fn inspect(bytes: &[u8], stem: &str) -> Result<(), LoadError> {
    let bad = |why: &dyn std::fmt::Display| {
        LoadError::new(format!("not a dynamic library, or cut off: {why}"))
    };
    let file = object::File::parse(bytes).map_err(|error| bad(&error))?;
    for segment in file.segments() {
        let (offset, size) = segment.file_range();
        if offset.checked_add(size).is_none_or(|end| end > bytes.len() as u64) {
            return Err(bad(&"a segment ends beyond the file"));
        }
    }
    let symbol = format!("{SYMBOL}{stem}");
    let exports = file.exports().map_err(|error| bad(&error))?;
    // Mach-O puts an underscore before every name.
    let named = |name: &[u8]| name.strip_prefix(b"_").unwrap_or(name) == symbol.as_bytes();
    if exports.iter().any(|export| named(export.name())) {
        return Ok(());
    }
    let other = exports
        .iter()
        .filter_map(|export| std::str::from_utf8(export.name()).ok())
        .find_map(|name| name.strip_prefix('_').unwrap_or(name).strip_prefix(SYMBOL));
    Err(LoadError::new(match other {
        Some(other) => format!(
            "its table is `{SYMBOL}{other}`, and `{symbol}` is wanted: a library is called as it was \
             when it was built, `{other}`"
        ),
        None => format!("no Luxel plugin: it has no symbol `{symbol}`"),
    }))
}
