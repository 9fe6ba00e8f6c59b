//! Speed and memory of Luxel, and the comparison with Mitsuba where it is installed.
//!
//! `cargo run --release -p luxel-bench -- [WHAT] [--luxel PATH] [--python PATH] [--embree LIBRARY]
//! [--lean DIRECTORY] [--write DOCUMENT] [--only beside|studies]`; a word that it does not know makes it tell what it measures. The
//! program under test is `target/release/luxel` beside this one unless given.
//! Every figure is a median with its spread, (largest − smallest) / median.
#![deny(unsafe_code)]
#![expect(clippy::print_stdout, reason = "the report is this program's output")]

mod attack_texts;
mod attacks;
mod boundary;
mod document;
mod editor;
mod errors;
mod evaluate;
mod features;
#[path = "../../cli/src/generated.rs"]
mod generated;
mod graph;
mod lean;
mod parse;
mod peer;
mod pictures;
mod ply;
mod process;
mod rays;
mod reload;
mod scene;
mod series;
mod strands;
mod tables;
mod watch;

use std::path::PathBuf;
use std::process::ExitCode;

use luxel_core::memory::Memory;

use process::Luxel;
use tables::Part;

/// As in the program under test.
#[global_allocator]
pub(crate) static MEMORY: Memory = Memory::new();

/// With which programs something is measured.
struct Plan {
    luxel: Luxel,
    python: Option<PathBuf>,
    embree: Option<PathBuf>,
    /// The program without the code that most scenes do without.
    lean: Option<PathBuf>,
    /// The document that `errors` writes its tables into.
    document: Option<PathBuf>,
    /// Which of the tables are wanted of `tables` and `tables-short`.
    part: Part,
}

/// Something that can be measured.
struct Bench {
    name: &'static str,
    /// Whether the program is run, rather than its crates.
    runs_program: bool,
    run: fn(&Plan) -> Result<(), String>,
}

const fn of_program(name: &'static str, run: fn(&Plan) -> Result<(), String>) -> Bench {
    Bench { name, runs_program: true, run }
}

const fn of_crates(name: &'static str, run: fn(&Plan) -> Result<(), String>) -> Bench {
    Bench { name, runs_program: false, run }
}

/// The last six are not among `all`: they take long, or another program, or measure nothing new.
const BENCHES: [Bench; 26] = [
    of_crates("parse", |_| parse::run().and_then(|()| evaluate::run())),
    of_crates("evaluate", |_| evaluate::run()),
    of_crates("editor", |_| {
        editor::run();
        Ok(())
    }),
    of_crates("graph", |_| graph::run()),
    of_program("cold", |plan| peer::cold(&plan.luxel)),
    of_program("attacks", |plan| attacks::run(&plan.luxel)),
    of_program("memory", |plan| peer::memory(&plan.luxel)),
    of_program("ply", |plan| ply::run(&plan.luxel, plan.python.as_deref())),
    of_program("plugins", |plan| boundary::run(&plan.luxel)),
    of_crates("rays", |plan| {
        rays::run(plan.embree.as_deref(), plan.python.as_deref());
        Ok(())
    }),
    of_crates("pictures", |_| pictures::run()),
    of_crates("features", |_| features::run()),
    of_crates("builds", |plan| {
        rays::builds(plan.embree.as_deref(), plan.python.as_deref());
        Ok(())
    }),
    of_crates("errors", |plan| errors::run(plan.document.as_deref(), errors::RAYS)),
    of_crates("strands", |_| strands::run()),
    of_crates("leaks", |plan| {
        rays::leaks(plan.embree.as_deref(), plan.python.as_deref(), 40_000);
        Ok(())
    }),
    of_program("reload", |plan| reload::run(&plan.luxel)),
    of_program("cornell", |plan| peer::cornell(&plan.luxel, plan.python.as_deref())),
    of_program("watch", |plan| watch::run(&plan.luxel, plan.python.as_deref())),
    of_program("lean", |plan| lean::run(plan.lean.as_deref())),
    of_program("tables", tables::run),
    of_program("soak", |plan| watch::soak(&plan.luxel)),
    of_program("stages", |plan| watch::stages(&plan.luxel)),
    of_program("crowd", |plan| watch::crowd(&plan.luxel)),
    of_program("tables-short", tables::short),
    of_crates("leaks-long", |plan| {
        rays::leaks(plan.embree.as_deref(), plan.python.as_deref(), 1_000_000);
        Ok(())
    }),
];

