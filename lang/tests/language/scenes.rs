//! Whole scenes: what they become.

use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::scene::{Color, Scene, Value, print};
use luxel_lang::{Loaded, ParamLimits, ParamValue, Settings, load};

use crate::registry::registry;

const HEAD: &str = "scene 1
camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)) }
";

fn files() -> MemoryFiles {
    MemoryFiles::default()
        .with("cornell.scene", &include_bytes!("../scenes/cornell.scene")[..])
        .with("cornell/white.spd", &b"400 0.3\n700 0.7\n"[..])
        .with("parametric.scene", &include_bytes!("../scenes/parametric.scene")[..])
        .with("glass_fog.scene", &include_bytes!("../scenes/glass_fog.scene")[..])
        .with("lib/metals.scene", &include_bytes!("../scenes/lib/metals.scene")[..])
        .with("lib/studio.scene", &include_bytes!("../scenes/lib/studio.scene")[..])
}

fn load_text(text: &str, set: &[(&str, &str)]) -> Loaded {
    let files = files().with("test.scene", text.as_bytes());
    load_file(&files, "test.scene", set)
}

fn load_file(files: &MemoryFiles, path: &str, set: &[(&str, &str)]) -> Loaded {
    let set = set.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    load(Path::new(path), files, &registry(), &Settings { set, ..Settings::default() })
}

/// The scene of a text that must be right.
fn scene(text: &str, set: &[(&str, &str)]) -> Scene {
    let loaded = load_text(&format!("{HEAD}{text}"), set);
    assert_eq!(loaded.diagnostics, []);
    loaded.scene.expect("there is no mistake")
}

/// The values of a parameter in the scene's nodes, in order.
fn values(scene: &Scene, name: &str) -> Vec<Value> {
    let found = scene.nodes.iter().filter_map(|node| node.get(name));
    found.map(|argument| argument.value.clone()).collect()
}

fn numbers(scene: &Scene, name: &str) -> Vec<f64> {
    let number = |value| match value {
        Value::Number(x, _) => x,
        other => panic!("{other:?}"),
    };
    values(scene, name).into_iter().map(number).collect()
}

#[test]
fn the_examples_are_scenes_without_a_mistake() {
    for (path, shapes) in [("cornell.scene", 8), ("parametric.scene", 3), ("glass_fog.scene", 4)] {
        let loaded = load_file(&files(), path, &[]);
        assert_eq!(loaded.diagnostics, [], "{path}");
        let scene = loaded.scene.unwrap();
        let found = scene.nodes.iter().filter(|n| n.kind.word() == "shape").count();
        assert!(found >= shapes, "{path}: {found}");
        assert!(scene.camera.is_some() && scene.film.is_some());
    }
}

#[test]
fn a_scene_prints_the_same_whenever_it_is_read() {
    let dump = || print(&load_file(&files(), "parametric.scene", &[]).scene.unwrap());
    let text = dump();
    assert_eq!(text, dump());
    assert!(text.contains("camera = n") && text.contains("shape box \"tread\""), "{text}");
}

#[test]
fn units_become_si_and_bare_numbers_take_the_files_unit() {
    let scene = scene(
        "units { length = mm }\nshape sphere { radius = 5 cm }\nshape sphere { radius = 5 }",
        &[],
    );
    // 5·0.01 and 5·0.001, each rounded once.
    assert_eq!(numbers(&scene, "radius"), [5.0 * 0.01, 5.0 * 0.001]);
}

#[test]
fn transforms_apply_first_to_last() {
    let text = "shape sphere { radius = 1 m, transform = [move((1, 0, 0) m), scale(2)] }
group { transform = [move((0, 1, 0) m)]
  shape sphere { radius = 2 m, transform = [rotate((0, 0, 1), 90 deg)] } }";
    let scene = scene(text, &[]);
    let place = fixed(&scene.root.items[0].pose).transform_point3(glam::DVec3::ZERO);
    assert_eq!(place, glam::DVec3::new(2.0, 0.0, 0.0));
    assert_eq!(fixed(&scene.root.items[1].pose).translation, glam::DVec3::Y);
    let turned = fixed(&scene.groups[0].items[0].pose).transform_point3(glam::DVec3::X);
    // One rounding of cos 90° and one of the product.
    assert!((turned - glam::DVec3::Y).length() < 2.0 * f64::EPSILON, "{turned}");
}

