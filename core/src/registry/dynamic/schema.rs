//! A library's schema, checked: what the derive makes a compile error is an error here too.

use luxel_sdk::abi::{ClassTable, HANDLE, ParamTable, Slice, TYPES};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{
    ComplexIor, Emission, File, Look, Maybe, Param, Preset, Role, Table, Text, Type,
    choice_is_said, default_is_in_range, name_is_free, range_is_ordered, unit_is_known,
};

use super::remote::HEAD;
use crate::registry::common_params;

/// Most bytes of a text, and most parameters of a class: more is no schema.
const MOST_TEXT: usize = 1 << 20;
const MOST_PARAMS: usize = 1 << 10;
/// Most bytes of a parameter struct.
pub(super) const MOST_STRUCT: usize = 256;

/// The roles, by their number in the boundary.
const ROLES: [Role; 8] = [
    Role::Plain,
    Role::Reflectance,
    Role::Illuminant,
    Role::Ior,
    Role::ComplexIor,
    Role::Coefficient,
    Role::Waves,
    Role::Count,
];

/// Values in a row; an error where there are too many or where they stand nowhere.
///
/// # Safety
/// A library that is never unloaded lends them.
pub(super) unsafe fn items<T>(of: Slice<T>, most: usize) -> Result<&'static [T], String> {
    if of.is_null() && !of.is_empty() {
        return Err("stands nowhere".to_owned());
    }
    if of.len() > most {
        return Err(format!("claims {} values where at most {most} can be", of.len()));
    }
    // SAFETY: the caller says so.
    Ok(unsafe { of.get() })
}

