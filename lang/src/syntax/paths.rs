//! Paths of files that are written without quotes.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, told};
use super::defined::stem;
use super::lex::{Token, TokenKind};

/// How files end that scenes name.
const ENDINGS: [&str; 16] = [
    "csv", "exr", "glb", "gltf", "hdr", "jpeg", "jpg", "obj", "pfm", "ply", "png", "scene", "spd",
    "stl", "tga", "tif",
];

/// Bytes of a path on each side of a place that are looked at, at most.
const LONGEST: usize = 1 << 10;

/// The bytes around byte `at` of a text that look like the path of a file.
pub(crate) fn path_around(text: &str, at: usize) -> Option<Range<usize>> {
    let is_of_path = |c: &u8| c.is_ascii_alphanumeric() || b"_-./".contains(c);
    let before = text.get(..at)?.bytes().rev().take(LONGEST);
    let after = text.get(at..)?.bytes().take(LONGEST);
    let start = at - before.take_while(is_of_path).count();
    let end = at + after.take_while(is_of_path).count();
    let (name, ending) = text[start..end].rsplit_once('.')?;
    (!name.is_empty() && ENDINGS.contains(&ending)).then_some(start..end)
}

/// `file = ./wood.png`
pub(super) fn unquoted(around: &Around<'_>) -> Option<Diagnostic> {
    let mut near = [around.current(), around.before(1)].into_iter().flatten();
    let path = near.find_map(|token| path_around(around.text, token.start))?;
    let text = format!("\"{}\"", &around.text[path.clone()]);
    let span = Span::new(around.source, path.start, path.end);
    let found = told(span, "the path of a file stands in quotes");
    let begins = around.tokens.iter().position(|token| token.start == path.start);
    // By itself it may be anything.
    Some(if begins.is_some_and(|i| around.begins(i)) { found } else { found.fix(span, text) })
}

/// `from "tools.scene" import ball` and `import ball from "tools.scene"`
pub(super) fn imported_from(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(2);
    let start = (first..=around.at).find(|i| around.begins(*i))?;
    let path = match (around.word(start), around.word(start + 2)) {
        ("from", "import") => start + 1,
        ("import", "from") => start + 3,
        _ => return None,
    };
    let on_line = |token: &&Token<'_>| !token.first_on_line;
    let path = around.tokens.get(path).filter(|path| path.kind == TokenKind::Text)?;
    let rest = around.tokens[start + 1..].iter().take_while(on_line);
    let (names, last) = (rest.clone().filter(|token| token.kind == TokenKind::Word), rest.last()?);
    let module = stem(path.text).unwrap_or("lib");
    let all = around.span(&around.tokens[start]).to(around.span(last));
    let found = told(all, "a file is imported as a whole, under a name");
    let found = match names.filter(|word| !matches!(word.text, "from" | "import")).last() {
        Some(name) => found.help(format!("what it defines is then `{module}.{}`", name.text)),
        None => found,
    };
    Some(found.guess(all, format!("import {} as {module}", path.text)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_looks_like_a_file_is_found_around_each_of_its_bytes() {
        let text = "a = ../wood/oak-2.png, b = 3.5 / x.y, c = .obj";
        for at in 4..21 {
            assert_eq!(path_around(text, at), Some(4..21), "{at}");
        }
        for at in [0, 2, 22, 27, 34, 44] {
            assert_eq!(path_around(text, at), None, "{at}");
        }
    }
}
