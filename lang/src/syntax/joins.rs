//! Signs and words between values as other languages have them.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, Span, nearest};

use super::around::{Around, Place, told};
use super::defined::is_type;
use super::head::RANGE;
use super::lex::{Token, TokenKind};

/// Tokens that stand side by side from `first` on, as one place, if their texts are these.
fn joined(around: &Around<'_>, first: usize, texts: &[&str]) -> Option<Span> {
    let tokens = around.tokens.get(first..first + texts.len())?;
    let touch = tokens.windows(2).all(|pair| pair[0].end() == pair[1].start);
    let same = tokens.iter().zip(texts).all(|(token, text)| token.text == *text);
    (touch && same).then(|| around.span(&tokens[0]).to(around.span(&tokens[texts.len() - 1])))
}

/// `a | b`, `|x| x * 2` and `&a`
fn half_joined(around: &Around<'_>, i: usize) -> Option<Diagnostic> {
    let sign = around.tokens.get(i).filter(|sign| matches!(sign.text, "&" | "|"))?;
    let (span, op) = (around.span(sign), sign.text);
    let joins = i.checked_sub(1).is_some_and(|i| around.tokens[i].ends_operand());
    let is_number = |i: usize| around.tokens.get(i).is_some_and(|t| t.kind == TokenKind::Number);
    Some(if joins && (is_number(i - 1) || is_number(i + 1)) {
        let found = told(span, "numbers are not joined bit by bit");
        found.help("whether `n` is even is `n % 2 == 0`; conditions are joined with `&&` and `||`")
    } else if joins {
        let twice = op.repeat(2);
        told(span, format!("conditions are joined with `{twice}`")).fix(span, twice)
    } else if op == "|" {
        let found = told(span, "a function is defined with `fn`");
        found.help("it is written `fn f(x: float) = x + 1`")
    } else {
        told(span, "no `&` stands before a value").guess(span, "")
    })
}

/// `0...3`
fn dots(around: &Around<'_>, first: usize) -> Option<Diagnostic> {
    let [range, next] = around.tokens.get(first..first + 2)? else { return None };
    let is_it = range.text == ".." && next.text.starts_with('.') && range.end() == next.start;
    let all = Span::new(around.source, range.start, range.end() + 1);
    let help = "a range with its end is written `0..=3`";
    is_it.then(|| told(all, RANGE).help(help).guess(all, "..=").guess(all, ".."))
}

/// `x := 3`, `2 ** 3`, `x += 1`, `a ? b : c`, `fn f() -> float`, `fn f(): float`, `(x) => x`
pub(super) fn operator(around: &Around<'_>) -> Option<Diagnostic> {
    let current = around.current()?;
    let (at, back) = (around.at, around.at.saturating_sub(1));
    for first in [back, at] {
        if let Some(span) = joined(around, first, &[":", "="]) {
            return Some(told(span, "a value is given with `=`").fix(span, "="));
        }
        if let Some(found) = dots(around, first) {
            return Some(found);
        }
        if let Some(span) = joined(around, first, &["=", "<"]) {
            return Some(told(span, "this comparison is written `<=`").fix(span, "<="));
        }
        if let Some(span) = joined(around, first, &["==", "="]) {
            return Some(told(span, "values are compared with `==`").fix(span, "=="));
        }
        if let Some(found) = half_joined(around, first) {
            return Some(found);
        }
        if let Some(span) = joined(around, first, &["*", "*"]) {
            return Some(told(span, "a power is written with `^`").fix(span, "^"));
        }
        if let Some(found) = arrow(around, first) {
            return Some(found);
        }
        for op in ["+", "-", "*", "/"] {
            if let Some(span) = joined(around, first, &[op, "="]) {
                let message = format!("a name keeps its value: `{op}=` cannot change it");
                return Some(told(span, message).help("give the new value a name with `let`"));
            }
        }
    }
    match current.text {
        "?" => Some(
            told(around.span(current), "a choice is no operator")
                .help("it is written `if x > 1 { a } else { b }`"),
        ),
        ":" => of_function(around),
        "=>" if around.inner() == Place::Fields && around.begins(back) => {
            let span = around.span(current);
            Some(told(span, "a value is given with `=`").fix(span, "="))
        }
        "=>" if around.before(1)?.text == ")" && around.word(around.statement()) == "fn" => {
            let span = around.span(current);
            Some(told(span, "what a function gives stands behind `=`").fix(span, "="))
        }
        "=>" if matches!(around.word(around.statement()), "assert" | "expect" | "if") => {
            let span = around.span(current);
            Some(told(span, "this comparison is written `>=`").fix(span, ">="))
        }
        "=>" => Some(nameless(around.span(current))),
        _ => None,
    }
}

/// `fn f(x: float): float = x`, `fn f(x: float): x * 2` and `fn f(x: length): { … }`
fn of_function(around: &Around<'_>) -> Option<Diagnostic> {
    let (colon, head) = (around.current()?, around.statement());
    let close = around.closing(head + 2).filter(|_| around.word(head) == "fn")?;
    if close + 1 != around.at {
        return None;
    }
    let is_whole = matches!(around.word(around.at + 2), "=" | "{");
    if is_whole && is_type(around.word(around.at + 1)) {
        return Some(undeclared(around, around.at..around.at + 1));
    }
    let gap = Span::new(around.source, around.tokens[close].end(), colon.end());
    let is_block = around.word(around.at + 1) == "{";
    let (message, instead) = if is_block {
        ("no sign stands before the braces of a function", "")
    } else {
        ("what a function gives stands behind `=`", " =")
    };
    Some(told(around.span(colon), message).guess(gap, instead))
}

