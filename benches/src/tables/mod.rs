//! Every table of docs/accuracy.md, and those of other documents that compare Luxel with another
//! renderer or sum it up, written where they stand.

mod asked;
mod denoised;
mod furnace;
mod peers;
mod readme;
mod said;
mod studied;

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::process::{self, Luxel, has_mitsuba, here, read, scratch};
use crate::{Plan, document, errors};
use peers::Found;
use studied::STUDIES;

/// The documents, below the project's folder.
const ACCURACY: &str = "docs/accuracy.md";
const PERFORMANCE: &str = "docs/performance.md";
const README: &str = "README.md";
/// Where the plots of studies stand.
const IMAGES: &str = "docs/images";

/// Packages, and those of their tests that write what they find.
const TESTS: [[&str; 2]; 2] =
    [["luxel-tests", "intervals_hold_the_truth"], ["luxel", "compare::trials"]];

/// The names of their parts.
const ASKED: &str = "asked";
const SAID: &str = "said";
const DENOISED: &str = "denoised";
const CALIBRATION: &str = "calibration";
const MANY: &str = "many";
const FURNACE: &str = "furnace";
const REGIONS: &str = "peers";
const BLOCKS: &str = "peers-blocks";
const SPEED: &str = "peers-speed";

/// How much is measured.
#[derive(Clone, Copy)]
enum Form {
    Whole,
    /// So little that it only shows that every table can be made.
    Short,
}

impl Form {
    fn pick<T>(self, whole: T, short: T) -> T {
        match self {
            Self::Whole => whole,
            Self::Short => short,
        }
    }
}

fn root() -> Result<&'static Path, String> {
    here().parent().ok_or_else(|| "the benches lie in the project's folder".to_owned())
}

/// Which of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    All,
    /// Those that another renderer is needed for.
    Beside,
    /// Those of studies.
    Studies,
}

/// Where tables are written.
struct Documents {
    accuracy: PathBuf,
    performance: PathBuf,
    readme: PathBuf,
}

/// Writes them all; what takes long last. Without another renderer its tables stay as they are, which is
/// an error where only they are wanted.
///
/// # Errors
/// What a command or the disk says.
pub(crate) fn run(plan: &Plan) -> Result<(), String> {
    let root = root()?;
    match plan.part {
        Part::All => alone(plan, root)?,
        Part::Beside => {}
        Part::Studies => {
            return studies(&plan.luxel, &root.join(ACCURACY), Path::new(IMAGES), Form::Whole);
        }
    }
    let [accuracy, performance, readme] = [ACCURACY, PERFORMANCE, README].map(|it| root.join(it));
    let to = Documents { accuracy, performance, readme };
    match (mitsuba(plan), plan.part) {
        (Some(python), _) => beside(&plan.luxel, python, &to, Form::Whole),
        (None, Part::Beside) => Err(MISSING.to_owned()),
        (None, _) => {
            println!("{MISSING}: what is measured beside it stays as it is");
            Ok(())
        }
    }
}

const MISSING: &str = "Mitsuba is not to be had (--python PATH of one that imports it)";

/// The Python that has it.
fn mitsuba(plan: &Plan) -> Option<&Path> {
    plan.python.as_deref().filter(|python| has_mitsuba(python))
}

/// What Luxel alone is needed for.
fn alone(plan: &Plan, root: &Path) -> Result<(), String> {
    let (luxel, place) = (&plan.luxel, root.join(ACCURACY));
    told(Command::new(&luxel.program).args(["verify", "--write"]).arg(&place))?;
    errors::run(Some(&place), errors::RAYS)?;
    for [package, tests] in TESTS {
        let words = ["test", "-p", package, tests];
        told(Command::new("cargo").args(words).env("LUXEL_WRITE_DOCS", "1").current_dir(root))?;
    }
    write(&place, MANY, &many(root, "1e9")?)?;
    renders(luxel, &place, Path::new(IMAGES), Form::Whole)?;
    readme::alone(plan, &root.join(README), Form::Whole)
}

/// What is measured beside another renderer.
fn beside(luxel: &Luxel, python: &Path, to: &Documents, form: Form) -> Result<(), String> {
    write(&to.accuracy, FURNACE, &furnace::tables(root()?, Some(python), form)?)?;
    let found = Found::measure(luxel, python, form)?;
    write(&to.accuracy, REGIONS, &found.regions()?)?;
    write(&to.accuracy, BLOCKS, &found.blocks()?)?;
    write(&to.performance, SPEED, &found.speed()?)?;
    readme::beside(&found, &to.readme)
}

