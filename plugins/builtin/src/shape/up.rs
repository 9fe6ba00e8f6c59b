//! Which way is up in a file.

use glam::{DMat3, DVec3};
use luxel_sdk::Choice;

/// The axis of a file that points up; scenes have +Y up.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Up {
    /// +X is up.
    X,
    /// +Y is up, as in scenes and glTF.
    Y,
    /// +Z is up, as in CAD.
    Z,
}

impl Up {
    /// The rotation from the file's axes to the scene's: whole numbers, so exact.
    pub(crate) fn turn(self) -> DMat3 {
        match self {
            Self::X => DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z),
            Self::Y => DMat3::IDENTITY,
            Self::Z => DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_turn_is_a_rotation_that_takes_up_to_y() {
        for (up, axis) in [(Up::X, DVec3::X), (Up::Y, DVec3::Y), (Up::Z, DVec3::Z)] {
            let turn = up.turn();
            assert_eq!(turn * axis, DVec3::Y);
            assert_eq!(turn * turn.transpose(), DMat3::IDENTITY);
            assert!(turn.determinant() > 0.0);
        }
    }
}
