//! A picture of what moves is the mean of pictures of its moments.

use std::path::Path;

use glam::{DVec3, UVec2};
use luxel_core::files::MemoryFiles;
use luxel_core::film::Film;
use luxel_core::render::{Control, Options, render};
use luxel_sdk::sampling::Rng;

use crate::load::stage_of;

/// Seen by a camera that is carried along: a lamp on an arm, a point of light and a beam that turn, a
/// mesh that bends, fog in a ball that goes to and fro, and light from far away that goes round.
const SCENE: &str = "scene 1
    param open: time = 0 s
    param shutter: time = 0 s
    camera perspective {
        look = look_at(from = (0, 2, 5) m, to = (0, 0.4, 0) m, up = (0, 1, 0)), fov = 40 deg
        transform = motion([(0 s, rotate((0, 1, 0), 0 deg)), (1 s, rotate((0, 1, 0), 40 deg))])
    }
    film rgb { resolution = (24, 16), time = open, shutter = shutter }
    sampler sobol { samples = 64, seed = 5 }
    let to_and_fro = motion([(0 s, move((-1, 0, 0) m)), (0.4 s, move((1, 0, 0.2) m)), (0.8 s, move((0, 0, 0) m))])
    let turning = spin((0, 1, 0), 200 deg / (1 s))
    light area {
        shape = shape rectangle { u = (0.6, 0, 0) m, v = (0, 0, 0.6) m }
        spectrum = rgb.linear_srgb(1, 0.9, 0.8), radiance = 9 W/m^2/sr
        transform = [move((1.2, 1.6, 0) m), turning]
    }
    light area {
        shape = shape mesh {
            points      = #[ 0 0 0  0.5 0 0  0 0.5 0 ] m, indices = #[ 0 1 2  0 2 1 ]
            next_points = #[ 0 0.6 0  0.7 0 0  0 0.9 0.4 ] m
        }
        spectrum = rgb.linear_srgb(0.2, 0.5, 1), radiance = 12 W/m^2/sr
        transform = [move((-1.2, 0.3, 0.4) m), motion([(0 s, scale((1, 1, 1))), (1 s, scale((1, 1.6, 0.7)))])]
    }
    light point {
        position = (0.4, 1.2, 0.2) m, spectrum = rgb.linear_srgb(1, 0.4, 0.2), intensity = 2 W/sr
        transform = to_and_fro
    }
    light directional {
        direction = (0.4, -1, 0.2), angular_size = 8 deg, spectrum = rgb.linear_srgb(0.6, 0.8, 1), scale = 30
        transform = [turning, motion([(0 s, rotate((0, 0, 1), 0 deg)), (1 s, rotate((0, 0, 1), 50 deg))])]
    }
    light constant { spectrum = rgb.linear_srgb(1, 1, 1), radiance = 0.1 W/m^2/sr }
    let chalk = material diffuse { reflectance = 0.7 }
    shape rectangle { u = (0, 0, 6) m, v = (6, 0, 0) m, material = chalk }
    shape mesh {
        points      = #[ -0.5 0.1 -1  0.5 0.1 -1  0.5 1.1 -1  -0.5 1.1 -1 ] m, indices = #[ 0 1 2  0 2 3 ]
        next_points = #[ -0.5 0.1 -1  0.5 0.1 -1  0.9 0.9 0.2  -0.5 1.1 -1.4 ] m
        at = 0.1 s, next_at = 0.7 s, smooth = \"smooth\", material = chalk
    }
    shape sphere {
        radius = 40 cm
        interior = medium homogeneous { sigma_t = 3 / (1 m), albedo = 0.8 }
        transform = [move((0, 0.41, 0.6) m), to_and_fro]
    }
    shape box { size = (0.3, 0.9, 0.3) m, material = chalk, transform = [move((0.9, 0.5, -0.4) m), turning, to_and_fro] }
";

fn picture(text: &str, set: &[(&str, String)], seed: u32) -> Film {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let set: Vec<_> = set.iter().map(|(n, v)| ((*n).to_owned(), v.clone())).collect();
    let stage = stage_of(Path::new("a.scene"), &files, &set, None)
        .unwrap_or_else(|said| panic!("{said:?}"));
    let options = Options { seed: Some(seed), ..Options::default() };
    let (film, _) = render(&stage, &options, &Control::default());
    assert_eq!(film.bad_samples(), 0);
    film
}

