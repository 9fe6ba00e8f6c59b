//! From radiance to what a screen shows: exposure, then a display transform.

use glam::{DMat3, DVec3};
use luxel_core::registry::Display;
use luxel_sdk::color::{luminance_cd_m2, srgb_encode};

/// Factor on radiance: at an exposure value EV (ISO 100), a luminance of 1.2·2^EV cd/m² becomes 1;
/// without one a radiance of 1 does.
pub(crate) fn scale(exposure: Option<f64>) -> f64 {
    exposure.map_or(1.0, |ev| luminance_cd_m2(1.0) / (1.2 * ev.exp2()))
}

/// The signal in [0, 1] for exposed linear sRGB; not a number stays one.
pub(crate) fn show(rgb: DVec3, display: Display) -> DVec3 {
    let clipped = |v: DVec3| v.clamp(DVec3::ZERO, DVec3::ONE);
    match display {
        Display::Srgb => DVec3::from(clipped(rgb).to_array().map(srgb_encode)),
        Display::Linear => clipped(rgb),
        Display::Filmic => clipped(filmic(rgb)),
    }
}

/// From linear sRGB to `AgX`'s working space, whose primaries lie further out, so that strong colours
/// bleach as they grow brighter. Columns.
const AGX: DMat3 = DMat3::from_cols_array(&[
    0.842479062253094,
    0.0423282422610123,
    0.0423756549057051,
    0.0784335999999992,
    0.878468636469772,
    0.0784336,
    0.0792237451477643,
    0.0791661274605434,
    0.879142973793104,
]);
/// The range that `AgX` shows, in stops about a radiance of 1.
const AGX_STOPS: (f64, f64) = (-12.47393, 4.026069);
/// Contrast over the range of stops, powers from the sixth down.
const AGX_CONTRAST: [f64; 7] = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232];

/// # Source
/// T. Sobotka's `AgX` in the form of B. Wrensch, "Minimal `AgX` implementation" (2023): a polynomial
/// through the original's table, mean squared error 3.7e-6.
fn filmic(rgb: DVec3) -> DVec3 {
    let (low, high) = AGX_STOPS;
    let curve = |x: f64| {
        let stop = if x > 0.0 { x.log2().clamp(low, high) } else { low };
        let t = (stop - low) / (high - low);
        AGX_CONTRAST.iter().fold(0.0, |sum, c| sum * t + c)
    };
    AGX.inverse() * DVec3::from((AGX * rgb).to_array().map(curve))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_luminance_of_an_exposure_value_is_white() {
        // EV 9.5: 1.2·2^9.5 = 868.892 cd/m², 5.595 units of radiance.
        assert!((scale(Some(9.5)) * 868.892 / luminance_cd_m2(1.0) - 1.0).abs() < 1e-6);
        assert!((scale(None) - 1.0).abs() <= 0.0);
        assert!((scale(Some(3.0)) / scale(Some(4.0)) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn every_display_keeps_grey_grey_black_dark_and_order() {
        for display in [Display::Srgb, Display::Linear, Display::Filmic] {
            let mut last = 0.0;
            for i in -10..=3 {
                let shown = show(DVec3::splat(f64::from(i).exp2()), display);
                // The matrix's rows sum to 1 within 2e-4, and its inverse undoes that.
                assert!(shown.max_element() - shown.min_element() < 1e-3, "{display:?} {shown}");
                assert!(shown.x >= last, "{display:?}");
                last = shown.x;
            }
            assert!(show(DVec3::ZERO, display).max_element() < 1.0 / 255.0);
            let huge = show(DVec3::splat(f64::INFINITY), display);
            assert!(huge.min_element() > 0.98, "{display:?} {huge}");
        }
    }

    #[test]
    fn filmic_leaves_room_above_white_and_bleaches_strong_colours() {
        let white = show(DVec3::ONE, Display::Filmic);
        let brighter = show(DVec3::splat(4.0), Display::Filmic);
        assert!(white.x < 0.85 && brighter.x > white.x && brighter.x < 1.0);
        let red = show(DVec3::new(16.0, 0.0, 0.0), Display::Filmic);
        assert!(red.y > 0.2, "{red}");
    }
}
