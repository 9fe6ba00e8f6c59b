//! Reading the scene as the page wishes it.

use luxel_core::scene::{Hash, Scene, Value};
use luxel_core::stage::Stage;
use luxel_lang::ParamInfo;
use luxel_sdk::kind::Kind;

use super::Args;
use super::camera;
use super::page::Page;
use super::params;
use super::wishes::{Wish, Wishes};
use crate::args::LoadArgs;
use crate::exit::Failure;
use crate::files::Known;
use crate::libraries::Plugins;
use crate::load::{self, Course, Text};

/// What was read, with what the page had set by then.
pub(super) struct Wished {
    text: Text,
    set: Vec<(String, String)>,
    /// What the page had set and the scene does not declare.
    gone: Vec<String>,
}

/// Reads the scene with what the page has set over what the command line sets. Nobody comes to know of
/// it before `settle`.
///
/// # Errors
/// As `load::read`.
pub(super) fn read(
    args: &Args,
    plugins: &Plugins,
    page: Option<&Page>,
    course: &Course,
) -> Result<Wished, Failure> {
    let read = |set: Vec<(String, String)>| {
        let settings = LoadArgs { set, ..args.load.clone() };
        load::read(&args.file, &settings, args.render.size, plugins, course)
    };
    wished(&read, &args.load.set, page.map(|page| page.wishes().take()).unwrap_or_default())
}

fn wished(
    read: &dyn Fn(Vec<(String, String)>) -> Result<Text, Failure>,
    first: &[(String, String)],
    Wish { mut set, .. }: Wish,
) -> Result<Wished, Failure> {
    let mut text = read(joined(first, &set))?;
    let gone = gone(&text.params, &set);
    if !gone.is_empty() {
        set.retain(|(name, _)| !gone.contains(name));
        text = read(joined(first, &set))?;
    }
    Ok(Wished { text, set, gone })
}

/// Puts the camera where the page wants it, forgets what the scene does not declare any more, and tells
/// the page what it may set; `before` is the last that was shown.
pub(super) fn settle(
    Wished { mut text, set, gone }: Wished,
    args: &Args,
    page: Option<&Page>,
    before: Option<&Stage>,
    known: &Known,
) -> Text {
    let Some(page) = page else { return text };
    forget(page.wishes(), &text, &gone);
    stand(&mut text, page.wishes(), before, known);
    if text.scene.is_some() || !text.params.is_empty() {
        let line = params::line(&joined(&args.load.set, &set));
        page.params(&params::offered(&text.params, &set), &line);
    }
    text
}

/// What a mistake hides may come back.
fn forget(wishes: &Wishes, text: &Text, gone: &[String]) {
    if text.scene.is_some() && !gone.is_empty() {
        wishes.forget(gone);
    }
}

fn stand(text: &mut Text, wishes: &Wishes, before: Option<&Stage>, known: &Known) {
    let Some(scene) = &mut text.scene else { return };
    let own = scene.camera.map(|id| scene.node(id).hash);
    let hash = own.or_else(|| Some(hash_of_assets(scene, known)));
    if let Some(view) = wishes.view((hash, scene.camera_pose.clone())) {
        camera::stand(scene, before, &view);
    }
}

/// Of everything that may bring a camera: how it is asked for, and what its file holds.
fn hash_of_assets(scene: &Scene, known: &Known) -> Hash {
    let mut hasher = blake3::Hasher::new();
    for asset in scene.nodes.iter().filter(|node| node.kind == Kind::Importer) {
        hasher.update(&asset.hash);
        for argument in &asset.params {
            if let Value::Path(path) = &argument.value {
                hasher.update(known.look(path).as_ref().map_or(&[], |seen| seen.as_bytes()));
            }
        }
    }
    *hasher.finalize().as_bytes()
}

/// What is set on the command line, then what is set on the page in its place.
fn joined(first: &[(String, String)], then: &[(String, String)]) -> Vec<(String, String)> {
    let replaced = |name: &String| then.iter().any(|(other, _)| other == name);
    let kept = first.iter().filter(|(name, _)| !replaced(name));
    kept.chain(then).cloned().collect()
}

