//! Plants mistakes in scenes without one, and counts how many are told in one run.
//!
//! A mistake is a change of a few bytes of a kind that people make, with the line where it must be
//! told and the code. Those of one run stand in different statements.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use luxel_lang::prescan::scan;

/// A small generator, so that every run plants the same (`SplitMix64`).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        usize::try_from((x ^ (x >> 31)) % n as u64).expect("below n")
    }
}

/// A change that is a mistake.
#[derive(Clone, Debug)]
pub(crate) struct Seed {
    pub(crate) kind: &'static str,
    start: usize,
    end: usize,
    new: String,
    /// Where it must be told, from 1.
    line: usize,
    codes: &'static [&'static str],
    /// The top-level statement in which it stands.
    statement: usize,
}

/// What was told of planted mistakes.
#[derive(Default)]
pub(crate) struct Score {
    /// By kind: told and planted.
    kinds: BTreeMap<&'static str, (usize, usize)>,
    /// Diagnostics, and those among them that belong to no planted mistake.
    told: usize,
    strangers: usize,
    /// The first misses and strangers, for whoever mends them.
    log: String,
}

impl Score {
    /// Plants up to `k` mistakes in a text and counts what a load tells: lines and codes.
    pub(crate) fn run(
        &mut self,
        text: &str,
        k: usize,
        dice: &mut Dice,
        load: impl Fn(&str) -> Vec<(usize, &'static str)>,
    ) {
        let seeds = chosen(seeds(text), k, dice);
        let mut wrong = text.to_owned();
        for seed in seeds.iter().rev() {
            wrong.replace_range(seed.start..seed.end, &seed.new);
        }
        let mut told = load(&wrong);
        self.told += told.len();
        let mut misses = vec![];
        for seed in &seeds {
            let (hits, all) = self.kinds.entry(seed.kind).or_default();
            *all += 1;
            let fits =
                |(line, code): &(usize, &str)| *line == seed.line && seed.codes.contains(code);
            match told.iter().position(fits) {
                Some(at) => {
                    told.remove(at);
                    *hits += 1;
                }
                None => misses.push(seed),
            }
        }
        self.strangers += told.len();
        if !(misses.is_empty() && told.is_empty()) && self.log.len() < 6000 {
            for miss in misses {
                let line = wrong.lines().nth(miss.line - 1).unwrap_or_default();
                let _ = writeln!(self.log, "missed {} {:?}: {line}", miss.kind, miss.codes);
            }
            for (line, code) in told {
                let text = wrong.lines().nth(line.max(1) - 1).unwrap_or_default();
                let _ = writeln!(self.log, "  stranger {code} {line}: {text}");
            }
        }
    }

    /// Told over planted, and strangers over all that was told.
    pub(crate) fn shares(&self) -> (f64, f64) {
        let (hits, all) = self.kinds.values().fold((0, 0), |(a, b), (c, d)| (a + c, b + d));
        (hits as f64 / all as f64, self.strangers as f64 / self.told as f64)
    }

    /// A table by kind.
    pub(crate) fn table(&self) -> String {
        let mut out = String::new();
        for (kind, (hits, all)) in &self.kinds {
            let _ = writeln!(out, "{kind:24} {hits:5} of {all}");
        }
        let (told, strange) = self.shares();
        let _ = writeln!(out, "told {:.2} %, strangers {:.2} %", 100.0 * told, 100.0 * strange);
        out + &self.log
    }
}

/// Up to `k` of the seeds, each in another statement, in the order of the text.
fn chosen(mut seeds: Vec<Seed>, k: usize, dice: &mut Dice) -> Vec<Seed> {
    let mut out: Vec<Seed> = vec![];
    while out.len() < k && !seeds.is_empty() {
        // A kind first, so that rare ones are planted as often as common ones.
        let mut kinds: Vec<_> = seeds.iter().map(|seed| seed.kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let kind = kinds[dice.below(kinds.len())];
        let of_kind: Vec<_> = seeds.iter().filter(|seed| seed.kind == kind).cloned().collect();
        let seed = of_kind[dice.below(of_kind.len())].clone();
        seeds.retain(|other| other.statement != seed.statement && other.line != seed.line);
        // A brace too few and one too many are none together.
        if let "unclosed brace" | "stray brace" = seed.kind {
            seeds.retain(|other| !["unclosed brace", "stray brace"].contains(&other.kind));
        }
        out.push(seed);
    }
    out.sort_by_key(|seed| seed.start);
    out
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Word,
    Number,
    Text,
    Mark,
}

#[derive(Clone, Copy, Debug)]
struct Token<'a> {
    kind: Kind,
    start: usize,
    text: &'a str,
}

impl Token<'_> {
    fn end(&self) -> usize {
        self.start + self.text.len()
    }
}

