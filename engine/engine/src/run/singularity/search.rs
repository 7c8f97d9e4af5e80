//! The search for singular configurations inside a step.

use super::found::Found;
use super::history::IslandHistory;
use super::probe::{self, Probe};
use crate::integrate::Integrator;
use triad_dynamics::constraints::mechanism::Mechanism;

/// Greatest number of times that a step is halved.
const MAX_DEPTH: usize = 8;
/// Places for pivot products: both ends of a step, one for each division, one for the search for a zero, and one to spare.
pub(super) const SAMPLES: usize = MAX_DEPTH + 4;
/// Bound of the rate at which the distance from a singular configuration, as an angle, changes, relative to the pace of the
/// fastest body.
const RATE_BOUND: f64 = 2.5;
/// The same relative to the fastest change of that joint so far, which masses and lengths may make faster.
const OBSERVED_RATE_BOUND: f64 = 2.0;
/// A joint whose largest pivot product is below this is redundant.
const REDUNDANT: f64 = 1e-7;
/// Pivot product, in zeros of the joint, below which a joint has become dependent at the configuration that was found last.
const TOGETHER: f64 = 1e3;
/// Pivot product below which a joint is named with a configuration.
const INVOLVED: f64 = 1e-6;
/// Turn of the rows below which a part of a step is not divided, rad.
const FINEST: f64 = 0.05;
/// Greatest number of probes in the search for one zero.
const MAX_PROBES: usize = 12;
/// Factor by which each probe should bring the root of the pivot product nearer to zero.
const CONVERGING: f64 = 0.5;
/// Number of probes that do not come nearer to a zero after which the search ends.
const MAX_FAILURES: usize = 3;
/// Turn of the rows, in roots of what counts as zero, below which two zeros of the same joint are one configuration.
const SAME: f64 = 20.0;

/// A time and the pivot product of a joint there.
type Sample = (f64, f64);

/// The search for zeros of pivot products inside a step.
pub(super) struct Search<'a> {
    pub probe: &'a mut Probe,
    pub found: &'a mut Found,
    pub mechanism: &'a mut Mechanism,
    pub integrator: &'a mut Integrator,
    pub history: &'a IslandHistory,
    /// Part of a joint's largest pivot product that counts as zero.
    pub zero: f64,
    /// How fast rows turn, 1/s.
    pub pace: f64,
    /// Pivot products at the start and at the end of the step, then those of probes.
    pub samples: &'a mut [Vec<f64>],
    /// Pivot products at the configuration that was found last.
    pub at_found: &'a mut Vec<f64>,
}

