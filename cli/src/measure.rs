//! One render: progress, the end by Ctrl-C, panics told with the scene's name.

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_core::film::{Errors, Film, Rect};
use luxel_core::render::{
    Control, Look, Options, Outcome, Reached, bytes_of_pixel, empty_film, render_on,
};
use luxel_core::stage::Stage;

use crate::exit::{Exit, Failure, blaming};
use crate::progress;

/// Bytes of one film, at most.
const MOST_BYTES: usize = 12 << 30;

/// Between two looks at how wrong the picture is, for the line.
const PACE: Duration = Duration::from_secs(1);

/// A film with what it took.
pub(crate) struct Measured {
    pub(crate) film: Film,
    pub(crate) outcome: Outcome,
    pub(crate) seconds: f64,
}

impl Measured {
    /// Whether all samples that were wanted were taken.
    pub(crate) fn is_whole(&self) -> bool {
        self.outcome == Outcome::Complete
    }
}

/// What will be measured, checked.
///
/// # Errors
/// A crop outside the picture, or more pixels than memory should hold.
pub(crate) fn window(stage: &Stage, options: &Options) -> Result<Rect, Failure> {
    let size = stage.film.resolution;
    let whole = Rect::new(UVec2::ZERO, size);
    let window = options.crop.unwrap_or(whole).intersection(whole);
    if window.area() == 0 {
        let message = format!("the crop lies outside the picture of {} x {}", size.x, size.y);
        return Err(Failure::new(Exit::Usage, message));
    }
    let most = MOST_BYTES / bytes_of_pixel(stage);
    if window.area() > most {
        let message = format!("{} x {} pixels are too many at once", window.size.x, window.size.y);
        return Err(Failure::new(Exit::Input, message)
            .help(format!("at most {most}; render parts with --crop X,Y,W,H")));
    }
    Ok(window)
}

/// An empty film for what will be measured.
///
/// # Errors
/// As `window`.
pub(crate) fn empty(stage: &Stage, options: &Options) -> Result<Film, Failure> {
    Ok(empty_film(stage, window(stage, options)?))
}

/// Renders on a film, with a line of progress if wanted; `look` sees the picture grow.
///
/// # Errors
/// A panic in the renderer or a plugin, with the scene's name.
pub(crate) fn measure(
    (scene, stage): (&Path, &Stage),
    mut film: Film,
    options: &Options,
    control: &Control,
    line: bool,
    look: &mut Look<'_>,
) -> Result<Measured, Failure> {
    let start = Instant::now();
    let shown = progress::is_shown(line);
    let at_first = film.window.area() as u64 * u64::from(options.samples_at_first(stage));
    let total = at_first.saturating_sub(film.samples());
    let reached = Mutex::new(Standing { total, error: None });
    let standing = || *reached.lock().unwrap_or_else(PoisonError::into_inner);
    let mut told = start;
    let mut seen = |film: &Film, now: Reached| {
        if shown && now.is_whole {
            let mut found = Standing { total: control.samples_done() + now.left, ..standing() };
            if now.samples >= 2 && told.elapsed() >= PACE {
                found.error = Errors::about(film).map(|errors| errors.median);
                told = Instant::now();
            }
            *reached.lock().unwrap_or_else(PoisonError::into_inner) = found;
        }
        look(film, now);
    };
    let rendered = blaming(&scene.display().to_string(), || {
        let told = |seconds| {
            let Standing { total, error } = standing();
            let time = options.goal.time.map(|time| time.as_secs_f64());
            progress::line((control.samples_done(), total), error, (seconds, time))
        };
        let work = || render_on(&mut film, stage, options, control, &mut seen);
        progress::shown_while(told, line, work)
    });
    let outcome = rendered?;
    Ok(Measured { film, outcome, seconds: start.elapsed().as_secs_f64() })
}

/// How far a render is.
#[derive(Clone, Copy)]
struct Standing {
    /// Samples in the end, as far as one can tell.
    total: u64,
    /// Median of the pixels' relative errors.
    error: Option<f64>,
}
