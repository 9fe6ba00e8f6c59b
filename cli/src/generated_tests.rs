//! Documents are written anew between their comments, and nowhere else.

use super::generated::{part, replaced};

const TEXT: &str = "# A\n\n<!-- begin: a -->\n\nold\n\n<!-- end: a -->\n\nrest\n";

#[test]
fn what_stands_between_comments_is_replaced_and_nothing_else() {
    assert_eq!(part(TEXT, "a").unwrap().trim(), "old");
    let new = replaced(TEXT, "a", "| new |\n").unwrap();
    assert_eq!(new, TEXT.replace("old", "| new |"));
    // What is written again is the same.
    assert_eq!(replaced(&new, "a", "| new |").unwrap(), new);
    let empty = TEXT.replace("\nold\n\n", "");
    assert_eq!(replaced(&empty, "a", "old").unwrap(), TEXT);
}

#[test]
fn missing_doubled_and_crossed_comments_are_told() {
    let crossed = TEXT.replace("begin", "x").replace("end", "begin").replace("x:", "end:");
    for (text, expected) in [
        (TEXT.replace("end: a", "end: b"), "no line `<!-- end: a -->`"),
        (TEXT.replace("begin: a", "begin: b"), "no line `<!-- begin: a -->`"),
        (TEXT.repeat(2), "more than one line `<!-- begin: a -->`"),
        (crossed, "the end of `a` stands before its beginning"),
    ] {
        assert_eq!(replaced(&text, "a", "new"), Err(expected.to_owned()));
    }
}
