//! How soon the scene graph of a large file that was edited is up to date, and what an editor tells of it.

use std::path::Path;
use std::time::Instant;

use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_lang::{Kept, Loaded, Settings, load};

use crate::scene::{lines, linked};
use crate::series::Series;

const BYTES: usize = 10_000_000;

/// Edits of a file that are measured, each there and back.
const EDITS: usize = 9;

const HEAD: &str = "scene 1
camera perspective { fov = 40 deg, look = look_at(from = (0, 1, 9) m, to = (0, 1, 0) m, up = (0, 1, 0)) }
let r = 50 cm
let rare = material diffuse { reflectance = 0.2 }
let m1 = material diffuse { reflectance = 0.5 }
let ball = shape sphere { radius = r, material = m1 }
";

/// A text with so many mistakes, and what of it becomes what else.
struct Case {
    name: &'static str,
    text: String,
    mistakes: usize,
    from: &'static str,
    to: &'static str,
}

/// Prints milliseconds from an edited text to its scene graph.
///
/// # Errors
/// What is wrong with a scene.
pub(crate) fn run() -> Result<(), String> {
    println!("graph, ms from an edited text of 10 MB to its scene graph (goal 50);");
    println!("and to what an editor tells of it: mistakes and values, not the graph");
    let objects = format!("{HEAD}{}", shapes(object));
    let registry = linked();
    let cases = handed(&objects).into_iter().chain(others(&objects)).chain(mistakes(&objects));
    cases.into_iter().try_for_each(|case| report(&case, &registry))
}

/// One of many shapes.
fn object(i: usize) -> String {
    let material = if i.is_multiple_of(1000) { "rare" } else { "m1" };
    format!("shape sphere \"ball {i}\" {{ center = {CENTER}, {RADIUS} material = {material} }}\n")
}

const CENTER: &str = "(1.2, 0.5, -3.25) m";
const RADIUS: &str = "radius = r,";

/// What of a shape of all becomes what else.
const NUMBER: [&str; 2] = ["ball 50001\" { center = (1.2", "ball 50001\" { center = (1.3"];

/// So many lines that the text has its size.
fn shapes(line: impl Fn(usize) -> String) -> String {
    lines(BYTES / object(55_555).len(), line)
}

fn case(name: &'static str, text: &str, [from, to]: [&'static str; 2]) -> Case {
    Case { name, text: text.to_owned(), mistakes: 0, from, to }
}

/// Edits of what all shapes use.
fn handed(objects: &str) -> Vec<Case> {
    let length = ["r = 50 cm", "r = 40 cm"];
    let rare = ["reflectance = 0.2", "reflectance = 0.3"];
    let reckoning = objects.replace(RADIUS, "radius = r / 2,");
    let alike = objects.replace(CENTER, "(1.2 m, r, -3.25 m)");
    let moved = |i: usize| object(i).replace(CENTER, &format!("({i} mm, r, -3.25 m)"));
    let own = |i: usize| object(i).replace(RADIUS, &format!("radius = r / {},", i + 1));
    let called = |i: usize| object(i).replace(RADIUS, &format!("radius = part(r, {}),", i + 1));
    let apart = format!("{HEAD}{}", shapes(moved));
    let reckoned = format!("{HEAD}{}", shapes(own));
    let called = format!("{HEAD}fn part(x: length, n: int) = max(x / n, 1 mm)\n{}", shapes(called));
    vec![
        case("objects, a material of one in a thousand", objects, rare),
        case("objects, a length that all hand on", objects, length),
        case("objects, a material of nearly all", objects, ["e = 0.5", "e = 0.4"]),
        case("objects, a length that all reckon with", &reckoning, length),
        case("objects, a length in one vector of all", &alike, length),
        case("objects, a length in a vector of each", &apart, length),
        case("objects, a length that each reckons with", &reckoned, length),
        case("objects, a length that each calls a function with", &called, length),
    ]
}

