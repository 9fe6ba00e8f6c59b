//! What a user trades: speed for accuracy of where rays meet triangles.

use luxel_sdk::Choice;

/// How rays meet the triangles of meshes. Analytic shapes, placements and origins of rays are in
/// double precision whatever this says.
#[derive(Choice, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Precision {
    /// Möller–Trumbore in single precision, boxes without slack: rays may slip between triangles.
    Fast,
    /// Watertight in single precision about the mesh's centre.
    #[default]
    Standard,
    /// Watertight in double precision, and hits with it.
    Exact,
}

impl Precision {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Standard, Self::Exact];

    /// As a scene writes it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Standard => "standard",
            Self::Exact => "exact",
        }
    }

    /// The one that is written so.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|precision| precision.word() == word)
    }
}
