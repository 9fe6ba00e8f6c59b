//! What the grammar of record makes of texts, as JSON: the truth for the grammars of editors.
//!
//! `cargo run -p luxel-lang --example pairs` reads texts from standard input, each ended by a NUL
//! byte, and answers each with a line: `statements` and `tokens` as `[rule, start, end, rule above]`
//! in bytes, or `error`, the byte where reading ends. A text without header is read as if it had one.

use std::fmt::Write as _;
use std::io::{Write, read_to_string, stdin, stdout};
use std::ops::Range;

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

/// `[rule, start, end, rule above]`, one after another.
#[derive(Default)]
struct Rows(String);

impl Rows {
    fn push(&mut self, rule: Rule, place: Range<usize>, above: Rule) {
        let comma = if self.0.is_empty() { "" } else { "," };
        let Range { start, end } = place;
        write!(self.0, "{comma}[\"{rule:?}\",{start},{end},\"{above:?}\"]")
            .expect("a string takes everything");
    }
}

/// What is told of one text; bytes count from `base`.
struct Told {
    base: usize,
    statements: Rows,
    tokens: Rows,
}

impl Told {
    /// A pair, which stands in one of the rule `above`, and everything below it.
    fn pair(&mut self, pair: Pair<'_, Rule>, above: Rule) {
        let (rule, span) = (pair.as_rule(), pair.as_span());
        let place = span.start().saturating_sub(self.base)..span.end().saturating_sub(self.base);
        let is_own = span.start() >= self.base;
        if is_own && above == Rule::stmt && !matches!(rule, Rule::doc | Rule::attr) {
            self.statements.push(rule, place.clone(), above);
        }
        let is_text = matches!(rule, Rule::string | Rule::attr);
        let mut parts = pair.into_inner().peekable();
        if is_text || parts.peek().is_none() {
            if is_own {
                self.tokens.push(rule, place, above);
            }
            return;
        }
        parts.for_each(|part| self.pair(part, rule));
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
            pairs.for_each(|pair| told.pair(pair, Rule::EOI));
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
