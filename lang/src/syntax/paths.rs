//! Paths of files that are written without quotes.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, told};

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
    Some(told(span, "the path of a file stands in quotes").fix(span, text))
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
