//! What plugins of all kinds must satisfy: they describe themselves and refuse what is out of range.

use luxel_core::object::ColorMode;
use luxel_core::scene::{Color, Given, conform};
use luxel_sdk::abi::Class;
use luxel_sdk::params::{Param, Preset, Type, Unit};

use crate::report::Judge;
use crate::sweep::{Bench, Tried, own};
use crate::values;

/// Names, manual, units and defaults.
pub(crate) fn describes_itself(class: &Class, judge: &mut Judge) {
    judge.holds("documented", !class.doc.trim().is_empty(), || "the class".to_owned());
    judge.holds("snake case", is_snake(class.name), || class.name.to_owned());
    for param in class.params {
        let name = || param.name.to_owned();
        judge.holds("documented", !param.doc.trim().is_empty(), name);
        judge.holds("snake case", is_snake(param.name), name);
        let units = param.unit.split('|').filter(|unit| !unit.is_empty() && *unit != "EV");
        judge.holds("units are known", units.into_iter().all(|u| Unit::parse(u).is_ok()), name);
        judge.holds("default in range", default_is_legal(param), || {
            format!("{}: {:?} in [{}, {}]", param.name, param.default, param.min, param.max)
        });
        for choice in param.words() {
            judge.holds("snake case", is_snake(choice), || choice.to_owned());
        }
    }
}

fn is_snake(name: &str) -> bool {
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(legal)
}

fn default_is_legal(param: &Param) -> bool {
    let numbers = match param.ty {
        Type::Vec2 => 2,
        Type::Vec3 | Type::DVec3 => 3,
        _ => 1,
    };
    match param.default {
        Preset::Numbers(n) => n[..numbers].iter().all(|x| param.min <= *x && *x <= param.max),
        Preset::Index(i) => (i as usize) < param.choices.len(),
        Preset::Absent | Preset::Text(_) => param.min <= param.max,
    }
}

/// Numbers just outside a range, NaN and infinity never fit; those at the ends give an object or an
/// error with its place.
pub(crate) fn refuses_what_is_out_of_range(bench: &Bench, class: &Class, judge: &mut Judge) {
    for param in own(class) {
        // Colours are forgiven what converting between colour spaces rounds.
        let rounding =
            |end: f64| if values::is_spectrum(param) { 1e-9 * end.abs().max(1.0) } else { 0.0 };
        let below = param.min.next_down() - rounding(param.min);
        let above = param.max.next_up() + rounding(param.max);
        let outside = [below, above, f64::NAN, f64::INFINITY];
        for x in outside.into_iter().chain([f64::NEG_INFINITY]) {
            let Some(given) = given(param, x) else { continue };
            let fits = conform(param, given, &|_| None).is_ok();
            judge.holds("refuses out of range", !fits, || format!("{} = {x}", param.name));
        }
    }
    let Ok(Tried { sets, .. }) = bench.sets(class, 0, 0) else { return };
    let Some(nominal) = sets.first() else { return };
    for param in own(class) {
        for (value, _) in values::extremes(param) {
            let shown = values::show(&value);
            let mut given = nominal.given.clone();
            given.retain(|(name, _)| *name != param.name);
            given.push((param.name, value));
            let Err(found) = bench.build(class, &given, ColorMode::Rgb) else { continue };
            let mut errors = found.iter().filter(|d| d.is_error());
            let placed = errors.all(|d| !d.labels.is_empty() && !d.message.is_empty());
            judge.holds("errors have a place", placed, || format!("{} = {shown}", param.name));
        }
    }
}

fn given(param: &Param, x: f64) -> Option<Given> {
    let dimension = values::dimension(param);
    match param.ty {
        Type::Float | Type::Double | Type::Int | Type::MaybeFloat => {
            Some(Given::Number(x, dimension))
        }
        Type::Emission if !param.group.is_empty() => Some(Given::Number(x, dimension)),
        Type::Vec2 => Some(Given::Numbers([x; 2].as_slice().into(), dimension)),
        Type::Vec3 | Type::DVec3 => Some(Given::Numbers([x; 3].as_slice().into(), dimension)),
        Type::Spectrum | Type::ComplexIor => Some(Given::Color(Color::Constant(x), dimension)),
        _ => None,
    }
}
