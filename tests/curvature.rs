//! How surfaces bend in their places: what the host makes of what shapes and normals of meshes say.

use std::path::Path;

use glam::{DVec2, DVec3};
use luxel_core::accel::{Precision, Processor};
use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::{Geometry, SceneHit, Stage};
use luxel_sdk::kind::Hit;
use luxel_sdk::num::{Ray, Transform};
use luxel_sdk::sampling::Rng;

use crate::load::stage_of;

fn stage(body: &str) -> Stage {
    let text = format!(
        "scene 1\nfilter box {{}}\nintegrator debug {{ show = \"curvature\", scale = 0.5 }}
        camera orthographic {{ look = look_at(from = (0, 0, 9) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 6 m }}
        film rgb {{ resolution = (24, 24) }}
        sampler independent {{ samples = 1, seed = 1 }}\n{body}"
    );
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    stage_of(Path::new("a.scene"), &files, &[], None).unwrap_or_else(|e| panic!("{body}: {e:?}"))
}

/// Where a ray towards −z meets the first surface, and mean curvature there.
fn met_at(stage: &Stage, x: f64, y: f64) -> Option<(DVec3, f64)> {
    let stage = stage.opening();
    let ray = Ray::new(DVec3::new(x, y, 9.0), -DVec3::Z);
    let hit = stage.intersect(Processor::ANY, &ray, None, &mut 0)?;
    let surface = stage.surface(&ray, &hit);
    Some((surface.p, stage.mean_curvature(&ray, &hit, &surface)))
}

fn met(stage: &Stage, x: f64, y: f64) -> Option<f64> {
    met_at(stage, x, y).map(|(_, mean)| mean)
}

#[test]
fn curvature_is_that_of_closed_forms() {
    let near = |found: f64, truth: f64| assert!((found - truth).abs() <= 1e-12, "{found} {truth}");
    let ball = stage("shape sphere { radius = 2 m }");
    near(met(&ball, 0.3, 1.1).unwrap(), 0.5);
    let rod = stage("shape cylinder { base = (0, -2, 0) m, radius = 1 m, height = 4 m }");
    near(met(&rod, 0.3, 1.1).unwrap(), 0.5);
    let floor = stage("shape rectangle { u = (2, 0, 0) m, v = (0, 2, 0) m }");
    near(met(&floor, 0.3, 0.4).unwrap(), 0.0);
    // The inner equator of a ring of 2 m and 0.5 m: 1 / 0.5 across, −1 / 1.5 around.
    let ring = stage("shape torus { axis = (0, 0, 1), radius = 2 m, tube = 50 cm }");
    near(met(&ring, 2.0, 0.0).unwrap(), 1.0);
    near(met(&ring, 2.25, 0.0).unwrap(), 0.5 * (2.0 + 0.5 / 2.25));
    near(met(&ring, -1.75, 0.0).unwrap(), 0.5 * (2.0 - 0.5 / 1.75));
    // An ellipsoid of half axes a, b and c from the end of c: half of c/a² + c/b².
    let egg = stage("shape sphere { radius = 1 m, transform = scale((1, 2, 3)) }");
    near(met(&egg, 0.0, 0.0).unwrap(), 0.5 * (3.0 + 3.0 / 4.0));
    let mirrored = stage("shape sphere { radius = 1 m, transform = scale((-1, 2, 3)) }");
    near(met(&mirrored, 0.0, 0.0).unwrap(), 0.5 * (3.0 + 3.0 / 4.0));
}

#[test]
fn solids_bend_as_the_part_that_is_met() {
    let near = |found: f64, truth: f64, slack: f64| {
        assert!((found - truth).abs() <= slack, "{found} {truth}");
    };
    let parts = "a = shape sphere { radius = 2 m }, b = shape sphere { center = (9, 0, 0) m, radius = 1 m }";
    let sharp = stage(&format!("shape union {{ {parts} }}"));
    near(met(&sharp, 0.3, 1.1).unwrap(), 0.5, 1e-12);
    // Second differences are exact to a millionth.
    let blended = stage(&format!("shape union {{ {parts}, smooth = 20 cm }}"));
    near(met(&blended, 0.3, 1.1).unwrap(), 0.5, 1e-6);
    // A bowl is hollow, and its brim flat.
    let bowl = stage(
        "shape difference {
          a = shape box { size = (4, 4, 4) m }
          b = shape sphere { center = (0, 0, 2) m, radius = 1 m }
        }",
    );
    near(met(&bowl, 0.3, 0.2).unwrap(), -1.0, 1e-12);
    near(met(&bowl, 1.3, 0.2).unwrap(), 0.0, 1e-12);
}

