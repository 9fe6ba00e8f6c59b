//! Bytes of another format into nodes of a scene.

use std::borrow::Cow;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::Kind;
use crate::params::{BuildContext, Fault, Look};

/// A value in an imported node.
#[derive(Clone, Debug, PartialEq)]
pub enum ImportValue {
    /// True or false.
    Bool(bool),
    /// A number in SI units; the amounts of a light in their SI unit, see `ImportNode::units`.
    Number(f64),
    /// A number with its unit, as `40 cd`.
    Quantity(f64, Cow<'static, str>),
    /// Two or three numbers in SI units.
    Vector(Vec<f64>),
    /// Text or a choice's word.
    Text(String),
    /// A colour in linear sRGB.
    Rgb([f64; 3]),
    /// Many numbers in SI units.
    Table(Arc<[f64]>),
    /// Where a camera or light stands.
    Look(Look),
    /// The bytes of a file that stands inside the imported one, and a name for it.
    Bytes(String, Arc<[u8]>),
    /// A node of its own, by its place in `Imported::nodes`.
    Node(usize),
}

/// A node to be made.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportNode {
    /// What it is.
    pub kind: Kind,
    /// Which class.
    pub class: String,
    /// Its name in the file; may be empty. Materials can be overridden by it.
    pub label: String,
    /// Its parameters by name.
    pub params: Vec<(Cow<'static, str>, ImportValue)>,
}

/// A shape, light or camera in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Nodes that others refer to or that are placed.
    pub nodes: Vec<ImportNode>,
    /// Which nodes stand in the scene, and where: node and placement.
    pub placed: Vec<(usize, DAffine3)>,
    /// Things in the file that are not supported, for a warning each.
    pub warnings: Vec<String>,
}

impl Imported {
    /// The turn that makes `up` (`x`, `y` or `z`) the scene's +Y, with a scale in metres per unit.
    pub fn base(up: DVec3, unit: f64) -> DAffine3 {
        let turn = glam::DQuat::from_rotation_arc(up, DVec3::Y);
        DAffine3::from_scale_rotation_translation(DVec3::splat(unit), turn, DVec3::ZERO)
    }
}

/// Reads another format.
pub trait Importer: Send + Sync {
    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// Reads the file that its parameters name.
    ///
    /// # Errors
    /// All faults that were found; damaged files never panic.
    fn import(&self, context: &dyn BuildContext) -> Result<Imported, Vec<Fault>>;
}
