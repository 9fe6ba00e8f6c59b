//! Names that nothing defines, or that are used too early: what is said of them.

use std::collections::BTreeSet;

use luxel_core::diag::{Diagnostic, Grade, Near, Span, near};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Unit;

use super::resolve::{Resolver, Scope, follows_fn};
use super::{DEFINED, builtins};
use crate::syntax::{Expr, ExprNode, Name, Op, path_around};
use crate::words::OF_A_TEXT;

/// Known names among which near ones are looked for: more than `near` looks at, names that are known
/// twice counted.
const LOOKED_AT: usize = 30_000;

/// Bytes behind a name that are looked at for the end of its call.
const CALL: usize = 1 << 10;
/// Bytes of a unit in brackets.
const UNIT: usize = 64;
/// Bytes of a function's name that may have lost its bracket.
const FUNCTION: usize = 64;

/// What other languages call a vector.
const VECTORS: [&str; 11] = [
    "vec", "vec2", "vec3", "vec4", "vector", "vector3", "float3", "point", "point3", "dvec3",
    "xyz3",
];

/// What other languages call functions, and ours.
const FUNCTIONS: [(&str, &str); 6] = [
    ("translate", "move"),
    ("translation", "move"),
    ("rotation", "rotate"),
    ("lookat", "look_at"),
    ("norm", "length"),
    ("magnitude", "length"),
];

/// The axes about which other languages turn by functions of their own.
const TURNS: [(char, &str); 3] = [('x', "(1, 0, 0)"), ('y', "(0, 1, 0)"), ('z', "(0, 0, 1)")];

/// Functions of other languages for which there is none here.
const ABSENT: [&str; 4] = ["print", "printf", "append", "input"];

