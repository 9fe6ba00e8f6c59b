//! Mistakes of which the cause is told already, or of which another says more.

mod blocks;
mod calls;
mod closed;
mod files;
mod lines;
mod names;
mod nearby;
mod pairs;
mod uses;

use std::collections::BTreeSet;

use luxel_core::diag::{Diagnostic, Sources, Span};
use luxel_sdk::kind::Kind;

use crate::syntax::{EARLY, ONE_WORD};
use crate::words::BEFORE_NAMES;

/// Bytes before a place that are looked at: of a line before a bracket that closes nothing, and of a call.
const LOOKED_AT: usize = 1 << 10;

/// Takes out what is said only because of something else that is told.
pub(crate) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    blocks::sift(diagnostics, sources);
    unread(diagnostics, sources);
    names::sift(diagnostics, sources);
    pairs::sift(diagnostics, sources);
    nearby::sift(diagnostics, sources);
    lines::sift(diagnostics, sources);
    calls::sift(diagnostics);
    closed::sift(diagnostics, sources);
    uses::sift(diagnostics, sources);
}

/// Takes out what is said of the value of an expression in which something cannot be read, as of a call that
/// lacks what stands behind a missing bracket; of names that nothing stands for, where a definition lacks its
/// own; and of two mistakes of one place the one that says less.
fn unread(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let is_cause = |found: &&Diagnostic| found.is_error() && found.code.starts_with("E00");
    let causes = diagnostics.iter().filter(is_cause);
    let of = |found: &Diagnostic| {
        let mended = found.fixes.iter().map(|fix| fix.span);
        found.span().into_iter().chain(mended).collect::<Vec<Span>>()
    };
    let doubts: Vec<Span> = causes.clone().filter_map(|found| in_doubt(found, sources)).collect();
    let joined: Vec<Span> = causes.clone().filter_map(|found| joined(found, sources)).collect();
    let bodies: Vec<Span> = causes.clone().filter_map(|found| body(found, sources)).collect();
    let is_unended = causes.clone().any(|found| found.code == "E0005");
    let is_nameless = causes.clone().any(|found| lacks_name(found, sources));
    let files = files::unread(diagnostics, sources);
    let has_others = diagnostics.iter().any(|found| found.is_error() && found.code != "E0109");
    let is_one_name = is_nameless && n_unknown(diagnostics, sources) == 1;
    let mut causes: Vec<Span> = causes.flat_map(of).collect();
    causes.sort_unstable();
    // Of a word without quotes it is said what it may be, which says more than that it is no name; and of a
    // brace that it is one too many, which says more than that it is not expected. A name that is defined
    // later is no word.
    let (words, braces) = (places(diagnostics, "E0416"), places(diagnostics, "E0008"));
    let early = places(diagnostics, "E0102");
    let (unknown, parted) = (places(diagnostics, "E0101"), places(diagnostics, "E0014"));
    let groups = groups(diagnostics);
    diagnostics.retain(|found| {
        let has_cause =
            |places: &BTreeSet<Span>| found.span().is_some_and(|at| places.contains(&at));
        let says_less = match found.code {
            "E0101" => {
                let is_nobody = is_one_name || is_nameless && found.sure().is_none();
                let name = found.span().and_then(|at| sources.text(at.source).get(at.range()));
                is_nobody
                    || name.is_some_and(|name| files.words.contains(name))
                    || has_cause(&words)
                    || is_category_behind(found, &braces, sources)
            }
            // A text that does not end may be a label, and a file that is not read may bear it.
            "E0109" => is_unended || files.hides_labels || has_others && is_label(found, sources),
            "E0023" => has_cause(&braces),
            "E0416" => has_cause(&early),
            // What may stand there twice, or lack a comma.
            "E0402" => found.fixes.is_empty() && stands_behind(found, &parted, sources),
            "E0403" => {
                doubts.iter().chain(&joined).any(|doubt| is_given_in(found, *doubt, sources))
            }
            "E0026" | "E0401" => {
                follows_category(found, &unknown, sources)
                    || found.code == "E0026" && stands_in(found, &groups, sources)
            }
            _ => false,
        };
        if says_less {
            return false;
        }
        let is_of_value = found.code.starts_with("E02") || found.code.starts_with("E04");
        let span = found.span().filter(|_| found.is_error());
        let is_doubtful = is_of_value || matches!(found.code, "E0113" | "E0114");
        let lies_in = |span: Span, doubt: &Span| {
            doubt.source == span.source && doubt.start <= span.start && span.end <= doubt.end
        };
        !span.is_some_and(|span| {
            is_of_value && holds_one(span, &causes)
                || is_doubtful && doubts.iter().any(|doubt| lies_in(span, doubt))
                || found.code == "E0113" && bodies.iter().any(|body| lies_in(span, body))
        })
    });
}

