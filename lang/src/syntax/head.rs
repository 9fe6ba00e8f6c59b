//! Mistakes in the first words of a statement or object: misspelt, or as other languages write them.

use luxel_core::diag::{Diagnostic, Grade, Near, Span, near};

use super::around::{Around, Place, SHORT, is_category, stands_behind, stands_nowhere, told};
use super::borrowed::{holds_bare_values, in_braces};
use super::defined::{is_type, of_list};
use super::lex::{Token, TokenKind};
use super::statement;
use crate::words::RESERVED;

/// What is said of a range that is written otherwise.
pub(super) const RANGE: &str = "a range is written `0..3`: from 0 up to, but not, 3";

/// Bytes above that are looked at for a definition, and of a line for the end of one.
const LOOKED_AT: usize = 1 << 12;

/// What is said of an object whose parameters do not stand in braces.
pub(super) const BRACES: &str = "an object has its parameters between `{` and `}`";

/// What is said of parameters without brackets.
pub(super) const PARAMETERS: &str = "the parameters of a function stand between `(` and `)`";

/// Words with which other languages begin what `let`, `param` and `fn` begin here.
const FOREIGN: [&str; 24] = [
    "auto", "bool", "color", "const", "constant", "declare", "def", "define", "double", "float",
    "func", "function", "fun", "int", "local", "macro", "module", "number", "static", "string",
    "val", "var", "vec3", "vector",
];

/// Why the first words of a statement or object near the place cannot be read.
pub(super) fn head(around: &Around<'_>) -> Option<Diagnostic> {
    list(around)
        .or_else(|| misspelt(around))
        .or_else(|| plugin(around))
        .or_else(|| function(around))
        .or_else(|| bare_parameters(around))
        .or_else(|| block(around))
        .or_else(|| object(around))
}

/// `let double(x: length) = x * 2`
fn function(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(4);
    let start = (first..around.at).find(|i| around.begins(*i) && around.word(*i) == "let")?;
    let opens = around.is_word(start + 1) && around.word(start + 2) == "(";
    let close = around.closing(start + 2).filter(|_| opens)?;
    let is_head = close == start + 3 || around.word(start + 4) == ":";
    let word = &around.tokens[start];
    let found = around.error("E0023", word, "a function is defined with `fn`");
    (is_head && around.at <= close).then(|| found.guess(around.span(word), "fn"))
}

/// `fn tint red: float, dark: float = red * dark`
fn bare_parameters(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(4);
    let start = (first..around.at).rev().find(|i| around.begins(*i) && around.word(*i) == "fn")?;
    let (name, parameter) = (around.tokens.get(start + 1)?, around.tokens.get(start + 2)?);
    let are_words = around.is_word(start + 1) && around.is_word(start + 2);
    if !are_words || parameter.first_on_line || around.word(start + 3) != ":" {
        return None;
    }
    // A comma ends what was read, not what was meant.
    let rest = &around.text[parameter.start..];
    let is_end = |(at, c): &(usize, char)| *c == '\n' || rest[*at..].starts_with("//");
    let end = rest.char_indices().take(LOOKED_AT).find(is_end).map(|(at, _)| at);
    let end = end.or_else(|| (rest.len() < LOOKED_AT).then_some(rest.len()));
    let line = &rest[..end.unwrap_or(parameter.text.len())];
    // A default has a sign too: the last one on the line is the function's.
    let whole = line.rsplit_once('=').map_or(line, |(inside, _)| inside).trim_end();
    let found =
        told(Span::new(around.source, parameter.start, parameter.start + whole.len()), PARAMETERS);
    let gap = Span::new(around.source, name.end(), parameter.start + whole.len());
    let is_mended = whole.len() < line.len() && whole.len() <= SHORT;
    Some(if is_mended { found.guess(gap, format!("({whole})")) } else { found })
}

