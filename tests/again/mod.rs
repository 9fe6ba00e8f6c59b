//! A large file, loaded again after each edit, is what a load from nothing gives.

mod concerned;
mod edited;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use luxel_core::files::MemoryFiles;
use luxel_lang::{Budgets, Settings};
use luxel_sdk::sampling::Rng;

use edited::{CAMERA, Edited, OTHER, is_good, text_of};

/// Statements that depend on others, emit, share, declare, read other files, or are wrong.
const LINES: [&str; 82] = [
    "let r = 5 cm",
    "let r = 25 cm",
    "let grey = material diffuse { reflectance = 0.5 }",
    "let grey = material diffuse { reflectance = rgb.linear_srgb(0.1, 0.2, size) }",
    "let shiny = material mix { a = grey, b = material dielectric { }, weight = 0.5 }",
    "let ball = shape sphere { radius = r, material = grey }",
    "let pair = group \"pair\" { place ball shape disk { radius = r, material = shiny } }",
    "let wide = ball with { radius = 2 * r }",
    "let rows = [for i in 0..3 => i * r]",
    "fn tower(n: int, step: length = r) { for i in 0..n { place ball { transform = move((0, i, 0) * step) } } }",
    "fn twice(x: length) = 2 * x",
    "shape sphere { radius = twice(r), center = (1, 2, 3) m, material = grey }",
    "shape sphere \"one\" { radius = 1 m }",
    "shape sphere \"two\" { radius = 1.5 m, material = shiny }",
    "shape sphere { radius = 1 m }\n// a remark\n",
    "/// What is said of it.\nshape disk { radius = 3 m, material = grey }",
    "place pair { transform = move((1, 0, 0) m), material = shiny }",
    "place wide",
    "tower(2)",
    "tower(3, step = 4 cm)",
    "for x in rows { shape sphere { radius = 1 cm, center = (x, 0, 0) } }",
    "group \"inner\" { place pair shape disk { radius = 1 cm } }",
    "if size < 0.5 { place ball } else { place wide }",
    "light constant { scale = 0.1 }",
    CAMERA,
    "film auto { resolution = (32, 16) }",
    "sampler sobol { samples = 4 }",
    "expect pixel (20, 10) = 0.5 ± 0.1",
    "import \"other.scene\" as other",
    "shape sphere { radius = other.far, material = other.red }",
    "include \"other.scene\" with { far = 3 m }",
    "let glass = material dielectric { n = glass(\"BK7\") }",
    "shape sphere { radius = r, material = glass }",
    "set one.radius = 7 cm",
    "material dielectric { }",
    "fn row(n: int) { let step = 2 cm for i in 0..n { shape sphere { radius = step, center = (n, i, 0) } } }",
    "row(2)",
    "row(3)",
    "shape sphere { radius = 5 deg, center = (r, 0) }",
    "let wrong = r + 2 s",
    "shape sphere { radus = wrong }",
    "@off shape sphere \"three\" { radius = nope }",
    "set one.radius = 8 cm",
    "set two.material = material diffuse { reflectance = size }",
    "set two.radius = twice(r)",
    "fn odd() { shape sphere \"one\" { radius = r } }",
    "odd()",
    "group { shape sphere \"two\" { radius = r } }",
    "twice(r)",
    "/// What is said of nothing.",
    "assert size < 0.3 and r > 1 cm, \"it is large\"",
    "let later = shape sphere { radius = r radius 2 }",
    "shape sphere { radius = r, material = grey, center = (1, 2, 3) m }",
    "shape sphere \"three\" { radius= r, material = material mix { a = grey, b = shiny, weight = size } }",
    "shape disk { radius /* how far */ = r, center = (r, r, 0), material = grey }",
    "light area { shape = shape sphere { radius = r, center = (0, 3, 0) m }, radiance = bright }",
    "shape sphere { radius = 2 * r, material = grey, center = (1, 2, 3) m }",
    "shape sphere { radius = (r + far * (r / far)) / 2 + r, material = grey }",
    "shape disk { radius = -(-r) * size % far, material = material mix { a = grey, b = shiny, weight = size / 2 } }",
    "let far = 3 m",
    "let far = 70 cm / size",
    "let bright = 3 W/m^2/sr",
    "let bright = rgb.linear_srgb(1, 2, 3) W/m^2/sr",
    "shape sphere { radius = r, center = (1.5 m, r, -2 * r), material = grey }",
    "shape sphere { radius = r, center = (0, r, 3 cm) }",
    "shape sphere \"four\" { radius = 1 m, center = ( far , -4 mm, r + (far) ) }",
    "shape sphere { radius = 1 m, center = (1, near, -2) }",
    "shape sphere { radius = 1 m, center = (near, near, 1 m) }",
    "let near = 3",
    "let near = 4 mm",
    "let near = 0",
    "let shiny = material conductor { eta = metal(\"Au\"), distribution = ggx }",
    "let shiny = material conductor { eta = metal(\"Au\"), distribution = word }",
    "let word = \"beckmann\"",
    "fn wider(x: length, by: float = 2) = twice(x) * by + far",
    "fn wider(x: length, by: int) = x * by",
    "fn twice(x: length) = 3 * x - 1 mm",
    "shape sphere { radius = wider(r), center = (1, 2, 3) m, material = grey }",
    "shape sphere { radius = max(wider(r, 3) * size, abs(far)), center = (twice(r), r, 3 cm) }",
    "shape sphere { radius = twice(r) + sqrt(far * r), center = (twice(r), sin(size * 1 rad) * r, r) }",
    "shape sphere { radius = 1 m, center = (1 m, -twice(r), min(r, far)) }",
    "shape disk { radius = wider(wider(r, by = 2)) }",
];

