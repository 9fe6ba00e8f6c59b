//! The camera stood elsewhere than the file says, in the scene graph; everything else of it stays.

mod text;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use luxel_core::diag::{SourceId, Sources, Span};
use luxel_core::registry::Registry;
use luxel_core::scene::{Argument, Node, Pose, Scene, Value};
use luxel_core::stage::Stage;
use luxel_sdk::params::Look;

use crate::preview::{Camera, View};

/// A camera and how its frame stands in the world.
type Standing = (Node, Pose);

/// Places of a length's decimals, less those of the view's: a millionth of it is seen by nobody.
const PLACES: f64 = 6.0;
/// Numbers that would need more are not rounded.
const MOST_PLACES: u8 = 15;
/// A pose that differs from a rigid one by so much bends a picture of 65536 pixels by less than one.
const RIGID: f64 = 1e-9;

/// Where a page wants the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wished {
    pub(super) look: Look,
    /// How many times as much is to be seen as the file says, where rays are parallel, if not as much.
    pub(super) zoom: Option<f64>,
}

/// How many times as much or as little may be asked for.
const MOST_ZOOM: f64 = 1e9;
/// What says how much a camera with parallel rays sees.
const HEIGHT: &str = "height";

/// Where a page wants the camera, rounded to what is seen; none that is no view.
pub(super) fn view(wished: &View) -> Option<Wished> {
    let zoom = wished.zoom.filter(|zoom| zoom.total_cmp(&1.0).is_ne());
    let is_sound = zoom.is_none_or(|zoom| (MOST_ZOOM.recip()..=MOST_ZOOM).contains(&zoom));
    look(wished).filter(|_| is_sound).map(|look| Wished { look, zoom })
}

fn look(wished: &View) -> Option<Look> {
    let [from, to, up] = [wished.from, wished.to, wished.up].map(DVec3::from_array);
    let look = sound(Look { from, to, up })?;
    let places = PLACES - (to - from).length().log10().floor();
    let length = |v: DVec3| rounded(v, places);
    sound(Look { from: length(from), to: length(to), up: rounded(up.normalize(), 9.0) })
        .or(Some(look))
}

fn rounded(v: DVec3, places: f64) -> DVec3 {
    let Some(places) = (0..=MOST_PLACES).find(|n| f64::from(*n) >= places) else { return v };
    // Through text, so that it is the number that a file would write.
    let places = usize::from(places);
    let one = |x: f64| format!("{x:.places$}").parse().map_or(x, |x: f64| x + 0.0);
    DVec3::new(one(v.x), one(v.y), one(v.z))
}

/// The view if it is one: finite, long enough to have a direction, and not along `up`.
fn sound(look: Look) -> Option<Look> {
    const LENGTHS: std::ops::RangeInclusive<f64> = 1e-100..=1e100;
    let Look { from, to, up } = look;
    let is_short = |v: DVec3| v.is_finite() && v.abs().max_element() <= *LENGTHS.end();
    let long = (to - from).length();
    let ok = is_short(from) && is_short(to) && is_short(up) && LENGTHS.contains(&long);
    let side = up.try_normalize()?.cross((to - from) / long).length();
    // As the language asks of `look_at`.
    (ok && side > 4.0 * f64::EPSILON).then_some(look)
}

/// Stands the scene's camera there, in the world; where the scene has none, that which an asset
/// brought to the stage before. One that moves goes on to move from there. A class without a view
/// stays where it is.
pub(super) fn stand(scene: &mut Scene, before: Option<&Stage>, view: &Wished) {
    let own = scene.camera.map(|id| (scene.node(id).clone(), scene.camera_pose.clone()));
    let brought = || before.and_then(|stage| camera_of(&stage.scene));
    let Some((mut node, pose)) = own.or_else(brought) else { return };
    let Some((look, pose)) = placed(&view.look, &pose, before) else { return };
    let Some(own) = look_of(&mut node) else { return };
    own.value = Value::look(look);
    if let (Some(zoom), Some(height)) = (view.zoom, height_of(&mut node)) {
        *height = significant(*height * zoom);
    }
    if scene.camera.is_none() {
        // It is written nowhere.
        node.span = Span::new(SourceId(0), 0, 0);
    }
    (scene.camera, scene.camera_pose) = (Some(scene.add(node)), pose);
}

/// The camera of a scene, if it refers to nothing else in it.
fn camera_of(scene: &Scene) -> Option<Standing> {
    let node = scene.node(scene.camera?).clone();
    let refers = |value: &Value| matches!(value, Value::Node(_) | Value::Moved(..));
    let alone = node.params.iter().all(|argument| !refers(&argument.value));
    alone.then(|| (node, scene.camera_pose.clone()))
}

