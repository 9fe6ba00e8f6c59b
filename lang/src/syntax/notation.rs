//! Names, operators and lines as other notations have them.

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::Unit;

use super::around::{Around, Place, is_category, told};
use super::lex::{Token, TokenKind};
use super::type_names;
use crate::words::{BEFORE_NAMES, RESERVED};

/// Words in a row that nobody writes but to say something to people.
const SAID: usize = 3;

/// Why the place cannot be read, if something is written there as it is elsewhere.
pub(super) fn notation(around: &Around<'_>) -> Option<Diagnostic> {
    name(around)
        .or_else(|| function(around))
        .or_else(|| condition(around))
        .or_else(|| path(around))
        .or_else(|| setting(around))
        .or_else(|| units(around))
        .or_else(|| operator(around))
        .or_else(|| comprehension(around))
        .or_else(|| block_of_call(around))
}

/// `let 2nd = 1 m` and `let arm-length = 1 m`
fn name(around: &Around<'_>) -> Option<Diagnostic> {
    let (current, before) = (around.current()?, around.before(1)?);
    let next = around.tokens.get(around.at + 1).filter(|t| t.kind == TokenKind::Word)?;
    let touches = current.end() == next.start;
    if current.kind == TokenKind::Number && touches && BEFORE_NAMES.contains(&before.text) {
        let all = around.span(current).to(around.span(next));
        let found = told(all, "a name begins with a letter");
        return Some(found.guess(all, format!("{}{}", next.text, current.text.replace('.', "_"))));
    }
    let word = around.before(2).filter(|word| BEFORE_NAMES.contains(&word.text));
    let is_name = word.is_some() && before.kind == TokenKind::Word;
    if !is_name || current.text != "-" || !touches || before.end() != current.start {
        return None;
    }
    // As many parts as there are.
    let is_part = |i: &usize| around.word(*i) == "-" && around.is_word(i + 1);
    let last = (around.at..).step_by(2).take_while(is_part).last()? + 1;
    let all = around.span(before).to(around.span(&around.tokens[last]));
    let name = around.text[all.range()].replace('-', "_");
    Some(told(all, "a name has no `-`, which subtracts").guess(all, name))
}

/// `double(x: length) = x * 2`, and `double(x) = x * 2`
fn function(around: &Around<'_>) -> Option<Diagnostic> {
    let start = around.tokens.iter().position(|t| t.kind != TokenKind::Doc)?;
    let (name, open) = (around.tokens.get(start)?, start + 1);
    let close = around.closing(open).filter(|_| around.word(open) == "(")?;
    let is_typed = around.is_word(open + 1) && around.word(open + 2) == ":";
    let is_name = name.kind == TokenKind::Word && !RESERVED.contains(&name.text);
    let next = around.word(close + 1);
    let is_head = next == "=" || is_typed && next == "{";
    if !is_name || !is_head || around.at > close + 1 {
        return None;
    }
    let found = told(around.span(name), format!("`fn` is missing before `{}`", name.text));
    let gap = Span::new(around.source, name.start, name.start);
    let example = format!("it is written `fn {}(x: float) = x + 1`", name.text);
    Some(if is_typed { found.fix(gap, "fn ") } else { found.help(example) })
}

/// `else x == 4 { … }` and `else shape box { … }`
fn condition(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(3);
    let word = (first..around.at).rev().find(|i| around.word(*i) == "else")?;
    let (word, next) = (&around.tokens[word], around.tokens.get(word + 1)?);
    let compares = (first..=around.at + 1)
        .any(|i| matches!(around.word(i), "==" | "!=" | "<" | ">" | "<=" | ">="));
    let is_one = !next.first_on_line && !matches!(next.text, "{" | "if");
    let gap = Span::new(around.source, word.end(), word.end());
    let found = told(around.span(word), "behind `else` stands a block, or an `if`");
    match is_one {
        true if compares => Some(found.guess(gap, " if")),
        true if is_category(next.text) => Some(found.help("it is written `else { … }`")),
        _ => None,
    }
}

/// `Material::Diffuse`
fn path(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(1);
    let at = (first..=around.at).find(|i| [*i, i + 1].iter().all(|i| around.word(*i) == ":"))?;
    let (one, other) = (&around.tokens[at], &around.tokens[at + 1]);
    let found = told(around.span(one).to(around.span(other)), "names are joined with `.`");
    let touches = one.end() == other.start;
    touches.then(|| found.help("kinds of objects have none: `material diffuse { … }`"))
}

/// `set camera fov = 30 deg` and `camera.fov = 30 deg`
fn setting(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(3);
    let start = (first..=around.at).rev().find(|i| around.begins(*i) && around.is_word(*i))?;
    let is_set = around.word(start) == "set";
    let at = start + usize::from(is_set);
    let category = around.tokens.get(at).filter(|token| is_category(token.text))?;
    let is_member = around.word(at + 1) == "." && around.word(at + 3) == "=";
    if !(is_set || is_member) || around.inner() == Place::Fields {
        return None;
    }
    let found = told(around.span(category), "what is set is named by its label");
    let word = category.text;
    Some(found.help(format!("of `{word} KIND \"a\" {{ … }}` something is set by `set a.NAME = …`")))
}