/// `for i in 0..3` and `if x > 1` that go on without `{`.
fn block(around: &Around<'_>) -> Option<Diagnostic> {
    let begins = |i: usize| around.begins(i) || around.word(i - 1) == "else";
    let start = (0..around.at).rev().find(|i| opens_block(around.word(*i)) && begins(*i))?;
    let last = around.before(1)?;
    // The head is whole if a value ends it, and nothing opened a block.
    let head = &around.tokens[start..around.at];
    let whole = head.len() > 1 && last.ends_operand() && head.iter().all(|t| t.text != "{");
    let named = head[0].text == "if" || head.iter().any(|t| t.text == "in");
    let goes_on = around.current().is_some_and(|t| !t.first_on_line && t.kind == TokenKind::Mark);
    let is_open = around.open.iter().any(|open| *open > start);
    if !whole || !named || last.text == "in" || goes_on || is_open {
        return None;
    }
    if let Some(found) = to(around, start) {
        return Some(found);
    }
    let message = format!("the `{{` of this `{}` is missing", head[0].text);
    Some(around.error("E0023", last, message).help("a block stands between `{` and `}`"))
}

/// `for i in 0 to 3`
fn to(around: &Around<'_>, start: usize) -> Option<Diagnostic> {
    let at = (start..=around.at).find(|i| around.word(*i) == "to")?;
    let [first, word, last] = around.tokens.get(at.checked_sub(1)?..at + 2)? else { return None };
    let gap = Span::new(around.source, first.end(), last.start);
    let found = around.error("E0023", word, RANGE);
    (!word.first_on_line).then(|| found.guess(gap, ".."))
}

/// `use plugn "a"` and `use "a"`
fn plugin(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(2);
    let start = (first..around.at).find(|i| around.begins(*i) && around.word(*i) == "use")?;
    let (word, next) = (&around.tokens[start], around.tokens.get(start + 1)?);
    let found =
        |token| around.error("E0023", token, "a plugin is asked for by `use plugin \"name\"`");
    match next.kind {
        TokenKind::Text => {
            let gap = Span::new(around.source, word.end(), word.end());
            Some(found(next).guess(gap, " plugin"))
        }
        TokenKind::Word if next.text != "plugin" && !next.first_on_line => {
            let near = near(next.text, ["plugin"]);
            Some(found(next).meant(around.span(next), near))
        }
        _ => None,
    }
}

/// How the statement is written whose head cannot be read further.
pub(super) fn pattern(around: &Around<'_>) -> Option<&'static str> {
    let start = (0..around.at).rev().find(|i| around.begins(*i) && around.is_word(*i))?;
    if around.tokens[start..around.at].iter().any(|t| t.text == "{") {
        return None;
    }
    statement::pattern(around.word(start))
}

/// Words that begin what a block follows.
pub(super) const BLOCKS: [&str; 2] = ["for", "if"];

/// Whether a block follows what the word begins.
pub(super) fn opens_block(word: &str) -> bool {
    BLOCKS.contains(&word)
}

/// `shape sphere { … } shape box { … }`: a statement on the line on which another one ends.
pub(super) fn second(around: &Around<'_>) -> Option<Diagnostic> {
    // Behind a name a category is read as one more word.
    let is_category_before = around.before(1).is_some_and(|word| is_category(word.text));
    let at = around.at - usize::from(is_category_before);
    let (current, before) = (around.tokens.get(at)?, around.tokens.get(at.checked_sub(1)?)?);
    let is_object = is_category(current.text) && around.is_word(at + 1);
    // `a if b` and `a for b in c` are other languages' expressions.
    let is_statement = current.text != "for" && fits(current.text, around, at + 1);
    let apart = around.open.is_empty() && around.place == Place::File;
    if !(is_object || is_statement) || !apart || current.first_on_line || !before.ends_operand() {
        return None;
    }
    // A comment between the two stays where it is.
    let blank = around.text[..current.start].trim_end().len();
    let gap = Span::new(around.source, blank, current.start);
    let message = begins_statement(current.text);
    // An object may be meant as a parameter of the one before, but for those that are none of any.
    let is_alone = matches!(current.text, "camera" | "film" | "integrator" | "light" | "sampler");
    let is_alike = around.tokens.first().is_some_and(|first| first.text == current.text);
    let grade = if !is_object || is_alone || is_alike { Grade::Sure } else { Grade::Guess };
    let line_break = line_break(around.text);
    Some(around.error("E0023", current, message).mend(gap, line_break, grade))
}

/// What is said of a word that begins a statement on the line of another one.
pub(super) fn begins_statement(word: &str) -> String {
    format!("`{word}` begins a statement, which wants a line of its own, or `;` before it")
}

/// What ends a line of this text.
fn line_break(text: &str) -> &'static str {
    let first = text.find('\n').map(|end| &text[..end]);
    if first.is_some_and(|line| line.ends_with('\r')) { "\r\n" } else { "\n" }
}

