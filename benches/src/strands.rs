//! Rays against hair: strands under the tree of their shape, and one after the other.

use std::fmt::Write as _;
use std::time::Instant;

use glam::DVec3;
use luxel_core::accel::Processor;
use luxel_core::stage::{Geometry, Stage};
use luxel_sdk::num::Ray;
use luxel_sdk::sampling::{Rng, uniform_sphere};

use crate::scene::{linked, stage_of};
use crate::series::Series;

/// Strands, of four segments each.
const STRANDS: u32 = 10_000;
/// Rays of a round under the tree, and one after the other.
const RAYS: [u32; 2] = [100_000, 200];
const ROUNDS: usize = 5;

/// Prints rays per second, for rods and for ribbons.
///
/// # Errors
/// The scene does not build.
pub(crate) fn run() -> Result<(), String> {
    println!("{STRANDS} strands of 4 segments on a ball, one thread; rays/s, median of {ROUNDS}");
    println!("  {:8} {:>12} {:>8} {:>12} {:>8}", "form", "tree", "spread", "in a loop", "spread");
    for form in ["round", "ribbon"] {
        let stage = hair(form)?;
        let Geometry::Analytic(shape) = &*stage.geometries[0] else {
            return Err("strands are no mesh".to_owned());
        };
        let tree = Series::of(ROUNDS, || {
            rate(RAYS[0], |ray| {
                stage.opening().intersect(Processor::widest(), ray, None, &mut 0).is_some()
            })
        });
        let shape = shape.object().fixed().shape();
        let all = Series::of(ROUNDS, || rate(RAYS[1], |ray| shape.intersect(ray).is_some()));
        println!(
            "  {form:8} {:12.0} {:6.1} % {:12.0} {:6.1} %",
            tree.median(),
            tree.spread(),
            all.median(),
            all.spread()
        );
    }
    Ok(())
}

/// Rays per second from around the ball to points in its hair.
fn rate(n: u32, mut ask: impl FnMut(&Ray) -> bool) -> f64 {
    let mut rng = Rng::new(9);
    let mut point = |r: f64| uniform_sphere(rng.pair()).as_dvec3() * r;
    let rays: Vec<Ray> = (0..n)
        .map(|_| {
            let (from, to) = (point(3.0), point(1.1));
            Ray::new(from, (to - from).normalize())
        })
        .collect();
    let start = Instant::now();
    let hits = rays.iter().filter(|ray| ask(ray)).count();
    let seconds = start.elapsed().as_secs_f64();
    std::hint::black_box(hits);
    f64::from(n) / seconds
}

fn hair(form: &str) -> Result<Stage, String> {
    let mut rng = Rng::new(8);
    let mut text = format!(
        "scene 1\nshape curves {{ form = \"{form}\", radius = 1 mm, strands = #[13], points = #[\n"
    );
    for _ in 0..STRANDS {
        let mut random = || uniform_sphere(rng.pair()).as_dvec3();
        let (root, mut at) = (random(), DVec3::ZERO);
        for i in 0..13 {
            let p = root * (1.0 + f64::from(i) * 0.02) + at;
            at += random() * 0.004;
            write!(text, "{} {} {} ", p.x, p.y, p.z).map_err(|error| error.to_string())?;
        }
        text.push('\n');
    }
    text += "] m }\ncamera perspective { look = look_at(from = (0, 0, 3) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }\n";
    stage_of(&linked(), &text)
}
