//! What every scene has, by subject: the use of each, what it gives, and an example.

use std::f64::consts::{PI, TAU};

use super::color::Make as C;
use super::math::Math as M;
use super::numbers::OfNumbers as N;
use super::transform::Transform as T;
use super::{Builtin, Constant, Run};

const fn builtin(
    name: &'static str,
    args: &'static [&'static str],
    run: Run,
    doc: &'static str,
    example: &'static str,
) -> Builtin {
    Builtin { name, args, run, doc, example }
}

pub(super) static CONSTANTS: [Constant; 2] = [
    Constant {
        name: "pi",
        value: PI,
        doc: "A circle's circumference over its diameter, 3.14159…, a number without a unit. An angle \
              is `pi * 1 rad`, or `180 deg`.",
        example: "2 * pi * 30 cm",
    },
    Constant {
        name: "tau",
        value: TAU,
        doc: "A circle's circumference over its radius, 6.28318…, a number without a unit: the radians \
              of a full turn.",
        example: "tau / 12 * 1 rad",
    },
];

pub(super) static NUMBERS: [Builtin; 19] = [
    builtin(
        "sin",
        &["x"],
        Run::Number(N::Sin),
        "The sine of an angle, in [-1, 1]. The angle has its unit: `sin(5)` is a mistake without \
         `units { angle = … }`.",
        "sin(30 deg)",
    ),
    builtin(
        "cos",
        &["x"],
        Run::Number(N::Cos),
        "The cosine of an angle, in [-1, 1].",
        "cos(60 deg)",
    ),
    builtin(
        "tan",
        &["x"],
        Run::Number(N::Tan),
        "The tangent of an angle: its sine over its cosine.",
        "2 m * tan(20 deg)",
    ),
    builtin(
        "asin",
        &["x"],
        Run::Number(N::Asin),
        "The angle, from -90 to 90 degrees, whose sine is a number in [-1, 1]; any other number is a \
         mistake (E0209).",
        "asin(0.5)",
    ),
    builtin(
        "acos",
        &["x"],
        Run::Number(N::Acos),
        "The angle, from 0 to 180 degrees, whose cosine is a number in [-1, 1]; any other number is a \
         mistake (E0209).",
        "acos(-0.5)",
    ),
    builtin(
        "atan",
        &["x"],
        Run::Number(N::Atan),
        "The angle, from -90 to 90 degrees, whose tangent is a number.",
        "atan(0.25)",
    ),
    builtin(
        "atan2",
        &["y", "x"],
        Run::Number(N::Atan2),
        "The angle from the x axis to the point (x, y), from -180 to 180 degrees, counter-clockwise \
         positive. Both are of one dimension; of (0, 0) it is 0.",
        "atan2(30 cm, 40 cm)",
    ),
    builtin(
        "sqrt",
        &["x"],
        Run::Number(N::Sqrt),
        "The square root of a number that is not negative, with the root of its unit: of square metres \
         it is metres. A unit without a root, as `m`, is a mistake (E0205).",
        "sqrt(2 m^2)",
    ),
    builtin(
        "abs",
        &["x"],
        Run::Number(N::Abs),
        "The number without its sign, with its unit.",
        "abs(-3 cm)",
    ),
    builtin(
        "min",
        &["a", "b"],
        Run::Number(N::Min),
        "The lesser of two numbers of one dimension.",
        "min(30 cm, 0.2 m)",
    ),
    builtin(
        "max",
        &["a", "b"],
        Run::Number(N::Max),
        "The greater of two numbers of one dimension.",
        "max(0, -0.5)",
    ),
    builtin(
        "clamp",
        &["x", "low", "high"],
        Run::Number(N::Clamp),
        "The number itself where it lies between `low` and `high`, else the nearer of the two. All three \
         are of one dimension; where `low` is above `high`, it is `high`.",
        "clamp(1.2, 0, 1)",
    ),
    builtin(
        "floor",
        &["x"],
        Run::Number(N::Floor),
        "The greatest whole number that is not above a number without a unit.",
        "floor(-1.5)",
    ),
    builtin(
        "ceil",
        &["x"],
        Run::Number(N::Ceil),
        "The least whole number that is not below a number without a unit.",
        "ceil(7 / 2)",
    ),
    builtin(
        "round",
        &["x"],
        Run::Number(N::Round),
        "The whole number nearest to a number without a unit; halves go away from zero.",
        "round(2.5)",
    ),
    builtin(
        "pow",
        &["x", "exponent"],
        Run::Math(M::Pow),
        "A number raised to a power, as `x ^ exponent`. The exponent has no unit; where `x` has one, the \
         exponent is a whole number from -9 to 9, and the result's unit is that power of it.",
        "pow(3 cm, 2)",
    ),
    builtin(
        "exp",
        &["x"],
        Run::Number(N::Exp),
        "e, 2.71828…, raised to a power without a unit.",
        "exp(-0.5)",
    ),
    builtin(
        "log",
        &["x"],
        Run::Number(N::Log),
        "The natural logarithm of a positive number without a unit; of any other it is a mistake \
         (E0209).",
        "log(100) / log(10)",
    ),
    builtin(
        "hash01",
        &["seed", "i"],
        Run::Number(N::Hash01),
        "Noise: a number in [0, 1), evenly spread, that depends on `seed` and `i` alone, two \
         numbers without a unit: the same two always give the same.",
        "360 deg * hash01(7, 3)",
    ),
];

