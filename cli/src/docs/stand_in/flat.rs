//! Pictures made of noise: a sky, soil, and the heights of mountains.

use std::f64::consts::PI;
use std::io::Cursor;

use glam::{DVec2, DVec3, IVec2, UVec2};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use luxel_core::film::Rect;

use crate::picture::{Plane, write_planes};

/// An overcast sky above grey ground: a third as bright at the horizon as overhead (CIE 1955), with clouds.
pub(super) fn sky() -> Vec<u8> {
    let towards_sun = DVec3::new(0.5, 0.6, 0.62).normalize();
    exr(UVec2::new(128, 64), |at| {
        let (elevation, azimuth) = (PI * (0.5 - at.y), 2.0 * PI * (at.x - 0.5));
        let (sin, cos) = elevation.sin_cos();
        if sin < 0.0 {
            return DVec3::new(0.2, 0.19, 0.17);
        }
        let d = DVec3::new(cos * azimuth.sin(), sin, -cos * azimuth.cos());
        let clouds = 0.6 + 0.8 * fractal(DVec2::new(d.x, d.z) / (0.3 + sin) * 3.0);
        let veiled_sun = 5.0 * d.dot(towards_sun).max(0.0).powi(40);
        DVec3::new(0.9, 0.96, 1.0) * clouds * (1.0 + 2.0 * sin) / 3.0 + veiled_sun
    })
}

/// Brown soil with darker and lighter clods.
pub(super) fn soil() -> Vec<u8> {
    exr(UVec2::splat(96), |at| {
        let share = fractal(at * 9.0).powi(2);
        DVec3::new(0.05, 0.03, 0.02).lerp(DVec3::new(0.6, 0.4, 0.24), share)
    })
}

/// Ridges that rise towards the middle, sixteen bits of grey.
#[expect(clippy::cast_possible_truncation, reason = "a share of the range of the type")]
#[expect(clippy::cast_sign_loss, reason = "a share of the range of the type")]
pub(super) fn mountains() -> Vec<u8> {
    let size = UVec2::splat(96);
    let height = |at: DVec2| {
        let ridges = 1.0 - (2.0 * fractal(at * 3.0) - 1.0).abs();
        let middle = (1.0 - 1.6 * (at - 0.5).length()).max(0.0);
        (ridges * ridges * (0.25 + middle)).clamp(0.0, 1.0)
    };
    let heights = places(size).map(|at| (height(at) * f64::from(u16::MAX)) as u16);
    let bytes: Vec<u8> = heights.flat_map(u16::to_ne_bytes).collect();
    let mut out = vec![];
    PngEncoder::new(&mut out)
        .write_image(&bytes, size.x, size.y, ExtendedColorType::L16)
        .expect("a picture of that size is written to memory");
    out
}

/// The middles of pixels, row by row from the upper left, in [0, 1].
fn places(size: UVec2) -> impl Iterator<Item = DVec2> {
    (0..size.y)
        .flat_map(move |y| (0..size.x).map(move |x| UVec2::new(x, y)))
        .map(move |pixel| (pixel.as_dvec2() + 0.5) / size.as_dvec2())
}

/// An EXR of linear sRGB.
fn exr(size: UVec2, rgb: impl Fn(DVec2) -> DVec3) -> Vec<u8> {
    let pixels: Vec<_> = places(size).map(|at| rgb(at).as_vec3()).collect();
    let plane = |i: usize| Plane::Floats(pixels.iter().map(|rgb| rgb[i]).collect());
    let planes = ["R", "G", "B"].into_iter().enumerate();
    let planes = planes.map(|(i, name)| (name.to_owned(), plane(i)));
    let mut out = Cursor::new(vec![]);
    write_planes(&mut out, (size, Rect::new(UVec2::ZERO, size)), planes, "{}")
        .expect("a picture of that size is written to memory");
    out.into_inner()
}

/// Noise in [0, 1] of several sizes, the largest of one unit.
fn fractal(at: DVec2) -> f64 {
    let octaves = [(1.0, 0.5), (2.0, 0.25), (4.0, 0.15), (8.0, 0.1)];
    octaves.into_iter().map(|(size, share)| share * noise(at * size)).sum()
}

/// Noise in [0, 1]: random at whole places, smooth between them.
fn noise(at: DVec2) -> f64 {
    let (cell, f) = (at.floor().as_ivec2(), at - at.floor());
    let f = f * f * (3.0 - 2.0 * f);
    let row = |y: i32| {
        let (a, b) = (random(cell + IVec2::new(0, y)), random(cell + IVec2::new(1, y)));
        a + (b - a) * f.x
    };
    row(0) + (row(1) - row(0)) * f.y
}

/// A number in [0, 1] that looks random.
fn random(cell: IVec2) -> f64 {
    let cell = cell.as_uvec2();
    let h = cell.x.wrapping_mul(0x9E37_79B1) ^ cell.y.wrapping_mul(0x85EB_CA77);
    let h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    let h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    f64::from(h ^ (h >> 15)) / f64::from(u32::MAX)
}
