//! What has another shape here than where somebody learnt to write it: loops without an end, vectors
//! without brackets, objects that are named by `=`.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, Grade, Span};
use luxel_sdk::params::Unit;

use super::around::{Around, Place, is_category, stands_nowhere, told};
use super::joins::branch;
use super::lex::{Token, TokenKind, tokens};
use super::loops::loops;
use super::type_names;

/// Numbers that stand side by side in a vector, at most.
const WIDEST: usize = 4;

/// Why the place cannot be read, if it has another language's shape.
pub(super) fn foreign(around: &Around<'_>) -> Option<Diagnostic> {
    loops(around)
        .or_else(|| returned(around))
        .or_else(|| steps(around))
        .or_else(|| value_in_block(around))
        .or_else(|| typed_before(around))
        .or_else(|| if_behind(around))
        .or_else(|| lone_if(around))
        .or_else(|| named_object(around))
        .or_else(|| set(around))
        .or_else(|| placed(around))
        .or_else(|| bare_vector(around))
        .or_else(|| vector_with_commas(around))
        .or_else(|| braced_vector(around))
        .or_else(|| called_parameter(around))
}

/// The token that begins a statement with one of these words, at most two before the place.
fn beginning<'a>(around: &'a Around<'_>, words: &[&str]) -> Option<(&'a Token<'a>, &'a Token<'a>)> {
    (around.at.saturating_sub(2)..=around.at).rev().find_map(|i| {
        let (word, next) = (around.tokens.get(i)?, around.tokens.get(i + 1)?);
        let is_one = words.contains(&word.text) && around.begins(i) && !next.first_on_line;
        (is_one && next.text != "=").then_some((word, next))
    })
}

/// `return y` in a block.
fn returned(around: &Around<'_>) -> Option<Diagnostic> {
    let (word, _) = beginning(around, &["return"])?;
    let found = told(around.span(word), "what a function gives stands behind its `=`");
    Some(found.help("it is written `fn f(x: float) = x + 1`"))
}

/// `y + 1` at the end of a function's block.
fn value_in_block(around: &Around<'_>) -> Option<Diagnostic> {
    let (sign, name) = (around.current()?, around.before(1)?);
    let first = around.tokens.iter().find(|t| t.kind != TokenKind::Doc)?;
    let in_body = matches!(&around.open[..], [open] if around.word(*open) == "{");
    let is_value = sign.is_operator() && sign.text != "=" && around.begins(around.at - 1);
    let found =
        told(around.span(name).to(around.span(sign)), "a function with a block gives no value");
    let found =
        found.help("a value is written `fn f(x: float) = x + 1`, each step a function of its own");
    (first.text == "fn" && in_body && is_value && !sign.first_on_line).then_some(found)
}

/// The brace that stands where the value of a function does, if what is in it are no fields.
pub(super) fn body_of_steps(around: &Around<'_>) -> Option<usize> {
    let first = around.tokens.iter().position(|t| t.kind != TokenKind::Doc)?;
    let brace = *around.open.iter().find(|open| around.word(**open) == "{")?;
    let is_value = around.word(first) == "fn" && brace > 0 && around.word(brace - 1) == "=";
    let is_field = around.is_word(brace + 1)
        && matches!(around.word(brace + 2), "=" | ":")
        && !matches!(around.word(brace + 1), "let" | "return");
    (is_value && !is_field).then_some(brace)
}

/// `fn f(x: int) = { let y = x; y * 2 }`
fn steps(around: &Around<'_>) -> Option<Diagnostic> {
    let brace = &around.tokens[body_of_steps(around)?];
    let found = told(around.span(brace), "the value of a function is one expression");
    Some(
        found.help(
            "it is written `fn f(x: int) = x * 2`; a step before it is a function of its own",
        ),
    )
}

/// What is said of a type that stands behind a name.
pub(super) const TYPES: &str = "a type stands behind `:`";
/// What is said of one that stands before a name.
pub(super) const TYPE_BEHIND: &str = "a type stands behind the name, and `:`";