#[test]
fn parts_bend_in_their_own_places_too() {
    let near = |found: f64, truth: f64| assert!((found - truth).abs() <= 1e-12, "{found} {truth}");
    // An ellipsoid of half axes 1, 2 and 3 from the end of the longest, in a place of the part and one
    // of the whole; mirrored, v runs the other way.
    for scales in ["(1, 2, 3)", "(-1, 2, 3)"] {
        let egg = stage(&format!(
            "shape union {{
              a = shape sphere {{ radius = 1 m, transform = scale({scales}) }}
              b = shape sphere {{ center = (9, 0, 0) m, radius = 1 m }}
              transform = move((0.3, 0.2, 0) m)
            }}"
        ));
        near(met(&egg, 0.3, 0.2).unwrap(), 0.5 * (3.0 + 3.0 / 4.0));
    }
    // A tetrahedron whose corners' normals are those of the ball about it, of √3 m: by them the normal
    // at p is that of a ball about the origin, and turns by the part of a step across p over |p|. Its faces
    // are 1/√3 m from the origin, so that the mean is (1 + 1 / (3·p²)) / 2·|p|. Without them it is flat.
    let smooth = ", normals = #[ 0.57735 0.57735 0.57735  -0.57735 -0.57735 0.57735  -0.57735 0.57735 -0.57735  0.57735 -0.57735 -0.57735 ]";
    for (normals, is_smooth) in [(smooth, true), ("", false)] {
        let ball = stage(&format!(
            "shape difference {{
              a = shape mesh {{ points = #[ 1 1 1  -1 -1 1  -1 1 -1  1 -1 -1 ] m, indices = #[ 0 2 1  0 1 3  0 3 2  1 2 3 ]{normals} }}
              b = shape sphere {{ center = (9, 0, 0) m, radius = 1 m }}
              transform = rotate((1, 0, 0), 54 deg)
            }}"
        ));
        for (x, y) in [(0.0, 0.0), (0.3, 0.3), (-0.2, 0.1)] {
            let (p, found) = met_at(&ball, x, y).unwrap();
            let bent = (1.0 + 1.0 / (3.0 * p.length_squared())) / (2.0 * p.length());
            // Normals are given to 3e-6.
            let off = (found - if is_smooth { bent } else { 0.0 }).abs();
            assert!(off <= 1e-5, "{found} {bent}");
        }
    }
}

/// A bumpy sheet of two triangles with normals and coordinates of its own.
const SHEET: &str = "shape mesh {
    points = #[ -1 -1 0  1 -1 0.2  1 1 0  -1 1 0.1 ] m, indices = #[ 0 1 2  0 2 3 ]
    normals = #[ -0.3 -0.2 0.93  0.4 -0.1 0.91  0.2 0.3 0.93  -0.1 0.2 0.97 ]
    uvs = #[ 0.1 0  1 0.2  0.9 1.1  0 0.8 ]
";

#[test]
fn normals_of_meshes_turn_as_their_neighbours_say_in_any_place() {
    let places = [
        "",
        "transform = matrix([1.5, 0.5, -0.2, 1, 0.2, 1, 0.4, 2, -0.1, 0.3, 0.8, 3, 0, 0, 0, 1])",
        "transform = [scale((-1e-6, 2e-6, 1e-6)), move((1, 2, 3) m)]",
    ];
    let mut rng = Rng::new(3);
    for place in places {
        let stage = stage(&format!("{SHEET}{place} }}"));
        let stage = stage.opening();
        let placement = &stage.placements[0];
        let Geometry::Mesh(mesh) = &*stage.geometries[0] else { panic!("a mesh") };
        let swaps = placement.place.first().is_some_and(Transform::swaps_handedness);
        let turn = if swaps { -1.0 } else { 1.0 };
        for i in 0..100u32 {
            let at = DVec2::new(0.1 + 0.4 * rng.f64(), 0.1 + 0.4 * rng.f64());
            let surface = |at: DVec2| {
                let local = mesh.surface(i % 2, at, Precision::Exact, 0.0);
                placement.place.first().map_or(local, |transform| local.carried(transform))
            };
            let hit = SceneHit { placement: 0, hit: Hit { t: 1.0, at, face: i % 2 } };
            let ray = Ray::new(DVec3::ZERO, DVec3::X);
            let told = stage.normal_derivatives(&ray, &hit).unwrap();
            let step = DVec2::from_angle(6.0 * rng.f64()) * 1e-4;
            let (a, b) = (surface(at - step), surface(at + step));
            let moved = b.uv - a.uv;
            let off = b.ns - a.ns - told.dn_du * moved.x - told.dn_dv * (turn * moved.y);
            // Of third order in the step, and rounding, by the condition of the map.
            assert!(off.length() <= 1e-10, "{place}: {off}");
            assert!(told.dn_du.length() > 0.1, "it turns");
        }
    }
}

#[test]
fn a_picture_shows_what_bulges_in_red_and_what_is_hollow_in_blue() {
    let bulge = stage("shape sphere { radius = 2 m }");
    // The camera stands inside.
    let hollow = stage("shape sphere { radius = 16 m }");
    let middle = |stage: &Stage| {
        let (film, _) = render(stage, &Options::default(), &Control::default());
        film.pixel(glam::UVec2::splat(12)).mean
    };
    assert!((middle(&bulge) - DVec3::X * 0.25).length() <= 1e-6, "{}", middle(&bulge));
    assert!((middle(&hollow) - DVec3::Z / 32.0).length() <= 1e-6, "{}", middle(&hollow));
}
