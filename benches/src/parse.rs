//! How fast scene text is read, evaluation left out.

use std::time::Instant;

use luxel_lang::{Budgets, parse_only};

use crate::series::Series;

const OBJECT: &str = "shape sphere \"ball\" { center = (1.2, 0.5, -3.25) m, radius = 50 cm, \
     material = material diffuse { reflectance = rgb.linear_srgb(0.5, 0.25, 0.125) } }\n";

/// Prints megabytes per second for what large scenes are made of.
pub(crate) fn run() {
    println!("parse, MB/s of scene text on one call (goals: objects 2, lists and tables 150)");
    let text = |body: String| format!("scene 1\n{body}\n");
    report("objects", &text(OBJECT.repeat(20_000)));
    report("table #[ ]", &text(format!("let t = #[{}1]", "0.2531 -12.25 ".repeat(500_000))));
    report("list [ ]", &text(format!("let t = [{}1]", "0.25, ".repeat(1_000_000))));
    let depth = 100;
    let nested = format!("let a = {}5 +{}", "material x { b = ".repeat(depth), " }".repeat(depth));
    let text = text(nested);
    let series = Series::of(9, || once(&text) * 1e3);
    println!(
        "  error inside {depth} objects: {:.2} ms (spread {:.0} %), goal 5",
        series.median(),
        series.spread()
    );
}

fn report(name: &str, text: &str) {
    let megabytes = text.len() as f64 / 1e6;
    let series = Series::of(7, || megabytes / once(text));
    println!(
        "  {name:12} {megabytes:5.1} MB {:8.1} MB/s (spread {:.0} %)",
        series.median(),
        series.spread()
    );
}

/// Seconds for one reading.
fn once(text: &str) -> f64 {
    let budgets = Budgets::default();
    let start = Instant::now();
    std::hint::black_box(parse_only(text, &budgets));
    start.elapsed().as_secs_f64()
}
