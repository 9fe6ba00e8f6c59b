//! The ray that crosses every shape interface.

use glam::DVec3;

/// A half line, cut at `t_max`: the points `o` + t `d` with 0 < t < `t_max`.
///
/// `d` need not be unit length: a placement's inverse carries rays into a shape's own frame
/// unnormalised, so that `t` means the same on both sides. `t` counts multiples of `d`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Origin, metres.
    pub o: DVec3,
    /// Direction, any finite length above zero.
    pub d: DVec3,
    /// End of the ray in multiples of `d`; infinity if it has none.
    pub t_max: f64,
}

impl Ray {
    /// The unbounded ray from `o` along `d`.
    pub const fn new(o: DVec3, d: DVec3) -> Self {
        Self { o, d, t_max: f64::INFINITY }
    }

    /// The point at parameter `t`, in metres.
    pub fn at(&self, t: f64) -> DVec3 {
        self.o + self.d * t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_counts_t_in_multiples_of_its_direction() {
        let ray = Ray::new(DVec3::X, DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(ray.at(3.0), DVec3::new(1.0, 6.0, 0.0));
        assert!(ray.t_max.is_infinite());
    }
}