impl Resolver<'_> {
    /// Whether an argument is a text without its quotes, which is told: `metal(Au)`.
    pub(super) fn is_unquoted(&mut self, function: &str, value: &Expr) -> bool {
        let text = self.text.get(value.span.range()).unwrap_or("");
        let is_name = |expr: &Expr| match &expr.node {
            ExprNode::Path(path) => path.len() == 1 && self.is_unknown(&path[0]),
            _ => false,
        };
        // `N-BK7`
        let is_text = match &value.node {
            ExprNode::Chain { first, rest } => {
                is_name(first) && rest.iter().all(|(op, _, expr)| *op == Op::Sub && is_name(expr))
            }
            _ => is_name(value),
        };
        if !OF_A_TEXT.contains(&function) || !is_text || self.free.is_some() {
            return false;
        }
        let message = format!("there is no `{text}`");
        let found = Diagnostic::error("E0101", value.span, message)
            .help("text is written in quotes: \"…\"")
            .guess(value.span, format!("\"{text}\""));
        self.sink.push(found);
        true
    }

    /// A name that is defined later in a block around the place.
    pub(super) fn later(&self, name: &Name) -> Option<Diagnostic> {
        let scope = self.scopes.iter().rev().find(|s| s.later.contains_key(&name.text))?;
        let place = scope.later.get(&name.text)?;
        if let Some(cycle) = self.functions.iter().find_map(|f| circle(scope, f, name)) {
            let message = format!("a function may not call itself: {}", cycle.join(" → "));
            let found = Diagnostic::error("E0105", name.span, message);
            return Some(
                found
                    .label(*place, DEFINED)
                    .help("use a loop over a range; a function sees only what stands before it"),
            );
        }
        let message = format!("`{}` is used before it is defined", name.text);
        let found = Diagnostic::error("E0102", name.span, message);
        Some(found.label(*place, DEFINED))
    }

    pub(super) fn unknown(&self, name: &Name, joined: &str, span: Span) -> Diagnostic {
        if let Some(label) = self.scopes.iter().rev().find_map(|s| s.labels.get(&name.text)) {
            let text = &name.text;
            let message = format!("`{text}` is a label, and labels name nothing but for `set`");
            return Diagnostic::error("E0101", name.span, message).label(*label, "the label").help(
                format!(
                    "give the object a name, `let {text} = …`; what stands somewhere is put where it \
                     stood, and anywhere else, by `place {text}`"
                ),
            );
        }
        if let Some(found) = self.written_otherwise(name) {
            return found;
        }
        if let Some(path) = path_around(self.text, name.span.range().start) {
            let (text, source) = (&self.text[path.clone()], name.span.source);
            let place = Span::new(source, path.start, path.end);
            let found = Diagnostic::error("E0101", place, format!("there is no `{text}`"));
            let found = found.help("the path of a file stands in quotes");
            return found.guess(place, format!("\"{text}\""));
        }
        let dotted = builtins::names()
            .any(|known| known.split_once('.').is_some_and(|(space, _)| space == &*name.text));
        let (shown, place) = if dotted { (joined, span) } else { (&*name.text, name.span) };
        let mut found = Diagnostic::error("E0101", place, format!("there is no `{shown}`"));
        let meant = self.meant(shown, place).filter(|meant| meant.name != shown);
        let member = meant.is_none().then(|| member_of_function(name, joined, span)).flatten();
        if let Some(found) = member {
            return found;
        }
        if let Some(number) = self.stop(place) {
            found = found.help("an f-number is written without `f/`").guess(number, "");
        } else if Unit::named(shown).is_some() {
            found = found.help("a unit stands in one piece behind its number: `3 W/m^2/sr`");
        } else if shown == "group" {
            found = found.help("a group is written `group { … }`");
        } else if let Some(before) = self.before_call(place) {
            found = found.help(format!("no `{shown}` stands before a call")).guess(before, "");
        } else if Kind::of_word(shown).is_some() {
            found = found.help(format!("an object is written `{shown} NAME {{ … }}`"));
        } else if shown == "rgba" {
            found = found.help("a colour is written `rgb.srgb(1, 0.5, 0)`, and has no alpha");
        } else if shown == "not" {
            found = found.help("`not` is written `!`").guess(place, "!");
        } else if let Some(call) = self.call_without_bracket(shown, place) {
            found = found.help("the bracket of a call stands behind the function's name");
            found = found.guess(call, "(");
        } else if meant.is_some() {
            found = found.meant(place, meant);
        } else {
            found = self.of_elsewhere(found, name, shown, place);
        }
        found
    }

    /// With what a word of other languages, or one at a place of theirs, is here.
    fn of_elsewhere(&self, found: Diagnostic, name: &Name, shown: &str, place: Span) -> Diagnostic {
        if VECTORS.contains(&&*shown.to_lowercase()) {
            let found = found.help("a vector is written without a word: `(0, 1, 0)`");
            if self.is_called(place) { found.fix(place, "") } else { found }
        } else if self.is_placed(name) {
            found.help(
                "`place` puts what has a name; an object by itself is written `shape NAME { … }`",
            )
        } else if shown == "range" {
            let found = found.help("a range is written `0..10`: from 0 up to, but not, 10");
            match self.range(place) {
                Some((call, range)) => found.guess(call, range),
                None => found,
            }
        } else if self.is_called(place) {
            found.help(format!(
                "a function comes from `fn` or `import`; an object is written with its kind, as \
                 `shape {shown} {{ … }}` or `material {shown} {{ … }}`"
            ))
        } else {
            found.help(
                "names come from `let`, `param`, `fn`, `for` and `import`, not from `include`; text is \
                 written in quotes: \"…\"",
            )
        }
    }

    /// The call `range(0, 10)`, and how it is written here.
    fn range(&self, name: Span) -> Option<(Span, String)> {
        let inner = self.text.get(name.range().end..)?.strip_prefix('(')?.split(')').next()?;
        let is_plain = |bound: &&str| {
            let is_of_it = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
            !bound.is_empty() && bound.chars().all(is_of_it)
        };
        let bounds: Vec<&str> = inner.split(',').map(str::trim).collect();
        let range = match &bounds[..] {
            _ if !bounds.iter().all(is_plain) => return None,
            [end] => format!("0..{end}"),
            [start, end] => format!("{start}..{end}"),
            _ => return None,
        };
        // Its two brackets.
        let end = name.range().end + inner.len() + 2;
        Some((Span::new(name.source, name.range().start, end), range))
    }

    /// Whether the name is called.
    fn is_called(&self, name: Span) -> bool {
        self.text.get(name.range().end..).is_some_and(|rest| rest.starts_with('('))
    }

    /// A category before a call, with the blanks behind it: `material paint(0.5)`.
    fn before_call(&self, category: Span) -> Option<Span> {
        let (start, end) = (category.range().start, category.range().end);
        Kind::of_word(self.text.get(start..end)?)?;
        let rest = self.text.get(end..)?;
        let call = rest.trim_start_matches([' ', '\t']);
        let behind = call.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
        let is_call = behind.len() < call.len() && behind.starts_with('(');
        is_call.then(|| Span::new(category.source, start, end + rest.len() - call.len()))
    }

    /// Whether a name stands behind `place`.
    fn is_placed(&self, name: &Name) -> bool {
        let before = self.text.get(..name.span.range().start).map(str::trim_end);
        let rest = before.and_then(|before| before.strip_suffix("place"));
        rest.is_some_and(|rest| !rest.ends_with(|c: char| c.is_alphanumeric() || c == '_'))
    }

    /// A unit by which a number is multiplied: `50 * cm`.
    fn product(&self, name: &Name) -> Option<Diagnostic> {
        let unit = Unit::named(&name.text).map(|_| name.span)?;
        let (before, rest) = self.text.split_at_checked(unit.range().start)?;
        let number = before.trim_end_matches(' ').strip_suffix('*')?.trim_end_matches(' ');
        let digits = number.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
        // `2^3 * cm` and `x / 2 * cm` are something else with the unit behind the number.
        let begins = !digits.trim_end_matches(' ').ends_with(['^', '/'])
            && !digits.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
        let is_number = digits.len() < number.len() && begins;
        // `50 * cm^2` and `50 * cm / s` go on.
        let behind = rest.get(unit.range().len()..)?.trim_start_matches(' ');
        let is_whole = !behind.starts_with(['^', '/', '*', '.', '(', '[']);
        let all = Span::new(unit.source, number.len(), unit.range().end);
        let found = Diagnostic::error("E0101", unit, format!("there is no `{}`", name.text));
        let found = found.help("a unit stands behind its number");
        (is_number && is_whole).then(|| found.guess(all, format!(" {}", name.text)))
    }

    /// A power, a turn or a unit as other languages write them.
    fn written_otherwise(&self, name: &Name) -> Option<Diagnostic> {
        let of_unit = || self.product(name).or_else(|| self.grouped_unit(name));
        self.power(name.span).or_else(|| self.turn(name)).or_else(of_unit)
    }

    /// A unit whose parts stand in brackets: `15 W/(m^2*sr)`.
    fn grouped_unit(&self, name: &Name) -> Option<Diagnostic> {
        let start = name.span.range().start;
        let before = self.text.get(..start)?.strip_suffix("/(")?;
        let digits = before.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        Unit::named(&before[digits.len()..])?;
        let rest = self.text.get(start..)?;
        let inner = &rest[..rest.bytes().take(UNIT).position(|byte| byte == b')')?];
        let parts: Vec<_> = inner.split('*').map(str::trim).collect();
        if !parts.iter().all(|part| Unit::parse(part).is_ok()) {
            return None;
        }
        let all = Span::new(name.span.source, start - 2, start + inner.len() + 1);
        let found = Diagnostic::error("E0204", all, "a unit has no brackets");
        Some(found.fix(all, format!("/{}", parts.join("/"))))
    }

    /// A turn whose name says its axis: `rotate_y(20 deg)`.
    fn turn(&self, name: &Name) -> Option<Diagnostic> {
        let axis = TURNS.into_iter().find_map(|(letter, axis)| {
            let word = name.text.strip_suffix([letter, letter.to_ascii_uppercase()])?;
            matches!(word.trim_end_matches('_'), "rotate" | "rot").then_some(axis)
        })?;
        let (start, end) = (name.span.range().start, name.span.range().end);
        let is_called = self.text.get(end..).is_some_and(|rest| rest.starts_with('('));
        let found = Diagnostic::error("E0101", name.span, format!("there is no `{}`", name.text));
        let found = found.help("a turn says about which axis: `rotate((0, 1, 0), 20 deg)`");
        let head = Span::new(name.span.source, start, end + 1);
        is_called.then(|| found.guess(head, format!("rotate({axis}, ")))
    }

    /// A name in what was to be a unit with a power.
    fn power(&self, name: Span) -> Option<Diagnostic> {
        let found = |all: Span| {
            let text = self.text.get(all.range()).unwrap_or_default();
            Diagnostic::error("E0204", all, format!("there is no unit `{text}`"))
        };
        if let Some((all, mended)) = self.unit_without_powers(name) {
            return Some(found(all).help("powers are written with `^`").fix(all, mended));
        }
        let (all, mended) = self.per_unit(name)?;
        Some(found(all).help("one over a unit is written with a power").guess(all, mended))
    }

    /// Where the bracket of a call is missing whose other one is there: `min2, 3)`.
    fn call_without_bracket(&self, shown: &str, place: Span) -> Option<Span> {
        let rest = self.text.as_bytes().get(place.range().end..)?;
        let mut line = rest.iter().take(CALL).take_while(|byte| **byte != b'\n');
        let mut depth = 0_i32;
        let is_closed = line.any(|byte| {
            depth += i32::from(b"([{".contains(byte)) - i32::from(b")]}".contains(byte));
            depth < 0 && *byte == b')'
        });
        let is_function = |name: &str| {
            let ours = self.scopes.iter().rev().find_map(|scope| scope.names.get(name));
            ours.is_some_and(|at| at.source == place.source && follows_fn(self.text, *at))
                || self.around.is_some_and(|(around, i)| around.has_function_before(i, name))
                || builtins::names().any(|known| known == name) && !builtins::is_value(name)
        };
        let mut ends = (1..shown.len().min(FUNCTION)).rev().filter(|_| is_closed);
        let end = ends.find(|end| shown.get(..*end).is_some_and(is_function))?;
        let at = place.range().start + end;
        Some(Span::new(place.source, at, at))
    }

    /// The name that an unknown one most likely stands for.
    fn meant(&self, shown: &str, place: Span) -> Option<Near<'_>> {
        let theirs = FUNCTIONS.iter().find(|(theirs, _)| *theirs == shown);
        if let Some((_, name)) = theirs {
            return Some(Near { name, grade: Grade::Guess });
        }
        if ABSENT.contains(&shown) {
            return None;
        }
        // What a function is called by names no value.
        let rest = self.text.get(place.range().end..).unwrap_or_default();
        let is_called = rest.trim_start_matches([' ', '\t']).starts_with('(');
        let builtins = || builtins::names().filter(|name| is_called || builtins::is_value(name));
        let mut known: Vec<&str> = builtins().chain(["true", "false"]).collect();
        known.extend(self.scopes.iter().flat_map(|scope| scope.names.keys()).map(|name| &**name));
        known.extend(self.around.into_iter().flat_map(|(around, i)| around.before(i)));
        // Which are looked at must not depend on the order in which a table holds them.
        if known.len() > LOOKED_AT {
            known.select_nth_unstable(LOOKED_AT);
            known.truncate(LOOKED_AT);
        }
        known.sort_unstable();
        // `srgb` is nearer to `rgb.srgb`, which ends so, than to `rgb`.
        let ending = builtins::names()
            .find(|known| known.split_once('.').is_some_and(|(_, ending)| ending == shown));
        // A picture may be meant by `file` as well as a spectrum.
        let grade = if shown == "file" { Grade::Guess } else { Grade::Sure };
        let ending = ending.map(|name| Near { name, grade });
        let alike = || known.iter().copied().find(|known| known.eq_ignore_ascii_case(shown));
        let alike = || alike().map(|name| Near { name, grade: Grade::Guess });
        let near = near(shown, known.iter().copied());
        // `Sin` is `sin`, and as near to `min`.
        let is_other = near.is_none_or(|near| !near.name.eq_ignore_ascii_case(shown));
        ending.or_else(|| alike().filter(|_| is_other)).or(near)
    }

    /// `0.2/m` and `0.2 /m^2`: the unit that divides a number, and how it is written.
    fn per_unit(&self, name: Span) -> Option<(Span, String)> {
        let (before, rest) = self.text.split_at_checked(name.range().start)?;
        let unit = rest.get(..name.range().len()).filter(|word| Unit::named(word).is_some())?;
        let number = before.trim_end_matches(' ').strip_suffix('/')?.trim_end_matches(' ');
        let power = rest[unit.len()..]
            .strip_prefix('^')
            .map_or("", |rest| &rest[..rest.bytes().take_while(u8::is_ascii_digit).count()]);
        let behind = unit.len() + if power.is_empty() { 0 } else { 1 + power.len() };
        let is_whole = !rest[behind..].starts_with(['^', '/', '.', '(', '[']);
        let sign = number.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
        let is_number = sign.len() < number.len();
        if !is_whole || !is_number || !sign.trim_end().ends_with(['=', '(', '[', ',']) {
            return None;
        }
        let all = Span::new(name.source, number.len(), name.range().start + behind);
        let power = if power.is_empty() { "1" } else { power };
        Some((all, format!(" {unit}^-{power}")))
    }

    /// What is too much of `f/2.8`.
    fn stop(&self, name: Span) -> Option<Span> {
        let rest = self.text.get(name.range().start..)?;
        let number = rest.strip_prefix("f/")?.trim_start_matches(' ');
        let gap = rest.len() - number.len();
        let is_number = number.starts_with(|c: char| c.is_ascii_digit());
        is_number.then(|| Span::new(name.source, name.range().start, name.range().start + gap))
    }

    /// The unit behind a number of which a name is a part, and how it is written: `W/m2/sr`.
    fn unit_without_powers(&self, name: Span) -> Option<(Span, String)> {
        let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'/';
        let (bytes, at) = (self.text.as_bytes(), name.range());
        let n_before = bytes.get(..at.start)?.iter().rev().take_while(|b| is_part(b)).count();
        let n_behind = bytes.get(at.end..)?.iter().take_while(|b| is_part(b)).count();
        let (start, end) = (at.start - n_before, at.end + n_behind);
        let number = self.text.get(..start)?.trim_end_matches(' ').bytes().next_back()?;
        if !number.is_ascii_digit() && !matches!(number, b')' | b']' | b'.') {
            return None;
        }
        let with_power = |part: &str| {
            let letters = part.trim_end_matches(|c: char| c.is_ascii_digit());
            let power = &part[letters.len()..];
            if power.is_empty() { letters.to_owned() } else { format!("{letters}^{power}") }
        };
        let parts: Vec<String> = self.text.get(start..end)?.split('/').map(with_power).collect();
        let mended = parts.join("/");
        let is_it = mended.len() > end - start && Unit::parse(&mended).is_ok();
        is_it.then(|| (Span::new(name.source, start, end), mended))
    }
}

