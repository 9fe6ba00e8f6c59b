//! How many messages a slip of one token brings: one, not a cascade.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

use crate::disk::{files_below, root, text};
use crate::published;
use crate::seeded::messages;

/// One slip in so many is tried.
const STEP: usize = 17;

/// What is written instead of a token, a gap and the next token.
type Slip = fn(&str, &str, &str) -> String;

/// What may go wrong with a token.
const SLIPS: [(&str, Slip); 4] = [
    ("missing", |_, gap, next| format!("{gap}{next}")),
    ("twice", |token, gap, next| format!("{token} {token}{gap}{next}")),
    ("behind the next", |token, gap, next| format!("{next}{gap}{token}")),
    ("mistyped", |token, gap, next| format!("{}{gap}{next}", mistyped(token))),
];

#[test]
fn a_slip_of_one_token_is_told_once() {
    let mut score = Score::default();
    // Files that scenes include have no camera.
    let scenes = [
        files_below(&root().join("scenes"), "scene"),
        files_below(&root().join("tests/seeded"), "scene"),
    ];
    for path in
        scenes.concat().iter().filter(|path| !path.starts_with(root().join("tests/seeded/parts")))
    {
        score.run(path, &text(path));
    }
    println!("{}", score.log);
    published::hold("language.md", "slips", &score.table());
    assert!(score.slips.values().all(|counts| counts[2] == 0), "{}", score.log);
}

/// How slips were told of.
#[derive(Default)]
struct Score {
    n: usize,
    /// By kind of slip: those without a message, with one, and with more.
    slips: BTreeMap<&'static str, [usize; 3]>,
    /// Those with more, for whoever mends them.
    log: String,
}

impl Score {
    /// Tries slips of a scene without a mistake.
    fn run(&mut self, path: &Path, right: &str) {
        for pair in tokens(right).windows(2) {
            let [token, next] = pair else { continue };
            for (kind, slip) in SLIPS {
                self.n += 1;
                if self.n.is_multiple_of(STEP) {
                    let gap = &right[token.end..next.start];
                    let slipped = slip(&right[token.clone()], gap, &right[next.clone()]);
                    let wrong = format!("{}{slipped}{}", &right[..token.start], &right[next.end..]);
                    self.count(path, kind, token.start, &wrong);
                }
            }
        }
    }

    fn count(&mut self, path: &Path, kind: &'static str, at: usize, wrong: &str) {
        let all = messages(path, wrong);
        self.slips.entry(kind).or_default()[all.len().min(2)] += 1;
        if all.len() > 1 {
            let name = path.file_name().unwrap_or_default().display();
            let line = wrong[..at].matches('\n').count();
            let near = wrong.lines().nth(line).unwrap_or_default().trim();
            let _ = writeln!(self.log, "{name}:{}, {kind}: {near}", line + 1);
            for one in all {
                let _ = writeln!(self.log, "    {}", one.lines().next().unwrap_or_default());
            }
        }
    }

    fn table(&self) -> String {
        let mut table =
            "| a token | no mistake | one message | more |\n|---|---|---|---|".to_owned();
        for (kind, [none, one, more]) in &self.slips {
            let share = 100.0 * *more as f64 / (none + one + more) as f64;
            let _ = write!(table, "\n| {kind} | {none} | {one} | {more}, {share:.1} % |");
        }
        table
    }
}

/// Where words, numbers, texts and signs stand.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let bytes = text.as_bytes();
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.');
    let until =
        |at: usize, end: &str| text[at..].find(end).map_or(text.len(), |n| at + n + end.len());
    let (mut all, mut at) = (vec![], 0);
    while let Some(byte) = bytes.get(at) {
        let start = at;
        at = match byte {
            b'/' if text[at..].starts_with("//") => until(at, "\n"),
            b'/' if text[at..].starts_with("/*") => until(at, "*/"),
            b'"' => until(at + 1, "\""),
            byte if is_word(byte) => {
                at + bytes[at..].iter().take_while(|byte| is_word(byte)).count()
            }
            _ => at + text[at..].chars().next().map_or(1, char::len_utf8),
        };
        let is_comment = text[start..].starts_with("//") || text[start..].starts_with("/*");
        if !byte.is_ascii_whitespace() && !is_comment {
            all.push(start..at);
        }
    }
    all
}

/// A token with a letter too few or too many, or another bracket or sign.
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
