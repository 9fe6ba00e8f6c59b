//! A film as bytes, and back: to go on with it later, to the same bits.

use std::io::{self, Write};
use std::sync::Arc;

use glam::{DVec3, UVec2, Vec3};

use super::{Film, Holds, Layer, Pixel, Rect};

/// What every saved film begins with; the digit counts layouts.
const MAGIC: &[u8; 8] = b"luxfilm4";
/// Bytes of a pixel.
const PIXEL: usize = 8 + 5 * 24 + 2 * 12;

/// Bytes that are no film, with what is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unreadable(pub &'static str);

impl Film {
    /// Writes the film, all numbers little-endian.
    ///
    /// # Errors
    /// The writer's.
    pub fn save(&self, to: &mut impl Write) -> io::Result<()> {
        to.write_all(MAGIC)?;
        for v in [self.size, self.window.min, self.window.size] {
            to.write_all(&v.x.to_le_bytes())?;
            to.write_all(&v.y.to_le_bytes())?;
        }
        let layers = Layer::ALL.map(|layer| u8::from(self.holds.layers.contains(&layer)));
        to.write_all(&layers)?;
        write_number(to, self.holds.groups.len())?;
        for group in &self.holds.groups {
            write_number(to, group.len())?;
            to.write_all(group.as_bytes())?;
        }
        for tile in &self.tiles {
            to.write_all(&tile.next.to_le_bytes())?;
            to.write_all(&tile.aim.to_le_bytes())?;
            for pixel in tile.pixels() {
                to.write_all(&bytes(pixel))?;
            }
            for sum in &tile.layers {
                to.write_all(&sum.to_le_bytes())?;
            }
        }
        Ok(())
    }

    /// Reads what `save` wrote: the same bits.
    ///
    /// # Errors
    /// Bytes that `save` did not write.
    pub fn load(bytes: &[u8]) -> Result<Self, Unreadable> {
        let mut from = Reader(bytes);
        if from.take::<8>()? != *MAGIC {
            return Err(Unreadable("it is no film of this version"));
        }
        let mut vector = || Ok(UVec2::new(from.u32()?, from.u32()?));
        let (size, min, extent): (UVec2, UVec2, UVec2) = (vector()?, vector()?, vector()?);
        let window = Rect::new(min, extent);
        if window.intersection(Rect::new(UVec2::ZERO, size)) != window || window.area() == 0 {
            return Err(Unreadable("its window lies outside the picture"));
        }
        let given = from.take::<{ Layer::ALL.len() }>()?;
        let layers = Layer::ALL.into_iter().zip(given).filter(|(_, given)| *given != 0);
        let layers = layers.map(|(layer, _)| layer).collect();
        let groups = (0..from.u32()?).map(|_| from.text()).collect::<Result<_, _>>()?;
        let holds = Holds { layers, groups };
        // Before any room is made for the pixels.
        let bytes = PIXEL + 8 * holds.channels().len();
        if from.0.len() / bytes < window.area() {
            return Err(Unreadable("it ends too early"));
        }
        let mut film = Self::holding(size, window, holds);
        for tile in &mut film.tiles {
            (tile.next, tile.aim) = (from.u32()?, from.u32()?);
            let most = tile.next;
            for pixel in tile.pixels_mut() {
                *pixel = from.pixel()?;
                if pixel.n.checked_add(pixel.bad).is_none_or(|n| n > most) {
                    return Err(Unreadable("a pixel has more samples than its tile"));
                }
            }
            for sum in &mut tile.layers {
                *sum = from.take().map(f64::from_le_bytes)?;
            }
        }
        if from.0.is_empty() { Ok(film) } else { Err(Unreadable("it goes on after its end")) }
    }
}

fn write_number(to: &mut impl Write, n: usize) -> io::Result<()> {
    to.write_all(&crate::cast::index(n).to_le_bytes())
}

