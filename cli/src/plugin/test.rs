//! `luxel plugin test`: whether plugins keep what their kind promises.

use std::collections::{BTreeMap, BTreeSet};
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fmt::Write;
use std::io::Read;
use std::path::Path;

use luxel_conformance::{Options, Report, Row, run_while};
use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use serde_json::json;

use super::course::Course;
use super::{apart, mutants};
use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::isolate::{Beat, IsolateArgs, Phase};
use crate::libraries::{Found, Plugins, Session, State, Surroundings, is_library, open_file};
use crate::progress::duration;
use crate::report::{Form, Stream};
use crate::{list, load, report};

/// Judge plugins: does each keep what its kind promises?
///
/// Of the plugins that a scene may name, or of one library, which need not be trusted: naming it lets
/// its code run. Objects are made from each plugin's schema, at the ends of its ranges and at random inside, and
/// asked for what every plugin of the kind must satisfy. Prints each check with the worst figure that
/// was found and its limit; below a check that failed, the parameters and the place. Equal seeds give
/// equal reports. Ctrl-C ends after the class in hand, with what was judged so far.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Exit codes: 0 no check failed, 1 one did (or a fault escaped), 2 no such plugin or option,
3 interrupted, or no object of a plugin could be made.

Examples:
  luxel plugin test
  luxel plugin test material
  luxel plugin test filter box --json
  luxel plugin test target/release/libvelvet.so
  luxel plugin test target/release/libvelvet.so --isolate
  luxel plugin test target/release/libvelvet.so material velvet
  luxel plugin test --mutants")]
pub(crate) struct Args {
    /// Only the plugins of this library (a path), this kind (as `luxel list` shows it), this name
    #[arg(num_args = 0..=3, value_name = "[LIBRARY] [KIND [NAME]]")]
    what: Vec<String>,
    /// A JSON object
    #[arg(long)]
    pub(super) json: bool,
    /// Seed of the parameters and samples that are tried
    #[arg(long, value_name = "N", default_value_t = Options::default().seed)]
    pub(super) seed: u64,
    /// Judge plugins that are wrong on purpose, to see whether the checks notice
    #[arg(long, conflicts_with = "isolate")]
    mutants: bool,
    /// Print kind and name of what would be judged
    #[arg(long, hide = true)]
    list: bool,
    #[command(flatten)]
    pub(super) isolate: IsolateArgs,
    #[command(flatten)]
    pub(super) plugins: PluginArgs,
}

impl Args {
    /// The library, if the first word is the path of one, and the words after it.
    pub(super) fn library(&self) -> (Option<&Path>, &[String]) {
        let path = self.what.first().map(Path::new);
        let names_file = |path: &&Path| {
            is_library(path) || path.to_string_lossy().contains(std::path::is_separator)
        };
        match path.filter(names_file) {
            Some(path) => (Some(path), &self.what[1..]),
            None => (None, &self.what),
        }
    }

    /// The command line that judges one class in the same way.
    fn again(&self, kind: &str, class: &str) -> String {
        let mut words = vec!["luxel".into(), "plugin".into(), "test".into()];
        words.extend(self.library().0.map(|path| path.to_string_lossy().into_owned()));
        words.extend([kind.to_owned(), class.to_owned()]);
        words.extend(self.isolate.words());
        words.extend(self.plugins.words().iter().map(|word| word.to_string_lossy().into_owned()));
        if self.seed != Options::default().seed {
            words.extend(["--seed".to_owned(), self.seed.to_string()]);
        }
        words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }
}

/// A word as a shell takes it for one.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:\\".contains(c);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{word}'") }
}

pub(super) fn run(args: &Args) -> Result<Exit, Failure> {
    let options = Options { seed: args.seed, memory: Some(memory), ..Options::default() };
    if args.mutants {
        let (library, words) = args.library();
        if let Some(file) = library {
            let message = format!("--mutants judges its own plugins, not `{}`", file.display());
            return Err(Failure::new(Exit::Usage, message).help("luxel plugin test --help"));
        }
        return mutants::run(args, words, &options);
    }
    let Some(beat) = args.isolate.beat() else { return apart::run(args) };
    let _end = beat.until_the_end();
    judge(args, &beat, &options)
}

