//! Values against made-up parameters.

use luxel_sdk::params::{Preset, Text};

use super::*;

const WORDS: [Text<'static>; 2] = [Text::new("ggx"), Text::new("beckmann")];

const LENGTH: Param = Param {
    name: "radius",
    doc: "",
    ty: Type::Double,
    unit: "m",
    role: Role::Plain,
    default: Preset::Absent,
    min: 0.0,
    max: f64::INFINITY,
    choices: &[],
    group: "",
    required: true,
    textured: false,
    deprecated: "",
    offset: 0,
};

fn fit(param: &Param, given: Given) -> Result<Value, &'static str> {
    conform(param, given, &|_| None).map_err(|misfit| misfit.code)
}

#[test]
fn a_length_wants_its_unit_and_its_range() {
    let cm = |x| Given::Number(x, Dimension::LENGTH);
    assert_eq!(fit(&LENGTH, cm(0.05)), Ok(Value::Number(0.05, Dimension::LENGTH)));
    assert_eq!(fit(&LENGTH, Given::Number(5.0, Dimension::ANGLE)), Err("E0202"));
    assert_eq!(fit(&LENGTH, cm(-1.0)), Err("E0405"));
    assert_eq!(fit(&LENGTH, cm(f64::NAN)), Err("E0209"));
    assert_eq!(fit(&LENGTH, Given::Bool(true)), Err("E0214"));
    let bare = Given::Number(5.0, Dimension::NONE);
    let misfit = conform(&LENGTH, bare.clone(), &|_| None).unwrap_err();
    assert_eq!((misfit.code, misfit.units), ("E0201", vec!["m", "cm", "mm"]));
    let waves = Param { role: Role::Waves, ..LENGTH };
    let misfit = conform(&waves, bare.clone(), &|_| None).unwrap_err();
    assert_eq!(misfit.units, ["nm", "um"]);
    assert!(misfit.message.ends_with("wants a unit, as in nm"), "{}", misfit.message);
    let mm = |d: Dimension| (d == Dimension::LENGTH).then_some(1e-3);
    assert_eq!(conform(&LENGTH, bare, &mm), Ok(Value::Number(5.0 * 1e-3, Dimension::LENGTH)));
}

#[test]
fn whole_numbers_stay_whole() {
    let int = Param { ty: Type::Int, unit: "", ..LENGTH };
    let plain = |x| Given::Number(x, Dimension::NONE);
    assert_eq!(fit(&int, plain(3.0)), Ok(Value::Number(3.0, Dimension::NONE)));
    assert_eq!(fit(&int, plain(1.5)), Err("E0208"));
    assert_eq!(fit(&int, plain(-1.0)), Err("E0405"));
    assert_eq!(fit(&int, plain(4294967296.0)), Err("E0405"));
    let few = Param { max: 9.0, ..int };
    let misfit = conform(&few, plain(-1.0), &|_| None).unwrap_err();
    assert!(misfit.message.ends_with("from 0 to 9"), "{}", misfit.message);
    let size = Param { ty: Type::Vec2, role: Role::Count, ..int };
    let pair = |x, y| Given::Numbers(Arc::from([x, y]), Dimension::NONE);
    assert_eq!(fit(&size, pair(640.0, 480.0)), Ok(Value::vector([640.0, 480.0])));
    assert_eq!(fit(&size, pair(640.0, 480.5)), Err("E0208"));
}

#[test]
fn amounts_of_light_take_radiometric_and_photometric_units() {
    let power = Param { ty: Type::Emission, unit: "W|lm", group: "amount", ..LENGTH };
    let lumen = Unit::named("lm").unwrap().dimension;
    assert!(fit(&power, Given::Number(800.0, lumen)).is_ok());
    assert!(fit(&power, Given::Number(60.0, Dimension::POWER)).is_ok());
    assert_eq!(fit(&power, Given::Number(60.0, Dimension::LENGTH)), Err("E0213"));
}

