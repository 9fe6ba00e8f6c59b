//! Transforms that change with time.

use luxel_core::diag::Span;
use luxel_core::scene::{Key, Pose, Step};
use luxel_sdk::params::Dimension;

use super::{Call, Evaluator, Value};
use crate::syntax::Form;

impl Evaluator<'_> {
    /// `motion([(time, transform), …])`: where something is at some times.
    pub(super) fn motion(&mut self, call: &Call<'_>) -> Option<Pose> {
        let arg = call.arg(0)?;
        let items = match &arg.value {
            Value::Items(items) if !items.items.is_empty() => items.clone(),
            _ => return self.no_motion(arg.span),
        };
        if !self.tick(items.items.len() as u64, arg.span) {
            return None;
        }
        let mut keys: Vec<Key> = Vec::with_capacity(items.items.len());
        for item in &items.items {
            let key = self.key(call, item, arg.span)?;
            if let Some(before) = keys.last() {
                self.follows(before, &key, arg.span)?;
            }
            keys.push(key);
        }
        Some(Pose::of(Step::Keys(keys.into())))
    }

    fn key(&mut self, call: &Call<'_>, item: &Value, span: Span) -> Option<Key> {
        let (time, transform) = match item {
            Value::Poison => return None,
            Value::Items(pair) if pair.form == Form::Tuple && pair.items.len() == 2 => {
                (&pair.items[0], &pair.items[1])
            }
            _ => return self.no_motion(span),
        };
        let Value::Number(time, found) = time else { return self.no_motion(span) };
        let time = time * self.unit_scale(call, *found, Dimension::TIME, span)?;
        let Some(transform) = self.transform(transform, span)?.fixed() else {
            self.poison("E0214", span, "a transform at one time does not move itself");
            return None;
        };
        Some(Key { time, transform })
    }

    /// Whether a key may come after another.
    fn follows(&mut self, before: &Key, next: &Key, span: Span) -> Option<()> {
        if next.time.partial_cmp(&before.time) != Some(std::cmp::Ordering::Greater) {
            let message = format!(
                "the times of a motion increase: {} s stands after {} s",
                next.time, before.time
            );
            self.poison("E0412", span, message);
            return None;
        }
        let hand = |key: &Key| key.transform.matrix3.determinant() > 0.0;
        if hand(before) != hand(next) {
            let message = format!(
                "between {} s and {} s this motion turns inside out: one of the two mirrors",
                before.time, next.time
            );
            self.poison("E0412", span, message);
            return None;
        }
        Some(())
    }

    fn no_motion<T>(&mut self, span: Span) -> Option<T> {
        let message = "a motion is a list of times and transforms: \
                       `motion([(0 s, move((0, 0, 0) m)), (1 s, move((1, 0, 0) m))])`";
        self.poison("E0214", span, message);
        None
    }

    /// `spin(axis, rate)`.
    pub(super) fn spin(&mut self, call: &Call<'_>) -> Option<Pose> {
        let axis = self.axis(call);
        let rate = self.number_arg(call, 1, Dimension::ANGULAR_SPEED);
        let (axis, rate) = (axis?, rate?);
        Some(Pose::of(Step::Spin { axis, rate }))
    }
}
