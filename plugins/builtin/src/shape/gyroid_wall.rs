//! The gyroid: a wall that divides space into two equal mazes.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, Surface};
use luxel_sdk::num::{Bounds3, Ray, sphere_roots};
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

use super::implicit::{Field, Look, Way, area_by_lines, march, surface_of, turns_of};

/// A wall in the form of a gyroid, cut out by a ball: closed. It divides space into two mazes that
/// are each other's mirror image and never meet.
///
/// Its thickness is about that which is given: from 0.8 times to 1.6 times. With `intersection` it
/// fills other shapes. Texture coordinates are two of the three axes. As a lamp it is found by chance
/// alone.
///
/// ```scene
/// shape gyroid_wall { radius = 1 m, cell = 50 cm, thickness = 3 cm, material = paint }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct GyroidWall<'a> {
    /// The middle of the ball.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) center: DVec3,
    /// Of the ball that cuts it out; greater than 0.
    #[param(default = 1.0, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) radius: f64,
    /// Length after which the wall repeats itself: a quarter of the radius or more; half of it
    /// unless given.
    #[param(optional, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) cell: f64,
    /// Of the wall: a ten-thousandth of a cell or more; a tenth unless given. From half a cell on it
    /// fills the ball.
    #[param(optional, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) thickness: f64,
    #[param(shared)]
    pub(crate) area: Shared<'a, OnceLock<f64>>,
}

impl Build<OnceLock<f64>> for GyroidWall<'_> {
    fn build(&self, _context: &dyn BuildContext) -> Result<OnceLock<f64>, Vec<Fault>> {
        Ok(OnceLock::new())
    }
}

/// What the gradient of sin x cos y + sin y cos z + sin z cos x never exceeds.
///
/// Its first component, cos x cos y − sin z sin x, is a product of (cos x, sin x), which is unit, and
/// (cos y, −sin z): its square is at most cos² y + sin² z. Taken so from (cos x, sin x), (cos y,
/// sin y) and (cos z, sin z) in turn, the three squares add up to no more than all cos² and sin²
/// together: 3. At the origin it is that.
const STEEPEST: f64 = 1.7320508075688774;
/// What the second derivative of the flattened function along a unit direction never exceeds, times
/// cell / 2π: sin x cos y is (sin(x + y) + sin(x − y)) / 2, whose second derivative along d is at most
/// ((dx + dy)² + (dx − dy)²) / 2 = dx² + dy². The three together: 2.
const BEND: f64 = 2.0 / STEEPEST;
/// A typical steepness on the wall's middle, where it is from 0.86 to `STEEPEST`: thickness is
/// counted by it.
const TYPICAL: f64 = 1.4;
/// Least cell, in radii: a line then meets the wall less than 64 times.
const SMALLEST: f64 = 0.25;
/// Least thickness, in cells: far above what a march tells apart.
const THINNEST: f64 = 1e-4;

impl Shape for GyroidWall<'_> {
    fn check(&self) -> Result<(), Fault> {
        super::check_length("radius", self.radius)?;
        let (cell, thickness) = (self.cell(), self.thickness());
        super::check_length("cell", cell)?;
        super::check_length("thickness", thickness)?;
        if cell < SMALLEST * self.radius {
            let least = SMALLEST * self.radius;
            let message = format!("a cell of {cell} m: at least {least} m for this radius");
            return Err(Fault::range("cell", message));
        }
        if thickness < THINNEST * cell {
            let least = THINNEST * cell;
            let message = format!("a wall of {thickness} m: at least {least} m for this cell");
            return Err(Fault::range("thickness", message));
        }
        Ok(())
    }

    fn bounds(&self) -> Bounds3 {
        super::bounds_about(self.center, DVec3::splat(self.radius))
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        march(self, &self.bounds(), ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        surface_of(self, &self.bounds(), ray, hit)
    }

    /// By lines along the axes, to about a thousandth.
    fn area(&self) -> f64 {
        let first = |ray: &Ray| Some(self.surface(ray, &self.intersect(ray)?));
        *self.area.get_or_init(|| area_by_lines(&self.bounds(), first))
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        Some(self.value(p))
    }

    fn normal_derivatives(&self, _hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        turns_of(self, &self.bounds(), at)
    }
}

