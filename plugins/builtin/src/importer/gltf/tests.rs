//! glTF files, sound and damaged.

use std::collections::HashMap;
use std::fmt::Write;
use std::sync::Arc;

use glam::DVec3;
use luxel_sdk::params::Text;

use super::*;
use crate::stop::STRIDE;
use crate::stop::testing::{Patience, ends_wherever};

const BOX: &[u8] = include_bytes!("../../../../../tests/data/gltf/box_sparse.gltf");
const BOX_BIN: &[u8] = include_bytes!("../../../../../tests/data/gltf/box_sparse.bin");
const BOX_GLB: &[u8] = include_bytes!("../../../../../tests/data/gltf/box_sparse.glb");
const CORNELL: &[u8] = include_bytes!("../../../../../tests/data/gltf/CornellBox.glb");

/// A host with these files.
struct Files(HashMap<&'static str, Arc<[u8]>>);

impl BuildContext for Files {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
        self.0.get(path).cloned().ok_or_else(|| format!("{path} does not exist"))
    }
    fn read_beside(&self, _base: &str, path: &str) -> Result<Arc<[u8]>, String> {
        self.read(path)
    }
    fn warn(&self, _message: &str) {}
}

fn params() -> Gltf<'static> {
    let file = File { path: Text::new("a.gltf") };
    Gltf { file, unit: 1.0, up: Up::Y, scene: Maybe { given: false, value: 0.0 } }
}

fn import_with(params: Gltf<'_>, bytes: &[u8]) -> Result<Imported, Vec<Fault>> {
    let files = [("a.gltf", bytes), ("box_sparse.bin", BOX_BIN), ("a b.png", b"png".as_slice())];
    params.import(&Files(files.into_iter().map(|(name, b)| (name, b.into())).collect()))
}

fn import(json: &str) -> Result<Imported, Vec<Fault>> {
    import_with(params(), json.as_bytes())
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for three in bytes.chunks(3) {
        let bits = three.iter().fold(0u32, |bits, b| bits << 8 | u32::from(*b));
        let bits = bits << (8 * (3 - three.len()));
        for k in 0..=three.len() {
            out.push(char::from(DIGITS[(bits >> (18 - 6 * k) & 63) as usize]));
        }
    }
    out
}

/// A file with a strip of four points: points as floats, then places 0 1 2 3 as bytes.
fn file(rest: &str) -> String {
    let mut bytes = vec![];
    for x in [0.0f32, 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend([0, 1, 2, 3]);
    let data = base64(&bytes);
    format!(
        r#"{{"asset":{{"version":"2.0"}},
        "buffers":[{{"byteLength":52,"uri":"data:application/octet-stream;base64,{data}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":4}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
                     {{"bufferView":1,"componentType":5121,"count":4,"type":"SCALAR"}}],
        {rest}}}"#
    )
}

const STRIP: &str = r#""meshes":[{"name":"m","primitives":[
    {"attributes":{"POSITION":0},"indices":1,"mode":5}]}]"#;

fn param<'a>(node: &'a ImportNode, name: &str) -> &'a ImportValue {
    let found = node.params.iter().find(|(known, _)| *known == name);
    &found.unwrap_or_else(|| panic!("no {name} in {node:?}")).1
}

fn table(node: &ImportNode, name: &str) -> Vec<f64> {
    let ImportValue::Table(table) = param(node, name) else { panic!("{name} is no table") };
    table.to_vec()
}

#[test]
fn a_sparse_box_is_the_same_from_text_and_binary() {
    let text = import_with(params(), BOX).unwrap();
    let binary = import_with(params(), BOX_GLB).unwrap();
    assert_eq!(text, binary);
    let shape = &text.nodes[text.placed[0].0];
    let points = table(shape, "points");
    assert_eq!((shape.class.as_str(), points.len() % 3), ("mesh", 0));
    assert!(table(shape, "indices").iter().all(|i| *i < (points.len() / 3) as f64));
}