/// What the process holds of memory, in bytes, where the system tells it in `/proc`.
fn memory() -> Option<u64> {
    let status = std::fs::File::options().read(true).open("/proc/self/status").ok()?;
    let mut text = String::new();
    status.take(1 << 16).read_to_string(&mut text).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<u64>().ok()? * 1024)
}

fn judge(args: &Args, beat: &Beat, options: &Options) -> Result<Exit, Failure> {
    beat.phase(Phase::Opening);
    let (library, words) = args.library();
    let (registry, own, choice) = if let Some(file) = library {
        let (registry, own) = with_library(file, &args.plugins)?;
        let choice = Choice::new(words, &own)?;
        (registry, own, choice)
    } else {
        let plugins = load::registry(&args.plugins)?;
        plugins.notes.tell(Form::Text, Stream::Error)?;
        let all: Vec<_> = plugins.registry.all().map(|entry| entry.class).collect();
        let choice = Choice::new(words, &all);
        let choice = choice.map_err(|failure| in_a_library(failure, words, &plugins))?;
        (plugins.registry, all, choice)
    };
    if args.list {
        return list_classes(&own, &choice);
    }
    beat.phase(Phase::Judging);
    let mut course = Course::new(beat)?;
    let is_own = |class: &Class| own.iter().any(|o| (o.kind, o.name) == (class.kind, class.name));
    let found = run_while(
        &registry,
        |class| is_own(class) && choice.takes(class),
        options,
        |step| course.next(&format!("{:?}", step.class), step.done, step.total),
    );
    tell(args, &found, course)
}

fn list_classes(own: &[Class], choice: &Choice) -> Result<Exit, Failure> {
    let chosen = own.iter().filter(|class| class.kind != Kind::Film && choice.takes(class));
    let names: Vec<_> = chosen.map(|class| (class.kind.word(), class.name)).collect();
    report::out(&format!("{}\n", json!(names)))?;
    Ok(Exit::Fine)
}

/// The built-in classes and those of a library, and the latter alone.
fn with_library(file: &Path, args: &PluginArgs) -> Result<(Registry, Vec<Class>), Failure> {
    let builtins = PluginArgs { builtins: args.builtins.clone(), ..PluginArgs::default() };
    // No surroundings: no other library has a say in this.
    let plugins = Session::new().refresh(&builtins, &Surroundings::default())?;
    let mut registry = plugins.registry;
    let (opened, _) = open_file(file)?;
    registry.add(&opened.name, &opened.classes).map_err(|conflict| {
        Failure::new(Exit::Input, format!("cannot use `{}`: {conflict}", file.display()))
    })?;
    Ok((registry, opened.classes))
}

/// Adds to the failure of a name that nobody knows where plugins of libraries are found.
fn in_a_library(failure: Failure, words: &[String], plugins: &Plugins) -> Failure {
    let [kind, name] = words else { return failure };
    if Kind::of_word(kind).is_none() {
        return failure;
    }
    let mut help: Vec<String> = failure.help.into_iter().collect();
    // Of what is only listed in the lock, that which may have the plugin.
    let listed = |state: &State| matches!(state, State::Elsewhere | State::Missing);
    let told =
        plugins.libraries.iter().filter(|found| found.stem == *name || !listed(&found.state));
    help.extend(told.filter_map(Found::advice));
    let file = format!("target/release/{DLL_PREFIX}{name}{DLL_SUFFIX}");
    help.push(format!(
        "that of a library: luxel plugin test {file} {kind} {name}, or --plugin-dir with its folder"
    ));
    Failure { help: Some(help.join("; ")), ..failure }
}