impl Field for GyroidWall<'_> {
    type Known = ();

    fn value(&self, p: DVec3) -> f64 {
        let q = p - self.center;
        let (g, _) = self.gyroid(q);
        // Of two such functions the larger one is one.
        (g.abs() - self.half()).max(q.length() - self.radius)
    }

    fn gradient(&self, p: DVec3, _step: f64) -> DVec3 {
        let q = p - self.center;
        let (g, slope) = self.gyroid(q);
        if q.length() - self.radius > g.abs() - self.half() {
            return q.normalize();
        }
        slope * g.signum()
    }

    fn bend(&self, p: DVec3, d: DVec3, _size: f64, _error: f64) -> Option<DVec3> {
        let q = p - self.center;
        let (g, _) = self.gyroid(q);
        let far = q.length();
        if far - self.radius > g.abs() - self.half() {
            let n = q / far;
            return Some((d - n * n.dot(d)) / far);
        }
        let k = TAU / self.cell();
        let (s, c) = ((q * k).map(f64::sin), (q * k).map(f64::cos));
        let (xy, yz, zx) = (-c.x * s.y, -c.y * s.z, -c.z * s.x);
        let own = -DVec3::new(s.x * c.y + s.z * c.x, s.y * c.z + s.x * c.y, s.z * c.x + s.y * c.z);
        let across = DVec3::new(xy * d.y + zx * d.z, xy * d.x + yz * d.z, zx * d.x + yz * d.y);
        Some((own * d + across) * (k / STEEPEST * g.signum()))
    }

    /// Along a line the gyroid's function bends by no more than `BEND`, so that its value and its slope
    /// bound it ahead; the ball's chord is known.
    fn look(&self, way: &Way, s: f64, (): &mut ()) -> Look {
        let q = way.at(s) - self.center;
        let (g, slope) = self.gyroid(q);
        let (half, ball) = (self.half(), q.length() - self.radius);
        let value = (g.abs() - half).max(ball);
        let (rise, bend) = (slope.dot(way.d), BEND * TAU / self.cell());
        let above = |gap: f64, rise: f64| if gap > 0.0 { stays(gap, rise, bend) } else { 0.0 };
        let roots = sphere_roots(q, way.d, self.radius);
        // In the wall both of its sides bound it, outside of it the nearer one.
        let free = if value > 0.0 {
            let before = roots.map_or(f64::INFINITY, |(enter, leave)| {
                if leave < 0.0 { f64::INFINITY } else { enter - way.error }
            });
            let wall = above(g.abs() - half, rise * g.signum());
            if ball > 0.0 { wall.max(before) } else { wall }
        } else {
            let wall = above(half - g, -rise).min(above(half + g, rise));
            wall.min(roots.map_or(0.0, |(_, leave)| leave - way.error))
        };
        Look { value, free: free.max(value.abs()), met: false }
    }
}

/// How far ahead a gap stays open that grows at a rate, where that changes by `bend` a metre at most:
/// the positive root of gap + rise·s − bend·s² / 2.
fn stays(gap: f64, rise: f64, bend: f64) -> f64 {
    let root = (rise * rise + 2.0 * bend * gap).sqrt();
    if rise > 0.0 { (rise + root) / bend } else { 2.0 * gap / (root - rise) }
}

