//! The singular configurations that were found.

use crate::system::System;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Number of configurations for which memory is allocated at the start.
const USUAL: usize = 64;
/// Greatest number of configurations that are kept; the search ends there.
const MAX_CONFIGURATIONS: usize = 1000;
/// Times of different islands that are closer than this, relative to 1 s or the time itself, belong to one configuration.
const SAME_TIME: f64 = 1e-6;

/// A singular configuration that a run passed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SingularConfiguration {
    /// When, s.
    pub time: f64,
    /// Joints and drivers that take part where rows become dependent on each other.
    pub joints: Vec<String>,
}

/// A configuration as it is kept, and where its joints stand in the list of all.
#[derive(Clone, Debug)]
struct Entry {
    time: f64,
    /// The island whose joints they are.
    island: usize,
    joints: Range<usize>,
}

/// A place where branches of the motion come near each other, and either may have been followed.
#[derive(Clone, Debug)]
pub(super) struct Doubtful {
    pub time: f64,
    /// How near, as an angle, rad.
    pub apart: f64,
    /// Places of the joints in the mechanism.
    pub joints: Vec<usize>,
    /// Whether the step was taken again: what is found then may settle it.
    pub open: bool,
}

/// All configurations that were found, in the order of time.
#[derive(Clone, Debug)]
pub(super) struct Found {
    entries: Vec<Entry>,
    /// Joints of all entries.
    joints: Vec<usize>,
    doubtful: Vec<Doubtful>,
}

impl Found {
    /// Allocates for a number of constraints.
    pub(super) fn new(constraints: usize) -> Self {
        Self {
            entries: Vec::with_capacity(USUAL),
            joints: Vec::with_capacity(USUAL * constraints),
            doubtful: Vec::new(),
        }
    }

    pub(super) fn clear(&mut self) {
        self.entries.clear();
        self.joints.clear();
        self.doubtful.clear();
    }

    pub(super) fn is_full(&self) -> bool {
        self.entries.len() >= MAX_CONFIGURATIONS
    }

    /// All of them by name; islands that pass theirs at the same time have one in common.
    pub(super) fn list(&self, system: &System) -> Vec<SingularConfiguration> {
        let name = |&joint: &usize| system.constraints[joint].name.clone();
        let mut list: Vec<SingularConfiguration> = Vec::new();
        for entry in &self.entries {
            let joints = self.joints[entry.joints.clone()].iter().map(name);
            match list.last_mut() {
                Some(last) if entry.time - last.time <= SAME_TIME * (1.0 + last.time.abs()) => {
                    last.joints.extend(joints);
                }
                _ => list.push(SingularConfiguration { time: entry.time, joints: joints.collect() }),
            }
        }
        list
    }

    /// Keeps a doubtful place. Of those nearer to each other than `near` one is kept, one that is not open before others.
    pub(super) fn doubt(&mut self, place: Doubtful, near: f64) {
        match self.doubtful.iter_mut().find(|known| (known.time - place.time).abs() <= near) {
            None => self.doubtful.push(place),
            Some(known) if known.open => *known = place,
            Some(_) => {}
        }
    }

    /// What steps that were taken again have found nearer to a time than `near` leaves no doubt.
    pub(super) fn settle(&mut self, time: f64, near: f64) {
        self.doubtful.retain(|known| !(known.open && (known.time - time).abs() <= near));
    }

    /// The doubtful places, in words.
    pub(super) fn doubts(&self, system: &System) -> Vec<String> {
        let sentence = |place: &Doubtful| {
            let joints: Vec<&str> =
                place.joints.iter().map(|&joint| system.constraints[joint].name.as_str()).collect();
            format!(
                "at t = {:.6} s the motion passes within {:.0e} of a branching position of {}; either branch may be right: \
                 compare with taylor at a tighter tolerance, or change a length a little",
                place.time,
                place.apart,
                joints.join(", ")
            )
        };
        self.doubtful.iter().map(sentence).collect()
    }

    /// Whether a configuration is known to which a zero at a time belongs: of the same island, and nearer than `near`.
    pub(super) fn is_known(&self, island: usize, time: f64, near: f64) -> bool {
        self.entries.iter().any(|known| known.island == island && (known.time - time).abs() <= near)
    }

    /// Forgets what was found of an island after a time, to which it goes back.
    pub(super) fn forget_after(&mut self, island: usize, time: f64) {
        self.entries.retain(|entry| entry.island != island || entry.time <= time);
    }

    /// Keeps a configuration with the places of its joints in the mechanism.
    pub(super) fn add(&mut self, island: usize, time: f64, joints: impl Iterator<Item = usize>) {
        let first = self.joints.len();
        self.joints.extend(joints);
        self.entries.push(Entry { time, island, joints: first..self.joints.len() });
        self.entries.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
    }
}
