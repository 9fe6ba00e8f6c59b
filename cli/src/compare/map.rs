//! A picture of where two pictures differ: blue where the first is darker, red where it is brighter.

use std::io::{self, Seek, Write};

use glam::{DVec3, UVec2};

use super::judge::Judged;
use super::numbers::{FLOOR, mean_luminance};
use super::pair::Pair;
use super::welch::lanes;
use crate::picture::{self, Plane};

/// From the deepest colour on, tiles differ by more than so many standard errors …
const MOST_Z: f64 = 5.0;
/// … or pixels by more than this share of the reference, where no standard errors are known.
const MOST_RELATIVE: f64 = 0.1;

/// What the colours mean.
pub(super) fn legend(judged: &Judged) -> String {
    let of = if judged.measured > 0 {
        format!("in each tile by {MOST_Z} standard errors of luminance or more")
    } else {
        format!("in each pixel by {} % of B's luminance or more", MOST_RELATIVE * 100.0)
    };
    format!("blue: A is darker, red: A is brighter, deepest {of}; black: not known")
}

/// Draws the map as a PNG.
///
/// # Errors
/// The writer's.
pub(super) fn write_png(to: impl Write, pair: &Pair, judged: &Judged) -> io::Result<()> {
    let window = pair.window;
    let mut signed = vec![f64::NAN; window.area()];
    let index = |at: UVec2| {
        let from = at - window.min;
        from.y as usize * window.size.x as usize + from.x as usize
    };
    if judged.measured > 0 {
        for tile in &judged.tiles {
            for at in tile.rect.points() {
                signed[index(at)] = tile.lanes[0].z() / MOST_Z;
            }
        }
    } else {
        let floor = FLOOR * mean_luminance(pair);
        for (value, [a, b]) in signed.iter_mut().zip(pair.pixels()) {
            let (difference, of) = (lanes(a.rgb - b.rgb).x, lanes(b.rgb).x.max(floor));
            // Black on black is no difference.
            let none = difference.abs() <= 0.0;
            *value = if none { 0.0 } else { difference / of / MOST_RELATIVE };
        }
    }
    picture::write_signal(to, window.size, signed.into_iter().map(colour))
}

/// White for 0, red for 1, blue for −1, black for what is no number.
fn colour(x: f64) -> DVec3 {
    const RED: DVec3 = DVec3::new(0.70, 0.02, 0.15);
    const BLUE: DVec3 = DVec3::new(0.13, 0.26, 0.70);
    if x.is_nan() {
        return DVec3::ZERO;
    }
    let end = if x > 0.0 { RED } else { BLUE };
    DVec3::ONE.lerp(end, x.abs().min(1.0))
}

/// Writes A − B as an EXR: R, G, B, the standard errors of the difference, and `Z`, the tile's
/// difference of luminance in standard errors, no number where that is not known.
///
/// # Errors
/// The writer's.
pub(super) fn write_exr(to: impl Write + Seek, pair: &Pair, judged: &Judged) -> io::Result<()> {
    let mut planes: Vec<(String, Plane)> = vec![];
    #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
    for (i, name) in ["R", "G", "B"].into_iter().enumerate() {
        let pixels = pair.pixels();
        let (values, errors) =
            pixels.map(|[a, b]| ((a.rgb - b.rgb)[i] as f32, a.se[i].hypot(b.se[i]) as f32)).unzip();
        planes.push((name.into(), Plane::Floats(values)));
        if judged.measured > 0 {
            planes.push((format!("SE.{name}"), Plane::Floats(errors)));
        }
    }
    if judged.measured > 0 {
        let mut z = vec![f32::NAN; pair.window.area()];
        for tile in &judged.tiles {
            for at in tile.rect.points() {
                let from = at - pair.window.min;
                let i = from.y as usize * pair.window.size.x as usize + from.x as usize;
                #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
                let value = tile.lanes[0].z() as f32;
                z[i] = value;
            }
        }
        planes.push(("Z".into(), Plane::Floats(z)));
    }
    let notes = serde_json::json!({ "luxel": env!("CARGO_PKG_VERSION"), "difference": true });
    picture::write_planes(to, (pair.a.size, pair.window), planes, &notes.to_string())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use luxel_core::film::Rect;

    use super::*;
    use crate::compare::judge::judge;
    use crate::compare::pair::tests::flat;
    use crate::picture::Picture;

    #[test]
    fn a_tile_without_a_measured_pixel_is_not_known() {
        let (size, window) = (UVec2::new(16, 8), Rect::new(UVec2::ZERO, UVec2::new(16, 8)));
        let mut a = flat(size, window, 1.0, 0.1);
        for y in 0..8 {
            a.n[y * 16 + 8..y * 16 + 16].fill(1);
        }
        let pair = Pair::new(a, flat(size, window, 1.0, 0.1)).unwrap();
        let judged = judge(&pair, 0.01);
        assert!(legend(&judged).ends_with("black: not known"));
        let mut file = Cursor::new(vec![]);
        write_exr(&mut file, &pair, &judged).unwrap();
        file.set_position(0);
        let found = Picture::read(file).unwrap();
        let z = found.others.iter().find(|(name, _)| name == "Z").unwrap();
        let Plane::Floats(z) = &z.1 else { panic!("Z is no plane of floats") };
        assert!(z.iter().enumerate().all(|(i, z)| z.is_nan() == (i % 16 >= 8)), "{z:?}");
    }
}
