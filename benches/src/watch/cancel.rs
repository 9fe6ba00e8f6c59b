//! How long a render goes on after it was asked to end.

use std::sync::mpsc;
use std::time::{Duration, Instant};

use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render_seen};
use luxel_sdk::sampling::Rng;

use super::subject::Subject;
use crate::process::read;
use crate::scene::{linked, stage_with};
use crate::series::Series;

const TIMES: u32 = 100;

/// Ends renders at moments drawn at random, within two seconds of their beginning; milliseconds.
///
/// # Errors
/// What is wrong with the scene.
pub(super) fn run(subject: &Subject) -> Result<Series, String> {
    let mut files = MemoryFiles::default();
    for name in ["large.ply", "small.ply", "soil.hdr"] {
        files = files.with(name, read(&subject.scene().with_file_name(name))?);
    }
    let text = String::from_utf8(read(&subject.scene())?).map_err(|error| error.to_string())?;
    let stage = stage_with(&linked(), files, &text)?;
    let mut rng = Rng::new(3);
    let mut end = || {
        let (control, (begun, begins)) = (Control::default(), mpsc::channel());
        let options = Options { coarse: true, ..Options::default() };
        std::thread::scope(|scope| {
            let render = scope.spawn(|| {
                let mut look = |_: &_, _| _ = begun.send(());
                render_seen(&stage, &options, &control, &mut look);
                Instant::now()
            });
            let _ = begins.recv();
            std::thread::sleep(Duration::from_secs_f64(2.0 * rng.f64()));
            let asked = Instant::now();
            control.supersede();
            let ended = render.join().expect("rendering does not panic");
            ended.saturating_duration_since(asked).as_secs_f64() * 1e3
        })
    };
    Ok(Series::from((0..TIMES).map(|_| end()).collect()))
}
