//! The axis-aligned box.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::Fault;

use super::spherical::{NEAR, SphericalRectangle};

/// A closed box along the axes; `transform` turns it.
///
/// Each face carries the whole texture, upright on the four sides.
///
/// ```scene
/// shape box "crate" {
///   size      = (40, 60, 40) cm
///   transform = [rotate((0, 1, 0), 30 deg), move((0, 0.3, 0) m)]
///   material  = wood
/// }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Box {
    /// The middle.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) center: DVec3,
    /// Whole edges along x, y and z; each greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) size: DVec3,
}

/// For each face (2 · axis, + 1 for the positive side) the axes of `u` and `v`, and the sign of
/// `u`'s; `v`'s is positive but on the top, so that `u` × `v` is the outer normal.
const FACES: [(usize, f64, usize, f64); 6] = [
    (2, 1.0, 1, 1.0),
    (2, -1.0, 1, 1.0),
    (0, 1.0, 2, 1.0),
    (0, 1.0, 2, -1.0),
    (0, -1.0, 1, 1.0),
    (0, 1.0, 1, 1.0),
];

impl Shape for Box {
    fn check(&self) -> Result<(), Fault> {
        if self.size.cmpgt(DVec3::ZERO).all() {
            return Ok(());
        }
        Err(Fault::range("size", format!("edges of {} m: each must exceed 0", self.size)))
    }

    fn bounds(&self) -> Bounds3 {
        super::bounds_about(self.center, 0.5 * self.size)
    }

    /// Slabs: the last entry against the first exit. Exact planes, so that a ray through an edge
    /// enters and leaves once.
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (o, half) = (ray.o - self.center, 0.5 * self.size);
        let (mut enter, mut leave) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for axis in 0..3 {
            let (o, d, half) = (o[axis], ray.d[axis], half[axis]);
            if d == 0.0 {
                if o.abs() <= half {
                    continue;
                }
                return None;
            }
            let (low, high) = ((-half - o) / d, (half - o) / d);
            let (near, far) = if d > 0.0 {
                ((low, 2 * axis), (high, 2 * axis + 1))
            } else {
                ((high, 2 * axis + 1), (low, 2 * axis))
            };
            if near.0.is_nan() || far.0.is_nan() {
                return None;
            }
            enter = if near.0 > enter.0 { near } else { enter };
            leave = if far.0 < leave.0 { far } else { leave };
        }
        let (t, face) = if enter.0 > 0.0 { enter } else { leave };
        let (u, u_sign, v, v_sign) = FACES[face];
        let at = |axis: usize| (o[axis] + ray.d[axis] * t).clamp(-half[axis], half[axis]);
        let at = DVec2::new(u_sign * at(u), v_sign * at(v));
        let found = enter.0 <= leave.0 && t > 0.0 && t <= ray.t_max && t < f64::INFINITY;
        found.then_some(Hit { t, at, face: u32::from(face_code(face)) })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.face as usize, hit.at)
    }

    fn area(&self) -> f64 {
        self.face_areas(None).iter().sum()
    }

    /// A face by the solid angle that it fills, and uniform in that, from near enough outside; over the
    /// area of the faces that can be seen from afar, and of all from within.
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let faces = self.faces(from);
        let total: f64 = faces.iter().map(|face| face.weight).sum();
        // Spends the first number on the face, and what is left of it on the place.
        let mut rest = f64::from(u[0]) * total;
        let mut face = 0;
        for (i, seen) in faces.iter().enumerate().filter(|(_, seen)| seen.weight > 0.0) {
            face = i;
            if rest < seen.weight {
                break;
            }
            rest -= seen.weight;
        }
        let across = (rest / faces[face].weight).clamp(0.0, 1.0);
        let (u_axis, u_sign, v_axis, v_sign) = FACES[face];
        let half = 0.5 * DVec2::new(self.size[u_axis], self.size[v_axis]);
        let at = match &faces[face].angle {
            Some((rectangle, foot)) => rectangle.sample([across, f64::from(u[1])]) - *foot,
            None => (DVec2::new(across, f64::from(u[1])) - 0.5) * (2.0 * half),
        };
        let at = at.clamp(-half, half) * DVec2::new(u_sign, v_sign);
        let surface = self.surface_at(face, at);
        let pdf = self.density(&faces, from, &surface);
        (pdf > 0.0 && pdf.is_finite()).then_some(ShapeSample { surface, pdf })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        self.density(&self.faces(from), from, at)
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        let out = (p - self.center).abs() - 0.5 * self.size;
        Some(out.max(DVec3::ZERO).length() + out.max_element().min(0.0))
    }

    fn normal_derivatives(&self, _hit: &Hit, _at: &Surface) -> Option<NormalDerivatives> {
        Some(NormalDerivatives::FLAT)
    }
}

