//! Rays per second through one mesh, side by side: ours, obvhs's own traversal, and Embree.

mod builds;
mod embree;
mod knot;
mod leaks;
mod peers;
mod self_hits;
mod shots;
mod staged;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use glam::Vec3;
use libloading::Library;
use luxel_core::accel::{MeshBvh, Precision, Processor};
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;

use crate::series::Series;
use embree::{Embree, Flags};
use knot::{Soup, eight, knot};
use peers::{Obvhs, SideBySide, Single, Tracer};
use shots::{Landing, Set, Shot, sets};

/// Rays traced between two looks at the clock.
const CHUNK: usize = 4096;

/// Times that everything is traced, in turn.
const ROUNDS: usize = 9;

/// Rays side by side: camera rays of a picture this wide.
const WIDTH: u16 = 384;

/// A mesh through which rays are traced, and from where it is seen.
struct Field {
    name: &'static str,
    soup: Soup,
    eye: Vec3,
}

struct Runner<'a> {
    name: String,
    tracer: Box<dyn Tracer + 'a>,
    build: Series,
}

/// Builds three times; keeps the last.
fn built<'a, T: Tracer + 'a>(name: String, make: impl Fn() -> T) -> Runner<'a> {
    let mut last = None;
    let build = Series::of(3, || {
        drop(last.take());
        let start = Instant::now();
        last = Some(make());
        start.elapsed().as_secs_f64()
    });
    Runner { name, tracer: Box::new(last.expect("built at least once")), build }
}

fn trace(tracer: &dyn Tracer, set: &Set, found: &mut [Landing]) -> f64 {
    let start = Instant::now();
    for (shots, found) in set.shots.chunks(CHUNK).zip(found.chunks_mut(CHUNK)) {
        if set.any {
            tracer.any(shots, found);
        } else {
            tracer.nearest(shots, found);
        }
    }
    start.elapsed().as_secs_f64()
}

/// Embree's library: as given, where Python's package keeps it, or where the system does.
fn embree_path(given: Option<&Path>, python: Option<&Path>) -> PathBuf {
    if let Some(path) = given {
        return path.to_owned();
    }
    let code = "import embreex, glob, os; print(glob.glob(os.path.join(os.path.dirname(\
                embreex.__file__), '..', 'embreex.libs', 'libembree4*'))[0])";
    let asked = python.and_then(|python| Command::new(python).args(["-c", code]).output().ok());
    let found = asked.filter(|said| said.status.success());
    let found = found.and_then(|said| Some(String::from_utf8(said.stdout).ok()?.trim().into()));
    found.unwrap_or_else(|| PathBuf::from("libembree4.so.4"))
}

/// Prints how many rays meet a closed mesh where they leave it, and how many get out of it; `n` for
/// each of eleven cases.
pub(crate) fn leaks(given: Option<&Path>, python: Option<&Path>, n: usize) {
    leaks::run(embree::load(&embree_path(given, python)).as_ref(), n);
}

/// Prints how long trees take to build.
pub(crate) fn builds(given: Option<&Path>, python: Option<&Path>) {
    println!("\n== builds: the least seconds of several");
    builds::run(embree::load(&embree_path(given, python)).as_ref());
}

/// Prints rays per second, build times and bytes per triangle for three meshes.
pub(crate) fn run(given: Option<&Path>, python: Option<&Path>) {
    println!("\n== rays: millions per second on one thread, ratio to Embree's default");
    let library = embree::load(&embree_path(given, python));
    if library.is_none() {
        println!("Embree 4 was not found: give --embree LIBRARY, or --python with `embreex`");
    }
    let near = Vec3::new(0.3, 0.6, 2.2);
    for field in [
        Field { name: "small", soup: knot(375, 94), eye: near },
        Field { name: "large", soup: knot(1341, 335), eye: near },
        knots(FINE),
    ] {
        mesh(&field, library.as_ref());
    }
}

/// Steps along and around each of the knots that the largest mesh is made of.
pub(crate) const FINE: [u32; 2] = [1341, 335];

/// Eight knots of so many steps along and around.
fn knots([along, around]: [u32; 2]) -> Field {
    Field { name: "huge", soup: eight(&knot(along, around)), eye: Vec3::new(0.9, 2.4, 4.4) }
}

/// Rays per second side by side through eight knots of so many steps, in parts of those of Embree's
/// default: the least and the greatest of all sets. `None` without Embree.
pub(crate) fn side_by_side(
    given: Option<&Path>,
    python: Option<&Path>,
    steps: [u32; 2],
) -> Option<[f64; 2]> {
    let library = embree::load(&embree_path(given, python))?;
    let field = knots(steps);
    let runners = [flock(&field.soup), with_embree(&library, &field.soup, EMBREE)?];
    let best = race(&runners, &field.sets(&runners[0]));
    let ratios = best[0].iter().zip(&best[1]).map(|(ours, theirs)| theirs.min() / ours.min());
    let ratios = Series::from(ratios.collect());
    Some([ratios.min(), ratios.percentile(100)])
}

