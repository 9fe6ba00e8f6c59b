//! Displacement: triangles are split finely, and each place is moved along its normal by what a
//! texture says.
//!
//! A place that several corners share moves once, by the mean of what the texture says at each of
//! them and along the mean of their normals: seams stay closed.

mod tessellate;

use glam::{DVec3, Vec2};
use luxel_sdk::kind::TextureRef;
use luxel_sdk::params::{BuildContext, Fault};

use self::tessellate::tessellate;
use super::Shading;
use super::assemble::angle;
use super::net::{MOST_TRIANGLES, Net};
use crate::stop::{gather, go_on, wanted};

/// What is asked for.
#[derive(Clone, Copy)]
pub(super) struct Settings<'a> {
    pub(super) texture: TextureRef<'a>,
    /// How far a value of one moves, metres.
    pub(super) by: f64,
    /// The value that does not move.
    pub(super) from: f64,
    /// Longest edge before anything moves, metres.
    pub(super) edge: f64,
}

/// Splits and moves triangles; their normals are made anew.
///
/// # Errors
/// An edge that would make more triangles than there may be; a texture that fails. That it is not wanted
/// any more.
pub(super) fn displace(
    mut net: Net,
    settings: Settings<'_>,
    smooth: Shading,
    context: &dyn BuildContext,
) -> Result<Net, Vec<Fault>> {
    let stopped = |message| vec![Fault::mesh("displace", message)];
    give_normals(&mut net, smooth, context).map_err(stopped)?;
    let edge = settings.edge;
    let net = tessellate(net, edge, MOST_TRIANGLES, context).map_err(|many| {
        let n = if many.triangles < 1e15 {
            format!("about {:.0}", many.triangles)
        } else {
            "far too many".to_owned()
        };
        let fits = many.fits.map_or("no edge".to_owned(), |fits| format!("{fits:.2e} m"));
        let message = format!(
            "an edge of {edge} m makes {n} triangles, at most {MOST_TRIANGLES} may be: \
             {fits} would fit"
        );
        vec![Fault::mesh("edge", message)]
    })?;
    go_on(context).map_err(stopped)?;
    let mut net = moved(net, settings, context)?;
    net.normals = vec![];
    if smooth != Shading::Flat {
        net.smoothen(context).map_err(stopped)?;
    }
    Ok(net)
}

/// Sees to it that each corner has a direction to move in.
fn give_normals(net: &mut Net, smooth: Shading, context: &dyn BuildContext) -> Result<(), String> {
    match smooth {
        Shading::Flat => net.flatten(context),
        _ if !net.normals.is_empty() => Ok(()),
        Shading::Smooth => net.smoothen(context),
        Shading::Keep => net.flatten(context),
    }
}

/// Moves each place.
fn moved(
    mut net: Net,
    settings: Settings<'_>,
    context: &dyn BuildContext,
) -> Result<Net, Vec<Fault>> {
    let stopped = |message| vec![Fault::mesh("displace", message)];
    let given = |corner: usize, face| {
        // A given normal without a direction leaves the face's.
        let n = net.normals[corner].as_dvec3();
        if n == DVec3::ZERO { face } else { n }
    };
    let along = net.mean_by_angle(given, context).map_err(stopped)?;
    let mut heights = vec![(0.0f64, 0u32); net.places.len()];
    let mut said: Vec<Option<(Vec2, f64)>> = vec![None; net.places.len()];
    let corners = net.triangles.as_flattened().iter().map(|i| *i as usize);
    for (corner, place) in wanted(corners.enumerate(), context) {
        let uv = net.uvs.get(corner).copied().unwrap_or(Vec2::ZERO);
        let value = match said[place] {
            Some((before, value)) if before == uv => value,
            _ => {
                let number = settings.texture.number(net.places[place], uv);
                let failed = "the texture has no number at some place of the surface";
                let number = number.filter(|x| x.is_finite());
                f64::from(number.ok_or_else(|| vec![Fault::mesh("displace", failed)])?)
            }
        };
        said[place] = Some((uv, value));
        heights[place].0 += value;
        heights[place].1 += 1;
    }
    let places = net.places.iter_mut().zip(along).zip(heights);
    for ((place, along), (sum, n)) in wanted(places, context) {
        if n > 0 {
            *place += along * (settings.by * (sum / f64::from(n) - settings.from));
        }
    }
    go_on(context).map_err(stopped)?;
    Ok(net)
}

impl Net {
    /// Gives each corner the normal of its triangle.
    fn flatten(&mut self, context: &dyn BuildContext) -> Result<(), String> {
        let each = |t: &[u32; 3]| [self.face_normal(*t).as_vec3(); 3];
        self.normals = gather(self.triangles.iter().flat_map(each), context)?;
        Ok(())
    }

    /// Gives the corners of each place the mean of its triangles' normals, weighted by their angles
    /// there; zero where they have none.
    ///
    /// # Source
    /// Thürmer & Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets".
    fn smoothen(&mut self, context: &dyn BuildContext) -> Result<(), String> {
        let of_places = self.mean_by_angle(|_, face| face, context)?;
        let corners = self.triangles.as_flattened().iter();
        self.normals = gather(corners.map(|i| of_places[*i as usize].as_vec3()), context)?;
        Ok(())
    }

    /// For each place the mean of a vector of its corners, weighted by their angles; `vector` is
    /// given the corner, counted over all triangles, and the normal of its triangle.
    fn mean_by_angle(
        &self,
        vector: impl Fn(usize, DVec3) -> DVec3,
        context: &dyn BuildContext,
    ) -> Result<Vec<DVec3>, String> {
        let mut sums = vec![DVec3::ZERO; self.places.len()];
        for (i, triangle) in wanted(self.triangles.iter().enumerate(), context) {
            let face = self.face_normal(*triangle);
            let p = triangle.map(|i| self.places[i as usize]);
            for k in 0..3 {
                let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                sums[triangle[k] as usize] += vector(3 * i + k, face) * angle(a, b);
            }
        }
        gather(sums.into_iter().map(DVec3::normalize_or_zero), context)
    }
}

#[cfg(test)]
mod tests;
