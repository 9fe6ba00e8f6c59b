//! Spectra in text files: a wavelength in nm and values, by blanks or commas.

/// The points of a spectrum: the first column in nm and the named one, or the second.
///
/// `#` and `//` begin comments. A first line that holds words is a header; only then can a column be
/// named.
///
/// # Errors
/// What is wrong, with its line.
pub(super) fn read(
    bytes: &[u8],
    column: Option<&str>,
    limit: usize,
) -> Result<Vec<(f64, f64)>, String> {
    let text =
        str::from_utf8(bytes).map_err(|e| format!("byte {} is not UTF-8", e.valid_up_to()))?;
    let mut header: Option<Vec<&str>> = None;
    let mut place = None;
    let mut points = vec![];
    for (i, line) in text.trim_start_matches('\u{FEFF}').lines().enumerate() {
        let line = line.split('#').next().unwrap_or("");
        let line = line.split("//").next().unwrap_or("").trim();
        if line.is_empty() {
            continue;
        }
        let cells: Vec<&str> = cells(line).take(1024).collect();
        // A quote alone.
        let Some(first) = cells.first() else { continue };
        let is_header = points.is_empty() && header.is_none() && first.parse::<f64>().is_err();
        if is_header {
            header = Some(cells);
            continue;
        }
        let at = match place {
            Some(at) => at,
            None => *place.insert(find(column, header.as_deref())?),
        };
        let number = |at: usize| {
            let cell = cells.get(at).ok_or(format!("line {} has no column {}", i + 1, at + 1))?;
            cell.parse::<f64>().map_err(|_| format!("line {}: `{cell}` is not a number", i + 1))
        };
        points.push((number(0)?, number(at)?));
        if points.len() > limit {
            return Err(format!("it has more than {limit} points"));
        }
    }
    if points.is_empty() { Err("it holds no points".to_owned()) } else { Ok(points) }
}

fn cells(line: &str) -> impl Iterator<Item = &str> {
    let commas = line.contains([',', ';']);
    line.split(move |c: char| if commas { c == ',' || c == ';' } else { c.is_whitespace() })
        .map(|cell| cell.trim().trim_matches('"'))
        .filter(move |cell| commas || !cell.is_empty())
}

fn find(column: Option<&str>, header: Option<&[&str]>) -> Result<usize, String> {
    let Some(name) = column else { return Ok(1) };
    let Some(header) = header else {
        return Err(format!("it has no line of column names in which to find `{name}`"));
    };
    let found = header.iter().position(|cell| *cell == name);
    found.ok_or_else(|| format!("it has no column `{name}`; there are {}", header.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_by_blank_comma_and_name() {
        let two = vec![(400.0, 0.1), (700.0, 0.5)];
        assert_eq!(read(b"# x\n400 0.1\n700\t.5\n", None, 9), Ok(two.clone()));
        assert_eq!(read(b"\"\n400 0.1\n\"\"\n700 .5", None, 9), Ok(two.clone()));
        assert_eq!(read(b"nm,a,b\n400,9,0.1\n700,9,.5", Some("b"), 9), Ok(two));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let check = |text: &str, column, part: &str| {
            let error = read(text.as_bytes(), column, 2).unwrap_err();
            assert!(error.contains(part), "{error}");
        };
        check("400 x", None, "line 1: `x`");
        check("400", None, "no column 2");
        check("", None, "no points");
        check("400 1", Some("a"), "column names");
        check("nm,b\n400,1", Some("a"), "there are nm, b");
        check("1 1\n2 1\n3 1", None, "more than 2");
    }
}