impl Field {
    /// The rays, of which the runner says where they land.
    fn sets(&self, runner: &Runner<'_>) -> Vec<Set> {
        let land = |shots: &[Shot]| {
            let mut found = vec![Landing::NOWHERE; shots.len()];
            runner.tracer.nearest(shots, &mut found);
            found
        };
        sets(&self.soup, WIDTH, self.eye, &land)
    }
}

fn tree(soup: &Soup) -> MeshBvh {
    MeshBvh::build(&soup.points, &soup.indices).expect("the knot is finite")
}

fn flock<'a>(soup: &Soup) -> Runner<'a> {
    let processor = Processor::widest();
    built("luxel, side by side".into(), || SideBySide { tree: tree(soup), processor })
}

/// What Embree is asked for where others are compared with it.
const EMBREE: (&str, Flags) = ("Embree", Flags::Default);

/// `None` if this library does not take the mesh.
fn with_embree<'a>(
    library: &'a Library,
    soup: &'a Soup,
    (name, flags): (&str, Flags),
) -> Option<Runner<'a>> {
    let scene = || Embree::new(library, soup, flags);
    scene()?;
    Some(built(name.into(), || scene().expect("it was built before")))
}

fn mesh(field: &Field, library: Option<&Library>) {
    let soup = &field.soup;
    println!("\n{}: {} triangles", field.name, soup.indices.len());
    let single = |processor, precision| Single { tree: tree(soup), processor, precision };
    let mut runners = vec![];
    for processor in Processor::all().into_iter().rev() {
        let name = format!("luxel, {}", processor.name());
        runners.push(built(name, || single(processor, Precision::Standard)));
    }
    for precision in [Precision::Fast, Precision::Exact] {
        let name = format!("luxel, {}", precision.word());
        runners.push(built(name, || single(Processor::widest(), precision)));
    }
    runners.push(flock(soup));
    runners.push(built("obvhs Bvh2".into(), || Obvhs::<Bvh2>::new(soup)));
    runners.push(built("obvhs CwBvh".into(), || Obvhs::<CwBvh>::new(soup)));
    for kind in [EMBREE, ("Embree, robust", Flags::Robust)] {
        runners.extend(library.and_then(|library| with_embree(library, soup, kind)));
    }
    let sets = field.sets(&runners[0]);
    let best = race(&runners, &sets);
    print(&runners, &sets, &best, soup.indices.len());
}

/// A table of what was measured through a mesh of `n` triangles.
fn print(runners: &[Runner<'_>], sets: &[Set], best: &[Vec<Series>], n: usize) {
    let reference = runners.iter().position(|runner| runner.name == EMBREE.0);
    print!("{:<22}{:>9}{:>8}", "", "build s", "B/tri");
    for set in sets {
        print!("{:>24}", format!("{} {}k", set.name, set.shots.len() / 1000));
    }
    println!();
    for (i, runner) in runners.iter().enumerate() {
        let per = runner.tracer.bytes() as f64 / n as f64;
        print!("{:<22}{:>9.3}{per:>8.1}", runner.name, runner.build.min());
        for (series, set) in best[i].iter().zip(sets) {
            let rate = |series: &Series| set.shots.len() as f64 / series.min() / 1e6;
            let at = sets.iter().position(|other| other.name == set.name);
            let ratio = reference.zip(at).map(|(r, at)| rate(series) / rate(&best[r][at]));
            let ratio = ratio.map_or(String::new(), |ratio| format!("{ratio:.2}×"));
            print!("{:>24}", format!("{:.3} {ratio} ±{:.0} %", rate(series), series.spread()));
        }
        println!();
    }
}

/// Seconds of every runner for every set, interleaved; says where they disagree with the first.
fn race(runners: &[Runner<'_>], sets: &[Set]) -> Vec<Vec<Series>> {
    let mut times = vec![vec![vec![]; sets.len()]; runners.len()];
    for round in 0..ROUNDS {
        for (s, set) in sets.iter().enumerate() {
            let mut first = vec![];
            for (r, runner) in runners.iter().enumerate() {
                let mut found = vec![Landing::NOWHERE; set.shots.len()];
                times[r][s].push(trace(runner.tracer.as_ref(), set, &mut found));
                if round > 0 {
                    continue;
                }
                if r == 0 {
                    first.clone_from(&found);
                }
                let differs = |(a, b): &(&Landing, &Landing)| {
                    (a.t < f32::INFINITY) != (b.t < f32::INFINITY)
                        || (a.t - b.t).abs() > 1e-3 * b.t.max(1.0)
                };
                let n = found.iter().zip(&first).filter(differs).count();
                if n > 0 {
                    println!("  {}: {n} of {} {} rays differ", runner.name, found.len(), set.name);
                }
            }
        }
    }
    let series = |times: Vec<Vec<f64>>| times.into_iter().map(Series::from).collect();
    times.into_iter().map(series).collect()
}
