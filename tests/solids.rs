//! Shapes of which others are made, from the scene file to the ray.

use std::path::Path;

use glam::DVec3;
use luxel_core::accel::Processor;
use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::{self, Stage};
use luxel_sdk::kind::Kind;
use luxel_sdk::num::{Ray, offset_origin};
use luxel_sdk::sampling::Rng;

use crate::load::{Builtins, registry, registry_of};

const CAMERA: &str = "scene 1
camera perspective {
  look = look_at(from = (0, 0, 9) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg
}
";

type Built = Result<(Stage, Vec<Diagnostic>), Vec<Diagnostic>>;

fn build(objects: &str) -> Built {
    build_of(&registry(), objects)
}

fn build_of(registry: &Registry, objects: &str) -> Built {
    let text = format!("{CAMERA}{objects}");
    let files = MemoryFiles::default().with("solids.scene", text.as_bytes());
    let settings = luxel_lang::Settings::default();
    let loaded = luxel_lang::load(Path::new("solids.scene"), &files, registry, &settings);
    let Some(scene) = loaded.scene else { return Err(loaded.diagnostics) };
    stage::build(&scene, registry, &files, None).map(|built| (built.stage, built.warnings))
}

/// The code and the text of the first thing that is wrong.
fn wrong(objects: &str) -> (&'static str, String) {
    let said = build(objects).map(|_| ()).unwrap_err();
    (said[0].code, said[0].message.clone())
}

/// Where a ray crosses the scene, with the cosine of each crossing.
fn crossings(stage: &Stage, o: DVec3, d: DVec3) -> Vec<(DVec3, f64)> {
    let (mut from, mut found) = (o, vec![]);
    while let Some(hit) =
        stage.opening().intersect(Processor::ANY, &Ray::new(from, d), None, &mut 0)
    {
        let s = stage.opening().surface(&Ray::new(from, d), &hit);
        from = offset_origin(s.p, s.p_err, s.ng, d);
        found.push((s.p, s.ng.dot(d)));
        assert!(found.len() < 100);
    }
    found
}

/// Crossings along x, through the origin.
fn along_x(objects: &str) -> Vec<f64> {
    let (stage, warnings) = build(objects).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let found = crossings(&stage, DVec3::X * -50.0, DVec3::X);
    for (k, (_, cos)) in found.iter().enumerate() {
        assert_eq!(*cos < 0.0, k % 2 == 0, "in and out in turn");
    }
    found.iter().map(|(p, _)| p.x).collect()
}

fn check(objects: &str, truth: &[f64]) {
    let found = along_x(objects);
    assert_eq!(found.len(), truth.len(), "{found:?}");
    for (x, truth) in found.iter().zip(truth) {
        assert!((x - truth).abs() < 1e-13, "{found:?}");
    }
}

#[test]
fn parts_stand_where_their_transforms_say() {
    check(
        "shape union { a = shape sphere { radius = 1 m }, b = shape sphere { radius = 1 m, transform = move((3, 0, 0) m) } }",
        &[-1.0, 1.0, 2.0, 4.0],
    );
    // A cube on its edge, stretched; the whole is moved as well.
    check(
        "shape difference {
           a = shape box { size = (2, 2, 2) m, transform = [rotate((0, 1, 0), 45 deg), scale((2, 1, 1))] }
           b = shape sphere { radius = 50 cm, transform = scale((2, 1, 1)) }
           transform = move((1, 0, 0) m)
         }",
        &[1.0 - 8f64.sqrt(), 0.0, 2.0, 1.0 + 8f64.sqrt()],
    );
    // Mirrored, its outside stays outside.
    check(
        "shape intersection { a = shape sphere { radius = 1 m, transform = scale((-1, 1, 1)) }, b = shape box { center = (1, 0, 0) m, size = (2, 2, 2) m } }",
        &[0.0, 1.0],
    );
}

