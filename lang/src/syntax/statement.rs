//! Statements and fields that have a word too many or too few.

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::Unit;

use super::amounts::amount;
use super::around::{Around, Place, is_category, told};
use super::calls::call;
use super::defined::stem;
use super::lex::{Token, TokenKind};
use super::peers::is_pbrt;
use super::wrapped::CHOICE;
use crate::words::RESERVED;

/// Words with which other languages end something.
const ENDING: [&str; 8] = ["break", "continue", "done", "end", "endif", "fi", "pass", "return"];

/// Words that other languages put before a statement.
const MODIFIERS: [&str; 7] = ["async", "export", "extern", "inline", "private", "pub", "public"];

/// What is told of a text for the name of a parameter.
pub(crate) const QUOTED: &str = "the name of a parameter has no quotes";

/// Why the place cannot be read, if such a statement stands there.
pub(super) fn statement(around: &Around<'_>) -> Option<Diagnostic> {
    placed_call(around)
        .or_else(|| header_again(around))
        .or_else(|| modified(around))
        .or_else(|| given_block(around))
        .or_else(|| lone_name(around))
        .or_else(|| assertion(around))
        .or_else(|| stepped(around))
        .or_else(|| quoted_name(around))
        .or_else(|| suffixed(around))
        .or_else(|| parted_unit(around))
        .or_else(|| amount(around))
        .or_else(|| call(around))
        .or_else(|| bare_choice(around))
        .or_else(|| signed(around))
        .or_else(|| commented_unit(around))
        .or_else(|| unquoted_path(around))
        .or_else(|| named_unit(around))
        .or_else(|| argument(around))
}

/// How a statement is written of which the place is a part.
pub(super) fn pattern(word: &str) -> Option<&'static str> {
    Some(match word {
        "for" => "a loop is written `for i in 0..9 { … }`",
        "if" => "a choice is written `if x > 1 { … } else { … }`, and `==` compares",
        "assert" => "an assertion is written `assert x > 1, \"what must hold\"`",
        "expect" => "an expectation is written `expect mean = 0.5 ± 0.01`",
        "param" => "a parameter is written `param size: length = 2 m in 1 m..=3 m`",
        "import" => "an import is written `import \"tools.scene\" as tools`",
        "include" => "an include is written `include \"tools.scene\" with { size = 2 m }`",
        "place" => "a placement is written `place ball { transform = move((1, 0, 0) m) }`",
        "set" => "a setting is written `set label.radius = 2 m`",
        _ => return None,
    })
}

/// `place tree(1 m)`
fn placed_call(around: &Around<'_>) -> Option<Diagnostic> {
    let (name, word) = (around.before(1)?, around.before(2)?);
    let is_call = around.word(around.at) == "(" && name.kind == TokenKind::Word;
    if !is_call || word.text != "place" || !around.begins(around.at - 2) {
        return None;
    }
    let end = around.closing(around.at)?;
    let found = told(around.span(around.current()?), "`place` takes a name, not a call");
    // Labels and transforms behind it belong to what is placed.
    if matches!(around.tokens.get(end + 1), Some(next) if !next.first_on_line && next.text != "}") {
        let name = name.text;
        return Some(
            found.help(format!("give it a name, `let it = {name}(…)`, and write `place it`")),
        );
    }
    let both = Span::new(around.source, word.start, name.start);
    Some(found.help("what a function makes stands where it is called").guess(both, ""))
}

/// `scene 1` once more.
fn header_again(around: &Around<'_>) -> Option<Diagnostic> {
    let (version, word) = (around.current()?, around.before(1)?);
    let is_it = word.text == "scene" && version.kind == TokenKind::Number;
    if !is_it || version.first_on_line || !around.begins(around.at - 1) || !around.open.is_empty() {
        return None;
    }
    let both = around.span(word).to(around.span(version));
    let message = "a file says once, and first, which version of the language it is in";
    Some(told(both, message).guess(both, ""))
}

/// `pub fn f(x: float) = x`
fn modified(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(2);
    let start = (first..around.at).rev().find(|i| around.begins(*i))?;
    let (word, next) = (&around.tokens[start], around.tokens.get(start + 1)?);
    let begins = RESERVED.contains(&next.text) || is_category(next.text);
    if !MODIFIERS.contains(&word.text) || !begins || next.first_on_line {
        return None;
    }
    let gap = Span::new(around.source, word.start, next.start);
    Some(told(around.span(word), format!("`{}` begins no statement", word.text)).fix(gap, ""))
}

