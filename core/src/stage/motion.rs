//! Where moving things stand at a time, and a box around where they pass.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use luxel_sdk::num::{Bounds3, Transform};

use crate::scene::{Key, Step};

/// Steps that are applied first to last, ready to be asked for any time.
#[derive(Clone, Debug)]
pub struct Motion(Vec<Part>);

#[derive(Clone, Debug)]
enum Part {
    Fixed(DAffine3),
    Keys(Arc<[Split]>),
    Spin { axis: DVec3, rate: f64 },
}

/// Keys that have been split, each list once. A list is known by its address, and held so that no other
/// takes that.
#[derive(Debug, Default)]
pub(super) struct Splits(BTreeMap<usize, Known>);

#[derive(Debug)]
struct Known {
    _keys: Arc<[Key]>,
    splits: Arc<[Split]>,
}

impl Splits {
    fn of(&mut self, keys: &Arc<[Key]>) -> Option<Arc<[Split]>> {
        let address = keys.as_ptr().addr();
        if let Some(known) = self.0.get(&address) {
            return Some(known.splits.clone());
        }
        let splits: Arc<[Split]> = keys.iter().map(Split::of).collect::<Option<_>>()?;
        self.0.insert(address, Known { _keys: keys.clone(), splits: splits.clone() });
        Some(splits)
    }
}

/// A key in parts that change on their own.
#[derive(Clone, Copy, Debug)]
struct Split {
    time: f64,
    translation: DVec3,
    turn: DQuat,
    /// Symmetric: what is left of the matrix before it turns.
    stretch: DMat3,
}

/// How far points lie from the origin of a frame at most, and how fast they move in it.
#[derive(Clone, Copy)]
struct Reach {
    radius: f64,
    speed: f64,
}

/// Moments for which a moving box is found; in between its speed bounds it.
const MOMENTS: u32 = 32;
/// Rounds of the polar decomposition, which converges quadratically once it is scaled.
const ROUNDS: u32 = 32;

impl Motion {
    /// Of the steps of a pose; `None` where a key cannot be split into a rotation and a stretch.
    /// Keys that several poses share are split once, into `known`.
    pub(super) fn new(steps: &[Step], known: &mut Splits) -> Option<Self> {
        let mut part = |step: &Step| {
            Some(match step {
                Step::Fixed(transform) => Part::Fixed(*transform),
                Step::Keys(keys) => Part::Keys(known.of(keys)?),
                Step::Spin { axis, rate } => Part::Spin { axis: *axis, rate: *rate },
            })
        };
        steps.iter().map(&mut part).collect::<Option<Vec<_>>>().map(Self)
    }

    /// Whether nothing changes in an interval of time, which may be a moment.
    pub fn stands(&self, [open, close]: [f64; 2]) -> bool {
        open >= close
            || self.0.iter().all(|part| match part {
                Part::Fixed(_) => true,
                Part::Keys(keys) => {
                    keys.len() == 1 || close <= keys[0].time || open >= keys[keys.len() - 1].time
                }
                Part::Spin { rate, .. } => *rate == 0.0,
            })
    }

    /// The whole transform at a time in seconds.
    pub fn affine(&self, time: f64) -> DAffine3 {
        let first = DAffine3::IDENTITY;
        self.0.iter().fold(first, |inner, part| part.affine(time) * inner)
    }

    /// The same, ready for rays; `None` where it flattens space to rounding.
    pub fn at(&self, time: f64) -> Option<Transform> {
        Transform::new(self.affine(time))
    }

    /// A box that holds all points of a box while it moves through an interval of time.
    pub fn bounds(&self, local: Bounds3, [open, close]: [f64; 2]) -> Bounds3 {
        if local.is_empty() || !local.diagonal().is_finite() {
            let all = Bounds3 { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
            return if local.is_empty() { local } else { all };
        }
        let radius = local.min.abs().max(local.max.abs()).length();
        let start = Reach { radius, speed: 0.0 };
        let reach = self.0.iter().fold(start, |reach, part| part.carried(reach, [open, close]));
        let step = (close - open) / f64::from(MOMENTS);
        let mut all = Bounds3::EMPTY;
        for i in 0..=MOMENTS {
            all = all.union(local.transform(&self.affine(open + step * f64::from(i))));
        }
        // Half a step away from the nearest moment; and rotations are rounded.
        let slack = reach.speed * step / 2.0 + reach.radius * 64.0 * f64::EPSILON;
        // However it turns, it stays within its reach.
        let most = DVec3::splat(reach.radius * (1.0 + 64.0 * f64::EPSILON));
        Bounds3 { min: (all.min - slack).max(-most), max: (all.max + slack).min(most) }
    }
}

impl Part {
    fn affine(&self, time: f64) -> DAffine3 {
        match self {
            Self::Fixed(transform) => *transform,
            Self::Keys(keys) => between(keys, time),
            Self::Spin { axis, rate } => DAffine3::from_axis_angle(*axis, rate * time),
        }
    }

