//! Intervals that hold the truth with a stated probability, and where they are wider than was asked.

use super::{Errors, Film, Rect, Scale, Tile, degrees_of_freedom};

/// Probability with which an interval is to hold the truth: from a half to 0.999, beyond which the
/// expansion that is used ends to be right to three digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confidence(f64);

impl Confidence {
    /// 95 %.
    pub const USUAL: Self = Self(0.95);

    /// `None` outside [0.5, 0.999], also of what is not a number.
    pub fn new(share: f64) -> Option<Self> {
        (0.5..=0.999).contains(&share).then_some(Self(share))
    }

    /// The probability.
    pub fn share(self) -> f64 {
        self.0
    }

    /// How many standard errors such an interval about the mean of `n` samples of a pixel reaches to each
    /// side: Student's t for its `degrees_of_freedom`; infinite below two samples.
    ///
    /// # Source
    /// Hill 1970, Algorithm 396 (the expansion in the normal quantile), three digits at 95 % from three
    /// degrees of freedom on; below, the closed forms.
    pub fn half_width(self, n: u32) -> f64 {
        let Self(share) = self;
        match n {
            0 | 1 => f64::INFINITY,
            2 => (share * std::f64::consts::FRAC_PI_2).tan(),
            3 => share * (2.0 / (1.0 - share * share)).sqrt(),
            _ => expansion(normal(share), degrees_of_freedom(n)),
        }
    }
}

/// How many standard errors an interval about the mean of `n` samples reaches to each side, if it is
/// to hold the truth 95 times in 100; infinite below two samples.
pub fn half_width_95(n: u32) -> f64 {
    Confidence::USUAL.half_width(n)
}

fn expansion(z: f64, nu: f64) -> f64 {
    let g1 = (z.powi(3) + z) / 4.0;
    let g2 = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
    let g3 = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
    let g4 = (79.0 * z.powi(9) + 776.0 * z.powi(7) + 1482.0 * z.powi(5)
        - 1920.0 * z.powi(3)
        - 945.0 * z)
        / 92160.0;
    z + g1 / nu + g2 / nu.powi(2) + g3 / nu.powi(3) + g4 / nu.powi(4)
}

/// What a normal variable of variance 1 is nearer to 0 than with that probability in [0, 1).
///
/// # Source
/// Wichura 1988, AS 241, the seven-digit form.
fn normal(share: f64) -> f64 {
    let q = 0.5 * share;
    if q <= 0.425 {
        let r = 0.180625 - q * q;
        let above = ((59.109_374_720 * r + 159.291_132_02) * r + 50.434_271_938) * r + 3.3871327179;
        let below = ((67.187_563_600 * r + 78.757_757_664) * r + 17.895_169_469) * r + 1.0;
        return q * above / below;
    }
    let r = (-(0.5 - q).ln()).sqrt() - 1.6;
    let above = ((0.17023821103 * r + 1.3067284816) * r + 2.7568153900) * r + 1.4234372777;
    above / ((0.12021132975 * r + 0.73700164250) * r + 1.0)
}

/// Half widths of intervals about the luminance of pixels, relative as `Errors` are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intervals {
    /// With which probability each is to hold the truth.
    pub confidence: Confidence,
    /// Half of the pixels have less.
    pub median: f64,
    /// All but a twentieth have less.
    pub p95: f64,
    /// The largest root mean square of a tile.
    pub worst_tile: f64,
    /// Where that is.
    pub worst_tile_at: Rect,
}

impl Intervals {
    /// Over the pixels that have two samples; nothing if none has.
    pub fn of_film(film: &Film, confidence: Confidence) -> Option<Self> {
        let scale = Scale::of(film);
        let mut width = widths(confidence);
        let pixels = film
            .pixels()
            .filter_map(|(_, pixel)| scale.error(pixel).map(|error| error * width(pixel.n)));
        let mut all: Vec<f64> = pixels.collect();
        let last = all.len().checked_sub(1)?;
        let mut at = |i: usize| *all.select_nth_unstable_by(i, f64::total_cmp).1;
        let (median, p95) = (at(last / 2), at(last - last / 20));
        let tiles = film.tiles().iter();
        let known =
            tiles.filter_map(|tile| Some((scale.reach(tile, Some(confidence))?, tile.rect)));
        let (worst_tile, worst_tile_at) = known.max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Self { confidence, median, p95, worst_tile, worst_tile_at })
    }
}

/// Where a picture is not as good as it was to be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Above {
    /// How many pixels.
    pub pixels: u64,
    /// How many tiles.
    pub tiles: u64,
    /// The worst of these, the worst first, with their root mean squares; of what is not known none, and
    /// that is the worst.
    pub worst: Vec<(Rect, Option<f64>)>,
}

impl Above {
    /// What is above `limit`: the relative standard error, or the half width of an interval of that
    /// confidence; at most `named` tiles by name.
    pub fn of_film(
        film: &Film,
        (limit, confidence): (f64, Option<Confidence>),
        named: usize,
    ) -> Self {
        let scale = Scale::of(film);
        let reaches = film.tiles().iter().map(|tile| (tile.rect, scale.reach(tile, confidence)));
        // A tile of which nothing is known is not good.
        let is_above = |(_, reach): &(Rect, Option<f64>)| reach.is_none_or(|reach| reach > limit);
        let mut worst: Vec<(Rect, Option<f64>)> = reaches.filter(is_above).collect();
        let key = |reach: Option<f64>| reach.unwrap_or(f64::INFINITY);
        // Tiles that are alike stay in their order.
        worst.sort_by(|a, b| key(b.1).total_cmp(&key(a.1)));
        let tiles = worst.len() as u64;
        worst.truncate(named);
        let pixels = match confidence {
            None => Errors::of_film(film, limit).map_or(0, |errors| errors.above),
            Some(confidence) => {
                let mut width = widths(confidence);
                let known = film.pixels().filter_map(|(_, p)| Some((scale.error(p)?, p.n)));
                known.filter(|(error, n)| error * width(*n) > limit).count() as u64
            }
        };
        Self { pixels, tiles, worst }
    }
}