/// `metal.Au`
fn member_of_function(name: &Name, joined: &str, span: Span) -> Option<Diagnostic> {
    let member = joined.strip_prefix(&*name.text)?.strip_prefix('.')?;
    builtins::value(&name.text)?;
    let found = Diagnostic::error("E0101", span, format!("there is no `{joined}`"));
    if builtins::value(member).is_some() {
        return Some(found.meant(span, Some(Near { name: member, grade: Grade::Guess })));
    }
    let found = found.help(format!("`{}` is a function", name.text));
    let is_named = OF_A_TEXT.contains(&&*name.text);
    Some(if is_named { found.guess(span, format!("{}(\"{member}\")", name.text)) } else { found })
}

/// The chain of functions from `from` over `name` back to `from`, if there is one.
fn circle(scope: &Scope, from: &Name, name: &Name) -> Option<Vec<String>> {
    let mut seen = BTreeSet::new();
    let mut open = vec![vec![name.text.clone()]];
    while let Some(chain) = open.pop() {
        let last = chain.last()?;
        if *last == from.text {
            let start = format!("`{}`", from.text);
            return Some(
                std::iter::once(start).chain(chain.iter().map(|n| format!("`{n}`"))).collect(),
            );
        }
        if seen.insert(last.clone()) {
            let next = scope.mentions.get(last).into_iter().flatten();
            open.extend(next.filter(|n| scope.mentions.contains_key(*n)).map(|n| {
                let mut longer = chain.clone();
                longer.push(n.clone());
                longer
            }));
        }
    }
    None
}
