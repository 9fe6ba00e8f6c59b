//! What every plugin of a kind must satisfy.
//!
//! The suite knows no plugin by name: it makes objects from a class's schema and judges them
//! through the traits of the SDK, so that a plugin is covered by existing. Statistical checks have
//! fixed seeds and one stated significance for a whole run ([`SIGNIFICANCE`]).

mod any;
mod camera;
mod cells;
mod convergence;
mod endurance;
mod files;
mod filter;
mod importer;
mod integrator;
mod light;
mod lobes;
mod material;
mod medium;
mod phase;
mod reference;
mod report;
mod reversal;
mod sampler;
mod shape;
mod statistics;
mod subject;
mod sweep;
mod texture;
mod values;

pub mod mutants;

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};

use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::sampling::hash_combine64;

use report::Judge;
use subject::Subject;
use sweep::{Bench, Tried, Unmade};

pub use endurance::Memory;
pub use reference::CLASSES as REFERENCE_CLASSES;
pub use report::{Report, Row, Verdict};
pub use statistics::SIGNIFICANCE;

/// The check that is skipped when no object of a class can be made.
const UNMADE: &str = "parameters";
/// The check that is skipped when some parameters were refused whatever they were.
const UNTRIED: &str = "every parameter is tried";
/// Whether code of a library gave what no plugin may.
const FAILS: &str = "never ends a render";
/// Whether code of a plugin panicked.
const PANICS: &str = "never panics";

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Equal seeds give equal reports.
    pub seed: u64,
    /// Samples for each statistic.
    pub samples: u32,
    /// Random parameter sets of each class, besides those at the ends of its ranges.
    pub sets: usize,
    /// Where to look whether objects leave memory behind; nothing is said about it without. Other
    /// work of the process must not disturb it.
    pub memory: Option<Memory>,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 0x5eed, samples: 16_384, sets: 6, memory: None }
    }
}

/// Judges the classes of a registry that `pick` chooses. Settings without behaviour (the film) are
/// not plugins and are left out.
///
/// A panic of a plugin is caught and fails it; an endless loop is not.
pub fn run(registry: &Registry, pick: impl Fn(&Class) -> bool, options: &Options) -> Report {
    run_while(registry, pick, options, |_| ControlFlow::Continue(()))
}

/// A class is about to be judged.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The class.
    pub class: Class,
    /// Classes that have been judged.
    pub done: usize,
    /// Classes that were chosen, this one among them.
    pub total: usize,
}

/// As [`run`], asking `next` before each class; `Break` ends the run with what was judged so far.
pub fn run_while(
    registry: &Registry,
    pick: impl Fn(&Class) -> bool,
    options: &Options,
    mut next: impl FnMut(Step) -> ControlFlow<()>,
) -> Report {
    let bench = Bench::new(registry);
    let classes = registry.all().map(|entry| entry.class);
    let chosen: Vec<_> = classes.filter(|c| c.kind != Kind::Film && pick(c)).collect();
    let total = chosen.len();
    let steps = chosen.into_iter().enumerate().map(|(done, class)| Step { class, done, total });
    let wanted = steps.map_while(|step| next(step).is_continue().then_some(step.class));
    Report::of(wanted.map(|class| judge(&bench, class, options)).collect())
}

fn judge(bench: &Bench, class: Class, options: &Options) -> Judge {
    let mut judge = Judge::new(&class);
    let caught = catch_unwind(AssertUnwindSafe(|| {
        any::describes_itself(&class, &mut judge);
        any::refuses_what_is_out_of_range(bench, &class, &mut judge);
        let name = class.name.bytes().fold(options.seed, |h, b| hash_combine64(h, u64::from(b)));
        match bench.sets(&class, name, options.sets) {
            Ok(Tried { sets, failed, untried }) => {
                if !untried.is_empty() {
                    judge.skip(UNTRIED, untried.join("; "));
                }
                for told in failed {
                    fails(&told, &mut judge);
                }
                let mut subject = Subject { bench, class, sets, options: *options };
                while_sound(&mut subject, &mut judge);
                endurance::judge(&subject, &mut judge);
                judge.holds(FAILS, true, String::new);
            }
            Err(Unmade { why, failed }) => {
                if failed {
                    fails(&why, &mut judge);
                }
                judge.skip(UNMADE, why);
            }
        }
    }));
    let message = caught.err().map(|payload| {
        let text = payload.downcast_ref::<String>().cloned();
        text.or(payload.downcast_ref::<&str>().map(|text| (*text).to_owned())).unwrap_or_default()
    });
    judge.holds(PANICS, message.is_none(), || message.unwrap_or_default());
    judge
}

