//! What pictures hold beside colour.

use std::path::Path;

use glam::{DVec3, UVec2};
use luxel_core::files::MemoryFiles;
use luxel_core::film::{Film, Layer};
use luxel_core::render::{Control, Options, render, render_on};
use luxel_core::stage::Stage;

use crate::load::stage_of;

/// A ball before nothing, 4 m from the eye, that moves by a tenth of the picture's height.
const SCENE: &str = "scene 1
    param layers: bool = true
    camera orthographic { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 4 m }
    film auto { resolution = (33, 33), shutter = 1 s,
        albedo = layers, normal = layers, position = layers, depth = layers,
        material_id = layers, object_id = layers, motion = layers, cost = layers }
    sampler sobol { samples = 64, seed = 2 }
    light constant { scale = 1 }
    shape rectangle \"behind\" { center = (0, 0, 9) m, u = (1, 0, 0) m, v = (0, 1, 0) m }
    shape sphere \"ball\" { radius = 1 m, material = material diffuse { reflectance = rgb.linear_srgb(0.2, 0.5, 0.8) },
        transform = motion([(0 s, move((0, 0, 0) m)), (1 s, move((0, 0.4, 0) m))]) }";

fn stage(text: &str, set: &[(&str, &str)]) -> Stage {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let set: Vec<_> = set.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    stage_of(Path::new("a.scene"), &files, &set, None).unwrap_or_else(|said| panic!("{said:?}"))
}

fn film(stage: &Stage) -> Film {
    render(stage, &Options::default(), &Control::default()).0
}

/// The values of a channel, row by row.
fn values(film: &Film, name: &str) -> Vec<f64> {
    let mut channels = film.channels().into_iter();
    channels.find(|(channel, _)| channel.name == name).unwrap().1
}

/// The number of the pixel in the middle.
const MIDDLE: usize = 33 * 16 + 16;

#[test]
fn layers_tell_what_stands_where() {
    let film = film(&stage(SCENE, &[]));
    let middle = |name: &str| values(&film, name)[MIDDLE];
    let vector = |name: &str| DVec3::from(["X", "Y", "Z"].map(|x| middle(&format!("{name}.{x}"))));
    // The ball's middle goes up by 0.4 m, so its front lies on average where a ball at 0.2 m has it:
    // within the second order, 0.4²/12/2 m.
    assert!((vector("position") - DVec3::new(0.0, 0.0, 0.98)).abs().max_element() < 0.02);
    assert!((vector("normal") - DVec3::new(0.0, -0.2, 0.98)).abs().max_element() < 0.02);
    assert!((middle("depth.Z") - 4.02).abs() < 0.02);
    // 0.4 m of 4 m are 3.3 of 33 pixels; up is against the rows.
    assert!(middle("motion.X").abs() < 1e-9 && (middle("motion.Y") + 3.3).abs() < 1e-9);
    let numbers = ["material.ID", "object.ID", "coverage.A"].map(middle);
    // The first of each is that of the sheet behind.
    assert_eq!(numbers.map(f64::to_bits), [2.0, 2.0, 1.0].map(f64::to_bits));
    assert!(middle("cost.steps") >= 1.0);
    for (channel, values) in film.channels() {
        assert!(values[0].abs() <= 0.0 || channel.name == "cost.steps", "{}", channel.name);
    }
}

#[test]
fn albedo_is_what_the_material_says_in_rgb_and_by_wavelength() {
    let given = [0.2, 0.5, 0.8];
    for mode in ["rgb", "spectral"] {
        let film = film(&stage(&SCENE.replace("film auto", &format!("film {mode}")), &[]));
        for (channel, expected) in ["R", "G", "B"].into_iter().zip(given) {
            let all = values(&film, &format!("albedo.{channel}"));
            let coverage = values(&film, "coverage.A");
            // All pixels that see nothing but the ball tell the same.
            let whole: Vec<f64> =
                all.iter().zip(coverage).filter(|(_, a)| *a >= 1.0).map(|(v, _)| *v).collect();
            let mean = whole.iter().sum::<f64>() / whole.len() as f64;
            // 64 samples of each of some 170 pixels: by wavelength they differ by .3 from each other.
            let allowed = if mode == "rgb" { 1e-6 } else { 4.0 * 0.3 / (64.0 * 170.0_f64).sqrt() };
            assert!(
                (mean - expected).abs() <= allowed,
                "{mode} {channel}: {mean}, {}",
                whole.len()
            );
        }
    }
}

#[test]
fn layers_change_no_bit_of_the_picture() {
    let with = film(&stage(SCENE, &[]));
    let without = film(&stage(SCENE, &[("layers", "false")]));
    assert!(without.channels().is_empty() && without.layers.is_empty());
    assert_eq!(with.layers, Layer::ALL);
    assert!(with.pixels().zip(without.pixels()).all(|(a, b)| a == b));
}

#[test]
fn layers_are_gone_on_with_too() {
    let stage = stage(SCENE, &[]);
    let with = |spp| Options { spp: Some(spp), ..Options::default() };
    let mut film = render(&stage, &with(5), &Control::default()).0;
    let mut bytes = vec![];
    film.save(&mut bytes).unwrap();
    film = Film::load(&bytes).unwrap();
    render_on(&mut film, &stage, &with(12), &Control::default(), &mut |_, _| {});
    assert_eq!(film, render(&stage, &with(12), &Control::default()).0);
    assert_eq!(film.size, UVec2::splat(33));
}
