//! What people write who think of another language, or whose editor sets type for them.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, Place, is_category, stands_nowhere, told};
use super::defined::stem;
use super::foreign::{TYPE_BEHIND, TYPES, foreign};
use super::lex::{Token, TokenKind};
use super::listed::listed;
use super::paths::{imported_from, unquoted};
use super::signs::sign;
use super::statement::statement;
use super::type_names;

/// What is said of `#` where a comment is meant.
pub(super) const COMMENTS: &str = "a comment begins with `//`";

/// Bytes that are looked at for a use of a name.
const LOOKED_AT: usize = 1 << 12;

/// What is said of two words that stand for one name.
const ONE_WORD: &str = "a name is one word";

/// Why the place cannot be read, if it looks like another language's way.
pub(super) fn habit(around: &Around<'_>) -> Option<Diagnostic> {
    sign(around)
        .or_else(|| imported_from(around))
        .or_else(|| unquoted(around))
        .or_else(|| hash(around))
        .or_else(|| foreign(around))
        .or_else(|| listed(around))
        .or_else(|| statement(around))
        .or_else(|| operator(around))
        .or_else(|| word_operator(around))
        .or_else(|| word(around))
        .or_else(|| vector(around))
        .or_else(|| share(around))
        .or_else(|| decimal_comma(around))
        .or_else(|| definition(around))
        .or_else(|| two_words(around))
        .or_else(|| object(around))
        .or_else(|| given(around))
}

/// Tokens that stand side by side from `first` on, as one place, if their texts are these.
fn joined(around: &Around<'_>, first: usize, texts: &[&str]) -> Option<Span> {
    let tokens = around.tokens.get(first..first + texts.len())?;
    let touch = tokens.windows(2).all(|pair| pair[0].end() == pair[1].start);
    let same = tokens.iter().zip(texts).all(|(token, text)| token.text == *text);
    (touch && same).then(|| around.span(&tokens[0]).to(around.span(&tokens[texts.len() - 1])))
}

/// `# comment` and `#ff8000`
fn hash(around: &Around<'_>) -> Option<Diagnostic> {
    let mark = around.current().filter(|mark| mark.text == "#")?;
    let rest = &around.text[mark.end()..around.end];
    let digits = rest.find(|c: char| !c.is_ascii_hexdigit()).unwrap_or(rest.len());
    if let Some(found) = directive(around, mark) {
        return Some(found);
    }
    let gap = rest.len() - rest.trim_start_matches([' ', '\t']).len();
    if rest[gap..].starts_with('[') && !mark.first_on_line {
        let span = Span::new(around.source, mark.start, mark.end() + gap + 1);
        return Some(told(span, "a table of numbers begins with `#[`").guess(span, "#["));
    }
    if mark.first_on_line || !matches!(digits, 3 | 6) {
        let found = told(around.span(mark), COMMENTS);
        return Some(found.guess(around.span(mark), "//"));
    }
    let width = digits / 3;
    let part = |i: usize| {
        let digits = &rest[i * width..(i + 1) * width];
        let most = if width == 1 { 15.0 } else { 255.0 };
        u8::from_str_radix(digits, 16).map_or(0.0, |x| (f64::from(x) / most * 1e4).round() / 1e4)
    };
    let span = Span::new(around.source, mark.start, mark.end() + digits);
    let color = format!("rgb.srgb({}, {}, {})", part(0), part(1), part(2));
    let message = "a colour is given by numbers, and says in which space they are";
    Some(told(span, message).guess(span, color))
}

/// `#declare x = 3`
fn directive(around: &Around<'_>, mark: &Token<'_>) -> Option<Diagnostic> {
    let word = around.tokens.get(around.at + 1).filter(|word| word.start == mark.end())?;
    let next = around.tokens.get(around.at + 2);
    if word.text == "include" && next.is_some_and(|next| next.kind == TokenKind::Text) {
        let found = told(around.span(mark), "another file is read by `include`, without `#`");
        return Some(found.fix(around.span(mark), ""));
    }
    let (name, value) = (next?, around.tokens.get(around.at + 3)?);
    let is_given = word.text == "define" && value.begins_operand() && !value.first_on_line;
    if name.kind != TokenKind::Word || !is_given && value.text != "=" {
        return None;
    }
    let span = around.span(mark).to(around.span(word));
    let found = told(span, format!("`#{}` begins no statement", word.text));
    let found = found.help("did you mean `let`?");
    if value.text == "=" {
        return Some(found.guess(span, "let"));
    }
    let head = Span::new(around.source, mark.start, value.start);
    Some(found.guess(head, format!("let {} = ", name.text)))
}

