//! `luxel plugin test --mutants`: whether the checks notice faults that are there on purpose.

use std::fmt::Write;

use luxel_conformance::Options;
use luxel_conformance::mutants::{Caught, mutants, score};
use serde_json::json;

use super::course::Course;
use super::test::{Args, Choice, count};
use crate::exit::{Exit, Failure};
use crate::isolate::Beat;
use crate::report;

pub(super) fn run(args: &Args, words: &[String], options: &Options) -> Result<Exit, Failure> {
    let mut chosen = mutants();
    let known: Vec<_> = chosen.iter().map(|mutant| mutant.class).collect();
    let choice = Choice::new(words, &known)?;
    chosen.retain(|mutant| choice.takes(&mutant.class));
    let mut course = Course::new(&Beat::silent())?;
    let mut found = vec![];
    for (done, mutant) in chosen.iter().enumerate() {
        if course.next(&format!("{:?}", mutant.class), done, chosen.len()).is_break() {
            break;
        }
        found.extend(score(std::slice::from_ref(mutant), options));
    }
    let complete = course.is_complete();
    // The line of progress ends here.
    drop(course);
    let caught = found.iter().filter(|one| !one.by.is_empty()).count();
    if args.json {
        let object = json!({
            "luxel": env!("CARGO_PKG_VERSION"),
            "seed": options.seed,
            "complete": complete,
            "caught": caught,
            "total": found.len(),
            "mutants": found,
        });
        report::out(&format!("{object}\n"))?;
    } else {
        let left = chosen.len() - found.len();
        let cut = if complete { String::new() } else { format!("; interrupted, {left} not tried") };
        let total = count(found.len(), "fault", "faults");
        report::out(&format!("{}\n{caught} of {total} caught{cut}\n", table(&found)))?;
    }
    Ok(match complete {
        _ if caught < found.len() => Exit::Input,
        true => Exit::Fine,
        false => Exit::Incomplete,
    })
}

/// Each fault with the checks that noticed it.
fn table(found: &[Caught]) -> String {
    let mut text = format!("{:<32} {:<32} {}\n", "mutant", "fault", "caught by");
    for Caught { class, fault, by } in found {
        let by = if by.is_empty() { "ESCAPED".to_owned() } else { by.join(", ") };
        let _ = writeln!(text, "{class:<32} {fault:<32} {by}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_that_escapes_stands_out() {
        let one = |by: &[&'static str]| Caught {
            class: "filter narrow".into(),
            fault: "too narrow",
            by: by.iter().map(|check| (*check).into()).collect(),
        };
        let told = table(&[one(&["weights", "mean"]), one(&[])]);
        let ends: Vec<_> = told.lines().map(|line| line[66..].to_owned()).collect();
        assert_eq!(ends, ["caught by", "weights, mean", "ESCAPED"]);
    }
}
