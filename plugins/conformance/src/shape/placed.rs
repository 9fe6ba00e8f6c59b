//! A shape a millionth as large, a million times as large, and a thousand kilometres away.

use luxel_core::scene::Value;
use luxel_sdk::params::{Param, Preset, Type};
use luxel_sdk::sampling::Rng;

use crate::report::Judge;
use crate::subject::Subject;
use crate::sweep::{FAR, Given, Set, own, part, said};
use crate::values::{Level, dimension};

/// Factors of every length, and the checks that there is such a shape.
const SCALES: [(f64, &str); 2] =
    [(1e-6, "a millionth as large"), (1e6, "a million times as large")];
const AWAY: &str = "far away";

/// The usual shape with all lengths scaled, and moved. Where it has none, or they are refused, there is
/// no such set, and a row that says so.
pub(super) fn sets(subject: &Subject<'_>, judge: &mut Judge) -> Vec<(Set, Rng)> {
    let Some(usual) = subject.sets.first() else { return vec![] };
    let scaled = |i: usize| {
        let (scale, check) = SCALES[i];
        let change = move |_: &Param, x: &[f64]| x.iter().map(|x| x * scale).collect();
        (check, format!("scaled by {scale:e}"), changed(subject, usual, 1 + i, change))
    };
    let moved = changed(subject, usual, 1 + SCALES.len(), |param, x| {
        let far = |i: usize| if is_place(param) { FAR[i % 3] } else { 0.0 };
        x.iter().enumerate().map(|(i, x)| x + far(i)).collect()
    });
    let all = [scaled(0), scaled(1), (AWAY, format!("moved by {FAR}"), moved)];
    let mut made = vec![];
    for ((check, label, given), i) in all.into_iter().zip(0u64..) {
        let Some(given) = given else {
            judge.skip(check, "no parameter is such a length or place");
            continue;
        };
        let object = match subject.bench.build(&subject.class, &given, usual.mode) {
            Ok(object) => object,
            Err(found) => {
                judge.skip(check, format!("{label}, it is refused: {}", said(&found)));
                continue;
            }
        };
        judge.holds(check, true, || label.clone());
        let set = Set { label, given: vec![], object, level: Level::Usual, mode: usual.mode };
        made.push((set, Rng::new(subject.options.seed.wrapping_add(1000 + i))));
    }
    made
}

/// A place and not an extent: the origin unless given; or a table of places, by its name.
fn is_place(param: &Param) -> bool {
    if param.ty == Type::Table {
        return param.name == "points";
    }
    let origin =
        matches!(param.default, Preset::Numbers(n) if n[..3].iter().all(|x| x.abs() <= 0.0));
    param.ty == Type::DVec3 && param.min < 0.0 && origin
}

/// What is given, with all lengths changed, parts to those of that place; `None` if nothing changes.
fn changed(
    subject: &Subject<'_>,
    usual: &Set,
    place: usize,
    change: impl Fn(&Param, &[f64]) -> Vec<f64>,
) -> Option<Given> {
    let (mut given, mut any) = (usual.given.clone(), false);
    for (i, param) in own(&subject.class).enumerate().filter(|(_, param)| param.ty == Type::Part) {
        if let Some((_, value)) = given.iter_mut().find(|(name, _)| *name == param.name) {
            (*value, any) = (part(i, place), true);
        }
    }
    for param in own(&subject.class).filter(|param| param.unit == "m") {
        let at = given.iter().position(|(name, _)| *name == param.name);
        let lanes = if param.ty == Type::DVec3 { 3 } else { 1 };
        let old = match (at.map(|at| &given[at].1), &param.default) {
            (Some(Value::Number(x, _)), _) => vec![*x],
            (Some(Value::Vector(x)), _) => x.to_vec(),
            (Some(Value::Table(x)), _) => x.to_vec(),
            (None, Preset::Numbers(numbers)) if numbers.len() >= lanes => numbers[..lanes].to_vec(),
            _ => continue,
        };
        let new = change(param, &old);
        if new == old {
            continue;
        }
        any = true;
        let new = match *new {
            _ if param.ty == Type::Table => Value::Table(new.into()),
            [x] => Value::Number(x, dimension(param)),
            _ => Value::vector(new),
        };
        match at {
            Some(at) => given[at].1 = new,
            None => given.push((param.name, new)),
        }
    }
    any.then_some(given)
}
