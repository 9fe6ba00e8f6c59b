//! T1, T2: a scene of everything looks alike wherever it stands and however large it is.

use luxel_core::film::Film;

use super::picture;

/// A lamp, glass, rough metal, a smooth mesh and a box on a floor, whose lengths are given in `m` and that
/// stand about `off`.
fn scene(away: &str, size: &str) -> String {
    format!(
        "let unit = {size}
        let off = ({away}, -{away}, 0.5 * {away})
        camera perspective {{ look = look_at(from = off + (3, 2, 4) * unit, to = off + (0, 0.5, 0) * unit, up = (0, 1, 0)), fov = 40 deg }}
        film rgb {{ resolution = (32, 32) }}
        sampler sobol {{ samples = 64 }}
        integrator path {{}}
        group {{
            transform = move(off)
            let grey = material diffuse {{ reflectance = 0.5 }}
            light area {{ shape = shape sphere {{ center = (1, 3, 1) * unit, radius = 0.5 * unit }}, spectrum = white, scale = 20 }}
            shape rectangle {{ u = (0, 0, 8) * unit, v = (8, 0, 0) * unit, material = grey }}
            shape box {{ center = (-1, 0.4, 0) * unit, size = (0.8, 0.8, 0.8) * unit, material = grey }}
            shape sphere {{ center = (0.5, 0.5, 0.5) * unit, radius = 0.5 * unit, material = material dielectric {{ ior = 1.5 }} }}
            shape torus {{
                center = (0.2, 0.3, -1) * unit, axis = (0.2, 1, 0), radius = 0.6 * unit, tube = 0.2 * unit
                material = material conductor {{ eta = metal(\"Ag\"), roughness = 0.2 }}
            }}
            shape mesh {{
                points = #[ 1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ] m
                indices = #[ 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5 ]
                subdivide = 3, scheme = \"loop\", material = grey
                transform = [scale(0.5 * unit / (1 m)), move((1.3, 0.5, -0.6) * unit)]
            }}
        }}"
    )
}

/// The largest difference of a channel of a pixel, in standard errors; and that of the means.
fn apart(a: &Film, b: &Film) -> [f64; 2] {
    let of_pixels = a.pixels().zip(b.pixels()).flat_map(|((_, a), (_, b))| {
        let error = (a.standard_error().powf(2.0) + b.standard_error().powf(2.0)).map(f64::sqrt);
        let off = (a.mean - b.mean).abs();
        [0, 1, 2].map(|c| if off[c] > 0.0 { off[c] / error[c] } else { 0.0 })
    });
    let ((a, of_a), (b, of_b)) = (a.mean(), b.mean());
    [of_pixels.fold(0.0, f64::max), (a.y - b.y).abs() / of_a.y.hypot(of_b.y)]
}

#[test]
fn a_scene_looks_alike_at_every_place_and_size() {
    let at_home = picture(&scene("0 m", "1 m"));
    assert!(at_home.mean().0.y > 0.1);
    for (away, size) in [
        ("1e3 m", "1 m"),
        ("1e6 m", "1 m"),
        ("1e8 m", "1 m"),
        ("0 m", "1e-9 m"),
        ("0 m", "1e-4 m"),
        ("0 m", "1e9 m"),
        ("1 m", "1e-6 m"),
    ] {
        // Of 3072 channels of pixels one is beyond 5.7 errors by chance with 5e-5 (Student's t of 15
        // degrees of freedom: beyond 7.5), and a mean beyond 4 with 6e-5.
        let [pixels, mean] = apart(&at_home, &picture(&scene(away, size)));
        assert!(pixels < 7.5 && mean < 4.0, "{away}, {size}: {pixels}, {mean}");
    }
}
