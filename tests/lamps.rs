//! Lamps of triangles: found by their solid angle, as the density says, and as bright as others.

use std::path::Path;

use glam::DVec3;
use luxel_core::accel::Processor;
use luxel_core::files::MemoryFiles;
use luxel_core::film::Film;
use luxel_core::object::Scratch;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::Stage;
use luxel_sdk::color::Palette;
use luxel_sdk::kind::{Arrival, ArrivalKind};
use luxel_sdk::num::{Moments, Ray};
use luxel_sdk::sampling::Rng;

use crate::load::stage_of;

fn stage(body: &str) -> Stage {
    let text = format!("scene 1\nlet white = rgb.linear_srgb(1, 1, 1)\nfilter box {{}}\n{body}");
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    stage_of(Path::new("a.scene"), &files, &[], None).unwrap_or_else(|e| panic!("{body}: {e:?}"))
}

/// A lamp of radiance 1 on both sides.
fn lamp(shape: &str) -> String {
    format!(
        "light area {{ shape = shape {shape}, spectrum = white, scale = 1, two_sided = true }}\n"
    )
}

/// A camera for scenes that need none.
const ANY: &str = "camera perspective { look = look_at(from = (0, 9, 9) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
    film rgb { resolution = (8, 8) }\n";

/// A quad as two triangles, by its corners in turn, m.
fn quad(corners: [DVec3; 4], transform: &str) -> String {
    let numbers: Vec<String> =
        corners.iter().flat_map(DVec3::to_array).map(|x| format!("{x:e}")).collect();
    let points = numbers.join(" ");
    let transform =
        if transform.is_empty() { String::new() } else { format!(", transform = {transform}") };
    format!("mesh {{ points = #[ {points} ] m, indices = #[ 0 1 2  0 2 3 ]{transform} }}")
}

const SQUARE: [DVec3; 4] = [
    DVec3::new(-1.0, 0.0, 1.0),
    DVec3::new(1.0, 0.0, 1.0),
    DVec3::new(1.0, 0.0, -1.0),
    DVec3::new(-1.0, 0.0, -1.0),
];

/// Solid angle of a triangle by the angles between its sides (Girard).
fn girard(corners: [DVec3; 3], from: DVec3) -> f64 {
    let [a, b, c] = corners.map(|p| (p - from).normalize());
    let angle = |p: DVec3, q: DVec3, r: DVec3| p.cross(q).angle_between(p.cross(r));
    angle(a, b, c) + angle(b, c, a) + angle(c, a, b) - std::f64::consts::PI
}

/// Finds the lamp from a place over and over: each time with the density that who meets it there is
/// told, which is one over the solid angle of both its triangles.
fn check_found(stage: &Stage, corners: [DVec3; 4], from: DVec3, slack: f64) {
    let [a, b, c, d] = corners;
    let halves = [girard([a, b, c], from), girard([a, c, d], from)];
    let stage = stage.opening();
    let arrival = Arrival { kind: ArrivalKind::Medium, p: from, ..Arrival::default() };
    let (palette, mut scratch, mut rng) = (Palette::rgb(), Scratch::default(), Rng::new(5));
    let mut whole = Moments::default();
    for _ in 0..4000 {
        let u = [rng.f32(), rng.f32(), rng.f32()];
        scratch.reset();
        let found = stage.sample_light::<true>(&arrival, &palette, u, &scratch);
        let found = found.unwrap_or_else(|| panic!("nothing from {from} by {u:?}"));
        let ray = Ray { t_max: f64::INFINITY, ..found.ray };
        whole.push(f64::from(found.pdf).recip());
        // What grazes an edge may miss by rounding.
        let Some(hit) = stage.intersect(Processor::ANY, &ray, None, &mut 0) else { continue };
        let surface = stage.surface(&ray, &hit);
        let placement = &stage.placements[hit.placement as usize];
        scratch.reset();
        let met = (placement, hit.hit.face);
        let (le, pdf) = stage.surface_emission(met, &surface, (from, ray.d), &palette, &scratch);
        assert!((le.mean() - 1.0).abs() <= 1e-6);
        assert!((le.mean() / pdf / found.le_over_pdf.mean() - 1.0).abs() <= 1e-6);
        assert!((pdf / found.pdf - 1.0).abs() <= 1e-6, "{from}: {pdf} {}", found.pdf);
        let truth = (halves[0] + halves[1]).recip();
        assert!((f64::from(pdf) / truth - 1.0).abs() <= slack, "{from}: {pdf} {truth}");
    }
    let (sum, noise) = (halves[0] + halves[1], whole.standard_error());
    assert!((whole.mean - sum).abs() <= 4.0 * noise + slack * sum, "{} {sum}", whole.mean);
}

