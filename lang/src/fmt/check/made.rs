//! Scenes that no one wrote: every form of the grammar, blanks and comments wherever they may stand.

use proptest::prelude::*;

/// What may stand before a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gap {
    /// Blanks, lines and comments.
    Free,
    /// Blanks and comments that do not end the line.
    Line,
    /// Blanks, at least one.
    Blank,
    /// Perhaps blanks.
    Unit,
    /// Nothing.
    Tight,
    /// The end of a statement.
    End,
    /// The end of a field: perhaps a comma.
    Field,
}

/// A word of the language with what is before it.
pub(crate) type Word = (Gap, String);
pub(crate) type Words = BoxedStrategy<Vec<Word>>;

/// Words that are apart by free gaps; `~` before one puts it on the same line, `_` after blanks, `!`
/// nowhere.
fn words(text: &str) -> Vec<Word> {
    let word = |word: &str| match word.split_at_checked(1) {
        Some(("~", rest)) if !rest.is_empty() => (Gap::Line, rest.to_owned()),
        Some(("_", rest)) if !rest.is_empty() => (Gap::Blank, rest.to_owned()),
        Some(("!", rest)) if !rest.is_empty() && rest != "=" => (Gap::Tight, rest.to_owned()),
        _ => (Gap::Free, word.to_owned()),
    };
    text.split_whitespace().map(word).collect()
}

/// Fixed words with strategies in the places of `%`.
fn put(pattern: &'static str, parts: Vec<Words>) -> Words {
    let join = move |parts: Vec<Vec<Word>>| {
        let mut parts = parts.into_iter();
        let mut out = vec![];
        for (i, fixed) in pattern.split('%').enumerate() {
            if i > 0 {
                out.extend(parts.next().expect("a part for each place"));
            }
            out.extend(words(fixed));
        }
        out
    };
    parts.prop_map(join).boxed()
}

fn one_of(texts: &'static [&'static str]) -> Words {
    prop::sample::select(texts).prop_map(words).boxed()
}

/// Between `open` and `close`, parted by commas; perhaps one more at the end.
fn list(open: &'static str, item: Words, least: usize, close: &'static str) -> Words {
    let items = prop::collection::vec(item, least..6);
    (items, any::<bool>())
        .prop_map(move |(items, trailing)| {
            let mut out = words(open);
            let n = items.len();
            for (i, item) in items.into_iter().enumerate() {
                out.extend(item);
                if i + 1 < n || trailing {
                    out.push((Gap::Free, ",".into()));
                }
            }
            out.extend(words(close));
            out
        })
        .boxed()
}

fn atom() -> Words {
    let unit = (0..1000_u32, one_of(&["mm", "W/m^2/sr", "m^-2", "deg"])).prop_map(|(n, unit)| {
        let unit = unit.into_iter().map(|(_, text)| (Gap::Unit, text));
        std::iter::once((Gap::Free, n.to_string())).chain(unit).collect()
    });
    let table = prop::sample::select(&["#[1 2]", "#[]", "#[ 1.5,-2,  30 4e1/* c */]"][..])
        .prop_map(|table| vec![(Gap::Free, table.to_owned())]);
    let rows = (1..5_usize, 1..6_usize, any::<u32>()).prop_map(|(rows, columns, seed)| {
        let cell = |i: usize| {
            let n = (u64::from(seed) >> (i % 7)) % 1000;
            [format!("{n}"), format!("-{n}.25"), format!("{n}e1 "), format!(".{n}")][i % 4].clone()
        };
        let row = |r: usize| {
            let cells: Vec<_> = (0..columns).map(|c| cell(r * columns + c)).collect();
            cells.join([" ", "  ", ", "][(r + columns) % 3])
        };
        let rows: Vec<_> = (0..rows).map(row).collect();
        let start = ["", " ", "\n"][seed as usize % 3];
        vec![(Gap::Free, format!("#[{start}{}]", rows.join("\n")))]
    });
    prop_oneof![
        4 => one_of(&["a", "a_name_that_is_long.b", "1", "2.5e-3", ".5", "\"x//\\\"/*y\"", "true"]),
        2 => unit,
        1 => table,
        1 => rows,
        1 => one_of(&["(0, 1, 0)", "(1, -2, +3,)", "[1]", "(1,)", "(- 1, 2)"]).prop_map(spaced),
    ]
    .boxed()
}