/// `group "pair" = { … }`
fn given_block(around: &Around<'_>) -> Option<Diagnostic> {
    let equals = (around.at.saturating_sub(2)..around.at + 3).find(|i| around.word(*i) == "=")?;
    let label = equals.checked_sub(1).map(|i| &around.tokens[i])?;
    let mut first = equals.checked_sub(2)?;
    let is_object = |i: usize| is_category(around.word(i)) || around.word(i) == "group";
    first -= usize::from(first > 0 && !is_object(first));
    let opens = around.word(equals + 1) == "{" && label.kind == TokenKind::Text;
    if !opens || !is_object(first) || !around.begins(first) {
        return None;
    }
    let sign = around.span(&around.tokens[equals]);
    let found = told(sign, "no `=` stands between an object and its block");
    let gap = Span::new(around.source, label.end(), around.tokens[equals + 1].start);
    Some(found.fix(gap, " "))
}

/// `ball`, and nothing beside it.
fn lone_name(around: &Around<'_>) -> Option<Diagnostic> {
    let ends = |token: &Token<'_>| token.first_on_line || matches!(token.text, "}" | ";");
    let mut first = around.at.checked_sub(1).filter(|_| around.current().is_none_or(ends))?;
    let last = &around.tokens[first];
    while first > 1 && around.word(first - 1) == "." {
        first -= 2;
    }
    let name = &around.tokens[first];
    let is_name = around.is_word(first) && last.kind == TokenKind::Word;
    let is_ours = RESERVED.contains(&name.text) || is_category(name.text) || is_pbrt(name.text);
    let is_field = around.inner() == Place::Fields && !around.is_in_group();
    if !is_name || is_ours || !around.begins(first) || is_field {
        return None;
    }
    let all = around.span(name).to(around.span(last));
    if ENDING.contains(&name.text) {
        return Some(told(all, format!("`{}` begins no statement", name.text)));
    }
    let start = Span::new(around.source, name.start, name.start);
    let found = told(all, "a name by itself says nothing");
    Some(found.help("`place` puts what it names into the scene").guess(start, "place "))
}

/// `assert x > 3 "x is small"`
fn assertion(around: &Around<'_>) -> Option<Diagnostic> {
    let text = around.current().filter(|t| t.kind == TokenKind::Text)?;
    let before = around.before(1).filter(|t| t.ends_operand())?;
    let is_head = |i: &usize| around.word(*i) == "assert" && around.begins(*i);
    let start = (0..around.at).rev().find(is_head)?;
    if start + 1 == around.at || !around.open.is_empty() && around.inner() == Place::Fields {
        return None;
    }
    let gap = Span::new(around.source, before.end(), before.end());
    let message = "a comma is missing before the message";
    Some(Diagnostic::error("E0014", around.span(text), message).fix(gap, ","))
}

/// `0..10 step 2`
fn stepped(around: &Around<'_>) -> Option<Diagnostic> {
    // The word was read as the unit of the number before it, or was not.
    let back = around.at.saturating_sub(1);
    let at = [back, around.at].into_iter().find(|i| matches!(around.word(*i), "step" | "by"))?;
    let word = &around.tokens[at];
    let next = around.tokens.get(at + 1).filter(|t| t.kind == TokenKind::Number)?;
    let start = (0..at).rev().find(|i| around.begins(*i)).unwrap_or(0);
    let is_range = (start..at).any(|i| matches!(around.word(i), ".." | "..="));
    if word.first_on_line || !is_range {
        return None;
    }
    let found = told(around.span(word).to(around.span(next)), "a range goes on by one");
    Some(found.help("other steps are computed: `for i in 0..5 { let x = i * 2 … }`"))
}

/// `"radius": 1 m`
fn quoted_name(around: &Around<'_>) -> Option<Diagnostic> {
    let text = around.current().filter(|t| t.kind == TokenKind::Text)?;
    let sign = around.tokens.get(around.at + 1).filter(|t| matches!(t.text, ":" | "="))?;
    let name = text.text.trim_matches('"');
    let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    let is_field = around.begins(around.at) && !around.open.is_empty();
    if !is_name || !is_field || around.word(around.at + 2) == "=" {
        return None;
    }
    let both = around.span(text).to(around.span(sign));
    let found = told(around.span(text), QUOTED);
    Some(found.fix(both, format!("{name} =")))
}

