//! Scattered numbers for the tests of this room, which stands below `sampling` and cannot use it.

use glam::DVec3;

/// A fixed sequence: multiples of the golden ratio, mod 1, from a place of `seed`'s choice.
pub(super) struct Points {
    x: f64,
}

impl Points {
    pub(super) fn new(seed: u32) -> Self {
        Self { x: f64::from(seed) * 0.123_456_7 }
    }

    /// In [0, 1). Irrational steps of growing phase keep neighbours unrelated.
    pub(super) fn f64(&mut self) -> f64 {
        self.x += 0.618_033_988_749_894_9;
        (self.x * self.x * 7919.0).fract()
    }

    /// A point of the cube [-1, 1)³, all of whose octants occur.
    pub(super) fn cube(&mut self) -> DVec3 {
        DVec3::new(self.f64(), self.f64(), self.f64()) * 2.0 - 1.0
    }

    /// A unit vector.
    pub(super) fn unit(&mut self) -> DVec3 {
        self.cube().normalize_or(DVec3::Z)
    }
}
