//! Displacement: triangles are split finely, and each place is moved along its normal by what a
//! texture says.
//!
//! A place that several corners share moves once, by the mean of what the texture says at each of
//! them and along the mean of their normals: seams stay closed.

mod tessellate;

use glam::{DVec3, Vec2};
use luxel_sdk::kind::TextureRef;
use luxel_sdk::params::Fault;

use self::tessellate::tessellate;
use super::Shading;
use super::assemble::angle;
use super::net::{MOST_TRIANGLES, Net};

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
/// An edge that would make more triangles than there may be; a texture that fails.
pub(super) fn displace(
    mut net: Net,
    settings: Settings<'_>,
    smooth: Shading,
) -> Result<Net, Vec<Fault>> {
    give_normals(&mut net, smooth);
    let edge = settings.edge;
    let net = tessellate(net, edge, MOST_TRIANGLES).map_err(|many| {
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
    let mut net = moved(net, settings)?;
    net.normals = vec![];
    if smooth != Shading::Flat {
        let normals = net.place_normals();
        net.set_normals(&normals);
    }
    Ok(net)
}

/// Sees to it that each corner has a direction to move in.
fn give_normals(net: &mut Net, smooth: Shading) {
    if smooth == Shading::Flat {
        net.flatten();
    } else if net.normals.is_empty() {
        if smooth == Shading::Smooth {
            let normals = net.place_normals();
            net.set_normals(&normals);
        } else {
            net.flatten();
        }
    }
}

/// Moves each place.
fn moved(mut net: Net, settings: Settings<'_>) -> Result<Net, Vec<Fault>> {
    let along = net.mean_by_angle(|corner, face| {
        // A given normal without a direction leaves the face's.
        let n = net.normals[corner].as_dvec3();
        if n == DVec3::ZERO { face } else { n }
    });
    let mut heights = vec![(0.0f64, 0u32); net.places.len()];
    let mut said: Vec<Option<(Vec2, f64)>> = vec![None; net.places.len()];
    for (corner, place) in net.triangles.iter().flatten().map(|i| *i as usize).enumerate() {
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
    for ((place, along), (sum, n)) in net.places.iter_mut().zip(along).zip(heights) {
        if n > 0 {
            *place += along * (settings.by * (sum / f64::from(n) - settings.from));
        }
    }
    Ok(net)
}

impl Net {
    /// Gives each corner the normal of its triangle.
    fn flatten(&mut self) {
        let each = |t: &[u32; 3]| [self.face_normal(*t).as_vec3(); 3];
        self.normals = self.triangles.iter().flat_map(each).collect();
    }

    /// For each place the mean of its triangles' normals, weighted by their angles there; zero where
    /// they have none.
    ///
    /// # Source
    /// Thürmer & Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets".
    fn place_normals(&self) -> Vec<DVec3> {
        self.mean_by_angle(|_, face| face)
    }

    /// For each place the mean of a vector of its corners, weighted by their angles; `vector` is
    /// given the corner, counted over all triangles, and the normal of its triangle.
    fn mean_by_angle(&self, vector: impl Fn(usize, DVec3) -> DVec3) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.places.len()];
        for (i, triangle) in self.triangles.iter().enumerate() {
            let face = self.face_normal(*triangle);
            let p = triangle.map(|i| self.places[i as usize]);
            for k in 0..3 {
                let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                sums[triangle[k] as usize] += vector(3 * i + k, face) * angle(a, b);
            }
        }
        sums.into_iter().map(DVec3::normalize_or_zero).collect()
    }

    /// Gives the corners of each place one normal.
    fn set_normals(&mut self, of_places: &[DVec3]) {
        let corners = self.triangles.iter().flatten();
        self.normals = corners.map(|i| of_places[*i as usize].as_vec3()).collect();
    }
}

#[cfg(test)]
mod tests;