pub(super) static VECTORS: [Builtin; 5] = [
    builtin(
        "len",
        &["list"],
        Run::Math(M::Len),
        "How many items a list or a vector has; of a table `#[ … ]`, how many numbers.",
        "len([2 m, 3 m, 5 m])",
    ),
    builtin(
        "length",
        &["v"],
        Run::Math(M::Length),
        "The length of a vector of three numbers, with their unit.",
        "length((3, 4, 0) m)",
    ),
    builtin(
        "normalize",
        &["v"],
        Run::Math(M::Normalize),
        "The vector of length 1, without a unit, that points where a vector of three numbers does. Of a \
         vector of zeros it is a mistake (E0209).",
        "normalize((1, 2, 2) m)",
    ),
    builtin(
        "dot",
        &["a", "b"],
        Run::Math(M::Dot),
        "The scalar product of two vectors of three numbers: their lengths times the cosine of the angle \
         between them. Its unit is the product of theirs.",
        "dot((1, 0, 0), (0.6, 0.8, 0))",
    ),
    builtin(
        "cross",
        &["a", "b"],
        Run::Math(M::Cross),
        "The vector product of two vectors of three numbers: at right angles to both, by the right \
         hand, and as long as the parallelogram between them has area. Its unit is the product of \
         theirs.",
        "cross((1, 0, 0), (0, 1, 0))",
    ),
];

pub(super) static COLOURS: [Builtin; 11] = [
    builtin(
        "rgb",
        &["r?", "g?", "b?"],
        Run::Color(C::Bare),
        "A mistake by itself (E0206), for red is another colour in each space: `rgb.linear_srgb`, \
         `rgb.srgb`, `rgb.acescg` or `rgb.rec2020` says which is meant.",
        "rgb.linear_srgb(0.6, 0.25, 0.1)",
    ),
    builtin(
        "rgb.linear_srgb",
        &["r", "g", "b"],
        Run::Color(C::LinearSrgb),
        "A colour by the amounts of the sRGB primaries, linear in light: twice the number is twice the \
         light, (1, 1, 1) is white (D65). What reflects keeps each in [0, 1]; light may go beyond.",
        "rgb.linear_srgb(0.6, 0.25, 0.1)",
    ),
    builtin(
        "rgb.srgb",
        &["r", "g", "b"],
        Run::Color(C::Srgb),
        "A colour as a screen's colour picker shows it, each component from 0 to 1 and encoded by the \
         curve of sRGB, which is taken off: 0.5 is 0.214 of the light.",
        "rgb.srgb(1, 0.5, 0)",
    ),
    builtin(
        "rgb.acescg",
        &["r", "g", "b"],
        Run::Color(C::AcesCg),
        "A colour by the amounts of the ACEScg primaries (AP1), linear in light. It is converted to \
         linear sRGB with the white adapted, so that (1, 1, 1) is white; a colour outside of sRGB has \
         components below 0 or above 1 there, which what reflects cannot have (E0210).",
        "rgb.acescg(0.4, 0.3, 0.2)",
    ),
    builtin(
        "rgb.rec2020",
        &["r", "g", "b"],
        Run::Color(C::Rec2020),
        "A colour by the amounts of the primaries of ITU-R BT.2020, linear in light; (1, 1, 1) is white \
         (D65). It is converted to linear sRGB; a colour outside of sRGB has components below 0 or above \
         1 there, which what reflects cannot have (E0210).",
        "rgb.rec2020(0.4, 0.3, 0.2)",
    ),
    builtin(
        "xyz",
        &["x", "y", "z"],
        Run::Color(C::Xyz),
        "A colour by its CIE 1931 tristimulus values, `y` being the luminance: (0.9505, 1, 1.0891) is \
         white (D65). It is converted to linear sRGB without adaptation.",
        "xyz(0.35, 0.3, 0.2)",
    ),
    builtin(
        "spectrum",
        &["points"],
        Run::Color(C::Spectrum),
        "A spectrum through points, each a wavelength and a value without a unit: straight between them; \
         beyond the first and the last it stays as it is there, but that of light is zero. Wavelengths \
         increase.",
        "spectrum([(400 nm, 0.1), (550 nm, 0.6), (700 nm, 0.3)])",
    ),
    builtin(
        "spectrum.file",
        &["path", "column?"],
        Run::Color(C::File),
        "A spectrum from a text file, found from the folder of the scene file that names it: a \
         wavelength in nm and values on each line, by blanks, commas or semicolons; `#` and `//` begin \
         comments. The second column counts, or the one that `column` names among the words of a first \
         line. Between and beyond its points it is as `spectrum`.",
        "spectrum.file(\"leaf.csv\", column = \"upper\")",
    ),
    builtin(
        "spectrum.constant",
        &["x"],
        Run::Color(C::Constant),
        "The same value, a number without a unit, at every wavelength.",
        "spectrum.constant(0.5)",
    ),
    builtin(
        "metal",
        &["name"],
        Run::Color(C::Metal),
        "The measured complex index of refraction of a metal, from 360 to 830 nm, for parameters that \
         take one, as the `eta` of `material conductor`: `Ag Al Au Cr Cu Fe Ni Ti W`, or a name such as \
         `gold`; case does not matter.",
        "metal(\"Au\")",
    ),
    builtin(
        "glass",
        &["name"],
        Run::Color(C::Glass),
        "The index of refraction of a glass, a crystal or a liquid, with its dispersion from 360 to \
         830 nm, for parameters that take one, as the `ior` of `material dielectric`: `N-BK7`, \
         `N-LASF9`, `SiO2`, `diamond`, `H2O`, `MgF2`, `TiO2`, or a name such as `water`; case does not matter.",
        "glass(\"N-BK7\")",
    ),
];

