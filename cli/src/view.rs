//! `luxel view`: finished pictures on a page of this machine.

mod layers;
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
use layers::layers;

/// Look at a finished picture, or compare two, in the browser
///
/// The page shows radiance as it was measured: exposure, false colour, standard error, histogram,
/// exact values of a pixel, the layers that the file has beside colour, and a wipe between two
/// pictures. A file that is written again is shown again. Only this machine is answered, and only at
/// the address that is printed. Ctrl-C ends.
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

/// What is on the page.
struct Page {
    preview: Preview,
    /// By the number of their side.
    shown: BTreeMap<u8, Shown>,
    /// The layer that is shown; none where it is colour.
    layer: Option<String>,
}

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
    let preview = Preview::start(&args.page, &title, None)?;
    let mut page = Page { preview, shown, layer: None };
    page.show_all();
    page.say();
    report::out(&format!("{}\n", page.preview.url()))?;
    if !args.page.no_open && std::io::stdout().is_terminal() {
        page.preview.open();
    }
    while !pressed.load(Ordering::Relaxed) {
        match page.preview.commands().recv_timeout(LOOK) {
            Ok(command) => page.answer(command),
            Err(RecvTimeoutError::Timeout) => page.look_again(),
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Failure::new(Exit::Ours, "the preview's server has ended"));
            }
        }
    }
    Ok(Exit::Fine)
}

impl Page {
    fn answer(&mut self, command: Command) {
        match command {
            Command::Pixel { at, side } => {
                let at = glam::UVec2::from(at);
                let of = self.shown.get(&(side as u8)).and_then(|shown| shown.picture.as_ref());
                let facts = of.map_or(vec![], |of| picture::facts(of, at));
                self.preview.screen().pixel(&PixelReply { at, side, facts, places: vec![] });
            }
            Command::Layer { name } => {
                self.layer = name;
                self.show_all();
            }
            // A finished picture has nothing to set.
            Command::Set { .. } | Command::Camera { .. } | Command::ResetParams => {}
        }
    }

    /// Shows the pictures, each in the layer that is wanted if both have it.
    fn show_all(&mut self) {
        let pictures: Vec<_> = self.pictures().collect();
        let mut of_each = pictures.iter().map(|picture| layers(picture));
        let mut common = of_each.next().unwrap_or_default();
        for others in of_each {
            common.retain(|layer| others.iter().any(|other| other.name == layer.name));
        }
        let names: Vec<_> = common.iter().map(|layer| layer.name).collect();
        let wanted = self.layer.as_deref().filter(|wanted| names.contains(wanted));
        for file in self.shown.values() {
            show(&self.preview, file, wanted);
        }
        self.preview.screen().layers(&names, wanted);
        self.layer = wanted.map(str::to_owned);
    }

    fn pictures(&self) -> impl Iterator<Item = &Picture> {
        self.shown.values().filter_map(|shown| shown.picture.as_ref())
    }

    /// A line about the pictures, and what is wrong with their files.
    fn say(&self) {
        let screen = self.preview.screen();
        let problems: Vec<_> = self.shown.values().filter_map(|it| it.problem.clone()).collect();
        screen.problems(&problems);
        screen.status(&self.pictures().map(picture::about).collect::<Vec<_>>().join(" | "));
    }

    /// Shows files that were written again; what is wrong with one lies over its last good picture.
    fn look_again(&mut self) {
        let mut changed = false;
        for file in self.shown.values_mut() {
            let now = stamp(&file.path);
            if now == file.stamp {
                continue;
            }
            changed = true;
            file.stamp = now;
            file.problem = match Picture::open(&file.path) {
                Ok(picture) => {
                    (file.picture, file.generation) = (Some(picture), file.generation + 1);
                    None
                }
                Err(failure) => Some(Problem::of_failure(&failure)),
            };
        }
        if changed {
            self.show_all();
            self.say();
        }
    }
}

fn name(path: &std::path::Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// Shows a file's picture, in one of its layers if one is named.
fn show(preview: &Preview, shown: &Shown, layer: Option<&str>) {
    if let Some(of) = &shown.picture {
        let all = layers(of);
        let mut frame = picture::frame(of, all.iter().find(|it| Some(it.name) == layer));
        (frame.side, frame.name) = (shown.side, name(&shown.path));
        frame.generation = shown.generation;
        preview.screen().show(&frame);
    }
}

fn stamp(path: &std::path::Path) -> Stamp {
    let about = std::fs::metadata(path).ok()?;
    Some((about.len(), about.modified().ok()?))
}
