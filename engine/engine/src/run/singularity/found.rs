//! The singular configurations that were found.

use crate::system::System;
use schemars::JsonSchema;
use serde::Serialize;
use std::ops::Range;

/// Number of configurations for which memory is allocated at the start.
const USUAL: usize = 64;
/// Greatest number of configurations that are kept; the search ends there.
const MAX_CONFIGURATIONS: usize = 1000;
/// Times that are closer than this, relative to 1 s or the time itself, belong to one configuration.
const SAME_TIME: f64 = 1e-6;

/// A singular configuration that a run passed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SingularConfiguration {
    /// When, s.
    pub time: f64,
    /// Joints whose rows become dependent there.
    pub joints: Vec<String>,
}

/// A configuration as it is kept, and where its joints stand in the list of all.
#[derive(Clone, Debug)]
struct Entry {
    time: f64,
    /// The pivot product that was found there.
    pivot_product: f64,
    joints: Range<usize>,
}

/// All configurations that were found, in the order of time.
#[derive(Clone, Debug)]
pub(super) struct Found {
    entries: Vec<Entry>,
    /// Joints of all entries.
    joints: Vec<usize>,
}

impl Found {
    /// Allocates for a number of constraints.
    pub(super) fn new(constraints: usize) -> Self {
        Self { entries: Vec::with_capacity(USUAL), joints: Vec::with_capacity(USUAL * constraints) }
    }

    pub(super) fn clear(&mut self) {
        self.entries.clear();
        self.joints.clear();
    }

    pub(super) fn is_full(&self) -> bool {
        self.entries.len() >= MAX_CONFIGURATIONS
    }

    pub(super) fn list(&self, system: &System) -> Vec<SingularConfiguration> {
        let name = |&joint: &usize| system.constraints[joint].name.clone();
        let named = |entry: &Entry| SingularConfiguration {
            time: entry.time,
            joints: self.joints[entry.joints.clone()].iter().map(name).collect(),
        };
        self.entries.iter().map(named).collect()
    }

    /// Whether the configuration at a time at which a joint becomes dependent is known: at the same time, or with the same
    /// joint at a time that is nearer than `near`. The one of the two that is nearer to zero is kept.
    pub(super) fn is_known(&mut self, joint: usize, time: f64, pivot_product: f64, near: f64) -> bool {
        let Self { entries, joints } = self;
        let same = |known: &&mut Entry| {
            let apart = (known.time - time).abs();
            apart <= SAME_TIME * (1.0 + time.abs())
                || (apart <= near && joints[known.joints.clone()].contains(&joint))
        };
        let Some(known) = entries.iter_mut().find(same) else { return false };
        if pivot_product < known.pivot_product {
            (known.time, known.pivot_product) = (time, pivot_product);
        }
        true
    }

    pub(super) fn add(&mut self, time: f64, pivot_product: f64, joints: impl Iterator<Item = usize>) {
        let first = self.joints.len();
        self.joints.extend(joints);
        self.entries.push(Entry { time, pivot_product, joints: first..self.joints.len() });
        self.entries.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
    }
}