/// Cuts brackets, commas and numbers apart.
fn spaced(joined: Vec<Word>) -> Vec<Word> {
    let mut out: Vec<Word> = vec![];
    for (_, text) in joined {
        let mut number = String::new();
        for c in text.chars() {
            if matches!(c, '(' | ')' | '[' | ']' | ',') {
                if !number.is_empty() {
                    out.push((Gap::Free, std::mem::take(&mut number)));
                }
                out.push((Gap::Free, c.to_string()));
            } else {
                number.push(c);
            }
        }
        if !number.is_empty() {
            out.push((Gap::Free, number));
        }
    }
    out
}

/// Expressions.
fn expr() -> Words {
    atom().prop_recursive(4, 48, 6, |inner| {
        let infix = one_of(&["+", "-", "*", "/", "%", "^", "==", "<=", "&&", "||", "..", "..="]);
        let arg = prop_oneof![inner.clone(), put("n = %", vec![inner.clone()])].boxed();
        prop_oneof![
            4 => put("% % %", vec![inner.clone(), infix, inner.clone()]),
            1 => put("- %", vec![inner.clone()]),
            1 => put("( % )", vec![inner.clone()]),
            2 => list("[", inner.clone(), 0, "]"),
            1 => list("(", inner.clone(), 2, ")"),
            1 => put("( % , )", vec![inner.clone()]),
            2 => list("f (", arg, 0, ")"),
            1 => put("a [ % ] !. !x", vec![inner.clone()]),
            1 => put("[ for i in % => % ]", vec![inner.clone(), inner.clone()]),
            1 => put(
                "[ for i , x in % if % => % ]",
                vec![inner.clone(), inner.clone(), inner.clone()]
            ),
            1 => put("if a { % } else { % }", vec![inner.clone(), inner.clone()]),
            1 => put("if a { % } else if b { % } else { % }", vec![inner.clone(), inner.clone(), inner.clone()]),
            1 => put("a with %", vec![record(inner.clone())]),
            1 => put("( % )", vec![object(fields(inner.clone()))]),
        ]
        .boxed()
    }).boxed()
}

/// An expression, or an object alone.
fn value() -> Words {
    prop_oneof![4 => expr(), 1 => object(fields(expr()))].boxed()
}

/// Fields, each with what ends it.
fn fields(value: Words) -> Words {
    let name = one_of(&["a", "center", "a_name_that_is_long", "where"]);
    let field = put("% = %", vec![name, value]);
    prop::collection::vec(field, 0..4)
        .prop_map(|fields| {
            let mut out = vec![];
            for mut field in fields {
                if !out.is_empty() {
                    field[0].0 = Gap::Field;
                }
                out.extend(field);
            }
            out
        })
        .boxed()
}

fn record(value: Words) -> Words {
    put("{ % }", vec![fields(value)])
}

fn object(body: Words) -> Words {
    let head = one_of(&["shape _box _\"a\"", "shape _sphere", "film _\"b\"", "group", "x _y.z"]);
    // No comment stands before the brace of an object.
    let brace = prop::sample::select(&[Gap::Unit, Gap::Blank][..]);
    (head, brace, body)
        .prop_map(|(mut out, brace, body)| {
            out.push((brace, "{".into()));
            out.extend(body);
            out.extend(words("}"));
            out
        })
        .boxed()
}

