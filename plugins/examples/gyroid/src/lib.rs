//! An implicit surface with bounds, as a plugin: the gyroid, met by a march that cannot miss it.

mod line;

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, sphere_roots};
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

use crate::line::Line;

/// The gyroid: a sheet that divides space into two equal mazes, cut out by a ball. Both sides show;
/// it has no inside.
///
/// ```scene
/// shape gyroid { radius = 1 m, cell = 50 cm, material = material diffuse {} }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct Gyroid<'a> {
    /// Of the ball that cuts it out, about the origin.
    #[param(default = 1.0, unit = "m", min = 1e-12, max = 1e12)]
    radius: f64,
    /// Length after which the sheet repeats itself; at least a fiftieth of the radius.
    #[param(default = 1.0, unit = "m", min = 1e-12, max = 1e12)]
    cell: f64,
    #[param(shared)]
    area: Shared<'a, f64>,
}

/// Lines along each axis, per side, by which the area is measured: to about a thousandth.
const LINES: u32 = 160;

impl Build<f64> for Gyroid<'_> {
    /// Area by lines along the axes. A crossing stands for the area that it and its neighbours share,
    /// 1/(|nx| + |ny| + |nz|) of a line's own, so that no line counts for more than its square.
    fn build(&self, context: &dyn BuildContext) -> Result<f64, Vec<Fault>> {
        let step = 2.0 * self.radius / f64::from(LINES);
        let mut area = 0.0;
        for i in 0..LINES {
            if context.cancelled() {
                break;
            }
            for j in 0..LINES {
                let at = |i: u32| (f64::from(i) + 0.5) * step - self.radius;
                let (u, v, far) = (at(i), at(j), -2.0 * self.radius);
                let lines = [
                    (DVec3::new(far, u, v), DVec3::X),
                    (DVec3::new(v, far, u), DVec3::Y),
                    (DVec3::new(u, v, far), DVec3::Z),
                ];
                for (o, d) in lines {
                    area += self.along(&Ray::new(o, d)) * step * step;
                }
            }
        }
        Ok(area)
    }
}

impl Gyroid<'_> {
    /// 2π per cell.
    fn k(&self) -> f64 {
        std::f64::consts::TAU / self.cell
    }

    /// The part of a ray inside the ball, from its origin on.
    fn inside(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (enter, leave) = sphere_roots(ray.o, ray.d, self.radius)?;
        (leave > 0.0).then_some((enter.max(0.0), leave))
    }

    /// What the crossings of a line count for.
    fn along(&self, ray: &Ray) -> f64 {
        let Some((enter, leave)) = self.inside(ray) else { return 0.0 };
        let ray = Ray { o: ray.at(enter), ..*ray };
        let (line, mut sum, mut from) = (Line::new(&ray, self.k()), 0.0, 0.0);
        while let Some(t) = line.root(from, leave - enter) {
            let n = self.gradient(ray.at(t)).normalize().abs();
            sum += 1.0 / (n.x + n.y + n.z);
            from = t + 1e-9 * self.cell;
        }
        sum
    }

    /// Of f = sin kx cos ky + sin ky cos kz + sin kz cos kx, over k. On the sheet it is longer than
    /// .8.
    fn gradient(&self, p: DVec3) -> DVec3 {
        let p = p * self.k();
        let (s, c) = (p.map(f64::sin), p.map(f64::cos));
        DVec3::new(c.x * c.y - s.z * s.x, c.y * c.z - s.x * s.y, c.z * c.x - s.y * s.z)
    }

    fn value(&self, p: DVec3) -> f64 {
        let p = p * self.k();
        p.x.sin() * p.y.cos() + p.y.sin() * p.z.cos() + p.z.sin() * p.x.cos()
    }
}

impl Shape for Gyroid<'_> {
    fn check(&self) -> Result<(), Fault> {
        if self.cell >= 0.02 * self.radius {
            return Ok(());
        }
        let least = 0.02 * self.radius;
        Err(Fault::range(
            "cell",
            format!("a cell of {} m, at least {least} m is needed", self.cell),
        ))
    }

    fn bounds(&self) -> Bounds3 {
        // Points of the sheet are found to within their error; so much wider is the box.
        let half = DVec3::splat(self.radius * (1.0 + 1e-13));
        Bounds3::of_points([-half, half])
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (enter, leave) = self.inside(ray)?;
        // From where it enters: from afar the ray's own parameter is too coarse to march by.
        let inner = Ray { o: ray.at(enter), ..*ray };
        let t = enter + Line::new(&inner, self.k()).root(0.0, leave - enter)?;
        (t > 0.0 && t <= ray.t_max).then_some(Hit { t, at: DVec2::ZERO, face: 0 })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        // A step of Newton's across the sheet takes away what the ray's parameter rounds.
        let mut p = ray.at(hit.t);
        let gradient = self.gradient(p);
        p -= gradient * (self.value(p) / (gradient.length_squared() * self.k()));
        let ng = self.gradient(p).normalize();
        // The three products and their arguments round to 16 halves of an ulp together, over a
        // gradient of at least .8 k; and a ray that starts here rounds its own way as far.
        let rounds = 32.0 * f64::EPSILON * (1.0 + self.k() * p.abs().max_element());
        let p_err = DVec3::splat(rounds / (0.8 * self.k())) + p.abs() * f64::EPSILON;
        let (uv, dp_du, dp_dv) = flat_coordinates(p, ng, self.radius);
        Surface { p, p_err, ng, ns: ng, uv, dp_du, dp_dv }
    }

    fn area(&self) -> f64 {
        *self.area
    }

    /// None: as a lamp it is found by chance alone.
    fn sample(&self, _from: Option<DVec3>, _u: [f32; 2]) -> Option<ShapeSample> {
        None
    }

    fn pdf(&self, _from: Option<DVec3>, _at: &Surface) -> f64 {
        0.0
    }
}

/// The two coordinates across which the surface is flattest, in radii.
fn flat_coordinates(p: DVec3, n: DVec3, scale: f64) -> (DVec2, DVec3, DVec3) {
    let axis = n.abs().max_position();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let along = |i: usize| {
        let mut d = DVec3::AXES[i];
        d[axis] = -n[i] / n[axis];
        d * scale
    };
    (DVec2::new(p[u], p[v]) / scale, along(u), along(v))
}

luxel_sdk::plugin! { shape "gyroid" => Gyroid<'_>; }