/// Where it is not known which values stand in which brackets: between one and another that closes it, on the
/// line before one that closes nothing, and below one that ends what goes on.
fn in_doubt(found: &Diagnostic, sources: &Sources) -> Option<Span> {
    let at = found.span()?;
    match found.code {
        "E0009" => {
            let text = sources.text(at.source).as_bytes();
            // What closes where a line ends is followed by what is known.
            let ends_line = |gap: &Span| {
                let rest = text.get(gap.range().end..at.range().start).unwrap_or_default();
                let line = rest.split(|byte| *byte == b'\n').next().unwrap_or_default();
                let is_blank = line.trim_ascii().is_empty() || line.trim_ascii().starts_with(b"//");
                gap.start == gap.end && is_blank && line.len() < rest.len()
            };
            let end = found.fixes.iter().map(|fix| fix.span).find(ends_line).unwrap_or(at);
            found.labels.get(1).map(|open| open.span.to(end))
        }
        "E0008" if sources.text(at.source).get(at.range()) != Some("{") => {
            Some(statement_from(at, sources))
        }
        "E0010" if found.message == EARLY => Some(going_on(at, sources)),
        "E0010" => Some(Span::new(at.source, line_of(at, sources), at.range().end)),
        _ => None,
    }
}

/// What stands in and below the statement of a bracket that never closes: what is indented further, or closes.
fn statement_from(bracket: Span, sources: &Sources) -> Span {
    let closes = |line: &[u8]| b")]}".iter().any(|it| line.trim_ascii().starts_with(&[*it]));
    lines_from(bracket, sources, &|deeper, line| deeper > 0 || deeper == 0 && closes(line))
}

/// What goes on below a brace, up to a line that begins with another and is not indented as far.
fn going_on(brace: Span, sources: &Sources) -> Span {
    lines_from(brace, sources, &|deeper, line| deeper >= 0 || !line.trim_ascii().starts_with(b"}"))
}

/// From a bracket on, the rest of its line and those below it as long as they belong to it, by how much deeper
/// than its own they are indented.
fn lines_from(bracket: Span, sources: &Sources, is_of_it: &dyn Fn(isize, &[u8]) -> bool) -> Span {
    let (text, start) = (sources.text(bracket.source).as_bytes(), bracket.range().start);
    let indent = |line: &[u8]| line.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    let own = indent(text.get(line_of(bracket, sources)..).unwrap_or_default());
    let below = text.get(start..).unwrap_or_default();
    let below = &below[..below.len().min(LOOKED_AT)];
    let is_within = |line: &&[u8]| is_of_it(indent(line).cast_signed() - own.cast_signed(), line);
    let mut lines = below.split_inclusive(|byte| *byte == b'\n');
    let n = lines.next().map_or(0, <[u8]>::len);
    let n = lines.take_while(is_within).fold(n, |n, line| n + line.len());
    Span::new(bracket.source, start, start + n)
}