#[test]
fn the_cornell_box_comes_with_its_materials_and_lamp() {
    let found = import_with(params(), CORNELL).unwrap();
    let count = |kind| found.nodes.iter().filter(|n| n.kind == kind).count();
    assert!(count(Kind::Material) >= 3 && count(Kind::Shape) >= 3, "{:?}", found.warnings);
    let named = |n: &&ImportNode| n.kind == Kind::Material && !n.label.is_empty();
    assert!(found.nodes.iter().filter(named).count() >= 3);
    for (i, _) in &found.placed {
        assert_ne!(found.nodes[*i].kind, Kind::Material);
    }
}

#[test]
fn nodes_that_share_a_mesh_share_its_node() {
    let json = file(&format!(
        r#"{STRIP},"scenes":[{{"nodes":[0]}}],"nodes":[
        {{"children":[1,2],"translation":[1,2,3],"scale":[2,2,2]}},
        {{"mesh":0,"translation":[1,0,0]}},
        {{"mesh":0,"rotation":[0,0.70710678,0,0.70710678]}}]"#
    ));
    let up = Gltf { unit: 0.01, up: Up::Z, ..params() };
    let found = import_with(up, json.as_bytes()).unwrap();
    let [(a, first), (b, second)] = found.placed[..] else { panic!("{:?}", found.placed) };
    assert_eq!(a, b);
    // (3, 2, 3) of the file, whose +z is up, in centimetres.
    assert!((first.translation - DVec3::new(0.03, 0.03, -0.02)).length() <= 1e-17);
    let x = Up::Z.turn().transpose() * second.transform_vector3(DVec3::X);
    assert!((x - DVec3::new(0.0, 0.0, -0.02)).length() <= 1e-9, "{x}");
    let shape = &found.nodes[a];
    assert_eq!(shape.label, "m");
    assert_eq!(table(shape, "indices"), [0., 1., 2., 2., 1., 3.]);
    let ImportValue::Node(material) = param(shape, "material") else { panic!() };
    assert_eq!(found.nodes[*material].class, "metallic_roughness");
}