/// `fn f(int x) = x` and `fn f(x int) = x`
fn typed_before(around: &Around<'_>) -> Option<Diagnostic> {
    let (name, ty) = (around.current()?, around.before(1)?);
    let first = around.tokens.iter().find(|t| t.kind != TokenKind::Doc)?;
    let is_open = matches!(&around.open[..], [open] if around.word(*open) == "(");
    let in_head = first.text == "fn" && is_open && name.kind == TokenKind::Word;
    let is_type = |token: &Token<'_>| type_names::names().any(|known| known == token.text);
    if !in_head || name.first_on_line {
        return None;
    }
    if !is_type(ty) {
        let is_behind = is_type(name) && around.begins_argument(around.at - 1);
        let gap = Span::new(around.source, ty.end(), name.start);
        return is_behind.then(|| told(around.span(name), TYPES).fix(gap, ": "));
    }
    // `x: length length`
    if name.text == ty.text && around.word(around.at + 1) != ":" {
        return None;
    }
    // `x: length y: length`
    if around.before(2).is_some_and(|sign| sign.text == ":") {
        let gap = Span::new(around.source, ty.end(), ty.end());
        let message = format!("a comma is missing before `{}`", name.text);
        return Some(around.error("E0014", name, message).fix(gap, ","));
    }
    let both = around.span(ty).to(around.span(name));
    let found = told(both, TYPE_BEHIND);
    Some(found.fix(both, format!("{}: {}", name.text, ty.text)))
}

/// `let x = 3 if a else 2`
fn if_behind(around: &Around<'_>) -> Option<Diagnostic> {
    let word = around.current().filter(|t| t.text == "if" && !t.first_on_line)?;
    let is_value = (1..=around.at.min(8)).any(|back| around.word(around.at - back) == "=");
    let ends = around.before(1)?.ends_operand() && around.before(1)?.text != "}";
    let found = told(around.span(word), "an `if` stands before the values that it chooses from");
    (is_value && ends).then(|| found.help("it is written `if x > 1 { a } else { b }`"))
}

/// `let x = if a { 3 }`
fn lone_if(around: &Around<'_>) -> Option<Diagnostic> {
    let word = (0..around.at).rev().find(|i| around.word(*i) == "if")?;
    let before = around.tokens.get(word.checked_sub(1)?)?;
    let is_value = before.is_operator() || matches!(before.text, "(" | "," | "[" | "=>" | "else");
    let brace = (word..around.at).find(|i| around.word(*i) == "{").filter(|_| is_value)?;
    let end = around.closing(brace)?;
    // Reading stopped right behind it, or at it.
    if around.word(end + 1) == "else" || !(end..=end + 1).contains(&around.at) {
        return None;
    }
    if let Some(found) = around.tokens.get(end + 1).and_then(|next| branch(around, next)) {
        return Some(found);
    }
    // What begins a line is a statement of its own.
    let below = tokens(around.text, around.end..around.text.len()).next();
    if let Some(found) = below.and_then(|next| branch(around, &next)) {
        return Some(found);
    }
    let found =
        told(around.span(&around.tokens[word]), "an `if` that gives a value wants an `else`");
    Some(found.help("it is written `if x > 1 { a } else { b }`"))
}

/// `material gold = conductor { … }`
fn named_object(around: &Around<'_>) -> Option<Diagnostic> {
    let start = (around.at.saturating_sub(4)..around.at)
        .rev()
        .find(|i| around.begins(*i) && is_category(around.word(*i)))?;
    let words = around.tokens.get(start..start + 4)?;
    let [category, name, equals, kind] = words else { return None };
    let are_words = [name, kind].iter().all(|t| t.kind == TokenKind::Word && !t.first_on_line);
    let opens = matches!(around.word(start + 4), "{" | ".");
    if !are_words || equals.text != "=" || !opens || around.inner() == Place::Fields {
        return None;
    }
    let all = around.span(category).to(around.span(kind));
    let (category, name, kind) = (category.text, name.text, kind.text);
    let found = told(all, "an object is given a name by `let`");
    let named = format!("let {name} = {category} {kind}");
    // One that stands somewhere may be meant to stand there.
    Some(if stands_nowhere(category) {
        found.fix(all, named)
    } else {
        found.guess(all, named).guess(all, format!("{category} {kind} \"{name}\""))
    })
}

