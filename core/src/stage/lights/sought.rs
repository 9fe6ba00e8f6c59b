//! Which light is looked for.

use std::sync::Arc;

use luxel_sdk::sampling::Alias;

use super::LightSource;
use crate::cast::{index, narrow};
use crate::scene::Feature;

/// The lights that are looked for, at least one, and how one of them is chosen.
#[derive(Debug)]
pub(super) struct Sought {
    /// Over all sources; the others are never drawn.
    choice: Arc<Alias>,
    first: u32,
    is_one: bool,
}

/// A source that was chosen.
pub(super) struct Chosen<'a> {
    pub(super) source: &'a LightSource,
    pub(super) light: u32,
    pub(super) chance: f32,
    /// What is left of the random number.
    pub(super) u: f64,
}

impl Sought {
    /// Those of the sources that are meant, by their weights; `None` if none is. `all` is the choice among
    /// all sources, shared where all are meant.
    pub(super) fn new(
        sources: &[LightSource],
        is_meant: impl Fn(&LightSource) -> bool,
        weights: &[f64],
        all: Option<&Arc<Alias>>,
    ) -> Option<Self> {
        let meant = || (0..).zip(sources).filter(|(_, light)| is_meant(light)).map(|(i, _)| i);
        let (first, count) = (meant().next()?, meant().count());
        let choice = if count == sources.len() {
            all?.clone()
        } else {
            let of_meant = |(light, weight): (_, &f64)| if is_meant(light) { *weight } else { 0.0 };
            let weights: Vec<f64> = sources.iter().zip(weights).map(of_meant).collect();
            Alias::new(&weights).ok()?.into()
        };
        Some(Self { choice, first, is_one: count == 1 })
    }

    /// The first of them.
    pub(super) fn first<'a>(&self, sources: &'a [LightSource]) -> &'a LightSource {
        &sources[self.first as usize]
    }

    /// Whether there is something to choose: a source, or a triangle of the only one.
    pub(super) fn is_choice(&self, sources: &[LightSource]) -> bool {
        !(self.is_one && self.first(sources).is_whole())
    }

    /// With which chance a source is chosen.
    pub(super) fn chance(&self, light: u32) -> f64 {
        self.choice.pmf(light as usize)
    }

    /// A source and its chance. `u` uniform in [0, 1). Compiled for scenes with a choice among lights, and
    /// for others.
    #[inline(always)]
    pub(super) fn choose<'a, const CHOICE: bool>(
        &self,
        sources: &'a [LightSource],
        u: f32,
    ) -> Chosen<'a> {
        if !CHOICE || !Feature::LightChoice.is_compiled() || self.is_one {
            let source = self.first(sources);
            return Chosen { source, light: self.first, chance: 1.0, u: f64::from(u) };
        }
        let drawn = self.choice.sample(f64::from(u));
        let (source, chance) = (&sources[drawn.index], narrow(drawn.pmf));
        Chosen { source, light: index(drawn.index), chance, u: drawn.u }
    }
}