/// `plcae ball`, `includ "a.scene"`, `const x = 3`: by what follows the word.
fn misspelt(around: &Around<'_>) -> Option<Diagnostic> {
    // Reading stops at the word after it, or one later.
    let first = around.at.saturating_sub(2);
    for i in first..around.at {
        let word = &around.tokens[i];
        let is_name = word.kind == TokenKind::Word && !RESERVED.contains(&word.text);
        if !is_name || !around.begins(i) || is_category(word.text) {
            continue;
        }
        let fit = || RESERVED.into_iter().filter(|known| fits(known, around, i + 1));
        let elsewhere = FOREIGN.contains(&word.text).then(|| fit().next()).flatten();
        let near = match elsewhere {
            Some(name) => Some(Near { name, grade: Grade::Guess }),
            None => near(word.text, fit()),
        };
        if let Some(near) = near {
            return Some(begins_nothing(around, i, near));
        }
    }
    None
}

/// `float heights[3] = [1, 2, 3]` and `float[] heights = [1, 2, 3]`
fn list(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(4);
    let start = (first..=around.at).rev().find(|i| around.begins(*i))?;
    let word = around.tokens.get(start)?;
    let (name, last) = of_list(around.tokens.get(start..)?)?;
    let ty = if is_type(word.text) { word.text } else { "float" };
    if ty != word.text && !FOREIGN.contains(&word.text) {
        return None;
    }
    let name = around.word(start + name);
    let found = around.error("E0023", word, format!("the list `{name}` is defined with `let`"));
    let help = format!("its type, if it is said, stands behind its name: `let {name}: {ty}[] = …`");
    let span = Span::new(around.source, word.start, around.tokens[start + last].end());
    Some(found.help(help).guess(span, format!("let {name}")))
}

/// A word that is none of the language, and the one that may be meant.
pub(super) fn begins_nothing(around: &Around<'_>, i: usize, near: Near<'_>) -> Diagnostic {
    let word = &around.tokens[i];
    let short: String = word.text.chars().take(32).collect();
    let found = around.error("E0023", word, format!("`{short}` begins no statement"));
    if let Some((colon, head)) = colon_behind(around, i + 1).filter(|_| near.name == "fn") {
        let all = around.span(word).to(around.span(colon));
        return found.help("did you mean `fn`?").guess(all, format!("fn {head} ="));
    }
    found.meant(around.span(word), Some(Near { grade: Grade::Guess, ..near }))
}

/// The `:` behind the brackets of a function whose name is token `i`, and what stands before it.
fn colon_behind<'a>(around: &'a Around<'_>, i: usize) -> Option<(&'a Token<'a>, &'a str)> {
    let close = around.closing(i + 1)?;
    let colon = around.tokens.get(close + 1).filter(|sign| sign.text == ":")?;
    let head = &around.text[around.tokens.get(i)?.start..around.tokens[close].end()];
    Some((colon, head)).filter(|_| around.word(i + 1) == "(" && head.len() <= SHORT)
}

/// Whether token `i` and those after it may follow a word of the language.
fn fits(known: &str, around: &Around<'_>, i: usize) -> bool {
    let Some(next) = around.tokens.get(i).filter(|t| !t.first_on_line) else { return false };
    let (is_word, after) = (next.kind == TokenKind::Word, around.word(i + 1));
    match known {
        "let" | "param" => is_word && matches!(after, "=" | ":"),
        "set" => is_word && matches!(after, "=" | "."),
        "for" => is_word && (after == "in" || after == "," && around.word(i + 3) == "in"),
        "fn" => is_word && after == "(",
        "include" | "import" => next.kind == TokenKind::Text,
        "use" => next.text == "plugin",
        "place" | "expect" => is_word && after != "=",
        _ => false,
    }
}

