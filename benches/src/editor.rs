//! How soon an editor is told what is wrong after a letter was typed into a large file.

use std::time::Instant;

use luxel_lang::Budgets;
use luxel_lang::editor::Document;

use crate::series::Series;

const BYTES: usize = 10_000_000;

/// Prints milliseconds from an edit to its diagnostics of syntax and names.
pub(crate) fn run() {
    println!("editor, ms from a typed letter to diagnostics of syntax and names, 10 MB (goal 50)");
    let object =
        "shape sphere \"ball N\" { center = (1.2, 0.5, -3.25) m, radius = r, material = m1 }\n";
    let objects: String =
        (0..BYTES / object.len()).map(|i| object.replace(" N", &format!(" {i}"))).collect();
    let head = "scene 1\nlet r = 50 cm\nlet m1 = material diffuse { reflectance = 0.5 }\n";
    let objects = format!("{head}{objects}");
    let middle = objects[..objects.len() / 2].rfind("radius = r").unwrap_or_default();
    report("objects, in a number", &objects, middle - 10, "7");
    report("objects, a new name", &objects, middle + 10, "x");
    let used = head.find("r = 50").unwrap_or_default() + 1;
    report("objects, what all use", &objects, used, "x");
    report("objects, an open brace", &objects, middle - 10, "{");
    let few = "let a = 1\n".repeat(3);
    let table =
        format!("scene 1\n{few}let t = #[{}1]\nlet z = 2\n", "0.2531 -12.25 ".repeat(BYTES / 14));
    report("table #[ ], beside it", &table, 16, "7");
    report("table #[ ], in it", &table, BYTES / 2, "7");
    let list = format!("scene 1\n{few}let t = [{}1]\nlet z = 2\n", "0.25, ".repeat(BYTES / 6));
    report("list [ ], beside it", &list, 16, "7");
    report("list [ ], in it", &list, 8 + few.len() + 9 + 6 * (BYTES / 12), "7");
}

fn report(name: &str, text: &str, at: usize, letter: &str) {
    let start = Instant::now();
    let mut document = Document::new(text, &Budgets::default());
    let open = start.elapsed().as_secs_f64();
    let series = Series::of(9, || {
        let typed = timed(|| {
            document.edit(at..at, letter);
            document.diagnostics().len()
        });
        document.edit(at..at + letter.len(), "");
        typed
    });
    println!(
        "  {name:24} {:8.1} ms (spread {:.0} %); opening it {open:.1} s",
        series.median(),
        series.spread()
    );
}

/// Milliseconds.
fn timed<T>(run: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    std::hint::black_box(run());
    start.elapsed().as_secs_f64() * 1e3
}
