//! The light tracer in its library: the pictures of the path tracer, by the opposite way.

use std::fmt::Write;
use std::num::NonZeroUsize;

use glam::{DVec3, UVec2};
use luxel_core::film::{Film, Rect};
use luxel_core::registry::Registry;
use luxel_core::render::{Control, Options, Outcome, render, render_on};
use luxel_core::stage::Stage;

use super::{open, registered};
use crate::disk::{OnDisk, root};
use crate::load::stage_with;

/// Side of the pictures, and of the blocks that are compared, pixels.
const SIDE: u32 = 24;
const BLOCK: u32 = 6;
/// Pictures of different seeds, which tell how far one is off: what a block shows in one pass is
/// not independent from pixel to pixel.
const SEEDS: u32 = 32;
/// With 62 degrees of freedom the chance of a difference of means beyond 4.5 standard errors is
/// 3e-5: for any of three channels of 16 blocks of twelve scenes 1.7e-2 (Šidák), once and for all, as
/// the seeds are fixed.
const SIGMAS: f64 = 4.5;

fn registry() -> Registry {
    registered(&[&open("light_tracer"), &open("bounces")])
}

fn stage(integrator: &str, body: &str) -> Stage {
    let camera = "camera perspective { look = look_at(from = (0, 2, 4) m, to = (0, 0.7, 0) m, up = (0, 1, 0)), fov = 40 deg }";
    stage_seen(camera, integrator, body)
}

fn stage_seen(camera: &str, integrator: &str, body: &str) -> Stage {
    let text = format!(
        "scene 1
        {camera}
        let white = material diffuse {{ reflectance = rgb.linear_srgb(0.8, 0.7, 0.6) }}
        sampler sobol {{ samples = 1 }}
        integrator {integrator}
        {body}"
    );
    super::stage(&registry(), &text).unwrap_or_else(|said| panic!("{said:?}"))
}

fn picture(stage: &Stage, options: &Options) -> Film {
    let (film, outcome) = render(stage, options, &Control::default());
    assert_eq!((outcome, film.bad_samples()), (Outcome::Complete, 0), "{:?}", stage.failures());
    film
}

/// Means of blocks and their squared standard errors, over several seeds.
fn blocks(stage: &Stage, spp: u32) -> Vec<(DVec3, DVec3)> {
    let n = (SIDE / BLOCK) * (SIDE / BLOCK);
    let mut sums = vec![(DVec3::ZERO, DVec3::ZERO); n as usize];
    for seed in 0..SEEDS {
        let film =
            picture(stage, &Options { spp: Some(spp), seed: Some(seed), ..Options::default() });
        for (i, (sum, squares)) in (0..n).zip(&mut sums) {
            let corner = UVec2::new(i % (SIDE / BLOCK), i / (SIDE / BLOCK)) * BLOCK;
            let area = Rect::new(corner, UVec2::splat(BLOCK));
            let mean = area.points().map(|at| film.pixel(at).mean).sum::<DVec3>();
            let mean = mean / f64::from(BLOCK * BLOCK);
            *sum += mean;
            *squares += mean * mean;
        }
    }
    let k = f64::from(SEEDS);
    sums.iter().map(|(s, q)| (s / k, (q / k - s * s / (k * k)) / (k - 1.0))).collect()
}

/// What both show of a scene: block by block within the noise of both (Welch 1947).
fn check_same(body: &str, [light, path]: [u32; 2], sees: impl Fn(usize) -> bool) {
    let body = format!("film rgb {{ resolution = ({SIDE}, {SIDE}) }}\n{body}");
    compare(&stage("light_tracer {}", &body), &stage("path {}", &body), [light, path], sees);
}

