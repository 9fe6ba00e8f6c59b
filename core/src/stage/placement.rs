//! Geometry in its place: rays into its frame, points back into the world.

use glam::DVec3;
use luxel_sdk::kind::Hit;
use luxel_sdk::num::Transform;

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

/// Geometry in its place.
#[derive(Clone, Debug)]
pub struct Placement {
    /// Which geometry of the stage.
    pub geometry: u32,
    /// From the geometry's frame to the world; `None` where they are the same.
    pub transform: Option<Box<Transform>>,
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

impl Placement {
    /// A point of the world in the geometry's frame.
    #[inline]
    pub fn point_to_local(&self, p: DVec3) -> DVec3 {
        match &self.transform {
            Some(transform) => transform.inverse_point(p),
            None => p,
        }
    }

    /// How much larger an area whose local unit normal is `ng` is in the world.
    pub fn area_scale(&self, ng: DVec3) -> f64 {
        self.transform.as_ref().map_or(1.0, |transform| transform.area_scale(ng))
    }
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
