//! What every plugin of a kind must satisfy.
//!
//! The suite knows no plugin by name: it makes objects from a class's schema and judges them
//! through the traits of the SDK, so that a plugin is covered by existing. Statistical checks have
//! fixed seeds and one stated significance for a whole run ([`SIGNIFICANCE`]).

mod any;
mod camera;
mod cells;
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
mod sampler;
mod shape;
mod statistics;
mod subject;
mod sweep;
mod texture;
mod values;

pub mod mutants;

use std::panic::{AssertUnwindSafe, catch_unwind};

use luxel_core::registry::Registry;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::sampling::hash_combine64;

use report::Judge;
use subject::Subject;
use sweep::Bench;

pub use reference::CLASSES as REFERENCE_CLASSES;
pub use report::{Report, Row, Verdict};
pub use statistics::SIGNIFICANCE;

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Equal seeds give equal reports.
    pub seed: u64,
    /// Samples for each statistic.
    pub samples: u32,
    /// Random parameter sets of each class, besides those at the ends of its ranges.
    pub sets: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 0x5eed, samples: 16_384, sets: 6 }
    }
}

/// Judges the classes of a registry that `pick` chooses. Settings without behaviour (the film) are
/// not plugins and are left out.
///
/// A panic of a plugin is caught and fails it; an endless loop is not.
pub fn run(registry: &Registry, pick: impl Fn(&Class) -> bool, options: &Options) -> Report {
    let bench = Bench::new(registry);
    let classes = registry.all().map(|entry| entry.class);
    let chosen = classes.filter(|class| class.kind != Kind::Film && pick(class));
    Report::of(chosen.map(|class| judge(&bench, class, options)).collect())
}

fn judge(bench: &Bench, class: Class, options: &Options) -> Judge {
    let mut judge = Judge::new(&class);
    let caught = catch_unwind(AssertUnwindSafe(|| {
        any::describes_itself(&class, &mut judge);
        any::refuses_what_is_out_of_range(bench, &class, &mut judge);
        let name = class.name.bytes().fold(options.seed, |h, b| hash_combine64(h, u64::from(b)));
        match bench.sets(&class, name, options.sets) {
            Ok(sets) => {
                let subject = Subject { bench, class, sets, options: *options };
                by_kind(&subject, &mut judge);
            }
            Err(why) => judge.skip("parameters", why),
        }
    }));
    let message = caught.err().map(|payload| {
        let text = payload.downcast_ref::<String>().cloned();
        text.or(payload.downcast_ref::<&str>().map(|text| (*text).to_owned())).unwrap_or_default()
    });
    judge.holds("never panics", message.is_none(), || message.unwrap_or_default());
    judge
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
        Kind::Integrator => integrator::judge(subject, judge),
        Kind::Importer => importer::judge(subject, judge),
        Kind::Film => {}
    }
}