/// The face as the smallest integer that widens without loss.
#[expect(clippy::cast_possible_truncation, reason = "a face is below 6")]
fn face_code(face: usize) -> u8 {
    face as u8
}

/// Least solid angle, sr, for which a face that is seen is chosen.
const LEAST: f64 = 1e-5;

/// What a viewer sees of a face.
#[derive(Default)]
struct Seen {
    /// The share with which it is chosen; 0 for one that is not seen.
    weight: f64,
    /// Its solid angle, and where its middle is from the viewer's foot; without, it is sampled by area.
    angle: Option<(SphericalRectangle, DVec2)>,
}

impl Box {
    /// Areas of the faces that face the viewer; of all without one or with one inside.
    fn face_areas(&self, from: Option<DVec3>) -> [f64; 6] {
        let s = self.size;
        let area = [s.y * s.z, s.z * s.x, s.x * s.y];
        let all = std::array::from_fn(|face| area[face / 2]);
        let Some(from) = from else { return all };
        let seen: [f64; 6] = std::array::from_fn(|face| {
            if self.height_above(face, from) > 0.0 { area[face / 2] } else { 0.0 }
        });
        if seen.iter().any(|a| *a > 0.0) { seen } else { all }
    }

    /// How far a place is outside of the plane of a face.
    fn height_above(&self, face: usize, place: DVec3) -> f64 {
        let o = (place - self.center)[face / 2];
        (if face % 2 == 1 { o } else { -o }) - 0.5 * self.size[face / 2]
    }

    fn faces(&self, from: Option<DVec3>) -> [Seen; 6] {
        let areas = self.face_areas(from);
        let by_area = || areas.map(|weight| Seen { weight, angle: None });
        let Some(from) = from else { return by_area() };
        let o = from - self.center;
        let outside = (o.abs() - 0.5 * self.size).max_element() > 0.0;
        if !outside || areas.iter().sum::<f64>() < NEAR * o.length_squared() {
            return by_area();
        }
        std::array::from_fn(|face| {
            if areas[face] <= 0.0 {
                return Seen::default();
            }
            let (u, _, v, _) = FACES[face];
            let (foot, half) =
                (-DVec2::new(o[u], o[v]), 0.5 * DVec2::new(self.size[u], self.size[v]));
            let height = self.height_above(face, from);
            if let Some(seen) = SphericalRectangle::new(foot - half, foot + half, height) {
                return Seen { weight: seen.solid_angle, angle: Some((seen, foot)) };
            }
            // Next to nothing, or next to half of everything: what its middle says.
            let d2 = foot.length_squared() + height * height;
            let angle = areas[face] * height / (d2 * d2.sqrt());
            Seen { weight: angle.clamp(LEAST, TAU), angle: None }
        })
    }

    /// Density over the area, m⁻², of a point that is sampled by a viewer who sees these faces.
    fn density(&self, faces: &[Seen; 6], from: Option<DVec3>, at: &Surface) -> f64 {
        let axis = at.ng.abs().max_position();
        let face = 2 * axis + usize::from(at.ng[axis] > 0.0);
        let total: f64 = faces.iter().map(|face| face.weight).sum();
        match (&faces[face].angle, from) {
            (Some(_), Some(from)) => {
                let to = from - at.p;
                let d2 = to.length_squared();
                to[axis].abs() / (d2 * d2.sqrt() * total)
            }
            _ => {
                faces[face].weight / (total * self.size[(axis + 1) % 3] * self.size[(axis + 2) % 3])
            }
        }
    }