/// `shape sphere (radius = 1 m)`, `camera thin_lens`, `shape /* c */ sphere { }`
fn object(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(4);
    let is_head = |i: &usize| {
        let may_begin = around.begins(*i) || around.word(i - 1) == "=";
        may_begin && is_category(around.word(*i)) && around.is_word(i + 1)
    };
    let start = (first..=around.at).rev().find(is_head)?;
    // After the category stands the name of the class, perhaps in parts, and perhaps a label.
    let mut end = start + 2;
    while around.word(end) == "." {
        end += 2;
    }
    let label = around.tokens.get(end).filter(|t| t.kind == TokenKind::Text && !t.first_on_line);
    end += usize::from(label.is_some());
    let (head, next) = (around.tokens.get(start..end)?, around.tokens.get(end));
    if next.is_some_and(|t| t.text == "{") {
        return comment(around, start, end);
    }
    // Among parameters `material gold` wants its `=` more likely.
    if around.at > end || around.begins(start) && around.inner() == Place::Fields {
        return None;
    }
    let on_line = next.filter(|t| !t.first_on_line && t.text != "}");
    let is_given = start > 0 && around.word(start - 1) == "=";
    if let Some(found) = defined(around, head, on_line, is_given) {
        return Some(found);
    }
    if let Some(next) = on_line {
        let found = around.error("E0023", next, BRACES);
        if matches!(next.text, "(" | "[") && holds_bare_values(around, end) {
            let (category, class) = (head[0].text, head[1].text);
            let help = format!("each has its name: `{category} {class} {{ NAME = … }}`");
            return Some(found.help(help));
        }
        return Some(in_braces(around, found, end - 1, end));
    }
    let last = head.last()?;
    let gap = Span::new(around.source, last.end(), last.end());
    Some(around.error("E0023", last, BRACES).guess(gap, " {}"))
}

/// A category before a name that is defined above: `shape stud(1 m)`, `shape ball`, `material = material clay`.
/// What is `next` stands on its line; `is_given` if a parameter or name is given it.
fn defined(
    around: &Around<'_>,
    head: &[Token<'_>],
    next: Option<&Token<'_>>,
    is_given: bool,
) -> Option<Diagnostic> {
    let [category, name] = head else { return None };
    let is_called = next.is_some_and(|open| open.text == "(");
    let is_function = || stands_behind(name.text, "fn", above(around));
    let (what, instead) = if is_called && is_function() {
        (format!("is a function: no `{}` stands before its call", category.text), "")
    } else if next.is_some() || !is_defined(around, name.text) {
        return None;
    } else if is_given {
        ("names what is given".into(), "")
    } else if stands_nowhere(category.text) {
        return None;
    } else {
        ("is defined above, and put here by `place`".into(), "place ")
    };
    let before = Span::new(around.source, category.start, name.start);
    let found = around.error("E0023", category, format!("`{}` {what}", name.text));
    Some(found.guess(before, instead))
}

/// The text not far above the statement.
fn above<'a>(around: &'a Around<'_>) -> &'a [u8] {
    let above = &around.text.as_bytes()[..around.tokens.first().map_or(0, |first| first.start)];
    &above[above.len().saturating_sub(LOOKED_AT)..]
}

/// Whether a `let` not far above defines a name.
pub(super) fn is_defined(around: &Around<'_>, name: &str) -> bool {
    stands_behind(name, "let", above(around))
}

/// A comment between the words of an object's head, which ends before token `end`.
fn comment(around: &Around<'_>, start: usize, end: usize) -> Option<Diagnostic> {
    (start..end).find_map(|i| {
        let (from, to) = (around.tokens[i].end(), around.tokens[i + 1].start);
        let at = from + around.text[from..to].find('/')?;
        let length = around.text[at..to].trim_end().len();
        let message = "no comment stands between the words of an object's head";
        let span = Span::new(around.source, at, at + length);
        Some(Diagnostic::error("E0023", span, message).help("write it before the object or in it"))
    })
}
