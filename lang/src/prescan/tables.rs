//! Where a table ends.

use memchr::{memchr, memchr2};

use super::block_comment;

/// The bytes of the table with which a text begins; `None` if it does not end before what stands in none.
pub(crate) fn table(text: &[u8]) -> Option<usize> {
    let (mut at, mut seen) = (2, 2);
    loop {
        at = end_or_other(text, at)?;
        if text[at] == b']' {
            return Some(at + 1);
        }
        // In a comment it may stand.
        seen = behind_comments(text, seen, at);
        if seen == at {
            return None;
        }
        at = memchr(b']', &text[at..seen]).map_or(seen, |end| at + end);
    }
}

/// The first byte from one on that ends a table, or stands in none but in its comments.
fn end_or_other(text: &[u8], from: usize) -> Option<usize> {
    let (mut at, mut length) = (from, 1 << 6);
    while at < text.len() {
        let near = &text[at..text.len().min(at + length)];
        let found = memchr2(b']', b'[', near).into_iter().chain(memchr2(b'}', b'=', near)).min();
        if let Some(found) = found {
            return Some(at + found);
        }
        (at, length) = (at + near.len(), 2 * length);
    }
    None
}

/// The end of the comment that holds the byte at `at`, or `at`, if what stands between the two bytes begins
/// outside comments.
fn behind_comments(text: &[u8], mut from: usize, at: usize) -> usize {
    while let Some(slash) = text.get(from..at).and_then(|before| memchr(b'/', before)) {
        let comment = &text[from + slash..];
        from += slash
            + match comment {
                [b'/', b'/', ..] => memchr(b'\n', comment).unwrap_or(comment.len()),
                [b'/', b'*', ..] => block_comment(comment).unwrap_or(comment.len()),
                _ => 1,
            };
    }
    from.max(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_ends_at_its_bracket_unless_what_stands_in_none_comes_first() {
        let ends = |text: &str| table(text.as_bytes());
        assert_eq!(ends("#[1 2] m ]"), Some(6));
        assert_eq!(ends("#[1 /* } = [ */ 2 // =\n 3] ]"), Some(26));
        // The bracket ends it in a comment too.
        assert_eq!((ends("#[1 // } ] 2\n ]"), ends("#[1 ( ]")), (Some(10), Some(7)));
        let long = format!("#[{}", "1 ".repeat(1000));
        assert_eq!(ends(&format!("{long}]")), Some(2003));
        for wrong in ["}]", "a = 2\n]", "[ 1 ] ]", "/* */ } ]", "/ } ]", "", "/* ]", "// ="] {
            assert_eq!(
                ends(&format!("{long}{wrong}")),
                wrong.find("/* ]").map(|_| 2006),
                "{wrong}"
            );
        }
    }
}
