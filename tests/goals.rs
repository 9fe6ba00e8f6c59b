//! Pictures that go on until they are good, or until they are whole: what is asked is what one gets,
//! and it does not matter how often one was stopped.

use std::num::NonZeroUsize;
use std::path::Path;
use std::time::Duration;

use glam::UVec2;
use luxel_core::files::MemoryFiles;
use luxel_core::film::{Above, Confidence, Errors, Film, Rect, half_width_95};
use luxel_core::render::{Control, Goal, Options, Outcome, Reached, render, render_on};
use luxel_core::stage::Stage;

use crate::load::stage_of;

/// A white floor under a disc of radius and height 1 m: π/2 of irradiance below its centre, so 1/2 to
/// look at.
const SCENE: &str = "scene 1
    camera perspective { look = look_at(from = (0, 0.5, 0) m, to = (0, 0, 0) m, up = (0, 0, 1)), fov = 0.01 deg }
    film rgb { resolution = (64, 32) }
    integrator direct {}
    sampler independent { seed = 3 }
    light area { shape = shape disk { center = (0, 1, 0) m, normal = (0, -1, 0), radius = 1 m }, spectrum = rgb.linear_srgb(1, 1, 1), scale = 1 }
    shape rectangle \"floor\" { center = (0, 0, 0) m, u = (0, 0, 1) m, v = (1, 0, 0) m, material = material diffuse { reflectance = 1 } }";

const TRUTH: f64 = 0.5;

fn stage(text: &str) -> Stage {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    stage_of(Path::new("a.scene"), &files, &[], None).unwrap_or_else(|said| panic!("{said:?}"))
}

fn empty(stage: &Stage) -> Film {
    let size = stage.film.resolution;
    Film::new(size, Rect::new(UVec2::ZERO, size))
}

fn asked(error: f64) -> Options {
    let goal = Goal { error: Some(error), ..Goal::default() };
    Options { goal, ..Options::default() }
}

#[test]
fn what_is_asked_is_what_one_gets() {
    for sampler in ["independent", "sobol"] {
        let stage = stage(&SCENE.replace("independent", sampler));
        let (film, outcome) = render(&stage, &asked(0.02), &Control::default());
        assert_eq!(outcome, Outcome::Complete);
        let said = Errors::of_film(&film, 0.02).unwrap();
        assert_eq!(said.tiles_above, 0);
        let squares = film.pixels().map(|(_, pixel)| (pixel.mean.y / TRUTH - 1.0).powi(2));
        let is = (squares.sum::<f64>() / film.window.area() as f64).sqrt();
        // 2048 errors tell their root mean square to 1.6 %.
        assert!(is <= 0.02 * (1.0 + 4.0 * 0.016), "{sampler}: {is}");
        assert!(is <= said.rms * (1.0 + 4.0 * 0.016), "{sampler}: {is}, said {}", said.rms);
        // And not four times the samples: tiles at most double, so the error is above half of it.
        assert!(said.rms > 0.01, "{sampler}: {}", said.rms);
    }
}

#[test]
fn with_confidence_the_error_asked_holds_for_that_share_of_the_pixels() {
    let stage = stage(SCENE);
    let goal = Goal { confidence: Some(Confidence::USUAL), ..asked(0.04).goal };
    let (film, outcome) =
        render(&stage, &Options { goal, ..Options::default() }, &Control::default());
    assert_eq!(outcome, Outcome::Complete);
    assert_eq!(Above::of_film(&film, (0.04, goal.confidence), 5).tiles, 0);
    let said = Errors::of_film(&film, 0.04).unwrap();
    assert!(said.rms * half_width_95(film.most_samples()) <= 0.04, "{said:?}");
    let held =
        film.pixels().filter(|(_, pixel)| (pixel.mean.y / TRUTH - 1.0).abs() <= 0.04).count();
    // Four standard deviations of the share of 2048 pixels, of which 95 % at the least are to be held.
    let share = held as f64 / film.window.area() as f64;
    assert!(share >= 0.95 - 4.0 * (0.95_f64 * 0.05 / 2048.0).sqrt(), "{share}");
    // As one standard error it asks for about a quarter of the samples.
    let plain = render(&stage, &asked(0.04), &Control::default()).0;
    assert!(plain.samples() * 2 < film.samples(), "{} {}", plain.samples(), film.samples());
}

