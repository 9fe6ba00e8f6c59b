//! Pictures depend on the scene and the seed, and on nothing else; edits share what they keep.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use glam::{DVec3, UVec2};
use luxel_core::files::MemoryFiles;
use luxel_core::film::{Film, Rect};
use luxel_core::render::{Control, Options, Outcome, Reached, render, render_seen};
use luxel_core::stage::{Geometry, Stage};

use crate::load::stage_of;

/// Mesh, glass, metal, fog and three kinds of light.
const SCENE: &str = "scene 1
    param rho: float = 0.5
    param from: length = 4 m
    param corner: length = 2 m
    camera perspective { look = look_at(from = (0, 1, 1) * from, to = (0, 0.5, 0) m, up = (0, 1, 0)), fov = 40 deg }
    film spectral { resolution = (41, 23), shutter = 10 ms }
    sampler sobol { samples = 8, seed = 5 }
    medium homogeneous { sigma_t = 0.05 / (1 m), albedo = 0.9 }
    light constant { spectrum = illuminant(\"D65\"), radiance = 0.2 W/m^2/sr }
    light point { position = (1, 3, 1) m, spectrum = blackbody(3000 K), intensity = 8 W/sr }
    light area { shape = shape sphere { center = (-2, 2, 0) m, radius = 30 cm }, spectrum = blackbody(6000 K), radiance = 9 W/m^2/sr }
    shape sphere { center = (0.6, 0.5, 0) m, radius = 50 cm, material = material dielectric { ior = glass(\"N-BK7\") } }
    shape sphere { center = (-0.6, 0.5, 0) m, radius = 50 cm, material = material conductor { eta = metal(\"Cu\"), roughness = 0.2 } }
    shape box { size = (0.3, 0.3, 0.3) m, transform = [spin((0, 1, 0), 9 deg / (1 ms)), move((0, 0.8, 0.5) m)] }
    shape mesh \"floor\" {
        points = [(-2 m, 0 m, -2 m), (corner, 0 m, -2 m), (2 m, 0 m, 2 m), (-2 m, 0 m, 2 m)]
        indices = #[ 0 2 1  0 3 2 ], material = material diffuse { reflectance = rho }
    }";

fn stage(text: &str, set: &[(&str, &str)], before: Option<&Stage>) -> Stage {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let set: Vec<_> = set.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    stage_of(Path::new("a.scene"), &files, &set, before).unwrap_or_else(|said| panic!("{said:?}"))
}

fn picture(stage: &Stage, options: &Options) -> Film {
    render(stage, options, &Control::default()).0
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
fn the_picture_has_the_same_bits_for_any_number_of_threads() {
    let stage = stage(SCENE, &[], None);
    let with = |n| {
        let threads = Some(NonZeroUsize::new(n).unwrap());
        bits(&picture(&stage, &Options { threads, ..Options::default() }))
    };
    let one = with(1);
    assert!(one.iter().any(|(_, pixel)| f64::from_bits(pixel[0]) > 0.0), "the picture is black");
    for n in [2, 7] {
        assert_eq!(one, with(n), "{n} threads");
    }
}

#[test]
fn a_picture_that_is_looked_at_has_the_bits_of_one_that_is_not() {
    let stage = stage(SCENE, &[], None);
    let whole = picture(&stage, &Options::default());
    let options = Options { coarse: true, ..Options::default() };
    let mut seen = vec![];
    let mut look = |film: &Film, now: Reached| {
        if !now.is_whole {
            return;
        }
        // What is there is what the finished picture began with, and what is told is there.
        for (at, pixel) in film.pixels() {
            let on = (at % now.step).cmpeq(UVec2::ZERO).all();
            assert_eq!(pixel.n + pixel.bad, if on { now.samples } else { 0 }, "{at} {now:?}");
        }
        seen.push((now.step, now.samples));
    };
    let (film, outcome) = render_seen(&stage, &options, &Control::default(), &mut look);
    assert_eq!(outcome, Outcome::Complete);
    assert_eq!(bits(&film), bits(&whole));
    assert_eq!(seen[..5], [(8, 1), (4, 1), (2, 1), (1, 1), (1, 2)]);
    assert_eq!(seen.last().map(|seen| seen.1), Some(options.samples(&stage)));
}

#[test]
fn a_picture_that_is_superseded_shows_its_first_step_and_one_that_is_cancelled_nothing() {
    let stage = stage(SCENE, &[], None);
    let options = Options { coarse: true, ..Options::default() };
    let steps = |control: &Control| {
        let mut steps = vec![];
        let look = &mut |_: &Film, now: Reached| steps.push(now.step);
        let (film, outcome) = render_seen(&stage, &options, control, look);
        assert_eq!(outcome, Outcome::Cancelled);
        let n = film.pixels().filter(|(_, pixel)| pixel.n > 0).count();
        (steps, n, film.pixels().count())
    };
    let control = Control::default();
    control.supersede();
    let (seen, n, all) = steps(&control);
    assert_eq!(seen, [8]);
    // Of 41 × 23 pixels, every eighth of every eighth row.
    assert_eq!((n, all), (6 * 3, 41 * 23));
    control.cancel();
    assert_eq!(steps(&control), (vec![], 0, all));
}

#[test]
fn a_picture_that_is_held_now_and_then_has_the_bits_of_one_that_is_not() {
    // Wider than what is measured together of a coarse step.
    let stage = stage(&SCENE.replace("(41, 23)", "(290, 9)"), &[], None);
    let whole = picture(&stage, &Options::default());
    let options = Options { coarse: true, ..Options::default() };
    let control = Control::default();
    control.hold();
    std::thread::scope(|scope| {
        let rendering = scope.spawn(|| render_seen(&stage, &options, &control, &mut |_, _| {}));
        for _ in 0..5 {
            std::thread::sleep(Duration::from_millis(10));
            control.hold();
        }
        control.release();
        let (film, outcome) = rendering.join().unwrap();
        assert_eq!(outcome, Outcome::Complete);
        assert_eq!(bits(&film), bits(&whole));
    });
}

#[test]
fn a_part_of_the_picture_has_the_bits_of_the_whole() {
    let stage = stage(SCENE, &[], None);
    let whole = picture(&stage, &Options::default());
    let crop = Some(Rect::new(UVec2::new(13, 5), UVec2::new(21, 17)));
    let part = picture(&stage, &Options { crop, ..Options::default() });
    assert_eq!(part.pixels().count(), 21 * 17);
    for (at, pixel) in part.pixels() {
        assert_eq!(pixel, whole.pixel(at), "{at}");
    }
}

#[test]
fn seeds_differ_and_repeat() {
    let stage = stage(SCENE, &[], None);
    let with = |seed| bits(&picture(&stage, &Options { seed: Some(seed), ..Options::default() }));
    assert_eq!(with(5), bits(&picture(&stage, &Options::default())), "the scene's own seed is 5");
    let (a, b) = (with(1), with(2));
    let same = a.iter().zip(&b).filter(|(a, b)| a == b).count();
    assert!(same < a.len() / 100, "{same} of {} pixels are the same for two seeds", a.len());
}

#[test]
fn fog_without_matter_changes_nothing_whatever_bounds_it() {
    let scene = |fog: &str| {
        format!(
            "scene 1
            camera perspective {{ look = look_at(from = (0, 1, 4) m, to = (0, 0.5, 0) m, up = (0, 1, 0)), fov = 40 deg }}
            film rgb {{ resolution = (24, 16) }}
            sampler sobol {{ samples = 144 }}
            light constant {{ spectrum = rgb.linear_srgb(1, 1, 1), scale = 0.2 }}
            light point {{ position = (1, 3, 1) m, spectrum = rgb.linear_srgb(1, 1, 1), intensity = 8 W/sr }}
            shape sphere {{ center = (0, 0.5, 0) m, radius = 50 cm }}
            shape rectangle {{ u = (0, 0, 9) m, v = (9, 0, 0) m }}
            let thin = medium homogeneous {{ sigma_t = 1e-30 / (1 m) }}
            {fog}"
        )
    };
    let clear = picture(&stage(&scene(""), &[], None), &Options::default());
    let bounds = [
        "shape sphere { center = (0, 0.6, 0.1) m, radius = 1.3 m, interior = thin }",
        "shape box { center = (0, 0.9, 0.1) m, size = (2, 1.7, 2) m, interior = thin }",
        "shape cylinder { base = (0, 0.05, 0) m, radius = 1.2 m, height = 2 m, caps = true, interior = thin }",
        "shape mesh { interior = thin
            points  = #[ 0 -2 0   2 0.5 0   0 0.5 -2   -2 0.5 0   0 0.5 2   0 3 0 ] m
            indices = #[ 0 1 4  0 2 1  0 3 2  0 4 3   5 4 1  5 1 2  5 2 3  5 3 4 ] }",
    ];
    for fog in bounds {
        let foggy = picture(&stage(&scene(fog), &[], None), &Options::default());
        assert_eq!(foggy.bad_samples(), 0);
        let ((a, se_a), (b, se_b)) = (clear.mean(), foggy.mean());
        let allowed = 4.0 * (se_a * se_a + se_b * se_b).y.sqrt();
        assert!((a.y - b.y).abs() <= allowed, "{fog}: {} is not {} ± {allowed}", b.y, a.y);
        // The standard error resolves 2 %.
        assert!(allowed < 0.02 * a.y, "{allowed}");
    }
}

fn meshes(stage: &Stage) -> Vec<Arc<Geometry>> {
    let is_mesh = |geometry: &&Arc<Geometry>| matches!(***geometry, Geometry::Mesh(_));
    stage.geometries.iter().filter(is_mesh).cloned().collect()
}

#[test]
fn an_edit_keeps_the_geometry_that_it_does_not_touch() {
    let first = stage(SCENE, &[], None);
    let kept = meshes(&first);
    assert_eq!(kept.len(), 1);
    for edit in [("rho", "0.7"), ("from", "5 m")] {
        let second = stage(SCENE, &[edit], Some(&first));
        assert!(Arc::ptr_eq(&kept[0], &meshes(&second)[0]), "{edit:?} made the mesh anew");
        // What is shared must not be stale.
        let fresh = stage(SCENE, &[edit], None);
        let options = Options { spp: Some(1), ..Options::default() };
        assert_eq!(bits(&picture(&second, &options)), bits(&picture(&fresh, &options)));
    }
    let third = stage(SCENE, &[("corner", "3 m")], Some(&first));
    assert!(!Arc::ptr_eq(&kept[0], &meshes(&third)[0]), "a changed mesh was kept");
}

#[test]
fn going_back_to_a_scene_of_a_moment_ago_makes_no_geometry_anew() {
    let first = stage(SCENE, &[], None);
    let second = stage(SCENE, &[("corner", "3 m")], Some(&first));
    let third = stage(SCENE, &[("corner", "3.5 m")], Some(&second));
    for (before, n) in [(&second, 1), (&third, 2)] {
        let back = stage(SCENE, &[], Some(before));
        assert!(Arc::ptr_eq(&meshes(&first)[0], &meshes(&back)[0]), "forgotten after {n} edits");
    }
    let fourth = stage(SCENE, &[("corner", "4 m")], Some(&third));
    let late = stage(SCENE, &[], Some(&fourth));
    assert!(!Arc::ptr_eq(&meshes(&first)[0], &meshes(&late)[0]), "kept for ever");
}

#[test]
fn equal_shapes_share_their_geometry_whatever_they_are_made_of() {
    let mesh = "points = #[ 0 0 0  1 0 0  0 1 0 ] m, indices = #[ 0 1 2 ]";
    let text = format!(
        "scene 1
        camera perspective {{ look = look_at(from = (0, 0, 1) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }}
        shape mesh {{ {mesh}, material = material diffuse {{ reflectance = 0.1 }} }}
        shape mesh {{ {mesh}, material = material diffuse {{ reflectance = 0.9 }} }}"
    );
    let stage = stage(&text, &[], None);
    let found = meshes(&stage);
    assert_eq!((found.len(), stage.placements.len(), stage.materials.len()), (2, 2, 2));
    assert!(Arc::ptr_eq(&found[0], &found[1]), "two trees over the same triangles");
}

#[test]
fn samples_that_are_asked_for_are_taken() {
    let stage = stage(SCENE, &[], None);
    for spp in [1, 3, 17] {
        let film = picture(&stage, &Options { spp: Some(spp), ..Options::default() });
        assert!(film.pixels().all(|(_, pixel)| pixel.n + pixel.bad == spp));
        assert!(film.mean().0.cmpgt(DVec3::ZERO).all());
    }
}