fn look_of(node: &mut Node) -> Option<&mut Argument> {
    node.params.to_mut().iter_mut().find(|argument| matches!(argument.value, Value::Look(_)))
}

/// How much a camera sees, where its file says so.
fn height_of(node: &mut Node) -> Option<&mut f64> {
    let whole = node.span;
    let argument = node.params.to_mut().iter_mut().find(|argument| argument.name == HEIGHT)?;
    // What an asset brings is written nowhere: its parameters stand where the whole does. It comes from
    // the stage before, which has the last wish already.
    let is_written = argument.span != whole && !whole.range().is_empty();
    match &mut argument.value {
        Value::Number(height, _) if is_written => Some(height),
        _ => None,
    }
}

/// A number in seven digits.
fn significant(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}

/// A view in the world as a camera's parameter in a frame: the world itself, where the frame is as
/// large as that and stands still.
fn placed(view: &Look, pose: &Pose, before: Option<&Stage>) -> Option<(Look, Pose)> {
    let to_world = match pose.fixed() {
        Some(pose) if is_rigid(&pose) => return Some((*view, Pose::Here)),
        Some(pose) => pose,
        None => *before?.camera_place.first()?.affine(),
    };
    let back = to_world.inverse();
    let up = back.transform_vector3(view.up);
    let look =
        Look { from: back.transform_point3(view.from), to: back.transform_point3(view.to), up };
    Some((sound(look)?, pose.clone()))
}

fn is_rigid(pose: &DAffine3) -> bool {
    let m = pose.matrix3;
    let off = m.transpose() * m - DMat3::IDENTITY;
    let worst = off.to_cols_array().into_iter().fold(0.0, |worst: f64, x| worst.max(x.abs()));
    worst <= RIGID && m.determinant() > 0.0
}

/// The camera of a stage for the page, which perhaps stands where it is wished; none if it has no view that
/// could be changed.
pub(super) fn told(
    stage: &Stage,
    (registry, sources): (&Registry, &Sources),
    wished: Option<Wished>,
) -> Option<Camera> {
    let moved = wished.is_some();
    let (mut node, pose) = camera_of(&stage.scene)?;
    let Value::Look(local) = look_of(&mut node)?.value.clone() else { return None };
    let place = stage.camera_place.first();
    let point = |p| place.map_or(p, |place| place.point(p));
    let vector = |v| place.map_or(v, |place| place.vector(v));
    let (from, ahead) = (point(local.from), point(local.to));
    let length = (ahead - from).length();
    let forward = (ahead - from) / length;
    let to = if moved { ahead } else { from + forward * ahead_of(stage, from, forward, length) };
    let world = Look { from, to: ahead, up: vector(local.up) };
    // As it would be written, whether or not it was moved.
    let (look, pose) = placed(&world, &pose, Some(stage))?;
    let spread = spread(stage);
    let zooms = spread[0] > 0.0 && spread[1] == 0.0 && height_of(&mut node).is_some();
    let camera = Camera {
        from: from.to_array(),
        to: to.to_array(),
        up: vector(local.up).normalize().to_array(),
        spread,
        zoom: zooms.then(|| wished.and_then(|wished| wished.zoom).unwrap_or(1.0)),
        moved,
        text: text::block((&node, &pose), &look, registry, sources),
    };
    Some(camera)
}

/// How far ahead what the middle of the picture shows is; else the middle of the scene, or what the
/// camera looks at.
fn ahead_of(stage: &Stage, from: DVec3, forward: DVec3, length: f64) -> f64 {
    let seen = stage.probe(stage.film.resolution / 2).map(|(first, _)| first.surface.p);
    let to_middle = [seen, Some(stage.sphere.0)].into_iter().flatten();
    let mut far = to_middle.map(|p| (p - from).dot(forward));
    far.find(|far| far.is_finite() && *far > 1e-6 * length).unwrap_or(length)
}

fn spread(stage: &Stage) -> [f64; 2] {
    let middle = stage.film.resolution.as_dvec2() / 2.0;
    let ray = |p: DVec2| Some(stage.opening().camera_ray(p, [0.5; 2])?.ray);
    let pair = ray(middle).zip(ray(middle + DVec2::Y));
    pair.map_or([0.0; 2], |(a, b)| [(b.o - a.o).length(), (b.d - a.d).length()])
}

#[cfg(test)]
mod tests;