fn statement() -> Words {
    let simple = prop_oneof![
        3 => put("let x = %", vec![value()]),
        1 => put("let x : length = %", vec![value()]),
        1 => put("param p : float = % in %", vec![expr(), expr()]),
        1 => put("fn f ( a : int , b : vec3 = % ) = %", vec![expr(), value()]),
        1 => put("include \"f\" with %", vec![record(expr())]),
        1 => one_of(&["import \"f\" as n", "use plugin \"v\" ~version \"^1\"", "place a.b _\"l\""]),
        1 => put("set a !. !b = %", vec![value()]),
        1 => put("assert a , \"m\"", vec![]),
        1 => put("units %", vec![record(expr())]),
        1 => put("expect mean = 1 ± 2 where %", vec![record(expr())]),
        1 => put("expect pixel ( % , 2 ) = a +- .5", vec![expr()]),
        1 => put("expect mean = % ± %", vec![expr(), expr()]),
        2 => put("name = %", vec![value()]),
        2 => object(fields(value())),
        1 => put("f ( % )", vec![expr()]),
    ]
    .boxed();
    let documented = |it: Words| {
        (it, 0..8)
            .prop_map(|(mut words, n)| {
                if n == 0 {
                    words.insert(0, (Gap::Free, "@off".into()));
                } else if n == 1 {
                    words.insert(0, (Gap::Free, "/// doc\n".into()));
                }
                words
            })
            .boxed()
    };
    documented(simple)
        .prop_recursive(2, 24, 4, move |inner| {
            let block = put("{ % }", vec![statements(inner)]);
            documented(
                prop_oneof![
                    put("for i in % %", vec![expr(), block.clone()]),
                    put("for i , x in a %", vec![block.clone()]),
                    put(
                        "if a < 1 % else if b % else %",
                        vec![block.clone(), block.clone(), block.clone()]
                    ),
                    put("if % %", vec![expr(), block.clone()]),
                    put("fn g ( ) %", vec![block.clone()]),
                    put("place a %", vec![block.clone()]),
                    put("group _\"g\" %", vec![block]).prop_map(|mut words| {
                        words[2].0 = Gap::Unit;
                        words
                    }),
                ]
                .boxed(),
            )
        })
        .boxed()
}

fn statements(statement: Words) -> Words {
    prop::collection::vec(statement, 0..4)
        .prop_map(|list| {
            let mut out = vec![];
            for mut words in list {
                if !out.is_empty() {
                    words[0].0 = Gap::End;
                }
                out.extend(words);
            }
            out
        })
        .boxed()
}

/// The statements of a file.
pub(crate) fn file() -> Words {
    statements(statement())
}

const BLANKS: [&str; 4] = [" ", "  ", "\t", "     "];
const INLINE: [&str; 3] = [" /* c */ ", " /**/", "   /* // */   "];
const FREE: [&str; 9] = [
    "\n",
    "\r\n  ",
    "\n\n\n",
    " // c\n",
    "  // c\n\n  ",
    "\n // own\n",
    "\n/* own */\n",
    " /* a\n   b */ ",
    "\n\n// x\n// y\n\n",
];

/// The text of a file, its gaps filled by `noise`.
pub(crate) fn text(words: &[Word], noise: &[u8]) -> String {
    let mut out = String::from("scene 1\n");
    let mut fillers = noise.iter().copied().cycle();
    for (gap, word) in words {
        let n = usize::from(fillers.next().unwrap_or(0));
        let joins = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '"' | '.' | '-' | '+');
        // `5 m^2` is a unit's power, `5 m ^ 2` a number's.
        let power = word == "^" && out.ends_with(|c: char| c.is_ascii_alphabetic());
        let merges = power || out.ends_with(joins) && word.starts_with(joins);
        let filler = match gap {
            Gap::Tight => "",
            Gap::Unit => ["", " ", "  "][n % 3],
            Gap::Blank => BLANKS[n % 4],
            Gap::End => ["\n", "\n\n", " // c\n", ";\n", "\n/* c */ ", ", // c\n"][n % 6],
            Gap::Field => [", ", "; ", "\n", " // c\n", ",\n\n", "\n// own\n", ", /* c */ "][n % 7],
            Gap::Line if n % 4 == 0 => INLINE[n / 4 % 3],
            Gap::Free if n % 4 == 0 => FREE[n / 4 % 9],
            Gap::Free if n % 8 == 1 => INLINE[n / 8 % 3],
            Gap::Free if n % 4 == 2 && !merges => "",
            Gap::Line | Gap::Free => BLANKS[n / 4 % 4],
        };
        out.push_str(filler);
        out.push_str(word);
    }
    out
}
