//! Scenes at the ends of what numbers can do, each with an outcome in closed form.
//!
//! | extreme | held by |
//! |---|---|
//! | T1 far away, T2 tiny and huge | `places`; `truths`: `furnace.closed` with `away` and `size` |
//! | T3 a pebble on a planet | `a_pebble_of_a_millimetre_casts_its_shadow_on_a_planet` |
//! | T4 slivers | `rooms_of_slivers_lose_no_light`, open in single precision beyond its 4e-7 |
//! | T5 zero-area triangles | `core/src/accel/mesh_tests.rs`, `bad_input` |
//! | T6 coincident faces | `faces`, `core/src/accel/mesh_tests.rs` |
//! | T7 nested dielectrics | `nested` |
//! | T8 grazing light | `glass_reflects_by_fresnel_down_to_a_ten_thousandth_of_a_degree` |
//! | T9 nearly smooth | `metal_that_is_hardly_rough_is_a_mirror` |
//! | T10 index of nearly one | `an_index_of_one_is_invisible_and_one_beside_it_hardly_reflects` |
//! | T11 1e30 and 1e-30 | `lamps_sixty_orders_apart_stay_finite` |
//! | T12 denormal values | `values_below_the_normal_numbers_stay_finite`; `luxel-bench -- pictures` |
//! | T13 no numbers | `numbers_beyond_all_numbers_are_told_with_their_place`, `bad_input` |
//! | T14 shadow terminator | `terminator` |
//! | T15 thin layers | `both_faces_of_a_layer_of_forty_millionths_are_met` |
//! | T16 depth 1e4 | `truths`: `furnace.closed` with `rho=0.999` |
//! | T17 many samples | `a_pixel_keeps_its_mean_through_ten_million_samples` |
//! | T18 edges and vertices | `core/src/accel/leak_tests.rs` |
//! | T19 zeros of both signs | `core/src/accel/mesh_tests.rs` |
//! | T20 a camera inside, on a surface | `cameras_stand_in_glass_in_fog_and_on_surfaces` |
//! | T21 mirroring, singular transforms | `mirrored_shapes_keep_their_inside`; `bad_input` |
//! | T22 many lights | `one_lamp_of_a_million_with_nearly_all_power_is_found` |
//! | T23 empty scene, one pixel, no samples | `bad_input::a_scene_without_anything_is_black` |
//! | T24 a shutter without duration | `motion::without_an_interval_things_stand_where_they_are_at_that_time` |
//! | T25 dense fog | `fog_of_a_hundred_free_paths_that_absorbs_nothing_is_unseen` |

mod faces;
mod nested;
mod places;
mod terminator;

use std::f64::consts::{PI, SQRT_2};
use std::fmt::Write;
use std::path::Path;

use glam::DVec3;
use luxel_core::diag::Span;
use luxel_core::files::MemoryFiles;
use luxel_core::film::{Film, Pixel};
use luxel_core::render::{Control, Options, render};
use luxel_sdk::scattering::dielectric_reflectance;

use crate::load::stage_of;

/// The picture of a scene of these statements; a box filter, so that pixels are plain means.
fn picture(body: &str) -> Film {
    let text = format!("scene 1\nlet white = rgb.linear_srgb(1, 1, 1)\nfilter box {{}}\n{body}");
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let stage = stage_of(Path::new("a.scene"), &files, &[], None)
        .unwrap_or_else(|said| panic!("{body}: {said:?}"));
    let (film, _) = render(&stage, &Options::default(), &Control::default());
    assert_eq!(film.bad_samples(), 0, "{body}");
    film
}

/// Mean of the picture within four standard errors and a relative rest; noise may not buy a pass.
fn check(body: &str, expected: f64, rel: f64) {
    let (mean, error) = picture(body).mean();
    let (noise, rest) = (4.0 * error.y, rel * expected.abs());
    assert!(noise <= 0.02 * expected.abs() + rest, "{body}: {} ± {}", mean.y, error.y);
    let off = (mean.y - expected).abs();
    assert!(off <= noise + rest, "{body}: {} ± {}, not {expected}", mean.y, error.y);
}

