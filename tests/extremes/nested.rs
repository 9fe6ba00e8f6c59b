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
fn balls_that_overlap_bend_light_as_the_solid_that_they_make() {
    let ball =
        |at: &str, rest: &str| format!("shape sphere {{ center = {at}, radius = 1 m, {rest} }}\n");
    let (left, right) = ("(-0.4, 0, 0) m", "(0.4, 0, 0) m");
    let view = |from: &str, balls: &str| {
        let body = camera(from, "(0, 0, 0) m", "(0, 1, 0)", "40 deg", 256)
            + "light directional {
                direction = (0.3, -1, 0), angular_size = 160 deg, spectrum = white, scale = pi
            }
            let crown = material dielectric { ior = 1.5 }\n"
            + balls;
        let (mean, error) = picture(&body).mean();
        (mean.y, error.y)
    };
    for from in ["(0, 0, 6) m", "(0, 0, -6) m"] {
        let (a, b) = (ball(left, "").replace("shape", "a = shape"), ball(right, ""));
        let whole = format!("shape union {{ {a} b = {b} material = crown }}");
        let (whole, error) = view(from, &whole);
        assert!(error <= 0.02 * whole, "{from}: {whole} ± {error}");
        for [first, second] in [["", "priority = 1"], ["priority = 1", ""], ["", ""]] {
            let material = |rest: &str| format!("material = crown, {rest}");
            let balls = ball(left, &material(first)) + &ball(right, &material(second));
            let (found, its) = view(from, &balls);
            let noise = 4.0 * error.hypot(its);
            assert!((found - whole).abs() <= noise, "{from} {first}: {found} ± {its}, not {whole}");
        }
    }
}
