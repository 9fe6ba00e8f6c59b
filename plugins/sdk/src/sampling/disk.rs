//! Warps onto the disk, the triangle and the half line.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4};

use glam::{BVec2, Vec2};

/// Density of [`disk_concentric`], per unit of area on the unit disk.
pub const DISK_PDF: f32 = FRAC_1_PI;

/// A uniform point on the unit disk; neighbours in `u` stay neighbours.
///
/// # Source
/// Shirley & Chiu 1997; PBR4 §A.5.1.
#[inline]
pub fn disk_concentric(u: [f32; 2]) -> Vec2 {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    // Which is longer is chance: choosing numbers costs less than a branch.
    let wide = a.abs() > b.abs();
    let r = if wide { a } else { b };
    let ratio = (if wide { b } else { a }) / r;
    let (sin, cos) = sin_cos_octant(FRAC_PI_4 * if r == 0.0 { 0.0 } else { ratio });
    Vec2::select(BVec2::splat(wide), Vec2::new(cos, sin), Vec2::new(sin, cos)) * r
}

/// Sine and cosine of an angle in [-π/4, π/4], to 2⁻²³: the same on every machine, where those of the
/// system's library may differ.
///
/// # Source
/// The polynomials of Cephes 2.8 (Moshier), `sinf.c`.
#[inline]
fn sin_cos_octant(x: f32) -> (f32, f32) {
    let z = x * x;
    let sin = ((-1.951_529_6e-4 * z + 8.332_161e-3) * z - 0.166_666_55) * z * x + x;
    let cos = ((2.443_315_7e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2) * (z * z);
    (sin, cos - 0.5 * z + 1.0)
}

/// Barycentric coordinates of a uniform point of a triangle: each ≥ 0, sum 1.
///
/// The density is 1 / area.
///
/// # Source
/// Heitz 2019, "A Low-Distortion Map Between Triangle and Square"; PBR4 §6.5.4.
#[inline]
pub fn uniform_triangle(u: [f32; 2]) -> [f32; 3] {
    let (b0, b1) =
        if u[0] < u[1] { (0.5 * u[0], u[1] - 0.5 * u[0]) } else { (u[0] - 0.5 * u[1], 0.5 * u[1]) };
    [b0, b1, (1.0 - b0 - b1).max(0.0)]
}

/// A distance with density σ e^(−σt): the free flight through a medium of extinction `sigma_t`.
///
/// `sigma_t` in m⁻¹; zero gives infinity. Uses ln u, as u of 32 bits is finest at 0: distances
/// reach 22.9 mean free paths instead of the 16.6 of ln(1 − u) in 24 bits. Decreasing in `u`.
#[inline]
pub fn exponential(u: f32, sigma_t: f32) -> f32 {
    // Zero stands for all of [0, 2⁻³²): its middle.
    -u.max(0.5 / (1u64 << 32) as f32).ln() / sigma_t
}

/// Density of [`exponential`] at distance `t` ≥ 0, in m⁻¹.
#[inline]
pub fn exponential_pdf(t: f32, sigma_t: f32) -> f32 {
    sigma_t * (-sigma_t * t).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Moments;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::{Counts, fraction_cell};

    #[test]
    fn disk_samples_follow_their_density() {
        // Rings of equal area times sectors: uniform if the density is.
        let (rings, sectors) = (8, 16);
        let mut counts = Counts::new(rings * sectors);
        let mut rng = Rng::new(10);
        for _ in 0..50_000 {
            let p = disk_concentric(rng.pair()).as_dvec2();
            assert!(p.length() <= 1.0 + f64::from(f32::EPSILON));
            let turn = p.y.atan2(p.x) / std::f64::consts::TAU + 0.5;
            let ring = fraction_cell(p.length_squared(), rings);
            counts.add(ring * sectors + fraction_cell(turn, sectors));
        }
        let cell_area = std::f64::consts::PI / 128.0;
        counts.check(|_| f64::from(DISK_PDF) * cell_area);
        assert_eq!(disk_concentric([0.5, 0.5]), Vec2::ZERO);
    }

    #[test]
    fn sine_and_cosine_of_an_octant_are_right_to_single_precision() {
        for i in -1000..=1000_i16 {
            let x = f32::from(i) / 1000.0 * FRAC_PI_4;
            let (sin, cos) = sin_cos_octant(x);
            let exact = f64::from(x).sin_cos();
            let worst = (f64::from(sin) - exact.0).abs().max((f64::from(cos) - exact.1).abs());
            assert!(worst <= f64::from(f32::EPSILON), "{x}: {worst:e}");
        }
    }

    #[test]
    fn triangle_samples_are_uniform() {
        // Classic map of barycentrics back to the unit square, where uniform is uniform.
        let n = 10;
        let mut counts = Counts::new(n * n);
        let mut rng = Rng::new(11);
        for _ in 0..50_000 {
            let [b0, b1, b2] = uniform_triangle(rng.pair()).map(f64::from);
            assert!(b0 >= 0.0 && b1 >= 0.0 && b2 >= 0.0);
            assert!((b0 + b1 + b2 - 1.0).abs() <= 2.0 * f64::from(f32::EPSILON));
            let along = b1 / (b0 + b1).max(f64::MIN_POSITIVE);
            counts.add(fraction_cell((b0 + b1).powi(2), n) * n + fraction_cell(along, n));
        }
        counts.check(|_| 1.0 / 100.0);
    }

    #[test]
    fn exponential_samples_follow_their_density() {
        let (sigma_t, n, end) = (2.5f32, 40usize, 2.0);
        let mut counts = Counts::new(n + 1);
        let mut mean = Moments::default();
        let mut rng = Rng::new(12);
        for _ in 0..50_000 {
            let t = f64::from(exponential(rng.f32(), sigma_t));
            mean.push(t);
            counts.add(if t < end { fraction_cell(t / end, n) } else { n });
        }
        let width = end / n as f64;
        // Midpoint rule: relative error (σ width)² / 24 < 1e-3 of a cell, below its noise of 2 %.
        let density = |i: usize| f64::from(exponential_pdf((i as f32 + 0.5) * 0.05, sigma_t));
        counts.check(|i| if i < n { density(i) * width } else { (-2.5 * end).exp() });
        assert!((mean.mean - 0.4).abs() <= 5.0 * mean.standard_error());
    }

    #[test]
    fn exponential_is_finite_at_both_ends() {
        let far = exponential(0.0, 1.0);
        assert!(far > 22.0 && far < 23.0);
        assert!(exponential(1.0f32.next_down(), 1.0) > 0.0);
        assert!(exponential(0.25, 0.0).is_infinite());
    }
}
