//! Colours, spectra and numbers for parameters that vary over wavelengths.

use std::sync::Arc;

use luxel_sdk::params::{Param, Role, Type};

use super::super::{Color, Value};
use super::{DefaultUnits, Given, Misfit, in_range, unit_of, wrong_type};

/// Rounding that converting between RGB spaces adds to a component of at most 1: a product of three
/// 3×3 matrices whose rows sum to about 1, under 64 ulp.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Fits a colour or a number to a parameter that varies over wavelengths.
pub(super) fn conform(
    param: &Param,
    given: Given,
    units: DefaultUnits<'_>,
) -> Result<Value, Misfit> {
    let (color, found) = match given {
        Given::Number(x, dimension) => (Color::Constant(x), dimension),
        Given::Color(color, dimension) => (color, dimension),
        Given::Numbers(v, _) if v.len() == 3 => {
            let message = format!("`{}` wants a colour; three numbers name no space", param.name);
            return Err(Misfit::new("E0206", message).help(
                "write `rgb.linear_srgb(r, g, b)`, or `rgb.srgb` for values picked from a screen",
            ));
        }
        given => return Err(wrong_type(param, &given)),
    };
    let (scale, dimension) = unit_of(param, found, units)?;
    let scaled = (scale - 1.0).abs() > 0.0;
    let color = if scaled { color.scaled(scale) } else { color };
    let role = if param.ty == Type::Emission { Role::Illuminant } else { param.role };
    suits(param, role, &color)?;
    let color = match check_range(param, color)? {
        Color::Constant(length) if role == Role::Waves => Color::Waves(length),
        color => color,
    };
    Ok(Value::Color(color, dimension))
}

/// Whether a colour of this form makes sense for the role.
fn suits(param: &Param, role: Role, color: &Color) -> Result<(), Misfit> {
    let form = match color {
        Color::Scaled(inner, _) => &**inner,
        color => color,
    };
    let (what, legal) = match form {
        Color::Rgb(_) => ("a colour", !matches!(role, Role::Ior | Role::Waves)),
        Color::Curve(_) => ("a spectrum", role != Role::Waves),
        // Factors are folded, so that none stands in another.
        Color::Constant(_) | Color::Scaled(..) => return Ok(()),
        Color::Waves(_) => ("a length", role == Role::Waves),
        Color::Blackbody(_) => ("a black body's spectrum", emits(role)),
        Color::Illuminant(_) => ("an illuminant", emits(role)),
        Color::Metal(_) => ("a metal", role == Role::ComplexIor && param.ty == Type::ComplexIor),
        Color::Glass(_) => ("a glass", matches!(role, Role::Ior | Role::ComplexIor)),
    };
    if legal {
        return Ok(());
    }
    let wanted = match role {
        Role::Reflectance => "a fraction of light: a colour or spectrum in [0, 1]",
        Role::Illuminant => "light: a colour, a spectrum, `blackbody(…)` or `illuminant(…)`",
        Role::Ior => "an index of refraction: a number, a spectrum or `glass(…)`",
        Role::ComplexIor => "an index of refraction: a number, a spectrum or `metal(…)`",
        Role::Coefficient => "a coefficient: a number, colour or spectrum per length",
        Role::Waves => "a length",
        Role::Plain | Role::Count => "a colour or spectrum",
    };
    let message = format!("`{}` wants {wanted}, not {what}", param.name);
    Err(Misfit::new("E0214", message))
}

fn emits(role: Role) -> bool {
    matches!(role, Role::Illuminant | Role::Plain)
}

/// Checks every number of a colour; rounding beyond a reflectance's range is taken off.
fn check_range(param: &Param, color: Color) -> Result<Color, Misfit> {
    let snap = |x: f64| {
        let near = |limit: f64| (x - limit).abs() <= ROUNDING * limit.abs().max(1.0);
        if x > param.max && near(param.max) {
            param.max
        } else if x < param.min && near(param.min) {
            param.min
        } else {
            x
        }
    };
    match color {
        Color::Rgb(c) => {
            let c = c.map(snap);
            for (x, name) in c.into_iter().zip(["red", "green", "blue"]) {
                // A saturated light may lie outside the gamut; what reflects may not.
                if param.role == Role::Reflectance || !x.is_finite() {
                    in_range(param, x, &format!("'s {name}"))?;
                }
            }
            Ok(Color::Rgb(c))
        }
        Color::Constant(x) => in_range(param, snap(x), "").map(|()| Color::Constant(snap(x))),
        Color::Curve(points) => {
            let curve: Arc<[(f64, f64)]> = points.iter().map(|(nm, x)| (*nm, snap(*x))).collect();
            for (nm, x) in &*curve {
                in_range(param, *x, &format!(" at {nm} nm"))?;
            }
            Ok(Color::Curve(curve))
        }
        Color::Scaled(inner, factor) => {
            let message = || format!("`{}` is scaled by {factor}", param.name);
            if !factor.is_finite() || factor < 0.0 && param.min >= 0.0 {
                return Err(Misfit::new("E0405", message()));
            }
            if let Color::Curve(points) = &*inner {
                let scaled = points.iter().map(|(nm, x)| (*nm, x * factor)).collect();
                return check_range(param, Color::Curve(scaled));
            }
            Ok(Color::Scaled(inner, factor))
        }
        color => Ok(color),
    }
}
