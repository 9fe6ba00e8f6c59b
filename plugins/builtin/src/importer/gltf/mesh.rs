//! Meshes: a shape for each primitive, or a light for each that shines.

use std::collections::HashMap;
use std::sync::Arc;

use gltf::json::mesh::{Mesh, Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};
use luxel_sdk::kind::{ImportValue, Kind};

use super::Builder;
use super::material::Paint;
use crate::stop::{gather, wanted};

/// What has been made of the file's meshes and accessors.
#[derive(Default)]
pub(super) struct Meshes {
    /// The nodes of each mesh.
    made: HashMap<usize, Vec<usize>>,
    /// Tables by accessor and what they are for, shared by primitives that share them.
    tables: HashMap<(usize, Use), Arc<[f64]>>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Use {
    Vectors,
    Coordinates,
    Colours,
    Indices,
}

impl Builder<'_> {
    /// The nodes to be placed for a mesh; made once.
    pub(super) fn mesh(&mut self, index: Index<Mesh>) -> Vec<usize> {
        let i = index.value();
        if let Some(made) = self.meshes.made.get(&i) {
            return made.clone();
        }
        let source = self.source;
        let Some(mesh) = source.root.get(index) else {
            self.faults.push(format!("there is no meshes[{i}]"));
            return vec![];
        };
        let name = mesh.name.as_deref().unwrap_or("");
        let mut out = vec![];
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            match self.primitive(primitive, name) {
                Ok(node) => out.push(node),
                Err(Refusal::Fault(message)) => {
                    self.faults.push(format!("meshes[{i}].primitives[{k}]: {message}"));
                }
                Err(Refusal::Skip(message)) => {
                    self.warn(format!("meshes[{i}].primitives[{k}]: {message}: left out"));
                }
            }
        }
        let more = Checked::Valid(Semantic::Colors(1));
        if mesh.primitives.iter().any(|p| p.attributes.contains_key(&more)) {
            self.warn("COLOR_1 and later are not supported: COLOR_0 is used alone".to_owned());
        }
        if mesh.primitives.iter().any(|p| p.targets.is_some()) {
            self.warn("morph targets are not supported: the base shape is used".to_owned());
        }
        self.meshes.made.insert(i, out.clone());
        out
    }

    fn primitive(&mut self, primitive: &Primitive, name: &str) -> Result<usize, Refusal> {
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let points = attribute(Semantic::Positions).ok_or(Refusal::skip("no POSITION"))?;
        let points = self.table(points, Use::Vectors)?;
        let n_points = points.len() / 3;
        let colours = attribute(Semantic::Colors(0));
        let paint = if colours.is_some() { Paint::Corners } else { Paint::Plain };
        let material = self.material(primitive.material, paint)?;
        let mut params = vec![
            ("indices", ImportValue::Table(self.triangles(primitive, n_points)?)),
            ("material", ImportValue::Node(material.node)),
        ];
        if let Some(at) = odd(&points) {
            return Err(Refusal::Fault(format!("point {} is not finite", at / 3)));
        }
        params.push(("points", ImportValue::Table(points)));
        let normals = attribute(Semantic::Normals).map(|n| (n, Use::Vectors, 3, "normals"));
        let uvs = attribute(Semantic::TexCoords(material.uv_set));
        let uvs = uvs.map(|uv| (uv, Use::Coordinates, 2, "uvs"));
        let colours = colours.map(|c| (c, Use::Colours, 3, "colors"));
        for (accessor, table_use, width, param) in normals.into_iter().chain(uvs).chain(colours) {
            let table = self.table(accessor, table_use)?;
            if table.len() / width != n_points {
                let n = table.len() / width;
                return Err(Refusal::Fault(format!("{n} {param} for {n_points} points")));
            }
            if let Some(at) = odd(&table) {
                return Err(Refusal::Fault(format!(
                    "{param}: that of point {} is not finite",
                    at / width
                )));
            }
            params.push((param, ImportValue::Table(table)));
        }
        let shape = self.add(Kind::Shape, "mesh", name, params);
        let Some(emission) = material.emission else { return Ok(shape) };
        let params = vec![
            ("shape", ImportValue::Node(shape)),
            ("spectrum", emission.spectrum),
            ("scale", ImportValue::Number(emission.strength)),
            ("two_sided", ImportValue::Bool(material.double_sided)),
        ];
        Ok(self.add(Kind::Light, "area", name, params))
    }

    fn table(&mut self, index: Index<Accessor>, table_use: Use) -> Result<Arc<[f64]>, String> {
        let key = (index.value(), table_use);
        if let Some(table) = self.meshes.tables.get(&key) {
            return Ok(table.clone());
        }
        let table: Arc<[f64]> = match table_use {
            Use::Vectors => self.source.floats::<3>(index)?.into_flattened().into(),
            // Rows of a picture count from the top here, and from the bottom in the scene.
            Use::Coordinates => {
                let uvs = self.source.floats::<2>(index)?;
                gather(uvs.into_iter().flat_map(|[u, v]| [u, 1.0 - v]), self.source.context)?.into()
            }
            Use::Colours => self.colours(index)?,
            Use::Indices => {
                let indices = self.source.indices(index)?;
                gather(indices.into_iter().map(f64::from), self.source.context)?.into()
            }
        };
        self.meshes.tables.insert(key, table.clone());
        Ok(table)
    }

    /// Linear colours, which glTF 2.0 §3.7.2.1 has from 0 to 1. Their alpha is not used.
    fn colours(&mut self, index: Index<Accessor>) -> Result<Arc<[f64]>, String> {
        let colours: Vec<[f64; 3]> = if self.source.has_four(index)? {
            let all = self.source.floats::<4>(index)?;
            if wanted(&all, self.source.context).any(|[_, _, _, a]| *a < 1.0) {
                self.warn("COLOR_0: the alpha of points is not supported".to_owned());
            }
            gather(all.into_iter().map(|[r, g, b, _]| [r, g, b]), self.source.context)?
        } else {
            self.source.floats::<3>(index)?
        };
        let clamped = colours.into_iter().flatten().map(|x| x.clamp(0.0, 1.0));
        Ok(gather(clamped, self.source.context)?.into())
    }

    fn triangles(&mut self, primitive: &Primitive, n: usize) -> Result<Arc<[f64]>, Refusal> {
        let mode = match primitive.mode {
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err(Refusal::Fault("an unknown `mode`".to_owned())),
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Err(Refusal::skip("points and lines have no surface"));
        }
        let corners = if let Some(index) = primitive.indices {
            self.table(index, Use::Indices)?
        } else {
            self.source.spend(n as u64)?;
            (0..n).map(|i| i as f64).collect()
        };
        if let Some(bad) = corners.iter().find(|i| **i >= n as f64) {
            return Err(Refusal::Fault(format!("index {bad} names no point: there are {n}")));
        }
        if corners.len() < 3 {
            return Err(Refusal::skip("it has no triangle"));
        }
        if mode == Mode::Triangles {
            if corners.len() % 3 == 0 {
                return Ok(corners);
            }
            let n = corners.len();
            return Err(Refusal::Fault(format!("{n} indices: not a multiple of 3")));
        }
        self.source.spend(3 * corners.len() as u64)?;
        let fan = mode == Mode::TriangleFan;
        let triangle = |i: usize| match (fan, i % 2) {
            (true, _) => [corners[0], corners[i + 1], corners[i + 2]],
            // Every other triangle of a strip is turned round (glTF 2.0 §3.7.2.1).
            (false, 0) => [corners[i], corners[i + 1], corners[i + 2]],
            (false, _) => [corners[i + 1], corners[i], corners[i + 2]],
        };
        let all = (0..corners.len() - 2).flat_map(triangle);
        Ok(gather(all, self.source.context)?.into())
    }
}

/// Why a primitive does not become a shape.
enum Refusal {
    /// The file is damaged.
    Fault(String),
    /// It is not supported or empty.
    Skip(String),
}

impl Refusal {
    fn skip(message: &str) -> Self {
        Self::Skip(message.to_owned())
    }
}

impl From<String> for Refusal {
    fn from(message: String) -> Self {
        Self::Fault(message)
    }
}

/// Where the first number stands that is not finite.
fn odd(table: &[f64]) -> Option<usize> {
    table.iter().position(|x| !x.is_finite())
}
