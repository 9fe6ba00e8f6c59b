//! Records what a film's layers hold: what paths met first, and what they cost.

use glam::{DVec2, DVec3, Vec3};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, ArrivalKind};

use super::develop::Develop;
use super::path::Path;
use crate::film::{Layer, Of, Tile, channels};
use crate::stage::Stage;

/// The numbers of samples in the making; nothing where a film has no layers.
pub(super) struct Recorder {
    layers: Vec<Layer>,
    /// Of each number of a sample.
    ofs: Vec<Of>,
    /// Sample by sample, as many numbers as there are channels.
    values: Vec<f64>,
    /// Whether the path in a lane has met nothing yet.
    is_fresh: Vec<bool>,
}

impl Recorder {
    pub(super) fn new(layers: &[Layer], lanes: usize) -> Self {
        let ofs = channels(layers).iter().map(|channel| channel.of).collect();
        Self { layers: layers.to_vec(), ofs, values: vec![], is_fresh: vec![false; lanes] }
    }

    /// Whether anything is recorded.
    pub(super) fn is_on(&self) -> bool {
        !self.layers.is_empty()
    }

    /// So many samples follow.
    pub(super) fn clear(&mut self, samples: usize) {
        self.values.clear();
        self.values.resize(samples * self.ofs.len(), 0.0);
    }

    /// A path begins in a lane.
    pub(super) fn start(&mut self, lane: usize) {
        self.is_fresh[lane] = true;
    }

    /// The path in a lane arrived.
    pub(super) fn arrived(
        &mut self,
        (lane, path): (usize, &Path),
        at: &Arrival,
        stage: &Stage,
        develop: &Develop,
    ) {
        let is_first = std::mem::take(&mut self.is_fresh[lane]);
        let n = self.ofs.len();
        let Some(values) = self.values.get_mut(path.job as usize * n..(path.job as usize + 1) * n)
        else {
            return;
        };
        let has_met = is_first && at.kind != ArrivalKind::Escaped;
        if has_met {
            values[0] = 1.0;
        }
        let mut rest = &mut values[1..];
        for layer in &self.layers {
            let (own, after) = std::mem::take(&mut rest).split_at_mut(layer.channels().len());
            rest = after;
            match layer {
                Layer::Cost => own[0] += f64::from(at.steps),
                _ if has_met => met(*layer, own, (path, at), stage, develop),
                _ => {}
            }
        }
    }

    /// Adds sample `sample` of `of` for each of some pixels to a tile.
    pub(super) fn add(&self, tile: &mut Tile, chosen: &[u32], samples: usize) {
        let n = self.ofs.len();
        let is_first = tile.next == 0;
        for (i, pixel) in chosen.iter().enumerate() {
            let sums = &mut tile.layers[*pixel as usize * n..][..n];
            for sample in 0..samples {
                let values = &self.values[(sample * chosen.len() + i) * n..][..n];
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
        Layer::Depth => own[0] = at.t,
        Layer::Material => own[0] = number(Some(at.material).filter(|i| *i != u32::MAX)),
        Layer::Object => own[0] = number(on),
        Layer::Motion => {
            own.copy_from_slice(&motion(stage, on, (at.p, path.time)).to_array());
        }
        Layer::Cost => {}
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