/// What is set and not declared.
fn gone(declared: &[ParamInfo], set: &[(String, String)]) -> Vec<String> {
    let lacks = |name: &&String| declared.iter().all(|param| param.name != **name);
    set.iter().map(|(name, _)| name).filter(lacks).cloned().collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use glam::DVec3;
    use luxel_core::registry::Registry;
    use luxel_sdk::params::Look;

    use super::*;
    use crate::files::DiskFiles;
    use crate::testing::Folder;

    fn pair(name: &str, value: &str) -> (String, String) {
        (name.to_owned(), value.to_owned())
    }

    fn wishes() -> Wishes {
        Wishes::new(Arc::default(), std::sync::mpsc::channel().0)
    }

    fn read(path: &Path, set: Vec<(String, String)>) -> Text {
        let mut registry = Registry::new();
        for classes in luxel_builtin::CLASSES {
            registry.add("builtin", classes).unwrap();
        }
        let files = DiskFiles::new(path, &[]);
        let settings = luxel_lang::Settings { set: set.clone(), ..Default::default() };
        let luxel_lang::Loaded { scene, rest, diagnostics, sources, params, .. } =
            luxel_lang::load(path, &files, &registry, &settings);
        Text { scene, rest, diagnostics, sources, files, params, set }
    }

    fn scene(params: &str, from: &str) -> String {
        format!(
            "scene 1\n{params}\ncamera perspective {{ look = look_at(from = {from} m, \
             to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }}\nlight constant {{ scale = a }}\n"
        )
    }

    #[test]
    fn what_a_save_takes_away_is_forgotten_but_not_what_a_mistake_hides() {
        let folder = Folder::new("wished");
        let path = folder.path("a.scene");
        let wishes = wishes();
        wishes.change(|wish| wish.set("a".into(), Some("3".into())));
        wishes.change(|wish| wish.set("b".into(), Some("4".into())));
        let first = [pair("b", "2")];
        let now = |text: &str| {
            folder.write("a.scene", text.as_bytes());
            let read = wished(&|set| Ok(read(&path, set)), &first, wishes.take()).unwrap();
            forget(&wishes, &read.text, &read.gone);
            (read.text, read.set)
        };
        let both = scene("param a: float = 1\nparam b: float = 1 in 0..=9", "(0, 0, 5)");
        let (text, set) = now(&both);
        assert_eq!(set, [pair("a", "3"), pair("b", "4")]);
        let values: Vec<_> = text.params.iter().map(|param| param.value.clone()).collect();
        assert_eq!(values, [3.0, 4.0].map(luxel_lang::ParamValue::Number));
        let (text, _) = now(&both.replace("scene 1", "scene 1 {"));
        assert!(text.scene.is_none());
        assert_eq!(wishes.take().set.len(), 2);
        // `b` is set on the command line too, which is a mistake then; without that, none.
        let one = both.replace("param b", "param c");
        folder.write("a.scene", one.as_bytes());
        let read = wished(&|set| Ok(read(&path, set)), &[], wishes.take()).unwrap();
        forget(&wishes, &read.text, &read.gone);
        let Wished { text, set, .. } = read;
        assert!(text.scene.is_some() && text.diagnostics.is_empty());
        assert_eq!((set, wishes.take().set), (vec![pair("a", "3")], vec![pair("a", "3")]));
    }

    #[test]
    fn the_camera_stands_where_it_is_wished_until_the_file_moves_it() {
        let folder = Folder::new("stands");
        let path = folder.path("a.scene");
        let wishes = wishes();
        let from = |scene: &Scene| match scene.node(scene.camera.unwrap()).get("look") {
            Some(argument) => match &argument.value {
                Value::Look(look) => look.from,
                _ => panic!("no view"),
            },
            None => panic!("no look"),
        };
        let now = |text: &str| {
            folder.write("a.scene", text.as_bytes());
            let mut text = read(&path, vec![]);
            stand(&mut text, &wishes, None, &Known::default());
            from(&text.scene.unwrap())
        };
        let file = scene("param a: float = 1", "(0, 0, 5)");
        assert_eq!(now(&file), DVec3::Z * 5.0);
        let look = Look { from: DVec3::X, to: DVec3::ZERO, up: DVec3::Y };
        wishes.change(|wish| wish.view = Some(camera::Wished { look, zoom: None }));
        assert_eq!(now(&file), DVec3::X);
        assert_eq!(now(&file.replace("= 1", "= 2")), DVec3::X);
        assert_eq!(now(&scene("param a: float = 2", "(0, 0, 6)")), DVec3::Z * 6.0);
        assert_eq!(now(&file), DVec3::Z * 5.0);
    }

    #[test]
    fn what_the_page_sets_replaces_what_the_command_line_sets() {
        let (first, then) = ([pair("a", "1"), pair("b", "2")], [pair("c", "3"), pair("a", "4")]);
        assert_eq!(joined(&first, &then), [pair("b", "2"), pair("c", "3"), pair("a", "4")]);
    }
}
