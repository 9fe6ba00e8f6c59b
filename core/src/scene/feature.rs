//! What a scene may require of a render beyond what every scene does.

/// Something that chooses code when a scene is rendered: modelled only where it is required.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Feature {
    /// Light by wavelength instead of RGB.
    Spectral,
    /// Something absorbs or scatters between surfaces.
    Media,
    /// Some surfaces are only the boundary of a medium, and rays pass them.
    OpenSurfaces,
    /// Refracting shapes may lie within each other.
    Nested,
    /// Something moves while the shutter is open.
    Motion,
    /// There are several lights, or triangles of one, to choose from.
    LightChoice,
    /// Something is recorded beside colour.
    Layers,
}

impl Feature {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Spectral,
        Self::Media,
        Self::OpenSurfaces,
        Self::Nested,
        Self::Motion,
        Self::LightChoice,
        Self::Layers,
    ];

    /// As the command line calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spectral => "spectral",
            Self::Media => "media",
            Self::OpenSurfaces => "open_surfaces",
            Self::Nested => "nested",
            Self::Motion => "motion",
            Self::LightChoice => "light_choice",
            Self::Layers => "layers",
        }
    }

    /// The feature of that name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|feature| feature.name() == name)
    }

    /// Whether its code is in this program: not where the cargo feature `without_` and its name is on,
    /// to measure what that code costs scenes that do without.
    pub(crate) const fn is_compiled(self) -> bool {
        match self {
            Self::Spectral => cfg!(not(feature = "without_spectral")),
            Self::Media => cfg!(not(feature = "without_media")),
            Self::OpenSurfaces => cfg!(not(feature = "without_open_surfaces")),
            Self::Nested => cfg!(not(feature = "without_nested")),
            Self::Motion => cfg!(not(feature = "without_motion")),
            Self::LightChoice => cfg!(not(feature = "without_light_choice")),
            Self::Layers => cfg!(not(feature = "without_layers")),
        }
    }

    /// Why it is left out where no scene requires it.
    pub fn absent(self) -> &'static str {
        match self {
            Self::Spectral => "every colour is given as RGB, so nothing depends on wavelength",
            Self::Media => "nothing fills a shape or the space around",
            Self::OpenSurfaces => "no surface is only the boundary of a medium",
            Self::Nested => "no refracting shape overlaps another one",
            Self::Motion => "nothing moves while the shutter is open",
            Self::LightChoice => "one light at most is looked for, in one piece",
            Self::Layers => "nothing is recorded beside colour",
        }
    }

    /// What is modelled instead where it is dropped.
    ///
    /// # Errors
    /// Why it cannot be dropped.
    pub fn dropped(self) -> Result<&'static str, &'static str> {
        match self {
            Self::Spectral => Ok("light is carried as RGB"),
            Self::Media => Ok("there is vacuum between surfaces"),
            Self::OpenSurfaces => Err("the boundary of a medium would be seen: drop `media`"),
            Self::Nested => Ok("each refracting shape is as if alone"),
            Self::Motion => Ok("everything stands as when the shutter opens"),
            Self::LightChoice => Err("the light of the others would be missing"),
            Self::Layers => Ok("nothing but colour is recorded"),
        }
    }

    /// Why it cannot be required without changing the picture, if it cannot.
    pub fn unrequirable(self) -> Option<&'static str> {
        match self {
            Self::Spectral => Some("it would change the picture: write `film spectral`"),
            Self::Layers => Some("there are several: say which by --aov"),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_feature_is_found_by_its_name_and_no_other() {
        for feature in Feature::ALL {
            assert_eq!(Feature::of_name(feature.name()), Some(feature));
        }
        assert_eq!(Feature::of_name("fog"), None);
    }
}
