//! What the formatter keeps: the tree, every comment, and its own output. Asked by tests and by
//! `tests/fuzz`.

mod made;

use luxel_core::diag::SourceId;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

use crate::sink::Sink;
use crate::syntax::parse;
use crate::{Budgets, format};

/// The tree of a text without its places; `None` if it cannot be read.
pub(crate) fn tree(text: &str) -> Option<String> {
    let mut sink = Sink::new(usize::MAX);
    let tree = parse(text, SourceId(0), &Budgets::default(), &mut sink);
    let told = format!("{:?}", tree.stmts);
    let mut bare = String::with_capacity(told.len());
    let mut parts = told.split("Span { source: SourceId(0)");
    bare.push_str(parts.next()?);
    for part in parts {
        bare.push_str(part.split_once('}')?.1);
    }
    (sink.errors() == 0).then_some(bare)
}

/// The comments of a text in order, found without the formatter's help.
fn comments(text: &str) -> Vec<String> {
    let (mut found, mut rest) = (vec![], text);
    while let Some(at) = rest.find(['"', '/', '#']) {
        rest = &rest[at..];
        let line = rest.find('\n').unwrap_or(rest.len());
        let length = match rest.get(..2) {
            Some("//") => line,
            // The bracket of a table ends the comments in it too.
            Some("#[") => {
                let end = rest.find(']').unwrap_or(rest.len());
                found.extend(comments(&rest[2..end]));
                end
            }
            Some("/*") => rest[2..].find("*/").map_or(rest.len(), |end| end + 4),
            _ if rest.starts_with('"') => {
                // The first quote that has an even number of backslashes before it.
                let ends = |end: &usize| {
                    let body = &rest[1..*end];
                    (body.len() - body.trim_end_matches('\\').len()).is_multiple_of(2)
                };
                let quotes = rest.match_indices('"').map(|(at, _)| at).skip(1);
                quotes.into_iter().find(ends).map_or(rest.len(), |end| end + 1)
            }
            _ => 1,
        };
        if matches!(rest.get(..2), Some("//" | "/*")) {
            let lines = rest[..length].lines().map(str::trim_end);
            found.push(lines.collect::<Vec<_>>().join("\n"));
        }
        rest = &rest[length..];
    }
    found
}

/// Formats, and holds the result against what the formatter promises.
pub(crate) fn formatted(text: &str) -> Result<String, String> {
    let once = format(text, &Budgets::default()).map_err(|told| format!("{told:?}\n{text}"))?;
    let twice = format(&once, &Budgets::default()).map_err(|told| format!("{told:?}\n{once}"))?;
    let check = |kept: bool, what: &str, other: &str| {
        if kept { Ok(()) } else { Err(format!("{what}\n{text}\n=>\n{once}\n=>\n{other}")) }
    };
    check(once == twice, "formatting twice differs", &twice)?;
    check(tree(text) == tree(&once), "another tree", "")?;
    check(comments(text) == comments(&once), "other comments", "")?;
    // Within a string a carriage return is kept, as all else.
    let tidy = |line: &str| line.trim_end() == line;
    let several = once.contains("/*") || once.split('\n').all(tidy);
    check(several && (once.ends_with('\n') || once.is_empty()), "untidy lines", "")?;
    Ok(once)
}

/// Noise that fills gaps with single blanks.
const PLAIN: u8 = 3;

/// A scene that no one wrote.
#[derive(Clone, Debug)]
pub(crate) struct Made {
    words: Vec<made::Word>,
    noise: Vec<u8>,
}

/// Scenes of any words, their gaps filled by any noise.
pub(crate) fn scene() -> impl Strategy<Value = Made> {
    let noise = prop::collection::vec(any::<u8>(), 1..200);
    (made::file(), noise).prop_map(|(words, noise)| Made { words, noise })
}

/// The scene that these bytes choose, folded into 32. (Where proptest takes choices from given
/// bytes it does not end once there are no more.)
pub(crate) fn chosen(bytes: &[u8]) -> Option<Made> {
    thread_local! {
        static SCENE: BoxedStrategy<Made> = scene().boxed();
    }
    let mut seed = [0_u8; 32];
    bytes.iter().zip((0..32).cycle()).for_each(|(byte, i)| seed[i] ^= byte);
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    SCENE.with(|scene| scene.new_tree(&mut runner)).ok().map(|tree| tree.current())
}

/// Holds a scene against what the formatter promises; its tree is that of its words alone.
pub(crate) fn made_keeps(made: &Made) -> Result<(), String> {
    let plain = made::text(&made.words, &[PLAIN]);
    let text = made::text(&made.words, &made.noise);
    let of_text = tree(&text).ok_or_else(|| format!("not a scene:\n{text}"))?;
    if tree(&plain) != Some(of_text) {
        return Err(format!("another tree\n{text}\n=>\n{plain}"));
    }
    formatted(&text).map(|_| ())
}
