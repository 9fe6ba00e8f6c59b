//! Records what a film holds beside colour: what paths met first, what they cost, whose light they found.

use glam::{DVec2, DVec3, Vec3};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, ArrivalKind, Lane};

use super::develop::Develop;
use super::path::Path;
use crate::film::{Holds, Layer, Of, Tile};
use crate::object::Scratch;
use crate::scene::Feature;
use crate::stage::Stage;

/// The numbers of samples in the making; nothing where a film holds colour alone.
pub(super) struct Recorder {
    layers: Vec<Layer>,
    /// How many groups of lights there are.
    n_groups: usize,
    /// Of each number of a sample.
    ofs: Vec<Of>,
    /// Sample by sample, as many numbers as there are channels.
    values: Vec<f64>,
    /// Where the path in a lane began, if it has met nothing yet.
    fresh: Vec<Option<DVec3>>,
    /// Light of the groups that the path in a lane has gathered, lane by lane.
    light: Vec<Spectrum>,
    /// What the paths that arrived had gathered before.
    before: Vec<Spectrum>,
}

impl Recorder {
    pub(super) fn new(holds: &Holds, lanes: usize) -> Self {
        let n_groups = holds.groups.len();
        Self {
            layers: holds.layers.clone(),
            n_groups,
            ofs: holds.channels().iter().map(|channel| channel.of).collect(),
            values: vec![],
            fresh: vec![None; lanes],
            light: vec![Spectrum::ZERO; lanes * n_groups],
            before: vec![],
        }
    }

    /// Whether anything is recorded.
    pub(super) fn is_on(&self) -> bool {
        Feature::Layers.is_compiled() && !self.ofs.is_empty()
    }

    /// Whether light of groups is told apart.
    pub(super) fn has_groups(&self) -> bool {
        Feature::Layers.is_compiled() && self.n_groups > 0
    }

    /// So many samples follow.
    pub(super) fn clear(&mut self, samples: usize) {
        self.values.clear();
        self.values.resize(samples * self.ofs.len(), 0.0);
    }

    /// A path begins in a lane.
    pub(super) fn start(&mut self, lane: usize, from: DVec3) {
        self.fresh[lane] = Some(from);
        self.light[lane * self.n_groups..][..self.n_groups].fill(Spectrum::ZERO);
    }

    /// The path in a lane arrived.
    pub(super) fn arrived(
        &mut self,
        (lane, path): (usize, &Path),
        at: &Arrival,
        stage: &Stage,
        develop: &Develop,
    ) {
        let from = self.fresh[lane].take();
        let n = self.ofs.len();
        let Some(values) = self.values.get_mut(path.job as usize * n..(path.job as usize + 1) * n)
        else {
            return;
        };
        let from = from.filter(|_| at.kind != ArrivalKind::Escaped);
        if from.is_some() {
            values[0] = 1.0;
        }
        let mut rest = &mut values[1..];
        for layer in &self.layers {
            let (own, after) = std::mem::take(&mut rest).split_at_mut(layer.channels().len());
            rest = after;
            match layer {
                Layer::Cost => own[0] += f64::from(at.steps),
                Layer::Depth => own[0] = from.map_or(own[0], |from| at.p.distance(from)),
                _ if from.is_some() => met(*layer, own, (path, at), stage, develop),
                _ => {}
            }
        }
    }

    /// The path in a lane found light of a source that it had chosen.
    pub(super) fn found(&mut self, stage: &Stage, (lane, path): (u32, &Path), l: Spectrum) {
        let group = stage.lights.group_of.get(path.light as usize).copied().flatten();
        if let Some(group) = group {
            self.light[lane as usize * self.n_groups + group as usize] += l;
        }
    }

    /// Paths are about to be told where they arrived.
    pub(super) fn before(&mut self, lanes: &[Lane], arrived: &[u32]) {
        self.before.clear();
        self.before.extend(arrived.iter().map(|lane| lanes[*lane as usize].l));
    }

    /// They were told: what they gathered is of what shines where they are.
    pub(super) fn after(
        &mut self,
        stage: &Stage,
        (paths, lanes): (&[Path], &[Lane]),
        arrived: &[u32],
        scratch: &mut Scratch,
    ) {
        for (i, lane) in arrived.iter().enumerate() {
            let (path, Lane { at, l, .. }) = (&paths[*lane as usize], &lanes[*lane as usize]);
            let gathered = *l - self.before[i];
            if gathered.is_black() {
                continue;
            }
            let light = &mut self.light[*lane as usize * self.n_groups..][..self.n_groups];
            match at.kind {
                ArrivalKind::Escaped => {
                    let (stage, d, palette) = (stage.at(path.time), -at.wo, &path.palette);
                    scratch.reset();
                    let (all, _) = stage.escaped(d, palette, scratch);
                    for (group, light) in (0..).zip(light) {
                        scratch.reset();
                        let own = stage.escaped_to_group(group, d, palette, scratch);
                        *light += gathered * share(own, all);
                    }
                }
                ArrivalKind::Surface => {
                    let on = path.on.map(|on| on.leaving.placement as usize);
                    let source = on.and_then(|on| stage.placements[on].light);
                    let group = source.and_then(|i| stage.lights.group_of[i as usize]);
                    if let Some(group) = group {
                        light[group as usize] += gathered;
                    }
                }
                ArrivalKind::Medium => {}
            }
        }
    }