#[test]
fn triangles_are_found_by_their_solid_angle_wherever_they_stand() {
    let near = [
        DVec3::new(0.2, -0.3, 0.1),
        DVec3::new(0.9, -1e-3, -0.8),
        DVec3::new(1.5, 0.02, 0.3),
        DVec3::new(-1.0, 1.0, 1.5),
    ];
    for from in near {
        check_found(&stage(&format!("{ANY}{}", lamp(&quad(SQUARE, "")))), SQUARE, from, 1e-6);
        for scale in [1e-9, 1e9] {
            let corners = SQUARE.map(|p| p * scale);
            let lamp = lamp(&quad(corners, ""));
            check_found(&stage(&format!("{ANY}{lamp}")), corners, from * scale, 1e-6);
        }
        // Far away by its transform: places there are known to 1e-10 m, a 1e-7th of the distance.
        let far = DVec3::new(1e6, -1e6, 3e6);
        let lamp = lamp(&quad(SQUARE, "move((1e6, -1e6, 3e6) m)"));
        check_found(&stage(&format!("{ANY}{lamp}")), SQUARE.map(|p| p + far), far + from, 1e-5);
    }
}

#[test]
fn sheared_and_mirrored_triangles_are_found_by_their_solid_angle_in_the_world() {
    let columns = [[2.0, 0.3, -0.5], [0.4, -1.0, 0.2], [1.5, 0.1, 0.25], [0.5, -2.0, 1.0]];
    let [x, y, z, t] = columns.map(DVec3::from_array);
    let world = |p: DVec3| x * p.x + y * p.y + z * p.z + t;
    let row = |i: usize| format!("{}, {}, {}, {}", x[i], y[i], z[i], t[i]);
    let matrix = format!("matrix([{}, {}, {}, 0, 0, 0, 1])", row(0), row(1), row(2));
    let stage = stage(&format!("{ANY}{}", lamp(&quad(SQUARE, &matrix))));
    for local in [[0.2, -0.3, 0.1], [0.9, 0.01, -0.8], [1.5, 0.1, 0.3], [-1.0, 0.6, 1.5]] {
        check_found(&stage, SQUARE.map(world), world(DVec3::from_array(local)), 1e-6);
    }
}

#[test]
fn from_its_plane_an_edge_or_a_corner_a_lamp_is_found_by_numbers_or_not_at_all() {
    let built = stage(&format!("{ANY}{}", lamp(&quad(SQUARE, ""))));
    let stage = built.opening();
    let (palette, scratch, mut rng) = (Palette::rgb(), Scratch::default(), Rng::new(6));
    let corners = [[0.3, 0.0, 0.2], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.5], [0.0; 3]];
    let mut found = 0;
    for height in [0.0, 1e-300, 1e-20, 1e-12, 1e-6] {
        for p in corners.map(|p| DVec3::from_array(p) + DVec3::Y * height) {
            let from = Arrival { kind: ArrivalKind::Medium, p, ..Arrival::default() };
            for _ in 0..500 {
                let u = [rng.f32(), rng.f32(), rng.f32()];
                let Some(light) = stage.sample_light::<true>(&from, &palette, u, &scratch) else {
                    continue;
                };
                found += 1;
                assert!(light.pdf > 0.0 && !light.pdf.is_nan(), "{p}: {light:?}");
                assert!(light.le_over_pdf.is_finite() && light.ray.d.is_finite(), "{p}: {light:?}");
            }
        }
    }
    assert!(found > 4000, "{found}");
}

/// A floor below a lamp that all but touches it.
fn floor(shape: &str, integrator: &str, samples: u32) -> Film {
    let body = format!(
        "camera orthographic {{ look = look_at(from = (0, 0.2, 0) m, to = (0, 0, 0) m, up = (0, 0, 1)), height = 3 m }}
        film rgb {{ resolution = (12, 12), shutter = 1 s }}
        sampler independent {{ samples = {samples}, seed = 7 }}
        {integrator}
        shape rectangle {{ u = (0, 0, 9) m, v = (9, 0, 0) m, material = material diffuse {{ reflectance = 0.5 }} }}
        light area {{ shape = shape {shape}, spectrum = white, scale = 1 }}\n"
    );
    let (film, _) = render(&stage(&body), &Options::default(), &Control::default());
    assert_eq!(film.bad_samples(), 0);
    film
}