pub(super) static LIGHT: [Builtin; 3] = [
    builtin(
        "blackbody",
        &["temperature"],
        Run::Color(C::Blackbody),
        "The spectrum of a black body of a temperature of at least 1 K, scaled to the luminance Y = 1: \
         2700 K is a warm lamp, 6500 K about daylight. How much light there is, the light's own \
         parameter says. It is light's alone: what reflects cannot have it.",
        "blackbody(2700 K)",
    ),
    builtin(
        "illuminant",
        &["name"],
        Run::Color(C::Illuminant),
        "The spectrum of a CIE standard illuminant, scaled to the luminance Y = 1: `A`, `C`, `D50`, \
         `D65`, `E`, fluorescent lamps such as `FL11` and LEDs such as `LED-B3`; a wrong name lists all. \
         It is light's alone: what reflects cannot have it.",
        "illuminant(\"D65\")",
    ),
    builtin(
        "sun_position",
        &["latitude", "longitude", "time"],
        Run::Sun,
        "The unit vector towards the sun: +X is east, +Y up, -Z north. Latitude is positive in the north, \
         longitude in the east; the time, from 1900 to 2099, is ISO 8601 with its offset (`Z`, `+02:00`). \
         It errs by about 0.5 minutes of arc from 1999 to 2015 and by a few in this century; the \
         refraction of the air is left out.",
        "sun_position(51.5 deg, 0 deg, \"2026-06-21T17:30:00+01:00\")",
    ),
];

pub(super) static TRANSFORMS: [Builtin; 7] = [
    builtin(
        "rotate",
        &["axis", "angle"],
        Run::Transform(T::Rotate),
        "Turns about an axis through the origin by an angle, counter-clockwise where the axis points at \
         the viewer. The axis may be of any length but zero.",
        "rotate((0, 1, 0), 30 deg)",
    ),
    builtin(
        "move",
        &["by"],
        Run::Transform(T::Move),
        "Moves by a vector of lengths.",
        "move((1, 0, -0.5) m)",
    ),
    builtin(
        "scale",
        &["by"],
        Run::Transform(T::Scale),
        "Scales about the origin by a number, or by one for each axis, none of them zero; a negative one \
         mirrors.",
        "scale((1, 2, 1))",
    ),
    builtin(
        "matrix",
        &["rows"],
        Run::Transform(T::Matrix),
        "An affine transform by the sixteen numbers of its matrix, row by row, for column vectors: the \
         last column moves, in metres, and the last row is 0, 0, 0, 1. One that flattens space is a \
         mistake (E0412).",
        "matrix([1, 0.5, 0, 0,  0, 1, 0, 2,  0, 0, 1, 0,  0, 0, 0, 1])",
    ),
    builtin(
        "motion",
        &["keys"],
        Run::Transform(T::Motion),
        "Where something is at some times: pairs of a time and a transform or a list of them, times \
         increasing. In between it moves and stretches evenly and turns the shorter way; before the first \
         and after the last it stands.",
        "motion([(0 s, move((0, 0, 0) m)), (1 s, [rotate((0, 1, 0), 90 deg), move((1, 0, 0) m)])])",
    ),
    builtin(
        "spin",
        &["axis", "rate"],
        Run::Transform(T::Spin),
        "Turns for ever about an axis through the origin at an angular speed, counter-clockwise where the \
         axis points at the viewer; at 0 s it is not turned.",
        "spin((0, 1, 0), 360 deg/s)",
    ),
    builtin(
        "look_at",
        &["from", "to", "up"],
        Run::Transform(T::LookAt),
        "The `look` of a camera that stands at one point and looks at another, and `up` is upwards in \
         the picture. `up` is of any length but zero; it need not be at right angles to the view, but is \
         not parallel to it.",
        "look_at(from = (0, 1.5, 5) m, to = (0, 1, 0) m, up = (0, 1, 0))",
    ),
];