/// Whether an object is said to lack what stands in brackets in it that another one closes, or that nothing opens.
fn is_given_in(found: &Diagnostic, doubt: Span, sources: &Sources) -> bool {
    let Some(at) = found.span().filter(|at| at.source == doubt.source) else { return false };
    let text = sources.text(at.source);
    let (head, within) = (text.get(at.range().end..doubt.range().start), text.get(doubt.range()));
    let (Some(head), Some(within)) = (head.filter(|head| head.len() <= LOOKED_AT), within) else {
        return false;
    };
    let mut names = found.message.split('`').skip(1).step_by(2);
    let is_given = |name: &str| {
        let mut places = memchr::memmem::find_iter(within.as_bytes(), name);
        let is_set = |rest: &str| rest.trim_start().starts_with('=');
        places.any(|i| within.get(i + name.len()..).is_some_and(is_set))
    };
    leaves_brace(head) && names.any(is_given)
}

/// From a name of two words to where its value may begin: the second may be a name by itself. And what stands on
/// its line behind a value that is missing: `radius = ,3 height = 1 m`.
fn joined(found: &Diagnostic, sources: &Sources) -> Option<Span> {
    let at = found.span()?;
    let rest = sources.text(at.source).get(at.range().end..)?;
    if found.code == "E0015" {
        let line = rest.bytes().take(LOOKED_AT).take_while(|byte| *byte != b'\n').count();
        return Some(Span::new(at.source, at.range().end, at.range().end + line));
    }
    if found.code != "E0023" || found.message != ONE_WORD {
        return None;
    }
    let value = rest.find(|c: char| c != ' ').filter(|equals| rest[*equals..].starts_with('='))?;
    Some(Span::new(at.source, at.range().start, at.range().end + value + 1))
}

/// Whether the first brace that opens in a text is still open at its end.
fn leaves_brace(text: &str) -> bool {
    let mut depth = 0_i32;
    let is_inside = text.bytes().skip_while(|byte| *byte != b'{').all(|byte| {
        depth += i32::from(byte == b'{') - i32::from(byte == b'}');
        depth > 0
    });
    is_inside && depth > 0
}

/// The lines before a brace that closes nothing that are indented further than it: an object whose own brace is
/// missing, so that its fields stand in none.
fn body(found: &Diagnostic, sources: &Sources) -> Option<Span> {
    let at = found.span().filter(|_| found.code == "E0010")?;
    let end = at.range().start;
    let near = end.saturating_sub(LOOKED_AT);
    let before = sources.text(at.source).as_bytes().get(near..end)?;
    let mut lines = before.rsplit(|byte| *byte == b'\n');
    let indent = |line: &[u8]| line.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    let own = lines.next().filter(|line| indent(line) == line.len())?;
    let inner = lines.take_while(|line| indent(line) > own.len());
    let n: usize = inner.map(|line| line.len() + 1).sum();
    let is_brace = sources.text(at.source)[end..].starts_with('}');
    (n > 0 && is_brace).then(|| Span::new(at.source, end - own.len() - n, end))
}

/// Whether a definition lacks its name: what it was to be may be any that nothing stands for.
fn lacks_name(found: &Diagnostic, sources: &Sources) -> bool {
    let word = found.span().and_then(|at| sources.text(at.source).get(at.range()));
    found.code == "E0019" && word.is_some_and(|word| BEFORE_NAMES.contains(&word))
}

/// Whether what is not in the scene is a label of its text all the same: of what something else left out.
fn is_label(found: &Diagnostic, sources: &Sources) -> bool {
    let Some(at) = found.span() else { return false };
    let text = sources.text(at.source);
    let label = text.get(at.range()).map(|label| format!("\"{label}\""));
    label.is_some_and(|label| {
        memchr::memmem::find_iter(text.as_bytes(), &label)
            .any(|at| text.as_bytes()[at + label.len()..].trim_ascii_start().starts_with(b"{"))
    })
}

/// Where the line of a place begins, or as far before it as is looked at.
fn line_of(at: Span, sources: &Sources) -> usize {
    let (text, start) = (sources.text(at.source), at.range().start);
    let near = (start.saturating_sub(LOOKED_AT)..start).find(|near| text.is_char_boundary(*near));
    let near = near.unwrap_or(start);
    let before = text.as_bytes().get(near..start).unwrap_or_default();
    memchr::memrchr(b'\n', before).map_or(near, |end| near + end + 1)
}

