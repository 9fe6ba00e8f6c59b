//! T6: faces that lie in each other.

use super::{PATHS, block, camera, picture};

#[test]
fn of_equal_faces_the_first_is_seen() {
    let looks = camera("(0.6, 4, 0.8) m", "(0, 0, 0) m", "(0, 0, 1)", "20 deg", 4);
    let lamp = |shape: &str, colour: &str| {
        format!(
            "light area {{ shape = {shape}, spectrum = {colour}, scale = 1, two_sided = true }}\n"
        )
    };
    let [red, green] = ["rgb.linear_srgb(1, 0, 0)", "rgb.linear_srgb(0, 1, 0)"];
    for shape in [
        "shape rectangle { u = (3, 0, 0.5) m, v = (-0.5, 0, 3) m }",
        "shape sphere { radius = 1 m }",
        "shape torus { radius = 1 m, tube = 50 cm }",
        &block(["1", "1", "1"], "material diffuse {}"),
    ] {
        for moves in
            ["", "group { transform = [rotate((1, 2, 3), 40 deg), move((0.1, 0.2, 0.3) m)]\n"]
        {
            // Others around them, so that rays go through several boxes.
            let rest = "for i in 0..40 { shape sphere { center = (i - 20, -5, 0) * 30 cm, radius = 10 cm } }\n";
            let both = format!("{}{}", lamp(shape, red), lamp(shape, green));
            let end = if moves.is_empty() { "" } else { "}" };
            let film = picture(&format!("{looks}{PATHS}{rest}{moves}{both}{end}"));
            let mean = film.mean().0;
            assert!(mean.x > 0.1 && mean.y <= 0.0, "{shape} {moves}: {mean}");
        }
    }
}