/// On the left a lamp in brushed metal, on the right an even sky.
const UNEVEN: &str = "scene 1
    camera orthographic { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 2 m }
    film rgb { resolution = (64, 32) }
    sampler sobol { seed = 3 }
    integrator path {}
    light constant { scale = 0.5 }
    light area { shape = shape sphere { center = (-1, 0, 2) m, radius = 30 cm }, scale = 9 }
    shape rectangle \"noisy\" { center = (-1, 0, 0) m, u = (2, 0, 0) m, v = (0, 2, 0) m, material = material conductor { eta = 0.2, k = 3, roughness = 0.4 } }";

#[test]
fn samples_go_where_they_are_needed_for_any_number_of_threads() {
    let stage = stage(UNEVEN);
    let with = |n| {
        let threads = Some(NonZeroUsize::new(n).unwrap());
        let options = Options { threads, spp: Some(1000), ..asked(0.03) };
        render(&stage, &options, &Control::default()).0
    };
    let film = with(1);
    let counts: Vec<u32> = film.pixels().map(|(_, pixel)| pixel.n).collect();
    let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
    assert!(*least < 100 && *most >= 2 * least, "{least} to {most}");
    assert_eq!(film, with(3));
}

#[test]
fn a_film_that_was_left_goes_on_to_the_same_bits() {
    let stage = stage(UNEVEN);
    let fixed = Options { spp: Some(50), ..Options::default() };
    for options in [fixed, Options { spp: Some(200), ..asked(0.05) }] {
        let whole = render(&stage, &options, &Control::default()).0;
        let mut stops = 0;
        let mut film = empty(&stage);
        loop {
            // Stopped after a few looks, each time in another place, and taken through a file.
            let control = Control::default();
            let mut left = 1 + stops % 3;
            let mut look = |_: &Film, _: Reached| {
                left -= 1;
                if left == 0 {
                    control.cancel();
                }
            };
            let outcome = render_on(&mut film, &stage, &options, &control, &mut look);
            let mut bytes = vec![];
            film.save(&mut bytes).unwrap();
            film = Film::load(&bytes).unwrap();
            if outcome == Outcome::Complete {
                break;
            }
            stops += 1;
        }
        assert!(stops > 2, "it was never stopped");
        assert_eq!(film, whole);
    }
}

#[test]
fn a_film_that_was_cut_off_in_a_pass_goes_on_to_the_same_bits() {
    let stage = stage(UNEVEN);
    let options = Options { spp: Some(160), ..Options::default() };
    let whole = render(&stage, &options, &Control::default()).0;
    let mut film = empty(&stage);
    let mut uneven = 0;
    // Each run ends as soon as it has taken another two tiles' samples.
    while film != whole {
        let control = Control::default();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while control.samples_done() < 2 * 16 * 256 && !control.is_cancelled() {
                    std::thread::yield_now();
                }
                control.cancel();
            });
            render_on(&mut film, &stage, &options, &control, &mut |_, _| {});
            control.cancel();
        });
        let counts: Vec<u32> = film.pixels().map(|(_, pixel)| pixel.n).collect();
        uneven += u32::from(counts.iter().any(|n| *n != counts[0]));
    }
    assert!(uneven > 0, "no pass was cut off");
}

#[test]
fn more_samples_go_on_where_fewer_ended() {
    let stage = stage(UNEVEN);
    let with = |spp| Options { spp: Some(spp), ..Options::default() };
    let mut film = render(&stage, &with(20), &Control::default()).0;
    let control = Control::default();
    render_on(&mut film, &stage, &with(50), &control, &mut |_, _| {});
    assert_eq!(film, render(&stage, &with(50), &Control::default()).0);
    assert_eq!(control.samples_done(), 30 * 64 * 32);
}

#[test]
fn a_time_that_is_over_at_once_leaves_a_picture() {
    let stage = stage(UNEVEN);
    let goal = Goal { time: Some(Duration::from_nanos(1)), ..Goal::default() };
    let options = Options { goal, ..Options::default() };
    let (film, outcome) = render(&stage, &options, &Control::default());
    assert_eq!(outcome, Outcome::Complete);
    assert!(film.pixels().all(|(_, pixel)| pixel.n == 1));
}
