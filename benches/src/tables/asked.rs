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

/// Of the pictures that count as the truth; the scenes have others.
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
    /// How many times the samples of a picture the one has that counts as its truth.
    times: u32,
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
        times: form.pick(16, 4),
    };
    let mut rows = vec![
        run.about_truths(),
        "| asked | took | samples of a pixel, mean | said | true | worst tile | evenly: true | evenly: worst tile |"
            .to_owned(),
        "|---|---|---|---|---|---|---|---|".to_owned(),
    ];
    for (name, file, assets) in SCENES {
        let stage = stage_of(&root.join("scenes"), (file, assets), run.size)?;
        let error = Goal { error: Some(run.error), ..Goal::default() };
        let asked = format!("{name}, {:.0} %", run.error * 100.0);
        rows.push(format!("| {asked} | {} |", run.row(&stage, error)));
        let time = Goal { time: Some(run.time), ..Goal::default() };
        let asked = format!("{name}, {} s", run.time.as_secs_f64());
        rows.push(format!("| {asked} | {} |", run.row(&stage, time)));
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
    fn row(&self, stage: &Stage, goal: Goal) -> String {
        let picture = |options: Options| render(stage, &options, &Control::default()).0;
        let truth = picture(self.truth(goal));
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
            [&asked, &evenly].map(|film| self.off(film, &truth));
        let [said, rms, worst, even_rms, even_worst] =
            [said, rms, worst, even_rms, even_worst].map(|share| format!("{:.1} %", share * 100.0));
        let [least, most] = [least, most].map(|n| n.copied().unwrap_or_default());
        format!(
            "{took:.2} s | {least} to {most}, {mean} | {said} | {rms} | {worst} | {even_rms} | {even_worst}"
        )
    }

    /// What the table says of what it calls true.
    fn about_truths(&self) -> String {
        let (times, root) = (self.times, f64::from(self.times).sqrt());
        format!(
            "True is what a picture of another seed shows, with about {times} times the samples: 1/{root} of the error was asked\n\
             for, or {times} times the time. Its own noise, about 1/{root} of that of the picture it judges, is in these numbers.\n"
        )
    }

    /// How the picture is made that counts as the truth of one with that goal. Errors fall with the root
    /// of the number of samples.
    fn truth(&self, goal: Goal) -> Options {
        let error = goal.error.map(|error| error / f64::from(self.times).sqrt());
        let time = goal.time.map(|time| time * self.times);
        Options { goal: Goal { error, time, ..goal }, seed: Some(SEED), ..Options::default() }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::stage_of;

    /// A plane below a disk that shines and a sky, looked for by chance: the same noise all over.
    const PLANE: &str = "scene 1
        camera orthographic { look = look_at(from = (0, 0, 9) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 1 m }
        film rgb { resolution = (16, 16) }
        sampler independent {}
        integrator path { light_sampling = false }
        light constant { scale = 1 }
        light area { shape = shape disk { center = (0, 0, 20) m, normal = (0, 0, -1), radius = 20 m }, radiance = 1 W/m^2/sr }
        shape plane { point = (0, 0, 0) m, normal = (0, 0, 1), material = material diffuse { reflectance = 0.5 } }";

    #[test]
    fn a_truth_has_sixteen_times_the_samples_of_what_is_judged_by_it() {
        let stage = stage_of(&linked(), PLANE).unwrap();
        let (size, time) = (UVec2::splat(16), Duration::from_secs(2));
        let run = Run { error: 0.01, time, size, times: 16 };
        let mean = |options: Options| {
            let film = render(&stage, &options, &Control::default()).0;
            let total: u64 = film.pixels().map(|(_, pixel)| u64::from(pixel.n)).sum();
            total as f64 / 256.0
        };
        let goal = Goal { error: Some(run.error), ..Goal::default() };
        let judged = mean(Options { goal, ..Options::default() });
        let ratio = mean(run.truth(goal)) / judged;
        assert!(judged > 64.0 && (12.0..20.0).contains(&ratio), "{ratio} times {judged}");
        let timed = run.truth(Goal { time: Some(time), ..Goal::default() });
        assert_eq!((timed.goal.time, timed.seed), (Some(Duration::from_secs(32)), Some(SEED)));
    }
}