/// The statements of a camera, its film and its sampler.
fn camera(from: &str, to: &str, up: &str, fov: &str, samples: u32) -> String {
    format!(
        "camera perspective {{ look = look_at(from = {from}, to = {to}, up = {up}), fov = {fov} }}
        film rgb {{ resolution = (8, 8) }}
        sampler sobol {{ samples = {samples}, seed = 3 }}\n"
    )
}

/// A mesh about the origin with six rectangular faces: half its edges in metres, and its material.
fn block(half: [&str; 3], skin: &str) -> String {
    let mut corners = String::new();
    for i in 0..8 {
        for (axis, half) in half.iter().enumerate() {
            let sign = if (i >> axis) & 1 == 0 { "-" } else { "" };
            write!(corners, "{sign}{half} ").unwrap();
        }
    }
    format!(
        "shape mesh {{ points = #[ {corners} ] m, material = {skin}, indices = #[ 0 3 1 0 2 3
            4 5 7 4 7 6  0 1 5 0 5 4  2 7 3 2 6 7  0 6 2 0 4 6  1 3 7 1 7 5 ] }}"
    )
}

const SKY: &str = "light constant { spectrum = white, scale = 1 }\n";
const PATHS: &str = "integrator path { russian_roulette_from = 1000000, light_sampling = false }\n";

#[test]
fn a_pebble_of_a_millimetre_casts_its_shadow_on_a_planet() {
    // Light at 45° makes the shadow of a ball an ellipse, √2 by 1 radii, whose middle lies one
    // radius from where the ball stands. From above ball and shadow cover
    // (1 + √2)(π − acos c + c√(1 − c²)) radii², c = √2 − 1: the ball is seen left of c, beyond it
    // the ellipse. The ground sinks by (1 mm)²/2e7 m: nothing.
    let c = SQRT_2 - 1.0;
    let dark = (1.0 + SQRT_2) * (PI - c.acos() + c * (1.0 - c * c).sqrt());
    let expected = 1.0 - dark / 16.0;
    let triangle = |size: &str| {
        format!(
            "shape mesh {{ points = [(-2, 0, -1) * {size}, (1, 0, -1) * {size}, (1, 0, 3) * {size}]
                indices = #[ 0 2 1 ], material = chalk }}"
        )
    };
    // In single precision a mesh is known to 4e-7 of its size: on 1e7 m that is 4 m.
    for (ground, precision) in [
        ("shape sphere { center = (0, -1e7, 0) m, radius = 1e7 m, material = chalk }", "standard"),
        (&triangle("10 m"), "standard"),
        (&triangle("1e7 m"), "exact"),
    ] {
        let body = format!(
            "camera orthographic {{
                look = look_at(from = (0.7, 9, 0) mm, to = (0.7, 0, 0) mm, up = (0, 0, -1))
                height = 4 mm
            }}
            film rgb {{ resolution = (16, 16), precision = \"{precision}\" }}
            sampler sobol {{ samples = 64, seed = 3 }}
            integrator path {{ max_depth = 1 }}
            light directional {{ direction = (1, -1, 0), spectrum = white, scale = pi * sqrt(2) }}
            let chalk = material diffuse {{ reflectance = 1 }}
            let coal = material diffuse {{ reflectance = 0 }}
            shape sphere {{ center = (0, 1, 0) mm, radius = 1 mm, material = coal }}
            {ground}"
        );
        check(&body, expected, 1e-4);
    }
}