/// Prints what was found.
///
/// # Errors
/// If standard output cannot be written.
pub(super) fn tell(args: &Args, found: &Report, course: Course) -> Result<Exit, Failure> {
    let Course { begun, total, .. } = course;
    let (time, complete) = (duration(course.seconds()), course.is_complete());
    // The line of progress ends here.
    drop(course);
    if args.json {
        let object = json!({
            "luxel": env!("CARGO_PKG_VERSION"),
            "seed": args.seed,
            "complete": complete,
            "classes": begun,
            "failed": found.failed().count(),
            "skipped": found.skipped().count(),
            "rows": found.rows,
        });
        report::out(&format!("{object}\n"))?;
    } else {
        let judged = if complete {
            format!("{} in {time}", count(begun, "class", "classes"))
        } else {
            format!("interrupted: {begun} of {total} classes in {time}")
        };
        report::out(&format!("{found}\n{judged}{}", summary(found, args)))?;
    }
    Ok(exit(found, complete))
}

fn exit(found: &Report, complete: bool) -> Exit {
    if !found.is_clean() {
        Exit::Input
    } else if complete && found.unmade().next().is_none() {
        Exit::Fine
    } else {
        Exit::Incomplete
    }
}

/// `: 20 checks passed, 1 failed`, what could not be judged, and how to judge the failures again.
fn summary(found: &Report, args: &Args) -> String {
    let (failed, skipped) = (found.failed().count(), found.skipped().count());
    let passed = found.rows.len() - failed - skipped;
    let mut text = format!(": {} passed, {failed} failed", count(passed, "check", "checks"));
    if skipped > 0 {
        let _ = write!(text, ", {skipped} could not be made");
    }
    text.push('\n');
    let mut reasons = BTreeMap::<_, Vec<_>>::new();
    for (Row { kind, class, check, .. }, why) in found.skipped() {
        reasons.entry((kind, class, why)).or_default().push(check.as_ref());
    }
    for ((kind, class, why), checks) in reasons {
        let told = if checks.len() <= MOST_CHECKS {
            checks.join(", ")
        } else {
            count(checks.len(), "check", "checks")
        };
        let _ = writeln!(text, "not judged: {kind} {class}, {told}: {why}");
    }
    let classes: BTreeSet<_> = found.failed().map(|row| (row.kind, &row.class)).collect();
    for (kind, class) in classes {
        let _ = writeln!(text, "failed: {}", args.again(kind, class));
    }
    text
}

/// Checks that are named together, at most: their rows name them all.
const MOST_CHECKS: usize = 4;

/// `1 class`, `2 classes`.
pub(super) fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// What the command line asks for.
pub(super) struct Choice {
    kind: Option<Kind>,
    name: Option<String>,
}

impl Choice {
    /// # Errors
    /// A kind or name that none of `known` has, with the nearest or those that there are; a kind
    /// without behaviour.
    pub(super) fn new(words: &[String], known: &[Class]) -> Result<Self, Failure> {
        let (word, name) = match words {
            [] => return Ok(Self { kind: None, name: None }),
            [word] => (word, None),
            [word, name] => (word, Some(name)),
            _ => {
                let message = format!("`{}` is neither a library nor expected here", words[0]);
                let help = "a library is a path, as in ./libvelvet.so";
                return Err(Failure::new(Exit::Usage, message).help(help));
            }
        };
        let usage = |failure| Failure { exit: Exit::Usage, ..failure };
        if crate::words::find(word).is_some() {
            let message = format!("`{word}` is a word of the language, not a kind of plugin");
            return Err(Failure::new(Exit::Usage, message).help("luxel plugin test --help"));
        }
        let kind = list::kind(word).map_err(usage)?;
        let of_kind = known.iter().filter(|class| class.kind == kind);
        let names: Vec<_> = of_kind.map(|class| class.name).collect();
        if kind == Kind::Film || names.is_empty() {
            let message = format!("there is nothing to judge of the kind `{word}`");
            let mut kinds: Vec<_> = known.iter().map(|class| class.kind).collect();
            kinds.retain(|kind| *kind != Kind::Film);
            kinds.dedup();
            let kinds: Vec<_> = kinds.into_iter().map(Kind::word).collect();
            let help = format!("known: {}", kinds.join(", "));
            return Err(Failure::new(Exit::Usage, message).help(help));
        }
        if let Some(name) = name.filter(|name| !names.contains(&name.as_str())) {
            return Err(usage(list::unknown(kind.word(), name, &names)));
        }
        Ok(Self { kind: Some(kind), name: name.cloned() })
    }

