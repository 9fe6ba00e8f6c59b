//! What a scene's file says of its picture, tested.

use std::path::Path;

use luxel_core::diag::Sources;
use luxel_core::film::{Film, Rect};
use luxel_core::render::Options;
use luxel_core::scene::{Area, Claim, Expectation, Expected};
use luxel_core::stage::Stage;

use super::mean::{luminance, mean};
use super::row::{Measured, Row};
use super::run::Run;
use super::same;
use crate::args::LoadArgs;
use crate::exit::{Exit, Failure};
use crate::load::{self, Loaded};
use crate::report::{self, Form, Stream};

/// Where a file gives no tolerance, the share of what is expected that rounding may take: a hundred
/// steps of single precision, in which light is carried, and as much as the longest sums of the
/// project's own truths lose.
const ROUNDING: f64 = 1e-5;

/// A scene that was read and is ready.
struct Ready {
    stage: Stage,
    expectations: Vec<Expectation>,
    sources: Sources,
}

/// Tests everything that a file says, once for each set of parameters under which it says something, and
/// gives the rows in the file's order. Whether it says anything.
///
/// # Errors
/// A scene that cannot be read; what `Run::film` says.
pub(super) fn test(
    file: &Path,
    args: &LoadArgs,
    run: &Run,
    form: Form,
    rows: &mut Vec<Row>,
) -> Result<bool, Failure> {
    let first = ready(file, args, run, form)?;
    if first.expectations.is_empty() {
        report::warning(&format!("`{}` expects nothing of its picture", file.display()));
        return Ok(false);
    }
    let mut sets: Vec<&[(String, String)]> = vec![];
    for said in &first.expectations {
        if !sets.contains(&&*said.given) {
            sets.push(&said.given);
        }
    }
    let mut found = vec![];
    let done = sets.into_iter().try_for_each(|given| {
        let mut again = None;
        if !given.is_empty() {
            let mut args = args.clone();
            args.set.extend_from_slice(given);
            again = Some(ready(file, &args, run, form)?);
        }
        let ready = again.as_ref().unwrap_or(&first);
        let said = under(given, &first, ready, file)?;
        picture(file, (ready, &said), args, run, form, &mut found)
    });
    found.sort_by_key(|(place, _)| *place);
    rows.extend(found.into_iter().map(|(_, row)| row));
    done.map(|()| true)
}

/// Reads a scene and makes it ready.
fn ready(file: &Path, args: &LoadArgs, run: &Run, form: Form) -> Result<Ready, Failure> {
    let loaded = load::load(file, args, None, &run.plugins, &run.course());
    let loaded = loaded.map_err(|failure| run.interrupted().unwrap_or(failure))?;
    report::diagnostics(&loaded.diagnostics, &loaded.sources, form, Stream::Error)?;
    let Loaded { stage: Some(stage), scene: Some(scene), sources, .. } = loaded else {
        let message = format!("`{}` cannot be tested", file.display());
        return Err(Failure::new(Exit::Input, message));
    };
    Ok(Ready { stage, expectations: scene.expectations, sources })
}

/// What a file says under some parameters, as it is evaluated under them.
fn under<'a>(
    given: &[(String, String)],
    first: &Ready,
    ready: &'a Ready,
    file: &Path,
) -> Result<Vec<&'a Expectation>, Failure> {
    let mut out = vec![];
    let said = first.expectations.iter().filter(|said| said.given == given);
    for (i, wanted) in said.clone().enumerate() {
        let alike = |said: &&Expectation| said.span == wanted.span && said.given == given;
        let before = said.clone().take(i).filter(alike).count();
        let Some(found) = ready.expectations.iter().filter(alike).nth(before) else {
            let message = format!(
                "`{}` does not say under what it sets in `where`, what it says without",
                place(file, wanted, &first.sources)
            );
            return Err(Failure::new(Exit::Input, message));
        };
        out.push(found);
    }
    Ok(out)
}

/// `a.scene:12`
fn place(file: &Path, said: &Expectation, sources: &Sources) -> String {
    let line = sources.line_column(said.span.source, said.span.range().start).line;
    format!("{}:{line}", file.display())
}

/// Renders a scene and tests what is said of it: rows, each with the place that says it.
fn picture(
    file: &Path,
    (ready, said): (&Ready, &[&Expectation]),
    args: &LoadArgs,
    run: &Run,
    form: Form,
    rows: &mut Vec<(usize, Row)>,
) -> Result<(), Failure> {
    let options = Options { crop: needed(said), ..run.options.clone() };
    let film = run.film((file, &ready.stage), &options)?;
    for said in said {
        let (id, at) = (place(file, said, &ready.sources), said.span.range().start);
        let given = said.given.iter().map(|(name, value)| format!(" {name}={value}"));
        let given = given.collect::<Vec<_>>().concat();
        match &said.claim {
            Claim::Mean { of, value, tolerance } => {
                let found = means(&film, *of, (*value, *tolerance), (&id, &given));
                rows.extend(found.into_iter().map(|row| (at, row.without(film.bad_samples()))));
            }
            Claim::SameAs { name, path } => {
                let own = LoadArgs { set: vec![], ..args.clone() };
                let other = self::ready(path, &own, run, form)?;
                // Other random numbers: equal noise would hide what differs.
                let seed = Some(options.seed(&ready.stage).wrapping_add(1));
                let options = Options { seed, ..run.options.clone() };
                let other = run.film((path, &other.stage), &options)?;
                let case = format!("same_as {name:?}{given}");
                let bad = film.bad_samples() + other.bad_samples();
                rows.push((at, same::test((&id, &case), &film, &other)?.without(bad)));
            }
        }
    }
    Ok(())
}

/// The part of the picture that the expectations speak of; nothing if they speak of all.
fn needed(said: &[&Expectation]) -> Option<Rect> {
    let mut all: Option<Rect> = None;
    for said in said {
        let Claim::Mean { of: Area::Region(rect), .. } = said.claim else { return None };
        all = Some(all.map_or(rect, |all| {
            let (min, end) =
                (all.min.min(rect.min), (all.min + all.size).max(rect.min + rect.size));
            Rect::new(min, end - min)
        }));
    }
    all
}

fn means(
    film: &Film,
    of: Area,
    (value, tolerance): (Expected, Option<f64>),
    (id, given): (&str, &str),
) -> Vec<Row> {
    let found = mean(film, of);
    let row = |channel: &str, expected: f64, value: f64, error: f64| {
        let tolerance = tolerance.unwrap_or(ROUNDING * expected.abs());
        let case = format!("{of}{channel}{given}");
        Row::new((id, &case), expected, Measured { value, error }, tolerance)
    };
    match value {
        Expected::Luminance(y) => {
            vec![row("", y, luminance(found.value), luminance(found.error))]
        }
        Expected::Rgb(rgb) => {
            let row = |i: usize| row([" R", " G", " B"][i], rgb[i], found.value[i], found.error[i]);
            (0..3).map(row).collect()
        }
    }
}
