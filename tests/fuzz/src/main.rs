//! The fuzz targets, in one program: `LUXEL_FUZZ` names the one that runs. Started by
//! `tests/fuzz/run`.
#![no_main]

#[path = "../../builder.rs"]
mod builder;
#[path = "../../../lang/tests/language/damage.rs"]
mod damage;
mod seeds;
mod targets;
mod words;

use std::sync::OnceLock;

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target, fuzzer_mutate};
use luxel_lang::check;

use crate::seeds::Seeds;

/// What one target is.
struct Target {
    name: &'static str,
    /// Judges an input; whether it was of use.
    judge: fn(&[u8]) -> bool,
    seeds: fn() -> Seeds,
    /// How often words are changed rather than bytes, of four times.
    words: u32,
}

const fn target(
    name: &'static str,
    judge: fn(&[u8]) -> bool,
    seeds: fn() -> Seeds,
    words: u32,
) -> Target {
    Target { name, judge, seeds, words }
}

const TARGETS: [Target; 12] = [
    target("bytes", targets::bytes::judge, seeds::texts, 1),
    target("readers", targets::readers::judge, seeds::texts, 3),
    target("chunks", check::chunks, seeds::texts, 3),
    target("format", check::format_keeps, seeds::texts, 3),
    target("made", check::made_keeps, seeds::noise, 0),
    target("damage", targets::damage::judge, seeds::texts, 4),
    target("evaluate", targets::evaluate::judge, seeds::texts, 3),
    target("edits", check::edits, seeds::edits, 1),
    target("nested", targets::nested::judge, seeds::nested, 2),
    target("import", targets::import::judge, seeds::files, 0),
    target("film", targets::film::judge, seeds::films, 0),
    target("builder", |bytes| builder::judge(bytes) > 0, seeds::noise, 0),
];

fn chosen() -> &'static Target {
    static CHOSEN: OnceLock<&Target> = OnceLock::new();
    CHOSEN.get_or_init(|| {
        let name = std::env::var("LUXEL_FUZZ").unwrap_or_default();
        TARGETS.iter().find(|target| target.name == name).unwrap_or_else(|| {
            let names: Vec<_> = TARGETS.iter().map(|target| target.name).collect();
            eprintln!("LUXEL_FUZZ names one of {}", names.join(", "));
            std::process::exit(2)
        })
    })
}

/// Words of the language, its names and those of the file formats.
fn words() -> &'static [String] {
    static WORDS: OnceLock<Vec<String>> = OnceLock::new();
    WORDS.get_or_init(words::of_scenes)
}

fuzz_target!(
    init: seeds::write(chosen().name, (chosen().seeds)()),
    |bytes: &[u8]| -> Corpus {
        if (chosen().judge)(bytes) { Corpus::Keep } else { Corpus::Reject }
    }
);

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    let text = str::from_utf8(&data[..size]);
    let Some(text) = text.ok().filter(|_| seed % 4 < chosen().words) else {
        return fuzzer_mutate(data, size, max_size);
    };
    let mut state = u64::from(seed);
    let mut below = |n: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        usize::try_from(state >> 33).unwrap_or_default() % n
    };
    let changed = damage::damaged(text, words(), &mut below);
    let length = changed.len().min(max_size).min(data.len());
    data[..length].copy_from_slice(&changed.as_bytes()[..length]);
    length
});
