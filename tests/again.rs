//! A large file, loaded again after each edit, is what a load from nothing gives.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use luxel_core::diag::{Diagnostic, Sources};
use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_lang::{Budgets, Kept, Loaded, Settings, load};
use luxel_sdk::sampling::Rng;

use crate::load::registry;

const CAMERA: &str = "camera perspective { fov = 40 deg, look = look_at(from = (0, 0, 9) m, \
                      to = (0, 0, 0) m, up = (0, 1, 0)) }";

/// Statements that depend on others, emit, share, declare, read other files, or are wrong.
const LINES: [&str; 71] = [
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
];

/// Half-written things, and what ends statements.
const PARTS: [&str; 12] =
    ["7", " ", "\n", "{", "}", "r", "//", "\"", "= ", "let ", "place ball\n", "1 m"];

const OTHER: &str = "scene 1\nparam far: length = 2 m\nlet red = material diffuse { reflectance = rgb.linear_srgb(1, 0, 0) }\n\
                     shape sphere { radius = far, material = red }\n";

/// What the file begins with, and what makes it large at no cost.
fn text_of(lines: &[String]) -> String {
    let head = "scene 1\nparam size: float = 0.4 in 0..=1\nunits { length = mm }\n";
    format!("{head}\n{}\n//{}\n", lines.join("\n"), " ".repeat(1 << 18))
}

fn is_good(loaded: &Loaded) -> bool {
    !loaded.diagnostics.iter().any(Diagnostic::is_error)
}

/// What a load gives, in words that can be compared.
fn told(loaded: &Loaded) -> String {
    let texts: Vec<_> = Sources::texts(&loaded.sources).map(str::len).collect();
    let Loaded { scene, diagnostics, params, values, .. } = loaded;
    let values = values.all();
    format!("{scene:#?}\n{diagnostics:#?}\n{params:#?}\n{texts:?}\n{values:#?}")
}

/// A file that is edited, and another one that it reads.
struct Edited {
    registry: Registry,
    kept: Kept,
    settings: Settings,
    other: String,
    n_short: usize,
    /// Short ones with a mistake.
    n_told: usize,
}

impl Edited {
    fn new(settings: Settings) -> Self {
        let (registry, kept, other) = (registry(), Kept::default(), OTHER.to_owned());
        Self { registry, kept, settings, other, n_short: 0, n_told: 0 }
    }

    /// How many statements are evaluated after an edit, and how many diagnostics there are.
    fn counted(&mut self, lines: &[String]) -> (usize, usize) {
        let loaded = self.load(&text_of(lines), "an edit");
        (self.kept.n_evaluated().unwrap_or_default(), loaded.diagnostics.len())
    }

