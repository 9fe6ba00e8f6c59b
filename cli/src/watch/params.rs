//! The scene's `param`s as the page offers them, and the command line that sets them so.

use luxel_lang::{ParamInfo, ParamLimits, ParamValue};

use crate::preview::{Field, Param};

/// What the page can set: numbers, alone or a few, what is true or false, text, and colours of sRGB.
pub(super) fn offered(params: &[ParamInfo], set: &[(String, String)]) -> Vec<Param> {
    let offer = |param: &ParamInfo| {
        let set = set.iter().any(|(name, _)| *name == param.name);
        let field = field(param)?;
        Some(Param { name: param.name.clone(), doc: param.doc.clone(), set, field })
    };
    params.iter().filter_map(offer).collect()
}

fn field(param: &ParamInfo) -> Option<Field> {
    let (unit, scale) = param.written.clone().unwrap_or((param.unit.clone(), 1.0));
    match &param.value {
        ParamValue::Number(x) if x.is_finite() => {
            let is_range =
                |l: &ParamLimits| l.low.is_finite() && l.high.is_finite() && l.low < l.high;
            let limits = param.limits.filter(is_range);
            let shown = limits.map(|limits| ends(limits, scale));
            let inclusive = limits.is_none_or(|limits| limits.inclusive);
            let whole = param.ty == "int";
            Some(Field::Number { value: tidy(x / scale), unit, whole, limits: shown, inclusive })
        }
        ParamValue::Bool(value) => Some(Field::Bool { value: *value }),
        ParamValue::Text(value) => Some(Field::Text { value: value.clone() }),
        ParamValue::Numbers { values, is_list } if is_shown(values) => {
            let value = values.iter().map(|x| tidy(x / scale)).collect();
            Some(Field::Numbers { value, unit, list: *is_list })
        }
        ParamValue::Color(rgb) if is_shown(rgb) => Some(Field::Color { value: *rgb }),
        ParamValue::Number(_)
        | ParamValue::Numbers { .. }
        | ParamValue::Color(_)
        | ParamValue::Other => None,
    }
}

fn is_shown(values: &[f64]) -> bool {
    !values.is_empty() && values.iter().all(|x| x.is_finite())
}

/// The ends of a range in a unit: as short as they come out within the range again.
fn ends(ParamLimits { low, high, .. }: ParamLimits, scale: f64) -> [f64; 2] {
    let within = |x: &f64| (low..=high).contains(&(x * scale));
    let end = |x: f64, inwards: fn(f64) -> f64| {
        let x = x / scale;
        [tidy(x), x].into_iter().find(within).unwrap_or(inwards(x))
    };
    [end(low, f64::next_up), end(high, f64::next_down)]
}

/// A number without what changing its unit has left in its last places.
fn tidy(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
}

