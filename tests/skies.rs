//! Light from everywhere: met by what scatters, looked for in media alone.

use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::film::Film;
use luxel_core::render::{Control, Options, render};
use luxel_core::scene::Feature;
use luxel_core::stage::Stage;

use crate::load::stage_of;

const FLOOR: &str = "shape rectangle {
    u = (0, 0, 20) m, v = (20, 0, 0) m, material = material diffuse { reflectance = 0.5 }
}\n";
const SKY: &str = "light constant { spectrum = white, scale = 1 }\n";
const LAMP: &str = "light area {
    shape = shape rectangle { center = (0, 1, 0) m, u = (0.4, 0, 0) m, v = (0, 0, 0.4) m }
    spectrum = white, scale = 5
}\n";
const FOG: &str = "medium homogeneous { sigma_t = 0.02 m^-1, albedo = 0.8 }\n";
const BLIND: &str = "integrator path { max_depth = 4, light_sampling = false }\n";
const SEEING: &str = "integrator path { max_depth = 4 }\n";

fn stage(parts: &[&str], samples: u32) -> Stage {
    let text = format!(
        "scene 1
        let white = rgb.linear_srgb(1, 1, 1)
        camera perspective {{
            look = look_at(from = (0, 2, 2) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg
        }}
        film rgb {{ resolution = (8, 8) }}
        filter box {{}}
        sampler sobol {{ samples = {samples} }}
        {}",
        parts.concat()
    );
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    stage_of(Path::new("a.scene"), &files, &[], None).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

fn film(parts: &[&str], samples: u32) -> Film {
    let (film, _) = render(&stage(parts, samples), &Options::default(), &Control::default());
    assert_eq!(film.bad_samples(), 0);
    film
}

#[test]
fn a_floor_under_an_even_sky_has_no_noise() {
    // Every direction that the floor scatters to shows the same sky: each sample is the albedo.
    for (_, pixel) in film(&[FLOOR, SKY, SEEING], 16).pixels() {
        let (mean, deviation) = (pixel.mean, pixel.variance().max_element().sqrt());
        // The throughput, the sky and the way to linear sRGB round once each for each of its sums and products.
        let rounding = 8.0 * f64::from(f32::EPSILON);
        assert!((mean - 0.5).abs().max_element() <= rounding, "{mean}");
        assert!(deviation <= rounding, "{deviation}");
    }
}

#[test]
fn looking_for_the_other_lights_alone_gives_the_same_picture() {
    for parts in [&[FLOOR, LAMP, SKY][..], &[FLOOR, SKY, LAMP], &[FLOOR, SKY, LAMP, FOG]] {
        let with = |integrator, samples| film(&[parts, &[integrator]].concat(), samples).mean();
        let ((a, da), (b, db)) = (with(SEEING, 1024), with(BLIND, 8192));
        let noise = da.y.hypot(db.y);
        // By chance once in 16,000 pictures; a light that counts twice or not at all is tens of them off.
        assert!((a.y - b.y).abs() <= 4.0 * noise, "{parts:?}: {a} {b}");
        assert!(noise <= 0.005 * b.y, "{parts:?}: {noise} is too noisy to tell");
    }
}

#[test]
fn an_even_sky_is_a_choice_in_media_alone() {
    let is_choice = |parts: &[&str]| stage(parts, 1).needs(Feature::LightChoice);
    assert!(!is_choice(&[FLOOR, SKY, LAMP, SEEING]));
    assert!(!is_choice(&[FLOOR, SKY, SKY, SEEING]));
    assert!(is_choice(&[FLOOR, SKY, LAMP, FOG, SEEING]));
    assert!(is_choice(&[FLOOR, SKY, LAMP, LAMP, SEEING]));
}