/// Half-written things, and what ends statements.
const PARTS: [&str; 16] = [
    "7",
    " ",
    "\n",
    "{",
    "}",
    "r",
    "//",
    "\"",
    "= ",
    "let ",
    "place ball\n",
    "1 m",
    "(",
    "[",
    ", (2",
    "\"\\q",
];

/// A number below `n`.
fn pick(rng: &mut Rng, n: usize) -> usize {
    rng.u32() as usize % n.max(1)
}

/// Changes some lines, as people and programs do.
fn edit(lines: &mut Vec<String>, rng: &mut Rng) {
    let i = pick(rng, lines.len());
    match pick(rng, 6) {
        0 => lines.insert(i, LINES[pick(rng, LINES.len())].to_owned()),
        1 if lines.len() > 4 => drop(lines.remove(i)),
        2 => lines[i] = LINES[pick(rng, LINES.len())].to_owned(),
        3 => {
            let j = pick(rng, lines.len());
            lines.swap(i, j);
        }
        4 => {
            let at = pick(rng, lines[i].len() + 1);
            let at = (0..=at).rev().find(|at| lines[i].is_char_boundary(*at)).unwrap_or(0);
            lines[i].insert_str(at, PARTS[pick(rng, PARTS.len())]);
        }
        _ => lines[i] = lines[i].replace(" = ", " =  ").replace('1', "2"),
    }
}

#[test]
fn after_any_edit_it_is_what_a_load_from_nothing_gives() {
    let (mut n_short, mut n_good, mut n_told, mut n_loads) = (0, 0, 0, 0);
    for seed in 0..60_u64 {
        let mut rng = Rng::new(seed);
        let set = if seed % 4 == 0 { vec![("size".to_owned(), "0.6".to_owned())] } else { vec![] };
        // Some are spent by one statement more.
        let budgets = Budgets {
            nodes: if seed % 3 == 0 { 1_000_000 } else { 57 },
            names: if seed % 2 == 0 { 500_000 } else { 12 },
            statements: if seed % 4 == 3 { 37 } else { 2_000_000 },
            ..Budgets::default()
        };
        let noting = seed % 5 != 1;
        let without_scene = seed % 7 == 1;
        let settings = Settings { set, budgets, noting, without_scene, ..Settings::default() };
        let mut edited = Edited::new(settings);
        let good = [
            0, 2, 59, 68, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15, 18, 20, 24, 52, 53, 54, 56, 57,
            58, 63, 64, 65, 66, 74, 77, 78, 79, 80,
        ];
        let more: &[usize] = [&[][..], &[33, 34], &[42, 43], &[44, 48]][pick(&mut rng, 4)];
        let mut lines: Vec<String> =
            good.iter().chain(more).map(|i| LINES[*i].to_owned()).collect();
        // Some files are wrong from the beginning, each statement for itself.
        let wrong: &[usize] = [&[][..], &[38, 40, 51], &[39, 41]][pick(&mut rng, 3)];
        for i in wrong {
            let at = pick(&mut rng, lines.len());
            lines.insert(at, LINES[*i].to_owned());
        }
        let mut last = lines.clone();
        for step in 0..25 {
            let loaded = edited.load(&text_of(&lines), &format!("seed {seed}, step {step}"));
            n_loads += 1;
            if step == 0 && wrong.is_empty() {
                assert!(is_good(&loaded), "{:#?}", loaded.diagnostics);
            }
            n_good += usize::from(is_good(&loaded));
            // Mistakes are taken back more often than not, as people do.
            if is_good(&loaded) {
                last.clone_from(&lines);
            } else if step % 4 > 0 {
                lines.clone_from(&last);
            }
            if step == 8 {
                last.retain(|line| !wrong.iter().any(|i| *line == LINES[*i]));
                lines.clone_from(&last);
            }
            edit(&mut lines, &mut rng);
            if seed == 0 {
                eprintln!("{seed} {step}");
            }
            if pick(&mut rng, 12) == 0 {
                edited.other = OTHER.replace("2 m", &format!("{step} m"));
            }
        }
        n_short += edited.n_short;
        n_told += edited.n_told;
    }
    let told = format!("{n_short} of {n_good} of {n_loads}, with mistakes {n_told}");
    assert!(
        n_good * 4 > n_loads && n_short * 4 > n_good && n_told * 10 > n_loads - n_good,
        "{told}"
    );
}

