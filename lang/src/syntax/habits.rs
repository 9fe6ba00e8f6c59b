//! What people write who think of another language, or whose editor sets type for them.

use luxel_core::diag::{Diagnostic, Span};

use super::around::{Around, Place, is_category, stands_behind, stands_nowhere, told};
use super::defined::stem;
use super::foreign::{TYPE_BEHIND, TYPES, foreign};
use super::joins::{branch, nameless, operator, word_operator};
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
pub(crate) const ONE_WORD: &str = "a name is one word";

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

/// `# comment` and `#ff8000`
fn hash(around: &Around<'_>) -> Option<Diagnostic> {
    let mark = around.current().filter(|mark| mark.text == "#")?;
    let rest = &around.text[mark.end()..around.end];
    let digits = rest.find(|c: char| !c.is_ascii_hexdigit()).unwrap_or(rest.len());
    if let Some(found) = directive(around, mark) {
        return Some(found);
    }
    let gap = rest.len() - rest.trim_start_matches([' ', '\t']).len();
    let span = Span::new(around.source, mark.start, mark.end() + gap + 1);
    let found = told(span, "a table of numbers stands between `#[` and `]`");
    if rest[gap..].starts_with('[') && !mark.first_on_line {
        return Some(found.guess(span, "#["));
    }
    if rest[gap..].starts_with(['{', '(', '<']) && !mark.first_on_line {
        return Some(found);
    }
    if rest.starts_with("#[") && !mark.first_on_line {
        return Some(found.guess(around.span(mark), ""));
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

/// `elif`, `return`, `lambda`, `mut`
fn word(around: &Around<'_>) -> Option<Diagnostic> {
    let current = around.current()?;
    let before = around.before(1)?;
    let near = around.at.saturating_sub(2)..=around.at;
    let mut behind = near.filter(|i| *i == 0 || around.word(i - 1) == "}");
    if let Some(found) = behind.find_map(|i| branch(around, around.tokens.get(i)?)) {
        return Some(found);
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
    // Of a tolerance it is a share of what is expected.
    if around.word(around.statement()) == "expect" {
        return Some(found.help("a tolerance is measured as what is expected: `0.5 ± 0.05`"));
    }
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

/// `let room group = { … }`
fn value_before_sign(
    around: &Around<'_>,
    name: &Token<'_>,
    value: &Token<'_>,
) -> Option<Diagnostic> {
    let sign = around.tokens.get(around.at + 1).filter(|sign| sign.text == "=")?;
    let is_object = value.text == "group" && around.word(around.at + 2) == "{";
    let message = format!("`=` stands between `{}` and its value", name.text);
    let gap = Span::new(around.source, name.end(), sign.end());
    let found = around.error("E0012", value, message);
    is_object.then(|| found.fix(gap, format!(" = {}", value.text)))
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
            if let Some(found) = value_before_sign(around, last, second) {
                return Some(found);
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
            let all = around.span(category).to(both);
            let named = format!("let {label} = {} {kind}", category.text);
            let found = found.help(help).guess(both, format!("{kind} \"{label}\""));
            Some(found.guess(all, named))
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
    stands_behind(word, "=", below)
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
