//! From a save to what is seen of it.

use std::time::{Duration, Instant};

use luxel_sdk::sampling::Rng;

use super::client::{Watching, What};
use super::subject::{Kind, Subject, Way};
use crate::series::Series;

/// Edits of each kind.
const ROUNDS: usize = 24;
/// So long after an edit of a comment nothing may begin.
const STILL: Duration = Duration::from_millis(300);
/// What the page is told when a save is noticed.
const NOTICED: &str = "reading";

/// Milliseconds from saves of one kind.
#[derive(Default)]
struct Times {
    noticed: Vec<f64>,
    coarse: Vec<f64>,
    whole: Vec<f64>,
    /// Mistakes that were shown before the picture: half a file, taken for the whole.
    mistakes: usize,
}

/// Edits everything in turn and prints how long each took to be seen.
///
/// # Errors
/// The program's words; an edit of a comment that begins a picture.
pub(super) fn run(watching: &Watching, subject: &mut Subject) -> Result<(), String> {
    let mut generation = first(watching)?;
    let mut times: [Times; Kind::ALL.len()] = Default::default();
    let mut rng = Rng::new(9);
    for round in 0..ROUNDS {
        for (i, kind) in Kind::ALL.into_iter().enumerate() {
            // Anywhere between two pictures.
            let pause = 50.0 + 200.0 * rng.f64();
            watching.until(Instant::now() + Duration::from_secs_f64(pause / 1e3)).for_each(drop);
            let way = if (round + i).is_multiple_of(2) { Way::InPlace } else { Way::Renamed };
            let saved = subject.edit(kind, way)?;
            let times = &mut times[i];
            if kind == Kind::Comment {
                comment(watching, (saved, generation), times)?;
            } else {
                generation = follow(watching, (saved, generation), times)?;
            }
        }
    }
    println!(
        "{:<30}{:>4}{:>24}{:>24}{:>24}",
        "edit, p50 / p95 / p99 ms", "n", "noticed", "coarse", "1 spp"
    );
    let mistakes: usize = times.iter().map(|times| times.mistakes).sum();
    for (kind, times) in Kind::ALL.into_iter().zip(times) {
        let n = times.noticed.len();
        let columns = [times.noticed, times.coarse, times.whole].map(|ms| told(&Series::from(ms)));
        let [noticed, coarse, whole] = columns;
        println!("{:<30}{n:>4}{noticed:>24}{coarse:>24}{whole:>24}", kind.name());
    }
    println!("mistakes shown on the way: {mistakes}");
    println!("goals: noticed p99 10; coarse p50 33, p95 60 of camera, material and transform");
    Ok(())
}

/// Makes edits of one kind, each up to so many seconds after the picture before, and prints how long
/// they took to be seen.
///
/// # Errors
/// The program's words.
pub(super) fn alike(
    watching: &Watching,
    what: &str,
    pause: f64,
    mut edit: impl FnMut() -> Result<Instant, String>,
) -> Result<(), String> {
    let mut generation = first(watching)?;
    let (mut times, mut rng) = (Times::default(), Rng::new(10));
    for _ in 0..ROUNDS {
        let pause = pause * rng.f64();
        watching.until(Instant::now() + Duration::from_secs_f64(pause)).for_each(drop);
        let saved = edit()?;
        generation = follow(watching, (saved, generation), &mut times)?;
    }
    let columns = [times.noticed, times.coarse, times.whole].map(|ms| told(&Series::from(ms)));
    let [noticed, coarse, whole] = columns;
    println!("{what}: noticed {noticed}, coarse {coarse}, 1 spp {whole}");
    Ok(())
}

fn told(ms: &Series) -> String {
    format!("{:.1} / {:.1} / {:.1}", ms.percentile(50), ms.percentile(95), ms.percentile(99))
}

/// Waits for a whole first picture; the number of its edit.
fn first(watching: &Watching) -> Result<u64, String> {
    loop {
        if let What::Picture { generation, step: 1, .. } = watching.next()?.what {
            return Ok(generation);
        }
    }
}

/// Waits until every pixel has a sample of the new scene; the number of its edit.
fn follow(
    watching: &Watching,
    (saved, before): (Instant, u64),
    times: &mut Times,
) -> Result<u64, String> {
    let (mut noticed, mut coarse) = (None, None);
    loop {
        let told = watching.next()?;
        let ms = told.at.saturating_duration_since(saved).as_secs_f64() * 1e3;
        match told.what {
            What::Status(status) if status == NOTICED && told.at >= saved => {
                noticed.get_or_insert(ms);
            }
            What::Problems(n) => times.mistakes += n,
            What::Picture { generation, step, .. } if generation > before => {
                coarse.get_or_insert(ms);
                if step == 1 {
                    times.noticed.extend(noticed);
                    times.coarse.extend(coarse);
                    times.whole.push(ms);
                    return Ok(generation);
                }
            }
            _ => {}
        }
    }
}

/// A comment is noticed, and begins nothing.
fn comment(
    watching: &Watching,
    (saved, before): (Instant, u64),
    times: &mut Times,
) -> Result<(), String> {
    let mut noticed = None;
    for told in watching.until(saved + STILL) {
        match told.what {
            What::Status(status) if status == NOTICED && told.at >= saved => {
                noticed.get_or_insert((told.at - saved).as_secs_f64() * 1e3);
            }
            What::Picture { generation, .. } if generation > before => {
                return Err("an edit of a comment began a picture".to_owned());
            }
            _ => {}
        }
    }
    times.noticed.extend(noticed);
    Ok(())
}