/// A shining room whose walls have a frame of slivers along every edge, two million to one.
fn framed_room() -> String {
    let steps = [-1.0, -1.0 + 1e-6, 1.0 - 1e-6, 1.0];
    let (mut points, mut indices) = (String::new(), String::new());
    for face in 0..6 {
        for (i, a) in steps.iter().enumerate() {
            for (j, b) in steps.iter().enumerate() {
                let side = if face < 3 { -1.0 } else { 1.0 };
                let mut p = [side, *a, *b];
                p.rotate_right(face % 3);
                write!(points, "{:?} {:?} {:?}  ", p[0], p[1], p[2]).unwrap();
                if i < 3 && j < 3 {
                    let k = 16 * face + 4 * i + j;
                    write!(indices, "{} {} {}  ", k, k + 1, k + 5).unwrap();
                    write!(indices, "{} {} {}  ", k, k + 5, k + 4).unwrap();
                }
            }
        }
    }
    format!("shape mesh {{ points = #[ {points} ] m, indices = #[ {indices} ], material = skin }}")
}

/// Inside the shape, which shines with this radiance and reflects half.
fn furnace(shape: &str, to: &str, fov: &str, radiance: f64) -> String {
    camera("(0, 0, 0) m", to, "(0, 1, 0)", fov, 4)
        + &format!(
            "integrator path {{ max_depth = 64, russian_roulette_from = 1000, light_sampling = false }}
            let skin = material diffuse {{ reflectance = 0.5 }}
            light area {{ shape = {shape}, spectrum = white, scale = {radiance:e}, two_sided = true }}"
        )
}

/// The same in double precision.
fn exact(body: &str) -> String {
    body.replace("resolution = (8, 8)", "resolution = (8, 8), precision = \"exact\"")
}

#[test]
fn rooms_of_slivers_lose_no_light() {
    // Le/(1 − ρ) = 2 along every path; 64 roundings of f32.
    let needle = |x: &str, y: &str| block([x, y, "1"], "skin");
    // In single precision rays leave a mesh from up to 4e-7 of its size beside where they met it:
    // they stay within walls that are 2e-6 of it apart, and not always within nearer ones.
    let flat = furnace(&needle("1", "1e-6"), "(0.2, 0.3, 1) m", "90 deg", 1.0);
    check(&flat, 2.0, 1e-5);
    for shape in [needle("1e6", "1"), needle("1", "1e-6"), needle("1e3", "1e-3")] {
        check(&exact(&furnace(&shape, "(0.2, 0.3, 1) m", "90 deg", 1.0)), 2.0, 1e-5);
    }
    // An edge and a corner so near that slivers fill the picture.
    for to in ["(1, 0.3, 1) m", "(1, 1, -1) m", "(-0.4, 1, 1) m"] {
        check(&exact(&furnace(&framed_room(), to, "0.0003 deg", 1.0)), 2.0, 1e-5);
    }
}

/// Fresnel's reflectance of unpolarised light, cosine `c` outside, index `n` inside.
fn fresnel(c: f64, n: f64) -> f64 {
    let t = (1.0 - (1.0 - c * c) / (n * n)).sqrt();
    let (s, p) = ((c - n * t) / (c + n * t), (n * c - t) / (n * c + t));
    0.5 * (s * s + p * p)
}

