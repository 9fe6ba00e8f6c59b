//! What a pixel shows, and where that is written.

use std::path::Path;

use glam::UVec2;
use luxel_core::diag::{Sources, Span};
use luxel_core::scene::{Node, NodeId};
use luxel_core::stage::{Skin, Stage};

use crate::preview::Editor;

/// What the middle of a pixel shows.
#[derive(Default)]
pub(super) struct Facts {
    /// Names and values.
    pub(super) told: Vec<(String, String)>,
    /// Of those that are written somewhere: name, place, and what opens it.
    pub(super) places: Vec<(String, String, Option<String>)>,
}

/// What the middle of a pixel shows, with places that `editor` opens.
pub(super) fn facts(stage: &Stage, sources: &Sources, editor: Option<&Editor>, at: UVec2) -> Facts {
    let inside = at.cmplt(stage.film.resolution).all();
    let Some((first, placement)) = inside.then(|| stage.probe(at)).flatten() else {
        let told = vec![("shape".into(), "none: the light of the sky".into())];
        return Facts { told, places: vec![] };
    };
    let about = |id: NodeId| {
        let node = stage.scene.nodes.get(id.0 as usize)?;
        Some((name(node), place(node.span, sources, editor)))
    };
    let (mut facts, mut places) = (vec![], vec![]);
    if let Some((name, (place, address))) = about(placement.node) {
        facts.push(("shape".to_owned(), name));
        facts.push(("written at".to_owned(), place.clone()));
        places.push(("written at".to_owned(), place, address));
    }
    if let Skin::Material(material) = placement.skin
        && let Some((name, (place, address))) = about(stage.material_nodes[material as usize])
    {
        facts.push(("material".to_owned(), format!("{name}, {place}")));
        places.push(("material".to_owned(), place, address));
    }
    let (p, n) = (first.surface.p, first.surface.ns);
    facts.push(("depth".to_owned(), format!("{:.6} m", first.t)));
    facts.push(("point".to_owned(), format!("({:.6}, {:.6}, {:.6}) m", p.x, p.y, p.z)));
    facts.push(("normal".to_owned(), format!("({:.4}, {:.4}, {:.4})", n.x, n.y, n.z)));
    Facts { told: facts, places }
}

/// What people call an object: its class, and its name if it has one.
fn name(node: &Node) -> String {
    match &node.label {
        Some(label) => format!("{} \"{label}\"", node.class),
        None => node.class.to_string(),
    }
}

/// `file:line:column`, and what opens it.
fn place(span: Span, sources: &Sources, editor: Option<&Editor>) -> (String, Option<String>) {
    let at = sources.line_column(span.source, span.start as usize);
    let file = sources.name(span.source);
    let place = format!("{file}:{}:{}", at.line, at.column);
    let (line, column) = (at.line.to_string(), at.column.to_string());
    (place, editor.and_then(|editor| editor.address(Path::new(file), &line, &column)))
}

#[cfg(test)]
mod tests {
    use luxel_core::files::MemoryFiles;
    use luxel_core::registry::Registry;

    use super::*;

    #[test]
    fn a_pixel_tells_its_shape_its_material_and_where_they_are_written() {
        let text = "scene 1\n\
            camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }\n\
            film rgb { resolution = (9, 9) }\n\
            light constant { scale = 1 }\n\
            let grey = material diffuse { reflectance = 0.5 }\n\
            shape sphere \"ball\" { radius = 1 m, material = grey }\n";
        let mut registry = Registry::new();
        for classes in luxel_builtin::CLASSES {
            registry.add("builtin", classes).unwrap();
        }
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let settings = luxel_lang::Settings::default();
        let read = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
        let scene = read.scene.unwrap();
        let stage = luxel_core::stage::build(&scene, &registry, &files, None).unwrap().stage;
        let editor = Editor::of("vscode://file/{file}:{line}:{column}").unwrap();
        let all = |at| facts(&stage, &read.sources, Some(&editor), at);
        let Facts { told, places } = all(UVec2::splat(4));
        let of = |name: &str| told.iter().find(|fact| fact.0 == name).map(|fact| fact.1.as_str());
        assert_eq!(of("shape"), Some("sphere \"ball\""));
        assert_eq!(of("written at"), Some("a.scene:6:1"));
        assert_eq!(of("depth"), Some("4.000000 m"));
        assert!(of("material").unwrap().starts_with("diffuse, a.scene:5:"), "{told:?}");
        let (name, place, address) = &places[0];
        assert_eq!((name.as_str(), place.as_str()), ("written at", "a.scene:6:1"));
        let here = std::path::absolute("a.scene").unwrap();
        let ends = address.as_ref().unwrap().ends_with("/a.scene:6:1");
        assert!(ends && here.is_absolute(), "{places:?}");
        assert!(places[1].1.starts_with("a.scene:5:"), "{places:?}");
        for at in [UVec2::ZERO, UVec2::splat(9), UVec2::MAX] {
            assert_eq!((all(at).told.len(), all(at).places.len()), (1, 0), "{at}");
        }
    }
}