fn bytes(pixel: &Pixel) -> [u8; PIXEL] {
    let Pixel { n, bad, mean, rest, m2, open, block_mean, block_m2, before } = *pixel;
    let mut out = [0; PIXEL];
    out[..4].copy_from_slice(&n.to_le_bytes());
    out[4..8].copy_from_slice(&bad.to_le_bytes());
    let (double, single) = out[8..].split_at_mut(5 * 24);
    let numbers = [mean, m2, open, block_mean, block_m2].into_iter().flat_map(|v| v.to_array());
    for (place, x) in double.chunks_exact_mut(8).zip(numbers) {
        place.copy_from_slice(&x.to_le_bytes());
    }
    let numbers = [rest, before].into_iter().flat_map(|v| v.to_array());
    for (place, x) in single.chunks_exact_mut(4).zip(numbers) {
        place.copy_from_slice(&x.to_le_bytes());
    }
    out
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Unreadable> {
        let (first, rest) = self.0.split_first_chunk().ok_or(Unreadable("it ends too early"))?;
        self.0 = rest;
        Ok(*first)
    }

    fn u32(&mut self) -> Result<u32, Unreadable> {
        self.take().map(u32::from_le_bytes)
    }

    fn text(&mut self) -> Result<Arc<str>, Unreadable> {
        let n = self.u32()? as usize;
        let (text, rest) = self.0.split_at_checked(n).ok_or(Unreadable("it ends too early"))?;
        self.0 = rest;
        let text = std::str::from_utf8(text).map_err(|_| Unreadable("a name in it is no text"))?;
        Ok(text.into())
    }

    fn vector(&mut self) -> Result<DVec3, Unreadable> {
        let mut number = || self.take().map(f64::from_le_bytes);
        Ok(DVec3::new(number()?, number()?, number()?))
    }

    fn single(&mut self) -> Result<Vec3, Unreadable> {
        let mut number = || self.take().map(f32::from_le_bytes);
        Ok(Vec3::new(number()?, number()?, number()?))
    }

    fn pixel(&mut self) -> Result<Pixel, Unreadable> {
        Ok(Pixel {
            n: self.u32()?,
            bad: self.u32()?,
            mean: self.vector()?,
            m2: self.vector()?,
            open: self.vector()?,
            block_mean: self.vector()?,
            block_m2: self.vector()?,
            rest: self.single()?,
            before: self.single()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film() -> Film {
        let window = Rect::new(UVec2::new(5, 3), UVec2::new(40, 18));
        let holds = Holds { layers: vec![Layer::Albedo, Layer::Cost], groups: vec!["key".into()] };
        let mut film = Film::holding(UVec2::new(64, 64), window, holds);
        for (i, tile) in (0_u8..).zip(film.tiles_mut()) {
            tile.layers[2] = f64::from(i) / 7.0;
            tile.aim = 100;
            tile.next = u32::from(i) * 7;
            for sample in 0..i * 7 {
                tile.pixel_mut(3).push(DVec3::new(0.1, 1e-30, 1e30) * f64::from(sample));
            }
        }
        film
    }

    #[test]
    fn a_film_is_read_back_bit_by_bit() {
        let (film, mut bytes) = (film(), vec![]);
        film.save(&mut bytes).unwrap();
        assert_eq!(Film::load(&bytes), Ok(film));
    }

    #[test]
    fn other_bytes_are_refused_before_room_is_made() {
        let mut bytes = vec![];
        film().save(&mut bytes).unwrap();
        let why = |bytes: &[u8]| Film::load(bytes).unwrap_err().0;
        assert_eq!(why(b"something else"), "it is no film of this version");
        assert_eq!(why(&bytes[..5]), "it ends too early");
        assert_eq!(why(&bytes[..bytes.len() - 1]), "it ends too early");
        bytes.push(0);
        assert_eq!(why(&bytes), "it goes on after its end");
        // A window of 2³² by 2³² pixels.
        let mut huge = MAGIC.to_vec();
        huge.extend([255; 8].into_iter().chain([0; 8]).chain([255; 8]));
        assert_eq!(why(&huge), "it ends too early");
        bytes[16] = 200;
        assert_eq!(why(&bytes), "its window lies outside the picture");
    }
}