/// The tokens of a scene without a mistake, comments left out.
fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut out = vec![];
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let run = |legal: fn(char) -> bool| rest.find(|c| !legal(c)).unwrap_or(rest.len());
        let (kind, length) = match c {
            c if c.is_whitespace() => (None, c.len_utf8()),
            '/' if rest.starts_with("//") => (None, rest.find('\n').unwrap_or(rest.len())),
            '/' if rest.starts_with("/*") => (None, rest.find("*/").expect("it closes") + 2),
            '#' => (Some(Kind::Mark), rest.find(']').map_or(1, |end| end + 1)),
            'a'..='z' | 'A'..='Z' | '_' => {
                (Some(Kind::Word), run(|c| c.is_ascii_alphanumeric() || c == '_'))
            }
            '0'..='9' => {
                let digits = run(|c| c.is_ascii_digit() || c == '.');
                (Some(Kind::Number), rest.find("..").map_or(digits, |range| digits.min(range)))
            }
            '"' => (Some(Kind::Text), rest[1..].find('"').expect("it closes") + 2),
            _ => (Some(Kind::Mark), c.len_utf8()),
        };
        if let Some(kind) = kind {
            out.push(Token { kind, start: at, text: &rest[..length] });
        }
        at += length;
    }
    out
}

/// A word with a slip of the pen, if it is long enough for one.
fn misspelt(word: &str) -> Option<String> {
    let letters = word.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
    (word.len() >= 4 && letters).then(|| format!("{}{}", &word[..1], &word[2..]))
}

/// Everything that could be planted in a scene without a mistake.
fn seeds(text: &str) -> Vec<Seed> {
    let starts = scan(text, 0..text.len(), 0, 128).starts;
    let tokens = tokens(text);
    let mut out = Planter { text, tokens: &tokens, starts: &starts, out: vec![] };
    out.all();
    out.out
}

struct Planter<'a> {
    text: &'a str,
    tokens: &'a [Token<'a>],
    starts: &'a [usize],
    out: Vec<Seed>,
}

const CATEGORIES: [&str; 9] =
    ["shape", "material", "light", "texture", "medium", "camera", "film", "sampler", "integrator"];
const FUNCTIONS: [&str; 8] =
    ["rotate", "move", "scale", "look_at", "blackbody", "metal", "glass", "illuminant"];

