//! Quadratic equations, and the ray against the sphere, without cancellation.

use glam::DVec3;

/// Real roots of `a` t² + `b` t + `c` = 0, the lower first; `None` if there are none.
///
/// With `a` = 0 the one root of the line is returned twice. NaN, infinite or overflowing
/// (beyond about 1e150) coefficients give `None`.
///
/// # Source
/// PBR4 §B.2.10 for the roots. The discriminant is Kahan's: both products carry their rounding
/// error, found with a fused multiply-add whether or not the machine has one.
pub fn quadratic_roots(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    if a == 0.0 {
        let t = -c / b;
        return t.is_finite().then_some((t, t));
    }
    let ac4 = 4.0 * a * c;
    let lost = (-4.0 * a).mul_add(c, ac4);
    let discriminant = b.mul_add(b, -ac4) + lost;
    if !(discriminant >= 0.0 && discriminant.is_finite()) {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    // q = 0 only if b and c are both 0: a double root at the origin.
    let (t0, t1) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    ordered(t0, t1)
}

/// Parameters at which the line `o` + t `d` meets the sphere of radius `r` about the origin.
///
/// `d` has any length whose square is a normal number (1e-150 to 1e150); the lower root comes
/// first and both may be negative. `None` if the line misses, `d` is zero, or anything is NaN or
/// infinite. Accurate far away and close to the surface: |Δt|/r below 1e-9 for |o|/r up to 1e5.
///
/// # Source
/// Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems
/// ch. 7; both the discriminant and c are products of a difference and a sum.
pub fn sphere_roots(o: DVec3, d: DVec3, r: f64) -> Option<(f64, f64)> {
    let a = d.length_squared();
    let half_b = -o.dot(d);
    // The vector from the centre to the line: an error of its foot runs along d, across it.
    let closest = (o + d * (half_b / a)).length();
    let discriminant = a * ((r - closest) * (r + closest));
    if !(discriminant >= 0.0 && discriminant.is_finite()) {
        return None;
    }
    let distance = o.length();
    let c = (distance - r) * (distance + r);
    let q = half_b + discriminant.sqrt().copysign(half_b);
    let (t0, t1) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    ordered(t0, t1)
}

fn ordered(t0: f64, t1: f64) -> Option<(f64, f64)> {
    let finite = t0.is_finite() && t1.is_finite();
    finite.then_some(if t0 <= t1 { (t0, t1) } else { (t1, t0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(found: Option<(f64, f64)>, expected: (f64, f64), relative: f64) {
        let (t0, t1) = found.unwrap();
        assert!((t0 - expected.0).abs() <= relative * expected.0.abs(), "{t0} {}", expected.0);
        assert!((t1 - expected.1).abs() <= relative * expected.1.abs(), "{t1} {}", expected.1);
    }

    #[test]
    fn sphere_roots_are_right_far_away_and_close_up() {
        // Truths to the last digit of their literals, for the rounded inputs as given.
        let d = DVec3::new(1.0, 1e-4, 0.0).normalize();
        let truth = (9999.999850000002, 10000.000049999999);
        check(sphere_roots(DVec3::new(-1e4, 0.0, 0.0), d, 1.0), truth, 1e-11);
        let o = DVec3::new(0.0, 1e7 + 1e-3, 0.0);
        let truth = (0.0010000001639127731, 20000000.001000002);
        check(sphere_roots(o, -DVec3::Y, 1e7), truth, 1e-14);
        let o = DVec3::new(0.0, 0.0, -1e8);
        check(sphere_roots(o, DVec3::Z, 1e8 - 1.0), (1.0, 199999999.0), 1e-14);
        // A chord at depth δ = 2⁻¹⁰ below the surface: half of it is √(δ(2r − δ)).
        let (r, depth) = (1e8f64, 0.0009765625);
        let half = (depth * (2.0 * r - depth)).sqrt();
        let o = DVec3::new(0.0, r - depth, 0.0);
        check(sphere_roots(o, DVec3::X, r), (-half, half), 4.0 * f64::EPSILON);
    }

    #[test]
    fn sphere_roots_scale_with_the_length_of_the_direction() {
        let (o, d) = (DVec3::new(-3.0, 0.25, 0.0), DVec3::X);
        let (t0, t1) = sphere_roots(o, d, 1.0).unwrap();
        for length in [1e-140, 1e-9, 1e9, 1e140] {
            let expected = (t0 / length, t1 / length);
            check(sphere_roots(o, d * length, 1.0), expected, 16.0 * f64::EPSILON);
        }
    }

    #[test]
    fn sphere_roots_from_the_surface_hold_the_origin() {
        check(sphere_roots(DVec3::X, -DVec3::X, 1.0), (0.0, 2.0), 0.0);
        check(sphere_roots(DVec3::X, DVec3::X, 1.0), (-2.0, 0.0), 0.0);
        check(sphere_roots(DVec3::X, DVec3::Y, 1.0), (0.0, 0.0), 0.0);
    }

    #[test]
    fn sphere_roots_refuse_misses_and_non_finite_input() {
        let o = DVec3::new(-3.0, 1.0 + 1e-15, 0.0);
        assert!(sphere_roots(o, DVec3::X, 1.0).is_none());
        assert!(sphere_roots(o, DVec3::ZERO, 1.0).is_none());
        assert!(sphere_roots(o, DVec3::NAN, 1.0).is_none());
        assert!(sphere_roots(o, DVec3::splat(f64::INFINITY), 1.0).is_none());
        assert!(sphere_roots(DVec3::NAN, DVec3::X, 1.0).is_none());
        assert!(sphere_roots(o, DVec3::X, f64::NAN).is_none());
        assert!(sphere_roots(o, DVec3::X, f64::INFINITY).is_none());
    }

    #[test]
    fn quadratic_roots_survive_cancellation() {
        // b² dwarfs 4ac: the small root is c/b to first order.
        check(quadratic_roots(1.0, -1e8, 1.0), (1e-8, 1e8), 1e-15);
        // b² almost equals 4ac: (94906267 t − 94906265)(94906266 t − 94906266), after Kahan.
        let (p, q, r, s) = (94906267.0, 94906265.0, 94906266.0, 94906266.0);
        let found = quadratic_roots(p * r, -(p * s + q * r), q * s);
        // Coefficients round at 2⁻⁵³, and a double root moves by the root of that.
        check(found, (q / p, s / r), 2.0 * f64::EPSILON.sqrt());
        // b² and 4ac need 55 bits and differ by 16: roots 1 and (n + 2) / (n − 2).
        let n = 134217729.0;
        let truth = (1.0, (n + 2.0) / (n - 2.0));
        check(quadratic_roots(n - 2.0, -2.0 * n, n + 2.0), truth, 2.0 * f64::EPSILON);
        check(quadratic_roots(1.0, -2.0, 1.0), (1.0, 1.0), 0.0);
        check(quadratic_roots(0.0, 2.0, -4.0), (2.0, 2.0), 0.0);
        check(quadratic_roots(3.0, 0.0, 0.0), (0.0, 0.0), 0.0);
    }

    #[test]
    fn quadratic_roots_refuse_what_has_none() {
        assert!(quadratic_roots(1.0, 0.0, 1.0).is_none());
        assert!(quadratic_roots(0.0, 0.0, 1.0).is_none());
        assert!(quadratic_roots(f64::NAN, 1.0, 1.0).is_none());
        assert!(quadratic_roots(1.0, f64::INFINITY, 1.0).is_none());
        assert!(quadratic_roots(1.0, 1e200, 1.0).is_none());
    }
}
