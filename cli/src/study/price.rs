//! What features cost in one scene: pictures with and without each, in turns.

use std::path::Path;

use luxel_core::scene::{Feature, Scene};
use luxel_core::stage::Stage;

use super::lab::Lab;
use super::outcome::quartiles;
use super::subjects::{rebuilt, small};
use crate::exit::{Exit, Failure};
use crate::load::Loaded;
use crate::progress::Steps;
use crate::verify::Run;

/// Rounds, each of which sees the scene as it is and with every feature changed.
const ROUNDS: usize = 9;
/// Least time of a picture, seconds: what is shorter says more of the machine than of the scene.
const LEAST: f64 = 0.1;
/// Samples of a picture are not more.
const MOST_SPP: u32 = 1 << 12;

/// What a feature costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Price {
    pub(crate) feature: Feature,
    /// Time with the feature over time without: lower quartile, median, upper quartile.
    pub(crate) ratio: [f64; 3],
}

/// The price of every feature that the scene requires and could do without, or whose code could be left out,
/// and of every other whose code could run for nothing.
///
/// # Errors
/// Ctrl-C; what building and rendering say.
pub(crate) fn prices(
    (file, scene): (&Path, &Scene),
    stage: &Stage,
    loaded: &Loaded,
    run: &Run,
) -> Result<Vec<Price>, Failure> {
    let mut base = scene.clone();
    base.set_resolution(small(stage.film.resolution));
    let build = |scene: &Scene| {
        let built = rebuilt((file, scene), loaded, run, stage)?;
        built.map_err(|message| Failure::new(Exit::Input, message))
    };
    let others: Vec<(Feature, Scene)> =
        Feature::ALL.into_iter().filter_map(|feature| changed(&base, stage, feature)).collect();
    let other = |(feature, scene): &(Feature, Scene)| {
        let mut other = build(scene)?;
        // Still modelled, as it cannot be dropped.
        other.run_without(*feature);
        Ok(other)
    };
    let built = others.iter().map(other).collect::<Result<Vec<Stage>, Failure>>()?;
    let all: Vec<Stage> = std::iter::once(build(&base)?).chain(built).collect();
    let times = timed(&mut Lab::new(run, file, 0), &all)?;
    let price = |(i, (feature, _)): (usize, &(Feature, Scene))| {
        let ratios = times.iter().map(|round| {
            let ratio = round[i + 1] / round[0];
            if stage.needs(*feature) { 1.0 / ratio } else { ratio }
        });
        Price { feature: *feature, ratio: quartiles(ratios.collect()) }
    };
    Ok(others.iter().enumerate().map(price).collect())
}

/// The scene without a feature that it requires, or with the code of one that it does not.
fn changed(base: &Scene, stage: &Stage, feature: Feature) -> Option<(Feature, Scene)> {
    let mut scene = base.clone();
    let is_changed = if stage.needs(feature) {
        scene.leave_out(feature).is_ok() || stage.may_run_without(feature)
    } else {
        !stage.has(feature) && scene.require(feature).is_ok()
    };
    is_changed.then_some((feature, scene))
}

/// Seconds of each stage, by round.
fn timed(lab: &mut Lab<'_>, stages: &[Stage]) -> Result<Vec<Vec<f64>>, Failure> {
    let mut spp = 4;
    while spp < MOST_SPP && lab.shot(&stages[0], spp)?.seconds < LEAST {
        spp *= 2;
    }
    let steps = Steps::new();
    let round = |round| {
        steps.next(round, ROUNDS, "timing features");
        stages.iter().map(|stage| lab.shot(stage, spp).map(|shot| shot.seconds)).collect()
    };
    (0..ROUNDS).map(round).collect()
}