#[test]
fn expectations_print_as_they_are_said_and_change_no_hash() {
    let head = "param rho: float = 0.5\nparam away: length = 2 m\n";
    let said = "expect mean = 1 / (1 - rho) +- 1e-3 * 2
        expect pixel (3, 4) = (1, 2, 0.5)
        expect region (1, 2, 3, 4) = rgb.linear_srgb(1, 0, 0) ± 0.1
        expect same_as \"cornell.scene\"
          where { rho = 0.9, away = 30 cm }
        for r in [0.1, 0.2] { expect mean = 1 - rho where { rho = r } }";
    let printed = [
        "expect mean = 2 ± 0.002",
        "expect pixel (3, 4) = (1, 2, 0.5)",
        "expect region (1, 2, 3, 4) = (1, 0, 0) ± 0.1",
        "expect same_as \"cornell.scene\" where { rho = 0.9, away = 0.3 m }",
        "expect mean = 0.5 where { rho = 0.1 }",
        "expect mean = 0.5 where { rho = 0.2 }",
    ];
    let (bare, told) = (scene(head, &[]), scene(&format!("{head}{said}"), &[]));
    let text = print(&told);
    assert_eq!(text.strip_prefix(&print(&bare)).unwrap().lines().collect::<Vec<_>>(), printed);
    assert_eq!((bare.hash(), bare.measured_hash()), (told.hash(), told.measured_hash()));
}

