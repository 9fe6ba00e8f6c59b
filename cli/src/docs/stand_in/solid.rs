//! Bodies of round parts: a cow, a bust and a tree.

use std::f32::consts::{PI, TAU};
use std::fmt::Write;

use glam::{Affine3A, Vec2, Vec3};
use serde_json::{Value, json};

/// Corners of a ring around the axis of a part.
const AROUND: u32 = 32;
/// Rings of an ellipsoid.
const RINGS: u16 = 16;

/// Triangles, in metres, +Y up.
#[derive(Default)]
struct Body {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Body {
    /// Adds what a line of (radius, height) sweeps about the Y axis, upwards where it bounds the outside.
    fn turned(&mut self, profile: &[Vec2], to: Affine3A) {
        let first = u32::try_from(self.points.len()).expect("a body has few points");
        for ring in profile {
            self.points.extend((0_u16..).take(AROUND as usize).map(|i| {
                let angle = TAU * f32::from(i) / AROUND as f32;
                to.transform_point3(Vec3::new(ring.x * angle.cos(), ring.y, ring.x * angle.sin()))
            }));
        }
        for (ring, pair) in (0_u32..).zip(profile.windows(2)) {
            for i in 0..AROUND {
                let at = |ring: u32, i: u32| first + ring * AROUND + i % AROUND;
                let (a, b) = (at(ring, i), at(ring, i + 1));
                let (c, d) = (at(ring + 1, i + 1), at(ring + 1, i));
                // A ring that is a point has no sides of its own.
                self.triangles.extend((pair[0].x > 0.0).then_some([a, c, b]));
                self.triangles.extend((pair[1].x > 0.0).then_some([a, d, c]));
            }
        }
    }

    fn ellipsoid(&mut self, centre: [f32; 3], radii: [f32; 3]) {
        let ring = |i: u16| {
            let angle = PI * f32::from(i) / f32::from(RINGS);
            let is_pole = i == 0 || i == RINGS;
            Vec2::new(if is_pole { 0.0 } else { angle.sin() }, -angle.cos())
        };
        let profile: Vec<Vec2> = (0..=RINGS).map(ring).collect();
        let scaled = Affine3A::from_scale(Vec3::from_array(radii));
        self.turned(&profile, Affine3A::from_translation(Vec3::from_array(centre)) * scaled);
    }

