//! Subdivision surfaces: coarse faces that stand for a smooth limit surface.
//!
//! Faces are refined a number of times, then every point is moved to where endless refinement would
//! bring it, and gets the normal that the limit surface has there. Positions join as the faces do,
//! whatever seams their texture coordinates have; these are interpolated linearly within each face.
//!
//! # Source
//! Catmull & Clark 1978; Loop 1987 with his own weights; Hoppe et al. 1994 for creases; `DeRose`, Kass
//! & Truong 1998 for sharpness that fades; boundaries and corners as `edgeAndCorner` of `OpenSubdiv`.

mod topology;
mod rules;
mod refine;
mod limit;
mod masks;

use glam::{Vec2, Vec3};
use luxel_sdk::Choice;
use luxel_sdk::params::{BuildContext, Fault};

use self::topology::Level;
use super::net::{MOST_TRIANGLES, Net};
use super::polygons::Polygons;

/// How faces are refined.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Scheme {
    /// Catmull and Clark's: for faces of any number of corners, best for four.
    CatmullClark,
    /// Loop's: for triangles.
    Loop,
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings<'a> {
    /// How often faces are refined, at least once.
    pub(super) levels: u32,
    pub(super) scheme: Scheme,
    /// Two points and a sharpness each.
    pub(super) creases: &'a [f64],
}

/// Refines faces and brings their points to the limit surface, with its normals.
///
/// # Errors
/// Faces that the scheme does not take, a crease that is none, more triangles than there may be. That
/// it is not wanted any more.
pub(super) fn subdivide(
    faces: Polygons,
    settings: Settings<'_>,
    context: &dyn BuildContext,
) -> Result<Net, Vec<Fault>> {
    check(&faces, settings).map_err(|fault| vec![fault])?;
    let carried = (faces.uvs.clone(), faces.colors.clone());
    let level = Level::build(faces, settings.creases, context)?;
    refined(level, settings, carried, context)
        .map_err(|message| vec![Fault::mesh("subdivide", message)])
}

fn refined(
    mut level: Level,
    Settings { levels, scheme, .. }: Settings<'_>,
    (mut uvs, mut colors): (Vec<Vec2>, Vec<Vec3>),
    context: &dyn BuildContext,
) -> Result<Net, String> {
    for _ in 0..levels {
        uvs = refine::values(&level, scheme, &uvs, context)?;
        colors = refine::values(&level, scheme, &colors, context)?;
        level = refine::refine(&level, scheme, context)?;
    }
    let normals = limit::normals(&level, scheme, context)?;
    let places = limit::points(&level, scheme, context)?;
    level.into_net(places, (&uvs, &normals, &colors), context)
}

fn check(faces: &Polygons, settings: Settings<'_>) -> Result<(), Fault> {
    if faces.n_faces() == 0 {
        return Err(Fault::mesh("subdivide", "no face has an area to subdivide"));
    }
    if settings.scheme == Scheme::Loop
        && let Some(i) = faces.starts.windows(2).position(|face| face[1] - face[0] != 3)
    {
        let n = faces.starts[i + 1] - faces.starts[i];
        let message = format!(
            "a face has {n} corners, the first of them {}: `loop` takes triangles, `catmull_clark` all",
            faces.points[faces.corners[faces.starts[i] as usize] as usize]
        );
        return Err(Fault::mesh("scheme", message));
    }
    // Each corner becomes a quad, each triangle four; then every face becomes four.
    let first = match settings.scheme {
        Scheme::CatmullClark => 2 * faces.corners.len() as u64,
        Scheme::Loop => 4 * faces.n_faces() as u64,
    };
    let count = |levels: u32| first << (2 * (levels - 1));
    if count(settings.levels) <= MOST_TRIANGLES {
        return Ok(());
    }
    let (levels, n) = (settings.levels, count(settings.levels));
    let fits = (1..levels).rev().find(|levels| count(*levels) <= MOST_TRIANGLES).unwrap_or(0);
    let message = format!(
        "{levels} levels make {n} triangles, at most {MOST_TRIANGLES} may be: {fits} would fit"
    );
    Err(Fault::mesh("subdivide", message))
}

#[cfg(test)]
mod tests;