/// A text that is UTF-8.
///
/// # Safety
/// A library that is never unloaded lends it.
pub(super) unsafe fn text(of: Text<'static>) -> Result<&'static str, String> {
    // SAFETY: the caller says so.
    let bytes = unsafe { items(of.bytes(), MOST_TEXT) }?;
    std::str::from_utf8(bytes).map_err(|_| "is not UTF-8".to_owned())
}

/// A name of the language: not empty, `[a-z0-9_]`.
///
/// # Safety
/// As `text`.
pub(super) unsafe fn name(of: Text<'static>) -> Result<&'static str, String> {
    // SAFETY: the caller says so.
    let name = unsafe { text(of) }?;
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name.is_empty() || !name.chars().all(legal) {
        return Err(format!("is \"{}\", not of a-z, 0-9 and _", name.escape_debug()));
    }
    Ok(name)
}

/// A class's parameters, as the host knows them: offsets count from the head.
///
/// # Safety
/// As `text`.
pub(super) unsafe fn params(kind: Kind, class: &ClassTable) -> Result<Vec<Param>, String> {
    // SAFETY: the caller says so.
    let tables = unsafe { items(class.params, MOST_PARAMS) }
        .map_err(|why| format!("its list of parameters {why}"))?;
    let mut out: Vec<Param> = vec![];
    for (i, table) in tables.iter().enumerate() {
        // SAFETY: as above.
        let name = unsafe { name(table.name) }
            .map_err(|why| format!("the name of parameter {} {why}", i + 1))?;
        // SAFETY: as above.
        let param = unsafe { param(name, table, class.size as usize) }
            .map_err(|why| format!("parameter `{name}` {why}"))?;
        if is_hosts(kind, &param) {
            return Err(format!(
                "parameter `{name}` is called like one that the host adds or reads"
            ));
        }
        if let Some(other) = out.iter().find(|other| stand_together(other, &param)) {
            return Err(format!("parameter `{name}` stands on `{}`", other.name));
        }
        out.push(param);
        if !name_is_free(&out, i) {
            return Err(format!("parameter `{name}` is there twice"));
        }
    }
    Ok(out)
}

/// Whether the host would take a parameter for one of its own: of all shapes, say, it looks at what
/// their `material` is.
fn is_hosts(kind: Kind, param: &Param) -> bool {
    let shape = kind == Kind::Light && param.name == "shape";
    let added = common_params(kind).iter().any(|own| own.name == param.name);
    added || (shape && param.ty != Type::Object(Kind::Shape))
}

/// Whether the host would write one over the other. The amounts of a light share their field, and a
/// metal's `k` stands inside the field of its `eta`.
fn stand_together(a: &Param, b: &Param) -> bool {
    let light = a.ty == Type::Emission && b.ty == Type::Emission;
    let metal = a.role == Role::ComplexIor && b.role == Role::ComplexIor;
    !(light || metal) && covers(a, b.offset, layout(b.ty).0)
}

/// Whether these bytes of the host's block hold a part of a parameter.
fn covers(param: &Param, start: usize, bytes: usize) -> bool {
    start < param.offset + layout(param.ty).0 && param.offset < start + bytes
}

/// Where the address of a shared table is written, as the host knows it.
pub(super) fn shared_offset(class: &ClassTable, params: &[Param]) -> Result<usize, String> {
    const BYTES: usize = size_of::<usize>();
    let (at, size) = (class.shared_offset, class.size as usize);
    let offset = usize::try_from(at).unwrap_or(usize::MAX);
    if offset.saturating_add(BYTES) > size || !offset.is_multiple_of(BYTES) {
        return Err(format!(
            "its shared table at {at} is not inside its struct of {size} bytes or not aligned"
        ));
    }
    match params.iter().find(|param| covers(param, offset + HEAD, BYTES)) {
        Some(other) => Err(format!("its shared table at {at} stands on `{}`", other.name)),
        None => Ok(offset + HEAD),
    }
}

/// # Safety
/// As `text`.
unsafe fn param(name: &'static str, table: &ParamTable, size: usize) -> Result<Param, String> {
    let say = |what: &'static str| move |why: String| format!("has a {what} that {why}");
    // SAFETY: the caller says so, here and below.
    let doc = unsafe { text(table.doc) }.map_err(say("doc"))?;
    // SAFETY: as above.
    let unit = unsafe { text(table.unit) }.map_err(say("unit"))?;
    // SAFETY: as above.
    let group = unsafe { text(table.group) }.map_err(say("group"))?;
    // SAFETY: as above.
    let deprecated = unsafe { text(table.deprecated) }.map_err(say("new name"))?;
    // SAFETY: as above.
    let preset_text = unsafe { text(table.text) }.map_err(say("default"))?;
    // SAFETY: as above.
    let choices = unsafe { items(table.choices, MOST_PARAMS) }.map_err(say("list of choices"))?;
    for choice in choices {
        // SAFETY: as above.
        unsafe { self::name(*choice) }.map_err(say("choice"))?;
    }
    let ty = type_of(table.ty).ok_or_else(|| format!("has the unknown type {}", table.ty))?;
    let role = ROLES.get(table.role as usize).copied();
    let is_length = ty == Type::Spectrum && unit == "m";
    let is_given = table.preset == 0 && table.flags & 2 == 0;
    if role == Some(Role::Waves) && !(is_length && is_given) {
        let message = "has the role waves, for spectra in m without default and texture";
        return Err(message.to_owned());
    }
    let default = match table.preset {
        0 => Preset::Absent,
        1 => Preset::Numbers(table.numbers),
        2 => Preset::Index(index(table.numbers[0], choices.len())?),
        3 => Preset::Text(preset_text),
        other => return Err(format!("has the unknown kind of default {other}")),
    };
    let offset = usize::try_from(table.offset).map_err(|_| "stands nowhere".to_owned())?;
    let (bytes, align) = layout(ty);
    if offset.checked_add(bytes).is_none_or(|end| end > size) || !offset.is_multiple_of(align) {
        return Err(format!(
            "takes {bytes} bytes at {offset}, which is not inside the struct of {size} bytes or not \
             aligned"
        ));
    }
    let param = Param {
        name,
        doc,
        ty,
        unit,
        role: role.ok_or_else(|| format!("has the unknown role {}", table.role))?,
        default,
        min: table.min,
        max: table.max,
        choices,
        group,
        required: table.flags & 1 != 0,
        textured: table.flags & 2 != 0,
        deprecated,
        offset: offset + HEAD,
    };
    judge(&param)?;
    Ok(param)
}

/// What the derive asserts while a plugin compiles.
fn judge(param: &Param) -> Result<(), String> {
    let Param { unit, min, max, .. } = param;
    let textured = matches!(
        param.ty,
        Type::Float | Type::Vec3 | Type::Spectrum | Type::ComplexIor | Type::Emission
    );
    let wrong = if param.doc.is_empty() {
        "has no doc: it becomes the manual".to_owned()
    } else if !unit_is_known(param) {
        format!("has the unknown unit `{unit}`")
    } else if !range_is_ordered(param) {
        format!("has the empty range [{min}, {max}]")
    } else if !default_is_of_type(param) {
        "has a default that is of another type".to_owned()
    } else if !default_is_in_range(param) {
        format!("has a default outside its range [{min}, {max}]")
    } else if !choice_is_said(param) {
        "is a choice without words, or has words and is none".to_owned()
    } else if param.textured && !textured {
        "is of a type that a texture cannot drive".to_owned()
    } else if matches!(param.ty, Type::Object(Kind::Material) | Type::Part)
        && !is_always_given(param)
    {
        "is a handle that a scene may leave out: handles are required".to_owned()
    } else {
        return Ok(());
    };
    Err(wrong)
}

/// Whether each object has it: one of a group may be absent.
fn is_always_given(param: &Param) -> bool {
    param.required && param.group.is_empty()
}

fn default_is_of_type(param: &Param) -> bool {
    match param.default {
        Preset::Absent => true,
        Preset::Index(_) => param.ty == Type::Choice,
        Preset::Text(_) => param.ty == Type::Text,
        Preset::Numbers(_) => !matches!(
            param.ty,
            Type::Choice
                | Type::Text
                | Type::File
                | Type::Table
                | Type::Look
                | Type::Object(_)
                | Type::Part
        ),
    }
}

fn index(number: f64, n: usize) -> Result<u32, String> {
    let index = crate::cast::whole(number);
    if (index as usize) < n && (f64::from(index) - number).abs() <= 0.0 {
        return Ok(index);
    }
    Err(format!("has the default {number}, which is none of its {n} choices"))
}

fn type_of(number: u32) -> Option<Type> {
    if let Some(kind) = number.checked_sub(HANDLE) {
        let (kind, _) = Kind::ALL.get(kind as usize)?;
        let held = matches!(kind, Kind::Material | Kind::Phase | Kind::Shape | Kind::Texture);
        return held.then_some(Type::Object(*kind));
    }
    TYPES.get(number as usize).copied()
}

/// Size and alignment of what the host writes.
fn layout(ty: Type) -> (usize, usize) {
    fn of<T>() -> (usize, usize) {
        (size_of::<T>(), align_of::<T>())
    }
    match ty {
        Type::Float => of::<f32>(),
        Type::Double => of::<f64>(),
        Type::Int | Type::Choice | Type::Object(Kind::Shape) => of::<u32>(),
        Type::Bool => of::<bool>(),
        Type::Vec2 => of::<glam::Vec2>(),
        Type::Vec3 => of::<glam::Vec3>(),
        Type::DVec3 => of::<glam::DVec3>(),
        Type::Spectrum => of::<luxel_sdk::color::Spectrum>(),
        Type::ComplexIor => of::<ComplexIor>(),
        Type::Text => of::<Text<'_>>(),
        Type::File => of::<File<'_>>(),
        Type::Table => of::<Table<'_>>(),
        Type::Look => of::<Look>(),
        Type::MaybeFloat => of::<Maybe<f32>>(),
        Type::Emission => of::<Emission>(),
        Type::Object(_) | Type::Part => (2 * size_of::<usize>(), align_of::<usize>()),
    }
}
