//! From a finished library file to the first pixel that it made, as `luxel watch` does it.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use crate::process::{self, Luxel, read, scratch, write};
use crate::series::Series;

pub(crate) const RELOADS: usize = 200;
/// Patience with one reload.
const LONGEST: Duration = Duration::from_secs(20);

const SCENE: &str = "scene 1
camera perspective { look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (64, 64) }
sampler sobol { samples = 1 }
light constant { radiance = 1 W/m^2/sr }
shape sphere { radius = 1 m, material = material velvet {} }
";

/// What many reloads took.
pub(crate) struct Reloads {
    /// From renaming the library into place to the new picture, milliseconds.
    pub(crate) ms: Series,
    /// What the process grew by with each, KiB, where the system tells it.
    grown: Option<f64>,
    /// The size of the library's file, KiB.
    file: f64,
}

/// Prints what many reloads took.
///
/// # Errors
/// As `measure`.
pub(crate) fn run(luxel: &Luxel) -> Result<(), String> {
    let Reloads { ms, grown, file } = measure(luxel, RELOADS)?;
    println!(
        "reload in `luxel watch`: from the library's rename to the written 64 x 64 picture, \
              {RELOADS} reloads (goal 50 ms)"
    );
    println!("  min {:.1} ms, median {:.1} ms, spread {:.0} %", ms.min(), ms.median(), ms.spread());
    match grown {
        Some(kib) => println!(
            "  resident memory grew by {kib:.0} KiB a reload; the library's file has {file:.0} KiB"
        ),
        None => println!("  resident memory is not told on this system"),
    }
    Ok(())
}

/// Puts a library in the place of a watched one so many times.
///
/// # Errors
/// The example library is missing, or the watch never answers.
pub(crate) fn measure(luxel: &Luxel, times: usize) -> Result<Reloads, String> {
    let original = process::library(luxel, "velvet", &["build", "-p", "velvet"])?;
    let bytes = read(&original)?;
    let name = original.file_name().expect("a library is a file");
    let scene = write("reload.scene", SCENE.as_bytes())?;
    let folder = scratch()?.join("reload");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let (library, picture) = (folder.join(name), scratch()?.join("reload-out"));
    let _ = std::fs::remove_file(picture.with_extension("exr"));
    put(&library, &bytes)?;
    let mut watch = watch(luxel, &scene, &folder, &picture)?;
    let places = (library.as_path(), &*picture.with_extension("exr"));
    let measured = reloads(&mut watch, &bytes, places, times);
    let _ = watch.kill();
    let _ = watch.wait();
    let (ms, grown) = measured?;
    Ok(Reloads { ms: Series::from(ms), grown, file: bytes.len() as f64 / 1024.0 })
}

fn watch(luxel: &Luxel, scene: &Path, folder: &Path, out: &Path) -> Result<Child, String> {
    let mut command = Command::new(&luxel.program);
    command.args(["watch", "--quiet", "--allow-unlocked-plugins", "--plugin-dir"]).arg(folder);
    command.arg("-o").arg(out).arg(scene).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().map_err(|error| error.to_string())
}

fn reloads(
    watch: &mut Child,
    bytes: &[u8],
    (library, picture): (&Path, &Path),
    times: usize,
) -> Result<(Vec<f64>, Option<f64>), String> {
    let mut seen = newer(picture, None, watch)?;
    let (mut ms, mut memory) = (vec![], vec![]);
    for i in 0..times {
        // Bytes behind the end are not loaded, and make another file of it.
        let mut changed = bytes.to_vec();
        changed.extend((i as u64).to_le_bytes());
        std::thread::sleep(Duration::from_millis(60));
        let start = Instant::now();
        put(library, &changed)?;
        seen = newer(picture, Some(seen), watch)?;
        ms.push(start.elapsed().as_secs_f64() * 1e3);
        memory.extend(resident(watch.id()));
    }
    // The first ones fill caches.
    let behind = memory.get(times / 10..).filter(|_| memory.len() == times).unwrap_or_default();
    let grown = match behind {
        [first, .., last] => Some((last - first) / (behind.len() - 1) as f64),
        _ => None,
    };
    Ok((ms, grown))
}

/// Waits until a file is another one than before.
fn newer(path: &Path, than: Option<SystemTime>, watch: &mut Child) -> Result<SystemTime, String> {
    let start = Instant::now();
    loop {
        let now = std::fs::metadata(path).and_then(|meta| meta.modified()).ok();
        if let Some(now) = now.filter(|now| Some(*now) != than) {
            return Ok(now);
        }
        if start.elapsed() > LONGEST || !matches!(watch.try_wait(), Ok(None)) {
            return Err("`luxel watch` has ended or makes no picture".to_owned());
        }
        std::thread::sleep(Duration::from_micros(200));
    }
}

/// Resident memory of a process, KiB, where the system tells it.
fn resident(process: u32) -> Option<f64> {
    let status = read(Path::new(&format!("/proc/{process}/status"))).ok()?;
    let status = String::from_utf8_lossy(&status).into_owned();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?.to_owned();
    line.split_whitespace().next()?.parse().ok()
}

/// A whole file appears at once.
fn put(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let part = write("reload.part", bytes)?;
    std::fs::rename(part, path).map_err(|error| error.to_string())
}
