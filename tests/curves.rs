//! Curves in whole scenes: strands under the tree of their shape, and glass fibres that lose nothing.

use std::fmt::Write as _;
use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::film::Film;
use luxel_core::render::{Control, Options, render};

use crate::load::stage_of;

fn picture(body: &str) -> Film {
    let text = format!("scene 1\n{body}");
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let stage = stage_of(Path::new("a.scene"), &files, &[], None);
    render(
        &stage.unwrap_or_else(|said| panic!("{said:?}")),
        &Options::default(),
        &Control::default(),
    )
    .0
}

/// What strands are seen in.
const WORLD: &str = "camera perspective { look = look_at(from = (0, 0.7, 3) m, to = (0, 0.4, 0) m, up = (0, 1, 0)), fov = 35 deg }
        film rgb { resolution = (48, 32) }
        sampler sobol { samples = 4 }
        light point { position = (1, 3, 1) m, intensity = 8 W/sr }
        light constant { radiance = 0.3 W/m^2/sr }
        shape disk \"floor\" { radius = 9 m }\n";

/// Sixty strands that stand about.
fn strands(form: &str, one_by_one: bool) -> String {
    let mut scene = WORLD.to_owned();
    let given = format!("radius = 2 cm, form = \"{form}\", transform = move((0, 0.01, 0) m)");
    let mut all = String::new();
    for i in 0..60 {
        let a = f64::from(i) * 2.4;
        let (x, z) = (a.cos() * 0.1 * a.sqrt(), a.sin() * 0.1 * a.sqrt());
        let points = format!(
            "{x} 0 {z}  {x} 0.3 {z}  {} 0.6 {}  {} 0.7 {} ",
            x * 1.2,
            z * 1.2,
            x * 1.6,
            z * 1.6
        );
        if one_by_one {
            writeln!(scene, "shape curves {{ points = #[{points}] m, {given} }}").unwrap();
        }
        all += &points;
    }
    if !one_by_one {
        writeln!(scene, "shape curves {{ points = #[{all}] m, strands = #[4], {given} }}").unwrap();
    }
    scene
}

#[test]
fn strands_of_one_shape_look_like_shapes_of_one_strand() {
    for form in ["round", "ribbon"] {
        let bits = |film: &Film| -> Vec<[u64; 3]> {
            film.pixels().map(|(_, pixel)| pixel.mean.to_array().map(f64::to_bits)).collect()
        };
        let (one, many) = (picture(&strands(form, false)), picture(&strands(form, true)));
        assert_eq!(bits(&one), bits(&many), "{form}");
        let bare = bits(&picture(WORLD));
        let n = bits(&one).iter().zip(&bare).filter(|(a, b)| a != b).count();
        assert!(n > 100, "{form}: {n} pixels show strands");
    }
}

/// Glass that absorbs nothing, before a world of the same radiance everywhere, cannot be seen: each
/// path through it ends with that radiance, unless it is caught inside or lost.
#[test]
fn a_glass_fibre_in_even_light_is_unseen_at_every_scale_and_distance() {
    for (scale, far) in [("1 m", "0 m"), ("1 um", "0 m"), ("1000 km", "0 m"), ("1 m", "1000 km")] {
        let world = format!(
            "let size = {scale}
            let far = [{far}, -{far}, {far}]
            fn at(x: float, y: float, z: float) = (x * size + far[0], y * size + far[1], z * size + far[2])
            camera perspective {{ look = look_at(from = at(0.3, 0.4, 6), to = at(0, 0.2, 0), up = (0, 1, 0)), fov = 40 deg }}
            film rgb {{ resolution = (24, 16) }}
            filter box {{}}
            integrator path {{ max_depth = 10000 }}
            sampler sobol {{ samples = 16 }}
            light constant {{ radiance = 1 W/m^2/sr }}\n"
        );
        let fibre = "
            let bow = [-2, -0.5, 0.3, -0.9, 1, -0.6, 1.1, 0.9, 0.8, 2.1, -0.7, -0.2]
            shape curves {
                points   = [for i in 0..12 => bow[i] * size + far[i % 3]]
                radii    = [0.3 * size, 0.5 * size, 0.2 * size, 0.1 * size]
                material = material dielectric { ior = 1.5 }
            }";
        let truth = picture(&world).pixels().next().expect("it has pixels").1.mean;
        let film = picture(&(world + fibre));
        assert_eq!(film.bad_samples(), 0);
        for (at, pixel) in film.pixels() {
            // In single precision each way in and out rounds what passes by a few parts in 10⁷.
            let off = (pixel.mean / truth - 1.0).abs().max_element();
            assert!(off < 1e-5, "{scale} {far} {at}: {off}");
        }
    }
}

#[test]
fn a_light_on_strands_is_refused_where_it_stands() {
    let lamp = "light area { shape = shape curves { points = #[ 0 0 0  0 1 0  0 2 0  0 3 0 ] m, radius = 1 cm }, radiance = 1 W/m^2/sr }";
    let text = format!(
        "scene 1\ncamera perspective {{ look = look_at(from = (0, 0, 9) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 35 deg }}\n{lamp}"
    );
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let said = stage_of(Path::new("a.scene"), &files, &[], None).unwrap_err();
    let found = said.iter().find(|d| d.code == "E0423").unwrap();
    assert_eq!(found.message, "a light on `curves`: points of it cannot be chosen at random");
    assert!(found.help.iter().any(|help| help.contains("capsule")), "{found:?}");
}