#[test]
fn fans_and_unindexed_primitives_become_triangles() {
    let fan = STRIP.replace("\"mode\":5", "\"mode\":6");
    let found = import(&file(&format!(r#"{fan},"nodes":[{{"mesh":0}}]"#))).unwrap();
    assert_eq!(table(&found.nodes[found.placed[0].0], "indices"), [0., 1., 2., 0., 2., 3.]);
    let plain = STRIP.replace("\"indices\":1,\"mode\":5", "\"mode\":5");
    let found = import(&file(&format!(r#"{plain},"nodes":[{{"mesh":0}}]"#))).unwrap();
    assert_eq!(table(&found.nodes[found.placed[0].0], "indices").len(), 6);
    let lines = STRIP.replace("\"mode\":5", "\"mode\":1");
    let found = import(&file(&format!(r#"{lines},"nodes":[{{"mesh":0}}]"#))).unwrap();
    assert!(found.placed.is_empty());
    let expected = "meshes[0].primitives[0]: points and lines have no surface: left out";
    assert_eq!(found.warnings, [expected]);
}

#[test]
fn materials_carry_textures_factors_and_emission() {
    let mesh = STRIP.replace("\"mode\":5", "\"mode\":5,\"material\":0");
    let found = import(&file(&format!(
        r#"{mesh},"nodes":[{{"mesh":0}}],
        "images":[{{"uri":"a%20b.png"}},{{"bufferView":1,"mimeType":"image/png"}}],
        "samplers":[{{"wrapS":33071,"wrapT":33071,"magFilter":9728}}],
        "textures":[{{"source":0,"sampler":0}},{{"source":1}}],
        "materials":[{{"name":"glow","alphaMode":"MASK","doubleSided":true,
          "emissiveFactor":[1,0.5,0],"normalTexture":{{"index":0}},
          "extensions":{{"KHR_materials_emissive_strength":{{"emissiveStrength":8}}}},
          "pbrMetallicRoughness":{{"baseColorFactor":[1,1,1,0.5],"roughnessFactor":0.25,
            "baseColorTexture":{{"index":0,"extensions":{{"KHR_texture_transform":
              {{"offset":[0.25,0.5],"scale":[2,3]}}}}}},
            "metallicRoughnessTexture":{{"index":1}}}}}}]"#
    )))
    .unwrap();
    let light = &found.nodes[found.placed[0].0];
    assert_eq!((light.kind, light.class.as_str()), (Kind::Light, "area"));
    assert_eq!(param(light, "spectrum"), &ImportValue::Rgb([1.0, 0.5, 0.0]));
    assert_eq!(param(light, "scale"), &ImportValue::Number(8.0));
    assert_eq!(param(light, "two_sided"), &ImportValue::Bool(true));
    let glow = found.nodes.iter().find(|n| n.label == "glow").unwrap();
    let texture = |value: &ImportValue| match value {
        ImportValue::Node(i) => found.nodes[*i].clone(),
        other => panic!("{other:?}"),
    };
    let base = texture(param(glow, "base_color"));
    let bytes = ImportValue::Bytes("a.gltf#a b.png".to_owned(), b"png".as_slice().into());
    assert_eq!(param(&base, "file"), &bytes);
    assert_eq!(param(&base, "scale"), &ImportValue::Vector(vec![2.0, 3.0]));
    assert_eq!(param(&base, "offset"), &ImportValue::Vector(vec![0.25, -2.5]));
    assert_eq!(param(&base, "wrap"), &ImportValue::Text("clamp".to_owned()));
    let roughness = texture(param(glow, "roughness"));
    assert_eq!(param(&roughness, "factor"), &ImportValue::Number(0.25));
    let picture = texture(param(&roughness, "value"));
    assert_eq!(param(&picture, "channel"), &ImportValue::Text("g".to_owned()));
    assert_eq!(texture(param(glow, "alpha")).class, "scale");
    assert_eq!(param(glow, "alpha_cutoff"), &ImportValue::Number(0.5));
    assert_eq!(found.warnings, ["material `glow`: its normal map is not supported"]);
}

#[test]
fn colours_of_points_multiply_the_base_colour() {
    // The bytes of the second point, 1 0 0, are the colours.
    let painted = |kind: &str, count: u32, material: &str| {
        let mesh = r#""meshes":[{"primitives":[
            {"attributes":{"POSITION":0,"COLOR_0":2},"indices":1,"mode":5,"material":0},
            {"attributes":{"POSITION":0},"indices":1,"mode":5,"material":0}]}]"#;
        let file = file(&format!(r#"{mesh},"nodes":[{{"mesh":0}}],"materials":[{{{material}}}]"#));
        let colours = format!(
            r#"{{"bufferView":0,"byteOffset":12,"componentType":5121,"normalized":true,
                "count":{count},"type":"{kind}"}}"#
        );
        import(&file.replacen(r#""SCALAR"}"#, &format!(r#""SCALAR"}},{colours}"#), 1))
    };
    let red = r#""pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1]}"#;
    let found = painted("VEC3", 4, red).unwrap();
    let (first, second) = (&found.nodes[found.placed[0].0], &found.nodes[found.placed[1].0]);
    let bytes = [1.0f32, 0.0, 0.0].map(f32::to_le_bytes).concat();
    let truth: Vec<f64> = bytes.iter().map(|x| f64::from(*x) / 255.0).collect();
    assert_eq!(table(first, "colors"), truth);
    assert!(second.params.iter().all(|(name, _)| *name != "colors"));
    let material = |shape: &ImportNode| match param(shape, "material") {
        ImportValue::Node(i) => found.nodes[*i].clone(),
        other => panic!("{other:?}"),
    };
    let ImportValue::Node(scaled) = param(&material(first), "base_color").clone() else {
        panic!("{first:?}")
    };
    let scaled = &found.nodes[scaled];
    assert_eq!(param(scaled, "factor"), &ImportValue::Rgb([1.0, 0.5, 0.25]));
    let ImportValue::Node(corners) = param(scaled, "value") else { panic!("{scaled:?}") };
    assert_eq!(found.nodes[*corners].class, "vertex_color");
    // The same material without colours is the factor alone.
    assert_eq!(param(&material(second), "base_color"), &ImportValue::Rgb([1.0, 0.5, 0.25]));
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let found = painted("VEC4", 4, red).unwrap();
    assert_eq!(found.warnings, ["COLOR_0: the alpha of points is not supported"]);
    let faults = painted("VEC3", 3, red).unwrap_err();
    assert!(faults[0].message.contains("3 colors for 4 points"), "{faults:?}");
}

#[test]
fn cameras_and_lights_keep_their_amounts() {
    let found = import(
        r#"{"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
        "cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],
        "extensions":{"KHR_lights_punctual":{"lights":[
          {"type":"point","intensity":40},{"type":"directional","intensity":1000},
          {"type":"spot","intensity":5,"spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}},
          {"type":"point","intensity":0}]}},
        "nodes":[{"camera":0},
          {"extensions":{"KHR_lights_punctual":{"light":0}}},
          {"extensions":{"KHR_lights_punctual":{"light":1}}},
          {"extensions":{"KHR_lights_punctual":{"light":2}}},
          {"extensions":{"KHR_lights_punctual":{"light":3}}}]}"#,
    )
    .unwrap();
    let classes: Vec<_> = found.placed.iter().map(|(i, _)| found.nodes[*i].class.clone()).collect();
    assert_eq!(classes, ["perspective", "point", "directional", "spot"]);
    let amount = |i: usize, name| match param(&found.nodes[i], name) {
        ImportValue::Quantity(x, unit) => (*x, unit.as_ref()),
        ImportValue::Number(x) => (*x, ""),
        other => panic!("{other:?}"),
    };
    // The luminance of white is 1 to the rounding of its three coefficients.
    let near = |(x, unit): (f64, _), y: f64, u| {
        assert!((x / y - 1.0).abs() <= 4.0 * f64::EPSILON && unit == u, "{x} {unit}");
    };
    near(amount(0, "fov"), 0.5, "");
    near(amount(1, "intensity"), 40.0, "cd");
    near(amount(2, "illuminance"), 1000.0, "lx");
    near(amount(3, "cone"), 0.5, "");
    near(amount(3, "falloff"), 0.25, "");
}

/// What is put in place of what in a file with a strip, and what that is refused with.
#[rustfmt::skip]
const DAMAGES: [(&str, &str, &str); 16] = [
    ("\"indices\":1", "\"indices\":7", "P: there is no accessors[7]"),
    ("\"mode\":5", "\"mode\":4", "P: 4 indices: not a multiple of 3"),
    ("\"mode\":5", "\"mode\":9", "P: an unknown `mode`"),
    ("\"mode\":5", "\"material\":3", "P: there is no materials[3]"),
    ("\"count\":4", "\"count\":5", "P: accessors[0]: 5 elements reach beyond the buffer view"),
    ("\"count\":4", "\"count\":3", "P: index 3 names no point: there are 3"),
    ("\"count\":4", "\"count\":1000000000000000000",
        "P: accessors[0]: 3000000000000000000 numbers are more than the file's size warrants"),
    ("\"byteLength\":48", "\"byteLength\":99",
        "P: accessors[0]: bufferViews[0] reaches beyond its buffer"),
    ("\"byteLength\":48", "\"byteStride\":0,\"byteLength\":48",
        "P: accessors[0]: a stride of 0 for elements of 12 bytes"),
    ("VEC3", "VEC2", "P: accessors[0]: Valid(Vec2) where Vec3 is wanted"),
    ("\"byteLength\":52", "\"byteLength\":53",
        "buffers[0]: 53 bytes were promised and 52 are there"),
    (";base64,", ";base64,%", "buffers[0]: a data URI with damaged base64"),
    ("\"mesh\":0", "\"mesh\":1", "there is no meshes[1]"),
    ("\"nodes\":[", "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[0]},",
        "nodes[0] is reached twice: nodes form a tree"),
    ("\"nodes\":[", "\"scenes\":[{\"nodes\":[9]}],\"nodes\":[", "there is no nodes[9]"),
    ("\"buffers\"", "\"extensionsRequired\":[\"KHR_draco\"],\"buffers\"",
        "it requires the extension `KHR_draco`, which is not supported"),
];

fn strip() -> String {
    file(&format!(r#"{STRIP},"nodes":[{{"mesh":0}}]"#))
}

#[test]
fn damaged_files_are_refused_with_their_place() {
    for (from, to, expected) in DAMAGES {
        assert!(strip().contains(from), "{from}");
        let faults = import(&strip().replacen(from, to, 1)).unwrap_err();
        let messages: Vec<_> = faults.iter().map(|f| f.message.as_str()).collect();
        let expected = expected.replace("P:", "meshes[0].primitives[0]:");
        assert_eq!(messages, [format!("a.gltf: {expected}")]);
    }
    for json in ["", "{", "[]", "glTF", "glTF\x02\0\0\0\0\0\0\0", "{\"asset\":{}}"] {
        assert!(import(json).is_err(), "{json}");
    }
}

#[test]
fn scenes_are_found_or_refused() {
    let missing = Gltf { scene: Maybe { given: true, value: 3.0 }, ..params() };
    let faults = import_with(missing, strip().as_bytes()).unwrap_err();
    assert_eq!(faults[0].message, "a.gltf: there is no scene 3: it has 0");
    // A ring without a beginning stands in no scene.
    let ring = strip().replace("\"mesh\":0", "\"children\":[0]");
    assert!(import(&ring).unwrap().placed.is_empty());
}

#[test]
fn many_readings_of_few_bytes_run_out_of_budget() {
    // Accessors without bytes, each as large as the budget lets a single one be.
    let mut accessors = String::new();
    let mut primitives = String::new();
    for i in 0..20 {
        let comma = if i > 0 { "," } else { "" };
        write!(accessors, r#"{comma}{{"componentType":5126,"count":300000,"type":"VEC3"}}"#)
            .unwrap();
        write!(primitives, r#"{comma}{{"attributes":{{"POSITION":{i}}},"mode":5}}"#).unwrap();
    }
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"accessors":[{accessors}],
        "meshes":[{{"primitives":[{primitives}]}}],"nodes":[{{"mesh":0}}]}}"#
    );
    let faults = import(&json).unwrap_err();
    assert!(faults[0].message.contains("more than the file's size warrants"), "{faults:?}");
}

#[test]
fn reading_tables_ends_soon_after_it_is_not_wanted_any_more() {
    let n = 50_000u32;
    let floats = (0..3 * n).map(|i| i as f32).flat_map(f32::to_le_bytes);
    let bytes: Vec<u8> = floats.chain((0..n).flat_map(u32::to_le_bytes)).collect();
    let json = format!(
        r#"{{ "asset": {{ "version": "2.0" }},
            "buffers": [{{ "byteLength": {all}, "uri": "a.bin" }}],
            "bufferViews": [{{ "buffer": 0, "byteLength": {points} }},
                {{ "buffer": 0, "byteOffset": {points}, "byteLength": {places} }}],
            "accessors": [
                {{ "bufferView": 0, "componentType": 5126, "count": {n}, "type": "VEC3" }},
                {{ "bufferView": 1, "componentType": 5125, "count": {n}, "type": "SCALAR" }}],
            "meshes": [{{ "primitives":
                [{{ "attributes": {{ "POSITION": 0 }}, "indices": 1, "mode": 5 }}] }}],
            "nodes": [{{ "mesh": 0 }}], "scenes": [{{ "nodes": [0] }}] }}"#,
        all = 16 * n,
        points = 12 * n,
        places = 4 * n,
    );
    let looks = ends_wherever(|patience| {
        let host = Impatient { files: [json.as_bytes(), &bytes].map(Into::into), patience };
        params().import(&host)
    });
    // Points, places, and the triangles that they make.
    assert!(looks >= 3 * n as usize / STRIDE, "{looks} looks");
}

/// A glTF file and its buffer, for a host that may lose interest.
struct Impatient<'a> {
    files: [Arc<[u8]>; 2],
    patience: &'a Patience,
}

impl BuildContext for Impatient<'_> {
    fn read(&self, _path: &str) -> Result<Arc<[u8]>, String> {
        Ok(self.files[0].clone())
    }
    fn read_beside(&self, _base: &str, _path: &str) -> Result<Arc<[u8]>, String> {
        Ok(self.files[1].clone())
    }
    fn warn(&self, _message: &str) {}
    fn cancelled(&self) -> bool {
        self.patience.cancelled()
    }
}

#[test]
fn a_long_text_is_read_as_a_short_one() {
    let nodes = r#""nodes":[{"mesh":0,"translation":[1,2,3]}]"#;
    let short = file(&format!("{STRIP},{nodes}"));
    let long = |text: &str| format!("{text}{}", " ".repeat(1 << 18));
    let [one, other] = [short.clone(), long(&short)].map(|text| import(&text).unwrap());
    assert!(!one.placed.is_empty());
    assert_eq!((one.placed, one.nodes.len()), (other.placed, other.nodes.len()));
    let damaged = short.replacen("translation", "\u{1}", 1);
    let told = |text: &str| import(text).unwrap_err().remove(0).message;
    assert_eq!(told(&damaged), told(&long(&damaged)));
}

#[test]
fn collapsed_nodes_are_left_out_with_a_warning() {
    let nodes = r#""nodes":[{"mesh":0,"scale":[0,0,0],"children":[1]},{"mesh":0}]"#;
    let found = import(&file(&format!("{STRIP},{nodes}"))).unwrap();
    assert!(found.placed.is_empty());
    assert_eq!(found.warnings, ["nodes[0] is scaled to nothing: left out"]);
}

#[test]
fn no_cut_or_flipped_byte_is_fatal() {
    for i in 0..BOX_GLB.len() {
        let _ = import_with(params(), &BOX_GLB[..i]);
        let mut damaged = BOX_GLB.to_vec();
        damaged[i] ^= [1, 4, 0x10, 0x80][i % 4];
        let _ = import_with(params(), &damaged);
    }
}

#[test]
fn extensions_that_are_declared_and_not_used_are_no_reason_to_warn() {
    let declared = r#""extensionsUsed":["KHR_materials_unlit"],"scenes":[{"nodes":[]}]"#;
    assert_eq!(import(&file(declared)).unwrap().warnings, [""; 0]);
    let used =
        format!(r#"{declared},"materials":[{{"extensions":{{"KHR_materials_unlit" : {{}}}}}}]"#);
    let found = import(&file(&used)).unwrap().warnings;
    assert!(found[0].contains("KHR_materials_unlit"), "{found:?}");
}

#[test]
fn files_that_are_no_gltf_are_told_by_what_they_are() {
    for (bytes, expected) in [
        (&b"\x89PNG\r\n\x1a\n"[..], "but a PNG picture"),
        (b"v 0 0 0\n", "but text"),
        (b"{ \"asset\": ", "its JSON is damaged"),
    ] {
        let faults = import_with(params(), bytes).unwrap_err();
        assert!(faults[0].message.contains(expected), "{}", faults[0].message);
    }
}

#[test]
fn what_an_orthographic_camera_shows_is_measured_in_the_files_unit() {
    let json = r#""cameras":[{"type":"orthographic",
        "orthographic":{"xmag":2,"ymag":1.5,"znear":0.1,"zfar":9}}],"nodes":[{"camera":0}]"#;
    let found = import_with(Gltf { unit: 0.01, ..params() }, file(json).as_bytes()).unwrap();
    // Half of the height stands in the file; 0.03 is rounded once.
    let ImportValue::Number(height) = param(&found.nodes[0], "height") else { panic!() };
    assert!((height - 0.03).abs() <= 0.03 * f64::EPSILON, "{height}");
}
