//! Scenes with words deleted, doubled, exchanged and put in. Shared with `tests/fuzz`, as a file that
//! it takes in.

/// The words, numbers and marks of a text, and the blanks between them.
pub(crate) fn pieces(text: &str) -> Vec<&str> {
    let kind = |c: char| match c {
        c if c.is_alphanumeric() || c == '_' => 0,
        c if c.is_whitespace() => 1,
        _ => 2,
    };
    let (mut out, mut start, mut last) = (vec![], 0, 3);
    for (at, c) in text.char_indices() {
        if at > start && (kind(c) != last || last == 2) {
            out.push(&text[start..at]);
            start = at;
        }
        last = kind(c);
    }
    out.push(&text[start..]);
    out
}

/// Does up to four changes to a text, each where `below` chooses; what is put in is one of `words`.
pub(crate) fn damaged(
    text: &str,
    words: &[impl AsRef<str>],
    below: &mut dyn FnMut(usize) -> usize,
) -> String {
    let mut parts = pieces(text);
    for _ in 0..=below(4) {
        let (at, other) = (below(parts.len()), below(parts.len()));
        let word = words[below(words.len())].as_ref();
        match below(5) {
            0 if parts.len() > 1 => drop(parts.remove(at)),
            0 | 1 => parts.insert(at, parts[other]),
            2 => parts.swap(at, other),
            3 => parts.insert(at, word),
            _ => parts[at] = word,
        }
    }
    parts.concat()
}
