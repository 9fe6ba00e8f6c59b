//! Solids made of two others: union, intersection, difference.
//!
//! With sharp edges a ray is walked from crossing to crossing of both parts (`walk`). With a blend
//! between them the distances of both are blended, and the ray marches (`field`).

mod field;
mod walk;

#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeRef, Surface};
use luxel_sdk::num::{Bounds3, Ray};
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

use super::implicit::{area_by_lines, march, surface_of, turns_of};
use field::Blend;

/// What is inside the whole, given what is inside its parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Op {
    /// Either.
    Union,
    /// Both.
    Intersection,
    /// The first without the second.
    Difference,
}

impl Op {
    fn holds(self, in_a: bool, in_b: bool) -> bool {
        match self {
            Self::Union => in_a || in_b,
            Self::Intersection => in_a && in_b,
            Self::Difference => in_a && !in_b,
        }
    }
}

/// Two parts and how they are joined.
#[derive(Clone, Copy)]
struct Pair<'s> {
    op: Op,
    a: ShapeRef<'s>,
    b: ShapeRef<'s>,
    smooth: f64,
    bounds: Bounds3,
    /// Whether each knows its distance, and so does not cross itself: 1 or 0.
    plain: [u32; 2],
}

impl<'s> Pair<'s> {
    fn found_plain(a: &ShapeRef<'_>, b: &ShapeRef<'_>) -> [u32; 2] {
        [a, b].map(|part| u32::from(part.distance(part.bounds().centre()).is_some()))
    }

    fn blend(&self) -> Blend<'s> {
        Blend::new(self.op, self.a, self.b, self.smooth)
    }

    fn found_bounds(op: Op, a: &ShapeRef<'_>, b: &ShapeRef<'_>, smooth: f64) -> Bounds3 {
        let (of_a, of_b) = (a.bounds(), b.bounds());
        match op {
            // Blended, it swells by a quarter of the blend at most: see `Blend`.
            Op::Union => {
                let both = of_a.union(of_b);
                let swell = DVec3::splat(0.25 * smooth * (1.0 + 8.0 * f64::EPSILON));
                Bounds3 { min: both.min - swell, max: both.max + swell }
            }
            Op::Intersection => {
                Bounds3 { min: of_a.min.max(of_b.min), max: of_a.max.min(of_b.max) }
            }
            Op::Difference => of_a,
        }
    }

    fn check(op: Op, a: &ShapeRef<'_>, b: &ShapeRef<'_>, smooth: f64) -> Result<(), Fault> {
        for (field, part) in [("a", a), ("b", b)] {
            if !part.is_closed() {
                let message = format!(
                    "`{field}` encloses no volume: a part is a closed shape, as a sphere, a box or \
                     another solid of parts"
                );
                return Err(Fault::range(field, message));
            }
            if !part.bounds().diagonal().is_finite() {
                return Err(Fault::range(field, format!("`{field}` has no end: a part has one")));
            }
            if smooth > 0.0 && part.distance(part.bounds().centre()).is_none() {
                let message = format!(
                    "`{field}` does not know its distance from a point, by which parts are blended: \
                     leave `smooth` out, or use spheres, boxes, capsules, cylinders with caps, tori \
                     and gyroid walls"
                );
                return Err(Fault::range(field, message));
            }
        }
        if (0.0..=super::LONGEST).contains(&smooth) {
            let bounds = Self::found_bounds(op, a, b, smooth);
            if bounds.min.cmple(bounds.max).all() {
                return Ok(());
            }
            return Err(Fault::range(
                "b",
                "`a` and `b` are too far apart to have a part in common",
            ));
        }
        Err(Fault::range(
            "smooth",
            format!("{smooth} m: it must be 0 or more, and a length that the world has room for"),
        ))
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if self.smooth > 0.0 {
            return march(&self.blend(), &self.bounds, ray);
        }
        walk::first(self, ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        if self.smooth > 0.0 {
            return surface_of(&self.blend(), &self.bounds, ray, hit);
        }
        walk::surface(self, ray, hit)
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        if self.smooth > 0.0 {
            return turns_of(&self.blend(), &self.bounds, at);
        }
        walk::normal_derivatives(self, hit, at)
    }

    fn area(&self) -> f64 {
        area_by_lines(&self.bounds, |ray| {
            let hit = self.intersect(ray)?;
            Some(self.surface(ray, &hit))
        })
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        self.blend().distance(p)
    }
}