#[test]
fn a_lamp_of_two_triangles_lights_as_the_rectangle_does() {
    let rectangle = "rectangle { center = (0.1, 0.3, 0) m, u = (2, 0, 0.2) m, v = (-0.1, 0, 1) m }";
    let corner = |i: f64, j: f64| {
        DVec3::new(0.1, 0.3, 0.0) + DVec3::new(1.0, 0.0, 0.1) * i + DVec3::new(-0.05, 0.0, 0.5) * j
    };
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let direct = "integrator path { max_depth = 2 }";
    let blind = "integrator path { max_depth = 2, light_sampling = false }";
    let films = [
        floor(rectangle, direct, 1024),
        floor(&quad(corners, ""), direct, 1024),
        floor(&quad(corners, ""), blind, 8192),
    ];
    for film in &films[1..] {
        let mut squares = 0.0;
        for ((_, a), (_, b)) in films[0].pixels().zip(film.pixels()) {
            let noise = (a.standard_error().y).hypot(b.standard_error().y);
            let z = (a.mean.y - b.mean.y) / noise;
            assert!(z.abs() <= 5.0, "{z}");
            squares += z * z;
        }
        let n = films[0].pixels().count() as f64;
        assert!(squares <= n + 5.0 * (2.0 * n).sqrt(), "{squares} of {n}");
        let ((a, da), (b, db)) = (films[0].mean(), film.mean());
        assert!((a.y - b.y).abs() <= 4.0 * da.y.hypot(db.y), "{a} {b}");
        assert!(da.y.hypot(db.y) <= 0.005 * a.y, "too noisy to tell");
    }
}

/// A rectangle that its placement stretches along a diagonal, and the same as two triangles.
fn stretched(ratio: f64) -> [String; 2] {
    let (p, q) = (0.5 * (ratio + 1.0), 0.5 * (ratio - 1.0));
    let size = ratio.sqrt().recip();
    let corner = |x: f64, z: f64| {
        let (x, z) = (0.5 * size * x, 0.5 * size * z);
        DVec3::new(p * x + q * z, 0.3, q * x + p * z)
    };
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let rectangle = format!(
        "rectangle {{ u = ({size}, 0, 0) m, v = (0, 0, {size}) m,
           transform = matrix([{p}, 0, {q}, 0, 0, 1, 0, 0.3, {q}, 0, {p}, 0, 0, 0, 0, 1]) }}"
    );
    [rectangle, quad(corners, "")]
}

#[test]
fn a_sheared_rectangle_is_found_by_its_solid_angle_in_the_world() {
    for ratio in [1.0, 3.0, 10.0] {
        let [rectangle, triangles] = stretched(ratio);
        let direct = "integrator path { max_depth = 2 }";
        let [a, b] = [floor(&rectangle, direct, 1024), floor(&triangles, direct, 1024)];
        let ((x, dx), (y, dy)) = (a.mean(), b.mean());
        let noise = dx.y.hypot(dy.y);
        assert!((x.y - y.y).abs() <= 4.0 * noise, "{ratio}: {x} {y}");
        assert!(noise <= 0.005 * x.y, "too noisy to tell");
        let variance = |film: &Film| film.pixels().map(|(_, p)| p.variance().y).sum::<f64>();
        let worse = variance(&a) / variance(&b);
        assert!((worse - 1.0).abs() <= 0.1, "{ratio}: {worse} times the variance");
    }
}

#[test]
fn who_meets_a_sheared_rectangle_is_told_the_density_of_finding_it() {
    let direct = "integrator path { max_depth = 2 }";
    let [rectangle, _] = stretched(3.0);
    let both = floor(&rectangle, direct, 1024).mean();
    let blind = "integrator path { max_depth = 2, light_sampling = false }";
    let met = floor(&rectangle, blind, 8192).mean();
    let noise = both.1.y.hypot(met.1.y);
    assert!((both.0.y - met.0.y).abs() <= 4.0 * noise, "{} {}", both.0, met.0);
    assert!(noise <= 0.005 * met.0.y, "too noisy to tell");
}

#[test]
fn a_lamp_that_moves_and_bends_is_found_where_it_is() {
    let bends = "mesh {
        points = #[ -0.5 0.3 -0.5  0.5 0.3 -0.5  0.5 0.3 0.5  -0.5 0.3 0.5 ] m, indices = #[ 0 1 2  0 2 3 ]
        next_points = #[ -0.5 0.4 -0.5  0.9 0.3 -0.5  0.5 0.5 0.5  -0.5 0.3 0.2 ] m
        transform = motion([(0 s, scale((1, 1, 1))), (1 s, scale((1, 1.6, 0.7)))])
    }";
    let direct = floor(bends, "integrator path { max_depth = 2 }", 1024).mean();
    let blind = "integrator path { max_depth = 2, light_sampling = false }";
    let met = floor(bends, blind, 8192).mean();
    let noise = direct.1.y.hypot(met.1.y);
    assert!((direct.0.y - met.0.y).abs() <= 4.0 * noise, "{} {}", direct.0, met.0);
    assert!(met.0.y > 0.0 && noise <= 0.01 * met.0.y, "too noisy to tell");
}