    /// What holds of points beyond this part.
    fn carried(&self, Reach { radius, speed }: Reach, [open, close]: [f64; 2]) -> Reach {
        match self {
            Self::Fixed(transform) => {
                let norm = norm(transform.matrix3);
                let radius = norm * radius + transform.translation.length();
                Reach { radius, speed: norm * speed }
            }
            Self::Keys(keys) => {
                let largest = |of: &dyn Fn(&Split) -> f64| keys.iter().map(of).fold(0.0, f64::max);
                let norm = largest(&|key| norm(key.stretch));
                let met = |pair: &&[Split]| pair[0].time < close && pair[1].time > open;
                let own = keys.windows(2).filter(met);
                let own = own.map(|pair| pair[0].speed(&pair[1], radius, norm));
                let speed = norm * speed + own.fold(0.0, f64::max);
                Reach { radius: norm * radius + largest(&|key| key.translation.length()), speed }
            }
            Self::Spin { rate, .. } => Reach { radius, speed: speed + rate.abs() * radius },
        }
    }
}

impl Split {
    fn of(key: &Key) -> Option<Self> {
        let Key { time, transform } = *key;
        let (turn, stretch) = polar(transform.matrix3)?;
        Some(Self { time, translation: transform.translation, turn, stretch })
    }

