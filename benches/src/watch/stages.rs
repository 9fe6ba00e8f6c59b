//! How long reading, decoding and building go on after they were given up: until the load has ended,
//! and until no thread works on it any more and its memory has been given back.

use std::any::Any;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use luxel_core::accel::Watch;
use luxel_core::files::{MemoryFiles, read_whole};
use luxel_core::registry::Registry;
use luxel_core::stage::build_watched;
use luxel_lang::{Kept, Settings, load};
use luxel_sdk::sampling::Rng;

use super::large::{HEAD, Held, NODES, SIDE, SMALL, ball, lamp};
use super::subject::LARGE;
use crate::MEMORY;
use crate::process::{Luxel, write};
use crate::scene::{lines, linked, scene_in};
use crate::series::Series;

/// Loads of each kind that are given up.
const TIMES: usize = 60;

/// Megabytes of the files that are read.
const READ: [usize; 2] = [19, 300];

const MESH: &str = "shape mesh { file = \"large.ply\", unit = 1 m }\n";
const LAND: &str = "shape heightfield { width = 1 m, depth = 1 m, file = \"seen.png\" }\n";
const PAINTED: &str = "shape rectangle { u = (4, 0, 0) m, v = (0, 0, -4) m, material = material \
                       diffuse { reflectance = texture image { file = \"FILE\" } } }\n";
const ASSET: &str = "asset gltf { file = \"seen.gltf\", unit = 1 m }\n";
const SKY: &str = "light environment { file = \"seen.exr\" }\n";

/// In which part of a load it is given up.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    /// At any moment.
    Any,
    /// Before the tree of a mesh is begun.
    Before,
    /// While the tree is built.
    Tree,
}

/// Gives up loads of large files at moments drawn at random and prints, of each kind, the milliseconds
/// from there to the end.
///
/// # Errors
/// The program's words; what is wrong with a scene.
pub(crate) fn run(luxel: &Luxel) -> Result<(), String> {
    println!("given up while loading, until it ends, p50 / p95 / p99 ms (goal p99 10)");
    println!(
        "then until its last thread ends and its memory is given back; and what the whole takes"
    );
    println!(
        "pictures of {SIDE} x {SIDE} pixels; files are in memory, but where they alone are read"
    );
    for mb in READ {
        let path = write("read.bin", &vec![7; mb << 20])?;
        let work = |watch: &Watch| made(is_read(&path, watch).then_some(()));
        told(&format!("file of {mb} MB, read and hashed"), Part::Any, &work)?;
    }
    let registry = linked();
    scenes(&registry, &Held::large(luxel)?)?;
    texts(&registry)
}

/// What is made ready, by a name for people, and in which part it is given up.
fn cases() -> Vec<(String, String, Part)> {
    let painted = |name: &str| PAINTED.replace("FILE", name);
    let n = 2 * (LARGE - 1) * (LARGE - 1);
    let small = LAND.replace("seen", "small");
    let balls = format!("let r = 50 cm\n{}", lines(NODES, ball));
    let case = |name: &str, text: String, part| (name.to_owned(), text, part);
    vec![
        case(&format!("PLY of {n} triangles, read"), MESH.to_owned(), Part::Before),
        case("its tree, built", MESH.to_owned(), Part::Tree),
        case("texture of a PNG, decoded", painted("seen.png"), Part::Any),
        case("texture of an EXR, decoded", painted("seen.exr"), Part::Any),
        case("texture of a progressive JPEG, decoded", painted("seen.jpg"), Part::Any),
        case("environment of an EXR, decoded and weighed", SKY.to_owned(), Part::Any),
        case(&format!("asset of {NODES} nodes, read"), ASSET.to_owned(), Part::Any),
        case("heightfield of a PNG, decoded and laid out", LAND.to_owned(), Part::Before),
        case(&format!("tree of one of {SMALL} x {SMALL}, built"), small, Part::Tree),
        case(&format!("{NODES} balls of glass, made ready"), balls, Part::Any),
        case(&format!("{NODES} lamps, made ready"), lines(NODES, lamp), Part::Any),
    ]
}

/// Loads that make a scene ready.
fn scenes(registry: &Registry, files: &Held) -> Result<(), String> {
    for (name, text, part) in cases() {
        let is_lit = text.contains("light ");
        let light = if is_lit { "" } else { "light constant { radiance = 1 W/m^2/sr }\n" };
        let text = format!("{HEAD}{light}{text}");
        let scene = scene_in(registry, &MemoryFiles::default().with("a.scene", text.as_bytes()))?;
        let work = |watch: &Watch| made(build_watched(&scene, registry, files, None, watch).ok());
        told(&name, part, &work)?;
    }
    Ok(())
}

