//! Speed and memory of Luxel, and the comparison with Mitsuba where it is installed.
//!
//! `cargo run --release -p luxel-bench -- [all|parse|cold|memory|ply|plugins|
//! rays|leaks|leaks-long|errors|strands|reload|cornell] [--luxel PATH] [--python PATH] [--embree LIBRARY]`. The program under test is `target/release/luxel` beside this one unless given.
//! Every figure is a median with its spread, (largest − smallest) / median.
#![deny(unsafe_code)]
#![expect(clippy::print_stdout, reason = "the report is this program's output")]

mod boundary;
mod errors;
mod parse;
mod peer;
mod ply;
mod process;
mod rays;
mod reload;
mod series;
mod strands;

use std::path::PathBuf;
use std::process::ExitCode;

use process::Luxel;

/// What is measured, and with which programs.
struct Plan {
    what: String,
    luxel: Luxel,
    python: Option<PathBuf>,
    embree: Option<PathBuf>,
}

const USAGE: &str = "usage: luxel-bench [all|parse|cold|memory|ply|plugins|rays|leaks|leaks-long|errors|strands|reload|cornell] [--luxel PATH] [--python PATH] [--embree LIBRARY]";

fn plan() -> Result<Plan, String> {
    let mut what = "all".to_owned();
    let mut luxel = std::env::current_exe().ok().and_then(|me| Some(me.parent()?.join("luxel")));
    let mut python = None;
    let mut embree = None;
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "all" | "parse" | "cold" | "memory" | "ply" | "plugins" | "rays" | "leaks"
            | "leaks-long" | "errors" | "strands" | "reload" | "cornell" => {
                what = word;
            }
            "--luxel" => luxel = words.next().map(PathBuf::from),
            "--embree" => embree = words.next().map(PathBuf::from),
            "--python" => python = words.next().map(PathBuf::from),
            _ => return Err(format!("`{word}`? {USAGE}")),
        }
    }
    let program = luxel.filter(|path| path.exists());
    if !matches!(what.as_str(), "parse" | "rays" | "leaks" | "leaks-long" | "errors" | "strands")
        && program.is_none()
    {
        return Err("no `luxel`: run `cargo build --release -p luxel`, or give --luxel".to_owned());
    }
    Ok(Plan { what, luxel: Luxel { program: program.unwrap_or_default() }, python, embree })
}

fn run(plan: &Plan) -> Result<(), String> {
    let wanted = |what: &str| plan.what == what || plan.what == "all";
    if wanted("parse") {
        parse::run();
    }
    if wanted("cold") {
        peer::cold(&plan.luxel)?;
    }
    if wanted("memory") {
        peer::memory(&plan.luxel)?;
    }
    if wanted("ply") {
        ply::run(&plan.luxel, plan.python.as_deref())?;
    }
    if wanted("plugins") {
        boundary::run(&plan.luxel)?;
    }
    if wanted("rays") {
        rays::run(plan.embree.as_deref(), plan.python.as_deref());
    }
    if wanted("errors") {
        errors::run()?;
    }
    if wanted("strands") {
        strands::run()?;
    }
    if wanted("leaks") {
        rays::leaks(plan.embree.as_deref(), plan.python.as_deref(), 40_000);
    }
    if plan.what == "leaks-long" {
        rays::leaks(plan.embree.as_deref(), plan.python.as_deref(), 1_000_000);
    }
    if wanted("reload") {
        reload::run(&plan.luxel)?;
    }
    if wanted("cornell") {
        peer::cornell(&plan.luxel, plan.python.as_deref())?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match plan().and_then(|plan| run(&plan)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            println!("{message}");
            ExitCode::FAILURE
        }
    }
}