#[test]
fn a_load_that_was_given_up_at_any_moment_leaves_what_can_be_gone_on_from() {
    let mut now = vec!["let r = 5 cm".to_owned(), "let q = 1 cm".to_owned(), CAMERA.to_owned()];
    now.extend((0..1500).map(|i| match i % 8 {
        0 => format!("shape sphere {{ radius = 1 m, center = (2 * q, {i} m, q) }}"),
        1 => format!("shape sphere {{ radius = 2 * q, center = ({i}, 0, 0) m }}"),
        _ => format!("shape sphere {{ radius = r, center = ({i}, 0, 0) m }}"),
    }));
    let mut edited = Edited::new(Settings::default());
    assert!(is_good(&edited.load(&text_of(&now), "from nothing")));
    let (mut rng, mut n_given_up, mut whole) = (Rng::new(7), 0, Duration::ZERO);
    for round in 0..40 {
        now[round % 2] = format!("let {} = {round}.5 cm", ["r", "q"][round % 2]);
        let text = text_of(&now);
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let stop = Arc::new(AtomicBool::new(false));
        let settings = Settings { stop: Some(stop.clone()), ..Settings::default() };
        // The first two take as long as they take.
        let pause = if round < 2 { Duration::from_secs(1) } else { whole.mul_f64(rng.f64()) };
        let later = thread::spawn(move || {
            thread::park_timeout(pause);
            stop.store(true, Ordering::Relaxed);
        });
        let began = Instant::now();
        let loaded = edited.kept.load(Path::new("a.scene"), &files, &edited.registry, &settings);
        if round < 2 {
            assert!(is_good(&loaded));
            whole = began.elapsed();
        }
        later.thread().unpark();
        n_given_up += usize::from(loaded.scene.is_none());
        later.join().unwrap();
        edited.load(&text, &format!("after {pause:?} in round {round}"));
    }
    assert!(n_given_up > 0, "none of them in {whole:?}");
}

#[test]
fn a_mistake_in_place_of_the_camera_leaves_the_camera_missing() {
    let mut edited = Edited::new(Settings::default());
    let mut lines = vec!["shape sphere { radius = 1 m }".to_owned(), CAMERA.to_owned()];
    assert!(is_good(&edited.load(&text_of(&lines), "with a camera")));
    lines[1] = "shape sphere { radius = 1 s }".to_owned();
    let codes: Vec<_> =
        edited.load(&text_of(&lines), "without").diagnostics.iter().map(|it| it.code).collect();
    assert!(codes.contains(&"E0409"), "{codes:?}");
}

#[test]
fn what_a_call_is_depends_on_what_stands_elsewhere() {
    let mut edited = Edited::new(Settings::default());
    let mut lines = vec![
        "fn twice(x: length) = 2 * x".to_owned(),
        "shape sphere { radius = 1 m, twice(3 m) }".to_owned(),
        CAMERA.to_owned(),
    ];
    assert!(is_good(&edited.load(&text_of(&lines), "a call that gives a value")));
    // Now it is a parameter whose `=` is missing.
    "fn twice_(x: length) = 2 * x".clone_into(&mut lines[0]);
    let told = edited.load(&text_of(&lines), "nothing that can be called").diagnostics;
    let codes: Vec<_> = told.iter().map(|it| it.code).collect();
    assert!(codes.contains(&"E0012") && !codes.contains(&"E0114"), "{codes:?}");
}
