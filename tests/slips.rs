//! How many messages a slip of one token brings: one, not a cascade.

use std::fmt::Write as _;
use std::ops::Range;

use crate::disk::{files_below, root, text};
use crate::seeded::messages;

/// One slip in so many is tried.
const STEP: usize = 7;

/// What is written instead of a token, a gap and the next token.
type Slip = fn(&str, &str, &str) -> String;

/// What may go wrong with a token.
const SLIPS: [(&str, Slip); 4] = [
    ("lost", |_, gap, next| format!("{gap}{next}")),
    ("doubled", |token, gap, next| format!("{token} {token}{gap}{next}")),
    ("swapped with the next", |token, gap, next| format!("{next}{gap}{token}")),
    ("mistyped", |token, gap, next| format!("{}{gap}{next}", mistyped(token))),
];

#[test]
fn a_slip_of_one_token_is_told_once() {
    let (mut slips, mut n, mut log) = (0, 0_usize, String::new());
    let mut by_count = [0_usize; 4];
    for folder in ["scenes", "tests/seeded"] {
        for path in files_below(&root().join(folder), "scene") {
            if path.ends_with("parts/stage.scene") || path.ends_with("parts/frames.scene") {
                continue;
            }
            let right = text(&path);
            let tokens = tokens(&right);
            for pair in tokens.windows(2) {
                let [token, next] = pair else { unreachable!("windows of two") };
                for (slip, made) in SLIPS {
                    n += 1;
                    if n % STEP != 0 {
                        continue;
                    }
                    let instead = made(
                        &right[token.clone()],
                        &right[token.end..next.start],
                        &right[next.clone()],
                    );
                    let wrong = format!("{}{instead}{}", &right[..token.start], &right[next.end..]);
                    let all = messages(&path, &wrong);
                    slips += 1;
                    by_count[all.len().min(3)] += 1;
                    if all.len() > 1 {
                        let line = 1 + right[..token.start].matches('\n').count();
                        let near = wrong.lines().nth(line - 1).unwrap_or_default();
                        let _ = writeln!(
                            log,
                            "{}:{line}: {} {slip}: {}",
                            path.display(),
                            &right[token.clone()],
                            near.trim()
                        );
                        for one in &all {
                            let _ = writeln!(log, "    {}", one.lines().next().unwrap_or_default());
                        }
                    }
                }
            }
        }
    }
    println!("{slips} slips, {by_count:?}\n{log}");
    assert!(log.is_empty(), "{log}");
}

/// Where words, numbers, texts and signs stand.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let is_word = |b: u8| b.is_ascii_alphanumeric() || b == b'_' || b == b'.';
    let (mut all, mut at) = (vec![], 0);
    while at < bytes.len() {
        let start = at;
        at += 1;
        match bytes[start] {
            b if b.is_ascii_whitespace() => continue,
            b'/' if bytes.get(at) == Some(&b'/') => {
                at = text[at..].find('\n').map_or(bytes.len(), |n| at + n);
                continue;
            }
            b'/' if bytes.get(at) == Some(&b'*') => {
                at = text[at..].find("*/").map_or(bytes.len(), |n| at + n + 2);
                continue;
            }
            b'"' => at = text[at..].find('"').map_or(bytes.len(), |n| at + n + 1),
            b if is_word(b) => {
                while at < bytes.len() && is_word(bytes[at]) {
                    at += 1
                }
            }
            b if !b.is_ascii() => {
                while !text.is_char_boundary(at) {
                    at += 1
                }
            }
            _ => {}
        }
        all.push(start..at);
    }
    all
}

/// A token with one letter wrong, or another bracket.
fn mistyped(token: &str) -> String {
    match token {
        "(" => "[".into(),
        "[" => "{".into(),
        "{" => "(".into(),
        ")" => "]".into(),
        "]" => "}".into(),
        "}" => ")".into(),
        "," => ".".into(),
        "=" => "==".into(),
        ":" => ";".into(),
        text if text.starts_with('"') => text[1..].into(),
        word if word.len() > 2 && word.is_ascii() => format!("{}{}", &word[..1], &word[2..]),
        other => format!("{other}q"),
    }
}