fn compare(a: &Stage, b: &Stage, [spp_a, spp_b]: [u32; 2], sees: impl Fn(usize) -> bool) {
    let (a, b) = (blocks(a, spp_a), blocks(b, spp_b));
    let (mut told, mut noise) = (String::new(), vec![]);
    for (i, ((a, va), (b, vb))) in a.iter().zip(&b).enumerate().filter(|(i, _)| sees(*i)) {
        // A block without noise may differ by the rounding of 576 paths of a few f32 factors.
        let sigma = (*va + *vb).map(|v| v.max(0.0).sqrt()) + b.abs() * 1e-6;
        let z = ((a - b) / sigma).abs().max_element();
        assert!(b.max_element() > 0.0, "block {i} is black");
        if !(z < SIGMAS) {
            let _ = writeln!(told, "block {i}: {a} instead of {b} ± {sigma}: {z:.1}");
        }
        noise.push((sigma / b).max_element());
    }
    // Blocks are known well enough, or nothing was compared.
    let mean = noise.iter().sum::<f64>() / noise.len() as f64;
    assert!(mean < 0.1 && noise.iter().all(|s| *s < 0.3), "too much noise: {noise:.2?}");
    assert!(told.is_empty(), "{told}");
}

#[test]
fn a_picture_that_was_left_goes_on_to_the_same_bits() {
    let body = format!("film rgb {{ resolution = ({SIDE}, {SIDE}) }}\n{ROOM}\n{LAMP}");
    let stage = stage("light_tracer {}", &body);
    let with = |spp| Options { spp: Some(spp), seed: Some(3), ..Options::default() };
    let whole = picture(&stage, &with(7));
    let mut film = picture(&stage, &with(1));
    for spp in [3, 7] {
        let control = Control::default();
        let outcome = render_on(&mut film, &stage, &with(spp), &control, &mut |_, _| {});
        assert_eq!((outcome, film.most_samples()), (Outcome::Complete, spp));
    }
    assert_eq!(film, whole);
    // No pass is the same as another.
    let first = picture(&stage, &with(1));
    assert!(first.pixels().zip(whole.pixels()).any(|((_, a), (_, b))| a.mean != b.mean));
}

const ANY: fn(usize) -> bool = |_| true;

/// A room around the camera, and a lamp in view below the ceiling.
const ROOM: &str = "
    let red = material diffuse { reflectance = rgb.linear_srgb(0.6, 0.1, 0.1) }
    shape rectangle { center = (0, 0, 1.5) m, u = (0, 0, 7) m, v = (4, 0, 0) m, material = white }
    shape rectangle { center = (0, 3, 1.5) m, u = (4, 0, 0) m, v = (0, 0, 7) m, material = white }
    shape rectangle { center = (0, 1.5, -2) m, u = (4, 0, 0) m, v = (0, 3, 0) m, material = white }
    shape rectangle { center = (0, 1.5, 5) m, u = (4, 0, 0) m, v = (0, 3, 0) m, material = white }
    shape rectangle { center = (-2, 1.5, 1.5) m, u = (0, 3, 0) m, v = (0, 0, 7) m, material = red }
    shape rectangle { center = (2, 1.5, 1.5) m, u = (0, 0, 7) m, v = (0, 3, 0) m, material = red }";
const LAMP: &str = "light area { shape = shape rectangle { center = (0, 1.6, -0.4) m, u = (0.7, 0, 0) m, v = (0, 0.1, 0.5) m },
    spectrum = rgb.linear_srgb(1, 1, 1), radiance = 6 W/m^2/sr, two_sided = true }";

/// A floor that fills the picture.
const FLOOR: &str = "shape rectangle { u = (0, 0, 40) m, v = (40, 0, 0) m, material = white }";
const POINT: &str =
    "light point { position = (1, 2, 1) m, spectrum = rgb.linear_srgb(1, 1, 1), scale = 8 }";

#[test]
fn a_matt_room_with_its_lamp_in_view() {
    check_same(&format!("{ROOM}\n{LAMP}"), [8, 4], ANY);
}

