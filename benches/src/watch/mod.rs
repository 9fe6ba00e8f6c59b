//! `luxel watch --preview`: from a save to what is seen of it, and what stays of many.

mod browser;
mod cancel;
mod client;
mod crowd;
mod large;
mod latency;
mod soak;
mod stages;
mod subject;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::process::{Luxel, has_mitsuba, here};
use crate::series::Series;
use client::Watching;
use crowd::Crowd;
use subject::{Kind, Subject, Way};

pub(crate) use soak::run as soak;
pub(crate) use stages::run as stages;

const SIZE: [u32; 2] = [960, 540];
/// Far more than are reached: every edit ends a render.
const SAMPLES: u32 = 4096;
/// Whole processes of each kind.
const RUNS: usize = 7;

/// Prints latencies of every kind of edit, of the end of a render and of loads, and of beginning anew,
/// here and with Mitsuba, where this Python has it.
///
/// # Errors
/// A program's words.
pub(crate) fn run(luxel: &Luxel, python: Option<&Path>) -> Result<(), String> {
    let mut subject = Subject::new("watch", SIZE, SAMPLES, true)?;
    println!("luxel watch --preview, {} x {}, edits while it renders", SIZE[0], SIZE[1]);
    let watching = Watching::start(luxel, &subject.scene(), &[])?;
    latency::run(&watching, &mut subject)?;
    drop(watching);
    let watching = Watching::start(luxel, &subject.scene(), &["--spp", "1"])?;
    // A finished picture is shown, and then written.
    let edit = || subject.edit(Kind::Camera, Way::Renamed);
    latency::alike(&watching, "camera, while a finished picture is written", 0.05, edit)?;
    drop(watching);
    crowd(luxel)?;
    let ends = cancel::run(&subject)?;
    let [p50, p95, p99] = [50, 95, 99].map(|percent| ends.percentile(percent));
    println!("end of a render after it is asked (goal p99 10): {p50:.1} / {p95:.1} / {p99:.1} ms");
    stages::run(luxel)?;
    for size in ["120x68", "960x540"] {
        let ms = cold(luxel, &subject.scene(), size)?;
        let (min, median) = (ms.min(), ms.median());
        println!(
            "luxel render, {size}, 1 spp, whole process: median {median:.0} ms, least {min:.0}"
        );
    }
    browser::run(luxel)?;
    let Some(python) = python.filter(|python| has_mitsuba(python)) else {
        println!("Mitsuba is not to be had (--python PATH of one that imports it)");
        return Ok(());
    };
    let mut command = Command::new(python);
    command.arg(here().join("watch_mitsuba.py")).arg(subject.mesh()).arg(subject.texture());
    let status = command.status().map_err(|error| format!("{}: {error}", python.display()))?;
    if status.success() { Ok(()) } else { Err("watch_mitsuba.py failed".to_owned()) }
}

/// Prints latencies of edits of the camera among many placements.
///
/// # Errors
/// A program's words.
pub(crate) fn crowd(luxel: &Luxel) -> Result<(), String> {
    let mut crowd = Crowd::new()?;
    let watching = Watching::start(luxel, &crowd.scene(), &[])?;
    latency::alike(&watching, "camera, 100,000 placements", 0.25, || crowd.edit())
}

/// Milliseconds from the start of the program to its end, with one sample per pixel.
fn cold(luxel: &Luxel, scene: &Path, size: &str) -> Result<Series, String> {
    let once = || {
        let mut command = Command::new(&luxel.program);
        command.args(["render", "--quiet", "--spp=1", "--size", size, "-o"]);
        command.arg(scene.with_extension("cold")).arg(scene);
        let start = Instant::now();
        let status = command.stdout(Stdio::null()).status().map_err(|error| error.to_string())?;
        let ms = start.elapsed().as_secs_f64() * 1e3;
        if status.success() { Ok(ms) } else { Err("`luxel render` failed".to_owned()) }
    };
    Ok(Series::from((0..RUNS).map(|_| once()).collect::<Result<_, String>>()?))
}
