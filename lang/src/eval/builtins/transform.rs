//! Transforms and views.

use std::ops::RangeInclusive;
use std::rc::Rc;

use glam::{DAffine3, DMat3, DMat4, DVec3};
use luxel_core::diag::{Diagnostic, Span};
use luxel_core::scene::Pose;
use luxel_sdk::params::{Dimension, Look};

use super::{Call, Evaluator, Value};

/// Which function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Transform {
    Rotate,
    Move,
    Scale,
    Matrix,
    Motion,
    Spin,
    LookAt,
}

/// Steps of one transform, where some move: each costs time for every ray.
const MOST_STEPS: usize = 64;

/// Steps that one transform of a list takes: what the product of two matrices does.
const JOINED: u64 = 2;

/// Distances from a camera to what it looks at whose squares, and sums of them, are accurate.
const VIEWS: RangeInclusive<f64> = 1e-150..=1e150;

/// A vector made unit, whatever its length; `None` without a direction.
fn direction(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    let scaled = || (largest > 0.0 && v.is_finite()).then(|| (v / largest).normalize());
    v.try_normalize().or_else(scaled)
}

impl Evaluator<'_> {
    /// Makes a transform or a view.
    pub(super) fn make_transform(&mut self, make: Transform, call: &mut Call<'_>) -> Value {
        let made = match make {
            Transform::Rotate => self.rotate(call).map(Pose::from),
            Transform::Move => {
                let by = self.vector_of(call, 0, Dimension::LENGTH);
                by.map(|by| DAffine3::from_translation(by).into())
            }
            Transform::Scale => self.scale(call).map(Pose::from),
            Transform::Matrix => self.matrix(call).map(Pose::from),
            Transform::Motion => self.motion(call),
            Transform::Spin => self.spin(call),
            Transform::LookAt => return self.look_at(call).unwrap_or(Value::Poison),
        };
        made.map_or(Value::Poison, |made| Value::Transform(Rc::new(made)))
    }

    fn rotate(&mut self, call: &Call<'_>) -> Option<DAffine3> {
        let axis = self.axis(call);
        let angle = self.number_arg(call, 1, Dimension::ANGLE);
        Some(DAffine3::from_axis_angle(axis?, angle?))
    }

    /// The axis of a rotation, which is given first, of any length.
    pub(super) fn axis(&mut self, call: &Call<'_>) -> Option<DVec3> {
        let (axis, dimension, span) = self.vector_arg(call, 0)?;
        if dimension == Dimension::ANGLE {
            let found = Diagnostic::error("E0202", span, "an axis is a direction, not angles");
            let help = "an angle about each axis is a turn each: `[rotate((1, 0, 0), 10 deg), …]`";
            self.tell(found.help(help));
            return None;
        }
        let axis = direction(axis.into());
        if axis.is_none() {
            self.poison("E0412", span, "the axis of a rotation has no direction");
        }
        axis
    }

    fn scale(&mut self, call: &Call<'_>) -> Option<DAffine3> {
        let arg = call.arg(0)?;
        let by = match arg.value {
            Value::Number(..) => DVec3::splat(self.number_arg(call, 0, Dimension::NONE)?),
            _ => self.vector_of(call, 0, Dimension::NONE)?,
        };
        if by.abs().min_element() > 0.0 {
            return Some(DAffine3::from_scale(by));
        }
        self.poison("E0412", arg.span, "a scale of zero leaves nothing");
        None
    }

    /// Sixteen numbers by rows, the last row 0 0 0 1; translations in metres.
    fn matrix(&mut self, call: &Call<'_>) -> Option<DAffine3> {
        let arg = call.arg(0)?;
        let rows = match &arg.value {
            Value::Numbers(n) if n.dimension.is_none() => <[f64; 16]>::try_from(&*n.data).ok(),
            _ => None,
        };
        let Some(rows) = rows else {
            let message = "`matrix` wants 16 numbers by rows, without a unit";
            self.poison("E0207", arg.span, message);
            return None;
        };
        let m = DMat4::from_cols_array(&rows).transpose();
        if m.row(3).to_array().map(f64::to_bits) != [0.0, 0.0, 0.0, 1.0_f64].map(f64::to_bits) {
            let message = "the last row of a transform is 0, 0, 0, 1";
            self.poison("E0412", arg.span, message);
            return None;
        }
        let affine = DAffine3::from_mat3_translation(DMat3::from_mat4(m), m.w_axis.truncate());
        self.invertible(affine, arg.span)
    }

    fn look_at(&mut self, call: &Call<'_>) -> Option<Value> {
        let [from, to] = [0, 1].map(|i| self.vector_of(call, i, Dimension::LENGTH));
        let up = self.vector_arg(call, 2);
        let (from, to, (up, _, _)) = (from?, to?, up?);
        let apart = to - from;
        let Some(view) = direction(apart) else {
            let same = from == to;
            let wrong = if same { "the same point" } else { "farther apart than can be measured" };
            let message = format!("`from` and `to` are {wrong}: there is no view");
            self.poison("E0412", call.span, message);
            return None;
        };
        let distance = apart.dot(view);
        if !VIEWS.contains(&distance) {
            let message = format!(
                "`from` and `to` are {distance:e} m apart: a view is between {:e} m and {:e} m long",
                VIEWS.start(),
                VIEWS.end()
            );
            self.poison("E0412", call.span, message);
            return None;
        }
        let up = DVec3::from_array(up);
        // Parallel to within the rounding of the cross product of unit vectors.
        let side = direction(up).map(|up| up.cross(view).length());
        if side.is_none_or(|side| side <= 4.0 * f64::EPSILON) {
            self.poison("E0412", call.span, "`up` is parallel to the view, or zero");
            return None;
        }
        // As written where its square is a number, else unit.
        let up = if up.try_normalize().is_some() { Some(up) } else { direction(up) }?;
        Some(Value::Look(Rc::new(Look { from, to, up })))
    }

    /// The transform that a field gives: one, or a list that is applied first to last.
    pub(in crate::eval) fn transform(&mut self, value: &Value, span: Span) -> Option<Pose> {
        let made = match value {
            Value::Transform(one) => Pose::clone(one),
            Value::Numbers(n) if n.data.is_empty() => Pose::Here,
            Value::Items(items) => {
                if !self.tick(items.items.len() as u64 * JOINED, span) {
                    return None;
                }
                let mut all = Pose::Here;
                for item in &items.items {
                    let Value::Transform(next) = item else {
                        return self.no_transform(item, span);
                    };
                    all = all.then(next);
                    if matches!(&all, Pose::Moving(steps) if steps.len() > MOST_STEPS) {
                        let message = format!("more than {MOST_STEPS} steps of a transform move");
                        self.poison("E0501", span, message);
                        return None;
                    }
                }
                all
            }
            other => return self.no_transform(other, span),
        };
        match made.fixed() {
            Some(fixed) => self.invertible(fixed, span).map(|_| made),
            None => Some(made),
        }
    }

    fn no_transform<T>(&mut self, found: &Value, span: Span) -> Option<T> {
        if !found.is_poison() {
            let message = format!(
                "a transform is a list of rotate, move, scale, matrix, motion and spin, not {}",
                found.describe()
            );
            self.poison("E0214", span, message);
        }
        None
    }

    fn invertible(&mut self, made: DAffine3, span: Span) -> Option<DAffine3> {
        let determinant = made.matrix3.determinant();
        let good = determinant.abs() > 0.0 && made.is_finite() && made.inverse().is_finite();
        if good {
            return Some(made);
        }
        self.poison("E0412", span, "this transform cannot be undone: it flattens space");
        None
    }
}