impl Planter<'_> {
    fn at(&self, i: usize) -> &str {
        self.tokens.get(i).map_or("", |t| t.text)
    }

    fn is(&self, i: usize, kind: Kind) -> bool {
        self.tokens.get(i).is_some_and(|t| t.kind == kind)
    }

    /// Plants at a range, told on the line of its first byte.
    fn put(
        &mut self,
        kind: &'static str,
        range: std::ops::Range<usize>,
        new: impl Into<String>,
        codes: &'static [&'static str],
    ) {
        let line = self.text[..range.start].matches('\n').count() + 1;
        let statement = self.starts.iter().take_while(|start| **start <= range.start).count();
        // The first statement is `scene 1`; what is off is not looked at.
        let off = |start: &usize| self.text[*start..].starts_with("@off");
        if statement > 1 && !off(&self.starts[statement - 1]) {
            let (start, end, new) = (range.start, range.end, new.into());
            self.out.push(Seed { kind, start, end, new, line, codes, statement });
        }
    }

    fn all(&mut self) {
        let mut braces: Vec<usize> = vec![];
        let mut defined: Vec<&str> = vec![];
        for i in 0..self.tokens.len() {
            let token = self.tokens[i];
            match token.text {
                "{" => braces.push(i),
                "}" => {
                    let open = braces.pop().expect("the scene has no mistake");
                    self.close(i, self.tokens[open]);
                }
                "let" | "param" => {
                    defined.push(self.tokens[i + 1].text);
                    self.definition(i, braces.is_empty());
                }
                _ => {}
            }
            let in_object = braces.last().is_some_and(|open| self.is_object(*open));
            let begins = matches!(self.at(i.wrapping_sub(1)), "{" | ",")
                || self.text[..token.start].trim_end_matches(' ').ends_with('\n');
            if token.kind == Kind::Word && self.at(i + 1) == "=" && self.at(i + 2) != "=" {
                if in_object && begins {
                    self.field(i);
                }
            } else if token.kind == Kind::Word {
                self.word(i, &defined);
            }
            self.brackets(i);
        }
    }

    /// Whether a brace opens the body of an object.
    fn is_object(&self, open: usize) -> bool {
        let head = open - usize::from(self.is(open - 1, Kind::Text));
        (CATEGORIES.contains(&self.at(head - 1)) || CATEGORIES.contains(&self.at(head - 2)))
            && self.is(head - 1, Kind::Word)
    }

    fn definition(&mut self, i: usize, is_outer: bool) {
        let (word, name) = (self.tokens[i], self.tokens[i + 1]);
        let new = if word.text == "let" { "lte" } else { "parm" };
        self.put("misspelt keyword", word.start..word.end(), new, &["E0023"]);
        let rest = &self.text[word.start..];
        let line = rest.find('\n').unwrap_or(rest.len());
        let whole = is_outer && self.starts.iter().any(|start| *start == word.start + line + 1);
        if whole && !rest[..line].contains("//") {
            let end = word.start + line;
            let again = format!("; let {} = 1", name.text);
            self.put("doubled definition", end..end, again, &["E0103"]);
        }
        if self.tokens.iter().filter(|token| token.text == name.text).count() == 1 {
            self.put("reserved name", name.start..name.end(), "for", &["E0019"]);
        }
    }

    fn field(&mut self, i: usize) {
        let (name, eq, value) = (self.tokens[i], self.tokens[i + 1], self.tokens[i + 2]);
        if let Some(new) = misspelt(name.text) {
            self.put("misspelt parameter", name.start..name.end(), new, &["E0402"]);
        }
        self.put("missing =", eq.start..value.start, "", &["E0012"]);
        self.put("doubled =", eq.end()..eq.end(), "=", &["E0013"]);
        self.put("= = in a row", eq.end()..eq.end(), " =", &["E0013"]);
        self.put("colon for =", eq.start..eq.end(), ":", &["E0017"]);
        let unit = Some(self.tokens[i + 3]).filter(|t| t.kind == Kind::Word);
        let unit = unit.filter(|t| !self.text[value.end()..t.start].contains('\n'));
        let last = unit.unwrap_or(value);
        let after = self.text[last.end()..].trim_start_matches(' ');
        if value.kind != Kind::Number || !after.starts_with([',', '\n', '}', ';']) {
            return;
        }
        let (number, all) = (value.start..value.end(), value.start..last.end());
        let again =
            format!("{}, {} = {}", &self.text[all.clone()], name.text, &self.text[all.clone()]);
        self.put("given twice", all.clone(), again, &["E0404"]);
        self.put("text for a number", all.clone(), "\"big\"", &["E0214"]);
        self.put("malformed number", number, "1.2.3", &["E0016"]);
        self.put("missing operand", last.end()..last.end(), " +", &["E0015"]);
        if name.text == "radius" {
            self.put("out of range", value.start..value.start, "-", &["E0405"]);
        }
        let Some(unit) = unit else { return };
        let has_units = self.tokens.iter().any(|t| t.text == "units");
        if !has_units && unit.text != "EV" {
            self.put("missing unit", value.end()..unit.end(), "", &["E0201"]);
        }
        let is_plain = |c: char| c == '\n' || c == ',' || c == ' ' || c == '}';
        if self.text[unit.end()..].starts_with(is_plain) && unit.text != "s" {
            self.put("wrong unit", unit.start..unit.end(), "s", &["E0202", "E0213"]);
            let new = format!("{}q", unit.text);
            self.put("unknown unit", unit.start..unit.end(), new, &["E0204"]);
        }
    }

    fn word(&mut self, i: usize, defined: &[&str]) {
        let token = self.tokens[i];
        let place = token.start..token.end();
        let Some(new) = misspelt(token.text) else { return };
        let called = self.at(i + 1) == "(";
        let (before, after) = (self.at(i.wrapping_sub(1)), self.tokens.get(i + 2).map(|t| t.text));
        if FUNCTIONS.contains(&token.text) && called {
            self.put("unknown function", place, new, &["E0101"]);
        } else if CATEGORIES.contains(&token.text) && self.is(i + 1, Kind::Word) {
            self.put("unknown category", place, new, &["E0401"]);
        } else if CATEGORIES.contains(&before) && (self.at(i + 1) == "{" || after == Some("{")) {
            self.put("unknown kind", place, new, &["E0401"]);
        } else if defined.contains(&token.text)
            && before != "."
            && before != "let"
            && before != "param"
            && !matches!(self.at(i + 1), ":" | "=")
        {
            self.put("unknown name", place, new, &["E0101"]);
        }
    }

    fn brackets(&mut self, i: usize) {
        let token = self.tokens[i];
        let tokens = self.tokens;
        let number = |i: usize| tokens.get(i).is_some_and(|t| t.kind == Kind::Number);
        if token.text == "(" && number(i + 1) && self.at(i + 2) == "," && number(i + 3) {
            let comma = self.tokens[i + 2];
            self.put("missing comma", comma.start..comma.end(), "", &["E0014"]);
            if self.at(i + 6) == ")" && number(i + 5) && self.at(i - 1) != "linear_srgb" {
                let close = self.tokens[i + 6];
                self.put("bracket of another kind", close.start..close.end(), "]", &["E0009"]);
            }
        }
        let ends_line = self.text[token.end()..].starts_with('\n');
        if token.kind == Kind::Text && ends_line {
            self.put("unclosed string", token.end() - 1..token.end(), "", &["E0005"]);
        }
    }

    /// A brace that closes.
    fn close(&mut self, i: usize, open: Token<'_>) {
        let token = self.tokens[i];
        let ends_line = self.text[token.end()..].starts_with('\n');
        let begins_line = self.text[..token.start].ends_with('\n');
        if token.text == "}" && begins_line && ends_line {
            self.put("stray brace", token.end()..token.end(), " }", &["E0010"]);
            // Told at the brace that it closes.
            self.put("unclosed brace", token.start..token.end(), "", &["E0008"]);
            let line = self.text[..open.start].matches('\n').count() + 1;
            if let Some(seed) = self.out.last_mut().filter(|seed| seed.kind == "unclosed brace") {
                seed.line = line;
            }
        }
    }
}