#[test]
fn a_reflectance_reflects_no_more_than_all() {
    let albedo = Param {
        ty: Type::Spectrum,
        unit: "",
        role: Role::Reflectance,
        max: 1.0,
        textured: true,
        ..LENGTH
    };
    let rgb = |c| Given::Color(Color::Rgb(c), Dimension::NONE);
    assert!(fit(&albedo, rgb([0.2, 0.5, 1.0])).is_ok());
    assert_eq!(fit(&albedo, rgb([0.2, 1.3, 1.0])), Err("E0210"));
    assert_eq!(fit(&albedo, rgb([-0.2, 0.3, 1.0])), Err("E0405"));
    let rounded = fit(&albedo, rgb([1.0 + f64::EPSILON, 0.0, -f64::EPSILON])).unwrap();
    assert_eq!(rounded, Value::Color(Color::Rgb([1.0, 0.0, 0.0]), Dimension::NONE));
    let light = Given::Color(Color::Blackbody(3000.0), Dimension::NONE);
    assert_eq!(fit(&albedo, light), Err("E0214"));
    assert_eq!(fit(&albedo, Given::Node(NodeId(3), Kind::Texture)), Ok(Value::Node(NodeId(3))));
    assert_eq!(fit(&albedo, Given::Node(NodeId(3), Kind::Shape)), Err("E0408"));
    let three: Arc<[f64]> = Arc::new([1.0, 0.0, 0.0]);
    assert_eq!(fit(&albedo, Given::Numbers(three, Dimension::NONE)), Err("E0206"));
}

#[test]
fn a_length_in_waves_is_a_length() {
    let film = Param { ty: Type::Spectrum, role: Role::Waves, ..LENGTH };
    let waves = |x| Ok(Value::Color(Color::Waves(x), Dimension::LENGTH));
    assert_eq!(fit(&film, Given::Number(3e-7, Dimension::LENGTH)), waves(3e-7));
    assert_eq!(fit(&film, Given::Number(-3e-7, Dimension::LENGTH)), Err("E0405"));
    assert_eq!(fit(&film, Given::Number(3e-7, Dimension::NONE)), Err("E0201"));
    for (wrong, words) in [
        (Color::Rgb([1e-7; 3]), "a colour"),
        (Color::Curve([(400.0, 1e-7), (700.0, 2e-7)].into()), "a spectrum"),
        (Color::Blackbody(3000.0), "a black body's spectrum"),
    ] {
        let misfit = conform(&film, Given::Color(wrong, Dimension::LENGTH), &|_| None).unwrap_err();
        let told = format!("`radius` wants a length, not {words}");
        assert_eq!((misfit.code, misfit.message), ("E0214", told));
    }
}

#[test]
fn a_choice_names_the_nearest_word() {
    let choice = Param { ty: Type::Choice, choices: &WORDS, ..LENGTH };
    let misfit = conform(&choice, Given::Text("gxg".into()), &|_| None).unwrap_err();
    assert_eq!((misfit.code, misfit.word.map(|near| near.name)), ("E0416", Some("ggx")));
}

#[test]
fn vectors_have_their_length_and_tables_their_numbers() {
    let vector = Param { ty: Type::DVec3, min: f64::NEG_INFINITY, ..LENGTH };
    let numbers = |v: &[f64]| Given::Numbers(v.into(), Dimension::LENGTH);
    assert_eq!(fit(&vector, numbers(&[1.0, 2.0])), Err("E0207"));
    assert_eq!(fit(&vector, numbers(&[1.0, 2.0, -3.0])), Ok(Value::vector([1.0, 2.0, -3.0])));
    let table = Param { ty: Type::Table, ..LENGTH };
    let misfit = conform(&table, numbers(&[1.0, -2.0]), &|_| None).unwrap_err();
    assert!(misfit.message.contains("[1]"), "{}", misfit.message);
}