/// The picture in parts, four by four, and as a whole.
type Parts = [DVec3; 17];

fn parts(film: &Film) -> Parts {
    let mut sums = [DVec3::ZERO; 17];
    let size = film.size;
    for (at, pixel) in film.pixels() {
        let part = at * UVec2::splat(4) / size;
        let of_all = pixel.mean / f64::from(size.element_product());
        sums[(part.y * 4 + part.x) as usize] += of_all * 16.0;
        sums[16] += of_all;
    }
    sums
}

fn mean_and_error(of: &[Parts]) -> [(DVec3, DVec3); 17] {
    let n = of.len() as f64;
    std::array::from_fn(|i| {
        let mean = of.iter().map(|parts| parts[i]).sum::<DVec3>() / n;
        // Of neighbours in time: what differs between them is noise, and a little of the change.
        let squares: DVec3 = of.chunks(2).map(|two| (two[0][i] - two[1][i]).powf(2.0)).sum();
        (mean, squares.map(f64::sqrt) / n)
    })
}

/// Compares pictures of an interval with pictures of moments that are spread over it, each at a time
/// that is chosen at random within its share of the interval. Of 51 numbers none is off by five
/// standard errors: 3e-5 by chance.
fn moments_make_the_picture(text: &str) {
    let (open, shutter, n) = (0.15, 0.6, 64u32);
    let blurred: Vec<_> = (0..16)
        .map(|seed| {
            let set = [("open", format!("{open} s")), ("shutter", format!("{shutter} s"))];
            parts(&picture(text, &set, seed))
        })
        .collect();
    let mut rng = Rng::new(3);
    let moments: Vec<_> = (0..n)
        .map(|i| {
            let time = open + shutter * (f64::from(i) + rng.f64()) / f64::from(n);
            parts(&picture(text, &[("open", format!("{time} s"))], 100 + i))
        })
        .collect();
    let (blurred, moments) = (mean_and_error(&blurred), mean_and_error(&moments));
    for (i, ((a, a_err), (b, b_err))) in blurred.into_iter().zip(moments).enumerate() {
        let allowed = 5.0 * (a_err * a_err + b_err * b_err).map(f64::sqrt);
        let fine = if i == 16 { 0.03 } else { 0.2 };
        assert!(allowed.max_element() < fine * b.max_element(), "{i}: {a} {b} {allowed}");
        assert!((a - b).abs().cmple(allowed).all(), "part {i}: {a}, of moments {b} ± {allowed}");
    }
}

#[test]
fn what_moves_looks_as_its_moments_do_together() {
    moments_make_the_picture(SCENE);
    moments_make_the_picture(&format!("{SCENE} integrator direct {{}}"));
}