/// Makes those tables of docs/accuracy.md that no test makes, and the rows of the README, of next to nothing
/// and in copies; what is measured beside another renderer is left out, unless it alone is wanted.
///
/// # Errors
/// What a command or the disk says.
pub(crate) fn short(plan: &Plan) -> Result<(), String> {
    let copy = |document: &str, name| process::write(name, &read(&root()?.join(document))?);
    let (place, readme) = (copy(ACCURACY, "accuracy.md")?, copy(README, README)?);
    if plan.part == Part::Beside {
        let python = mitsuba(plan).ok_or(MISSING)?;
        let performance = copy(PERFORMANCE, "performance.md")?;
        let to = Documents { accuracy: place, performance, readme };
        return beside(&plan.luxel, python, &to, Form::Short);
    }
    errors::run(Some(&place), 100)?;
    write(&place, MANY, &many(root()?, "1e6")?)?;
    write(&place, FURNACE, &furnace::tables(root()?, None, Form::Short)?)?;
    renders(&plan.luxel, &place, &scratch()?, Form::Short)?;
    readme::alone(plan, &readme, Form::Short)
}

/// What the film's test of the mean of so many samples of a pixel says.
fn many(root: &Path, samples: &str) -> Result<String, String> {
    let words = ["test", "-p", "luxel-core", "--lib", "a_mean_of_many", "--", "--nocapture"];
    let said =
        told(Command::new("cargo").args(words).env("LUXEL_SAMPLES", samples).current_dir(root))?;
    let line = said.lines().find(|line| line.starts_with("relative error of the mean"));
    let line = line.ok_or_else(|| format!("the test of the mean says nothing of it: {said}"))?;
    Ok(format!("```\n{line}\n```"))
}

/// What is measured by rendering scenes of the project; plots of studies go to `images`, a path as
/// from the project's folder.
fn renders(luxel: &Luxel, place: &Path, images: &Path, form: Form) -> Result<(), String> {
    let root = root()?;
    write(place, SAID, &said::table(root, form)?)?;
    write(place, ASKED, &asked::table(root, form)?)?;
    write(place, DENOISED, &denoised::table(luxel, root, form)?)?;
    studies(luxel, place, images, form)
}

/// Studies of scenes of the project; their plots as above.
fn studies(luxel: &Luxel, place: &Path, images: &Path, form: Form) -> Result<(), String> {
    let root = root()?;
    write(place, CALIBRATION, &studied::calibration(luxel, root)?)?;
    STUDIES
        .iter()
        .try_for_each(|study| write(place, &study.name(), &study.run(luxel, root, images, form)?))
}

/// Prints a part of a document, and puts it there.
fn write(place: &Path, name: &str, body: &str) -> Result<(), String> {
    println!("{name}\n{body}");
    document::write(place, name, body)
}

/// What a command prints, if it ends well.
fn told(command: &mut Command) -> Result<String, String> {
    answer(command, &[0])
}

/// What a command prints, if it ends with one of these codes.
fn answer(command: &mut Command, fine: &[i32]) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    if !output.status.code().is_some_and(|code| fine.contains(&code)) {
        return Err(format!("{command:?}: {}", String::from_utf8_lossy(&output.stderr)));
    }
    String::from_utf8(output.stdout).map_err(|_| format!("{command:?}: no text"))
}

/// Runs the program in a folder.
fn luxel(luxel: &Luxel, folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(&luxel.program);
    command.args(words).current_dir(folder);
    command
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::part;
    use studied::Study;

    #[test]
    fn every_part_that_is_written_stands_in_its_document() {
        let text =
            |document| String::from_utf8(read(&here().join("..").join(document)).unwrap()).unwrap();
        let accuracy = text(ACCURACY);
        for name in [
            "truths",
            "errors",
            "coverage",
            "coverage-asked",
            "trials-same",
            "trials-different",
            "trials-skewed",
            CALIBRATION,
            SAID,
            ASKED,
            MANY,
            DENOISED,
            FURNACE,
            REGIONS,
            BLOCKS,
        ] {
            assert!(!part(&accuracy, name).unwrap().trim().is_empty(), "{name}");
        }
        for name in STUDIES.iter().map(Study::name) {
            assert!(!part(&accuracy, &name).unwrap().trim().is_empty(), "{name}");
        }
        assert!(!part(&text(PERFORMANCE), SPEED).unwrap().trim().is_empty());
    }
}
