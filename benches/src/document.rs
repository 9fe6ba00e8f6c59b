//! Documents that a measurement writes a part of.

use std::path::Path;

use crate::generated;

/// Puts `body` between the comments of that name in a file.
///
/// # Errors
/// As `generated::part`, and what the disk says, with the file's name.
pub(crate) fn write(path: &Path, name: &str, body: &str) -> Result<(), String> {
    change(path, |text| generated::replaced(text, name, body))
}

/// Puts cells behind a label, which begins one row of a table in a file; the row's other cells stay.
///
/// # Errors
/// Not one row begins so, or it has fewer cells; what the disk says; all with the file's name.
pub(crate) fn write_row(path: &Path, label: &str, cells: &[String]) -> Result<(), String> {
    change(path, |text| with_row(text, label, cells))
}

/// Changes a file: all of it or nothing, through a file beside it.
#[expect(clippy::disallowed_methods, reason = "a document of the project is written anew")]
fn change(path: &Path, to: impl FnOnce(&str) -> Result<String, String>) -> Result<(), String> {
    let told = |message: String| format!("{}: {message}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| told(error.to_string()))?;
    let text = to(&text).map_err(told)?;
    let beside = path.with_extension("part");
    let written = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, path));
    written.map_err(|error| told(error.to_string()))
}

fn with_row(text: &str, label: &str, cells: &[String]) -> Result<String, String> {
    let begin = format!("| {label} |");
    let mut rows = text.lines().filter_map(|line| line.strip_prefix(&begin));
    let old = match (rows.next(), rows.next()) {
        (Some(old), None) => old,
        (None, _) => return Err(format!("no row `{begin}`")),
        (Some(_), Some(_)) => return Err(format!("more than one row `{begin}`")),
    };
    let inner = old.trim_end().strip_suffix('|').unwrap_or(old);
    let there: Vec<&str> = inner.split('|').map(str::trim).collect();
    let kept = there.get(cells.len()..).ok_or_else(|| format!("too few cells in `{begin}`"))?;
    let cells = cells.iter().map(String::as_str).chain(kept.iter().copied());
    let new: String = cells
        .map(|cell| if cell.is_empty() { " |".to_owned() } else { format!(" {cell} |") })
        .collect();
    Ok(text.replacen(&format!("\n{begin}{old}"), &format!("\n{begin}{new}"), 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# A\n\n| | us | them |\n|---|---|---|\n| time | 1 s | 2 s |\n| size | 3 MB | |\n\nBoth | time |\n";

    #[test]
    fn a_row_takes_new_cells_and_keeps_the_rest() {
        let row = |label, cells: &[&str]| {
            let cells: Vec<String> = cells.iter().map(|cell| (*cell).to_owned()).collect();
            with_row(TEXT, label, &cells)
        };
        assert_eq!(row("time", &["9 s"]), Ok(TEXT.replace("| 1 s |", "| 9 s |")));
        assert_eq!(row("size", &["4 MB"]), Ok(TEXT.replace("3 MB", "4 MB")));
        assert_eq!(row("size", &["4 MB", "5 MB"]), Ok(TEXT.replace("3 MB | |", "4 MB | 5 MB |")));
        assert_eq!(row("size", &[]), Ok(TEXT.to_owned()));
        assert_eq!(row("weight", &["1 g"]), Err("no row `| weight |`".to_owned()));
        assert_eq!(row("time", &["1", "2", "3"]), Err("too few cells in `| time |`".to_owned()));
        let twice = with_row(&TEXT.replace("size", "time"), "time", &[]);
        assert_eq!(twice, Err("more than one row `| time |`".to_owned()));
    }
}
