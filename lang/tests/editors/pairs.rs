//! What the grammar of record makes of texts, as JSON: the truth for the grammars of editors.
//!
//! `cargo run -p luxel-lang --example pairs` reads texts from standard input, each ended by a NUL
//! byte, and answers each with a line: `statements` and `tokens` as `[rule, start, end]` in bytes,
//! or `error`, the byte where reading ends. A text without header is read as if it had one.

use std::fmt::Write as _;
use std::io::{Write, read_to_string, stdin, stdout};

use pest::Parser;
use pest::error::{ErrorVariant, InputLocation};
use pest::iterators::Pair;

use grammar::{Rule, SceneParser};

/// The header of a text that has none.
const HEADER: &str = "scene 1\n";

/// What pest makes of the grammar.
mod grammar {
    /// The parser that pest derives.
    #[derive(pest_derive::Parser)]
    #[grammar = "scene.pest"]
    pub(crate) struct SceneParser;
}

/// `[rule, start, end]`, one after another.
#[derive(Default)]
struct Rows(String);

impl Rows {
    fn push(&mut self, rule: Rule, start: usize, end: usize) {
        let comma = if self.0.is_empty() { "" } else { "," };
        write!(self.0, "{comma}[\"{rule:?}\",{start},{end}]").expect("a string takes everything");
    }
}

/// What is told of one text; bytes count from `base`.
struct Told {
    base: usize,
    statements: Rows,
    tokens: Rows,
}

impl Told {
    /// Everything below a pair.
    fn pair(&mut self, pair: Pair<'_, Rule>) {
        let (rule, span) = (pair.as_rule(), pair.as_span());
        let (Some(start), Some(end)) =
            (span.start().checked_sub(self.base), span.end().checked_sub(self.base))
        else {
            return pair.into_inner().for_each(|part| self.pair(part));
        };
        let is_text = matches!(rule, Rule::string | Rule::attr);
        let mut parts = pair.into_inner().peekable();
        if is_text || parts.peek().is_none() {
            self.tokens.push(rule, start, end);
            return;
        }
        for part in parts {
            if rule == Rule::stmt && !matches!(part.as_rule(), Rule::doc | Rule::attr) {
                let span = part.as_span();
                let (start, end) = (span.start() - self.base, span.end() - self.base);
                self.statements.push(part.as_rule(), start, end);
            }
            self.pair(part);
        }
    }
}

/// What is told of a text, as JSON.
fn told(text: &str) -> String {
    let bare = SceneParser::parse(Rule::file, text);
    let with_header = format!("{HEADER}{text}");
    let (base, read) = match bare {
        Ok(pairs) => (0, Ok(pairs)),
        Err(error) if text.contains("scene 1") => (0, Err(error)),
        Err(_) => (HEADER.len(), SceneParser::parse(Rule::file, &with_header)),
    };
    match read {
        Ok(pairs) => {
            let mut told = Told { base, statements: Rows::default(), tokens: Rows::default() };
            pairs.for_each(|pair| told.pair(pair));
            let (statements, tokens) = (told.statements.0, told.tokens.0);
            format!("{{\"statements\":[{statements}],\"tokens\":[{tokens}]}}")
        }
        Err(error) => {
            let (InputLocation::Pos(at) | InputLocation::Span((at, _))) = error.location;
            assert!(matches!(error.variant, ErrorVariant::ParsingError { .. }), "{error}");
            format!("{{\"error\":{}}}", at.saturating_sub(base))
        }
    }
}

fn main() {
    let texts = read_to_string(stdin()).expect("the texts are UTF-8");
    for text in texts.split_terminator('\0') {
        writeln!(stdout(), "{}", told(text)).expect("standard output takes everything");
    }
}