    /// The point of a face at `at`, metres about its middle along its `u` and `v`.
    ///
    /// Error: about the centre the plane is exact, so only the sum rounds, and once more the
    /// difference where a ray starts; twice that keeps clear of the plane.
    fn surface_at(&self, face: usize, at: DVec2) -> Surface {
        let (axis, side) = (face / 2, if face % 2 == 1 { 1.0 } else { -1.0 });
        let (u_axis, u_sign, v_axis, v_sign) = FACES[face];
        let mut local = DVec3::ZERO;
        local[axis] = side * 0.5 * self.size[axis];
        local[u_axis] = u_sign * at.x;
        local[v_axis] = v_sign * at.y;
        let axis_vector = |axis: usize, length: f64| {
            let mut v = DVec3::ZERO;
            v[axis] = length;
            v
        };
        let ng = axis_vector(axis, side);
        Surface {
            p: self.center + local,
            p_err: (self.center.abs() + local.abs()) * gamma64(4),
            ng,
            ns: ng,
            uv: at / DVec2::new(self.size[u_axis], self.size[v_axis]) + 0.5,
            dp_du: axis_vector(u_axis, u_sign * self.size[u_axis]),
            dp_dv: axis_vector(v_axis, v_sign * self.size[v_axis]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::testing::{
        check_convex, check_sampling, check_solid_angle, solid_angle, visible_area,
    };

    fn residual(b: &Box, p: DVec3) -> f64 {
        ((p - b.center).abs() - 0.5 * b.size).max_element().abs()
    }

    #[test]
    fn hits_and_offsets_hold_at_every_scale_and_distance() {
        for (center, scale) in [
            (DVec3::ZERO, 1.0),
            (DVec3::new(1e6, -1e6, 1e6), 1.0),
            (DVec3::ONE, 1e-6),
            (DVec3::splat(3.0), 1e6),
        ] {
            let b = Box { center, size: DVec3::new(1.0, 2.0, 3.0) * scale };
            check_convex(&b, 31, |p| residual(&b, p));
        }
    }

    #[test]
    fn each_face_is_hit_from_outside_and_inside() {
        let b = Box { center: DVec3::ONE, size: DVec3::new(2.0, 4.0, 6.0) };
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let mut n = DVec3::ZERO;
                n[axis] = side;
                for (o, d) in [(b.center + n * 10.0, -n), (b.center, n)] {
                    let ray = Ray::new(o, d);
                    let at = b.surface(&ray, &b.intersect(&ray).unwrap());
                    assert_eq!(at.ng, n);
                    assert_eq!(at.uv, DVec2::splat(0.5));
                    assert!(residual(&b, at.p) <= 0.0);
                }
            }
        }
    }

    #[test]
    fn rays_through_edges_and_corners_enter_and_leave_once() {
        let b = Box { center: DVec3::ZERO, size: DVec3::splat(2.0) };
        for o in [DVec3::new(-3.0, 1.0, 0.0), DVec3::new(-3.0, 1.0, 1.0)] {
            let hit = b.intersect(&Ray::new(o, DVec3::X)).unwrap();
            assert!((hit.t - 2.0).abs() <= 0.0);
        }
        let corner = Ray::new(DVec3::splat(-3.0), DVec3::ONE);
        assert!((b.intersect(&corner).unwrap().t - 2.0).abs() <= 0.0);
        let past = Ray::new(DVec3::new(-3.0, 1.0f64.next_up(), 0.0), DVec3::X);
        assert!(b.intersect(&past).is_none());
    }

    #[test]
    fn samples_cover_what_is_seen() {
        let b = Box { center: DVec3::ONE, size: DVec3::new(1.0, 2.0, 3.0) };
        for from in [None, Some(DVec3::ONE), Some(DVec3::new(4.0, 5.0, 6.0)), Some(DVec3::X * 9.0)]
        {
            check_sampling(&b, from, 32);
        }
        assert!((b.area() - 22.0).abs() <= 1e-14);
        let seen = visible_area(&b, Some(DVec3::splat(5.0)), 3, 33).mean;
        assert!((seen - 11.0).abs() <= 1e-14);
        check_solid_angle(&b, DVec3::new(3.0, 1.5, 1.0), 34);
    }

    #[test]
    fn near_boxes_are_sampled_by_the_solid_angles_of_their_faces() {
        let b = Box { center: DVec3::ONE, size: DVec3::new(1.0, 2.0, 3.0) };
        let at = |x: f64, y: f64, z: f64| DVec3::ONE + DVec3::new(x, y, z);
        for (k, from) in (0..).zip([
            at(0.9, 1.5, -2.0),
            at(0.7, 0.2, 0.1),
            at(0.501, -0.3, 1.6),
            at(-0.55, 0.1, 1.4),
            at(0.2, -1.3, 0.4),
        ]) {
            check_sampling(&b, Some(from), 35 + k);
            check_solid_angle(&b, from, 50 + 2 * k);
        }
        // All that is seen is found alike: one sample tells the solid angle.
        let from = at(0.9, 1.5, -2.0);
        let near = solid_angle(&b, from, 1000, 45);
        assert!(near.standard_error() <= 1e-9 * near.mean, "{}", near.standard_error());
    }

    #[test]
    fn flat_boxes_are_refused() {
        let b = Box { center: DVec3::ZERO, size: DVec3::new(1.0, 0.0, 1.0) };
        assert_eq!(b.check().unwrap_err().field, "size");
    }
}
