//! Ten thousand edits of all kinds: what the program holds afterwards.

use std::time::{Duration, Instant};

use super::client::{Watching, What};
use super::subject::{Kind, Subject, Way};
use crate::process::{Luxel, read};

const EDITS: u32 = 10_000;
/// Edits between two looks.
const EVERY: u32 = 500;
/// The first ones fill caches.
const WARM: u32 = 2_000;
/// Patience with one edit, which a comment uses up.
const STILL: Duration = Duration::from_millis(25);
/// Patience with the end of what is in hand.
const REST: Duration = Duration::from_secs(10);

/// What a process holds.
struct Held {
    edits: u32,
    kib: f64,
    files: usize,
    threads: usize,
}

/// Prints what the process holds every few hundred edits, and whether it grows.
///
/// # Errors
/// The program's words; files or threads that stay open; memory that grows.
pub(crate) fn run(luxel: &Luxel) -> Result<(), String> {
    let mut subject = Subject::new("soak", [64, 36], 2, false)?;
    let watching = Watching::start(luxel, &subject.scene(), &[])?;
    println!("luxel watch --preview, {EDITS} edits\n  edits   RSS, MB   open files   threads");
    let (mut held, mut generation) = (vec![], 0);
    for n in 0..=EDITS {
        if n % EVERY == 0 {
            let now = at_rest(watching.id(), n, held.last())?;
            println!("{n:7}{:10.1}{:13}{:10}", now.kib / 1024.0, now.files, now.threads);
            held.push(now);
        }
        let kind = Kind::ALL[n as usize % Kind::ALL.len()];
        let way = if n / 7 % 2 == 0 { Way::Renamed } else { Way::InPlace };
        subject.edit(kind, way)?;
        generation = seen(&watching, generation);
    }
    verdict(&held)
}

/// What it holds once no render is in hand: what it held before, unless that takes too long.
fn at_rest(process: u32, edits: u32, before: Option<&Held>) -> Result<Held, String> {
    let since = Instant::now();
    loop {
        std::thread::sleep(Duration::from_millis(300));
        let now = held_by(process, edits)?;
        let same = |it: &Held| (it.files, it.threads) == (now.files, now.threads);
        if before.is_none_or(same) || since.elapsed() > REST {
            return Ok(now);
        }
    }
}

/// Waits for a picture of another edit, or for as long as a comment is waited for.
fn seen(watching: &Watching, before: u64) -> u64 {
    let newer = |told: super::client::Told| match told.what {
        What::Picture { generation, .. } if generation > before => Some(generation),
        _ => None,
    };
    watching.until(Instant::now() + STILL).find_map(newer).unwrap_or(before)
}

/// Prints the slope of memory with its standard error.
fn verdict(held: &[Held]) -> Result<(), String> {
    let warm: Vec<_> = held.iter().filter(|held| held.edits >= WARM).collect();
    let points: Vec<_> = warm.iter().map(|held| (f64::from(held.edits), held.kib)).collect();
    let (slope, error) = slope(&points);
    println!(
        "memory grows by {:.0} ± {:.0} bytes an edit (from edit {WARM} on, one standard error)",
        slope * 1024.0,
        error * 1024.0
    );
    let same = |of: fn(&Held) -> usize| warm.windows(2).all(|pair| of(pair[0]) == of(pair[1]));
    if !same(|held| held.files) || !same(|held| held.threads) {
        return Err("open files or threads change".to_owned());
    }
    println!("open files and threads stay the same");
    Ok(())
}

/// Least squares: the slope and its standard error; three points at least.
fn slope(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
    let left: f64 = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).powi(2)).sum();
    (slope, (left / (n - 2.0) / spread).sqrt())
}

#[cfg(target_os = "linux")]
fn held_by(process: u32, edits: u32) -> Result<Held, String> {
    let folder = std::path::PathBuf::from(format!("/proc/{process}"));
    let status = String::from_utf8_lossy(&read(&folder.join("status"))?).into_owned();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or_default();
    let kib = line.split_whitespace().next().and_then(|kib| kib.parse().ok());
    let count = |name: &str| std::fs::read_dir(folder.join(name)).map_or(0, Iterator::count);
    let kib = kib.ok_or("the program has ended")?;
    Ok(Held { edits, kib, files: count("fd"), threads: count("task") })
}

#[cfg(not(target_os = "linux"))]
fn held_by(_: u32, _: u32) -> Result<Held, String> {
    Err("this system does not tell what a process holds".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_is_found_with_its_error() {
        let (exact, none) = slope(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]);
        assert!((exact - 2.0).abs() < 1e-12 && none < 1e-12);
        // Residuals -1/3, 2/3, -1/3 about a flat line: sqrt((2/3) / 1 / 2).
        let (flat, error) = slope(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]);
        assert!(flat.abs() < 1e-12 && (error - (1.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }
}
