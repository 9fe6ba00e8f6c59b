//! What the derive asserts of each parameter while a plugin compiles.

use super::{Kind, Param, Preset, Type, UNITS};

/// Whether the default is one of the legal values; true where there is none. NaN is in no range.
pub const fn default_is_in_range(param: &Param) -> bool {
    let Preset::Numbers(numbers) = param.default else { return true };
    let n = match param.ty {
        Type::Vec2 => 2,
        Type::Vec3 | Type::DVec3 => 3,
        _ => 1,
    };
    let mut i = 0;
    while i < n {
        let inside = numbers[i] >= param.min && numbers[i] <= param.max;
        if !inside || (matches!(param.ty, Type::Int) && !is_u32(numbers[i])) {
            return false;
        }
        i += 1;
    }
    true
}

#[expect(
    clippy::float_cmp,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole numbers below 2^32 survive the way there and back exactly, others do not"
)]
const fn is_u32(number: f64) -> bool {
    number as u32 as f64 == number
}

/// Whether the field borrows what the host lends for one call: its struct needs a lifetime.
pub const fn is_lent(param: &Param) -> bool {
    match param.ty {
        Type::Text | Type::File | Type::Table | Type::Part => true,
        // A shape is a number.
        Type::Object(kind) => !matches!(kind, Kind::Shape),
        _ => false,
    }
}

/// Whether no parameter before `schema[at]` has its name.
pub const fn name_is_free(schema: &[Param], at: usize) -> bool {
    let name = schema[at].name.as_bytes();
    let mut i = 0;
    while i < at {
        if same(schema[i].name.as_bytes(), name, 0, name.len()) {
            return false;
        }
        i += 1;
    }
    true
}

/// Whether some number lies in the range.
pub const fn range_is_ordered(param: &Param) -> bool {
    param.min <= param.max
}

/// Whether a choice lists its words, and nothing else does.
pub const fn choice_is_said(param: &Param) -> bool {
    matches!(param.ty, Type::Choice) != param.choices.is_empty()
}

/// Whether the unit is empty or products and quotients of known units, as `Unit::parse` reads
/// them, without spaces and with exponents of one digit; alternatives are parted by `|`.
pub const fn unit_is_known(param: &Param) -> bool {
    let unit = param.unit.as_bytes();
    if unit.is_empty() {
        return true;
    }
    let mut start = 0;
    let mut i = 0;
    while i <= unit.len() {
        if i == unit.len() || matches!(unit[i], b'*' | b'/' | b'|') {
            if !factor_is_known(unit, start, i) {
                return false;
            }
            start = i + 1;
        }
        i += 1;
    }
    true
}

/// `bytes[start..end]` as `1`, `m` or `m^2`.
const fn factor_is_known(bytes: &[u8], start: usize, end: usize) -> bool {
    if end == start + 1 && bytes[start] == b'1' {
        return true;
    }
    let mut name_end = start;
    while name_end < end && bytes[name_end] != b'^' {
        name_end += 1;
    }
    if name_end != end {
        let minus = name_end + 1 < end && bytes[name_end + 1] == b'-';
        let digit = if minus { name_end + 2 } else { name_end + 1 };
        if digit + 1 != end || !bytes[digit].is_ascii_digit() {
            return false;
        }
    }
    let mut i = 0;
    while i < UNITS.len() {
        if same(UNITS[i].0.as_bytes(), bytes, start, name_end) {
            return true;
        }
        i += 1;
    }
    false
}

const fn same(known: &[u8], bytes: &[u8], start: usize, end: usize) -> bool {
    if known.len() != end - start {
        return false;
    }
    let mut i = 0;
    while i < known.len() {
        if known[i] != bytes[start + i] {
            return false;
        }
        i += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::super::{Role, Unit};
    use super::*;

    const PARAM: Param = Param {
        name: "x",
        doc: "x",
        ty: Type::Float,
        unit: "",
        role: Role::Plain,
        default: Preset::Absent,
        min: 0.0,
        max: 1.0,
        choices: &[],
        group: "",
        required: false,
        textured: false,
        deprecated: "",
        offset: 0,
    };

    #[test]
    fn units_of_schemas_are_those_that_scenes_can_read() {
        let units = [
            "m",
            "1/m",
            "W/m^2/sr",
            "µm",
            "W*m^-2/nm",
            "kg*m",
            "m^-",
            "EV",
            "1",
            "metre",
            "m^",
            "m^x",
            "M",
            "/m",
            "m/",
            "m^2^2",
            "",
        ];
        for unit in units {
            let known = unit_is_known(&Param { unit, ..PARAM });
            assert_eq!(known, unit.is_empty() || Unit::parse(unit).is_ok(), "{unit}");
        }
        assert!(unit_is_known(&Param { unit: "W/m^2/sr|nit", ..PARAM }));
        assert!(!unit_is_known(&Param { unit: "W|lumen", ..PARAM }));
    }

    #[test]
    fn a_default_is_judged_in_each_component_and_by_its_type() {
        let inside = |ty, numbers, max| {
            default_is_in_range(&Param { ty, default: Preset::Numbers(numbers), max, ..PARAM })
        };
        assert!(inside(Type::Float, [1.0; 4], 1.0));
        assert!(!inside(Type::Float, [f64::NAN; 4], 1.0));
        assert!(!inside(Type::Vec3, [0.0, 0.0, 2.0, 0.0], 1.0));
        assert!(inside(Type::Vec2, [0.0, 0.0, 2.0, 0.0], 1.0));
        assert!(inside(Type::Int, [4_294_967_295.0; 4], 1e10));
        assert!(!inside(Type::Int, [4_294_967_296.0; 4], 1e10));
        assert!(!inside(Type::Int, [0.5; 4], 1.0));
    }
}