#[test]
fn a_text_that_an_expectation_sets_is_read_as_it_was_said() {
    let text = "param form: string = \"box\"
        expect mean = 1 where { form = \"a \\\"b\\\" \\\\ \\n\" }
        shape sphere \"x\" { center = (0, 0, 0) m, radius = if form == \"a \\\"b\\\" \\\\ \\n\" { 1 m } else { 2 m } }";
    let (name, value) = scene(text, &[]).expectations[0].given[0].clone();
    assert_eq!(numbers(&scene(text, &[]), "radius"), [2.0]);
    assert_eq!(numbers(&scene(text, &[(&*name, &*value)]), "radius"), [1.0]);
}

#[test]
fn set_changes_labelled_objects_and_off_takes_them_out() {
    let text = "shape sphere \"a\" { radius = 1 m }\n@off shape sphere \"b\" { radius = 2 m }
set a.radius = 3 m\nset b.radius = 4 m\nset a.radius = 5 m";
    assert_eq!(numbers(&scene(text, &[]), "radius"), [5.0]);
}

#[test]
fn functions_loops_conditions_and_lists_do_what_they_say() {
    let text = "fn twice(x: length, by: float = 2) = x * by
fn ball(r: length) { if r > 2 m { shape sphere { radius = r } } else { shape sphere { radius = twice(r, by = 10) } } }
let radii = [for i in 1..=3 if i != 2 => i * 1 m]
for r in radii { ball(r) }
for i, r in [7 m, 8 m] { shape sphere { radius = r + i * 1 cm } }";
    assert_eq!(numbers(&scene(text, &[]), "radius"), [10.0, 3.0, 7.0, 8.0 + 0.01]);
}

#[test]
fn with_makes_a_changed_copy_and_equal_objects_have_equal_hashes() {
    let text = "let a = material dielectric { roughness = 0.1 }\nlet b = a with { roughness = 0.3 }
shape sphere { radius = 1 m, material = a }\nshape sphere { radius = 1 m, material = b }
shape sphere \"other label\" { radius = 100 cm, material = material dielectric { roughness = 0.1 } }";
    let scene = scene(text, &[]);
    let spheres: Vec<_> = scene.nodes.iter().filter(|n| n.class == "sphere").collect();
    assert_eq!(spheres[0].hash, spheres[2].hash);
    assert_ne!(spheres[0].hash, spheres[1].hash);
}

#[test]
fn unused_objects_are_left_out_and_shared_ones_are_shared() {
    let text = "let unused = material diffuse {}\nlet grey = material diffuse {}
let ball = group { shape sphere { radius = 1 m, material = grey } }
for i in 0..5 { place ball { transform = [move(i * (1, 0, 0) m)] } }";
    let scene = scene(text, &[]);
    assert_eq!((scene.nodes.len(), scene.groups.len(), scene.root.items.len()), (3, 1, 5));
}

#[test]
fn settings_reach_declared_parameters() {
    let text = "/// How wide.\nparam r: length = 1 m in 0.5 m..=20 m\nparam q: string = \"draft\"
shape sphere { radius = if q == \"final\" { 2 * r } else { r } }";
    let with = |set: &[(&str, &str)]| numbers(&scene(text, set), "radius");
    assert_eq!(with(&[]), [1.0]);
    assert_eq!(with(&[("r", "2 m"), ("q", "final")]), [4.0]);
    let loaded = load_text(&format!("{HEAD}{text}"), &[]);
    let info = &loaded.params[0];
    assert_eq!(
        (&*info.name, &*info.ty, &*info.unit, &*info.doc),
        ("r", "length", "m", "How wide.")
    );
    assert_eq!((&*info.default, info.range.as_deref()), ("1 m", Some("0.5 m..=20 m")));
}

#[test]
fn a_param_tells_its_value_and_range_in_si_and_the_unit_of_its_author() {
    let text = "param tilt: angle = -(30 deg) in (-90 deg)..90 deg\nparam n: int = 24 in 2..=200
param gap: length = 2 * 1e1 cm\nparam lit: bool = true\nparam of: string = \"oak\"
param far: length = 0.5 m in 0 m..=1e3 mm\nparam w: power = 3 W\nparam tint: color = rgb.srgb(1, 0, 0)";
    let loaded = load_text(&format!("{HEAD}{text}"), &[("tilt", "1 rad"), ("n", "3")]);
    assert_eq!(loaded.diagnostics, []);
    let deg = std::f64::consts::PI / 180.0;
    let of = |name: &str| loaded.params.iter().find(|param| param.name == name).unwrap();
    let tilt = of("tilt");
    assert_eq!(tilt.value, ParamValue::Number(1.0));
    assert_eq!(
        tilt.limits,
        Some(ParamLimits { low: -90.0 * deg, high: 90.0 * deg, inclusive: false })
    );
    assert_eq!(tilt.written, Some(("deg".to_owned(), deg)));
    let n = ParamLimits { low: 2.0, high: 200.0, inclusive: true };
    assert_eq!((&of("n").value, of("n").limits), (&ParamValue::Number(3.0), Some(n)));
    assert_eq!((&of("n").written, of("gap").limits), (&None, None));
    assert_eq!(of("gap").written, Some(("cm".to_owned(), 0.01)));
    assert_eq!(
        (&of("lit").value, &of("of").value),
        (&ParamValue::Bool(true), &ParamValue::Text("oak".into()))
    );
    assert_eq!(
        (of("far").written.clone(), of("w").written.clone()),
        (Some(("m".into(), 1.0)), Some(("W".into(), 1.0)))
    );
    assert_eq!(of("tint").value, ParamValue::Color([1.0, 0.0, 0.0]));
}

#[test]
fn a_param_of_numbers_tells_them_and_the_unit_of_its_author_and_takes_others() {
    let text = "param at: vec3 = (1, 2, 3) cm\nparam n: int[] = [1, 2]\nparam gaps: length[2] = [1 mm, 2 m]
param way: vec2 = (0, 1)\nparam far: vec3 = (1 m, -2 m, 3 m)\nparam many: float[] = [for i in 0..17 => i * 1.0]
param lamp: color = illuminant(\"D65\")\nparam tint: color = rgb.srgb(1, 0, 0)";
    let loaded = |set: &[(&str, &str)]| {
        let loaded = load_text(&format!("{HEAD}{text}"), set);
        assert_eq!(loaded.diagnostics, []);
        loaded.params
    };
    let numbers =
        |values: &[f64], is_list| ParamValue::Numbers { values: values.to_vec(), is_list };
    let unit = |name: &str, scale| Some((name.to_owned(), scale));
    let own = loaded(&[]);
    let of = |name: &str| own.iter().find(|param| param.name == name).unwrap();
    assert_eq!(of("at").value, numbers(&[0.01, 0.02, 0.03], false));
    assert_eq!((of("at").unit.as_str(), &of("at").written), ("m", &unit("cm", 0.01)));
    assert_eq!((&of("n").value, &of("n").written), (&numbers(&[1.0, 2.0], true), &None));
    assert_eq!(of("gaps").value, numbers(&[0.001, 2.0], true));
    assert_eq!(of("gaps").written, unit("mm", 0.001));
    assert_eq!((&of("way").value, of("way").unit.as_str()), (&numbers(&[0.0, 1.0], false), ""));
    assert_eq!(of("far").value, numbers(&[1.0, -2.0, 3.0], false));
    assert_eq!(of("far").written, unit("m", 1.0));
    assert_eq!((&of("many").value, &of("lamp").value), (&ParamValue::Other, &ParamValue::Other));
    let set = [
        ("at", "(1, -2.5, 0) cm"),
        ("n", "[3, 4, 5]"),
        ("gaps", "[1, 2] mm"),
        ("tint", "rgb.linear_srgb(0.25, 0.5, 0.125)"),
    ];
    let given = loaded(&set);
    let of = |name: &str| given.iter().find(|param| param.name == name).unwrap();
    assert_eq!(of("at").value, numbers(&[0.01, -0.025, 0.0], false));
    assert_eq!(of("n").value, numbers(&[3.0, 4.0, 5.0], true));
    assert_eq!(of("gaps").value, numbers(&[0.001, 0.002], true));
    assert_eq!(of("tint").value, ParamValue::Color([0.25, 0.5, 0.125]));
}

#[test]
fn imports_give_names_and_includes_emit() {
    let files = MemoryFiles::default()
        .with(
            "a/main.scene",
            format!("{HEAD}import \"lib.scene\" as lib\ninclude \"part.scene\" with {{ r = 3 m }}\nshape sphere {{ radius = lib.r }}\nplace lib.ball")
                .into_bytes(),
        )
        .with("a/lib.scene", &b"scene 1\nparam r: length = 1 m\nlet ball = group { shape sphere { radius = 9 m } }\ncamera perspective { look = look_at(from = (0, 0, 9) m, to = (0, 0, 0) m, up = (0, 1, 0)) }\nshape sphere { radius = r }"[..]);
    let files = files
        .with("a/part.scene", &b"scene 1\nparam r: length = 1 m\nshape sphere { radius = r }"[..]);
    let loaded = load_file(&files, "a/main.scene", &[]);
    assert_eq!(loaded.diagnostics, []);
    assert_eq!(numbers(&loaded.scene.unwrap(), "radius"), [3.0, 1.0, 9.0]);
}

#[test]
fn colours_carry_their_dimension_and_rows_become_a_table() {
    let text =
        "let fog = medium homogeneous { sigma_t = spectrum([(400 nm, 0.5), (700 nm, 1)]) / (2 m) }
medium homogeneous { sigma_s = 1 / (4 m), albedo = rgb.srgb(1, 0, 1) }
shape mesh { points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)] m, indices = #[0 1 2], interior = fog }";
    let loaded = load_text(&format!("{HEAD}{}", text.replace("] m, indices", "], indices")), &[]);
    assert_eq!(loaded.diagnostics.len(), 1);
    assert_eq!(loaded.diagnostics[0].code, "E0201");
    let text = text
        .replace("] m, indices", "], indices")
        .replace("(0, 0, 0), (1, 0, 0), (0, 1, 0)", "(0, 0, 0) m, (1, 0, 0) m, (0, 1, 0) m");
    let scene = scene(&text, &[]);
    let table = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    assert_eq!(values(&scene, "points"), [Value::Table(table.into())]);
    let Value::Color(Color::Curve(points), dimension) = &values(&scene, "sigma_t")[0] else {
        panic!("a curve")
    };
    assert_eq!(
        (&**points, dimension.to_string()),
        (&[(400.0, 0.25), (700.0, 0.5)][..], "m^-1".into())
    );
}

#[test]
fn a_shining_shape_keeps_its_place() {
    let text = "light area { shape = shape sphere { radius = 1 m, transform = [move((0, 3, 0) m)] }, spectrum = blackbody(3000 K), power = 60 W }";
    let scene = scene(text, &[]);
    assert_eq!(fixed(&scene.root.items[0].pose).translation, glam::DVec3::new(0.0, 3.0, 0.0));
}

#[test]
fn materials_of_an_asset_are_replaced_by_name() {
    let text =
        "asset gltf { file = \"a.glb\", unit = 1 m, materials = { steel = material diffuse {} } }";
    let scene = scene(text, &[]);
    let asset = scene.nodes.iter().find(|n| n.class == "gltf").unwrap();
    assert_eq!(
        (&*asset.overrides[0].0, scene.node(asset.overrides[0].1).kind.word()),
        ("steel", "material")
    );
}

/// Of what does not move.
fn fixed(pose: &luxel_core::scene::Pose) -> glam::DAffine3 {
    pose.fixed().unwrap_or_else(|| panic!("{pose:?}"))
}
