//! Which shapes lie within each other, and which of them counts where they overlap.

use std::sync::Arc;

use glam::DVec3;

use super::{Geometry, Placement, Skin};
use crate::accel::{Box64, Watch};
use crate::cast::index;
use crate::object::Object;

/// Pairs of placements that are looked at before they are taken to be nested unseen.
const MOST_PAIRS: usize = 1 << 20;

/// Finds which placements are closed and which counts where they overlap, as far as that matters:
/// where there are media, and where refracting shapes lie within each other. Gives two such shapes if
/// there are any; none of them where they are too many to look at. Left off once the watch is cancelled.
pub(super) fn settle(
    placements: &mut [Placement],
    geometries: &[Arc<Geometry>],
    boxes: &[Box64],
    materials: &[Arc<Object>],
    has_media: bool,
    watch: &Watch,
) -> Option<Vec<usize>> {
    for placement in watch.until(placements.iter_mut()) {
        placement.bends = material(placement, materials).is_some_and(Object::bends);
    }
    let is_closed = |placement: &Placement| geometries[placement.geometry as usize].is_closed();
    let nested = may_be_nested(placements, boxes, materials, is_closed, watch);
    if !has_media && nested.is_none() || watch.is_over() {
        return None;
    }
    for placement in watch.until(placements.iter_mut()) {
        placement.closed = (has_media || placement.bends) && is_closed(placement);
    }
    rank(placements, geometries, watch);
    nested
}

fn material<'a>(placement: &Placement, materials: &'a [Arc<Object>]) -> Option<&'a Object> {
    let Skin::Material(material) = placement.skin else { return None };
    Some(&materials[material as usize])
}

/// A closed refracting shape that overlaps another one, or something else to which it matters what
/// lies around it, as far as boxes tell, and that other.
fn may_be_nested(
    placements: &[Placement],
    boxes: &[Box64],
    materials: &[Arc<Object>],
    is_closed: impl Fn(&Placement) -> bool,
    watch: &Watch,
) -> Option<Vec<usize>> {
    let minds = |i: &usize| material(&placements[*i], materials).is_some_and(Object::has_index);
    let minding = watch.until(0..placements.len()).filter(minds);
    // Each with where it begins: what is sorted refers to nothing far away.
    let mut order: Vec<(f64, usize)> = minding.map(|i| (boxes[i].0.x, i)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pairs = 0;
    for (at, &(_, a)) in watch.until(order.iter().enumerate()) {
        for &(_, b) in order[at + 1..].iter().take_while(|(x, _)| *x <= boxes[a].1.x) {
            pairs += 1;
            if pairs > MOST_PAIRS {
                return Some(vec![]);
            }
            let fills = |i: usize| placements[i].bends && is_closed(&placements[i]);
            if overlap(boxes[a], boxes[b]) && (fills(a) || fills(b)) {
                return Some(vec![a, b]);
            }
        }
    }
    None
}

fn overlap(a: Box64, b: Box64) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}

/// Ranks placements by priority; among equals the smaller box counts more, so that what lies within
/// another shape counts there, from whichever side a ray comes; then the one placed later.
fn rank(placements: &mut [Placement], geometries: &[Arc<Geometry>], watch: &Watch) {
    // Where the shutter opens: what moves fast is no larger.
    let size = |placement: &Placement| {
        let local = geometries[placement.geometry as usize].opening_bounds();
        let bounds = placement.place.first().map_or(local, |it| local.transform(it.affine()));
        bounds.diagonal().max(DVec3::ZERO).element_product()
    };
    let sizes: Vec<f64> = watch.until(&*placements).map(size).collect();
    if sizes.len() < placements.len() {
        return;
    }
    let mut order: Vec<usize> = (0..placements.len()).collect();
    order.sort_by(|&a, &b| {
        let by_priority = placements[a].priority.cmp(&placements[b].priority);
        by_priority.then_with(|| sizes[b].total_cmp(&sizes[a]))
    });
    for (rank, place) in order.into_iter().enumerate() {
        placements[place].rank = index(rank);
    }
}