impl Scale {
    /// Root mean square over a tile of the standard errors, or of the half widths of intervals of that
    /// confidence; nothing where none of its pixels is known.
    pub(crate) fn reach(&self, tile: &Tile, confidence: Option<Confidence>) -> Option<f64> {
        let Some(confidence) = confidence else { return self.of_tile(tile) };
        let mut width = widths(confidence);
        let known = tile.pixels().filter_map(|pixel| Some(self.error(pixel)? * width(pixel.n)));
        let (squares, n) = known.fold((0.0, 0.0), |(sum, n), x| (sum + x * x, n + 1.0));
        (n > 0.0).then(|| (squares / n).sqrt())
    }
}

/// `half_width`, which neighbours with as many samples have in common.
fn widths(confidence: Confidence) -> impl FnMut(u32) -> f64 {
    let (mut of, mut width) = (0, f64::INFINITY);
    move |n| {
        if n != of {
            (of, width) = (n, confidence.half_width(n));
        }
        width
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, UVec2};

    use super::*;

    #[test]
    fn intervals_are_those_of_the_tables() {
        // Student's t, 97.5 %: 3.18245, 2.36462, 2.13145 for 3, 7 and 15 degrees of freedom.
        for (n, t) in [(2, 12.7062), (3, 4.30265), (4, 3.18245), (8, 2.36462), (16, 2.13145)] {
            assert!((half_width_95(n) / t - 1.0).abs() < 2e-3, "{n}: {}", half_width_95(n));
        }
        assert!(half_width_95(0).is_infinite() && half_width_95(1).is_infinite());
        // And of 15 degrees: 0.69120, 1.75305, 2.94671, 4.07277 of 50, 90, 99 and 99.9 %.
        for (share, t) in [(0.5, 0.69120), (0.9, 1.75305), (0.99, 2.94671), (0.999, 4.07277)] {
            let found = Confidence::new(share).unwrap().half_width(16);
            assert!((found / t - 1.0).abs() < 1e-3, "{share}: {found}");
        }
        assert!([0.49, 0.9991, 1.0, f64::NAN].iter().all(|c| Confidence::new(*c).is_none()));
    }

    #[test]
    fn normal_quantiles_have_seven_digits() {
        let table = [(0.5, 0.674489750), (0.95, 1.959963985), (0.99, 2.575829304)];
        for (share, z) in [&table[..], &[(0.999, 3.290526731), (0.85, 1.439531471)]].concat() {
            assert!((normal(share) / z - 1.0).abs() < 2e-7, "{share}: {}", normal(share));
        }
    }

    /// Three tiles of two samples a pixel, of mean 1: the first has no known pixel, the others errors of
    /// 0.1 and 0.3.
    fn film() -> Film {
        let size = UVec2::new(48, 16);
        let mut film = Film::new(size, Rect::new(UVec2::ZERO, size));
        for (tile, off) in film.tiles_mut()[1..].iter_mut().zip([0.1, 0.3]) {
            for pixel in tile.pixels_mut() {
                for off in [-off, off] {
                    pixel.push(DVec3::splat(1.0 + off));
                }
            }
        }
        film
    }

    #[test]
    fn half_widths_are_standard_errors_times_t() {
        let found = Intervals::of_film(&film(), Confidence::USUAL).unwrap();
        let near = |x: f64, error: f64| {
            let half = error * half_width_95(2);
            assert!((x / half - 1.0).abs() < 1e-6, "{x} {half}");
        };
        near(found.worst_tile, 0.3);
        near(found.median, 0.1);
        near(found.p95, 0.3);
        assert_eq!(found.worst_tile_at.min, UVec2::new(32, 0));
        let size = UVec2::splat(4);
        let empty = Film::new(size, Rect::new(UVec2::ZERO, size));
        assert_eq!(Intervals::of_film(&empty, Confidence::USUAL), None);
    }

    #[test]
    fn what_is_above_is_told_with_the_worst_first_and_the_unknown_before() {
        let at = |above: &Above| above.worst.iter().map(|(r, _)| r.min.x).collect::<Vec<_>>();
        let above = Above::of_film(&film(), (0.2, None), 5);
        assert_eq!((above.pixels, above.tiles, at(&above)), (256, 2, vec![0, 32]));
        assert_eq!(above.worst[0].1, None);
        assert!(above.worst[1].1.is_some_and(|error| (error - 0.3).abs() < 1e-6));
        // As half widths, all are.
        let above = Above::of_film(&film(), (0.2, Some(Confidence::USUAL)), 2);
        assert_eq!((above.pixels, above.tiles, at(&above)), (512, 3, vec![0, 32]));
        let none = Above::of_film(&film(), (0.2, Confidence::new(0.5)), 5);
        // Of one degree of freedom, half hold within the standard error itself.
        assert_eq!((none.pixels, none.tiles), (256, 2));
    }
}