/// The measured area, once someone has asked for it: only lamps do.
type Area = OnceLock<f64>;

macro_rules! solid {
    ($(#[$doc:meta])* $name:ident, $op:ident, $a:literal, $b:literal) => {
        $(#[$doc])*
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        pub(crate) struct $name<'a> {
            #[doc = $a]
            #[param(required)]
            a: ShapeRef<'a>,
            #[doc = $b]
            #[param(required)]
            b: ShapeRef<'a>,
            /// How wide the blend between both is; 0 m for a sharp edge.
            #[param(default = 0.0, unit = "m", min = 0.0)]
            smooth: f64,
            #[param(shared)]
            area: Shared<'a, Area>,
            /// The box around it.
            #[param(derived)]
            bounds: [DVec3; 2],
            /// Which parts know their distance.
            #[param(derived)]
            plain: [u32; 2],
        }

        impl Build<Area> for $name<'_> {
            fn build(&self, _context: &dyn BuildContext) -> Result<Area, Vec<Fault>> {
                Ok(Area::new())
            }
        }

        impl<'a> $name<'a> {
            fn pair(&self) -> Pair<'a> {
                let [min, max] = self.bounds;
                let Self { a, b, smooth, plain, .. } = *self;
                Pair { op: Op::$op, a, b, smooth, bounds: Bounds3 { min, max }, plain }
            }
        }

        impl Shape for $name<'_> {
            fn prepare(&mut self) {
                let found = Pair::found_bounds(Op::$op, &self.a, &self.b, self.smooth);
                self.bounds = [found.min, found.max];
                self.plain = Pair::found_plain(&self.a, &self.b);
            }

            fn check(&self) -> Result<(), Fault> {
                Pair::check(Op::$op, &self.a, &self.b, self.smooth)
            }

            fn bounds(&self) -> Bounds3 {
                let [min, max] = self.bounds;
                Bounds3 { min, max }
            }

            fn intersect(&self, ray: &Ray) -> Option<Hit> {
                self.pair().intersect(ray)
            }

            fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
                self.pair().surface(ray, hit)
            }

            /// By lines along the axes, to about a thousandth.
            fn area(&self) -> f64 {
                *self.area.get_or_init(|| self.pair().area())
            }

            fn is_closed(&self) -> bool {
                true
            }

            fn distance(&self, p: DVec3) -> Option<f64> {
                self.pair().distance(p)
            }

            fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
                self.pair().normal_derivatives(hit, at)
            }
        }
    };
}

solid! {
    /// What is inside of either of two closed shapes, as one solid: what lies between them is gone,
    /// so that glass has no skins inside.
    ///
    /// The parts have their own `transform`; material and interior are those of the whole. Parts may
    /// be solids of parts themselves. As a lamp it is found by chance alone.
    ///
    /// ```scene
    /// shape union "snowman" {
    ///   a        = shape sphere { radius = 40 cm }
    ///   b        = shape sphere { center = (0, 55, 0) cm, radius = 28 cm }
    ///   smooth   = 15 cm
    ///   material = white
    /// }
    /// ```
    Union, Union, "One closed shape.", "The other one."
}
solid! {
    /// What two closed shapes have in common: of two balls a lens, whose edge is exact.
    ///
    /// The parts have their own `transform`; material and interior are those of the whole. Parts may
    /// be solids of parts themselves. As a lamp it is found by chance alone.
    ///
    /// ```scene
    /// shape intersection "lentil" {
    ///   a        = shape sphere { center = (0, 9, 0) cm, radius = 10 cm }
    ///   b        = shape sphere { center = (0, -9, 0) cm, radius = 10 cm }
    ///   material = wood
    /// }
    /// ```
    Intersection, Intersection, "One closed shape.", "The other one."
}
solid! {
    /// A closed shape from which another one is cut.
    ///
    /// The parts have their own `transform`; material and interior are those of the whole. Parts may
    /// be solids of parts themselves. As a lamp it is found by chance alone.
    ///
    /// ```scene
    /// shape difference "bowl" {
    ///   a        = shape box { size = (30, 12, 30) cm }
    ///   b        = shape sphere { center = (0, 10, 0) cm, radius = 14 cm }
    ///   material = wood
    /// }
    /// ```
    Difference, Difference, "What is cut: a closed shape.", "What is taken away: a closed shape."
}
