//! `luxel view`: finished pictures on a page of this machine.

mod picture;

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, SystemTime};

use crate::exit::{Exit, Failure};
use crate::interrupt;
use crate::picture::Picture;
use crate::preview::{Command, PageArgs, PixelReply, Preview, Problem, Side};
use crate::report;

/// Look at a finished picture, or compare two, in the browser
///
/// The page shows radiance as it was measured: exposure, false colour, standard error, histogram,
/// exact values of a pixel, and a wipe between two pictures. A file that is written again is shown
/// again. Only this machine is answered, and only at the address that is printed. Ctrl-C ends.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel view cornell.exr
  luxel view cornell.exr reference.exr
  luxel view cornell.exr --port 8123 --no-open")]
pub(crate) struct Args {
    /// The picture
    a: PathBuf,
    /// A picture to compare it with
    b: Option<PathBuf>,
    #[command(flatten)]
    page: PageArgs,
}

/// Between two looks at the files.
const LOOK: Duration = Duration::from_millis(200);

/// A file with what was last read from it.
struct Shown {
    path: PathBuf,
    side: Side,
    stamp: Stamp,
    generation: u64,
    picture: Option<Picture>,
    problem: Option<Problem>,
}

type Stamp = Option<(u64, SystemTime)>;

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let sides = [(Side::A, Some(&args.a)), (Side::B, args.b.as_ref())];
    let mut shown = BTreeMap::new();
    for (side, path) in sides.into_iter().filter_map(|(side, path)| Some((side, path?))) {
        let stamp = stamp(path);
        let picture = Some(Picture::open(path)?);
        let path = path.clone();
        shown
            .insert(side as u8, Shown { path, side, stamp, generation: 1, picture, problem: None });
    }
    let pressed = interrupt::pressed()?;
    let title = shown.values().map(|shown| name(&shown.path)).collect::<Vec<_>>().join(" · ");
    let mut preview = Preview::start(&args.page, &title, None)?;
    for file in shown.values() {
        show(&preview, file);
    }
    preview.screen().status(&about(&shown));
    report::out(&format!("{}\n", preview.url()))?;
    if !args.page.no_open && std::io::stdout().is_terminal() {
        preview.open();
    }
    while !pressed.load(Ordering::Relaxed) {
        match preview.commands().recv_timeout(LOOK) {
            Ok(Command::Pixel { at, side }) => {
                let at = glam::UVec2::from(at);
                let of = shown.get(&(side as u8)).and_then(|shown| shown.picture.as_ref());
                let facts = of.map_or(vec![], |of| picture::facts(of, at));
                preview.screen().pixel(&PixelReply { at, side, facts, places: vec![] });
            }
            // A finished picture has nothing to set.
            Ok(_) => {}
            Err(RecvTimeoutError::Timeout) => look_again(&preview, &mut shown),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Failure::new(Exit::Ours, "the preview's server has ended"));
            }
        }
    }
    Ok(Exit::Fine)
}

/// A line about the pictures.
fn about(shown: &BTreeMap<u8, Shown>) -> String {
    let pictures = shown.values().filter_map(|shown| shown.picture.as_ref());
    pictures.map(picture::about).collect::<Vec<_>>().join(" | ")
}

fn name(path: &std::path::Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn show(preview: &Preview, shown: &Shown) {
    if let Some(of) = &shown.picture {
        let mut frame = picture::frame(of);
        (frame.side, frame.name) = (shown.side, name(&shown.path));
        frame.generation = shown.generation;
        preview.screen().show(&frame);
    }
}

/// Shows files that were written again; what is wrong with one lies over its last good picture.
fn look_again(preview: &Preview, shown: &mut BTreeMap<u8, Shown>) {
    let mut changed = false;
    for file in shown.values_mut() {
        let now = stamp(&file.path);
        if now == file.stamp {
            continue;
        }
        changed = true;
        file.stamp = now;
        file.problem = match Picture::open(&file.path) {
            Ok(picture) => {
                (file.picture, file.generation) = (Some(picture), file.generation + 1);
                show(preview, file);
                None
            }
            Err(failure) => Some(Problem::of_failure(&failure)),
        };
    }
    if changed {
        let problems: Vec<_> = shown.values().filter_map(|shown| shown.problem.clone()).collect();
        preview.screen().problems(&problems);
        preview.screen().status(&about(shown));
    }
}

fn stamp(path: &std::path::Path) -> Stamp {
    let about = std::fs::metadata(path).ok()?;
    Some((about.len(), about.modified().ok()?))
}