/// The arguments of a command line that set these, as a shell reads them.
pub(super) fn line(set: &[(String, String)]) -> String {
    let one = |(name, value): &(String, String)| {
        let text = format!("{name}={value}");
        let plain = |c: char| c.is_ascii_alphanumeric() || "_=.,+-/:".contains(c);
        if text.chars().all(plain) {
            format!("--set {text}")
        } else {
            format!("--set '{}'", text.replace('\'', r"'\''"))
        }
    };
    set.iter().map(one).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use luxel_core::files::MemoryFiles;
    use luxel_core::registry::Registry;
    use luxel_lang::Settings;

    use super::*;

    fn offers(text: &str, set: &[(&str, &str)]) -> Vec<Param> {
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let set: Vec<_> = set.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
        let settings = Settings { set: set.clone(), ..Settings::default() };
        let read = luxel_lang::load(Path::new("a.scene"), &files, &Registry::new(), &settings);
        offered(&read.params, &set)
    }

    #[test]
    fn a_param_is_offered_in_the_unit_of_its_author() {
        let text = "scene 1\n/// How far.\nparam tilt: angle = 30 deg in -90 deg..90 deg\n\
                    param n: int = 3 in 1..=9\nparam lit: bool = true\nparam of: string = \"oak\"\n\
                    param tint: color = rgb.srgb(1, 0, 0)\n\
                    param at: vec3 = (1, 2.5, -3) cm\nparam some: int[] = [1, 2]\n\
                    param none: int[] = []\nparam all: bool[] = [true]\n\
                    param lamp: color = blackbody(3000 K)\n";
        let found = offers(text, &[("tilt", "1 rad")]);
        let names: Vec<_> = found.iter().map(|param| param.name.as_str()).collect();
        assert_eq!(names, ["tilt", "n", "lit", "of", "tint", "at", "some"]);
        assert!(found[0].set && !found[1].set);
        assert_eq!(found[0].doc, "How far.");
        let Field::Number { value, unit, whole, limits, inclusive } = &found[0].field else {
            panic!("{:?}", found[0])
        };
        assert_eq!((unit.as_str(), *whole, *inclusive), ("deg", false, false));
        assert_eq!((*value, *limits), (57.29577951308, Some([-90.0, 90.0])));
        let n = Field::Number {
            value: 3.0,
            unit: String::new(),
            whole: true,
            limits: Some([1.0, 9.0]),
            inclusive: true,
        };
        assert_eq!(found[1].field, n);
        assert_eq!(found[2].field, Field::Bool { value: true });
        assert_eq!(found[3].field, Field::Text { value: "oak".into() });
        assert_eq!(found[4].field, Field::Color { value: [1.0, 0.0, 0.0] });
        let at = Field::Numbers { value: vec![1.0, 2.5, -3.0], unit: "cm".into(), list: false };
        assert_eq!(found[5].field, at);
        let some = Field::Numbers { value: vec![1.0, 2.0], unit: String::new(), list: true };
        assert_eq!(found[6].field, some);
    }

    #[test]
    fn a_param_that_was_given_what_is_no_value_can_be_given_another() {
        let text = "scene 1\nparam r: float = 0.5\nparam n: int = 3\n";
        for wrong in ["0,5", "abc", "1e", "", "0.5 m", "\"x\""] {
            let found = offers(text, &[("r", wrong)]);
            let names: Vec<_> = found.iter().map(|param| (&*param.name, param.set)).collect();
            assert_eq!(names, [("r", true), ("n", false)], "{wrong}");
        }
    }

    #[test]
    fn the_ends_that_are_offered_are_taken() {
        for unit in ["deg", "rad", "mm", "ft", "um"] {
            let kind = if ["deg", "rad"].contains(&unit) { "angle" } else { "length" };
            for high in ["0.7", "90", "1.5707963267948966", "3.3", "1/3 * 1", "2/3 * 1"] {
                let of = |value: &str| {
                    let text = format!(
                        "scene 1\nparam a: {kind} = {value} in 0.1 {unit}..={high} {unit}\n"
                    );
                    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
                    let settings = Settings::default();
                    luxel_lang::load(Path::new("a.scene"), &files, &Registry::new(), &settings)
                };
                let found = offered(&of(&format!("0.3 {unit}")).params, &[]);
                let Field::Number { limits: Some([low, high]), .. } = found[0].field else {
                    panic!("{found:?}")
                };
                for end in [low, high] {
                    let told = of(&format!("{end} {unit}")).diagnostics;
                    let refused = told.iter().any(|found| found.code == "E0405");
                    assert!(!refused, "{end} {unit}: {told:?}");
                }
            }
        }
    }

    #[test]
    fn the_line_is_one_that_a_shell_reads_back() {
        let pair = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        let set = [pair("n", "3"), pair("tilt", "30 deg"), pair("of", "it's $HOME")];
        assert_eq!(line(&set), r"--set n=3 --set 'tilt=30 deg' --set 'of=it'\''s $HOME'");
        assert_eq!(line(&[]), "");
    }
}