    /// The path in a lane has ended.
    pub(super) fn finish(&mut self, (lane, path): (usize, &Path), develop: &Develop) {
        let n = self.ofs.len();
        let values = &mut self.values[(path.job as usize + 1) * n - 3 * self.n_groups..]
            [..3 * self.n_groups];
        let light = &self.light[lane * self.n_groups..][..self.n_groups];
        for (own, l) in values.chunks_exact_mut(3).zip(light) {
            let rgb = develop.sample(*l * path.weight, &path.palette.wavelengths);
            own.copy_from_slice(&rgb.to_array());
        }
    }

    /// Adds the samples of a pixel to its tile, which knows it by `number`: it was the `i`th of so many
    /// pixels. Samples whose light is not finite count nowhere.
    pub(super) fn add(
        &self,
        tile: &mut Tile,
        number: usize,
        (i, n_pixels): (usize, usize),
        results: &[DVec3],
    ) {
        let (n, is_first) = (self.ofs.len(), tile.next == 0);
        let sums = &mut tile.layers[number * n..][..n];
        let is_finite = |sample: &usize| results[sample * n_pixels + i].is_finite();
        for sample in (0..results.len() / n_pixels).filter(is_finite) {
            let values = &self.values[(sample * n_pixels + i) * n..][..n];
            for ((sum, value), of) in sums.iter_mut().zip(values).zip(&self.ofs) {
                match of {
                    Of::First if is_first && sample == 0 => *sum = *value,
                    Of::First => {}
                    Of::All | Of::Met => *sum += *value,
                }
            }
        }
    }
}

/// What part is of the whole; none where that is black.
fn share(own: Spectrum, all: Spectrum) -> Spectrum {
    let lane = |i: usize| if all[i] > 0.0 { own[i] / all[i] } else { 0.0 };
    Spectrum::new(lane(0), lane(1), lane(2), lane(3))
}

/// What a layer says of the place that a path met first.
fn met(
    layer: Layer,
    own: &mut [f64],
    (path, at): (&Path, &Arrival),
    stage: &Stage,
    develop: &Develop,
) {
    let on = path.on.map(|on| on.leaving.placement);
    let number = |index: Option<u32>| index.map_or(0.0, |index| f64::from(index) + 1.0);
    match layer {
        Layer::Albedo => {
            let weight = at.scatter.get().map_or(Spectrum::ZERO, |scatter| scatter.weight);
            // By wavelength, as the white of linear sRGB shows it.
            let shown = if develop.is_spectral() {
                weight * path.palette.illuminant(Vec3::ONE)
            } else {
                weight
            };
            own.copy_from_slice(&develop.sample(shown, &path.palette.wavelengths).to_array());
        }
        Layer::Normal => own.copy_from_slice(&at.ns.to_array()),
        Layer::Position => own.copy_from_slice(&at.p.to_array()),
        Layer::Material => own[0] = number(Some(at.material).filter(|i| *i != u32::MAX)),
        Layer::Object => own[0] = number(on),
        Layer::Motion => {
            own.copy_from_slice(&motion(stage, on, (at.p, path.time)).to_array());
        }
        Layer::Depth | Layer::Cost => {}
    }
}

/// How far a place moves over the picture while the shutter is open. Of what bends as it moves, only
/// the motion of the whole counts.
fn motion(stage: &Stage, placement: Option<u32>, (p, time): (DVec3, f64)) -> DVec2 {
    let [open, close] = stage.film.during();
    let place = placement.map(|i| &stage.placements[i as usize].place);
    let local = place.and_then(|place| {
        let mut room = None;
        place.at(time, &mut room).map(|transform| transform.inverse_point(p))
    });
    let seen = |time: f64| {
        let mut room = None;
        let transform = place.and_then(|place| place.at(time, &mut room));
        let p = transform.zip(local).map_or(p, |(transform, local)| transform.point(local));
        stage.at(time).project(p)
    };
    match (seen(open), seen(close)) {
        (Some(a), Some(b)) if (b - a).is_finite() => b - a,
        _ => DVec2::ZERO,
    }
}