/// `fn f() -> float`, `radius -> 1 m`, `lib->oak` and `[for x in a -> x]`
fn arrow(around: &Around<'_>, first: usize) -> Option<Diagnostic> {
    let span = joined(around, first, &["-", ">"])?;
    let before = first.checked_sub(1)?;
    if around.inner() == Place::Fields && around.is_word(before) && around.begins(before) {
        return Some(told(span, "a value is given with `=`, not with `->`").fix(span, "="));
    }
    let open = around.open.last().filter(|open| around.word(**open) == "[");
    if open.is_some_and(|open| around.word(open + 1) == "for") {
        let message = "what a list is made of stands behind `=>`";
        return Some(told(span, message).fix(span, "=>"));
    }
    let touches = around.tokens[before].end() == span.range().start;
    if touches && around.is_word(before) && around.is_word(first + 2) {
        return Some(told(span, "names are joined with `.`").fix(span, "."));
    }
    Some(undeclared(around, first..first + 2))
}

/// The type of what a function gives stands behind a sign of these tokens, which others precede.
fn undeclared(around: &Around<'_>, sign: Range<usize>) -> Diagnostic {
    let ty = around.tokens.get(sign.end).filter(|ty| ty.kind == TokenKind::Word);
    let sign = &around.tokens[sign.start - 1..sign.end];
    let (before, first, last) = (&sign[0], &sign[1], &sign[sign.len() - 1]);
    let end = ty.unwrap_or(last).end();
    told(around.span(first).to(around.span(last)), "what a function gives is not declared")
        .guess(Span::new(around.source, before.end(), end), "")
}

pub(super) fn nameless(span: Span) -> Diagnostic {
    told(span, "a function has a name").help("it is written `fn f(x: float) = x + 1`")
}

/// `a and b`, `a or b`, `not a`
pub(super) fn word_operator(around: &Around<'_>) -> Option<Diagnostic> {
    let back = around.at.saturating_sub(1);
    [back, around.at].into_iter().find_map(|i| {
        let word = around.tokens.get(i)?;
        let next = around.tokens.get(i + 1).filter(|next| !next.first_on_line)?;
        let before = i.checked_sub(1).and_then(|i| around.tokens.get(i))?;
        if !next.begins_operand() || around.begins(i) {
            return None;
        }
        let span = around.span(word);
        match word.text {
            "and" | "or" if before.ends_operand() => condition(span, word.text),
            "not" if !before.ends_operand() || before.text == "if" => {
                let all = Span::new(around.source, word.start, next.start);
                let found = told(span, "`not` is written `!`");
                let (first, end) = (operand(around, i + 1), negated(around, i + 1));
                if first == end {
                    return Some(found.fix(all, "!"));
                }
                let what = &around.text[next.start..around.tokens[end - 1].end()];
                let all = Span::new(around.source, word.start, around.tokens[end - 1].end());
                Some(found.guess(all, format!("!({what})")))
            }
            _ => None,
        }
    })
}

/// What is said of a word that joins conditions elsewhere, if it is one.
pub(super) fn condition(span: Span, word: &str) -> Option<Diagnostic> {
    let (_, sign) = [("and", "&&"), ("or", "||")].into_iter().find(|(known, _)| *known == word)?;
    Some(told(span, format!("`{word}` is written `{sign}`")).fix(span, sign))
}

/// The token behind the name, number, call or brackets that begin with token `at`.
fn operand(around: &Around<'_>, at: usize) -> usize {
    let mut next = match around.word(at) {
        "(" | "[" => around.closing(at).map_or(at, |end| end + 1),
        _ => at + 1,
    };
    loop {
        let touches =
            around.tokens.get(next).is_some_and(|t| t.start == around.tokens[next - 1].end());
        next = match around.word(next) {
            "." => next + 2,
            "(" | "[" if touches => around.closing(next).map_or(next + 1, |end| end + 1),
            _ => return next.min(around.tokens.len()),
        };
    }
}

/// The token behind all that a `not` before token `at` is about: up to another condition, or where the
/// whole one ends.
fn negated(around: &Around<'_>, at: usize) -> usize {
    let mut next = operand(around, at);
    while let Some(token) = around.tokens.get(next).filter(|t| t.is_operator() && !t.first_on_line)
    {
        let is_over = matches!(token.text, "&&" | "||" | "?" | "=>");
        let follows = around.tokens.get(next + 1).is_some_and(Token::begins_operand);
        if is_over || !follows {
            break;
        }
        next = operand(around, next + 1);
    }
    next
}

/// What is said of a word that is not quite `else`.
pub(crate) const ELSE: &str = "the other branch begins with `else`";

/// What is said of a word for `else if`, or of `else` that is misspelt, if it is one.
pub(super) fn branch(around: &Around<'_>, word: &Token<'_>) -> Option<Diagnostic> {
    let span = around.span(word);
    if matches!(word.text, "elif" | "elsif" | "elseif") {
        return Some(told(span, "a further branch is written `else if`").fix(span, "else if"));
    }
    let behind = around.text[word.end()..].trim_start_matches([' ', '\t']);
    let goes_on = behind.starts_with('{') || behind.starts_with("if ");
    let is_behind = around.text[..word.start].trim_end().ends_with('}');
    let is_one = word.text != "else" && nearest(word.text, ["else"]).is_some();
    (goes_on && is_behind && is_one).then(|| told(span, ELSE).guess(span, "else"))
}