#[test]
fn matt_things_in_the_light_of_points() {
    let spot = "light spot { look = look_at(from = (-2, 3, 1) m, to = (-0.4, 0, 0) m, up = (0, 1, 0)), cone = 14 deg,
        falloff = 6 deg, spectrum = rgb.linear_srgb(1, 0.8, 0.5), intensity = 40 W/sr }";
    let ball = "shape sphere { center = (0.3, 0.6, 0) m, radius = 60 cm, material = white }";
    check_same(&format!("{FLOOR}\n{POINT}\n{spot}\n{ball}"), [40, 4], ANY);
}

#[test]
fn matt_things_under_a_sky_that_is_in_view() {
    let sky = "light constant { spectrum = rgb.linear_srgb(0.5, 0.7, 1), scale = 1 }";
    let sun = "light directional { direction = (1, -2, -1), spectrum = rgb.linear_srgb(1, 1, 0.8), illuminance = 2 W/m^2 }";
    let things = "shape rectangle { u = (0, 0, 3) m, v = (3, 0, 0) m, material = white }
        shape sphere { center = (0.3, 0.6, 0) m, radius = 60 cm, material = white }";
    check_same(&format!("{sky}\n{sun}\n{things}"), [16, 4], ANY);
}

#[test]
fn lamps_and_things_that_move_past_a_camera_that_does() {
    // Also a lamp whose stretch changes: directions of a point light turn and crowd with it.
    let moving = format!(
        "let go = motion([(0 s, move((-0.5, 0, 0) m)), (1 s, move((0.6, 0.2, 0) m))])
        let bend = motion([(0 s, scale((1, 1, 1))), (1 s, [scale((1.6, 0.7, 1.2)), rotate((0, 1, 0), 60 deg)])])
        let lamp = group {{ {LAMP} }}
        place lamp {{ transform = go }}
        light spot {{ look = look_at(from = (-1, 2, 1) m, to = (-0.4, 0, 0) m, up = (0, 1, 0)), cone = 24 deg,
            falloff = 9 deg, spectrum = rgb.linear_srgb(1, 0.8, 0.5), intensity = 30 W/sr, transform = [bend, go] }}
        shape box {{ size = (0.5, 0.5, 0.5) m, material = white, transform = [spin((0, 1, 0), 90 deg / (1 s)), move((-0.4, 0.3, 0.4) m), go] }}"
    );
    let camera = "film rgb { resolution = (24, 24), shutter = 1 s }";
    let carried = "camera perspective {
        look = look_at(from = (0, 2, 4) m, to = (0, 0.7, 0) m, up = (0, 1, 0)), fov = 40 deg
        transform = motion([(0 s, move((-0.2, 0, 0) m)), (1 s, move((0.2, 0, 0.1) m))])
    }";
    let scene =
        |integrator: &str| stage_seen(carried, integrator, &format!("{camera}\n{ROOM}\n{moving}"));
    compare(&scene("light_tracer {}"), &scene("path {}"), [16, 8], ANY);
}

#[test]
fn a_rough_glass_ball_in_a_room() {
    let ball = "shape sphere { center = (0, 0.9, 0.4) m, radius = 70 cm, material = material dielectric { ior = 1.5, roughness = 0.5 } }";
    check_same(&format!("{ROOM}\n{LAMP}\n{ball}"), [12, 12], ANY);
}

#[test]
fn a_room_full_of_fog_but_where_the_camera_is() {
    // What scatters at a distance r from the camera shows as r^-2: around it the variance has no end.
    let fog = "shape box { center = (0, 1.5, 0.4) m, size = (3.9, 2.9, 4.6) m,
        interior = medium homogeneous { sigma_t = 0.3 / (1 m), albedo = 0.8 } }";
    check_same(&format!("{ROOM}\n{LAMP}\n{fog}"), [8, 8], ANY);
}

#[test]
fn a_ball_of_fog_under_a_point_and_a_sky() {
    let fog =
        "shape sphere { center = (0, 0.8, 0.3) m, radius = 80 cm, interior = medium homogeneous {
        sigma_t = 1.5 / (1 m), albedo = 0.9, phase = phase henyey_greenstein { g = 0.5 } } }";
    let sky = "light constant { spectrum = rgb.linear_srgb(0.5, 0.7, 1), scale = 0.3 }";
    check_same(&format!("{FLOOR}\n{POINT}\n{sky}\n{fog}"), [24, 8], ANY);
}

