//! Singular positions that a run passes, found from the pivots of the factorization — THEORY section 8.
//!
//! Near a singular position the smallest relative pivot of S falls with the square of the distance. Where it is small
//! at an end of a step, the step is searched for a minimum that is zero. Runs that stay away from singular positions
//! pay one comparison a step; where rows are redundant, whose pivots are always zero, one factorization a step.

use crate::integrate::Integrator;
use crate::mechanism::Mechanism;
use crate::rank::Rank;
use crate::system::System;
use serde::Serialize;

/// A step is looked at inside if its pivot falls below this part of the largest one seen.
const NEAR: f64 = 0.8;
/// The root of the pivot falls and rises linearly. A step is searched if that is less inside than at both ends, or at one
/// end than this part of the mean of both.
const SUSPICIOUS_END: f64 = 0.5;
/// Places inside a step that are looked at first.
const LOOKS: u32 = 8;
/// A minimum of the relative pivot below this part of the largest one is zero.
const ZERO: f64 = 1e-9;
/// Joints that are named have a pivot below this part of the largest one, at the minimum.
const INVOLVED: f64 = 1e-6;
/// Steps of the search for a minimum: each makes the interval smaller by the golden ratio.
const NARROWINGS: usize = 60;
/// Passages that are kept: a run through more of them is told by their number alone.
const MOST: usize = 1000;

/// A singular position that was passed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passage {
    /// When, s.
    pub time: f64,
    /// Joints whose rows lose their hold there.
    pub joints: Vec<String>,
}

/// Watches the pivots of a run.
#[derive(Clone, Debug)]
pub struct Watch {
    /// For each solver row, whether it depends on others everywhere.
    dependent: Vec<bool>,
    redundant: bool,
    largest: f64,
    /// Pivot at the end of the last step.
    last: f64,
    passages: Vec<Passage>,
    y: Vec<f64>,
}

impl Watch {
    /// For a system whose rank is known.
    pub fn new(system: &System, rank: &Rank) -> Self {
        let mut dependent = vec![false; system.solver_rows];
        for &row in &rank.dependent {
            dependent[row] = true;
        }
        Self {
            redundant: !rank.dependent.is_empty(),
            dependent,
            largest: 0.0,
            last: 0.0,
            passages: Vec::new(),
            y: vec![0.0; 2 * system.coordinates],
        }
    }

    /// Begins anew.
    pub fn forget(&mut self) {
        (self.largest, self.last) = (0.0, 0.0);
        self.passages.clear();
    }

    /// What was passed so far.
    pub fn passages(&self) -> &[Passage] {
        &self.passages
    }

    /// Looks at the step that was taken last.
    pub fn step(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator) {
        if mechanism.system.solver_rows == 0 || self.passages.len() >= MOST {
            return;
        }
        let counters = mechanism.elimination.counters;
        let end = integrator.time();
        let pivot = if self.redundant {
            self.pivot_at(mechanism, integrator, end)
        } else {
            integrator.smallest_pivot(mechanism)
        };
        let near = self.largest > 0.0 && pivot.min(self.last) < NEAR * self.largest;
        let start = end - integrator.last_step();
        if near {
            let (a, b) = (pivot.max(0.0).sqrt(), self.last.max(0.0).sqrt());
            let last = self.last;
            let mut lower = |part: f64| {
                let inside = self.pivot_at(mechanism, integrator, start + part * (end - start));
                inside < pivot.min(last)
            };
            if a.min(b) <= SUSPICIOUS_END * 0.5 * (a + b) || [0.25, 0.5, 0.75].into_iter().any(&mut lower) {
                self.search(mechanism, integrator, start, end);
            }
        }
        self.largest = self.largest.max(pivot);
        self.last = pivot;
        mechanism.elimination.counters = counters;
    }

    /// Smallest relative pivot of the rows that are independent in general, at a time within the last step.
    fn pivot_at(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator, t: f64) -> f64 {
        integrator.interpolate(mechanism, t, &mut self.y);
        mechanism.set_state(t, &self.y);
        let pivots = mechanism.elimination.pivots(&mechanism.system, 1e-13);
        let own = pivots.iter().filter(|(row, _)| !self.dependent[*row]);
        own.fold(f64::INFINITY, |least, (_, pivot)| least.min(*pivot))
    }

    fn search(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator, start: f64, end: f64) {
        let time = |k: u32| start + (end - start) * f64::from(k) / f64::from(LOOKS);
        let pivots: Vec<f64> = (0..=LOOKS).map(|k| self.pivot_at(mechanism, integrator, time(k))).collect();
        for k in 0..=LOOKS {
            let at = |k: u32| {
                usize::try_from(k).ok().and_then(|k| pivots.get(k)).copied().unwrap_or(f64::INFINITY)
            };
            if (k > 0 && at(k) > at(k - 1)) || (k < LOOKS && at(k) >= at(k + 1)) {
                continue;
            }
            let found =
                self.minimum(mechanism, integrator, time(k.saturating_sub(1)), time((k + 1).min(LOOKS)));
            let pivot = self.pivot_at(mechanism, integrator, found);
            let apart = self.passages.last().is_none_or(|last| found - last.time > 1e-3 * (end - start));
            if pivot <= ZERO * self.largest && apart {
                let joints = self.involved(mechanism);
                self.passages.push(Passage { time: found, joints });
            }
        }
    }

    /// Time of the minimum between two times, by golden section.
    fn minimum(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator, a: f64, b: f64) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let (mut a, mut b) = (a, b);
        let mut inner = [b - GOLDEN * (b - a), a + GOLDEN * (b - a)];
        let mut values = inner.map(|t| self.pivot_at(mechanism, integrator, t));
        for _ in 0..NARROWINGS {
            if values[0] <= values[1] {
                (b, inner[1], values[1]) = (inner[1], inner[0], values[0]);
                inner[0] = b - GOLDEN * (b - a);
                values[0] = self.pivot_at(mechanism, integrator, inner[0]);
            } else {
                (a, inner[0], values[0]) = (inner[0], inner[1], values[1]);
                inner[1] = a + GOLDEN * (b - a);
                values[1] = self.pivot_at(mechanism, integrator, inner[1]);
            }
            if b - a <= 1e-9 * (1.0 + b.abs()) {
                break;
            }
        }
        if values[0] <= values[1] { inner[0] } else { inner[1] }
    }

    /// Joints with a vanishing pivot at the positions that are in place.
    fn involved(&self, mechanism: &mut Mechanism) -> Vec<String> {
        let system = &mechanism.system;
        let pivots = mechanism.elimination.pivots(system, 1e-13);
        let limit = INVOLVED * self.largest;
        let rows: Vec<usize> = pivots
            .iter()
            .filter(|(row, pivot)| !self.dependent[*row] && *pivot <= limit)
            .map(|(row, _)| *row)
            .collect();
        let groups = system.groups.iter().filter(|group| rows.iter().any(|row| group.solver.contains(row)));
        groups.map(|group| group.name.clone()).collect()
    }
}