    pub(super) fn takes(&self, class: &Class) -> bool {
        self.kind.is_none_or(|kind| kind == class.kind)
            && self.name.as_ref().is_none_or(|name| name == class.name)
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};
    use luxel_conformance::Verdict;

    use super::*;

    fn args(words: &[&str]) -> Args {
        let command = Args::augment_args(clap::Command::new("test"));
        let matches = command.get_matches_from(["test"].iter().chain(words));
        Args::from_arg_matches(&matches).unwrap()
    }

    fn report(verdicts: &[(&'static str, Verdict)]) -> Report {
        let row = |(check, verdict): &(&'static str, Verdict)| Row {
            kind: "filter",
            class: "box".into(),
            check: (*check).into(),
            verdict: verdict.clone(),
            figure: 0.0,
            limit: 0.0,
            detail: String::new(),
        };
        Report { rows: verdicts.iter().map(row).collect() }
    }

    #[test]
    fn a_failure_outweighs_an_interrupt_and_an_object_that_cannot_be_made_is_no_success() {
        let (fine, bad) = (report(&[("a", Verdict::Pass)]), report(&[("a", Verdict::Fail)]));
        assert_eq!((exit(&fine, true), exit(&fine, false)), (Exit::Fine, Exit::Incomplete));
        assert_eq!((exit(&bad, true), exit(&bad, false)), (Exit::Input, Exit::Input));
        let skip =
            |check| report(&[("a", Verdict::Pass), (check, Verdict::Skip("no file".into()))]);
        assert_eq!(exit(&skip("bounded"), true), Exit::Fine);
        assert_eq!(exit(&skip("parameters"), true), Exit::Incomplete);
    }

    #[test]
    fn a_summary_counts_and_names_what_was_skipped_and_what_failed() {
        let skip = Verdict::Skip("no file".into());
        let found = report(&[("a", Verdict::Pass), ("b", Verdict::Fail), ("c", skip)]);
        let told = ": 1 check passed, 1 failed, 1 could not be made\n\
                    not judged: filter box, c: no file\n\
                    failed: luxel plugin test filter box --seed 7\n";
        assert_eq!(summary(&found, &args(&["--seed", "7"])), told);
        let fine = report(&[("a", Verdict::Pass), ("b", Verdict::Pass)]);
        assert_eq!(summary(&fine, &args(&[])), ": 2 checks passed, 0 failed\n");
    }

    #[test]
    fn what_is_skipped_for_one_reason_is_one_line() {
        let skip = || Verdict::Skip("it failed".into());
        let found = report(&[("a", skip()), ("b", skip())]);
        let told = ": 0 checks passed, 0 failed, 2 could not be made\n\
                    not judged: filter box, a, b: it failed\n";
        assert_eq!(summary(&found, &args(&[])), told);
    }

    #[test]
    fn the_command_that_judges_again_is_this_one_for_one_class() {
        for words in [
            &["./my lib.so", "filter", "box", "--isolate", "--patience", "2.5", "--seed", "7"][..],
            &["filter", "box", "--plugin-dir", "a", "--allow-unlocked-plugins"],
            &["filter", "box"],
        ] {
            let told = args(words).again("filter", "box");
            let expected: Vec<_> = words.iter().map(|word| quoted(word)).collect();
            assert_eq!(told, format!("luxel plugin test {}", expected.join(" ")));
        }
        assert_eq!(quoted("./my lib.so"), "'./my lib.so'");
    }
}
