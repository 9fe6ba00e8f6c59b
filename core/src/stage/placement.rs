//! Geometry in its place: rays into its frame, points back into the world.

use luxel_sdk::kind::Hit;
use luxel_sdk::num::{Bounds3, Transform};

use super::motion::Motion;
use crate::scene::NodeId;

/// What a placement's surface scatters with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skin {
    /// A material of the stage, by index.
    Material(u32),
    /// Nothing: light that arrives is lost. Lamps without a material.
    Black,
    /// Nothing: rays pass as if it were not there. The boundary of a medium.
    Open,
}

/// From a frame to the world.
#[derive(Clone, Debug)]
pub enum Place {
    /// They are the same.
    Here,
    /// It stands.
    Fixed(Box<Transform>),
    /// It moves.
    Moving(Box<Moving>),
}

/// How something moves while the shutter is open.
#[derive(Clone, Debug)]
pub struct Moving {
    motion: Motion,
    /// Where it is when the shutter opens.
    first: Transform,
}

impl Place {
    /// Of something that stands.
    pub(super) fn fixed(transform: Transform) -> Self {
        Self::Fixed(Box::new(transform))
    }

    /// Of something that moves, seen from `time` on; `None` where it cannot be undone then.
    pub(super) fn moving(motion: Motion, time: f64) -> Option<Self> {
        let first = motion.at(time)?;
        Some(Self::Moving(Box::new(Moving { motion, first })))
    }

    /// Whether it moves.
    pub fn is_moving(&self) -> bool {
        matches!(self, Self::Moving(_))
    }

    /// Where it is at a time in seconds, made in `room` if it moves; `None` where it is made.
    #[inline(always)]
    pub fn at<'a>(&'a self, time: f64, room: &'a mut Option<Transform>) -> Option<&'a Transform> {
        match self {
            Self::Here => None,
            Self::Fixed(transform) => Some(transform),
            Self::Moving(moving) => Some(room.insert(moving.at(time))),
        }
    }

    /// Where it is when the shutter opens.
    pub fn first(&self) -> Option<&Transform> {
        match self {
            Self::Here => None,
            Self::Fixed(transform) => Some(transform),
            Self::Moving(moving) => Some(&moving.first),
        }
    }

    /// A box around where the points of a box are in an interval of time.
    pub fn bounds(&self, local: Bounds3, during: [f64; 2]) -> Bounds3 {
        match self {
            Self::Here => local,
            Self::Fixed(transform) => local.transform(transform.affine()),
            Self::Moving(moving) => moving.motion.bounds(local, during),
        }
    }
}

impl Moving {
    /// Apart: few rays need it, and it would take registers from all others. Rotations and stretches
    /// without a reflection can be undone, but for products of them that are flat to rounding: these
    /// are left where the shutter opened.
    #[inline(never)]
    fn at(&self, time: f64) -> Transform {
        self.motion.at(time).unwrap_or(self.first)
    }
}

/// Geometry in its place.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Which geometry of the stage.
    pub geometry: u32,
    /// From the geometry's frame to the world.
    pub place: Place,
    /// How it scatters.
    pub skin: Skin,
    /// Which light of the stage it is.
    pub light: Option<u32>,
    /// Which medium of the stage fills it.
    pub interior: Option<u32>,
    /// Whether it encloses a volume, so that rays that pass it change what they are in: found only
    /// where that matters.
    pub closed: bool,
    /// Whether its material has an index of refraction, so that light bends on its way in.
    pub bends: bool,
    /// Its `priority`, as the scene gives it.
    pub priority: u32,
    /// Which counts where closed placements overlap: the highest. All differ where it matters.
    pub rank: u32,
    /// The node of the shape.
    pub node: NodeId,
}

/// The primitive that a ray leaves: a flat one cannot be met again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaving {
    /// Which placement.
    pub placement: u32,
    /// Which of its faces.
    pub face: u32,
}

impl Leaving {
    /// A face that no geometry has: a ray that leaves it may meet any.
    pub const NO_FACE: u32 = u32::MAX;

    /// The face that is passed where it is on this placement.
    pub fn face_on(from: Option<Self>, placement: u32) -> Option<u32> {
        from.filter(|from| from.placement == placement).map(|from| from.face)
    }
}

impl From<&SceneHit> for Leaving {
    fn from(hit: &SceneHit) -> Self {
        Self { placement: hit.placement, face: hit.hit.face }
    }
}

/// Where a ray met the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneHit {
    /// Which placement.
    pub placement: u32,
    /// Where on it; `t` is along the world's ray.
    pub hit: Hit,
}

impl SceneHit {
    /// This hit, which is no farther than the last one, but for one as near of a placement that comes
    /// first: which of equal faces is seen does not depend on the order in which they are met.
    #[inline(always)]
    pub(super) fn or_before(self, last: Option<Self>) -> Option<Self> {
        let is_tie = |last: &Self| last.hit.t <= self.hit.t && last.placement < self.placement;
        last.filter(is_tie).or(Some(self))
    }
}