#[test]
fn without_an_interval_things_stand_where_they_are_at_that_time() {
    let scene = |pose: &str| {
        format!(
            "scene 1
            camera perspective {{ look = look_at(from = (0, 1, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }}
            film rgb {{ resolution = (16, 12), time = 0.5 s, shutter = 0 s }}
            sampler sobol {{ samples = 8 }}
            light constant {{ spectrum = rgb.linear_srgb(1, 1, 1), radiance = 1 W/m^2/sr }}
            shape sphere {{ radius = 50 cm, transform = {pose} }}"
        )
    };
    let still = picture(&scene("move((1, 0.25, 0) m)"), &[], 1);
    let moving =
        picture(&scene("motion([(0 s, move((0, 0, 0) m)), (1 s, move((2, 0.5, 0) m))])"), &[], 1);
    for ((at, a), (_, b)) in still.pixels().zip(moving.pixels()) {
        assert_eq!(a, b, "{at}");
    }
}

#[test]
fn a_camera_that_is_carried_in_a_ball_of_fog_sees_as_one_that_stands_in_it() {
    let scene = |carried: &str| {
        format!(
            "scene 1
            let carried = {carried}
            camera perspective {{
                look = look_at(from = (0, 0, 0) m, to = (0, 0, -1) m, up = (0, 1, 0)), fov = 40 deg, transform = carried
            }}
            film rgb {{ resolution = (8, 8), shutter = 1 s }}
            sampler sobol {{ samples = 16 }}
            light constant {{ spectrum = rgb.linear_srgb(1, 1, 1), scale = 1 }}
            shape sphere {{
                radius = 1 m, transform = carried, interior = medium homogeneous {{ sigma_t = 1 / (1 m), albedo = 0 }}
            }}
            // Where the camera was: no longer around it.
            shape sphere {{ radius = 1.5 m, interior = medium homogeneous {{ sigma_t = 0 / (1 m), albedo = 0 }} }}"
        )
    };
    for carried in ["[]", "motion([(0 s, move((0, 0, 0) m)), (1 s, move((9, 0, 0) m))])"] {
        let (mean, _) = picture(&scene(carried), &[], 1).mean();
        let expected = (-1.0f64).exp();
        // The way out of the ball is one metre to rounding of its centre, 9 m away.
        assert!((mean.y - expected).abs() < 1e-6, "{carried}: {}", mean.y);
    }
}

/// Light on a floor from a lamp is as much when rays are sent to it as when it is met by chance. At
/// `exact` a ray to a lamp ends within 1e-15 of it, and must not meet it.
fn lamp_is_found(lamp: &str, precision: &str) {
    let of = |sampling: bool, seed| {
        let text = format!(
            "scene 1
            camera perspective {{ look = look_at(from = (0, 6, 0.01) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 60 deg }}
            film rgb {{ resolution = (16, 16), shutter = 1 s, precision = \"{precision}\" }}
            sampler sobol {{ samples = {} }}
            integrator path {{ light_sampling = {sampling} }}
            shape rectangle {{ u = (0, 0, 40) m, v = (40, 0, 0) m }}
            light area {{ shape = {lamp}, spectrum = rgb.linear_srgb(1, 1, 1), radiance = 1 W/m^2/sr, two_sided = true }}
            ",
            if sampling { 64 } else { 1024 }
        );
        picture(&text, &[], seed).mean().0.y
    };
    let stats = |sampling: bool| {
        let means: Vec<f64> = (0..8).map(|seed| of(sampling, seed)).collect();
        let mean = means.iter().sum::<f64>() / 8.0;
        let squares: f64 = means.iter().map(|x| (x - mean).powi(2)).sum();
        (mean, squares / 56.0)
    };
    let ((a, va), (b, vb)) = (stats(true), stats(false));
    // With fourteen degrees of freedom 5.4 standard errors are passed by chance once in 10⁴, in one of
    // the eight cases once in 10³.
    let allowed = 5.4 * (va + vb).sqrt();
    assert!(allowed < 0.25 * b, "{precision} {lamp}: {a} {b} {allowed}");
    assert!((a - b).abs() < allowed, "{precision} {lamp}: {a}, by chance {b} ± {allowed}");
}

#[test]
fn lamps_of_triangles_do_not_stand_in_their_own_light() {
    let ball = "shape mesh { points = #[ 1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ] m, subdivide = 2, scheme = \"loop\",
        indices = #[ 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5 ] }";
    let tilted =
        "shape mesh { points = #[ -0.3 0 0  0.3 0.2 0  0.1 0.5 0.4 ] m, indices = #[ 0 1 2 ] }";
    let bends = "shape mesh {
        points = #[ 0 0 0  0.4 0 0  0 0 0.4 ] m, indices = #[ 0 1 2 ]
        next_points = #[ 0 0 0  0 0.4 0  0 0 0.4 ] m
    }";
    let places = [
        (ball, "scale(0.3), move((0, 1.5, 0) m)"),
        (tilted, "move((0.2, 1.5, 0.1) m)"),
        (tilted, "move((1, 1.5, 0) m), spin((0, 1, 0), 360 deg / (1 s))"),
        // Its normal turns where the place stretches: so does the share of each moment.
        (bends, "scale((1, 6, 1)), move((0, 2, 0) m)"),
    ];
    for (lamp, place) in places {
        for precision in ["standard", "exact"] {
            lamp_is_found(&format!("{lamp} with {{ transform = [{place}] }}"), precision);
        }
    }
}