#[test]
fn one_named_shape_may_be_a_part_of_several() {
    check(
        "let ball = shape sphere { radius = 1 m }
         shape union {
           a = shape union { a = ball, b = shape torus { radius = 3 m, tube = 25 cm } }
           b = shape capsule { base = (7, 0, 0) m, radius = 1 m, height = 1 m }
         }",
        &[-3.25, -2.75, -1.0, 1.0, 2.75, 3.25, 6.0, 8.0],
    );
}

#[test]
fn what_cannot_be_a_part_is_told_at_its_place() {
    let ball = "shape sphere { radius = 1 m }";
    let of = |b: &str| format!("shape union {{ a = {ball}, b = {b} }}");
    let (code, text) = wrong(&of("shape rectangle { u = (1, 0, 0) m, v = (0, 1, 0) m }"));
    assert!(code == "E0405" && text.contains("`b` encloses no volume"), "{text}");
    let (code, text) = wrong(&of("shape sphere { radius = 1 m, material = material diffuse {} }"));
    assert!(code == "E0402" && text.contains("has no `material`"), "{text}");
    let flat = "matrix([1, 0, 0, 0,  0, 1, 0, 0,  1, 1, 0, 0,  0, 0, 0, 1])";
    let (code, text) = wrong(&of(&format!("shape sphere {{ radius = 1 m, transform = {flat} }}")));
    assert!(code == "E0412" && text.contains("flattens"), "{code} {text}");
    let moving = "shape sphere { radius = 1 m, transform = spin((0, 1, 0), 1 rad / (1 s)) }";
    let (code, text) = wrong(&of(moving));
    assert!(code == "E0418" && text.contains("does not move in it"), "{code} {text}");
    let (code, text) = wrong(&of("shape mesh {
        points      = #[ 0 0 0  1 0 0  0 1 0  0 0 1 ] m, indices = #[ 0 2 1  0 1 3  0 3 2  1 2 3 ]
        next_points = #[ 0 0 0  2 0 0  0 2 0  0 0 2 ] m
    }"));
    assert!(code == "E0405" && text.contains("points move"), "{code} {text}");
    let (code, text) = wrong(&of("material diffuse {}"));
    assert!(code == "E0408" && text.contains("wants a shape"), "{text}");
    let (code, text) = wrong(&format!("shape union {{ a = {ball} }}"));
    assert!(code == "E0403" && text.contains("wants `b`"), "{text}");
    let (code, text) = wrong(
        "shape union {
           a = shape sphere { radius = 1 m }, smooth = 1 cm
           b = shape cone { radius = 1 m, height = 1 m, caps = true }
         }",
    );
    assert!(code == "E0405" && text.contains("does not know its distance"), "{text}");
}

#[test]
fn solids_nest_until_their_faces_are_used_up() {
    let nested = |depth: usize| {
        let mut text = "shape sphere { radius = 1 m }".to_owned();
        for i in 0..depth {
            let x = 3 * (i + 1);
            text = format!(
                "shape union {{ a = {text}, b = shape sphere {{ center = ({x}, 0, 0) m, radius = 1 m }} }}"
            );
        }
        text
    };
    let truth: Vec<f64> =
        (0..17).flat_map(|i| [f64::from(3 * i - 1), f64::from(3 * i + 1)]).collect();
    check(&nested(16), &truth);
    let (_, text) = wrong(&nested(17));
    assert!(text.contains("more than 16 deep"), "{text}");
}

#[test]
fn a_lamp_that_cannot_be_sampled_shines_with_a_warning() {
    let lamp = "light area {
      shape = shape gyroid_wall { radius = 1 m }, spectrum = rgb.srgb(1, 1, 1), scale = 1
    }";
    let (stage, warnings) = build(lamp).unwrap();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].message.contains("found by chance alone"), "{warnings:?}");
    assert!(!crossings(&stage, DVec3::X * -50.0, DVec3::X).is_empty());
}

