//! Nodes out of nothing.

use glam::{DAffine3, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{ImportNode, ImportValue, Imported, Importer, Kind};
use luxel_sdk::params::{BuildContext, Fault};

use super::Wrong;

/// A ball, or what is none.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Pour {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
}

fn node(kind: Kind, class: &str, params: &[(&'static str, ImportValue)]) -> ImportNode {
    let params = params.iter().map(|(name, value)| ((*name).into(), value.clone())).collect();
    ImportNode { kind, class: class.to_owned(), label: String::new(), params }
}

fn ball(radius: ImportValue, material: usize) -> ImportNode {
    let params = [("radius", radius), ("material", ImportValue::Node(material))];
    node(Kind::Shape, "sphere", &params)
}

impl Importer for Pour {
    fn check(&self) -> Result<(), Fault> {
        self.wrong.at(Wrong::Check);
        Ok(())
    }
    fn import(&self, _: &dyn BuildContext) -> Result<Imported, Vec<Fault>> {
        self.wrong.at(Wrong::Eval);
        let one = ImportValue::Number(1.0);
        let mut nodes = vec![node(Kind::Material, "diffuse", &[]), ball(one.clone(), 0)];
        let mut placed = vec![(1, DAffine3::IDENTITY)];
        match self.wrong {
            Wrong::Dangling => placed.push((2, DAffine3::IDENTITY)),
            Wrong::Beyond => placed.push((u32::MAX as usize, DAffine3::IDENTITY)),
            Wrong::Other => nodes[1] = ball(one, 7),
            // A node may only refer to those before it.
            Wrong::Second => nodes[1] = ball(one, 1),
            Wrong::OtherNan => nodes[1] = ball(one, usize::MAX),
            Wrong::Foreign => nodes.push(node(Kind::Film, "rgb", &[])),
            Wrong::Prepare => nodes.push(node(Kind::Importer, "bad", &[])),
            Wrong::Zero => placed.push((0, DAffine3::IDENTITY)),
            Wrong::Nan => nodes[1] = ball(ImportValue::Number(f64::NAN), 0),
            Wrong::Negative => nodes[1] = ball(ImportValue::Number(-1.0), 0),
            Wrong::Sample => nodes[1] = ball(ImportValue::Text("wide".to_owned()), 0),
            Wrong::SampleNan => nodes[1] = node(Kind::Shape, "no_such_shape", &[]),
            Wrong::SampleZero => nodes[1] = node(Kind::Shape, "sphere", &[]),
            Wrong::SampleLong => nodes[1] = node(Kind::Shape, "sphere", &[("width", one)]),
            Wrong::Infinite => placed[0].1 = DAffine3::from_scale(DVec3::NAN),
            // A mix without what it mixes, and one of a thing that is no material.
            Wrong::SecondNan => nodes[0] = node(Kind::Material, "mix", &[]),
            Wrong::Check | Wrong::Eval | Wrong::Nothing | Wrong::Bomb => {}
            Wrong::Greedy => {
                for i in 0..100_000_u32 {
                    nodes.push(ball(one.clone(), 0));
                    placed.push((1, DAffine3::from_translation(DVec3::X * f64::from(i))));
                }
            }
        }
        Ok(Imported { nodes, placed, warnings: vec![] })
    }
}
