//! From lanes to linear sRGB.

use glam::DVec3;
use luxel_sdk::color::{Observer, RgbSpace, Spectrum, Wavelengths, to_xyz};
use luxel_sdk::kind::Output;

use crate::stage::Stage;

/// What samples become.
pub(super) struct Develop {
    spectral: bool,
    observer: Observer,
    from_xyz: glam::DMat3,
}

impl Develop {
    pub(super) fn new(stage: &Stage, output: Output) -> Self {
        Self {
            spectral: stage.mode.is_spectral() && output == Output::Value,
            observer: stage.film.observer,
            from_xyz: RgbSpace::LinearSrgb.from_xyz(),
        }
    }

    pub(super) fn is_spectral(&self) -> bool {
        self.spectral
    }

    pub(super) fn sample(&self, l: Spectrum, lambda: &Wavelengths) -> DVec3 {
        if self.spectral {
            self.from_xyz * to_xyz(self.observer, l, lambda)
        } else {
            l.rgb().as_dvec3()
        }
    }
}