#[test]
fn a_stretched_lamp_that_cannot_be_sampled_shines_with_its_power() {
    let lamp = |transform: &str| {
        format!(
            "film rgb {{ resolution = (16, 16) }}
            filter box {{}}
            integrator path {{ max_depth = 0 }}
            light area {{ power = 8 W, transform = {transform}, shape = shape union {{
                a = shape sphere {{ radius = 1 m }}, b = shape sphere {{ radius = 0.5 m }} }} }}"
        )
    };
    let radiance = |transform: &str| {
        let (stage, _) = build(&lamp(transform)).unwrap();
        let (film, _) = render(&stage, &Options::default(), &Control::default());
        film.pixels().map(|(_, pixel)| pixel.mean.y).fold(0.0, f64::max)
    };
    // An ellipsoid twice as long has 1/2 + 2/√3·asin(√3/2) = 1.709 times the area of a ball.
    let ratio = radiance("scale(1)") / radiance("scale((2, 1, 1))");
    let expected = 0.5 + 2.0 / 3f64.sqrt() * (3f64.sqrt() / 2.0).asin();
    // Areas of unions are measured to 1e-3, and normals of all directions stand for those of a ball.
    assert!((ratio / expected - 1.0).abs() < 5e-3, "{ratio}, not {expected}");
}

#[test]
fn parts_of_a_library_and_built_in_ones_give_the_same_bits() {
    let (linked, loaded) = (registry_of(Builtins::Linked), registry_of(Builtins::Loaded));
    let solids = ["union", "difference"];
    // The library's solids, the library's parts, or both.
    let mixed = |solids_loaded: bool, parts_loaded: bool| {
        let mut registry = Registry::new();
        for (all, origin) in [(&linked, "linked"), (&loaded, "loaded")] {
            for entry in all.all() {
                let solid = entry.class.kind == Kind::Shape && solids.contains(&entry.class.name);
                let wanted = if solid { solids_loaded } else { parts_loaded };
                if entry.origin != "host" && wanted == (origin == "loaded") {
                    registry.add(origin, &[entry.class]).unwrap();
                }
            }
        }
        registry
    };
    let text = "shape difference {
      a = shape union {
        a = shape sphere { radius = 1 m }
        b = shape box { size = (3, 1, 1) m, transform = rotate((0, 0, 1), 20 deg) }
        smooth = 20 cm
      }
      b = shape torus { radius = 90 cm, tube = 20 cm }
    }";
    let crossed = |registry: &Registry| {
        let (stage, _) = build_of(registry, text).unwrap();
        let rays = (0..200).map(|i| DVec3::new(-5.0, 0.01 * f64::from(i) - 1.0, 0.1));
        let all = rays.flat_map(|o| crossings(&stage, o, DVec3::new(0.9, 0.0, 0.02)));
        all.map(|(p, cos)| (p.to_array().map(f64::to_bits), cos.to_bits())).collect::<Vec<_>>()
    };
    let truth = crossed(&linked);
    assert!(truth.len() > 300, "{}", truth.len());
    for (solids_loaded, parts_loaded) in [(true, true), (true, false), (false, true)] {
        let found = crossed(&mixed(solids_loaded, parts_loaded));
        assert!(found == truth, "solids loaded: {solids_loaded}, parts loaded: {parts_loaded}");
    }
}

/// A cube of edge 2 about the origin, as triangles.
const CUBE: &str = "shape mesh {
  points  = #[ -1 -1 -1   1 -1 -1   1 -1 1   -1 -1 1   -1 1 -1   1 1 -1   1 1 1   -1 1 1 ] m
  indices = #[ 0 1 2  0 2 3   4 6 5  4 7 6   0 4 5  0 5 1   1 5 6  1 6 2   2 6 7  2 7 3   3 7 4  3 4 0 ]
  MORE
}";

