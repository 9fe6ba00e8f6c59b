//! Pictures with independent random numbers, and how long they took.

use std::path::Path;
use std::time::Instant;

use luxel_core::render::Options;
use luxel_core::stage::Stage;
use luxel_sdk::color::RgbSpace;

use super::plan::{LEAST_SEEDS, Plan};
use super::sweep::{Change, Dimension};
use crate::exit::{Exit, Failure};
use crate::progress::Steps;
use crate::verify::Run;

/// A scene with one setting changed, or none.
pub(super) struct Subject {
    pub(super) change: Option<Change>,
    pub(super) stage: Stage,
}

impl Subject {
    pub(super) fn name(&self) -> String {
        self.change.as_ref().map_or_else(|| "as it is".to_owned(), Change::name)
    }

    /// Whether a feature is left out.
    pub(super) fn drops(&self) -> bool {
        self.change.as_ref().is_some_and(|change| change.dimension == Dimension::Drop)
    }
}

/// One picture.
pub(super) struct Shot {
    /// Luminance of each pixel.
    pub(super) picture: Vec<f32>,
    pub(super) seconds: f64,
    /// Samples that were not finite.
    pub(super) bad: u64,
}

/// Where pictures are made, no two with the same random numbers.
pub(super) struct Lab<'a> {
    run: &'a Run,
    /// The scene's file, for messages.
    scene: &'a Path,
    /// Of the next picture.
    seed: u32,
}

impl<'a> Lab<'a> {
    pub(super) fn new(run: &'a Run, scene: &'a Path, seed: u32) -> Self {
        Self { run, scene, seed }
    }

    /// A picture with other random numbers than those before.
    ///
    /// # Errors
    /// Ctrl-C; what rendering says.
    pub(super) fn shot(&mut self, stage: &Stage, spp: u32) -> Result<Shot, Failure> {
        let seed = Some(self.seed);
        self.seed = self.seed.wrapping_add(1);
        let options = Options { spp: Some(spp), seed, ..self.run.options.clone() };
        let start = Instant::now();
        let film = self.run.film((self.scene, stage), &options)?;
        let seconds = start.elapsed().as_secs_f64();
        let weights = RgbSpace::LinearSrgb.luminance_weights();
        #[expect(clippy::cast_possible_truncation, reason = "far below the noise")]
        let picture = film.pixels().map(|(_, pixel)| weights.dot(pixel.mean) as f32).collect();
        Ok(Shot { picture, seconds, bad: film.bad_samples() })
    }
}

/// All that was measured.
pub(super) struct Series {
    /// Numbers of samples, rising.
    pub(super) spp: Vec<u32>,
    /// By subject, number of samples and round.
    pub(super) shots: Vec<Vec<Vec<Shot>>>,
    /// Of the reference, by round; none where the truth is known.
    pub(super) reference: Vec<Shot>,
    /// Rounds.
    pub(super) seeds: usize,
    /// Whether Ctrl-C ended it.
    pub(super) is_interrupted: bool,
}

/// Measures in rounds, each of which sees every subject: what slows the machine slows all alike.
///
/// # Errors
/// What rendering says; Ctrl-C before the fewest rounds that tell something.
pub(super) fn measure(
    lab: &mut Lab<'_>,
    subjects: &[Subject],
    plan: &Plan,
    is_truth_known: bool,
    steps: &Steps,
) -> Result<Series, Failure> {
    let each = |_: &Subject| plan.spp.iter().map(|_| vec![]).collect();
    let mut series = Series {
        spp: plan.spp.clone(),
        shots: subjects.iter().map(each).collect(),
        reference: vec![],
        seeds: 0,
        is_interrupted: false,
    };
    while series.seeds < plan.seeds as usize {
        let told = format!("rounds over {} configurations", subjects.len());
        steps.next(series.seeds, plan.seeds as usize, &told);
        match round(lab, subjects, plan, is_truth_known) {
            Ok((shots, reference)) => {
                for (all, new) in series.shots.iter_mut().flatten().zip(shots) {
                    all.push(new);
                }
                series.reference.extend(reference);
                series.seeds += 1;
            }
            Err(failure) => {
                let enough = series.seeds >= LEAST_SEEDS as usize;
                series.is_interrupted = enough && failure.exit == Exit::Incomplete;
                if series.is_interrupted {
                    break;
                }
                return Err(failure);
            }
        }
    }
    Ok(series)
}

/// A picture of each subject at each number of samples, and one of the reference.
fn round(
    lab: &mut Lab<'_>,
    subjects: &[Subject],
    plan: &Plan,
    is_truth_known: bool,
) -> Result<(Vec<Shot>, Option<Shot>), Failure> {
    let mut shots = vec![];
    for subject in subjects {
        for spp in &plan.spp {
            shots.push(lab.shot(&subject.stage, *spp)?);
        }
    }
    let base = subjects.first().filter(|_| !is_truth_known);
    let reference = base.map(|base| lab.shot(&base.stage, plan.reference())).transpose()?;
    Ok((shots, reference))
}
