//! FLIP: the difference that a person sees when flipping between two displayed pictures.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator
//! for Alternating Images", HPG 2020: the measure for pictures of low dynamic range, at its default
//! of 67 pixels per degree. 0 is no difference, 1 the largest.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::blur::{Kernel, Plane};

/// Pixels per degree of the eye: a screen of 3840 pixels over 0.7 m, seen from 0.7 m.
const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Contrast sensitivity of achromatic, red-green and blue-yellow: two bells each, by height and width.
const SENSITIVITY: [[(f64, f64); 2]; 3] =
    [[(1.0, 0.0047), (0.0, 1e-5)], [(1.0, 0.0053), (0.0, 1e-5)], [(34.1, 0.04), (13.5, 0.025)]];
/// The widest of them.
const WIDEST: f64 = 0.04;

/// Exponent of colour differences.
const COLOUR_POWER: f64 = 0.7;
/// Below this share of the largest colour difference …
const KNEE: f64 = 0.4;
/// … lie differences up to this.
const KNEE_TO: f64 = 0.95;

/// Width of what is taken as an edge or a point, degrees.
const FEATURE_WIDTH: f64 = 0.082;
/// Exponent of feature differences.
const FEATURE_POWER: f64 = 0.5;

/// From linear sRGB to XYZ, rows.
const XYZ: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];

fn to_xyz() -> DMat3 {
    DMat3::from_cols_array_2d(&XYZ).transpose()
}

/// White has XYZ equal to it.
fn white() -> DVec3 {
    to_xyz() * DVec3::ONE
}

/// Mean over two displayed pictures of one size, linear sRGB in [0, 1], row by row.
pub(super) fn flip(a: &[DVec3], b: &[DVec3], width: usize) -> f64 {
    let (a, b) = (opponent(a, width), opponent(b, width));
    let features = feature_differences(&a[0], &b[0]);
    let (a, b) = (seen(&a), seen(&b));
    let most = largest();
    let pixels = a.iter().zip(&b).zip(&features);
    let sum: f64 = pixels
        .map(|((a, b), feature)| {
            let colour = spread(distance(*a, *b).powf(COLOUR_POWER), most);
            colour.powf(1.0 - feature)
        })
        .sum();
    sum / features.len().max(1) as f64
}

/// Planes of `YCxCz`: achromatic, red-green, blue-yellow.
fn opponent(rgb: &[DVec3], width: usize) -> [Plane; 3] {
    let (matrix, white) = (to_xyz(), white());
    let all: Vec<DVec3> = rgb
        .iter()
        .map(|rgb| {
            let v = matrix * *rgb / white;
            DVec3::new(116.0 * v.y - 16.0, 500.0 * (v.x - v.y), 200.0 * (v.y - v.z))
        })
        .collect();
    [0, 1, 2].map(|i| Plane { width, values: all.iter().map(|v| v[i]).collect() })
}

/// What the eye makes of them, in Hunt-adjusted L*a*b*.
fn seen(planes: &[Plane; 3]) -> Vec<DVec3> {
    let [y, cx, cz] = [0, 1, 2].map(|i| planes[i].filtered(&sensitivity(SENSITIVITY[i])));
    let (matrix, white) = (to_xyz(), white());
    let inverse = matrix.inverse();
    (0..y.values.len())
        .map(|i| {
            let y = (y.values[i] + 16.0) / 116.0;
            let v = DVec3::new(y + cx.values[i] / 500.0, y, y - cz.values[i] / 200.0);
            let rgb = (inverse * (v * white)).clamp(DVec3::ZERO, DVec3::ONE);
            hunt(lab(matrix * rgb / white))
        })
        .collect()
}

/// Two bells as sums of separable ones; their sum is 1 over the square that they are cut to.
fn sensitivity(bells: [(f64, f64); 2]) -> Vec<Kernel> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil();
    let mut kernels: Vec<Kernel> = bells
        .into_iter()
        .filter(|bell| bell.0 > 0.0)
        .map(|(height, width)| {
            let bell = |x: f64| (-(PI * x / PIXELS_PER_DEGREE).powi(2) / width).exp();
            let mut kernel = Kernel::new(radius, bell, bell);
            kernel.scale(height * (PI / width).sqrt());
            kernel
        })
        .collect();
    let sum: f64 = kernels.iter().map(Kernel::sum).sum();
    for kernel in &mut kernels {
        kernel.scale(1.0 / sum);
    }
    kernels
}