/// Edits of single statements.
fn others(objects: &str) -> Vec<Case> {
    let one_more = ["shape sphere \"ball 50001", "place ball\nshape sphere \"ball 50001"];
    let told = format!("{objects}set one.radius = 30 cm\nmaterial dielectric {{ }}\n")
        .replacen("ball 3", "one", 1);
    let placement = |i: usize| format!("place ball {{ transform = move(({i}, 0.5, -3.25) m) }}\n");
    let placements = format!("{HEAD}{}", lines(BYTES / placement(55_555).len(), placement));
    vec![
        case("objects, a number", objects, NUMBER),
        case("objects, one more", objects, one_more),
        case("objects, the camera", objects, ["fov = 40", "fov = 35"]),
        case("objects, a number beside a `set` and a warning", &told, NUMBER),
        case("objects, what is `set`", &told, ["radius = 30 cm", "radius = 20 cm"]),
        case("placements, a number", &placements, ["move((50001, 0.5", "move((50001, 0.25"]),
    ]
}

/// Edits that are wrong, or beside what is.
fn mistakes(objects: &str) -> Vec<Case> {
    let of_number = |name, to| case(name, objects, [NUMBER[0], to]);
    let unclosed = ["shape sphere \"ball 50001", "let z = (1 m\nshape sphere \"ball 50001"];
    let block = ["shape sphere \"ball 50001", "group {\nshape sphere \"ball 50001"];
    let twice = ["let rare", "let r = 40 cm\nlet rare"];
    let wrong = objects.replacen("radius = r", "radus = r", 1);
    vec![
        of_number("objects, a mistake", "ball 50001\" { center = (1.2 s"),
        case("objects, a length of all that loses its value", objects, ["r = 50 cm", "r ="]),
        case("objects, a length of all that is defined twice", objects, twice),
        of_number("objects, an open bracket", "ball 50001\" { center = ((1.2"),
        case("objects, an open bracket at the end", objects, unclosed),
        case("objects, an open block at the end", objects, block),
        of_number("objects, an open block", "ball 50001\" { { center = (1.2"),
        of_number("objects, a text that does not end", "ball 50001 { center = (1.2"),
        Case { mistakes: 1, ..case("objects, a number, where a mistake stands", &wrong, NUMBER) },
    ]
}

fn report(case: &Case, registry: &Registry) -> Result<(), String> {
    let other = case.text.replacen(case.from, case.to, 1);
    let files = |text: &str| MemoryFiles::default().with("a.scene", text.as_bytes());
    let files = [files(&case.text), files(&other)];
    let path = Path::new("a.scene");
    let good = load(path, &files[0], registry, &Settings::default());
    if good.diagnostics.iter().filter(|told| told.is_error()).count() != case.mistakes {
        return Err(format!("{:?}", good.diagnostics));
    }
    drop(good);
    let again = |settings: &Settings| {
        let mut kept = Kept::default();
        let mut one = |i: usize| timed(|| kept.load(path, &files[i % 2], registry, settings));
        one(0);
        let took: Vec<f64> = (1..=EDITS).map(&mut one).collect();
        (Series::from(took), kept.n_evaluated().unwrap_or_default())
    };
    let settings = Settings::default();
    let (graph, n_evaluated) = again(&settings);
    let (editor, _) = again(&Settings { noting: true, without_scene: true, ..Settings::default() });
    let fresh = (0..3).map(|i| timed(|| load(path, &files[i % 2], registry, &settings)));
    let fresh = Series::from(fresh.collect());
    println!(
        "  {:42} {:7.1} ms (spread {:.0} %), editor {:7.1} ms (spread {:.0} %), from nothing {:6.0} ms, {:7} statements evaluated",
        case.name,
        graph.median(),
        graph.spread(),
        editor.median(),
        editor.spread(),
        fresh.median(),
        n_evaluated,
    );
    Ok(())
}

/// Milliseconds, dropping what was made left out.
fn timed(run: impl FnOnce() -> Loaded) -> f64 {
    let start = Instant::now();
    let loaded = std::hint::black_box(run());
    let took = start.elapsed().as_secs_f64() * 1e3;
    drop(loaded);
    took
}
