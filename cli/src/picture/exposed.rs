//! Whether a picture can be seen as it is displayed, and the exposure that would show it.

use glam::DVec3;
use luxel_core::film::Film;
use luxel_core::registry::Display;
use luxel_core::stage;
use luxel_sdk::color::{RgbSpace, luminance_cd_m2};

use super::display;

/// What comes of a picture on a screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exposed {
    /// Something can be seen.
    Well,
    /// Nothing that shines is seen.
    Black,
    /// Nearly all of it is darker than the darkest grey; this exposure would show it.
    Dark(f64),
    /// Nearly all of it is far brighter than white; this exposure would show it.
    White(f64),
}

/// The share of the pixels that is nearly all.
const NEARLY_ALL: f64 = 0.95;
/// What an exposure brings the median to.
const GREY: f64 = 0.2;

impl Exposed {
    pub(crate) fn of(film: &Film, settings: &stage::Film) -> Self {
        let measured = film.pixels().filter(|(_, pixel)| pixel.n > 0);
        Self::of_means(measured.map(|(_, pixel)| pixel.mean), settings)
    }

    fn of_means(means: impl Iterator<Item = DVec3>, settings: &stage::Film) -> Self {
        let weights = RgbSpace::LinearSrgb.luminance_weights();
        let scale = display::scale(settings.exposure);
        // So much brighter than white that no rounding and no view of an amount up to 1 is.
        let white = if settings.display == Display::Filmic { 16.0 } else { 1.5 };
        let (mut n, mut dark, mut bright, mut lit) = (0_u64, 0_u64, 0_u64, vec![]);
        for mean in means {
            let exposed = mean * scale;
            n += 1;
            bright += u64::from(exposed.min_element() > white);
            let shown = display::show(exposed, settings.display).max_element();
            dark += u64::from(shown < 0.5 / 255.0);
            lit.extend(Some(mean.dot(weights)).filter(|of| *of > 0.0 && of.is_finite()));
        }
        let nearly_all = |of: u64| n > 0 && of as f64 >= NEARLY_ALL * n as f64;
        if lit.is_empty() {
            return if nearly_all(dark) { Self::Black } else { Self::Well };
        }
        let middle = lit.len() / 2;
        let (_, median, _) = lit.select_nth_unstable_by(middle, f64::total_cmp);
        let ev = (luminance_cd_m2(*median) / (1.2 * GREY)).log2().round();
        match (nearly_all(dark), nearly_all(bright)) {
            (true, _) => Self::Dark(ev),
            (_, true) => Self::White(ev),
            _ => Self::Well,
        }
    }

    /// A line about what cannot be seen.
    pub(crate) fn words(self) -> String {
        let (how, ev) = match self {
            Self::Well => return String::new(),
            Self::Black => {
                return "the picture is black: nothing that shines is seen in it\n".into();
            }
            Self::Dark(ev) => ("dark", ev),
            Self::White(ev) => ("white", ev),
        };
        format!("the picture is nearly all {how}: `exposure = {ev} EV` in its film would show it\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What comes of ten pixels, one of which has another radiance.
    fn of(radiance: f64, one: f64, exposure: Option<f64>) -> Exposed {
        let means = (0..10).map(|i| DVec3::splat(if i == 0 { one } else { radiance }));
        Exposed::of_means(means, &stage::Film { exposure, ..stage::Film::default() })
    }

    #[test]
    fn what_cannot_be_seen_is_shown_by_the_exposure_that_is_told() {
        for radiance in [1e-6, 40.0, 1e9] {
            let (Exposed::White(ev) | Exposed::Dark(ev)) = of(radiance, radiance, None) else {
                panic!("{radiance} can be seen");
            };
            assert_eq!(of(radiance, radiance, Some(ev)), Exposed::Well);
            // A whole exposure value is half a stop off at most.
            let off = (radiance * display::scale(Some(ev)) / GREY).log2().abs();
            assert!(off < 0.5 + 1e-6, "{radiance}: {off} stops");
        }
        assert_eq!(of(0.0, 0.0, None), Exposed::Black);
        for (radiance, one) in [(1.0, 1.0), (1e-6, 0.3), (40.0, 0.3)] {
            assert_eq!(of(radiance, one, None), Exposed::Well);
        }
    }
}
