//! Single edits, and what each of them leaves as it was.

use std::sync::Arc;

use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::object::ColorMode;
use luxel_core::stage::{Anew, LightSource, Stage};

use super::draft::{SCENE, octahedron};
use super::made;
use crate::load::registry;

const CAMERA: &str = "camera perspective { look = look_at(from = (0, 1, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }\n";

/// Stages of one text after another, each beside the one before, with what was made and told.
fn stages(texts: &[&str]) -> Vec<(Stage, Anew, Vec<Diagnostic>)> {
    let registry = registry();
    let mut stages: Vec<(Stage, Anew, Vec<Diagnostic>)> = vec![];
    for text in texts {
        let files = MemoryFiles::default()
            .with("a.obj", octahedron(0).as_bytes())
            .with("flat.obj", octahedron(3).as_bytes())
            .with(SCENE, format!("scene 1\n{text}").as_bytes());
        let (built, told) = made(&registry, &files, stages.last().map(|it| &it.0));
        let (stage, anew) = built.unwrap_or_else(|| panic!("{text}: {told:?}"));
        stages.push((stage, anew, told));
    }
    stages
}

#[test]
fn the_first_spectral_material_and_the_last_leave_shapes_and_trees() {
    let scene = |paint: &str| {
        format!(
            "{CAMERA}film auto {{ resolution = (8, 8) }}\nlight constant {{ scale = 1 }}\n\
             shape mesh {{ file = \"a.obj\", unit = 1 m }}\n\
             shape difference {{ a = shape mesh {{ file = \"a.obj\", unit = 2 m }}, b = shape sphere {{ radius = 1 m }} }}\n\
             shape sphere {{ radius = 1 m, material = material {paint} }}\n"
        )
    };
    let [plain, gold] = ["diffuse {}", "conductor { eta = metal(\"Au\") }"].map(scene);
    let built = stages(&[&plain, &gold, &plain]);
    let modes: Vec<_> = built.iter().map(|(stage, ..)| stage.mode).collect();
    assert_eq!(modes, [ColorMode::Rgb, ColorMode::Spectral, ColorMode::Rgb]);
    assert_eq!((built[0].1.shapes, built[0].1.trees), (3, 2));
    for (stage, anew, _) in &built[1..] {
        assert_eq!((anew.shapes, anew.trees), (0, 0), "{anew:?}");
        let all = built[0].0.geometries.iter().zip(&*stage.geometries);
        assert!(all.into_iter().all(|(a, b)| Arc::ptr_eq(a, b)));
    }
}

#[test]
fn a_cutter_that_moves_leaves_the_tree_of_what_it_cuts() {
    let scene = |x: f64| {
        format!(
            "{CAMERA}light constant {{ scale = 1 }}\nshape difference {{ \
             a = shape mesh {{ file = \"a.obj\", unit = 1 m }}, \
             b = shape sphere {{ radius = 20 cm, transform = move(({x}, 0, 0) m) }} }}\n"
        )
    };
    let texts = [0.1, 0.1, 0.1, 0.1, 0.2, 0.3].map(scene);
    let built = stages(&texts.each_ref().map(String::as_str));
    let made = built.iter().map(|(_, anew, _)| (anew.shapes, anew.trees));
    // However long the solid has stood before the first of these edits.
    assert_eq!(made.collect::<Vec<_>>(), [(1, 1), (0, 0), (0, 0), (0, 0), (1, 0), (1, 0)]);
}

#[test]
fn what_is_looked_with_leaves_the_world_and_what_was_told_of_it() {
    let world = "light area { shape = shape mesh { file = \"flat.obj\", unit = 20 cm }, radiance = 9 W/m^2/sr }\n\
                 let many = group { shape mesh { file = \"flat.obj\", unit = 30 cm } }\n\
                 place many { transform = move((1, 0, 0) m) }\nplace many {}\n";
    let settings = [
        String::new(),
        "film rgb { resolution = (9, 9) }\nintegrator direct {}\n".to_owned(),
        "// moved\nfilter box {}\nsampler sobol { samples = 3 }\nfilm rgb {}\n".to_owned(),
    ];
    let texts = settings.map(|settings| {
        format!("film rgb {{}}\n{CAMERA}{world}").replacen("film rgb {}\n", &settings, 1)
    });
    let built = stages(&texts.each_ref().map(String::as_str));
    let cold = |text: &String| stages(&[text]).remove(0).2;
    for ((before, after), text) in built.iter().zip(&built[1..]).zip(&texts[1..]) {
        let ((before, ..), (after, anew, told)) = (before, after);
        assert!(Arc::ptr_eq(&before.placements, &after.placements));
        assert!(Arc::ptr_eq(&before.lights, &after.lights));
        assert!(Arc::ptr_eq(&before.top, &after.top));
        assert_eq!((anew.shapes, anew.trees), (0, 0));
        assert!(!told.is_empty() && *told == cold(text), "{told:?}");
    }
}

#[test]
fn a_lamp_that_stays_is_chosen_from_as_before() {
    let scene = |paint: f64, at: f64| {
        format!(
            "{CAMERA}light area {{ shape = shape mesh {{ file = \"a.obj\", unit = 20 cm }}, \
             radiance = 9 W/m^2/sr, transform = move(({at}, 3, 0) m) }}\n\
             shape sphere {{ radius = 1 m, material = material diffuse {{ reflectance = {paint} }} }}\n"
        )
    };
    let texts = [scene(0.5, 1.0), scene(0.6, 1.0), scene(0.6, 1.5)];
    let built = stages(&texts.each_ref().map(String::as_str));
    let facets = |stage: &Stage| {
        let LightSource::Surface { triangles, .. } = &stage.lights.sources[0] else { panic!() };
        triangles.clone().unwrap()
    };
    let [a, b, c] = [0, 1, 2].map(|i| facets(&built[i].0));
    assert!(Arc::ptr_eq(&a, &b) && !Arc::ptr_eq(&b, &c));
    assert!(!Arc::ptr_eq(&built[0].0.placements, &built[1].0.placements));
}
