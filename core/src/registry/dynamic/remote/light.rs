use std::mem::{MaybeUninit, offset_of};

use glam::{DVec3, Vec2};
use luxel_sdk::abi::LightTable;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample, Output};

use super::material::is_light;
use super::texture::output;
use super::{Head, NO_BOOL, is_bool};

/// A library's light.
#[repr(transparent)]
pub(super) struct RemoteLight(Head);

// SAFETY: the SDK demands of lights that they are `Send + Sync`.
unsafe impl Send for RemoteLight {}
// SAFETY: as above.
unsafe impl Sync for RemoteLight {}

const DARK: Escaped = Escaped { le: Spectrum::ZERO, pdf: 0.0 };

impl RemoteLight {
    #[inline(always)]
    fn table(&self) -> &'static LightTable {
        // SAFETY: the view was made for lights.
        unsafe { self.0.table() }
    }

    #[inline(always)]
    fn lit(&self, le: Spectrum) -> Spectrum {
        if is_light(le) {
            return le;
        }
        self.0.wrong("gave light that is negative or not finite");
        Spectrum::ZERO
    }
}

impl Light for RemoteLight {
    fn form(&self) -> LightForm {
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        match self.0.found(unsafe { self.table().form(self.0.at()) }) {
            Some(0) => LightForm::Surface,
            Some(1) => LightForm::Point,
            Some(2) => LightForm::Infinite,
            Some(3) => LightForm::Everywhere,
            _ => {
                self.0.wrong("gave a form of light that is none");
                LightForm::Point
            }
        }
    }

    #[inline(always)]
    fn le(&self, cos_o: f32, uv: Vec2, area: f64) -> Spectrum {
        if self.0.is_poisoned() {
            return Spectrum::ZERO;
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().le)(self.0.at(), cos_o, &uv, area, &mut out) };
        if !self.0.is_ok(status) {
            return Spectrum::ZERO;
        }
        // SAFETY: the library has written a result.
        self.lit(unsafe { out.assume_init() })
    }

    #[inline(always)]
    fn sample(&self, query: &LightQuery) -> Option<LightSample> {
        if self.0.is_poisoned() {
            return None;
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().sample)(self.0.at(), query, &mut out) };
        if !self.0.is_ok(status) {
            return None;
        }
        // SAFETY: where it says.
        if !unsafe { is_bool(&out, offset_of!(LightSample, delta)) } {
            self.0.wrong(NO_BOOL);
            return None;
        }
        // SAFETY: as above.
        let LightSample { le, wi, distance, pdf, delta } = *unsafe { out.assume_init_ref() };
        if wi.is_normalized() && distance > 0.0 && pdf > 0.0 && pdf < f32::INFINITY {
            return Some(LightSample { le: self.lit(le), wi, distance, pdf, delta });
        }
        self.0.wrong("gave a sample that is not finite or not of unit length");
        None
    }

    fn escaped(&self, d: DVec3) -> Escaped {
        if self.0.is_poisoned() {
            return DARK;
        }
        // SAFETY: as above.
        let found = self.0.found(unsafe { self.table().escaped(self.0.at(), &d) });
        let found = found.unwrap_or(DARK);
        if found.pdf >= 0.0 && found.pdf.is_finite() {
            return Escaped { le: self.lit(found.le), ..found };
        }
        self.0.wrong("gave a density that is negative or not finite");
        DARK
    }

    fn power(&self, area: f64, scene_radius: f64) -> f32 {
        // SAFETY: as above.
        let found = self.0.found(unsafe { self.table().power(self.0.at(), area, scene_radius) });
        let power = found.unwrap_or(0.0);
        if power >= 0.0 {
            return power;
        }
        self.0.wrong("gave a power that is negative or no number");
        0.0
    }

    fn output(&self) -> Output {
        // SAFETY: as above.
        output(&self.0, self.0.found(unsafe { self.table().output(self.0.at()) }))
    }
}