/// How many names are told of that nothing stands for.
fn n_unknown(diagnostics: &[Diagnostic], sources: &Sources) -> usize {
    let unknown = diagnostics.iter().filter(|found| found.code == "E0101");
    let names = unknown.filter_map(|found| {
        let at = found.span()?;
        sources.text(at.source).get(at.range())
    });
    names.collect::<BTreeSet<_>>().len()
}

/// Whether something is said of an object that stands behind one of some words, `shape shape sphere { }`: it is
/// not what is wrong.
fn follows_category(found: &Diagnostic, words: &BTreeSet<Span>, sources: &Sources) -> bool {
    let Some(at) = found.span() else { return false };
    let text = sources.text(at.source);
    let word = words.range(..at).next_back().filter(|word| word.source == at.source);
    word.is_some_and(|word| {
        let between = text.get(word.range().end..at.range().start);
        let is_category = text.get(word.range()).is_some_and(|word| Kind::of_word(word).is_some());
        is_category && between.is_some_and(|between| between.trim_matches([' ', '\t']).is_empty())
    })
}

/// Whether a kind of object is taken for a name behind a bracket on its line that is not closed: in
/// `fn leg(top: length = group {` it begins what the function makes.
fn is_category_behind(found: &Diagnostic, open: &BTreeSet<Span>, sources: &Sources) -> bool {
    let Some(at) = found.span() else { return false };
    let text = sources.text(at.source);
    let is_category = text.get(at.range()).is_some_and(|word| Kind::of_word(word).is_some());
    let is_one = is_category || text.get(at.range()) == Some("group");
    let bracket = open.range(..at).next_back().filter(|bracket| bracket.source == at.source);
    is_one && bracket.is_some_and(|bracket| bracket.range().start >= line_of(at, sources))
}

/// Whether something stands in the braces behind one of some heads.
fn stands_in(found: &Diagnostic, heads: &BTreeSet<Span>, sources: &Sources) -> bool {
    let Some(at) = found.span() else { return false };
    let head = heads.range(..at).next_back().filter(|head| head.source == at.source);
    let between = head.and_then(|head| {
        let between = sources.text(at.source).get(head.range().end..at.range().start)?;
        Some(between).filter(|between| between.len() <= LOOKED_AT)
    });
    between.is_some_and(leaves_brace)
}

/// Whether a value without a name stands behind one of some places, in the same brackets.
fn stands_behind(found: &Diagnostic, places: &BTreeSet<Span>, sources: &Sources) -> bool {
    let Some(at) = found.span() else { return false };
    let rest = sources.text(at.source).as_bytes().get(at.range().end..).unwrap_or_default();
    let next = rest.iter().take(LOOKED_AT).find(|byte| !byte.is_ascii_whitespace());
    if next == Some(&b'=') {
        return false;
    }
    let place = places.range(..=at).next_back().filter(|place| place.source == at.source);
    let between = place.and_then(|place| {
        let text = sources.text(at.source).get(place.start as usize..at.range().start)?;
        Some(text).filter(|text| text.len() <= LOOKED_AT)
    });
    between.is_some_and(|between| {
        let mut depth = 0_i32;
        let is_inside = between.bytes().all(|byte| {
            depth += i32::from(b"([{".contains(&byte)) - i32::from(b")]}".contains(&byte));
            depth >= 0
        });
        is_inside && depth == 0
    })
}

/// Words that are surely meant to be `group`.
fn groups(diagnostics: &[Diagnostic]) -> BTreeSet<Span> {
    let is_one = |found: &&Diagnostic| {
        found.code == "E0401" && found.sure().is_some_and(|fix| fix.replacement == "group")
    };
    diagnostics.iter().filter(is_one).filter_map(Diagnostic::span).collect()
}

/// Where something is told with a code.
fn places(diagnostics: &[Diagnostic], code: &str) -> BTreeSet<Span> {
    diagnostics.iter().filter(|found| found.code == code).filter_map(Diagnostic::span).collect()
}