/// `2.5f m`
fn suffixed(around: &Around<'_>) -> Option<Diagnostic> {
    let (letter, number) = (around.before(1)?, around.before(2)?);
    let touch = number.kind == TokenKind::Number && number.end() == letter.start;
    (touch && is_suffix(letter.text)).then(|| of_suffix(around.span(letter)))
}

/// `3 c m`
fn parted_unit(around: &Around<'_>) -> Option<Diagnostic> {
    // Reading stops at the second, or behind it.
    [2, 3].into_iter().find_map(|back| parted_at(around, around.at.checked_sub(back)?))
}

fn parted_at(around: &Around<'_>, i: usize) -> Option<Diagnostic> {
    let [number, first, second] = around.tokens.get(i..i + 3)? else { return None };
    let is_value = number.kind == TokenKind::Number || number.text == ")";
    let are_words = [first, second].iter().all(|word| word.kind == TokenKind::Word);
    let is_unit = Unit::named(&[first.text, second.text].concat()).is_some();
    // `1 m m` has one twice.
    let is_unit = is_unit && first.text != second.text;
    let is_field = matches!(around.word(i + 3), "=" | "{");
    let breaks = first.first_on_line || second.first_on_line;
    if !is_value || !are_words || !is_unit || breaks || is_field {
        return None;
    }
    let both = around.span(first).to(around.span(second));
    let gap = Span::new(around.source, first.end(), second.start);
    Some(Diagnostic::error("E0204", both, "a unit is one word").guess(gap, ""))
}

/// Tokens before the place among which a choice begins.
const CHOICE_HEAD: usize = 32;

/// `if a then 1 m else 2 m` and `if (a) (1 m) else (2 m)`
fn bare_choice(around: &Around<'_>) -> Option<Diagnostic> {
    let back = around.at.saturating_sub(CHOICE_HEAD)..=around.at;
    let start = back.rev().find(|i| around.word(*i) == "if")?;
    let is_on_line = |i: &usize| !around.tokens[*i].first_on_line;
    let rest = || (start + 1..around.tokens.len()).take_while(is_on_line);
    if rest().any(|i| around.word(i) == "{") {
        return None;
    }
    let [then, otherwise] = ["then", "else"].map(|word| rest().find(|i| around.word(*i) == word));
    let word = around.span(&around.tokens[then.or(otherwise)?]);
    let found = told(word, "what a choice gives stands in braces").help(CHOICE);
    let mend = then.zip(otherwise).and_then(|(then, otherwise)| {
        let ends = |i: &usize| matches!(around.word(*i), "," | ";" | "}" | ")" | "]");
        let last = rest().skip_while(|i| *i <= otherwise).take_while(|i| !ends(i)).last()?;
        let [then, otherwise, last] = [then, otherwise, last].map(|i| &around.tokens[i]);
        let one = around.text.get(then.end()..otherwise.start)?.trim();
        let other = around.text[otherwise.end()..last.end()].trim();
        // A bracket that opens there may hold what seems to be the end.
        let is_plain = !other.contains(['(', '[']);
        let all = around.span(then).to(around.span(last));
        is_plain.then(|| (all, format!("{{ {one} }} else {{ {other} }}")))
    });
    Some(match mend {
        Some((all, mended)) => found.guess(all, mended),
        None => found,
    })
}

/// `+3` and `+/- 3`
fn signed(around: &Around<'_>) -> Option<Diagnostic> {
    let is_sign = |i: &usize| around.word(*i) == "+" && !around.tokens[*i].first_on_line;
    let plus = [around.at.saturating_sub(1), around.at].into_iter().find(is_sign)?;
    let (sign, before) = (&around.tokens[plus], &around.tokens[plus.checked_sub(1)?]);
    if [1, 2].map(|k| around.word(plus + k)) == ["/", "-"] {
        let all = around.span(sign).to(around.span(&around.tokens[plus + 2]));
        return Some(told(all, "this sign is written `±`").fix(all, "±"));
    }
    let is_operand = around.tokens.get(plus + 1).is_some_and(|t| t.start == sign.end());
    let begins = before.is_operator() || matches!(before.text, "(" | "[" | ",");
    let found = told(around.span(sign), "what is positive has no sign");
    (is_operand && begins).then(|| found.fix(around.span(sign), ""))
}