    /// A Wavefront file of its points, each as `of` writes it.
    fn obj(&self, of: impl Fn(Vec3) -> Vec3) -> Vec<u8> {
        let mut out = String::new();
        for p in self.points.iter().map(|p| of(*p)) {
            writeln!(out, "v {} {} {}", p.x, p.y, p.z).expect("a string takes everything");
        }
        for [a, b, c] in self.triangles.iter().map(|corners| corners.map(|i| i + 1)) {
            writeln!(out, "f {a} {b} {c}").expect("a string takes everything");
        }
        out.into_bytes()
    }
}

/// A cow, 1.3 m long, on its legs.
pub(super) fn cow() -> Vec<u8> {
    let mut body = Body::default();
    body.ellipsoid([0.0, 0.55, 0.0], [0.5, 0.27, 0.26]);
    body.ellipsoid([0.56, 0.78, 0.0], [0.2, 0.17, 0.16]);
    body.ellipsoid([0.72, 0.72, 0.0], [0.11, 0.09, 0.11]);
    body.ellipsoid([-0.51, 0.5, 0.0], [0.03, 0.2, 0.03]);
    for side in [-1.0, 1.0] {
        body.ellipsoid([0.5, 0.95, 0.15 * side], [0.04, 0.06, 0.09]);
        body.ellipsoid([-0.32, 0.24, 0.14 * side], [0.08, 0.24, 0.08]);
        body.ellipsoid([0.32, 0.24, 0.14 * side], [0.08, 0.24, 0.08]);
    }
    body.obj(|p| p)
}

/// Head and shoulders on a foot, 46 cm high; the file is in millimetres, +Z up.
pub(super) fn bust() -> Vec<u8> {
    let mut body = Body::default();
    let foot = [(0.0, 0.0), (0.09, 0.0), (0.09, 0.02), (0.04, 0.05), (0.04, 0.1), (0.0, 0.1)];
    body.turned(&foot.map(Vec2::from), Affine3A::IDENTITY);
    body.ellipsoid([0.0, 0.16, 0.0], [0.18, 0.09, 0.09]);
    body.ellipsoid([0.0, 0.25, 0.0], [0.05, 0.1, 0.055]);
    body.ellipsoid([0.0, 0.36, 0.01], [0.075, 0.1, 0.09]);
    body.ellipsoid([0.0, 0.35, 0.1], [0.014, 0.025, 0.018]);
    body.obj(|p| Vec3::new(p.x, -p.z, p.y) * 1000.0)
}

/// A fir, 3.4 m high, of bark and needles.
pub(super) fn tree() -> Vec<u8> {
    let (mut trunk, mut crown) = (Body::default(), Body::default());
    trunk.turned(&[(0.17, 0.0), (0.1, 1.6)].map(Vec2::from), Affine3A::IDENTITY);
    for (low, radius, high) in [(0.8, 0.95, 2.1), (1.5, 0.75, 2.8), (2.2, 0.5, 3.4)] {
        let cone = [(0.0, low), (radius, low), (0.0, high)];
        crown.turned(&cone.map(Vec2::from), Affine3A::IDENTITY);
    }
    glb(&[("bark", [0.22, 0.13, 0.07], trunk), ("needles", [0.05, 0.2, 0.07], crown)])
}

/// A binary glTF file of bodies, each with the name and colour of its material.
fn glb(bodies: &[(&str, [f32; 3], Body)]) -> Vec<u8> {
    let mut bin: Vec<u8> = vec![];
    let (mut views, mut accessors) = (vec![], vec![]);
    let mut accessor = |bytes: Vec<u8>, facts: Value| {
        let mut accessor = facts;
        accessor["bufferView"] = views.len().into();
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() }));
        accessors.push(accessor);
        bin.extend(bytes);
        accessors.len() - 1
    };
    let (mut primitives, mut materials) = (vec![], vec![]);
    for (i, (name, [r, g, b], body)) in bodies.iter().enumerate() {
        let points = body.points.iter().flat_map(Vec3::to_array);
        let points = points.flat_map(f32::to_le_bytes).collect();
        let least = body.points.iter().copied().fold(Vec3::INFINITY, Vec3::min).to_array();
        let most = body.points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max).to_array();
        let points = accessor(
            points,
            json!({ "componentType": 5126, "count": body.points.len(), "type": "VEC3",
                    "min": least, "max": most }),
        );
        let corners = body.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        let corners = accessor(
            corners,
            json!({ "componentType": 5125, "count": 3 * body.triangles.len(), "type": "SCALAR" }),
        );
        primitives.push(
            json!({ "attributes": { "POSITION": points }, "indices": corners, "material": i }),
        );
        materials.push(json!({ "name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1], "metallicFactor": 0, "roughnessFactor": 1 } }));
    }
    let root = json!({
        "asset": { "version": "2.0" }, "buffers": [{ "byteLength": bin.len() }],
        "bufferViews": views, "accessors": accessors, "materials": materials,
        "meshes": [{ "primitives": primitives }], "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }], "scene": 0,
    });
    container(root.to_string().into_bytes(), bin)
}

/// The chunks of a binary glTF file, each padded to four bytes.
fn container(mut json: Vec<u8>, bin: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let size = |n: usize| u32::try_from(n).expect("a small file").to_le_bytes();
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend(size(28 + json.len() + bin.len()));
    for (name, chunk) in [(b"JSON", json), (b"BIN\0", bin)] {
        out.extend(size(chunk.len()));
        out.extend(name);
        out.extend(chunk);
    }
    out
}