#[test]
fn closed_meshes_are_parts_as_other_shapes_are() {
    let cube = |more: &str| CUBE.replace("MORE", more);
    let ball = "shape sphere { center = (1, 0, 0) m, radius = 50 cm }";
    for (more, by) in [("", 1.0), ("transform = scale((2, 1, 1))", 2.0)] {
        let of = |class: &str| format!("shape {class} {{ a = {}, b = {ball} }}", cube(more));
        // Right through edges and diagonals of the faces.
        check(&of("union"), &[-by, 1.5f64.max(by)]);
        let eaten = if by > 1.5 { vec![-by, 0.5, 1.5, by] } else { vec![-by, 0.5] };
        check(&of("difference"), &eaten);
        check(&of("intersection"), &[0.5, 1.5f64.min(by)]);
    }
    // Faces of both lie in each other.
    let half = "shape box { center = (1, 0, 0) m, size = (2, 2, 2) m }";
    check(&format!("shape union {{ a = {}, b = {half} }}", cube("")), &[-1.0, 2.0]);
    let open = CUBE.replace("3 7 4  3 4 0", "3 7 4").replace("MORE", "");
    let (code, text) = wrong(&format!("shape union {{ a = {open}, b = {ball} }}"));
    assert!(code == "E0405" && text.contains("`a` encloses no volume"), "{text}");
}

#[test]
fn a_mesh_with_a_hole_is_crossed_in_turn_by_rays_from_everywhere() {
    let carved = format!(
        "shape difference {{
           a = {}
           b = shape sphere {{ center = (0.9, 0.3, 0.2) m, radius = 70 cm }}
           transform = [rotate((1, 2, 3), 40 deg), move((1000, 0, 0) m)]
         }}",
        CUBE.replace("MORE", "")
    );
    let (stage, _) = build(&carved).unwrap();
    let mut rng = Rng::new(99);
    let mut n = 0;
    for _ in 0..5000 {
        let mut any = || DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 2.0 - 1.0;
        let (d, target) = (any().normalize(), any() + DVec3::X * 1000.0);
        let found = crossings(&stage, target - d * 5.0, d);
        assert!(found.len().is_multiple_of(2), "{found:?}");
        for (k, (_, cos)) in found.iter().enumerate() {
            assert!(cos.abs() < 1e-6 || (*cos < 0.0) == (k % 2 == 0), "{found:?}");
        }
        n += found.len();
    }
    assert!(n > 8000, "{n}");
}

#[test]
fn a_part_whose_file_has_changed_is_made_anew() {
    let obj = |x: f64| {
        let corner = |i: i32| [-1.0, x][usize::from(i != 0)];
        let corners = (0..8).map(|i| (corner(i & 1), 2 * (i >> 1 & 1) - 1, 2 * (i >> 2) - 1));
        let points: Vec<_> = corners.map(|(x, y, z)| format!("v {x} {y} {z}\n")).collect();
        let faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"];
        points.concat() + &faces.map(|f| format!("f {f}\n")).concat()
    };
    let text = format!(
        "{CAMERA}shape difference {{ a = shape mesh {{ file = \"a.obj\", unit = 1 m }}, b = shape sphere {{ radius = 50 cm }} }}"
    );
    let registry = registry();
    let stage = |x: f64, before: Option<&Stage>| {
        let files = MemoryFiles::default().with("solids.scene", text.as_bytes());
        let files = files.with("a.obj", obj(x).as_bytes());
        let settings = luxel_lang::Settings::default();
        let loaded = luxel_lang::load(Path::new("solids.scene"), &files, &registry, &settings);
        let said: Vec<_> = loaded.diagnostics.iter().map(ToString::to_string).collect();
        stage::build(&loaded.scene.unwrap_or_else(|| panic!("{said:?}")), &registry, &files, before)
            .unwrap()
            .stage
    };
    let last = |stage: &Stage| crossings(stage, DVec3::X * -50.0, DVec3::X)[3].0.x;
    let first = stage(1.0, None);
    assert!((last(&first) - 1.0).abs() < 1e-13);
    assert!((last(&stage(3.0, Some(&first))) - 3.0).abs() < 1e-13);
}