#[test]
fn glass_reflects_by_fresnel_down_to_a_ten_thousandth_of_a_degree() {
    // The half of the world above shines; what is refracted is lost.
    for (degrees, fov) in [(89.0, "1e-4 deg"), (89.99, "1e-6 deg"), (89.9999, "1e-8 deg")] {
        let c = f64::sin((90.0 - degrees) * PI / 180.0);
        let expected = fresnel(c, 1.5);
        let n = 256 * 64;
        let from = format!("({:?}, {c:?}, 0) m", (1.0 - c * c).sqrt());
        let body = camera(&from, "(0, 0, 0) m", "(0, 1, 0)", fov, 256)
            + PATHS
            + "light directional {
                direction = (0, -1, 0), angular_size = 180 deg, spectrum = white, scale = pi
            }
            shape plane { material = material dielectric { ior = 1.5 } }";
        let mean = picture(&body).mean().0.y;
        // A sample reflects or not: four binomial standard errors, and eight roundings of f32.
        let allowed = 4.0 * (expected * (1.0 - expected) / f64::from(n)).sqrt() + 5e-7;
        assert!(
            (mean - expected).abs() <= allowed,
            "{degrees}°: {mean}, not {expected} ± {allowed}"
        );
    }
    // Rough surfaces and metals: finite, and no more than a mirror gives.
    for skin in [
        "dielectric { ior = 1.5, roughness = 0.3 }",
        "conductor { eta = metal(\"Ag\"), roughness = 0.3 }",
    ] {
        let body = camera("(1, 1.7e-6, 0) m", "(0, 0, 0) m", "(0, 1, 0)", "1e-8 deg", 16)
            + SKY
            + &format!("shape plane {{ material = material {skin} }}");
        let (mean, error) = picture(&body).mean();
        assert!(mean.y > 0.3 && mean.y < 1.0 + 4.0 * error.y + 1e-6, "{skin}: {mean} ± {error}");
    }
}

