//! What asking for an error or a time gives: what is said of it, and what is true.

use std::path::Path;
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_core::files::MemoryFiles;
use luxel_core::film::{Errors, Film};
use luxel_core::render::{Control, Goal, Options, render};
use luxel_core::stage::{self, Stage};
use luxel_sdk::color::RgbSpace;

use super::Form;
use crate::process::read;
use crate::scene::{linked, scene_in};

/// Of that picture; the scenes have others.
const SEED: u32 = 77;
/// Side of a tile, pixels.
const TILE: u32 = 16;
/// Share of the mean that a darker pixel's error is compared with, as `luxel render --error`.
const DARK: f64 = 0.1;

/// What is rendered.
struct Run {
    /// What is asked for: an error and a time.
    error: f64,
    time: Duration,
    size: UVec2,
    /// Of the picture that counts as the truth.
    spp: u32,
}

/// Name, file, and the files that it reads.
pub(super) const SCENES: [(&str, &str, &[&str]); 3] = [
    ("Cornell box", "cornell.scene", &["cornell/reflectance.csv"]),
    (
        "Spot",
        "spot.scene",
        &[
            "assets/spot/spot_texture.png",
            "assets/spot/spot_triangulated.obj",
            "assets/hdri/studio.hdr",
        ],
    ),
    ("Caustic", "caustic.scene", &[]),
];

/// # Errors
/// A scene that does not build.
pub(super) fn table(root: &Path, form: Form) -> Result<String, String> {
    let run = Run {
        error: form.pick(0.05, 0.3),
        time: form.pick(Duration::from_secs(2), Duration::from_millis(20)),
        size: UVec2::splat(form.pick(96, 32)),
        spp: form.pick(2048, 64),
    };
    let mut rows = vec![
        "| asked | took | samples of a pixel, mean | said | true | worst tile | evenly: true | evenly: worst tile |"
            .to_owned(),
        "|---|---|---|---|---|---|---|---|".to_owned(),
    ];
    for (name, file, assets) in SCENES {
        let stage = stage_of(&root.join("scenes"), (file, assets), run.size)?;
        let truth = Options { spp: Some(run.spp), seed: Some(SEED), ..Options::default() };
        let truth = render(&stage, &truth, &Control::default()).0;
        let error = Goal { error: Some(run.error), time: None };
        let asked = format!("{name}, {:.0} %", run.error * 100.0);
        rows.push(format!("| {asked} | {} |", run.row(&stage, error, &truth)));
        let time = Goal { error: None, time: Some(run.time) };
        let asked = format!("{name}, {} s", run.time.as_secs_f64());
        rows.push(format!("| {asked} | {} |", run.row(&stage, time, &truth)));
    }
    Ok(rows.join("\n"))
}

/// One of the scenes in a folder, of that size.
///
/// # Errors
/// A scene that does not build.
pub(super) fn stage_of(
    folder: &Path,
    (file, assets): (&str, &[&str]),
    size: UVec2,
) -> Result<Stage, String> {
    let mut files = MemoryFiles::default().with("a.scene", &*read(&folder.join(file))?);
    for asset in assets {
        files = files.with(*asset, &*read(&folder.join(asset))?);
    }
    let mut scene = scene_in(&linked(), &files)?;
    scene.set_resolution(size);
    let built = stage::build(&scene, &linked(), &files, None);
    built.map(|built| built.stage).map_err(|found| format!("{found:?}"))
}

impl Run {
    fn row(&self, stage: &Stage, goal: Goal, truth: &Film) -> String {
        let picture = |options: Options| render(stage, &options, &Control::default()).0;
        let start = Instant::now();
        let asked = picture(Options { goal, ..Options::default() });
        let took = start.elapsed().as_secs_f64();
        let counts: Vec<u32> = asked.pixels().map(|(_, pixel)| pixel.n).collect();
        let (least, most) = (counts.iter().min(), counts.iter().max());
        let total: u64 = counts.iter().map(|n| u64::from(*n)).sum();
        let mean = u32::try_from(total / counts.len() as u64).unwrap_or(u32::MAX);
        let evenly = picture(Options { spp: Some(mean), ..Options::default() });
        let said = Errors::of_film(&asked, self.error).map_or(f64::NAN, |errors| errors.rms);
        let [(rms, worst), (even_rms, even_worst)] =
            [&asked, &evenly].map(|film| self.off(film, truth));
        let [said, rms, worst, even_rms, even_worst] =
            [said, rms, worst, even_rms, even_worst].map(|share| format!("{:.1} %", share * 100.0));
        let [least, most] = [least, most].map(|n| n.copied().unwrap_or_default());
        format!(
            "{took:.2} s | {least} to {most}, {mean} | {said} | {rms} | {worst} | {even_rms} | {even_worst}"
        )
    }

    /// Relative error of a picture, root mean square: of all, and of the worst tile.
    fn off(&self, film: &Film, truth: &Film) -> (f64, f64) {
        let weights = RgbSpace::LinearSrgb.luminance_weights();
        let n = f64::from(self.size.x) * f64::from(self.size.y);
        let dark = DARK * truth.pixels().map(|(_, pixel)| weights.dot(pixel.mean)).sum::<f64>() / n;
        let side = self.size / TILE;
        let mut tiles = vec![0.0; (side.x * side.y) as usize];
        for ((at, own), (_, true_pixel)) in film.pixels().zip(truth.pixels()) {
            let [own, right] = [own, true_pixel].map(|pixel| weights.dot(pixel.mean));
            let tile = at / TILE;
            tiles[(tile.y * side.x + tile.x) as usize] += ((own - right) / right.max(dark)).powi(2);
        }
        let whole = (tiles.iter().sum::<f64>() / n).sqrt();
        let worst = tiles.iter().copied().fold(0.0, f64::max) / f64::from(TILE * TILE);
        (whole, worst.sqrt())
    }
}
