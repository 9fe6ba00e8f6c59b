//! Reading the scene as the page wishes it.

use luxel_core::stage::Stage;
use luxel_lang::ParamInfo;

use super::Args;
use super::camera;
use super::page::Page;
use super::params;
use super::wishes::{Wish, Wishes};
use crate::args::LoadArgs;
use crate::exit::Failure;
use crate::isolate::Beat;
use crate::libraries::Plugins;
use crate::load::{self, Text};

/// Reads the scene, with what the page has set and the camera where it wants it; `before` is the
/// last that was shown.
///
/// # Errors
/// As `load::read`.
pub(super) fn read(
    args: &Args,
    plugins: &Plugins,
    page: Option<&Page>,
    before: Option<&Stage>,
) -> Result<Text, Failure> {
    let read = |set: Vec<(String, String)>| {
        let settings = LoadArgs { set, ..args.load.clone() };
        load::read(&args.file, &settings, args.render.size, plugins, &Beat::silent())
    };
    let Some(page) = page else { return read(args.load.set.clone()) };
    let wishes = page.wishes();
    let mut wish = wishes.take();
    let mut text = read(joined(&args.load.set, &wish.set))?;
    if let Some(gone) = gone(&text.params, &wish) {
        wish.set.retain(|(name, _)| !gone.contains(name));
        text = read(joined(&args.load.set, &wish.set))?;
        // What a mistake hides may come back.
        if text.scene.is_some() {
            wishes.forget(&gone);
        }
    }
    stand(&mut text, wishes, before);
    if text.scene.is_some() || !text.params.is_empty() {
        let line = params::line(&joined(&args.load.set, &wish.set));
        page.params(&params::offered(&text.params, &wish.set), &line);
    }
    Ok(text)
}

fn stand(text: &mut Text, wishes: &Wishes, before: Option<&Stage>) {
    let Some(scene) = &mut text.scene else { return };
    let hash = scene.camera.map(|id| scene.node(id).hash);
    if let Some(view) = wishes.view((hash, scene.camera_pose.clone())) {
        camera::stand(scene, before, &view);
    }
}

/// What is set on the command line, then what is set on the page in its place.
fn joined(first: &[(String, String)], then: &[(String, String)]) -> Vec<(String, String)> {
    let replaced = |name: &String| then.iter().any(|(other, _)| other == name);
    let kept = first.iter().filter(|(name, _)| !replaced(name));
    kept.chain(then).cloned().collect()
}

/// What is set on the page and not declared; none if there is nothing.
fn gone(declared: &[ParamInfo], wish: &Wish) -> Option<Vec<String>> {
    let lacks = |name: &&String| declared.iter().all(|param| param.name != **name);
    let names: Vec<_> = wish.set.iter().map(|(name, _)| name).filter(lacks).cloned().collect();
    (!names.is_empty()).then_some(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_page_sets_replaces_what_the_command_line_sets() {
        let pair = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        let (first, then) = ([pair("a", "1"), pair("b", "2")], [pair("c", "3"), pair("a", "4")]);
        assert_eq!(joined(&first, &then), [pair("b", "2"), pair("c", "3"), pair("a", "4")]);
    }
}