#[test]
fn fog_without_an_end_under_a_point_and_a_sky() {
    let fog = "medium homogeneous { sigma_t = 0.1 / (1 m), albedo = 0.8 }";
    let sky = "light constant { spectrum = rgb.linear_srgb(0.5, 0.7, 1), scale = 0.3 }";
    let ball = "shape sphere { center = (0.3, 0.6, 0) m, radius = 60 cm, material = white }";
    let floor = "shape rectangle { u = (0, 0, 3) m, v = (3, 0, 0) m, material = white }";
    check_same(&format!("{floor}\n{POINT}\n{sky}\n{fog}\n{ball}"), [80, 8], ANY);
}

/// A hilly sheet of `n`² squares whose normals lean by more than the triangles do.
fn leaning(n: u32, lean: f64, material: &str) -> String {
    let (mut points, mut normals, mut indices) = (String::new(), String::new(), String::new());
    let at = |i: u32| 3.0 * f64::from(i) / f64::from(n) - 1.5;
    for (x, z) in (0..=n).flat_map(|i| (0..=n).map(move |j| (at(i), at(j)))) {
        let (a, b) = ((3.0 * x).sin(), (3.0 * z).sin());
        let _ = write!(points, "{x} {} {z}  ", 0.2 + 0.05 * a * b);
        let _ = write!(normals, "{} 1 {}  ", lean * a, lean * b);
    }
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [p, q] = [i * (n + 1) + j, (i + 1) * (n + 1) + j];
        let _ = write!(indices, "{p} {} {q}  {q} {} {}  ", p + 1, p + 1, q + 1);
    }
    format!(
        "shape mesh {{ points = #[ {points} ] m, normals = #[ {normals} ], indices = #[ {indices} ], material = {material} }}"
    )
}

/// What dips below a facet and is reflected once more is of the second order in it, and no light path
/// finds that.
const DIM: &str = "material diffuse { reflectance = 0.1 }";

#[test]
fn a_sheet_whose_normals_lean() {
    let sheet = leaning(8, 0.3, DIM);
    check_same(&format!("{FLOOR}\n{POINT}\n{sheet}"), [24, 4], ANY);
    check_same(&format!("{ROOM}\n{LAMP}\n{sheet}"), [12, 8], ANY);
}

#[test]
fn a_caustic_of_a_small_lamp_behind_smooth_glass() {
    // Glass out of view: what it shows itself is what light paths cannot find.
    let glass = "shape sphere { center = (0, 3.2, 0.3) m, radius = 60 cm, material = material dielectric { ior = 1.5 } }";
    let lamp = "light area { shape = shape sphere { center = (0, 5, 0.3) m, radius = 25 cm },
        spectrum = rgb.linear_srgb(1, 1, 1), radiance = 30 W/m^2/sr }";
    check_same(&format!("{FLOOR}\n{glass}\n{lamp}"), [16, 32], ANY);
}

