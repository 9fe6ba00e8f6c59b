//! Values of parameters.

use std::path::PathBuf;
use std::sync::Arc;

use arrayvec::ArrayVec;
use glam::DAffine3;
use luxel_sdk::params::{Dimension, Look};

use super::{Color, NodeId};

/// A value as the scene graph keeps it: evaluated, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// True or false.
    Bool(bool),
    /// A number in SI units with what it measures.
    Number(f64, Dimension),
    /// Two to four numbers in SI units.
    Vector(ArrayVec<f64, 4>),
    /// Text, or the word of a choice.
    Text(Arc<str>),
    /// A file, joined to the folder of the scene file that names it.
    Path(PathBuf),
    /// The bytes of a file inside another one, with a name for messages.
    Bytes(Arc<str>, Arc<[u8]>),
    /// Many numbers in SI units.
    Table(Arc<[f64]>),
    /// A colour or spectrum, with the dimension that multiplies it.
    Color(Color, Dimension),
    /// Where something stands and looks.
    Look(Box<Look>),
    /// Another node.
    Node(NodeId),
    /// A shape that is a part of another, moved in the frame of that one.
    Moved(NodeId, Arc<DAffine3>),
}

impl Value {
    /// Two to four numbers in SI units; what comes after them is left out.
    pub fn vector(numbers: impl IntoIterator<Item = f64>) -> Self {
        Self::Vector(numbers.into_iter().take(4).collect())
    }

    /// Where something stands and looks.
    pub fn look(look: Look) -> Self {
        Self::Look(Box::new(look))
    }
}
