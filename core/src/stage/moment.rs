//! The stage at one moment.

use std::ops::Deref;

use super::Stage;

/// What stands and moves as it is at one time. Every path sees one moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'s> {
    pub(super) stage: &'s Stage,
    /// Seconds.
    pub time: f64,
}

impl Stage {
    /// The stage at a time in seconds: within the interval in which the shutter is open.
    #[inline(always)]
    pub fn at(&self, time: f64) -> Moment<'_> {
        Moment { stage: self, time }
    }

    /// The stage when the shutter opens.
    pub fn opening(&self) -> Moment<'_> {
        self.at(self.film.time)
    }

    /// The time of a path; `u` uniform in [0, 1).
    #[inline(always)]
    pub fn time_of(&self, u: f32) -> f64 {
        self.film.time + self.film.shutter * f64::from(u)
    }
}

impl Deref for Moment<'_> {
    type Target = Stage;

    #[inline(always)]
    fn deref(&self) -> &Stage {
        self.stage
    }
}