/// `units length = mm`
fn units(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.current().filter(|t| t.kind == TokenKind::Word && !t.first_on_line)?;
    let word = around.before(1).filter(|t| t.text == "units" && around.begins(around.at - 1))?;
    let ends = |t: &Token<'_>| t.first_on_line || t.text == ";";
    let end = around.tokens[around.at + 1..].iter().position(ends);
    let last = &around.tokens[end.map_or(around.tokens.len(), |n| around.at + 1 + n) - 1];
    let all = around.span(first).to(around.span(last));
    let found = told(all, format!("what `{}` says stands between `{{` and `}}`", word.text));
    let written = &around.text[all.range()];
    // `units mm`
    let name = Unit::named(written).and_then(|unit| {
        type_names::measured().find(|name| type_names::dimension(name) == Some(unit.dimension))
    });
    let said = name.map_or_else(|| written.to_owned(), |name| format!("{name} = {written}"));
    Some(found.guess(all, format!("{{ {said} }}")))
}

/// `a <> b`, `i++` and `*/`
fn operator(around: &Around<'_>) -> Option<Diagnostic> {
    let pair = |i: usize| {
        let (one, other) = (around.tokens.get(i)?, around.tokens.get(i + 1)?);
        let ends = around.tokens.get(i + 2).is_none_or(|next| next.first_on_line);
        (one.end() == other.start).then_some((one, other, ends))
    };
    (around.at.saturating_sub(2)..=around.at).filter_map(pair).find_map(|(one, other, ends)| {
        let all = around.span(one).to(around.span(other));
        match (one.text, other.text) {
            ("<", ">") => Some(told(all, "this comparison is written `!=`").fix(all, "!=")),
            ("+", "+") | ("-", "-") if ends => {
                let message = format!("there is no `{0}{0}`", one.text);
                Some(told(all, message).help("a name keeps its value; another one is computed"))
            }
            ("*", "/") => Some(told(all, "this `*/` closes no comment").guess(all, "")),
            _ => None,
        }
    })
}

/// Words that elsewhere stand between what lists are made of and chosen by.
fn joins(word: &str) -> bool {
    matches!(word, "," | "for" | "unless" | "when" | "where")
}

/// `[for x in 0..4 x * 2]`, `[for x in 0..4 => x if x > 2]`
fn comprehension(around: &Around<'_>) -> Option<Diagnostic> {
    let open = *around.open.last().filter(|open| around.word(**open) == "[")?;
    let current = around.current().filter(|_| around.word(open + 1) == "for")?;
    let close = around.closing(open).unwrap_or(around.tokens.len());
    let arrow = (open..close).find(|i| around.word(*i) == "=>");
    let has_in = (open..around.at).any(|i| around.word(i) == "in");
    let message = match arrow {
        None if has_in => "`=>` is missing before what a list is made of",
        Some(arrow)
            if arrow < around.at && matches!(current.text, "if" | "unless" | "when" | "where") =>
        {
            "what a list is chosen by stands before `=>`"
        }
        Some(arrow) if arrow > around.at && has_in && joins(current.text) => {
            "between `in` and `=>` stand one range or list, and one `if`"
        }
        _ => return None,
    };
    let found = told(around.span(current), message);
    Some(found.help("it is written `[for i in 0..4 if i > 1 => i * 2]`"))
}

/// `rotate((0, 1, 0), 30 deg) { … }`
fn block_of_call(around: &Around<'_>) -> Option<Diagnostic> {
    let brace = around.current().filter(|brace| brace.text == "{")?;
    let open = around.opening(around.at.checked_sub(1)?)?;
    let start = open.checked_sub(1).filter(|i| around.is_word(*i) && around.begins(*i))?;
    let word = around.word(start);
    if RESERVED.contains(&word) || brace.first_on_line || around.inner() == Place::Fields {
        return None;
    }
    let found = told(around.span(brace), "no block stands behind a call");
    let moves = ["move", "rotate", "scale", "translate"].iter().any(|name| word.starts_with(name));
    Some(found.help(if moves {
        "what is moved is given where it is: `transform = rotate((0, 1, 0), 20 deg)`"
    } else {
        "it stands behind an object, a `for` or an `if`, or a head of `fn`"
    }))
}

/// `a forgotten comment`: what says nothing to the language.
pub(super) fn remark(around: &Around<'_>) -> Option<Diagnostic> {
    let last = around.at.min(around.tokens.len().checked_sub(1)?);
    let start = (1..=last).rev().find(|i| around.tokens[*i].first_on_line).unwrap_or(0);
    let is_said = |t: &&Token<'_>| t.kind == TokenKind::Word && !RESERVED.contains(&t.text);
    let begun = around.tokens[start..].iter().enumerate();
    let on_line = begun.take_while(|(i, t)| *i == 0 || !t.first_on_line).map(|(_, t)| t);
    let line: Vec<&Token<'_>> = on_line.collect();
    let n_said = line.iter().copied().take_while(is_said).count();
    let gives = line.iter().any(|t| matches!(t.text, "=" | "{" | "}"));
    if n_said < SAID || gives || is_category(line[0].text) || around.inner() == Place::Fields {
        return None;
    }
    let all = around.span(line[0]).to(around.span(line[line.len() - 1]));
    let gap = Span::new(around.source, line[0].start, line[0].start);
    Some(told(all, "these words say nothing; a remark stands behind `//`").guess(gap, "// "))
}
