//! Curves: hair, grass, fibres, wires and ribbons, exact along cubics.

mod cubic;
mod ribbon;
mod strand;
#[cfg(test)]
mod tests;
mod tube;

use std::sync::Arc;

use glam::DVec2;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, Surface};
use luxel_sdk::num::{Bounds3, Ray};
use luxel_sdk::params::{Build, BuildContext, Fault, Shared, Table};
use luxel_sdk::{Choice, Params};

use self::strand::{Line, Strand, Strands};

/// How points make a curve.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Basis {
    /// Cubic Bézier segments that share their ends: 4, 7, 10 … points to a strand.
    Bezier,
    /// A uniform cubic B-spline, smooth throughout, which begins and ends beside its second and
    /// last but one point: 4 or more points to a strand.
    Bspline,
}

/// What a strand is made of.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Form {
    /// A solid rod with round ends: all that is within the radius of the curve.
    Round,
    /// A strip without thickness, twice the radius wide.
    Ribbon,
}

/// Strands along cubic curves: hair, grass, fibres, wires; or ribbons.
///
/// A round strand is everything that a ball sweeps as it moves along the curve and its radius
/// changes: closed, with round ends, however sharply it bends. A ribbon lies between its two edges,
/// whose points are those of the curve, a radius to either side. Texture coordinates: `u` along the
/// strand, in equal shares for its segments, `v` around or across. A light cannot shine from it.
///
/// ```scene
/// shape curves "wire" {
///   points = #[ 0 0 0  0 30 0  40 60 0  40 90 0 ] mm, radius = 1 mm, material = gold
/// }
/// shape curves "grass" {
///   points  = #[ 0 0 0  0 30 0  5 60 0  20 80 0   30 0 0  30 40 0  30 60 9  25 90 20 ] mm
///   strands = #[ 4 ], form = "ribbon", radii = #[ 2 2 1 0  2 2 1 0 ] mm, material = paint
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Curves<'a> {
    /// x y z of each point, strand by strand.
    #[param(required, unit = "m")]
    points: Table<'a>,
    /// Half the thickness everywhere.
    #[param(optional, unit = "m", group = "thickness", min = f64::MIN_POSITIVE)]
    radius: f64,
    /// Half the thickness at each point, 0 or more, blended as the points are.
    #[param(optional, unit = "m", group = "thickness")]
    radii: Table<'a>,
    /// Points of each strand; a single number for strands of as many points each. Without, there is
    /// one strand.
    #[param(optional)]
    strands: Table<'a>,
    /// How the points make a curve.
    #[param(choice, default = Basis::Bezier)]
    basis: Basis,
    /// What a strand is made of.
    #[param(choice, default = Form::Round)]
    form: Form,
    /// Where a ribbon faces at each point: x y z of any length. Without, it begins level and does
    /// not twist more than its curve.
    #[param(optional)]
    normals: Table<'a>,
    #[param(shared)]
    table: Shared<'a, Arc<Strands>>,
}

impl Build<Arc<Strands>> for Curves<'_> {
    fn build(&self, context: &dyn BuildContext) -> Result<Arc<Strands>, Vec<Fault>> {
        let given = strand::Given {
            points: self.points.get(),
            radius: self.radius,
            radii: self.radii.get(),
            strands: self.strands.get(),
            normals: self.normals.get(),
            basis: self.basis,
            form: self.form,
        };
        given.strands(context).map(Arc::new).map_err(|fault| vec![fault])
    }
}

impl Curves<'_> {
    fn of(&self, strand: &Strand, ray: &Ray) -> Option<Hit> {
        let line = Line::of(strand, ray)?;
        let (t, at, face) = match self.form {
            Form::Round => {
                let (t, s, face) = tube::intersect(strand, &line)?;
                (t, DVec2::new(s, 0.0), face)
            }
            Form::Ribbon => ribbon::intersect(strand, &line)?,
        };
        (t <= ray.t_max && t < f64::INFINITY).then_some(Hit {
            t,
            at,
            face: 2 * strand.first + face,
        })
    }
}

impl Shape for Curves<'_> {
    fn bounds(&self) -> Bounds3 {
        self.table.bounds
    }

    /// One strand after the other: the host, which knows the parts, does better.
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        super::axial::length_of(ray)?;
        let (mut found, mut ray) = (None, *ray);
        for strand in &self.table.strands {
            if strand.bounds.intersect_ray(ray.o, ray.d.recip(), ray.t_max).is_none() {
                continue;
            }
            if let Some(hit) = self.of(strand, &ray).filter(|h| found.is_none() || h.t < ray.t_max)
            {
                ray.t_max = hit.t;
                found = Some(hit);
            }
        }
        found
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let strand = self.table.of_segment(hit.face / 2);
        let segment = (hit.face / 2).saturating_sub(strand.first).min(strand.count() - 1);
        match self.form {
            Form::Round => tube::surface(strand, ray, (segment, hit.face & 1 == 1), hit.at.x),
            Form::Ribbon => ribbon::surface(strand, segment, hit.at),
        }
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let strand = self.table.of_segment(hit.face / 2);
        let segment = (hit.face / 2).saturating_sub(strand.first).min(strand.count() - 1);
        match self.form {
            Form::Round => tube::normal_derivatives(strand, segment, hit.at.x, at),
            Form::Ribbon => ribbon::normal_derivatives(strand, segment, hit.at, at),
        }
    }

    fn area(&self) -> f64 {
        f64::INFINITY
    }

    fn is_closed(&self) -> bool {
        self.form == Form::Round
    }

    fn parts(&self) -> u32 {
        u32::try_from(self.table.strands.len()).unwrap_or(0)
    }

    fn part_bounds(&self, part: u32) -> Bounds3 {
        self.table.strands.get(part as usize).map_or(Bounds3::EMPTY, |strand| strand.bounds)
    }

    fn intersect_part(&self, part: u32, ray: &Ray) -> Option<Hit> {
        self.of(self.table.strands.get(part as usize)?, ray)
    }
}