#[test]
fn light_that_glass_bends_to_a_leaning_sheet_by_wavelength() {
    let glass = "shape sphere { center = (0, 3.2, 0.3) m, radius = 60 cm, material = material dielectric { ior = glass(\"N-BK7\") } }";
    let lamp = "light area { shape = shape sphere { center = (0, 5, 0.3) m, radius = 60 cm },
        spectrum = illuminant(\"D65\"), radiance = 30 W/m^2/sr }";
    let sheet = leaning(8, 0.3, DIM);
    let film = format!("film spectral {{ resolution = ({SIDE}, {SIDE}) }}");
    let body = format!("{film}\n{FLOOR}\n{glass}\n{lamp}\n{sheet}");
    compare(&stage("light_tracer {}", &body), &stage("path {}", &body), [16, 48], ANY);
}

/// Radiance of a white floor under a point: ρ·I·cos/(π·d²), mean over a pixel's square.
fn lit_floor(pixel: UVec2) -> f64 {
    const N: u32 = 8;
    let (from, to) = (DVec3::new(0.0, 2.0, 4.0), DVec3::new(0.0, 0.7, 0.0));
    let ahead = (to - from).normalize();
    let right = ahead.cross(DVec3::Y).normalize();
    let up = right.cross(ahead);
    let half = 20f64.to_radians().tan() * 2.0 / f64::from(SIDE);
    let radiance = |i: u32| {
        let at = pixel.as_dvec2() + (UVec2::new(i % N, i / N).as_dvec2() + 0.5) / f64::from(N);
        let screen = (at - f64::from(SIDE) / 2.0) * half;
        let d = ahead + right * screen.x - up * screen.y;
        let to_light = DVec3::new(1.0, 2.0, 1.0) - (from - d * (from.y / d.y));
        0.8 * 8.0 * to_light.y / (std::f64::consts::PI * to_light.length().powi(3))
    };
    (0..N * N).map(radiance).sum::<f64>() / f64::from(N * N)
}

#[test]
fn a_point_and_a_ball_light_a_floor_as_the_closed_form_says() {
    // Matt, and lit by the irradiance I·cos/d² alone, I = πr²·L of a ball: the rows below the horizon,
    // block by block. The mean of 64 places differs from the integral by less than 1e-3.
    let film =
        format!("film rgb {{ resolution = ({SIDE}, {SIDE}) }}\nfilter box {{ radius = 0.5 }}");
    let radiance = 8.0 / (std::f64::consts::PI * 0.1 * 0.1);
    let ball = format!(
        "light area {{ shape = shape sphere {{ center = (1, 2, 1) m, radius = 10 cm }},
            spectrum = rgb.linear_srgb(1, 1, 1), scale = {radiance} }}"
    );
    for (integrator, lamp, spp) in [
        ("light_tracer {}", POINT, 48),
        ("light_tracer {}", ball.as_str(), 48),
        ("path {}", POINT, 2),
        ("path {}", ball.as_str(), 2),
    ] {
        let found = blocks(&stage(integrator, &format!("{film}\n{FLOOR}\n{lamp}")), spp);
        for (i, (mean, variance)) in (0..16).zip(found).skip(4) {
            let corner = UVec2::new(i % 4, i / 4) * BLOCK;
            let pixels = Rect::new(corner, UVec2::splat(BLOCK));
            let truth = pixels.points().map(lit_floor).sum::<f64>() / f64::from(BLOCK * BLOCK);
            let allowed = 4.0 * variance.x.max(0.0).sqrt() + 1e-3 * truth;
            let told = || format!("{integrator} {lamp} {i}: {} instead of {truth}", mean.x);
            assert!((mean.x - truth).abs() < allowed, "{}", told());
            assert!(allowed < 0.1 * truth, "block {i} is only known to {allowed} of {truth}");
        }
    }
}

/// Mean and variance of every pixel, as bits.
fn bits(film: &Film) -> Vec<(UVec2, [u64; 6])> {
    let pixel = |(at, pixel): (UVec2, &luxel_core::film::Pixel)| {
        let (m, v) = (pixel.mean, pixel.variance());
        (at, [m.x, m.y, m.z, v.x, v.y, v.z].map(f64::to_bits))
    };
    film.pixels().map(pixel).collect()
}

#[test]
fn threads_and_crop_change_no_bit() {
    // Several bundles of paths in each pass.
    let fog = "medium homogeneous { sigma_t = 0.3 / (1 m), albedo = 0.8 }";
    let body = format!("film spectral {{ resolution = (67, 61) }}\n{ROOM}\n{LAMP}\n{POINT}\n{fog}");
    let stage = stage("light_tracer {}", &body);
    let with = |threads, crop| {
        let threads = NonZeroUsize::new(threads);
        let options = Options { spp: Some(3), threads, crop, ..Options::default() };
        let film = picture(&stage, &options);
        assert!(film.pixels().all(|(_, pixel)| pixel.n == 3));
        bits(&film)
    };
    let one = with(1, None);
    for threads in [2, 7] {
        assert!(one == with(threads, None), "{threads} threads");
    }
    let crop = Rect::new(UVec2::new(13, 5), UVec2::new(21, 17));
    let whole: Vec<_> =
        one.into_iter().filter(|(at, _)| crop.points().any(|inside| inside == *at)).collect();
    assert!(whole == with(2, Some(crop)), "a part differs from the whole");
}

