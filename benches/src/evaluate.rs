//! What scenes of many things cost to read and evaluate: seconds, and the most memory at once.
//!
//! Each measurement is a process of its own, this program anew, so that none finds memory that
//! another one has left.

use std::path::Path;
use std::time::Instant;

use luxel_core::files::MemoryFiles;
use luxel_lang::{Budgets, Settings, load, parse_only};

use crate::process;
use crate::scene::{lines, linked};
use crate::series::Series;

/// The word that makes this program measure once.
const ONCE: &str = "evaluate-once";

/// What each scene begins with.
const HEAD: &str = "scene 1
camera perspective { fov = 40 deg, look = look_at(from = (0, 1, 9) m, to = (0, 1, 0) m, up = (0, 1, 0)) }
let grey = material diffuse { reflectance = 0.5 }
let ball = shape sphere { radius = 1 m, material = grey }
";

/// A scene of many things.
struct Case {
    name: &'static str,
    /// Things that stand in it.
    n: usize,
    text: fn(usize) -> String,
}

const CASES: [Case; 7] = [
    Case {
        name: "shapes, a loop",
        n: 500_000 - 10,
        text: |n| {
            format!(
                "for i in 0..{n} {{ shape sphere {{ center = (i, 0, 0) m, radius = 1 m, material = grey }} }}\n"
            )
        },
    },
    Case {
        name: "placements, a loop",
        n: 1_000_000 - 10,
        text: |n| format!("for i in 0..{n} {{ place ball {{ transform = move((i, 0, 0) m) }} }}\n"),
    },
    Case {
        name: "a table's, a loop",
        n: 1_000_000 - 10,
        text: |n| {
            let numbers = "0.2531 ".repeat(n);
            format!(
                "let t = #[{numbers}]\nfor x in t {{ place ball {{ transform = move((x, 0, 0) m) }} }}\n"
            )
        },
    },
    Case {
        name: "shapes, written out",
        n: 500_000 - 10,
        text: |n| {
            lines(n, |i| {
                format!(
                    "shape sphere {{ center = ({i}, 0, 0) m, radius = 1 m, material = grey }}\n"
                )
            })
        },
    },
    Case {
        name: "placements, written",
        n: 1_000_000 - 10,
        text: |n| lines(n, |i| format!("place ball {{ transform = move(({i}, 0, 0) m) }}\n")),
    },
    Case {
        name: "changes, written out",
        n: 450_000,
        text: |n| {
            let ball = "shape sphere \"ball\" { radius = 1 m }\n".to_owned();
            ball + &"set ball.radius = 2 m\n".repeat(n)
        },
    },
    Case {
        name: "names, written out",
        n: 500_000 - 10,
        text: |n| lines(n, |i| format!("let a{i} = {i} m\n")),
    },
];

/// Prints what each costs.
///
/// # Errors
/// This program does not start anew.
pub(crate) fn run() -> Result<(), String> {
    println!(
        "evaluate, seconds of processor time, of which reading, by the clock in brackets, and the \
         most memory (goal: 10^6 nodes 2 s)"
    );
    for case in &CASES {
        let text = ((case.text)(case.n).len() + HEAD.len()) as f64;
        let (reading, all) = (Measured::of(case, "read")?, Measured::of(case, "load")?);
        let bytes = all.megabytes * f64::from(1 << 20);
        println!(
            "  {:20} {:8} things {:5.1} MB {:5.2} s (spread {:.0} %), reading {:5.2} s ({:.2}, {:.2}) \
             {:5.0} MiB, {:5.0} bytes a thing, {:.1} a byte of text",
            case.name,
            case.n,
            text / 1e6,
            all.processor.median(),
            all.processor.spread(),
            reading.processor.median(),
            all.clock.median(),
            reading.clock.median(),
            all.megabytes,
            bytes / case.n as f64,
            bytes / text,
        );
    }
    Ok(())
}

/// What one case took.
struct Measured {
    /// Seconds in user mode of the whole process, the making of the text included.
    processor: Series,
    /// Seconds of the call.
    clock: Series,
    /// The median of the most that it held at once.
    megabytes: f64,
}

impl Measured {
    fn of(case: &Case, what: &str) -> Result<Self, String> {
        let (mut processor, mut clock, mut megabytes) = (vec![], vec![], vec![]);
        for _ in 0..3 {
            let (took, told) = process::again(ONCE, case.name, what)?;
            let printed = told.lines().next().and_then(|line| line.parse().ok());
            clock.push(printed.ok_or_else(|| told.clone())?);
            processor.push(took.cpu);
            megabytes.push(took.megabytes.unwrap_or(f64::NAN));
        }
        let [processor, clock, megabytes] = [processor, clock, megabytes].map(Series::from);
        Ok(Self { processor, clock, megabytes: megabytes.median() })
    }
}

/// Measures once and prints seconds, if this program was started for that.
pub(crate) fn once() -> bool {
    let Some((name, what)) = process::asked(ONCE) else { return false };
    let Some(case) = CASES.iter().find(|case| case.name == name) else { return false };
    let text = format!("{HEAD}{}", (case.text)(case.n));
    let seconds = if what == "read" { read(&text) } else { loaded(text) };
    report(&seconds);
    true
}

#[expect(clippy::print_stderr, reason = "the process around it listens there")]
fn report(seconds: &Result<f64, String>) {
    match seconds {
        Ok(seconds) => eprintln!("{seconds}"),
        Err(message) => eprintln!("{message}"),
    }
}

fn read(text: &str) -> Result<f64, String> {
    let start = Instant::now();
    let (_, told) = parse_only(text, &Budgets::default());
    if told.is_empty() { Ok(start.elapsed().as_secs_f64()) } else { Err(format!("{told:?}")) }
}

fn loaded(text: String) -> Result<f64, String> {
    let registry = linked();
    let files = MemoryFiles::default().with("a.scene", text.into_bytes());
    let start = Instant::now();
    let loaded = load(Path::new("a.scene"), &files, &registry, &Settings::default());
    let seconds = start.elapsed().as_secs_f64();
    loaded.scene.map(|_| seconds).ok_or_else(|| format!("{:?}", loaded.diagnostics))
}
