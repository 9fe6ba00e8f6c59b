//! Arguments in another order than here, or a vector's numbers without its own brackets.

use luxel_core::diag::Diagnostic;
use luxel_sdk::params::Dimension;

use super::super::Evaluator;
use super::super::value::Value;
use super::Given;

/// `look_at(from = 0, 1.8, 7 m, to = …)`: numbers behind one with a name.
pub(super) fn unbracketed(given: &[Given]) -> Option<Diagnostic> {
    let is_number = |given: &Given| matches!(given.value, Value::Number(..));
    let is_bare = |given: &Given| given.name.is_none() && is_number(given);
    let first = given.iter().position(|given| given.name.is_some() && is_number(given))?;
    let n = given[first + 1..].iter().take_while(|given| is_bare(given)).count();
    let all = given[first].span.to(given[first + n].span);
    let found = Diagnostic::error("E0402", all, "a vector has brackets of its own");
    (n == 2).then(|| found.help("it is written `(1, 2, 3) m`"))
}

impl Evaluator<'_> {
    /// `rgb.srgb((1, 0, 0))`: one vector of what a colour is made of.
    pub(super) fn bracketed(
        &self,
        usage: &str,
        n_wanted: usize,
        given: &[Given],
    ) -> Option<Diagnostic> {
        let [Given { name: None, value: Value::Numbers(numbers), span }] = given else {
            return None;
        };
        let found =
            Diagnostic::error("E0402", *span, "the numbers of a colour stand by themselves");
        let found = found.help(format!("it is called as `{usage}`"));
        let written = self.written(*span);
        let inner = written.strip_prefix(['(', '[']).and_then(|it| it.strip_suffix([')', ']']));
        let found = match inner {
            Some(inner) if numbers.data.len() == n_wanted => found.fix(*span, inner.trim()),
            _ => found,
        };
        (n_wanted > 1).then_some(found)
    }

    /// `look_at((0, 1, 0), (0, 1, 5) m, (0, 0, 0) m)`: what is up before what has a place.
    pub(super) fn up_first(&self, given: &[Given]) -> Option<Diagnostic> {
        let measure = |given: &Given| match &given.value {
            Value::Numbers(numbers) if given.name.is_none() => Some(numbers.dimension),
            _ => None,
        };
        let [up, from, to] = given else { return None };
        // What is nowhere but in the middle may lack its unit, and is no direction.
        if matches!(&up.value, Value::Numbers(up) if up.data.iter().all(|x| x.abs() <= 0.0)) {
            return None;
        }
        let measures = [up, from, to].map(measure);
        let all = up.span.to(to.span);
        let written = [from, to, up].map(|given| self.written(given.span));
        let found = Diagnostic::error("E0402", all, "what is up stands last");
        let is_first =
            measures == [Dimension::NONE, Dimension::LENGTH, Dimension::LENGTH].map(Some);
        is_first.then(|| found.guess(all, written.join(", ")))
    }

    /// What is told of the arguments of a transform as a whole, if they are meant for it in another form.
    pub(super) fn misarranged(&self, function: &str, given: &[Given]) -> Option<Diagnostic> {
        let is_number = |given: &Given| matches!(given.value, Value::Number(..));
        let is_vector = |given: &Given| matches!(given.value, Value::Numbers(_) | Value::Items(_));
        // No number of an axis that anybody writes.
        let is_large = |given: &Given| matches!(given.value, Value::Number(x, _) if x.abs() > 1.0);
        if given.iter().any(|given| given.name.is_some()) {
            return None;
        }
        let turns = matches!(function, "rotate" | "spin");
        let all = given.first()?.span.to(given.last()?.span);
        match given {
            // `rotate(30 deg, (0, 1, 0))`
            [angle, axis] if turns && is_number(angle) && is_vector(axis) => {
                let written = [axis, angle].map(|given| self.written(given.span));
                let found = Diagnostic::error("E0402", all, "the axis stands first");
                Some(found.guess(all, written.join(", ")))
            }
            // `rotate(30, 0, 1, 0)`
            [angle, x, y, z]
                if turns
                    && [angle, x, y, z].into_iter().all(is_number)
                    && is_large(angle)
                    && ![x, y, z].into_iter().any(is_large) =>
            {
                let bare = matches!(angle.value, Value::Number(_, measure) if measure.is_none());
                let unit = if bare { " deg" } else { "" };
                let [angle, axis] = [angle.span, x.span.to(z.span)].map(|span| self.written(span));
                let found = Diagnostic::error("E0402", all, "the axis stands first, as a vector");
                Some(found.guess(all, format!("({axis}), {angle}{unit}")))
            }
            // `move(1, 2, 3)`, `rotate(0, 1, 0, 30 deg)`
            [x, y, z, rest @ ..] if [x, y, z].into_iter().all(is_number) => {
                let takes_them = match rest.len() {
                    0 => matches!(function, "move" | "scale"),
                    n => turns && n == 1,
                };
                let vector = x.span.to(z.span);
                let found = Diagnostic::error("E0402", vector, "a vector has brackets of its own");
                takes_them.then(|| found.guess(vector, format!("({})", self.written(vector))))
            }
            _ => None,
        }
    }
}