/// Whether one of some places, which are in order, lies in a larger one.
fn holds_one(span: Span, places: &[Span]) -> bool {
    let first = places.partition_point(|at| (at.source, at.start) < (span.source, span.start));
    let begin_within = |at: &&Span| at.source == span.source && at.start <= span.end;
    let mut within = places[first..].iter().take_while(begin_within);
    within.any(|at| at.end <= span.end && *at != span)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use luxel_core::diag::SourceId;
    use luxel_core::files::MemoryFiles;
    use luxel_core::registry::Registry;

    use super::*;
    use crate::{Loaded, Settings, load};

    fn load_of(lines: &str) -> Loaded {
        let text = format!("scene 1\n{lines}\n");
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        load(Path::new("a.scene"), &files, &Registry::new(), &Settings::default())
    }

    /// The codes of what is told of these lines.
    fn codes(lines: &str) -> Vec<&'static str> {
        load_of(lines).diagnostics.iter().map(|found| found.code).collect()
    }

    #[test]
    fn a_call_is_not_said_to_lack_what_stands_behind_a_missing_bracket() {
        assert_eq!(codes("let c = { a = rgb.srgb(0.8, 0.7) }"), ["E0403", "E0409"]);
        assert_eq!(codes("let c = { a = rgb.srgb(0.8, 0.7 }"), ["E0009", "E0409"]);
    }

    #[test]
    fn a_call_is_not_said_to_have_too_many_arguments_for_one_without_its_comma() {
        let codes = |call: &str| codes(&format!("fn half(x: float) = x / 2\nlet c = {call}"));
        assert_eq!(codes("rgb.srgb(0.1 0.2, 0.3, 0.4)"), ["E0014", "E0409"]);
        assert_eq!(codes("half(1 2)"), ["E0014", "E0409"]);
        assert_eq!(codes("half([1 2], 3)"), ["E0014", "E0402", "E0409"]);
        assert_eq!(codes("half(1, 2)"), ["E0402", "E0409"]);
        let codes =
            |call: &str| self::codes(&format!("fn two(a: vec3, b: vec3) = a\nlet c = {call}"));
        assert_eq!(codes("two((1, 0, 0) (0, 0, 1))"), ["E0214", "E0409"]);
        assert_eq!(codes("two((1, 0, 0))"), ["E0403", "E0409"]);
    }

    #[test]
    fn fields_of_an_object_without_its_brace_are_not_told_of_one_by_one() {
        let fields = "  radius = 1 m\n  material = nope";
        assert_eq!(codes(&format!("{fields}\n}}")), ["E0010", "E0101", "E0409"]);
        assert_eq!(codes("  radius = 1 m\nlet a = 2\n}"), ["E0010", "E0113", "E0409"]);
    }

    #[test]
    fn a_callee_is_not_said_to_have_no_elements_where_a_bracket_is_of_another_kind() {
        let codes = |value: &str| codes(&format!("fn half(x: float) = x / 2\nlet c = {value}"));
        assert_eq!(codes("half[2)"), ["E0009", "E0409"]);
        assert_eq!(codes("half[2]"), ["E0214", "E0409"]);
    }

    #[test]
    fn a_name_is_not_told_of_that_an_unreadable_line_may_define() {
        let uses = "let a = tall * 2\nlet b = tall * 3";
        assert_eq!(codes(uses), ["E0101", "E0409"]);
        let called = "let a = tall(1)\nlet b = tall(2)";
        assert_eq!(codes(&format!("fn talli: int) = i\n{called}")), ["E0010", "E0409"]);
        assert_eq!(codes(&format!("fn talle(i: int) = i\n{called}")), ["E0101", "E0409"]);
        let heads =
            [("let = tall 3", "E0019"), ("tall let = 3", "E0023"), ("fn tall x = 3", "E0023")];
        for (head, code) in heads {
            assert_eq!(codes(&format!("{head}\n{uses}")), [code, "E0409"], "{head}");
        }
        let both = load_of("let a = tall * 2\nlet b = tall * 3").diagnostics.remove(0);
        assert_eq!(both.labels.len(), 2);
        // What is meant stands nowhere but where it is defined: that is mended.
        let found = load_of(&format!("let tal = 3\n{uses}")).diagnostics.remove(0);
        assert_eq!((found.fixes.len(), &*found.fixes[0].replacement), (1, "tall"));
        assert_eq!(found.fixes[0].span.range(), 12..15);
        // What stands where a value does defines nothing.
        let told = codes("let a = [tall 1 m]\nlet b = (1, tall,, 2)\nlet c = tall * 3");
        assert_eq!(told, ["E0014", "E0023", "E0101", "E0409"]);
        // What is meant is no definition of the scene.
        let found =
            load_of("let a = mxi(1, 2, 0)\nlet b = [mxi(1, 2, 1), mix(0, 1, 2)]").diagnostics;
        assert!(found[0].fixes.iter().all(|fix| fix.replacement == "mix"), "{found:?}");
    }

    #[test]
    fn of_two_slips_on_a_line_both_are_told_where_their_mends_are_sure() {
        assert_eq!(codes("let a = (1 2, 3 4)"), ["E0014", "E0014", "E0409"]);
        assert_eq!(codes("let a = (1.5. 2, 3)"), ["E0014", "E0409"]);
        assert_eq!(codes("let a = { b = 1. c = 2 }"), ["E0014", "E0409"]);
        assert_eq!(codes("let a = max(1, min1, 2))"), ["E0101", "E0409"]);
    }

    #[test]
    fn long_lines_of_wide_letters_are_looked_at_in_part() {
        for gap in ["", " "] {
            let wide = format!("let a = max(1, min2, {gap}\"{}\"))", "é".repeat(40_000));
            assert_eq!(codes(&wide), ["E0010", "E0101", "E0409"]);
            let wide = format!("fn a(b: \"{gap}{}\" c", "é".repeat(40_000));
            assert_eq!(codes(&wide), ["E0008", "E0409"]);
        }
    }

    #[test]
    fn a_word_too_much_is_told_at_each_place() {
        let text = "// é\nlet a = vec3(0, 1, 0)\nlet b = vec3(1, 0, 0)\n// é";
        assert_eq!(codes(text), ["E0101", "E0101", "E0409"]);
    }

    #[test]
    fn a_value_is_not_judged_whose_brackets_are_only_likely() {
        let uses = "let a = ends(2) - (1, 1, 1) m\nlet b = tall - (1, 1, 1) m";
        let defined = |close: &str| {
            let list = format!("[1 m, 0 m, 2 m{close}");
            format!("fn ends(i: int) = {list}\nlet tall = {list}\n{uses}")
        };
        assert_eq!(codes(&defined("]")), ["E0214", "E0214", "E0409"]);
        assert_eq!(codes(&defined(")")), ["E0009", "E0009", "E0409"]);
    }

    #[test]
    fn values_around_what_cannot_be_read_are_not_judged() {
        let mut sources = Sources::default();
        sources.add("a.scene", "let a = f(1, 2, 3,\n4};\nlet other = 1");
        sources.add("b.scene", "let b = f(5, 6, 7, 8); let other = 2");
        let error = |code, file, start, end| {
            Diagnostic::error(code, Span::new(SourceId(file), start, end), "")
        };
        let cause = || error("E0009", 0, 20, 21).guess(Span::new(SourceId(0), 19, 19), ")");
        let kept = |found: Diagnostic| {
            let mut all = vec![found, cause()];
            sift(&mut all, &sources);
            all.len() == 2
        };
        assert!(!kept(error("E0403", 0, 10, 19)) && !kept(error("E0214", 0, 19, 30)));
        for (code, file, start, end) in [
            ("E0403", 0, 10, 18),
            ("E0403", 0, 20, 21),
            ("E0403", 1, 10, 30),
            ("E0214", 0, 23, 30),
            ("E0101", 0, 10, 30),
        ] {
            assert!(kept(error(code, file, start, end)), "{code} {file} {start}");
        }
        let warning = Diagnostic::warning("E0403", Span::new(SourceId(0), 10, 30), "");
        assert!(kept(warning));
    }
}