/// `ball.radius = 3 m`
fn set(around: &Around<'_>) -> Option<Diagnostic> {
    let start = around.at.checked_sub(3).filter(|start| around.begins(*start))?;
    let is_member = around.word(start + 1) == "." && around.word(around.at) == "=";
    let words = around.is_word(start) && around.is_word(start + 2);
    let is_label = words && !is_category(around.word(start));
    if !is_label || !is_member || around.inner() == Place::Fields {
        return None;
    }
    let (first, last) = (&around.tokens[start], &around.tokens[start + 2]);
    let gap = Span::new(around.source, first.start, first.start);
    let place = around.span(first).to(around.span(last));
    let found = told(place, "a parameter of an object in the scene is changed by `set`");
    Some(found.help("`set` names the label of the object").fix(gap, "set "))
}

/// `place "ball"`
fn placed(around: &Around<'_>) -> Option<Diagnostic> {
    let label = around.current().filter(|t| t.kind == TokenKind::Text && !t.first_on_line)?;
    let word = around.before(1).filter(|t| t.text == "place" && around.begins(around.at - 1))?;
    let name = label.text.trim_matches('"');
    let found = told(around.span(label), format!("`{}` takes a name, not a label", word.text));
    Some(
        found.help(format!(
            "give the object a name, `let {name} = shape …`, and write `place {name}`"
        )),
    )
}

fn a_vector(around: &Around<'_>, all: Range<usize>, numbers: &[&str]) -> Diagnostic {
    let span = Span::new(around.source, all.start, all.end);
    let found = told(span, "a vector stands between `(` and `)`, with commas");
    found.guess(span, format!("({})", numbers.join(", ")))
}

/// `resolution = 48, 30`, `center = -1, 2, 0`
fn vector_with_commas(around: &Around<'_>) -> Option<Diagnostic> {
    let near = around.at.saturating_sub(WIDEST)..around.at;
    let first = near.rev().find(|i| around.word(*i) == "=")? + 1;
    let (mut next, mut ends) = (first, vec![]);
    while ends.len() < WIDEST {
        let number = next + usize::from(around.word(next) == "-");
        let is_number = around.tokens.get(number).is_some_and(|t| t.kind == TokenKind::Number);
        if !is_number || around.tokens[next].first_on_line {
            break;
        }
        ends.push(number);
        if around.word(number + 1) != "," {
            break;
        }
        next = number + 2;
    }
    let last = *ends.last().filter(|last| ends.len() > 1 && around.at <= **last)?;
    let is_over = |t: &Token<'_>| t.first_on_line || matches!(t.text, "," | "}");
    let all = around.tokens[first].start..around.tokens[last].end();
    let texts = around.text[all.clone()].split(',').map(str::trim).collect::<Vec<_>>();
    // A unit stays behind the brackets; `3,500 W` may be one number.
    let is_parted = around.text[all.clone()].contains(", ");
    let has_unit = is_parted && Unit::named(around.word(last + 1)).is_some();
    around
        .tokens
        .get(last + 1 + usize::from(has_unit))
        .is_none_or(is_over)
        .then(|| a_vector(around, all, &texts))
}

