//! What a statement of a file came to, noted while it is evaluated.

use std::ops::Range;

use luxel_core::diag::Diagnostic;
use luxel_core::scene::{Expectation, NodeId, Pose};
use luxel_sdk::kind::Kind;

use super::super::Evaluator;
use crate::budgets::Budgets;

/// What a statement put into the scene and what that took.
#[derive(Debug, Default)]
pub(in crate::eval) struct Made {
    /// Its nodes and groups, by number.
    pub(super) nodes: Range<usize>,
    pub(super) groups: Range<usize>,
    /// How many things it put into the world.
    pub(super) n_items: usize,
    pub(super) rare: Option<Box<Rare>>,
    pub(super) cost: Cost,
}

/// What few statements do.
#[derive(Debug, Default)]
pub(super) struct Rare {
    /// The settings that it gave.
    pub(super) slots: Vec<Slot>,
    pub(super) expectations: Vec<Expectation>,
    pub(super) has_asset: bool,
    /// Other files came into it.
    pub(super) has_read: bool,
    /// How often its evaluation told something in a load of the whole file.
    pub(super) n_told: usize,
    pub(super) told: Told,
}

/// Told of a statement, whose places lie in it and count from its first byte.
#[derive(Debug, Default)]
pub(super) struct Told {
    /// Of what does not close in it.
    pub(super) faults: Vec<Diagnostic>,
    /// Of how it is written.
    pub(super) read: Vec<Diagnostic>,
    /// Of what it came to.
    pub(super) found: Vec<Diagnostic>,
}

impl Made {
    /// Whether it put something into the world or gave a setting.
    pub(super) fn stands_somewhere(&self) -> bool {
        self.n_items > 0 || self.rare.as_ref().is_some_and(|rare| !rare.slots.is_empty())
    }

    /// Whether other files came into it.
    pub(super) fn has_read(&self) -> bool {
        self.rare.as_ref().is_some_and(|rare| rare.has_read)
    }

    /// What is said of it, to be added to.
    pub(super) fn told_mut(&mut self) -> &mut Told {
        &mut self.rare.get_or_insert_default().told
    }
}

/// A camera, film, … of the scene.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    pub(super) kind: Kind,
    pub(super) id: NodeId,
    /// Where a camera stands.
    pub(super) pose: Pose,
}

/// What budgets bound: steps, bytes of values, nodes and placements, instances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cost([u64; 4]);

impl Cost {
    pub(super) fn of(evaluator: &Evaluator<'_>) -> Self {
        let n_instances = evaluator.open_groups.first().map_or(0, |open| open.instances);
        let wide = |n: usize| n as u64;
        Self([evaluator.steps, wide(evaluator.held.get()), wide(evaluator.placements), n_instances])
    }

    pub(super) fn of_steps(steps: u64) -> Self {
        Self([steps, 0, 0, 0])
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_add(other.0[i])))
    }

    pub(super) fn minus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_sub(other.0[i])))
    }

    pub(super) fn is_within(self, budgets: &Budgets) -> bool {
        let wide = |n: usize| n as u64;
        let most =
            [budgets.steps, wide(budgets.value_bytes), wide(budgets.nodes), budgets.instances];
        self.0.iter().zip(most).all(|(spent, most)| *spent <= most)
    }
}

/// Where an evaluation stands before a statement.
pub(super) struct Mark {
    n_nodes: usize,
    n_groups: usize,
    n_items: usize,
    n_slots: usize,
    n_expectations: usize,
    had_asset: bool,
    n_reads: usize,
    n_told: usize,
    cost: Cost,
}

impl Evaluator<'_> {
    /// Where it stands, at the top level of the root file.
    pub(super) fn mark(&mut self) -> Mark {
        Mark {
            n_nodes: self.scene.nodes.len(),
            n_groups: self.scene.groups.len(),
            n_items: self.n_items(),
            n_slots: self.slots.len(),
            n_expectations: self.scene.expectations.len(),
            had_asset: std::mem::take(&mut self.has_asset),
            n_reads: self.includes + self.n_reads,
            n_told: self.sink.kept().len(),
            cost: Cost::of(self),
        }
    }

    /// What has been made since.
    pub(super) fn made_since(&mut self, mark: &Mark) -> Made {
        let has_asset = self.has_asset;
        self.has_asset |= mark.had_asset;
        let kinds: Vec<Kind> = self.slots[mark.n_slots..].iter().map(|(kind, _)| *kind).collect();
        let mut slot = |kind: Kind| {
            let id = (*self.scene.slot_mut(kind)?)?;
            let is_camera = kind == Kind::Camera;
            let pose = if is_camera { self.scene.camera_pose.clone() } else { Pose::Here };
            Some(Slot { kind, id, pose })
        };
        let slots: Vec<Slot> = kinds.into_iter().filter_map(&mut slot).collect();
        let expectations = self.scene.expectations[mark.n_expectations..].to_vec();
        let has_read = self.includes + self.n_reads > mark.n_reads;
        let n_told = self.sink.kept().len() - mark.n_told;
        let is_rare =
            has_asset || has_read || n_told > 0 || !slots.is_empty() || !expectations.is_empty();
        let told = Told::default();
        let rare = || Box::new(Rare { slots, expectations, has_asset, has_read, n_told, told });
        Made {
            nodes: mark.n_nodes..self.scene.nodes.len(),
            groups: mark.n_groups..self.scene.groups.len(),
            n_items: self.n_items() - mark.n_items,
            rare: is_rare.then(rare),
            cost: Cost::of(self).minus(mark.cost),
        }
    }

    /// Things in the world so far.
    fn n_items(&self) -> usize {
        self.open_groups.first().map_or(0, |open| open.group.items.len())
    }
}