impl Search<'_> {
    /// Keeps the pivot products at time t.
    fn sample(&mut self, t: f64, place: usize) {
        self.probe.pivot_products(self.mechanism, self.integrator, t, &mut self.samples[place]);
    }

    /// What counts as zero for the pivot product of a joint.
    fn zero(&self, joint: usize) -> f64 {
        self.history.largest[joint] * self.zero
    }

    /// The joint that is most likely to become dependent between two samples so far apart in time; and its distances from that
    /// at both: zero there, π/2 at its largest pivot product.
    fn suspect(&self, a: usize, b: usize, apart: f64) -> Option<(usize, f64, f64)> {
        // In steps that rounding makes very short both ends may be indistinguishable from zero.
        let floor = self.zero.sqrt();
        let turned = apart * self.pace;
        let IslandHistory { largest, fastest_change, .. } = self.history;
        let mut found = None;
        let mut least = 1.0;
        for (joint, largest) in largest.iter().enumerate().filter(|(_, largest)| **largest > REDUNDANT) {
            let part = |place: usize| {
                let product = self.samples[place].get(joint).copied().unwrap_or(f64::NAN);
                let root = (product / largest).clamp(0.0, 1.0).sqrt();
                if root <= floor { 0.0 } else { root - floor }
            };
            let observed = fastest_change.get(joint);
            let rate = observed.map_or(RATE_BOUND, |fastest| RATE_BOUND.max(OBSERVED_RATE_BOUND * fastest));
            let bound = rate * turned;
            let (from, to) = (part(a), part(b));
            // The sine is less than its angle. Comparisons that are false for NaN as well.
            if from + to <= least * bound {
                let (from, to) = (libm::asin(from), libm::asin(to));
                let gone =
                    self.at_found.get(joint).is_some_and(|found| *found <= TOGETHER * self.zero(joint));
                if from + to <= least * bound && !gone {
                    least = (from + to) / bound.max(f64::MIN_POSITIVE);
                    found = Some((joint, from, to));
                }
            }
        }
        found
    }

    /// Searches for zeros between two times whose samples are given; further ones are kept from `place` on.
    pub(super) fn within(&mut self, a: (f64, usize), b: (f64, usize), place: usize) {
        if place + 1 >= self.samples.len() || self.found.is_full() {
            return;
        }
        let apart = b.0 - a.0;
        let Some((joint, from, to)) = self.suspect(a.1, b.1, apart) else { return };
        // Where it would be zero if it fell and rose at one rate.
        let part = if from + to > 0.0 { (from / (from + to)).clamp(0.1, 0.9) } else { 0.5 };
        let time = a.0 + part * apart;
        self.sample(time, place);
        let sample = |search: &Self, (t, place): (f64, usize)| (t, search.samples[place][joint]);
        let middle = (time, place);
        let near = (sample(self, middle).1 / self.history.largest[joint]).max(0.0).sqrt();
        let finest = apart * self.pace < FINEST;
        if near < CONVERGING * from.max(to) || finest {
            let three = (sample(self, a), sample(self, middle), sample(self, b));
            if let Some(zero) = self.root(joint, three.0, three.1, three.2) {
                self.keep(joint, zero);
            }
        }
        if finest {
            return;
        }
        self.within(a, middle, place + 1);
        self.within(middle, b, place + 1);
    }

    /// The time of a zero near `m`, by the secant: the root of the pivot product is a number that changes its sign there, of
    /// which only the size is known. Of the two zeros that two sizes allow, the slope selects one.
    fn root(&mut self, joint: usize, a: Sample, m: Sample, b: Sample) -> Option<f64> {
        let root = |(t, product): Sample| (t, product.max(0.0).sqrt());
        let place = self.samples.len() - 1;
        let (mut last, mut now) = (root(a), root(m));
        let mut slope = (last.1 + root(b).1) / (b.0 - a.0);
        let zero = self.zero(joint);
        let mut failures = 0;
        for _ in 0..MAX_PROBES {
            let apart = (now.0 - last.0).abs();
            let slopes = [last.1 + now.1, (last.1 - now.1).abs()].map(|change| change / apart);
            let between = libm::log(slopes[0] / slope).abs() <= libm::log(slopes[1] / slope).abs();
            slope = if between { slopes[0] } else { slopes[1] };
            let signed = if between { -now.1 } else { now.1 };
            // A zero at an end of the step may seem to lie behind it.
            let next = (now.0 + (now.0 - last.0) * signed / (last.1 - signed)).clamp(a.0, b.0);
            let vanishes = now.1 * now.1 <= zero;
            if next.is_nan() || next == now.0 {
                return vanishes.then_some(now.0);
            }
            self.sample(next, place);
            let there = root((next, self.samples[place][joint]));
            if vanishes {
                return Some(if there.1 < now.1 { next } else { now.0 });
            }
            failures += usize::from(there.1 > CONVERGING * now.1);
            if failures == MAX_FAILURES {
                return None;
            }
            (last, now) = (now, there);
        }
        None
    }

    /// Keeps the singular configuration at a zero, unless it is known.
    fn keep(&mut self, joint: usize, time: f64) {
        let place = self.samples.len() - 1;
        self.sample(time, place);
        probe::copy(&self.samples[place], self.at_found);
        let product = self.samples[place][joint];
        let near = SAME * self.zero.sqrt() / self.pace;
        // Of all constraints, where the samples may be those of one island.
        let products = self.probe.evaluate(self.mechanism, self.integrator, time);
        if self.found.is_known(joint, time, product, near) {
            return;
        }
        let least = products.iter().fold(f64::INFINITY, |least, product| least.min(*product));
        let limit = INVOLVED.max(self.zero).max(2.0 * least);
        self.found.add(time, product, (0..products.len()).filter(|joint| products[*joint] <= limit));
    }
}