/// `center = 0 0 0`
fn bare_vector(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.checked_sub(1).filter(|first| *first > 0)?;
    let is_number = |t: &&Token<'_>| t.kind == TokenKind::Number && !t.first_on_line;
    let numbers: Vec<&Token<'_>> = around.tokens[first..].iter().take_while(is_number).collect();
    if around.word(first - 1) != "=" || !(2..=WIDEST).contains(&numbers.len()) {
        return None;
    }
    let texts: Vec<&str> = numbers.iter().map(|t| t.text).collect();
    let last = first + numbers.len() - 1;
    // `1 000`, but `640 480` are two.
    let is_thousands = (1..=3).contains(&texts[0].len())
        && texts[0].bytes().all(|byte| matches!(byte, b'1'..=b'9'))
        && texts[1..].iter().all(|text| *text == "000");
    if is_thousands {
        let all = around.span(numbers[0]).to(around.span(&around.tokens[last]));
        return Some(told(all, "no blank stands in a number").guess(all, texts.concat()));
    }
    // `0.2 1/m`
    let unit = around.tokens.get(last + 2).filter(|unit| Unit::named(unit.text).is_some());
    if let ([_, "1"], "/", Some(unit)) = (&texts[..], around.word(last + 1), unit) {
        let all = around.span(numbers[1]).to(around.span(unit));
        let found = told(all, "one over a unit is written with a power");
        let is_whole = !matches!(around.word(last + 3), "^" | "/");
        return Some(if is_whole { found.guess(all, format!("{}^-1", unit.text)) } else { found });
    }
    Some(a_vector(around, numbers[0].start..numbers[numbers.len() - 1].end(), &texts))
}

/// `center = {0, 1, 0}`
fn braced_vector(around: &Around<'_>) -> Option<Diagnostic> {
    let brace = around.at.checked_sub(1).filter(|i| around.word(*i) == "{")?;
    let end = around.closing(brace)?;
    let before = around.before(2)?;
    let is_value = before.is_operator() || matches!(before.text, "(" | "," | "[");
    let inside = &around.tokens[brace + 1..end];
    let is_list = inside.iter().all(|t| t.kind == TokenKind::Number || matches!(t.text, "," | "-"));
    let place = around.tokens[brace].end()..around.tokens[end].start;
    let texts: Vec<&str> = around.text[place].split(',').map(str::trim).collect();
    if !is_value || !is_list || !(2..=WIDEST).contains(&texts.len()) {
        return None;
    }
    Some(a_vector(around, around.tokens[brace].start..around.tokens[end].end(), &texts))
}

/// `center (0, 1, 0) m` among parameters: it was read as a call.
fn called_parameter(around: &Around<'_>) -> Option<Diagnostic> {
    let unit = (around.at.saturating_sub(2)..=around.at).rev().find(|i| {
        let is_unit = around.is_word(*i) && Unit::named(around.word(*i)).is_some();
        is_unit && *i > 0 && around.word(i - 1) == ")" && !around.tokens[*i].first_on_line
    })?;
    let open =
        (0..unit).rev().find(|i| around.word(*i) == "(" && around.closing(*i) == Some(unit - 1))?;
    let at = open.checked_sub(1).filter(|i| around.is_word(*i))?;
    let name = &around.tokens[at];
    let is_listed = around.open.last().is_some_and(|open| around.word(*open) != "{");
    if around.inner() != Place::Fields || is_listed || is_category(name.text) {
        return None;
    }
    let before = &around.tokens[at.checked_sub(1)?];
    // `radius = 1 m center (0, 1, 0) m`
    if !around.begins(at) {
        let is_value = before.kind == TokenKind::Number || Unit::named(before.text).is_some();
        let both = Span::new(around.source, before.end(), name.end());
        let message = format!("a comma is missing before `{}`", name.text);
        let mend = format!(", {} =", name.text);
        return is_value.then(|| around.error("E0014", name, message).fix(both, mend));
    }
    let gap = Span::new(around.source, name.end(), name.end());
    let message = format!("`=` is missing between `{}` and its value", name.text);
    Some(around.error("E0012", &around.tokens[open], message).mend(gap, " =", Grade::Sure))
}