/// Code of a library failed: it panicked, or gave what no plugin may.
fn fails(told: &str, judge: &mut Judge) {
    let check = if told.contains(" panicked") { PANICS } else { FAILS };
    judge.holds(check, false, || told.to_owned());
}

/// Judges the objects that do not fail. One that did answers for the plugin no more, so that what
/// was found of it, good or bad, says nothing: the others are judged again without it.
fn while_sound(subject: &mut Subject<'_>, judge: &mut Judge) {
    let mut checks = vec![];
    for _ in 0..2 {
        if subject.sets.is_empty() {
            break;
        }
        let mut found = judge.fresh();
        by_kind(subject, &mut found);
        let all = subject.sets.len();
        subject.sets.retain(|set| {
            let failure = set.object.failure();
            if let Some(told) = &failure {
                fails(&format!("{}: {told}", set.label), judge);
            }
            failure.is_none()
        });
        checks.extend(found.checks());
        if subject.sets.len() == all {
            judge.join(found);
            break;
        }
    }
    for check in checks {
        judge.skip_untried(check, "the plugin failed before it could be tried");
    }
}

fn by_kind(subject: &Subject<'_>, judge: &mut Judge) {
    match subject.class.kind {
        Kind::Shape => shape::judge(subject, judge),
        Kind::Material => material::judge(subject, judge),
        Kind::Texture => texture::judge(subject, judge),
        Kind::Light => light::judge(subject, judge),
        Kind::Medium => medium::judge(subject, judge),
        Kind::Phase => phase::judge(subject, judge),
        Kind::Camera => camera::judge(subject, judge),
        Kind::Sampler => sampler::judge(subject, judge),
        Kind::Filter => filter::judge(subject, judge),
        Kind::Integrator => {
            integrator::judge(subject, judge);
            convergence::judge(subject, judge);
        }
        Kind::Importer => importer::judge(subject, judge),
        Kind::Film => {}
    }
}

#[cfg(test)]
mod tests {
    use luxel_sdk::Params;
    use luxel_sdk::kind::Filter;
    use luxel_sdk::params::Fault;

    use super::*;

    /// A filter that takes its default alone.
    #[derive(Params, Clone, Copy)]
    #[repr(C)]
    struct Stubborn {
        /// Half the width, pixels.
        #[param(default = 0.5, min = 0.1, max = 16)]
        radius: f32,
    }

    impl Filter for Stubborn {
        fn check(&self) -> Result<(), Fault> {
            let told = || Fault::range("radius", "half a pixel or nothing");
            ((self.radius - 0.5).abs() <= 0.0).then_some(()).ok_or_else(told)
        }
        fn radius(&self) -> f32 {
            self.radius
        }
        fn eval(&self, offset: [f32; 2]) -> f32 {
            if offset.iter().all(|x| x.abs() <= 0.5) { 1.0 } else { 0.0 }
        }
        fn sample(&self, u: [f32; 2]) -> [f32; 2] {
            u.map(|u| u - 0.5)
        }
    }

    #[test]
    fn a_parameter_that_is_refused_whatever_it_is_is_told() {
        let mut registry = Registry::new();
        registry.add("tests", &[Class::filter::<Stubborn>("stubborn")]).unwrap();
        let options = Options { samples: 512, sets: 1, ..Options::default() };
        let report = run(&registry, |class| class.name == "stubborn", &options);
        let told = report.skipped().find(|(row, _)| row.check == UNTRIED);
        let (_, why) = told.unwrap_or_else(|| panic!("{report}"));
        assert!(why.starts_with("radius = ") && why.ends_with("half a pixel or nothing"), "{why}");
    }

    #[test]
    fn a_run_that_is_ended_keeps_what_was_judged() {
        let mut registry = Registry::new();
        registry.add("conformance", REFERENCE_CLASSES).unwrap();
        let pick = |class: &Class| [Kind::Filter, Kind::Texture].contains(&class.kind);
        let options = Options { samples: 512, sets: 1, ..Options::default() };
        let mut asked = vec![];
        let report = run_while(&registry, pick, &options, |step| {
            asked.push((step.class.name, step.done, step.total));
            if step.done == 1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!((asked[0].1, asked[0].2, asked.len()), (0, 2, 2));
        assert!(!report.rows.is_empty(), "the first class was judged");
        assert!(report.rows.iter().all(|row| row.class == asked[0].0), "{report}");
    }
}
