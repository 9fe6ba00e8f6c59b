//! `luxel study`: what speed costs in accuracy, measured for one scene.

mod args;
mod calibrate;
mod choose;
mod data;
mod estimate;
mod expected;
mod fit;
mod found;
mod lab;
mod outcome;
mod plan;
mod price;
mod settings;
mod subjects;
mod svg;
mod sweep;
mod table;
mod verify;

use std::path::Path;
use std::time::Instant;

use luxel_core::render::Options;

use self::choose::Choice;
use self::estimate::Reference;
use self::expected::Expected;
use self::found::{Advice, Found};
use self::lab::{Lab, Series, Subject};
use self::outcome::Outcome;
use self::plan::Plan;
use self::subjects::Subjects;
use crate::exit::{Exit, Failure};
use crate::load;
use crate::progress::{self, Steps};
use crate::report::{self, Stream};
use crate::verify::Run;

pub(crate) use self::args::Args;
pub(crate) use self::price::{Price, prices};

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    args.output.as_deref().map_or(Ok(()), found::check)?;
    let plugins = load::registry(&args.plugins)?;
    plugins.notes.tell(args.form(), Stream::Error)?;
    let options = Options { threads: args.threads, ..Options::default() };
    let run = Run::new(plugins, options)?.silent();
    let start = Instant::now();
    let Some(file) = &args.file else {
        let readings = calibrate::readings(&run, args.seed)?;
        let told = if args.json {
            readings.map(|reading| format!("{}\n", reading.json())).concat()
        } else {
            readings.map(|reading| format!("{}\n", reading.text())).concat()
        };
        return report::out(&told).map(|()| Exit::Fine);
    };
    let found = study(file, args, &run, start)?;
    args.output.as_deref().map_or(Ok(()), |out| found.write(out))?;
    let told = if args.json { format!("{}\n", found.json()) } else { found.text() };
    report::out(&told)?;
    let is_whole = found.is_met() && !found.is_interrupted;
    Ok(if is_whole { Exit::Fine } else { Exit::Incomplete })
}

fn study(file: &Path, args: &Args, run: &Run, start: Instant) -> Result<Found, Failure> {
    let mut subjects = subjects::subjects(file, args, run)?;
    let readings = calibrate::readings(run, args.seed)?;
    let mut lab = Lab::new(run, file, args.seed);
    let steps = Steps::new();
    let plan = plan(args, &subjects, &mut lab)?;
    subjects.all.truncate(plan.subjects);
    let mut series = lab::measure(&mut lab, &subjects.all, &plan, args.truth.is_some(), &steps)?;
    let reference = reference(args, &series)?;
    let names: Vec<String> = subjects.all.iter().map(Subject::name).collect();
    let outcomes = outcome::outcomes(&names, &series, &reference);
    let mut notes = [&subjects.notes[..], &plan.notes].concat();
    let dropped = subjects.all.iter().zip(&outcomes).filter(|(subject, _)| subject.drops());
    let expected = Expected::of(&subjects.scene);
    notes.extend(expected.map(|expected| expected.note(&outcomes)));
    notes.extend(dropped.map(|(_, outcome)| table::dropped(outcome)));
    let mut advice = None;
    if let Some(choice) = choose::choose(&outcomes, args.target) {
        let left = args.time.map(|time| time.saturating_sub(start.elapsed()).as_secs_f64());
        let of = (&outcomes[choice.of], &subjects.all[choice.of]);
        steps.next(series.seeds, series.seeds, "verifying");
        advice = Some(advise(choice, of, (args, &subjects), (run, &mut lab), (&reference, left))?);
    }
    drop(steps);
    if run.interrupted().is_some() {
        series.is_interrupted = true;
        notes.push(format!("interrupted after {} of {} seeds", series.seeds, plan.seeds));
    }
    let against = match args.truth {
        Some(truth) => format!("a truth of {truth}"),
        None => format!(
            "the mean of {} pictures of the scene as it is, {} spp each",
            series.seeds,
            plan.reference()
        ),
    };
    let scene = &subjects.scene;
    let film = luxel_core::stage::Film::of_node(scene.film.map(|id| scene.node(id)));
    Ok(Found {
        scene: file.to_path_buf(),
        hash: blake3::Hash::from_bytes(scene.measured_hash()).to_hex().to_string(),
        size: subjects.size,
        whole: film.resolution,
        target: args.target,
        seeds: series.seeds,
        first_seed: args.seed,
        against,
        reference_error: reference.error(),
        expected,
        readings,
        notes,
        outcomes,
        advice,
        is_interrupted: series.is_interrupted,
    })
}

/// As much as there is time for.
fn plan(args: &Args, subjects: &Subjects, lab: &mut Lab<'_>) -> Result<Plan, Failure> {
    let plan = Plan::whole(args.sweep().spp, args.seeds, subjects.all.len());
    let Some(time) = args.time else { return Ok(plan) };
    let spp = plan.most();
    let cost = lab.shot(&subjects.all[0].stage, spp)?.seconds / f64::from(spp);
    let names: Vec<String> = subjects.all.iter().map(Subject::name).collect();
    Ok(plan.within(time, &names, cost))
}

fn reference(args: &Args, series: &Series) -> Result<Reference, Failure> {
    let found = if let Some(truth) = args.truth {
        let n_pixels = series.shots[0][0][0].picture.len();
        Reference::flat(truth, n_pixels)
    } else {
        let pictures: Vec<&[f32]> = series.reference.iter().map(|shot| &*shot.picture).collect();
        Reference::of(&pictures)
    };
    found.ok_or_else(|| {
        let message = "the picture is black: there is nothing that errors could be compared with";
        Failure::new(Exit::Input, message)
    })
}

/// What is recommended, verified if there is time for it.
fn advise(
    choice: Choice,
    (outcome, subject): (&Outcome, &Subject),
    (args, subjects): (&Args, &Subjects),
    (run, lab): (&Run, &mut Lab<'_>),
    (reference, left): (&Reference, Option<f64>),
) -> Result<Advice, Failure> {
    let needed = 2.0 * f64::from(choice.samples) * outcome.cost;
    let mut verified = None;
    if run.interrupted().is_none() {
        let of = (outcome, &subject.stage);
        match choose::verify(choice, of, reference, (args.target, left), lab) {
            Ok(found) => verified = found,
            Err(failure) if failure.exit == Exit::Incomplete => {}
            Err(failure) => return Err(failure),
        }
    }
    if let Some(left) = left.filter(|left| needed > *left) {
        let [needed, left] = [needed, left].map(progress::duration);
        report::warning(&format!("verifying would take {needed}, and {left} are left"));
    }
    let samples = verified.map_or(choice.samples, |verified| verified.samples);
    let registry = &run.plugins.registry;
    let sources = &subjects.loaded.sources;
    let lines =
        settings::lines(&subjects.scene, subject.change.as_ref(), samples, registry, sources);
    Ok(Advice { of: choice.of, samples, lines: lines.map_err(sweep::unfit)?, verified })
}