#[test]
fn a_cancelled_picture_has_no_pass_that_is_not_whole() {
    let body = format!("film rgb {{ resolution = ({SIDE}, {SIDE}) }}\n{ROOM}\n{LAMP}");
    let control = Control::default();
    control.cancel();
    let (film, outcome) = render(&stage("light_tracer {}", &body), &Options::default(), &control);
    assert_eq!(outcome, Outcome::Cancelled);
    assert!(film.pixels().all(|(_, pixel)| pixel.n == 0));
}

#[test]
fn a_camera_that_is_no_point_is_refused_where_it_stands() {
    for (camera, fine) in [
        (
            "orthographic { look = look_at(from = (0, 2, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 2 m }",
            false,
        ),
        (
            "thin_lens { look = look_at(from = (0, 2, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg, f_number = 2, focus = 4 m }",
            false,
        ),
        (
            "perspective { look = look_at(from = (0, 2, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }",
            true,
        ),
    ] {
        let text = format!(
            "scene 1\ncamera {camera}\nintegrator light_tracer {{}}\nshape sphere {{ radius = 1 m }}"
        );
        match super::stage(&registry(), &text) {
            Ok(_) => assert!(fine, "{camera}"),
            Err(said) => {
                assert!(!fine && said.len() == 1, "{camera}: {said:?}");
                let message =
                    "`light_tracer` needs a camera whose lens is a point, as `perspective`";
                assert_eq!((said[0].code, &*said[0].message), ("E0422", message));
                let label = said[0].labels[0].span;
                assert!(text[label.start as usize..].starts_with("camera"), "{label:?}");
            }
        }
    }
}

#[test]
fn bounces_add_up_to_the_picture() {
    let body = format!("film rgb {{ resolution = ({SIDE}, {SIDE}) }}\n{ROOM}\n{LAMP}");
    let [direct, indirect, all] = ["bounces { last = 1 }", "bounces { first = 2 }", "path {}"]
        .map(|integrator| blocks(&stage(integrator, &body), 8));
    for (i, ((a, b), (c, vc))) in direct.iter().zip(&indirect).zip(&all).enumerate() {
        let sigma = (a.1 + b.1 + *vc).map(f64::sqrt);
        let z = ((a.0 + b.0 - *c) / sigma).abs().max_element();
        assert!(z < SIGMAS, "block {i}: {} and {} make {c}, {z:.1} off", a.0, b.0);
        assert!(b.0.min_element() > 0.02 * c.max_element(), "block {i} has no indirect light");
    }
}

#[test]
fn both_keep_what_their_kind_promises() {
    let effort = luxel_conformance::Options { samples: 4096, sets: 3, ..Default::default() };
    let ours = |class: &luxel_sdk::abi::Class| ["light_tracer", "bounces"].contains(&class.name);
    let report = luxel_conformance::run(&registry(), ours, &effort);
    assert!(report.rows.len() > 10 && report.is_clean(), "{report}");
    assert!(report.unmade().next().is_none(), "{report}");
}

#[test]
fn both_make_the_pictures_of_their_scenes() {
    for name in ["light_tracer", "bounces"] {
        let path = root().join(format!("plugins/examples/{name}/{name}.scene"));
        let stage = stage_with(&registry(), &path, &OnDisk, UVec2::splat(SIDE));
        let stage = stage.unwrap_or_else(|found| panic!("{name}: {found:?}"));
        let film = picture(&stage, &Options { spp: Some(4), ..Options::default() });
        assert!(film.mean().0.y > 0.0, "{name} is black");
    }
}