/// `a | b`, `|x| x * 2` and `&a`
fn half_joined(around: &Around<'_>, i: usize) -> Option<Diagnostic> {
    let sign = around.tokens.get(i).filter(|sign| matches!(sign.text, "&" | "|"))?;
    let (span, op) = (around.span(sign), sign.text);
    let joins = i.checked_sub(1).is_some_and(|i| around.tokens[i].ends_operand());
    Some(if joins {
        let twice = op.repeat(2);
        told(span, format!("conditions are joined with `{twice}`")).fix(span, twice)
    } else if op == "|" {
        let found = told(span, "a function is defined with `fn`");
        found.help("it is written `fn f(x: float) = x + 1`")
    } else {
        told(span, "no `&` stands before a value").guess(span, "")
    })
}

/// `x := 3`, `2 ** 3`, `x += 1`, `a ? b : c`, `fn f() -> float`, `(x) => x`
fn operator(around: &Around<'_>) -> Option<Diagnostic> {
    let current = around.current()?;
    let (at, back) = (around.at, around.at.saturating_sub(1));
    for first in [back, at] {
        if let Some(span) = joined(around, first, &[":", "="]) {
            return Some(told(span, "a value is given with `=`").fix(span, "="));
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
        if let Some(span) = joined(around, first, &["-", ">"]) {
            if around.inner() == Place::Fields && around.is_word(first.wrapping_sub(1)) {
                return Some(told(span, "a value is given with `=`, not with `->`").fix(span, "="));
            }
            let open = around.open.last().filter(|open| around.word(**open) == "[");
            if open.is_some_and(|open| around.word(open + 1) == "for") {
                let message = "what a list is made of stands behind `=>`";
                return Some(told(span, message).fix(span, "=>"));
            }
            let found = told(span, "what a function gives is not declared");
            let ty = around.tokens.get(first + 2).filter(|ty| ty.kind == TokenKind::Word);
            let before =
                around.tokens.get(first.wrapping_sub(1)).map_or(span.range().start, Token::end);
            let end = ty.map_or(span.range().end, Token::end);
            return Some(found.guess(Span::new(around.source, before, end), ""));
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
        "=>" if around.inner() == Place::Fields && around.begins(back) => {
            let span = around.span(current);
            Some(told(span, "a value is given with `=`").fix(span, "="))
        }
        "=>" if around.before(1)?.text == ")" && around.word(0) == "fn" => {
            let span = around.span(current);
            Some(told(span, "what a function gives stands behind `=`").fix(span, "="))
        }
        "=>" => Some(nameless(around.span(current))),
        _ => None,
    }
}

fn nameless(span: Span) -> Diagnostic {
    told(span, "a function has a name").help("it is written `fn f(x: float) = x + 1`")
}

/// `a and b`, `a or b`, `not a`
fn word_operator(around: &Around<'_>) -> Option<Diagnostic> {
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

/// `elif`, `return`, `lambda`, `mut`
fn word(around: &Around<'_>) -> Option<Diagnostic> {
    let current = around.current()?;
    let before = around.before(1)?;
    let span = around.span(current);
    if matches!(current.text, "elif" | "elsif" | "elseif") && before.text == "}" {
        return Some(told(span, "a further branch is written `else if`").fix(span, "else if"));
    }
    match before.text {
        "return" if !current.first_on_line => Some(
            told(around.span(before), "what a function gives stands behind its `=`")
                .help("it is written `fn f(x: float) = x + 1`"),
        ),
        "lambda" => Some(nameless(around.span(before))),
        "new" if !current.first_on_line && !around.begins(around.at - 1) => Some(
            told(around.span(before), "an object is made without `new`")
                .help("it is written `material diffuse { reflectance = 0.5 }`"),
        ),
        "mut" if around.before(2).is_some_and(|t| t.text == "let") => {
            let all = Span::new(around.source, before.start, current.start);
            Some(told(around.span(before), "a name keeps its value").fix(all, ""))
        }
        _ => None,
    }
}

/// `<1, 2, 3>`
fn vector(around: &Around<'_>) -> Option<Diagnostic> {
    let open = around.current().filter(|open| open.text == "<")?;
    let is_value =
        around.before(1).is_some_and(|t| t.is_operator() || matches!(t.text, "(" | "," | "["));
    let line = around.text[open.end()..around.end].split('\n').next().filter(|_| is_value)?;
    let length = line.find('>')?;
    let all = Span::new(around.source, open.start, open.end() + length + 1);
    let found = told(around.span(open), "a vector stands between `(` and `)`");
    Some(found.guess(all, format!("({})", &line[..length])))
}

/// `70%`
fn share(around: &Around<'_>) -> Option<Diagnostic> {
    let (sign, number) = (around.before(1)?, around.before(2)?);
    let follows = around.current().is_some_and(|t| !t.first_on_line && t.begins_operand());
    let is_share = sign.text == "%" && number.kind == TokenKind::Number;
    let value: f64 = number.text.parse().ok().filter(|_| is_share && !follows)?;
    let span = around.span(number).to(around.span(sign));
    let found = told(span, "a share is written as a number: 1 is all");
    Some(found.guess(span, format!("{}", value / 100.0)))
}

/// `0,2 m`
fn decimal_comma(around: &Around<'_>) -> Option<Diagnostic> {
    let (number, comma, rest) = (around.before(2)?, around.before(1)?, around.current()?);
    let is_number = |t: &Token<'_>| t.kind == TokenKind::Number && !t.text.contains('.');
    let is_list = around.open.last().is_some_and(|open| around.word(*open) != "{");
    let touch = number.end() == comma.start && comma.end() == rest.start;
    if comma.text != "," || !is_number(number) || !is_number(rest) || is_list || !touch {
        return None;
    }
    let span = around.span(comma);
    if rest.text.len() == 3 {
        let found = told(span, "no comma stands in a number, and the decimal point is `.`");
        return Some(found.guess(span, "").guess(span, "."));
    }
    Some(told(span, "the decimal point is written `.`").guess(span, "."))
}

/// `base color = 3`
fn two_words(around: &Around<'_>) -> Option<Diagnostic> {
    around.current().filter(|sign| sign.text == "=")?;
    let (first, second) = (around.before(2)?, around.before(1)?);
    let are_words = [first, second].iter().all(|word| word.kind == TokenKind::Word);
    let is_field = around.begins(around.at - 2) && around.inner() == Place::Fields;
    if !are_words || !is_field || second.first_on_line || is_category(first.text) {
        return None;
    }
    let gap = Span::new(around.source, first.end(), second.start);
    Some(told(around.span(first).to(around.span(second)), ONE_WORD).guess(gap, "_"))
}

/// `let x int = 3`, `let go ld = 3`, `param x = 3`, `import "a.scene"`
fn definition(around: &Around<'_>) -> Option<Diagnostic> {
    let (last, before) = (around.before(1)?, around.before(2));
    let is_word = last.kind == TokenKind::Word;
    match (before.map_or("", |t| t.text), around.current()) {
        ("let" | "param", Some(second)) if is_word && second.kind == TokenKind::Word => {
            if second.first_on_line {
                return None;
            }
            let gap = Span::new(around.source, last.end(), second.start);
            let is_object = is_category(second.text)
                && (around.word(around.at + 1) == "{" || around.is_word(around.at + 1));
            if is_object {
                let message = format!("`=` is missing between `{}` and its value", last.text);
                return Some(around.error("E0012", second, message).fix(gap, " = "));
            }
            let is_type = |word: &Token<'_>| type_names::names().any(|known| known == word.text);
            if is_type(second) {
                let found = told(around.span(second), TYPES);
                return Some(found.fix(gap, ": "));
            }
            let both = around.span(last).to(around.span(second));
            if is_type(last) && around.word(around.at + 1) == "=" {
                let found = told(both, TYPE_BEHIND);
                return Some(found.fix(both, format!("{}: {}", second.text, last.text)));
            }
            Some(told(both, ONE_WORD).guess(gap, "_"))
        }
        ("param", Some(equals)) if is_word && equals.text == "=" => {
            let message = format!("the parameter `{}` needs a type", last.text);
            let found = around.error("E0024", last, message);
            let value = around.tokens.get(around.at + 1);
            let gap = Span::new(around.source, last.end(), last.end());
            let is_int = |t: &&Token<'_>| {
                t.kind == TokenKind::Number && t.text.bytes().all(|b| b.is_ascii_digit())
            };
            let help = format!("write `{}: length`, `float`, `int`, `angle`, …", last.text);
            let is_alone = !around.is_word(around.at + 2)
                || around.tokens.get(around.at + 2).is_some_and(|t| t.first_on_line);
            Some(match value.filter(is_int).filter(|_| is_alone) {
                Some(_) => found.help(help).guess(gap, ": int").guess(gap, ": float"),
                None => found.help(help),
            })
        }
        (_, next) if last.kind == TokenKind::Text && next.is_none_or(|t| t.first_on_line) => {
            import(around, last)
        }
        _ => None,
    }
}

/// `import "a.scene"` without a name.
fn import(around: &Around<'_>, path: &Token<'_>) -> Option<Diagnostic> {
    let word = around.before(2).filter(|word| word.text == "import")?;
    let name = stem(path.text).unwrap_or("lib");
    let end = Span::new(around.source, path.end(), path.end());
    let found = told(around.span(word).to(around.span(path)), "what is imported needs a name");
    Some(found.guess(end, format!(" as {name}")))
}

/// `shape "sphere" "ball" { … }`, `shape "ball" sphere { … }` and `material paint diffuse { … }`
fn object(around: &Around<'_>) -> Option<Diagnostic> {
    let first = around.at.saturating_sub(3);
    let start =
        (first..around.at).rev().find(|i| around.begins(*i) && is_category(around.word(*i)))?;
    let (kind, label) = (around.tokens.get(start + 1)?, around.tokens.get(start + 2)?);
    let opens = |i: usize| around.word(i) == "{" && around.inner() != Place::Fields;
    let apart = |t: &Token<'_>| t.first_on_line;
    if apart(kind) || apart(label) || !opens(start + 3) {
        return None;
    }
    match (kind.kind, label.kind) {
        (TokenKind::Text, TokenKind::Text) => {
            let word = kind.text.trim_matches('"');
            let found = told(around.span(kind), "the kind of an object is a word, not a text");
            Some(found.fix(around.span(kind), word))
        }
        (TokenKind::Word, TokenKind::Word) => {
            // `shape sphere sphere { … }` and `shape shape sphere { … }`
            for (one, again) in [(&around.tokens[start], kind), (kind, label)] {
                if one.text == again.text {
                    let found =
                        told(around.span(again), format!("`{}` is written twice", one.text));
                    let gap = Span::new(around.source, one.end(), again.end());
                    return Some(found.fix(gap, ""));
                }
            }
            let both = around.span(kind).to(around.span(label));
            let category = &around.tokens[start];
            let (kind, label) = (kind.text, label.text);
            if stands_nowhere(category.text) {
                let (word, all) = (category.text, around.span(category).to(both));
                let (kind, label) =
                    if is_given(around, kind) { (label, kind) } else { (kind, label) };
                let found = told(both, format!("a {word} gets its name by `let`"));
                let help = format!("or `let {kind} = {word} {label}`, if `{label}` is the kind");
                let mend = format!("let {label} = {word} {kind}");
                return Some(found.help(help).guess(all, mend));
            }
            let found = told(both, "an object has one kind, and its label is a text");
            let help = format!("or `{label} \"{kind}\"`, if `{label}` is the kind");
            Some(found.help(help).guess(both, format!("{kind} \"{label}\"")))
        }
        (TokenKind::Text, TokenKind::Word) => {
            let both = around.span(kind).to(around.span(label));
            let found = told(around.span(kind), "the label of an object stands behind its kind");
            Some(found.fix(both, format!("{} {}", label.text, kind.text)))
        }
        _ => None,
    }
}

/// Whether a word is the value of something not far below, as a name is and a kind of object is not.
fn is_given(around: &Around<'_>, word: &str) -> bool {
    let (start, end) = (around.end, (around.end + LOOKED_AT).min(around.text.len()));
    let below = &around.text.as_bytes()[start.min(end)..end];
    memchr::memmem::find_iter(below, word).any(|at| {
        let before = below[..at].trim_ascii_end();
        let ends =
            below.get(at + word.len()).is_none_or(|b| !b.is_ascii_alphanumeric() && *b != b'_');
        before.ends_with(b"=") && ends
    })
}

/// `expect mean = 1, where { … }`, what is expected on one line
fn given(around: &Around<'_>) -> Option<Diagnostic> {
    around.current().filter(|brace| brace.text == "{")?;
    let word = around.before(1).filter(|word| word.text == "where")?;
    let expected = around.text[..word.start].trim_end().strip_suffix([',', ';'])?;
    let statement = expected.rsplit(['\n', '{', ';']).next()?;
    statement.trim_start().strip_prefix("expect")?.strip_prefix([' ', '\t'])?;
    let comma = Span::new(around.source, expected.len(), expected.len() + 1);
    Some(told(comma, "`where` follows its `expect` without a comma").fix(comma, ""))
}
