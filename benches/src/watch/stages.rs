//! How long reading, decoding and building go on after they were given up: until the load has ended,
//! and until no thread works on it any more and its memory has been given back.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use luxel_core::accel::Watch;
use luxel_core::files::{FileError, Files, MemoryFiles, read_whole};
use luxel_core::scene::Hash;
use luxel_core::stage::build_watched;
use luxel_sdk::sampling::Rng;

use super::subject::LARGE;
use crate::MEMORY;
use crate::ply::grid;
use crate::process::{Luxel, read, scratch, write};
use crate::scene::{linked, scene_in};
use crate::series::Series;

/// Loads of each kind that are given up.
const TIMES: usize = 60;
/// Columns and rows of the pictures: as many pixels as 4096 × 2048.
const SIDE: u32 = 2896;
/// Nodes of the asset.
const NODES: usize = 100_000;
/// Those of the landscape whose tree is built: it takes long enough.
const SMALL: u32 = 1024;

/// Megabytes of the files that are read.
const READ: [usize; 2] = [19, 300];

/// What every scene has.
const HEAD: &str = "scene 1
camera perspective { look = look_at(from = (0, 2, 3) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (64, 36) }
";
/// What the pictures show: noise, as each pixel has one sample.
const SEEN: &str = "sampler independent { samples = 1 }
light area { shape = shape sphere { center = (0, 3, 0) m, radius = 1 m }, radiance = 9 W/m^2/sr }
light constant { radiance = 0.1 W/m^2/sr }
shape sphere { center = (0, 0.5, 0) m, radius = 50 cm }
shape rectangle { u = (9, 0, 0) m, v = (0, 0, -9) m }
";
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

/// Files in memory whose hashes are known: reading and hashing them are measured by themselves.
struct Held {
    files: MemoryFiles,
    hashes: BTreeMap<PathBuf, Hash>,
}

impl Held {
    fn with(mut self, name: &str, bytes: Vec<u8>) -> Self {
        self.files = self.files.with(name, bytes);
        let hash = self.files.hash(Path::new(name)).expect("it has just been put there");
        self.hashes.insert(name.into(), hash);
        self
    }
}

impl Files for Held {
    fn read(&self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        self.files.read(path)
    }

    fn hash(&self, path: &Path) -> Option<Hash> {
        self.hashes.get(&self.canonical(path)).copied()
    }

    fn canonical(&self, path: &Path) -> PathBuf {
        self.files.canonical(path)
    }
}

/// Gives up loads of large files at moments drawn at random and prints, of each kind, the milliseconds
/// from there to the end.
///
/// # Errors
/// The program's words; what is wrong with a scene.
pub(crate) fn run(luxel: &Luxel) -> Result<(), String> {
    let files = Held { files: MemoryFiles::default(), hashes: BTreeMap::new() };
    let files = files.with("large.ply", grid(LARGE));
    let [_, png] = pictures(luxel, SMALL)?;
    let files = files.with("small.png", png);
    let [exr, png] = pictures(luxel, SIDE)?;
    let files = files.with("seen.exr", exr).with("seen.png", png);
    let painted = |name: &str| PAINTED.replace("FILE", name);
    let n = 2 * (LARGE - 1) * (LARGE - 1);
    println!("given up while loading, until it ends, p50 / p95 / p99 ms (goal p99 10)");
    println!(
        "then until its last thread ends and its memory is given back; and what the whole takes"
    );
    println!(
        "pictures of {SIDE} x {SIDE} pixels; files are in memory, but where they alone are read"
    );
    for mb in READ {
        let path = write("read.bin", &vec![7; mb << 20])?;
        let work = |watch: &Watch| is_read(&path, watch);
        told(&format!("file of {mb} MB, read and hashed"), Part::Any, &work)?;
    }
    let cases = [
        (format!("PLY of {n} triangles, read"), MESH.to_owned(), Part::Before),
        ("its tree, built".to_owned(), MESH.to_owned(), Part::Tree),
        ("texture of a PNG, decoded".to_owned(), painted("seen.png"), Part::Any),
        ("texture of an EXR, decoded".to_owned(), painted("seen.exr"), Part::Any),
        ("environment of an EXR, decoded and weighed".to_owned(), SKY.to_owned(), Part::Any),
        (format!("asset of {NODES} nodes, read"), ASSET.to_owned(), Part::Any),
        ("heightfield of a PNG, decoded and laid out".to_owned(), LAND.to_owned(), Part::Before),
        (
            format!("tree of one of {SMALL} x {SMALL}, built"),
            LAND.replace("seen", "small"),
            Part::Tree,
        ),
    ];
    let files = files.with("seen.gltf", asset());
    let registry = linked();
    for (name, text, part) in cases {
        let lit = if text == SKY { "" } else { "light constant { radiance = 1 W/m^2/sr }\n" };
        let texts = MemoryFiles::default().with("a.scene", format!("{HEAD}{lit}{text}").as_bytes());
        let scene = scene_in(&registry, &texts)?;
        let work = |watch: &Watch| build_watched(&scene, &registry, &files, None, watch).is_ok();
        told(&name, part, &work)?;
    }
    Ok(())
}

/// Prints what giving up some work comes to.
fn told(name: &str, part: Part, work: &(dyn Fn(&Watch) -> bool + Sync)) -> Result<(), String> {
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

/// A picture of this program's, as EXR and as PNG, of so many columns and rows.
fn pictures(luxel: &Luxel, side: u32) -> Result<[Vec<u8>; 2], String> {
    let scene = write("seen.scene", format!("{HEAD}{SEEN}").as_bytes())?;
    luxel.render(&scene, side, 1)?;
    let of = |name: &str| read(&scratch()?.join(name));
    Ok([of("picture.exr")?, of("picture.png")?])
}

/// A glTF file of many nodes, that refer to one triangle.
fn asset() -> Vec<u8> {
    let many = |one: &dyn Fn(usize) -> String| (0..NODES).map(one).collect::<Vec<_>>().join(",");
    let nodes = many(&|i| format!(r#"{{"mesh":0,"translation":[{i},0,0]}}"#));
    let roots = many(&|i| i.to_string());
    // The corners (0, 0, 0), (1, 0, 0) and (0, 1, 0).
    let buffer =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":36,"uri":"{buffer}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "nodes":[{nodes}],"scenes":[{{"nodes":[{roots}]}}],"scene":0}}"#
    );
    json.into_bytes()
}

/// What is loaded, again and again.
struct Load<'a> {
    /// Whether it was done before the watch was cancelled.
    work: &'a (dyn Fn(&Watch) -> bool + Sync),
}

impl Load<'_> {
    /// How long the part takes when nobody gives it up.
    fn whole(&self, part: Part) -> Result<Duration, String> {
        let watch = Watch::default();
        std::thread::scope(|scope| {
            let (began, load) = (Instant::now(), scope.spawn(|| self.load(&watch)));
            let tree = if part == Part::Any { began } else { begun(&watch, || load.is_finished()) };
            let (is_made, end) = load.join().expect("loading does not panic");
            let took = match part {
                Part::Any => end - began,
                Part::Before => tree - began,
                Part::Tree => end - tree,
            };
            is_made.then_some(took).ok_or_else(|| "what cannot be loaded".to_owned())
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

    /// Whether it is whole, and when it came to its end.
    fn load(&self, watch: &Watch) -> (bool, Instant) {
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