/// CIE L*a*b*, of XYZ relative to white.
fn lab(v: DVec3) -> DVec3 {
    const DELTA: f64 = 6.0 / 29.0;
    let f = |t: f64| {
        if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let v = DVec3::from(v.to_array().map(f));
    DVec3::new(116.0 * v.y - 16.0, 500.0 * (v.x - v.y), 200.0 * (v.y - v.z))
}

/// Colour weakens as light does.
fn hunt(lab: DVec3) -> DVec3 {
    DVec3::new(lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z)
}

/// `HyAB`.
fn distance(a: DVec3, b: DVec3) -> f64 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}

/// From green to blue.
fn largest() -> f64 {
    let of = |rgb: DVec3| hunt(lab(to_xyz() * rgb / white()));
    distance(of(DVec3::Y), of(DVec3::Z)).powf(COLOUR_POWER)
}

fn spread(difference: f64, most: f64) -> f64 {
    let knee = KNEE * most;
    if difference < knee {
        difference * KNEE_TO / knee
    } else {
        KNEE_TO + (difference - knee) / (most - knee) * (1.0 - KNEE_TO)
    }
}

/// Differences of edges and points of the achromatic plane, in [0, 1].
fn feature_differences(a: &Plane, b: &Plane) -> Vec<f64> {
    let sd = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * sd).ceil();
    let bell = |x: f64| (-0.5 * (x / sd).powi(2)).exp();
    let edge = |x: f64| -x * bell(x);
    let point = |x: f64| ((x / sd).powi(2) - 1.0) * bell(x);
    let strength = |plane: &Plane, across: &dyn Fn(f64) -> f64| -> Vec<f64> {
        let mut kernel = Kernel::new(radius, across, bell);
        kernel.balance();
        let x = plane.filtered(&[kernel.clone()]);
        let y = plane.filtered(&[kernel.turned()]);
        x.values.iter().zip(&y.values).map(|(x, y)| x.hypot(*y)).collect()
    };
    let normal = |plane: &Plane| {
        let values = plane.values.iter().map(|y| (y + 16.0) / 116.0).collect();
        Plane { width: plane.width, values }
    };
    let (a, b) = (normal(a), normal(b));
    let [edges_a, edges_b] = [&a, &b].map(|plane| strength(plane, &edge));
    let [points_a, points_b] = [&a, &b].map(|plane| strength(plane, &point));
    (0..a.values.len())
        .map(|i| {
            let edge = (edges_a[i] - edges_b[i]).abs();
            let point = (points_a[i] - points_b[i]).abs();
            (edge.max(point) / 2.0_f64.sqrt()).clamp(0.0, 1.0).powf(FEATURE_POWER)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 48;

    /// A picture of waves, steps and squares, and what is to be compared with it.
    fn pictures() -> (Vec<DVec3>, Vec<DVec3>) {
        let colour = |x: f64, y: f64| {
            let square = ((x / 8.0).floor() + (y / 8.0).floor()) % 2.0;
            let waves = 0.5 + 0.5 * (x * 0.37 + y * 0.11).sin();
            DVec3::new(waves, (x * 7.0 + y * 13.0) % 17.0 / 16.0, square * 0.8 + 0.1)
        };
        let other = |x: f64, y: f64| {
            let (here, left) = (colour(x, y), colour(if x > 0.0 { x - 1.0 } else { 47.0 }, y));
            DVec3::new(here.x * 0.9, (here.y + 0.1 * x.sin()).clamp(0.0, 1.0), left.z)
        };
        let all = |of: &dyn Fn(f64, f64) -> DVec3| {
            (0..32_u8)
                .flat_map(|y| (0..48_u8).map(move |x| (x, y)))
                .map(|(x, y)| of(x.into(), y.into()))
                .collect()
        };
        (all(&colour), all(&other))
    }

    #[test]
    fn flip_is_that_of_the_reference_program() {
        // flip-evaluator 1.7 of NVlabs: evaluate(a, b, "LDR", inputsRGB=False), in single precision.
        let (a, b) = pictures();
        let near = |found: f64, expected: f64| (found - expected).abs() < 1e-5;
        let found = flip(&a, &b, WIDTH);
        assert!(near(found, 0.267_490_357), "{found}");
        let half: Vec<_> = a.iter().map(|v| *v * 0.5).collect();
        let found = flip(&a, &half, WIDTH);
        assert!(near(found, 0.633_574_247), "{found}");
        let (green, blue) = (vec![DVec3::Y; a.len()], vec![DVec3::Z; a.len()]);
        assert!(near(flip(&green, &blue, WIDTH), 1.0));
    }

    #[test]
    fn equal_pictures_do_not_flip() {
        let (a, _) = pictures();
        assert!(flip(&a, &a, WIDTH) <= 0.0 && flip(&[], &[], 0) <= 0.0);
    }
}
