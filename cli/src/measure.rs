//! One render: progress, the end by Ctrl-C, panics told with the scene's name.

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_core::film::{Film, Rect};
use luxel_core::render::{Control, Look, Options, Outcome, Reached, render_seen};
use luxel_core::stage::Stage;

use crate::errors::Errors;
use crate::exit::{Exit, Failure, blaming};
use crate::progress;

/// Pixels of one film, at most: 56 bytes each, 7.5 GB.
const MAX_PIXELS: usize = 1 << 27;

/// Between two looks at how wrong the picture is, for the line.
const PACE: Duration = Duration::from_secs(1);

/// A film with what it took.
pub(crate) struct Measured {
    pub(crate) film: Film,
    pub(crate) outcome: Outcome,
    pub(crate) seconds: f64,
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
    if window.area() > MAX_PIXELS {
        let message = format!("{} x {} pixels are too many at once", window.size.x, window.size.y);
        return Err(Failure::new(Exit::Input, message)
            .help(format!("at most {MAX_PIXELS}; render parts with --crop X,Y,W,H")));
    }
    Ok(window)
}

/// Renders, with a line of progress if wanted; `look` sees the picture grow.
///
/// # Errors
/// As `window`; a panic in the renderer or a plugin, with the scene's name.
pub(crate) fn measure(
    (scene, stage): (&Path, &Stage),
    options: &Options,
    control: &Control,
    line: bool,
    look: &mut Look<'_>,
) -> Result<Measured, Failure> {
    let window = window(stage, options)?;
    let total = window.area() as u64 * u64::from(options.samples(stage));
    let start = Instant::now();
    let (shown, error) = (progress::is_shown(line), Mutex::new(None));
    let mut told = start;
    let mut seen = |film: &Film, now: Reached| {
        if shown && now.samples >= 2 && told.elapsed() >= PACE {
            let found = Errors::about(film).map(|errors| errors.median);
            *error.lock().unwrap_or_else(PoisonError::into_inner) = found;
            told = Instant::now();
        }
        look(film, now);
    };
    let rendered = blaming(&scene.display().to_string(), || {
        let told = |seconds| {
            let error = *error.lock().unwrap_or_else(PoisonError::into_inner);
            progress::line(control.samples_done(), total, error, seconds)
        };
        progress::shown_while(told, line, || render_seen(stage, options, control, &mut seen))
    });
    let (film, outcome) = rendered?;
    Ok(Measured { film, outcome, seconds: start.elapsed().as_secs_f64() })
}