impl GyroidWall<'_> {
    /// The gyroid's function, made so flat that it is a distance, and its gradient.
    fn gyroid(&self, q: DVec3) -> (f64, DVec3) {
        let k = TAU / self.cell();
        let (s, c) = ((q * k).map(f64::sin), (q * k).map(f64::cos));
        let g = s.x * c.y + s.y * c.z + s.z * c.x;
        let slope = DVec3::new(c.x * c.y - s.z * s.x, c.y * c.z - s.x * s.y, c.z * c.x - s.y * s.z);
        (g / (k * STEEPEST), slope / STEEPEST)
    }

    /// What the function is on the wall's sides.
    fn half(&self) -> f64 {
        0.5 * self.thickness() * (TYPICAL / STEEPEST)
    }

    fn cell(&self) -> f64 {
        if self.cell > 0.0 { self.cell } else { 0.5 * self.radius }
    }

    fn thickness(&self) -> f64 {
        if self.thickness > 0.0 { self.thickness } else { 0.1 * self.cell() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::implicit::differences;
    use crate::shape::testing::direction;
    use luxel_sdk::num::offset_origin;
    use luxel_sdk::sampling::Rng;

    fn wall(area: &OnceLock<f64>, center: DVec3, scale: f64) -> GyroidWall<'_> {
        let area = Shared::new(area);
        GyroidWall { center, radius: scale, cell: 0.6 * scale, thickness: 0.05 * scale, area }
    }

    #[test]
    fn its_gradient_is_bounded_as_the_distance_needs_it() {
        let area = OnceLock::new();
        let g = wall(&area, DVec3::ZERO, 1.0);
        let mut rng = Rng::new(91);
        let (mut steepest, mut flattest) = (0.0f64, f64::INFINITY);
        for _ in 0..200_000 {
            let q = direction(&mut rng) * rng.f64();
            let (f, d) = g.gyroid(q);
            steepest = steepest.max(d.length());
            if f.abs() < 1e-3 {
                flattest = flattest.min(d.length());
            }
            let across = differences(|q| g.gyroid(q).0, q, 1e-5);
            assert!((across - d).length() < 1e-8, "{across} {d}");
            let moved = q + direction(&mut rng) * (0.1 * rng.f64());
            let change = (g.value(q) - g.value(moved)).abs();
            assert!(change <= q.distance(moved) * (1.0 + 1e-12));
        }
        assert!(steepest <= 1.0 + 1e-12 && steepest > 0.99, "{steepest}");
        assert!(flattest > 0.8 / STEEPEST, "{flattest}");
    }

    #[test]
    fn points_lie_on_it_and_rays_cross_it_in_turn_at_every_scale_and_place() {
        let mut rng = Rng::new(92);
        for (place, scale) in [
            (DVec3::ZERO, 1.0),
            (DVec3::new(1e6, -1e6, 1e6), 1.0),
            (DVec3::ZERO, 1e-6),
            (DVec3::ZERO, 1e6),
        ] {
            let area = OnceLock::new();
            let g = wall(&area, place, scale);
            let mut n_hits = 0;
            for _ in 0..300 {
                let d = direction(&mut rng);
                let target = place + direction(&mut rng) * (scale * rng.f64());
                let (mut o, mut inside) = (target - d * (3.0 * scale), false);
                let mut grazes = false;
                while let Some(hit) = g.intersect(&Ray::new(o, d)) {
                    let ray = Ray::new(o, d);
                    let s = g.surface(&ray, &hit);
                    let slack = s.p_err.max_element();
                    assert!(g.value(s.p).abs() <= slack && slack < 1e-6 * scale, "{slack}");
                    // At the rim, where wall and ball meet, differences see both.
                    grazes |= s.ng.dot(d).abs() < 1e-2;
                    let rim = (s.p - place).length() > (1.0 - 1e-3) * scale;
                    assert!(grazes || rim || (s.ng.dot(d) > 0.0) == inside, "{ray:?}");
                    inside = !inside;
                    o = offset_origin(s.p, s.p_err, s.ng, d);
                    n_hits += 1;
                }
                assert!(grazes || !inside, "{target} {d}: entered and not left");
            }
            assert!(n_hits > 1000, "{n_hits}");
        }
    }

    #[test]
    fn cells_and_walls_out_of_proportion_are_refused() {
        let area = OnceLock::new();
        let g = wall(&area, DVec3::ZERO, 1.0);
        assert!(g.check().is_ok());
        assert_eq!(GyroidWall { cell: 0.1, ..g }.check().unwrap_err().field, "cell");
        assert!(GyroidWall { thickness: 9.0, ..g }.check().is_ok());
        assert_eq!(GyroidWall { thickness: 1e-9, ..g }.check().unwrap_err().field, "thickness");
        assert_eq!(GyroidWall { radius: 0.0, ..g }.check().unwrap_err().field, "radius");
    }
}
