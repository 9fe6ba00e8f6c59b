//! T7: glass, water and air within each other.

use super::{PATHS, camera, check, picture};

/// A camera that looks down through blocks at a half of the world that shines.
fn through(blocks: &str) -> String {
    camera("(0, 5, 0) m", "(0, 0, 0) m", "(0, 0, 1)", "0.001 deg", 2048)
        + PATHS
        + "light directional {
            direction = (0, 1, 0), angular_size = 180 deg, spectrum = white, scale = pi
        }
        let crown = material dielectric { ior = 1.5 }
        let water = material dielectric { ior = 1.33 }\n"
        + blocks
}

/// What faces between media of these indices let through, one behind the other, reflections among
/// them counted: (1 − T)/T of incoherent faces add up.
fn passed(indices: &[f64]) -> f64 {
    let lost = indices.windows(2).map(|pair| {
        let r = ((pair[0] - pair[1]) / (pair[0] + pair[1])).powi(2);
        r / (1.0 - r)
    });
    1.0 / (1.0 + lost.sum::<f64>())
}

#[test]
fn water_in_glass_lets_through_what_its_faces_let_through() {
    let slab = |at: &str, thick: &str, rest: &str| {
        format!("shape box {{ center = (0, {at}, 0) m, size = (18, {thick}, 18) m, {rest} }}\n")
    };
    let nested = [1.0, 1.5, 1.33, 1.5, 1.0];
    // One in the other, whichever is written first.
    let (outer, inner) = (slab("0", "2", "material = crown"), slab("0", "1", "material = water"));
    check(&through(&(outer.clone() + &inner)), passed(&nested), 1e-3);
    check(&through(&(inner.clone() + &outer)), passed(&nested), 1e-3);
    // What lies within counts, unless the outer one is to.
    let solid = outer.replace("crown", "crown, priority = 1");
    check(&through(&(solid + &inner)), passed(&[1.0, 1.5, 1.0]), 1e-3);
    // Two plates, and water that reaches into them: far, hardly, or to the very face.
    let plates = slab("-0.75", "0.5", "material = crown, priority = 1")
        + &slab("0.75", "0.5", "material = crown, priority = 1");
    for thick in ["1.5", "1.000002", "1"] {
        let between = slab("0", thick, "material = water");
        check(&through(&(between + &plates)), passed(&nested), 1e-3);
    }
    // A film of air is there to be seen, however thin.
    let apart = slab("0", "0.999998", "material = water");
    let films = [1.0, 1.5, 1.0, 1.33, 1.0, 1.5, 1.0];
    check(&through(&(apart + &plates)), passed(&films), 1e-3);
    // What has the index of what it lies in is not there.
    let same = inner.replace("water", "crown");
    check(&through(&(outer + &same)), passed(&[1.0, 1.5, 1.0]), 1e-3);
}

#[test]
fn nested_balls_bend_light_alike_from_either_side() {
    // A ball in another of its own index, partly outside: the picture of what they hold together.
    let ball = |at: &str, rest: &str| {
        format!("shape sphere {{ center = {at}, radius = 1 m, material = crown, {rest} }}\n")
    };
    let view = |from: &str, balls: &str| {
        camera(from, "(0, 0, 0) m", "(0, 1, 0)", "40 deg", 64)
            + "light directional {
                direction = (1, -1, 0.3), angular_size = 120 deg, spectrum = white, scale = pi
            }
            let crown = material dielectric { ior = 1.5 }\n"
            + balls
    };
    for from in ["(0, 0, 6) m", "(0, 0, -6) m"] {
        let [a, b] = [["", "priority = 1"], ["priority = 1", ""]].map(|[first, second]| {
            let balls = ball("(-0.4, 0, 0) m", first) + &ball("(0.4, 0, 0) m", second);
            picture(&view(from, &balls)).mean()
        });
        // Which counts does not matter where both are alike.
        let noise = (a.1 * a.1 + b.1 * b.1).map(f64::sqrt).y;
        assert!((a.0.y - b.0.y).abs() <= 4.0 * noise, "{from}: {a:?} {b:?}");
    }
}
