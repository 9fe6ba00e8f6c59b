//! Squares of two colours.

use glam::Vec2;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Texture, TexturePoint};

/// A chessboard over the uv coordinates.
///
/// ```scene
/// let board = texture checker { a = 0.1, b = 0.8, scale = (8, 8) }
/// let floor = material diffuse { reflectance = board }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Checker {
    /// Colour of the square at (0, 0).
    #[param(default = 0.2, textured)]
    a: Spectrum,
    /// Colour of its neighbours.
    #[param(default = 0.8, textured)]
    b: Spectrum,
    /// Squares in a unit of uv.
    #[param(default = [8.0, 8.0])]
    scale: Vec2,
}

impl Texture for Checker {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        let place = (at.uv.as_dvec2() * self.scale.as_dvec2()).floor();
        let odd = (place.x.rem_euclid(2.0) - place.y.rem_euclid(2.0)).abs() > 0.5;
        if odd { self.b } else { self.a }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use luxel_sdk::color::Wavelengths;

    use super::*;

    #[test]
    fn neighbours_differ_and_diagonals_agree() {
        let board = Checker { a: Spectrum::ZERO, b: Spectrum::ONE, scale: Vec2::splat(2.0) };
        let at = |u: f32, v: f32| {
            let lambda = Wavelengths::sample(0.5);
            board.eval(&TexturePoint { p: DVec3::ZERO, uv: Vec2::new(u, v), lambda }).is_black()
        };
        assert!(at(0.2, 0.2) && at(0.7, 0.7) && at(-0.2, -0.2) && at(1e30, f32::NAN));
        assert!(!at(0.7, 0.2) && !at(-0.2, 0.2) && !at(0.2, -0.2));
    }
}