/// `(0, 1, 0) /* up */ m`
fn commented_unit(around: &Around<'_>) -> Option<Diagnostic> {
    let back = around.at.saturating_sub(1);
    let unit = [back, around.at].into_iter().find(|i| Unit::named(around.word(*i)).is_some())?;
    let before = around.tokens.get(unit.checked_sub(1)?).filter(|t| t.ends_operand())?;
    let (from, to) = (before.end(), around.tokens[unit].start);
    let at = from + around.text[from..to].find("/*")?;
    let span = Span::new(around.source, at, at + around.text[at..to].trim_end().len());
    let found = told(span, "no comment stands between a number and its unit");
    Some(found.help("write it before the number or behind the unit"))
}

/// `include tools.scene`, `use plugin velvet`
fn unquoted_path(around: &Around<'_>) -> Option<Diagnostic> {
    let is_head = |i: &usize| match around.word(*i) {
        "include" | "import" => around.begins(*i),
        "plugin" => *i > 0 && around.word(i - 1) == "use" && around.begins(i - 1),
        _ => false,
    };
    let head = (around.at.saturating_sub(2)..around.at).rev().find(is_head)?;
    let name = around.tokens.get(head + 1)?;
    if name.kind != TokenKind::Word || name.first_on_line {
        return None;
    }
    let rest = &around.text[name.start..around.end];
    let length = rest.find(|c: char| c.is_whitespace() || c == ';').unwrap_or(rest.len());
    let span = Span::new(around.source, name.start, name.start + length);
    let found = told(span, "the name of a file or a plugin stands between `\"`");
    let written = &rest[..length];
    let is_unnamed = around.word(head) == "import" && around.word(head + 2) != "as";
    Some(match stem(written).filter(|_| is_unnamed) {
        Some(name) => {
            let path = written.strip_suffix(".scene").unwrap_or(written);
            found.guess(span, format!("\"{path}.scene\" as {name}"))
        }
        None => found.guess(span, format!("\"{written}\"")),
    })
}

/// `n m`, also where reading goes on to what stands behind it.
fn named_unit(around: &Around<'_>) -> Option<Diagnostic> {
    let is_unit = |i: &usize| {
        let ends = |t: &Token<'_>| t.first_on_line || matches!(t.text, "," | ";" | "}");
        let is_last = *i == around.at || around.current().is_none_or(ends);
        is_last && around.is_word(*i) && Unit::named(around.word(*i)).is_some()
    };
    let at = [around.at, around.at.checked_sub(1)?].into_iter().find(is_unit)?;
    let (unit, name, before) =
        (around.tokens.get(at)?, around.tokens.get(at.checked_sub(1)?)?, at.checked_sub(2)?);
    let before = &around.tokens[before];
    let is_after = before.is_operator() || matches!(before.text, "," | "(" | "[");
    if name.kind != TokenKind::Word || !is_after || unit.first_on_line {
        return None;
    }
    let message = format!("a unit stands behind a number, not behind the name `{}`", name.text);
    let found = told(around.span(unit), message);
    let gap = Span::new(around.source, name.end(), unit.end());
    let help = format!("`{}` may measure something already", name.text);
    Some(found.help(help).guess(gap, format!(" * 1 {}", unit.text)))
}

/// `look_at(from (0, 1, 4) m)`: an argument without its sign.
fn argument(around: &Around<'_>) -> Option<Diagnostic> {
    let unit = around.current().filter(|t| !t.first_on_line && Unit::named(t.text).is_some())?;
    let close = around.before(1).filter(|t| t.text == ")" && t.end() <= unit.start)?;
    let outer = *around.open.last().filter(|open| around.word(**open) == "(")?;
    let open = (outer + 1..around.at)
        .find(|i| around.word(*i) == "(" && around.closing(*i) == Some(around.at - 1))?;
    let name = &around.tokens[open - 1];
    let is_apart = name.end() < around.tokens[open].start && open >= 2;
    let begins = is_apart && matches!(around.word(open - 2), "(" | ",");
    if name.kind != TokenKind::Word || !begins {
        return None;
    }
    let value = around.span(&around.tokens[open]).to(around.span(close));
    let gap = Span::new(around.source, name.end(), name.end());
    let message = format!("`=` is missing between `{}` and its value", name.text);
    Some(Diagnostic::error("E0012", value, message).fix(gap, " ="))
}

/// Whether a letter behind a number says elsewhere of which precision it is.
pub(super) fn is_suffix(letter: &str) -> bool {
    matches!(letter, "f" | "F")
}

/// What is said of such a letter.
pub(super) fn of_suffix(letter: Span) -> Diagnostic {
    let found = Diagnostic::error("E0204", letter, "no letter stands behind a number");
    found.help("what is calculated with is precise enough").guess(letter, "")
}