    fn load(&mut self, text: &str, step: &str) -> Loaded {
        let files = || {
            let other: Arc<[u8]> = self.other.as_bytes().into();
            MemoryFiles::default().with("a.scene", text.as_bytes()).with("other.scene", other)
        };
        let path = Path::new("a.scene");
        let (short, whole) = (files(), files());
        let again = self.kept.load(path, &short, &self.registry, &self.settings);
        let mut fresh = load(path, &whole, &self.registry, &self.settings);
        if self.settings.without_scene && again.scene.is_none() && is_good(&fresh) {
            fresh.scene = None;
        }
        let shown = text.trim_end_matches(['/', ' ', '\n']);
        assert!(again.scene == fresh.scene, "{step}\n{shown}\n{}\n{}", told(&again), told(&fresh));
        assert_eq!(told(&again), told(&fresh), "{step}\n{shown}");
        let mut asked = [short.asked(), whole.asked()];
        for asked in &mut asked {
            asked.sort();
            asked.dedup();
        }
        // Where it cannot go on from the last one, it has asked for what that one had read.
        assert!(asked[1].iter().all(|path| asked[0].contains(path)), "{step}\n{shown}");
        let n_stmts = text.lines().count();
        let is_short = self.kept.n_evaluated().is_some_and(|n| n < n_stmts / 3);
        self.n_short += usize::from(is_short && is_good(&again));
        self.n_told += usize::from(is_short && !is_good(&again));
        again
    }
}

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
            nodes: if seed % 3 == 0 { 1_000_000 } else { 49 },
            names: if seed % 2 == 0 { 500_000 } else { 11 },
            ..Budgets::default()
        };
        let noting = seed % 5 != 1;
        let without_scene = seed % 7 == 1;
        let settings = Settings { set, budgets, noting, without_scene, ..Settings::default() };
        let mut edited = Edited::new(settings);
        let good = [
            0, 2, 59, 68, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15, 18, 20, 24, 52, 53, 54, 56, 57,
            58, 63, 64, 65, 66,
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

/// Some lines, and many that one edit need not concern.
fn with_disks(first: &[&str]) -> Vec<String> {
    let disk = |i| format!("shape disk {{ radius = 2 m, center = (0, {i}, 0) }}");
    first.iter().map(|line| (*line).to_owned()).chain((0..60).map(disk)).collect()
}

#[test]
fn beside_warnings_and_what_is_set_an_edit_concerns_its_statement() {
    let mut now = with_disks(&[
        "let r = 5 cm",
        "let q = 1 cm",
        "material dielectric { }",
        "fn half(x: length) = x / 2",
        "half(q)",
        "shape sphere \"one\" { radius = 1 m }",
        "set one.radius = 2 * q",
        CAMERA,
    ]);
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| edited.counted(lines);
    assert_eq!(n(&now).1, 2);
    // One of many and what it uses.
    now[20] = now[20].replace("2 m", "r");
    assert_eq!(n(&now), (2, 2));
    // A length, the call that it is given to, the function, the sphere of which it is set, the `set`.
    now[1] = "let q = 2 cm".to_owned();
    assert_eq!(n(&now), (5, 2));
    // The sphere, the `set`, the length.
    now[5] = now[5].replace("1 m", "3 m");
    assert_eq!(n(&now), (3, 2));
    now[21] = now[21].replace("2 m", "2 s");
    assert_eq!(n(&now), (1, 3));
}

#[test]
fn beside_mistakes_that_stood_there_before_an_edit_concerns_its_statement() {
    let first = ["let r = 5 cm", "shape sphere { radus = 1 m }", "let wrong = r + 2 s", CAMERA];
    let mut now = with_disks(&first);
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| edited.counted(lines);
    assert_eq!(n(&now).1, 2);
    now[20] = now[20].replace("2 m", "3 m");
    assert_eq!(n(&now), (1, 2));
    // One more, further down: the statements between are read again, and evaluated.
    now[23] = now[23].replace("2 m", "2 s");
    assert_eq!(n(&now), (4, 3));
}

#[test]
fn of_vectors_that_each_shape_has_for_itself_the_numbers_are_handed_on() {
    let ball = |i: usize| {
        let center = match i % 5 {
            0 => format!("({} mm, r, -2 * r)", i + 1),
            1 => format!("(r, -(r / 2), {i}.5 m)"),
            2 => format!("({i}, 3, -1)"),
            3 => format!("(0, r, -{i} cm)"),
            _ => format!("(bare, r, {i} cm)"),
        };
        format!("shape sphere {{ radius = 1 m, center = {center} }}")
    };
    let mut lines = ["let r = 5 cm", "let bare = 0", CAMERA].map(str::to_owned).to_vec();
    lines.extend((0..60).map(ball));
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |first: &str| {
        first.clone_into(&mut lines[0]);
        edited.counted(&lines)
    };
    assert_eq!(n("let r = 5 cm"), (65, 0));
    // The length, and the zero beside it.
    assert_eq!(n("let r = 7 cm"), (2, 0));
    assert_eq!(n("let r = 0 m"), (2, 0));
    assert_eq!(n("let r = -2 m"), (2, 0));
    // A bare zero is shown otherwise, and what measures something else fits nowhere: a load from nothing.
    assert_eq!(n("let r = 0").1, 0);
    assert_eq!(n("let r = 3 m").1, 0);
    assert!(n("let r = 1 s").1 > 0);
}

#[test]
fn what_only_hands_a_value_on_is_not_evaluated() {
    let mut now: Vec<String> =
        ["let r = 5 cm", "let grey = material diffuse { reflectance = 0.5 }", CAMERA]
            .map(str::to_owned)
            .to_vec();
    let ball = |i: usize| match i % 3 {
        0 => "shape sphere { radius = r, center = (1, 2, 3) m, material = grey }",
        1 => "light area { shape = shape disk { radius = r }, radiance = 1 W/m^2/sr }",
        _ => {
            "shape disk { radius = 2 m, material = material mix { a = grey, b = grey, weight = 0.1 } }"
        }
    };
    now.extend((0..60).map(|i| ball(i).to_owned()));
    for noting in [false, true] {
        let settings = Settings { noting, ..Settings::default() };
        let mut edited = Edited::new(settings);
        let mut lines = now.clone();
        let mut n = |lines: &[String]| {
            let loaded = edited.load(&text_of(lines), "an edit");
            (edited.kept.n_evaluated().unwrap_or_default(), is_good(&loaded))
        };
        assert_eq!(n(&lines), (65, true));
        lines[0] = "let r = 7 cm".to_owned();
        assert_eq!(n(&lines), (1, true));
        lines[1] = "let grey = material conductor { eta = metal(\"Au\") }".to_owned();
        assert_eq!(n(&lines), (1, true));
        // Also what was written since, of which a part of a part and the whole hand the same on.
        let both = "material mix { a = grey, b = grey, weight = 0.2 }";
        let ball = format!(
            "shape sphere {{ radius = r, material = material mix {{ a = grey, b = {both}, weight = 0.1 }} }}"
        );
        lines.insert(20, ball);
        // With what it uses, and the next one, which begins alike.
        assert_eq!(n(&lines), (4, true));
        lines[1] = "let grey = material diffuse { reflectance = 0.3 }".to_owned();
        assert_eq!(n(&lines), (1, true));
        lines[0] = "let r = 7.5 cm".to_owned();
        assert_eq!(n(&lines), (1, true));
        // A vector of what is reckoned too, of which an item may become a bare zero.
        lines[9] = lines[9].replace("(1, 2, 3) m", "(r, 2 * r, 0)");
        assert_eq!(n(&lines), (3, true));
        lines[0] = "let r = 8 cm".to_owned();
        assert_eq!(n(&lines), (1, true));
        // One that does more than that is evaluated, with what it uses.
        lines[9] = lines[9].replace("(r, 2 * r, 0)", "(r, 2 * r, r) * 2");
        assert_eq!(n(&lines), (3, true));
        lines[0] = "let r = 9 cm".to_owned();
        assert_eq!(n(&lines), (3, true));
        // What is wrong for all of them is told of each.
        lines[0] = "let r = 8 s".to_owned();
        assert!(!n(&lines).1);
    }
}

#[test]
fn vectors_of_what_is_reckoned_are_not_evaluated() {
    let mut now: Vec<String> =
        ["let x = 5 cm", "let at = (1, 2, 3) m", CAMERA].map(str::to_owned).to_vec();
    now.extend((0..60).map(|i| match i % 3 {
        0 => format!("shape sphere {{ radius = 1 m, center = (x, {i} m, 2 * x) }}"),
        1 => "shape sphere { radius = 1 m, center = (0, x, 0) }".to_owned(),
        _ => "shape sphere { radius = 1 m, center = at }".to_owned(),
    }));
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| {
        let loaded = edited.load(&text_of(lines), "an edit");
        (edited.kept.n_evaluated().unwrap_or_default(), is_good(&loaded))
    };
    assert_eq!(n(&now), (65, true));
    for (i, line) in [(0, "let x = 7 cm"), (1, "let at = (0, 0, 3) m"), (0, "let x = 0 mm")] {
        line.clone_into(&mut now[i]);
        assert_eq!(n(&now), (1, true), "{line}");
    }
    for (i, line) in [(0, "let x = 1 s"), (1, "let at = (1, 2) m"), (0, "let x = (1, 2) m")] {
        let before = std::mem::replace(&mut now[i], line.to_owned());
        assert!(!n(&now).1, "{line}");
        now[i] = before;
        assert!(n(&now).1, "{line}");
    }
}

#[test]
fn what_only_reckons_with_a_value_is_not_evaluated() {
    let mut now: Vec<String> = ["let r = 5 cm", "let k = 2", CAMERA, "fn half(x: length) = x / 2"]
        .map(str::to_owned)
        .to_vec();
    now.extend((0..60).map(|i| match i % 3 {
        0 => "shape sphere { radius = (r + 1 cm) / k }".to_owned(),
        1 => format!("shape disk {{ radius = r * {i}, inner_radius = r * {i} / 2 }}"),
        _ => "shape disk { radius = 2 m }".to_owned(),
    }));
    let settings = Settings { noting: true, ..Settings::default() };
    let mut edited = Edited::new(settings);
    let mut n = |lines: &[String]| {
        let loaded = edited.load(&text_of(lines), "an edit");
        (edited.kept.n_evaluated().unwrap_or_default(), is_good(&loaded))
    };
    now[5] = now[5].replace("r * 1,", "r * 7,");
    assert_eq!(n(&now), (66, true));
    // The length, and what else is reckoned with.
    now[0] = "let r = 7 cm".to_owned();
    assert_eq!(n(&now), (2, true));
    now[1] = "let k = 3".to_owned();
    assert_eq!(n(&now), (2, true));
    // Where a number is no longer one, or is divided by nothing, it is a mistake of each.
    for wrong in ["0", "\"two\"", "(1, 2)", "1 s"] {
        now[1] = format!("let k = {wrong}");
        assert!(!n(&now).1, "{wrong}");
    }
    now[1] = "let k = 4".to_owned();
    assert!(n(&now).1);
    // A call takes steps of its own, and its statement is evaluated, with what it uses.
    now[4] = now[4].replace("(r + 1 cm) / k", "half(r) / k");
    assert_eq!(n(&now), (4, true));
    now[0] = "let r = 9 cm".to_owned();
    assert_eq!(n(&now), (4, true));
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