    /// How fast points within a radius move on the way to the next key, at most.
    fn speed(&self, next: &Self, radius: f64, largest: f64) -> f64 {
        let angle = self.turn.angle_between(next.turn);
        let turned = angle * largest * radius;
        let stretched = norm(next.stretch - self.stretch) * radius;
        let moved = next.translation.distance(self.translation);
        (turned + stretched + moved) / (next.time - self.time)
    }
}

fn between(keys: &[Split], time: f64) -> DAffine3 {
    let next = keys.partition_point(|key| key.time <= time);
    let (a, b) = (&keys[next.saturating_sub(1)], &keys[next.min(keys.len() - 1)]);
    let share = if a.time < b.time { (time - a.time) / (b.time - a.time) } else { 0.0 };
    let turn = a.turn.slerp(b.turn, share);
    let stretch = a.stretch + (b.stretch - a.stretch) * share;
    let matrix3 = DMat3::from_quat(turn) * stretch;
    let translation = a.translation.lerp(b.translation, share);
    DAffine3 { matrix3, translation }
}

/// A rotation and a symmetric matrix whose product, the rotation last, is `m`.
///
/// # Source
/// Higham 1986, Computing the Polar Decomposition, with its scaling.
fn polar(m: DMat3) -> Option<(DQuat, DMat3)> {
    let largest = m.to_cols_array().into_iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    let mut q = m / largest;
    for _ in 0..ROUNDS {
        let inverse = q.inverse().transpose();
        let scale = (norm(inverse) / norm(q)).sqrt();
        let next = (q * scale + inverse * scale.recip()) * 0.5;
        let change = norm(next - q);
        q = next;
        if change <= 1e-15 {
            break;
        }
    }
    let q = q * q.determinant().signum();
    let turn = DQuat::from_mat3(&q).normalize();
    let stretch = DMat3::from_quat(turn).transpose() * m;
    (turn.is_finite() && stretch.is_finite()).then_some((turn, stretch))
}

/// At least by how much a matrix stretches any vector: the smaller of two bounds of the largest
/// singular value, which is exact where axes stay axes. Up to 4 roundings.
fn norm(m: DMat3) -> f64 {
    let sums = |m: DMat3| {
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.abs().element_sum());
        x.max(y).max(z)
    };
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length_squared);
    (x + y + z).sqrt().min((sums(m) * sums(m.transpose())).sqrt())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, TAU};

    use super::*;

    fn keys(keys: &[(f64, DAffine3)]) -> Motion {
        let keys: Arc<[Key]> = keys
            .iter()
            .map(|(time, transform)| Key { time: *time, transform: *transform })
            .collect();
        Motion::new(&[Step::Keys(keys)], &mut Splits::default()).unwrap()
    }

    fn close(a: DAffine3, b: DAffine3) -> bool {
        a.to_cols_array().iter().zip(b.to_cols_array()).all(|(a, b)| (a - b).abs() < 1e-14)
    }

    #[test]
    fn keys_are_met_and_held_outside_their_times() {
        let turned = DAffine3::from_axis_angle(DVec3::Z, 2.0);
        let stretched = DAffine3::from_scale(DVec3::new(1.0, -2.0, 3.0));
        let far = DAffine3::from_translation(DVec3::X) * turned * stretched;
        let motion = keys(&[(1.0, stretched), (3.0, far)]);
        for (time, expected) in [(0.0, stretched), (1.0, stretched), (3.0, far), (9.0, far)] {
            assert!(close(motion.affine(time), expected), "{time}");
        }
    }

    #[test]
    fn rotations_turn_evenly_and_translations_run_straight() {
        let end = DAffine3::from_translation(DVec3::Y * 4.0)
            * DAffine3::from_axis_angle(DVec3::Z, FRAC_PI_2);
        let motion = keys(&[(0.0, DAffine3::IDENTITY), (1.0, end)]);
        for share in [0.25, 0.5, 0.9] {
            let expected = DAffine3::from_translation(DVec3::Y * 4.0 * share)
                * DAffine3::from_axis_angle(DVec3::Z, FRAC_PI_2 * share);
            assert!(close(motion.affine(share), expected), "{share}");
        }
        let spin = Motion::new(&[Step::Spin { axis: DVec3::X, rate: TAU }], &mut Splits::default())
            .unwrap();
        assert!(close(spin.affine(1.25), DAffine3::from_rotation_x(FRAC_PI_2)));
    }

    #[test]
    fn matrices_of_any_size_and_hand_are_split_into_a_rotation_and_a_stretch() {
        let turned = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 2.5);
        for scale in [1e-150, 1e-9, 1.0, 1e150] {
            for stretch in [DVec3::ONE, DVec3::new(1.0, 1e-12, 5.0), DVec3::new(-1.0, 2.0, 3.0)] {
                let m = turned * DMat3::from_diagonal(stretch) * scale;
                let (turn, stretch) = polar(m).unwrap();
                let again = DMat3::from_quat(turn) * stretch;
                assert!(norm((again - m) / scale) < 1e-14 * norm(m / scale), "{m}");
                let skew = stretch - stretch.transpose();
                assert!(norm(skew / scale) < 1e-13 * norm(stretch / scale), "{stretch}");
            }
        }
    }

    #[test]
    fn boxes_hold_what_moves_at_every_moment() {
        let spin = Step::Spin { axis: DVec3::new(1.0, 1.0, 0.2).normalize(), rate: 9.0 };
        let there = DAffine3::from_translation(DVec3::new(5.0, 0.0, -3.0))
            * DAffine3::from_axis_angle(DVec3::Y, 3.0)
            * DAffine3::from_scale(DVec3::new(0.5, 2.0, 1.0));
        let keys = [(0.2, DAffine3::IDENTITY), (0.6, there)];
        let keys = keys.map(|(time, transform)| Key { time, transform });
        let aside = Step::Fixed(DAffine3::from_translation(DVec3::X * 2.0));
        let steps = [aside, spin, Step::Keys(Arc::new(keys))];
        let motion = Motion::new(&steps, &mut Splits::default()).unwrap();
        let local = Bounds3 { min: DVec3::new(-1.0, 0.0, -0.5), max: DVec3::ONE };
        let bounds = motion.bounds(local, [0.0, 1.0]);
        for i in 0..=997 {
            let at = local.transform(&motion.affine(f64::from(i) / 997.0));
            assert!(bounds.min.cmple(at.min).all() && bounds.max.cmpge(at.max).all(), "{i}");
        }
        // What is a blade's length away stays so, however fast it turns; and what stands, stands.
        let steps = [Step::Spin { axis: DVec3::Y, rate: 6e3 }];
        let fan = Motion::new(&steps, &mut Splits::default()).unwrap();
        let blade = Bounds3 { min: DVec3::ZERO, max: DVec3::X };
        assert!(fan.bounds(blade, [0.0, 1.0]).max.max_element() < 1.0 + 1e-12);
        assert!(!fan.stands([0.0, 1.0]) && !motion.stands([0.0, 0.3]));
        let steps = [Step::Keys(Arc::new(keys))];
        let keyed = Motion::new(&steps, &mut Splits::default()).unwrap();
        assert!(keyed.stands([0.0, 0.2]) && keyed.stands([0.6, 9.0]) && !keyed.stands([0.1, 0.3]));
    }
}
