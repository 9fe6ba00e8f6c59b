//! A Rust file as the house rules see it: without comments, texts and tests.

use std::path::Path;

/// One Rust file.
pub(super) struct Source {
    /// From the project's folder, with `/`.
    pub(super) path: String,
    pub(super) n_lines: usize,
    /// Lines without comments and texts, up to the tests.
    code: Vec<String>,
    /// The same with the tests.
    all: Vec<String>,
}

impl Source {
    pub(super) fn new(root: &Path, path: &Path, text: &str) -> Self {
        let path = path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
        let all: Vec<String> = bare(text).lines().map(str::to_owned).collect();
        // By convention the tests stand last.
        let end =
            all.iter().position(|line| line.trim() == "#[cfg(test)]" && !line.starts_with(' '));
        let tests_follow = |at: &usize| all.get(at + 1).is_some_and(|l| l.contains("mod tests {"));
        let code = end.filter(tests_follow).map_or(all.clone(), |end| all[..end].to_vec());
        Self { path, n_lines: text.lines().count(), code, all }
    }

    /// Whether it is part of the program, rather than of its tests or benchmarks.
    pub(super) fn is_product(&self) -> bool {
        let name = self.path.rsplit('/').next().unwrap_or_default();
        let helps_tests = ["tests.rs", "testing.rs", "check.rs"].contains(&name);
        let in_tests = self.path.contains("/tests/") || self.path.starts_with("tests/");
        let apart = self.path.starts_with("benches/") || self.path.contains("/benches/");
        !(helps_tests || in_tests || apart || name.ends_with("_tests.rs"))
    }

    /// The code, line by line.
    pub(super) fn code(&self) -> impl Iterator<Item = &str> {
        self.code.iter().map(String::as_str)
    }

    /// Numbers of the lines of code that hold a word.
    pub(super) fn lines_with(&self, word: &str) -> impl Iterator<Item = usize> {
        numbered(&self.code, word)
    }

    /// Numbers of the lines that hold a word, tests included.
    pub(super) fn all_lines_with(&self, word: &str) -> impl Iterator<Item = usize> {
        numbered(&self.all, word)
    }
}

fn numbered(lines: &[String], word: &str) -> impl Iterator<Item = usize> {
    let has = move |line: &str| {
        line.match_indices(word).any(|(at, _)| {
            let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let before = line[..at].chars().next_back().is_some_and(letter);
            let after = line[at + word.len()..].chars().next().is_some_and(letter);
            // `unsafe_code` names a lint; `eprint!` is another word.
            !(before || (after && word.ends_with(|c: char| c.is_ascii_alphabetic())))
        })
    };
    lines.iter().enumerate().filter(move |(_, line)| has(line)).map(|(i, _)| i + 1)
}

/// The text with comments and what stands between quotes left blank, line breaks kept.
fn bare(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut quoted = false;
    for line in text.lines() {
        let mut escaped = false;
        let mut previous = ' ';
        for (at, c) in line.char_indices() {
            let rest = &line[at..];
            if !quoted && rest.starts_with("//") {
                break;
            }
            let literal = !quoted && (rest.starts_with("'\"'") || previous == '\'' && c == '"');
            if c == '"' && !escaped && !literal {
                quoted = !quoted;
            } else if !quoted {
                out.push(c);
            }
            escaped = quoted && c == '\\' && !escaped;
            previous = c;
        }
        out.push('\n');
    }
    out
}

#[test]
fn comments_texts_and_tests_do_not_count() {
    let text = "//! unsafe\nlet a = \"unsafe \\\" x\"; // unsafe\nunsafe {\n#[cfg(test)]\nmod tests {\nunsafe";
    let source = Source::new(Path::new("/p"), Path::new("/p/core/src/a.rs"), text);
    assert_eq!(source.lines_with("unsafe").collect::<Vec<_>>(), [3]);
    assert_eq!(source.all_lines_with("unsafe").collect::<Vec<_>>(), [3, 6]);
    assert!(source.is_product());
}
