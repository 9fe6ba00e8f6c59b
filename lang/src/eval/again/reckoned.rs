//! What formulas come to that are numbers: each by itself, so that threads share them.

use std::collections::BTreeMap;

use luxel_core::registry::Registry;
use luxel_core::scene::{self, Given, conform};
use luxel_sdk::params::{Dimension, Param};

use super::State;
use super::handed::{FittedValue, Handed, SIZE};
use super::handing::{Handing, Wanted};
use super::vector;
use crate::eval::Evaluator;
use crate::eval::arithmetic::Measured;
use crate::eval::env::Env;
use crate::eval::value::Value;
use crate::shares;

/// From what numbers are reckoned, and what becomes of them.
struct Reckoning<'a> {
    handing: &'a Handing,
    registry: &'a Registry,
    /// What bare numbers count, by dimension.
    units: &'a BTreeMap<Dimension, f64>,
    /// The numbers that names stand for, in the order of the names.
    names: Vec<(u32, Measured)>,
    /// Names whose values mistakes hide, in order.
    hidden: Vec<u32>,
}

impl State {
    /// For each that is wanted its value, if it is a number that fits. Of the others, nothing is known.
    pub(super) fn reckoned(
        &self,
        handed: &Handed,
        env: &Env,
        evaluator: &Evaluator<'_>,
    ) -> Vec<Option<FittedValue>> {
        let number = |name: u32| match env.get(self.names.name(name)) {
            Some(Value::Number(x, measure)) => Some((name, (x, measure))),
            _ => None,
        };
        let is_hidden = |name: &u32| matches!(env.get(self.names.name(*name)), Some(Value::Poison));
        let reckoning = Reckoning {
            handing: &self.handing,
            registry: evaluator.registry,
            units: &env.file.units,
            names: handed.names().filter_map(number).collect(),
            hidden: handed.names().filter(is_hidden).collect(),
        };
        let is_over = evaluator.sink.over();
        let some = |part: &[u32]| -> Vec<Option<FittedValue>> {
            let mut last = None;
            part.iter().map(|i| reckoning.value(*i, &mut last).filter(|_| !is_over())).collect()
        };
        shares::join(shares::map(handed.wanted(), |_| SIZE, some))
    }
}

/// A parameter that was wanted, and what is known of it.
type Last<'a> = Option<(&'a Wanted, &'a Param)>;

impl<'a> Reckoning<'a> {
    /// The parameter that a value is wanted for. Mostly it is the one of the last.
    fn param(&self, wanted: &'a Wanted, last: &mut Last<'a>) -> Option<&'a Param> {
        let is_last = |(one, _): &(&Wanted, _)| {
            (one.kind, one.param) == (wanted.kind, wanted.param) && one.class == wanted.class
        };
        if !last.as_ref().is_some_and(is_last) {
            let class = self.registry.class(wanted.kind, wanted.class)?;
            let param = Registry::params(class).find(|param| param.name == wanted.param)?;
            *last = Some((wanted, param));
        }
        last.map(|(_, param)| param)
    }

    fn number_of(&self, name: u32) -> Option<Measured> {
        let found = self.names.binary_search_by_key(&name, |(known, _)| *known);
        found.ok().map(|i| self.names[i].1)
    }

    /// The value of one that is wanted, by its number.
    fn value(&self, i: u32, last: &mut Last<'a>) -> Option<FittedValue> {
        let wanted = self.handing.wanted(i);
        let formula = self.handing.formula(i);
        let is_hidden = |name: u32| self.hidden.binary_search(&name).is_ok();
        if !self.hidden.is_empty() && formula.names().any(is_hidden) {
            return Some(FittedValue::Hidden);
        }
        if wanted.is_node {
            return None;
        }
        let units = |dimension: Dimension| self.units.get(&dimension).copied();
        let (x, measure) = formula.number(&|name| self.number_of(name), &units)?;
        let param = self.param(wanted, last)?;
        let given = match wanted.n_items {
            0 => Given::Number(x, measure),
            n if vector::dimension(param) == Some(measure) => {
                Given::Numbers(vec![x; usize::from(n)].into(), measure)
            }
            _ => return None,
        };
        let value = match (conform(param, given, &units).ok()?, wanted.n_items) {
            (scene::Value::Number(x, measure), 0) => (x, measure),
            (scene::Value::Vector(numbers), 1..) => (*numbers.first()?, measure),
            _ => return None,
        };
        Some(FittedValue::Number { value, said: (x, measure) })
    }
}
