//! How fast scene text is read, evaluation left out, and what its tree holds: by the reader that is in
//! use, and by pest, which is the grammar of record; how fast the pass before both finds where
//! statements begin; and how fast it is laid out.

use std::path::Path;
use std::time::Instant;

use luxel_lang::{Budgets, format as lay_out, parse_by_pest, parse_only, prescan};

use crate::process;
use crate::scene::lines;
use crate::series::Series;

/// The word that makes this program read a text once.
const ONCE: &str = "parse-once";

/// Measurements of a rate.
pub(crate) const ROUNDS: usize = 5;

/// Processor seconds of one measurement.
const LEAST: f64 = 0.4;

const OBJECT: &str = "shape sphere \"ball\" { center = (1.2, 0.5, -3.25) m, radius = 50 cm, \
     material = material diffuse { reflectance = rgb.linear_srgb(0.5, 0.25, 0.125) } }\n";

/// What large scenes are made of.
pub(crate) struct Case {
    name: &'static str,
    text: fn() -> String,
}

pub(crate) const OBJECTS: Case = Case { name: "objects", text: || OBJECT.repeat(20_000) };
pub(crate) const TABLE: Case = Case {
    name: "table #[ ]",
    text: || format!("let t = #[{}1]", "0.2531 -12.25 ".repeat(700_000)),
};

const CASES: [Case; 6] = [
    OBJECTS,
    Case {
        name: "placements",
        text: || lines(60_000, |i| format!("place ball {{ transform = move(({i}, 0, 0) m) }}\n")),
    },
    Case {
        name: "expressions",
        text: || {
            lines(30_000, |i| {
                format!(
                    "let x{i} = (a * (b + {i}) - sin(c / 2 m) ^ 2) * d.e[3] + if a > {i} {{ 1 }} else {{ 2 }}\n"
                )
            })
        },
    },
    Case {
        name: "deep lists",
        text: || {
            lines(6_000, |i| format!("let x{i} = {}a{}\n", "[".repeat(100), " + 1]".repeat(100)))
        },
    },
    Case { name: "list [ ]", text: || format!("let t = [{}1]", "0.25, ".repeat(1_600_000)) },
    TABLE,
];

impl Case {
    fn scene(&self) -> String {
        format!("scene 1\n{}\n", (self.text)())
    }
}

/// A way to read a text, or to go on from there.
struct Reader {
    name: &'static str,
    read: fn(&str),
}

const READERS: [Reader; 4] = [
    Reader {
        name: "ours",
        read: |text| drop(std::hint::black_box(parse_only(text, &Budgets::default()))),
    },
    Reader {
        name: "pest",
        read: |text| drop(std::hint::black_box(parse_by_pest(text, &Budgets::default()))),
    },
    Reader {
        name: "pre-scan",
        read: |text| {
            let limit = Budgets::default().brackets;
            drop(std::hint::black_box(prescan::scan(text, 0..text.len(), 0, limit)));
        },
    },
    Reader {
        name: "format",
        read: |text| drop(std::hint::black_box(lay_out(text, &Budgets::default()))),
    },
];

/// Prints megabytes per second of processor time, what is held at most for a byte of text, and how many
/// processors the reader in use keeps busy.
///
/// # Errors
/// This program does not start anew.
pub(crate) fn run() -> Result<(), String> {
    println!(
        "parse, MB/s of scene text per second of processor time (goals: objects 10, lists and tables 150, pre-scan 200)"
    );
    for case in &CASES {
        let text = case.scene();
        print!("  {:12} {:5.1} MB", case.name, text.len() as f64 / 1e6);
        for reader in &READERS {
            let series = rates(&text, reader, ROUNDS);
            let held = peak(case, reader)? / text.len() as f64;
            print!(
                "   {} {:6.1} MB/s (spread {:2.0} %), {held:4.1} bytes a byte",
                reader.name,
                series.median(),
                series.spread()
            );
        }
        let busy = Series::of(ROUNDS, || reading(&text, &READERS[0]).busy);
        println!("   on {:.2} processors", busy.median());
    }
    mistake();
    Ok(())
}

/// Megabytes per second of processor time of the reader that is in use, measured so many times.
pub(crate) fn ours(case: &Case, times: usize) -> Series {
    rates(&case.scene(), &READERS[0], times)
}

fn rates(text: &str, reader: &Reader, times: usize) -> Series {
    Series::of(times, || reading(text, reader).rate)
}

/// How long a mistake inside many objects takes, on the wall.
fn mistake() {
    let depth = 100;
    let nested = format!(
        "scene 1\nlet a = {}5 +{}\n",
        "material x { b = ".repeat(depth),
        " }".repeat(depth)
    );
    let series = Series::of(9, || {
        let start = Instant::now();
        std::hint::black_box(parse_only(&nested, &Budgets::default()));
        start.elapsed().as_secs_f64() * 1e3
    });
    println!(
        "  error inside {depth} objects: {:.2} ms (spread {:.0} %), goal 5",
        series.median(),
        series.spread()
    );
}

/// What reading a text again and again took.
struct Reading {
    /// Megabytes per second of processor time, all threads together.
    rate: f64,
    /// Seconds of processor time in a second.
    busy: f64,
}

fn reading(text: &str, reader: &Reader) -> Reading {
    let (start, begun, mut read) = (processor_seconds(), Instant::now(), 0.0);
    loop {
        (reader.read)(text);
        read += text.len() as f64 / 1e6;
        let seconds = processor_seconds() - start;
        // Where the system does not tell, it is not a number and one reading is enough.
        if seconds.is_nan() || seconds >= LEAST {
            return Reading { rate: read / seconds, busy: seconds / begun.elapsed().as_secs_f64() };
        }
    }
}

/// Seconds of processor time that this process took, in steps of 10 ms; not a number where the system
/// does not tell.
fn processor_seconds() -> f64 {
    let told = process::read(Path::new("/proc/self/stat")).unwrap_or_default();
    let told = String::from_utf8_lossy(&told);
    // User and system, counted from behind the program's name.
    let numbers = told.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: Vec<f64> = numbers.skip(11).take(2).filter_map(|n| n.parse().ok()).collect();
    if ticks.len() == 2 { (ticks[0] + ticks[1]) / 100.0 } else { f64::NAN }
}

/// The bytes that a reading holds at most, the text left out, measured in a process of its own.
fn peak(case: &Case, reader: &Reader) -> Result<f64, String> {
    let held = |reader: &str| {
        let (took, _) = process::again(ONCE, case.name, reader)?;
        Ok::<_, String>(took.megabytes.unwrap_or(f64::NAN) * f64::from(1 << 20))
    };
    Ok(held(reader.name)? - held("none")?)
}

/// Reads a text once, if this program was started for that.
pub(crate) fn once() -> bool {
    let Some((name, what)) = process::asked(ONCE) else { return false };
    let Some(case) = CASES.iter().find(|case| case.name == name) else { return false };
    let mut text = String::with_capacity(16 << 20);
    text.push_str("scene 1\n");
    text.push_str(&(case.text)());
    if let Some(reader) = READERS.iter().find(|reader| reader.name == what) {
        (reader.read)(&text);
    }
    true
}