/// Loads of a large text.
fn texts(registry: &Registry) -> Result<(), String> {
    let text = |r: f64| {
        let named = |i: usize| format!("{}let of_{i} = r + {i} mm\n", ball(i));
        let many = lines(NODES, |i| if i.is_multiple_of(10) { named(i) } else { ball(i) });
        let text = format!("{HEAD}let r = {r} m\n{many}");
        MemoryFiles::default().with("a.scene", text.as_bytes())
    };
    let both = [text(0.5), text(0.25)];
    let settings = |watch: &Watch| Settings { stop: Some(watch.flag()), ..Settings::default() };
    let (path, name) = (Path::new("a.scene"), format!("text of {NODES} objects, "));
    let fresh = |watch: &Watch| made(load(path, &both[0], registry, &settings(watch)).scene);
    told(&format!("{name}evaluated"), Part::Any, &fresh)?;
    let kept = |watch: &Watch| {
        let mut kept = Kept::default();
        let scene = kept.load(path, &both[0], registry, &settings(watch)).scene;
        made(scene.map(|scene| (kept, scene)))
    };
    told(&format!("{name}and kept"), Part::Any, &kept)?;
    let kept = Mutex::new((Kept::default(), 0));
    let again = |watch: &Watch| {
        let (kept, n) = &mut *kept.lock().unwrap_or_else(PoisonError::into_inner);
        *n += 1;
        made(kept.load(path, &both[*n % 2], registry, &settings(watch)).scene)
    };
    again(&Watch::default());
    told(&format!("{name}after an edit"), Part::Any, &again)
}

/// Prints what giving up some work comes to.
fn told(name: &str, part: Part, work: &Work<'_>) -> Result<(), String> {
    let load = Load { work };
    let whole = load.whole(part)?;
    let [ended, free] = load.given_up(part, whole).map(|ms| {
        let [p50, p95, p99] = [50, 95, 99].map(|percent| ms.percentile(percent));
        format!("{p50:.1} / {p95:.1} / {p99:.1}")
    });
    let whole = whole.as_secs_f64() * 1e3;
    println!("{name:<46}{TIMES:>4}{ended:>24}{free:>24}  of {whole:.0}");
    Ok(())
}

/// Reads a file from the disk, or rather from the system's memory, as the program does; whether all of it.
fn is_read(path: &Path, watch: &Watch) -> bool {
    #[expect(clippy::disallowed_methods, reason = "the reading of files is what is measured")]
    let file = std::fs::File::open(path).expect("it has just been written");
    let length = file.metadata().expect("it is open").len();
    let n = usize::try_from(length).expect("it has been in memory");
    read_whole(file, n, length, &watch.flag()).is_ok()
}

/// What a load gives, if it was done before the watch was cancelled.
type Made = Option<Box<dyn Any + Send>>;

/// A load.
type Work<'a> = dyn Fn(&Watch) -> Made + Sync + 'a;

fn made<T: Any + Send>(made: Option<T>) -> Made {
    made.map(|made| Box::new(made) as Box<dyn Any + Send>)
}

/// What is loaded, again and again.
struct Load<'a> {
    work: &'a Work<'a>,
}

impl Load<'_> {
    /// How long the part takes when nobody gives it up.
    fn whole(&self, part: Part) -> Result<Duration, String> {
        let watch = Watch::default();
        std::thread::scope(|scope| {
            let (began, load) = (Instant::now(), scope.spawn(|| self.load(&watch)));
            let tree = if part == Part::Any { began } else { begun(&watch, || load.is_finished()) };
            let (made, end) = load.join().expect("loading does not panic");
            let took = match part {
                Part::Any => end - began,
                Part::Before => tree - began,
                Part::Tree => end - tree,
            };
            made.map(|_| took).ok_or_else(|| "what cannot be loaded".to_owned())
        })
    }

    /// Milliseconds from giving it up, at moments of the part, to its end, and from there to that of its
    /// threads and of giving its memory back. A load that was done before does not count.
    fn given_up(&self, part: Part, whole: Duration) -> [Series; 2] {
        let (mut rng, mut ms) = (Rng::new(4), [vec![], vec![]]);
        while ms[0].len() < TIMES {
            let (watch, before) = (Watch::default(), n_threads());
            let [asked, end] = std::thread::scope(|scope| {
                let load = scope.spawn(|| self.load(&watch));
                if part == Part::Tree {
                    begun(&watch, || load.is_finished());
                }
                std::thread::sleep(whole.mul_f64(rng.f64()));
                let asked = Instant::now();
                watch.cancel();
                [asked, load.join().expect("loading does not panic").1]
            });
            while n_threads() > before || MEMORY.pending() > 0 {
                std::thread::sleep(Duration::from_micros(200));
            }
            if end > asked {
                ms[0].push((end - asked).as_secs_f64() * 1e3);
                ms[1].push(end.elapsed().as_secs_f64() * 1e3);
            }
        }
        ms.map(Series::from)
    }

    /// What it gives, and when it came to its end.
    fn load(&self, watch: &Watch) -> (Made, Instant) {
        ((self.work)(watch), Instant::now())
    }
}

/// How many threads this program has; 0 where the system does not tell.
fn n_threads() -> usize {
    std::fs::read_dir("/proc/self/task").map_or(0, Iterator::count)
}

/// Waits until a tree is begun, or everything is over.
fn begun(watch: &Watch, is_over: impl Fn() -> bool) -> Instant {
    while watch.standing().total == 0 && !is_over() {
        std::thread::sleep(Duration::from_micros(200));
    }
    Instant::now()
}