fn usage() -> String {
    let names: Vec<&str> = BENCHES.iter().map(|bench| bench.name).collect();
    let names = names.join("|");
    format!(
        "usage: luxel-bench [all|{names}] [--luxel PATH] [--python PATH] [--embree LIBRARY] \
         [--lean DIRECTORY] [--write DOCUMENT] [--only beside|studies]"
    )
}

/// What is to be measured, and with which programs, as these words say.
fn plan(mut words: impl Iterator<Item = String>) -> Result<(&'static [Bench], Plan), String> {
    const ALL: &[Bench] = BENCHES.split_at(BENCHES.len() - 6).0;
    let mut benches = ALL;
    let mut luxel = std::env::current_exe().ok().and_then(|me| Some(me.parent()?.join("luxel")));
    let (mut python, mut embree, mut lean, mut document) = (None, None, None, None);
    let mut part = Part::All;
    while let Some(word) = words.next() {
        match word.as_str() {
            "all" => benches = ALL,
            "--luxel" => luxel = words.next().map(PathBuf::from),
            "--lean" => lean = words.next().map(PathBuf::from),
            "--embree" => embree = words.next().map(PathBuf::from),
            "--write" => document = Some(words.next().ok_or_else(usage)?.into()),
            "--only" => match words.next().as_deref() {
                Some("beside") => part = Part::Beside,
                Some("studies") => part = Part::Studies,
                other => return Err(format!("--only {}? {}", other.unwrap_or_default(), usage())),
            },
            "--python" => python = words.next().map(PathBuf::from),
            name => match BENCHES.iter().position(|bench| bench.name == name) {
                Some(i) => benches = &BENCHES[i..=i],
                None => return Err(format!("`{word}`? {}", usage())),
            },
        }
    }
    let program = luxel.filter(|path| path.exists());
    if program.is_none() && benches.iter().any(|bench| bench.runs_program) {
        return Err("no `luxel`: run `cargo build --release -p luxel`, or give --luxel".to_owned());
    }
    if document.is_some() && !benches.iter().any(|bench| bench.name == "errors") {
        return Err("--write: only `errors` writes into a document".to_owned());
    }
    if part == Part::Studies && benches.iter().any(|bench| bench.name == "tables-short") {
        return Err("--only studies: `tables-short` makes them with all others".to_owned());
    }
    if part != Part::All && !benches.iter().all(|bench| bench.name.starts_with("tables")) {
        return Err("--only: of `tables` and `tables-short` alone there are parts".to_owned());
    }
    let luxel = Luxel { program: program.unwrap_or_default() };
    Ok((benches, Plan { luxel, python, embree, lean, document, part }))
}

fn main() -> ExitCode {
    MEMORY.begin();
    if parse::once() || evaluate::once() {
        return ExitCode::SUCCESS;
    }
    let words = std::env::args().skip(1);
    match plan(words).and_then(|(benches, plan)| benches.iter().try_for_each(|it| (it.run)(&plan)))
    {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            println!("{message}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_one_of_tables_and_has_a_name() {
        // Any file stands for the program.
        let here = std::env::current_exe().unwrap().display().to_string();
        let part = |text: &str| {
            let words =
                text.split(' ').map(str::to_owned).chain(["--luxel".to_owned(), here.clone()]);
            plan(words).map(|(benches, plan)| (benches.len(), benches[0].name, plan.part))
        };
        assert_eq!(part("tables"), Ok((1, "tables", Part::All)));
        assert_eq!(part("tables --only beside"), Ok((1, "tables", Part::Beside)));
        assert_eq!(part("--only beside tables-short"), Ok((1, "tables-short", Part::Beside)));
        assert_eq!(part("tables --only studies"), Ok((1, "tables", Part::Studies)));
        assert!(part("tables-short --only studies").unwrap_err().starts_with("--only studies: "));
        assert!(part("tables --only besides").unwrap_err().starts_with("--only besides? usage: "));
        assert!(part("ply --only beside").unwrap_err().starts_with("--only: of `tables`"));
        assert!(part("--only beside").unwrap_err().starts_with("--only: of `tables`"));
    }
}
