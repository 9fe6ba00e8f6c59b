//! How things stand in the frame around them, and how they move there.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

/// From a thing's frame to the one around it. Small, as a large scene has many and is copied.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Pose {
    /// It stands where it is made.
    #[default]
    Here,
    /// It stands elsewhere.
    Fixed(Arc<DAffine3>),
    /// It moves: steps that are applied first to last, at least one of which is not `Fixed`.
    Moving(Arc<[Step]>),
}

/// One of several transforms that are applied one after another.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// The same at all times.
    Fixed(DAffine3),
    /// Where it is at some times, at least one, which increase. In between translation and stretch
    /// change evenly and rotations turn the shorter way at even speed; before the first and after the
    /// last it stands.
    Keys(Arc<[Key]>),
    /// Turns for ever.
    Spin {
        /// Through the origin, unit.
        axis: DVec3,
        /// rad/s, counter-clockwise about the axis; at time 0 it is not turned.
        rate: f64,
    },
}

/// Where something is at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Seconds.
    pub time: f64,
    /// Invertible, and of the same handedness as its neighbours.
    pub transform: DAffine3,
}

impl Pose {
    /// A pose of one step.
    pub fn of(step: Step) -> Self {
        match step {
            Step::Fixed(transform) => transform.into(),
            step => Self::Moving(Arc::new([step])),
        }
    }

    /// Whether it changes nothing.
    pub fn is_identity(&self) -> bool {
        self.fixed() == Some(DAffine3::IDENTITY)
    }

    /// Where it stands, unless it moves.
    pub fn fixed(&self) -> Option<DAffine3> {
        match self {
            Self::Here => Some(DAffine3::IDENTITY),
            Self::Fixed(transform) => Some(**transform),
            Self::Moving(_) => None,
        }
    }

    /// This one in a frame that stands so in the next.
    #[must_use]
    pub fn then(&self, outer: &Self) -> Self {
        match (self, outer) {
            (Self::Here, one) | (one, Self::Here) => return one.clone(),
            (Self::Fixed(inner), Self::Fixed(outer)) => return (**outer * **inner).into(),
            _ => {}
        }
        let mut steps: Vec<Step> = vec![];
        for step in self.steps().into_iter().chain(outer.steps()) {
            match (steps.last_mut(), &step) {
                (_, Step::Fixed(step)) if *step == DAffine3::IDENTITY => {}
                (Some(Step::Fixed(before)), Step::Fixed(next)) => *before = *next * *before,
                _ => steps.push(step),
            }
        }
        Self::Moving(steps.into())
    }

    /// Whether both are the same to the bit, which `==` does not ask of zeros.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Here, Self::Here) => true,
            (Self::Fixed(a), Self::Fixed(b)) => Arc::ptr_eq(a, b) || bits(a) == bits(b),
            (Self::Moving(a), Self::Moving(b)) => {
                Arc::ptr_eq(a, b)
                    || a.len() == b.len() && a.iter().zip(&**b).all(|(a, b)| a.is_same(b))
            }
            _ => false,
        }
    }

    /// The steps, first to last.
    pub fn steps(&self) -> Vec<Step> {
        match self {
            Self::Here => vec![Step::Fixed(DAffine3::IDENTITY)],
            Self::Fixed(transform) => vec![Step::Fixed(**transform)],
            Self::Moving(steps) => steps.to_vec(),
        }
    }
}

impl Step {
    fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Fixed(a), Self::Fixed(b)) => bits(a) == bits(b),
            (Self::Keys(a), Self::Keys(b)) => {
                let is_same = |(a, b): (&Key, &Key)| {
                    a.time.to_bits() == b.time.to_bits() && bits(&a.transform) == bits(&b.transform)
                };
                Arc::ptr_eq(a, b) || a.len() == b.len() && a.iter().zip(&**b).all(is_same)
            }
            (Self::Spin { axis: a, rate: x }, Self::Spin { axis: b, rate: y }) => {
                let bits =
                    |axis: &DVec3, rate: &f64| (axis.to_array().map(f64::to_bits), rate.to_bits());
                bits(a, x) == bits(b, y)
            }
            _ => false,
        }
    }
}

fn bits(affine: &DAffine3) -> [u64; 12] {
    affine.to_cols_array().map(f64::to_bits)
}

impl From<DAffine3> for Pose {
    fn from(transform: DAffine3) -> Self {
        if bits(&transform) == bits(&DAffine3::IDENTITY) {
            Self::Here
        } else {
            Self::Fixed(Arc::new(transform))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_join_and_fixed_steps_melt_together() {
        let spin = Pose::of(Step::Spin { axis: DVec3::Y, rate: 1.0 });
        let by = |x: f64| Pose::from(DAffine3::from_translation(DVec3::X * x));
        assert_eq!(by(1.0).then(&by(2.0)), by(3.0));
        let joined = by(1.0).then(&spin).then(&by(2.0)).then(&by(3.0));
        assert_eq!(joined.steps().len(), 3);
        assert_eq!(joined.steps()[2], by(5.0).steps()[0]);
        assert_eq!(Pose::Here.then(&spin), spin);
        assert_eq!(spin.then(&Pose::Here), spin);
    }

    #[test]
    fn what_changes_nothing_holds_nothing() {
        assert_eq!(Pose::from(DAffine3::IDENTITY), Pose::Here);
        let there_and_back =
            [1.0, -1.0].map(|x| Pose::from(DAffine3::from_translation(DVec3::X * x)));
        assert_eq!(there_and_back[0].then(&there_and_back[1]), Pose::Here);
        assert!(size_of::<Pose>() <= size_of::<Arc<[Step]>>() + size_of::<usize>());
    }
}