#[test]
fn metal_that_is_hardly_rough_is_a_mirror() {
    // Half of the picture shows a lamp. α = 2e-4 spreads its edge over 4e-4 of 0.3 rad, evenly to
    // both sides, and GGX sends α²/θ² of the light farther than θ.
    let with = |roughness: &str| {
        let body = camera("(0, 1, 1) m", "(0, 0, 0) m", "(0, 1, 0)", "17 deg", 256)
            + PATHS
            + &format!(
                "light area {{
                    shape = shape rectangle {{ center = (1, 1, -1) m, u = (2, 0, 0) m, v = (0, 4, 0) m }}
                    spectrum = white, scale = 1, two_sided = true }}
                shape plane {{ material = material conductor {{ eta = metal(\"Ag\"), roughness = {roughness} }} }}"
            );
        picture(&body)
    };
    let mirror = with("0");
    let (mean, _) = mirror.mean();
    assert!(mean.y > 0.4 && mean.y < 0.5, "half of the picture is bright: {mean}");
    for roughness in ["1e-5", "2e-4"] {
        let rough = with(roughness);
        for ((at, a), (_, b)) in mirror.pixels().zip(rough.pixels()) {
            // The two columns beside the edge share its blur.
            let (off, edge) = ((a.mean - b.mean).abs().max_element(), at.x == 3 || at.x == 4);
            assert!(off < 1e-3 || edge, "{roughness}, {at}: {} and {}", a.mean, b.mean);
        }
        let off = (mean - rough.mean().0).abs().max_element();
        assert!(off < 1e-3, "{roughness}: {mean} and {}", rough.mean().0);
    }
}

#[test]
fn an_index_of_one_is_invisible_and_one_beside_it_hardly_reflects() {
    // ((n − 1)/(n + 1))² of the index as f32 holds it: 1 + 8 ulp, 2.27e-13. Reflectance is f32.
    let n = 1.0f32 + 1e-6;
    let r = f64::from(dielectric_reflectance(1.0, n));
    let expected = fresnel(1.0, f64::from(n));
    assert!((r / expected - 1.0).abs() < 1e-6, "{r:e}, not {expected:e}");
    assert!((expected / 2.5e-13 - 1.0).abs() < 0.1, "{expected:e}");
    assert!(dielectric_reflectance(1.0, 1.0) <= 0.0);
    let scene = |ball: &str| {
        let body = camera("(0, 0, 4) m", "(0, 0, 0) m", "(0, 1, 0)", "40 deg", 16)
            + PATHS
            + SKY
            + "light area {
                shape = shape rectangle { center = (1, 0, -3) m, u = (2, 0, 0) m, v = (0, 3, 0) m }
                spectrum = white, scale = 2, two_sided = true
            }\n"
            + ball;
        picture(&body)
    };
    let clear = scene("");
    for ior in ["1", "1.000001"] {
        let ball = format!(
            "shape sphere {{ radius = 1 m, material = material dielectric {{ ior = {ior} }} }}"
        );
        for ((at, a), (_, b)) in clear.pixels().zip(scene(&ball).pixels()) {
            // Radiance changes by n² inside and back: f32. The chance that f32 directions (6e-8) or
            // the bend (2e-6·cot) move a sample over an edge is below 1e-4 for all samples.
            let off = (a.mean - b.mean).abs().max_element();
            assert!(off < 1e-5, "{ior}, {at}: {} and {}", a.mean, b.mean);
        }
    }
}

#[test]
fn lamps_sixty_orders_apart_stay_finite() {
    let ball = "shape sphere { radius = 1 m, material = skin }";
    for radiance in [1e30, 1e-30] {
        let body = furnace(ball, "(0, 0.3, 1) m", "60 deg", radiance);
        check(&body, 2.0 * radiance, 1e-5);
        let body = body.replace("light_sampling = false", "light_sampling = true");
        check(&body.replace("samples = 4", "samples = 256"), 2.0 * radiance, 1e-5);
    }
    // Both at once over a floor at x = 0: E = I cos/d², and the weak lamp is lost in rounding.
    let body = camera("(0, 1, 0.5) m", "(0, 0, 0) m", "(0, 1, 0)", "0.01 deg", 64)
        + "integrator direct {}
        light point { position = (0, 2, 0) m, spectrum = white, scale = 1e30 }
        light point { position = (1, 2, 0) m, spectrum = white, scale = 1e-30 }
        shape plane { material = material diffuse { reflectance = 1 } }";
    check(&body, 1e30 / 4.0 / PI, 1e-4);
}

#[test]
fn values_below_the_normal_numbers_stay_finite() {
    // A convex ball in an even world: ρ·L. Steps of f32 down there are 1.4e-45, 3e-5 of 5e-41.
    let scene = |sky: &str, rho: &str, radius: &str| {
        let at = format!("(0, 0, 5) * {radius}");
        camera(&at, "(0, 0, 0) m", "(0, 1, 0)", "3 deg", 16)
            + &format!(
                "light constant {{ spectrum = white, scale = {sky} }}
                shape sphere {{ radius = {radius}, material = material diffuse {{ reflectance = {rho} }} }}\n"
            )
    };
    let dim = |body: String| body + PATHS;
    check(&dim(scene("1e-40", "0.5", "1 m")), 5e-41, 1e-4);
    check(&dim(scene("1", "1e-40", "1 m")), 1e-40, 1e-4);
    check(&dim(scene("1", "0.5", "1e-100 m")), 0.5, 1e-5);
    // With light sampling squares of densities underflow too: finite and not brighter than the sky.
    for (sky, rho, radius) in [("1e-40", "1e-40", "1 m"), ("1e-44", "0.5", "1e-30 m")] {
        let mean = picture(&scene(sky, rho, radius)).mean().0;
        assert!(mean.y >= 0.0 && mean.y <= 1e-40, "{sky} {rho} {radius}: {mean}");
    }
}

#[test]
fn numbers_beyond_all_numbers_are_told_with_their_place() {
    // Whether something is said of the second line.
    let is_told = |number: &str| {
        let text = format!("scene 1\nshape sphere {{ radius = ({number}) * 1 m }}\n");
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let said = stage_of(Path::new("a.scene"), &files, &[], None).unwrap_err();
        let second = |span: Span| text[..span.start as usize].matches('\n').count() == 1;
        said.iter().any(|d| d.is_error() && d.span().is_some_and(second))
    };
    for number in ["1e400", "nan", "inf", "1 / 0", "0 / 0", "1e300 * 1e300"] {
        assert!(is_told(number), "{number}");
    }
    assert!(!is_told("1e300"));
}

/// A shape of a size and a skin.
type Form<'a> = &'a dyn Fn(&str, &str) -> String;

#[test]
fn both_faces_of_a_layer_of_forty_millionths_are_met() {
    // A shining black core in a coat of glass: (1 − R)/n² of its radiance gets out, R = 0.04. A ray
    // that starts beyond the coat finds the core's dark inside, one that misses the core nothing.
    let cube = |a: &str, skin: &str| block([a; 3], skin);
    let ball =
        |a: &str, skin: &str| format!("shape sphere {{ radius = {a} m, material = {skin} }}");
    let glass = "material dielectric { ior = 1.5 }";
    let black = "material diffuse { reflectance = 0 }";
    let forms: [(Form<'_>, &str); 3] = [(&ball, "standard"), (&cube, "standard"), (&cube, "exact")];
    for (form, precision) in forms {
        for away in ["0 m", "1e3 m", "1e5 m"] {
            let (coat, core) = (form("1", glass), form("0.99996", black));
            let body = camera("from", "to", "(0, 1, 0)", "0.1 deg", 256)
                .replace("(8, 8)", &format!("(8, 8), precision = \"{precision}\""));
            let body = format!(
                "let to = (1, 0, 0) * {away}\nlet from = to + (0.01, 0.02, 4) m\n{body}{PATHS}
                group {{
                    transform = move(to)
                    {coat}
                    light area {{ shape = {core}, spectrum = white, scale = 1 }}
                }}"
            );
            // R at the 0.4° of the view is that of 0° but for 1e-6.
            check(&body, 0.96 / 2.25, 1e-4);
        }
    }
}

#[test]
fn a_pixel_keeps_its_mean_through_ten_million_samples() {
    // 1 and 3 by turns after a firefly of 1e9: the mean is 2 + (1e9 − 2)/n. Push k rounds by at most
    // 2⁻⁵³ of its mean, 2 + 1e9/k, of which k/n remains: in all 2⁻⁵³·(1e9 + n) = 1.12e-7.
    let n = 10_000_001;
    let mut pixel = Pixel::NONE;
    pixel.push(DVec3::splat(1e9));
    for i in 1..n {
        pixel.push(DVec3::splat(if i % 2 == 0 { 1.0 } else { 3.0 }));
    }
    let expected = 2.0 + (1e9 - 2.0) / f64::from(n);
    assert!((pixel.mean.y - expected).abs() < 1.2e-7, "{} {expected}", pixel.mean.y);
    assert_eq!((pixel.n, pixel.bad), (n, 0));
}

#[test]
fn cameras_stand_in_glass_in_fog_and_on_surfaces() {
    let inside = |shape: &str| {
        camera("(0, 0, 0) m", "(0, 0.2, 1) m", "(0, 1, 0)", "70 deg", 16) + PATHS + SKY + shape
    };
    // In equilibrium radiance over n² is the same everywhere; no direction from the middle is
    // trapped. Paths that last long are cut by no one.
    check(
        &inside("shape sphere { radius = 1 m, material = material dielectric { ior = 1.5 } }"),
        2.25,
        1e-5,
    );
    let fog = |m: &str| {
        inside(&format!("shape sphere {{ radius = 1 m, interior = medium homogeneous {{ {m} }} }}"))
    };
    check(&fog("sigma_t = 3 / (1 m), albedo = 1"), 1.0, 1e-5);
    check(
        &fog("sigma_a = 1 / (1 m)").replace("samples = 16", "samples = 1024"),
        f64::exp(-1.0),
        1e-5,
    );
    // On a black surface, looking away from it: the sky, all of it.
    let black = "material = material diffuse { reflectance = 0 }";
    for shape in [
        "shape sphere { center = (0, -1, 0) m, radius = 1 m",
        "shape sphere { center = (0, -0.1, 0) m, radius = 10 cm",
        "shape plane {",
        "shape box { center = (0, -0.5, 0) m, size = (1, 1, 1) m",
        "shape rectangle { u = (0, 0, 2) m, v = (2, 0, 0) m",
        "shape disk { normal = (0, 1, 0), radius = 1 m",
        "shape mesh { points = #[ -1 0 -1  1 0 -1  0 0 2 ] m, indices = #[ 0 2 1 ]",
        "shape mesh { points = #[ -1 0 -0.3  1 0 -1  0 0 2  0 -4 0.1 ] m, indices = #[ 0 2 1  0 1 3  1 2 3  2 0 3 ]",
    ] {
        let body = camera("(0, 0, 0) m", "(0, 1, 0) m", "(0, 0, 1)", "160 deg", 4) + PATHS + SKY;
        check(&format!("{body}{shape}, {black} }}").replace("{,", "{"), 1.0, 1e-6);
    }
}

#[test]
fn mirrored_shapes_keep_their_inside() {
    let glass = "material dielectric { ior = 1.5 }";
    let black = "material diffuse { reflectance = 0 }";
    let ball =
        |a: &str, skin: &str| format!("shape sphere {{ radius = {a} m, material = {skin} }}");
    let cube = |a: &str, skin: &str| block([a; 3], skin);
    for transform in ["scale((-1, 1, 1))", "scale(-1)", "scale((1, 1, -1))"] {
        for form in [&ball as Form<'_>, &cube] {
            // In glass everything is n² as bright; from the middle of this view no ray is trapped.
            let inside = camera("(0, 0, 0) m", "(0, 0.1, 1) m", "(0, 1, 0)", "30 deg", 16) + PATHS;
            let coat = form("1", glass);
            let body = format!("{inside}{SKY}group {{\ntransform = {transform}\n{coat}\n}}");
            check(&body, 2.25, 1e-5);
            // A lamp shines outwards alone.
            let core = form("1", black);
            let lamp = format!(
                "light area {{ shape = {core}, spectrum = white, scale = 1, transform = {transform} }}"
            );
            let outside = camera("(0, 0, 3) m", "(0, 0, 0) m", "(0, 1, 0)", "10 deg", 4) + PATHS;
            check(&format!("{outside}{lamp}"), 1.0, 1e-6);
            check(&format!("{inside}{lamp}"), 0.0, 0.0);
        }
    }
}

#[test]
fn one_lamp_of_a_million_with_nearly_all_power_is_found() {
    // All stand on a circle at the same distance √2 and angle 45°: E = ΣI·cos/d², ΣI = 1.
    let body = camera("(0, 0.5, 0.1) m", "(0, 0, 0) m", "(0, 1, 0)", "0.01 deg", 64)
        + "integrator direct {}
        let weak = light point { position = (1, 1, 0) m, spectrum = white, scale = 1e-10 }
        let ring = group { for i in 0..1000 { place weak { transform = rotate((0, 1, 0), i * 0.36 deg) } } }
        for i in 0..1000 { place ring { transform = rotate((0, 1, 0), i * 0.00036 deg) } }
        light point { position = (1, 1, 0) m, spectrum = white, scale = 0.9999 }
        shape plane { material = material diffuse { reflectance = 1 } }";
    check(&body, 0.5f64.sqrt() / 2.0 / PI, 1e-4);
}

#[test]
fn fog_of_a_hundred_free_paths_that_absorbs_nothing_is_unseen() {
    // No path is cut, none loses anything: one, but for f32.
    for g in ["0", "0.9"] {
        let body = camera("(0, 0, 3) m", "(0, 0, 0) m", "(0, 1, 0)", "30 deg", 2)
            + PATHS
            + SKY
            + &format!(
                "shape sphere {{ radius = 1 m, interior = medium homogeneous {{
                    sigma_t = 50 / (1 m), albedo = 1, phase = phase henyey_greenstein {{ g = {g} }} }} }}"
            );
        check(&body, 1.0, 1e-5);
    }
}
