//! The search for singular positions inside a step.

use super::{Approach, MOST, Passed, Watch, renew};
use crate::integrate::Integrator;
use triad_dynamics::constraints::mechanism::Mechanism;

/// How fast the distance from a singular position, as an angle, may change beside the fastest turning body.
const FASTER: f64 = 2.5;
/// The same beside the fastest change of that joint so far, which masses and lengths may make faster.
const STEADY: f64 = 2.0;
/// Joints that never hold more firmly are redundant.
const REDUNDANT: f64 = 1e-7;
/// Joints whose hold is below so many zeros at the passage of another have lost it with that one.
const TOGETHER: f64 = 1e3;
/// Joints that are named hold less than this.
const INVOLVED: f64 = 1e-6;
/// Least part of a step that is looked at, rad.
const FINEST: f64 = 0.05;
/// Looks in the search for a zero, how much nearer each is to come, and how many may fail to.
const LOOKS: usize = 12;
const NEARER: f64 = 0.5;
const FAILURES: usize = 3;
/// Passages nearer to each other than this part of the time are one.
const APART: f64 = 1e-6;
/// Two at which the same joint loses its hold are one if rows turn less than so many times what cannot be told from zero.
const SAME: f64 = 20.0;

/// A time and the hold of a joint there.
type Spot = (f64, f64);

/// The search for zeros of holds inside a step.
pub(super) struct Search<'a> {
    pub watch: &'a mut Watch,
    pub mechanism: &'a mut Mechanism,
    pub integrator: &'a mut Integrator,
    pub approach: &'a Approach,
    /// How fast rows turn, 1/s.
    pub pace: f64,
    pub places: &'a mut [Vec<f64>],
}

impl Search<'_> {
    /// Looks at time t, and keeps the holds.
    fn look(&mut self, t: f64, place: usize) {
        self.watch.look(self.mechanism, self.integrator, t, &mut self.places[place]);
    }

    /// What counts as zero for the hold of a joint.
    fn zero(&self, joint: usize) -> f64 {
        self.approach.firmest[joint] * self.watch.zero
    }

    /// The joint that is most likely to lose its hold between two places so far apart in time; and its distances from that
    /// at both: zero there, π/2 at its firmest hold.
    fn suspect(&self, a: usize, b: usize, apart: f64) -> Option<(usize, f64, f64)> {
        // In steps that rounding makes very short both ends may be as near to zero as can be told.
        let floor = self.watch.zero.sqrt();
        let turned = apart * self.pace;
        let Approach { firmest, faster, .. } = self.approach;
        let mut found = None;
        let mut least = 1.0;
        for (joint, firmest) in firmest.iter().enumerate().filter(|(_, firmest)| **firmest > REDUNDANT) {
            let part = |place: usize| {
                let hold = self.places[place].get(joint).copied().unwrap_or(f64::NAN);
                let root = (hold / firmest).clamp(0.0, 1.0).sqrt();
                if root <= floor { 0.0 } else { root - floor }
            };
            let faster = faster.get(joint).map_or(FASTER, |faster| FASTER.max(STEADY * faster));
            let bound = faster * turned;
            let (from, to) = (part(a), part(b));
            // The sine is less than its angle. Comparisons that are false for NaN as well.
            if from + to <= least * bound {
                let (from, to) = (from.asin(), to.asin());
                let gone =
                    self.watch.there.get(joint).is_some_and(|hold| *hold <= TOGETHER * self.zero(joint));
                if from + to <= least * bound && !gone {
                    least = (from + to) / bound.max(f64::MIN_POSITIVE);
                    found = Some((joint, from, to));
                }
            }
        }
        found
    }

    /// Looks for zeros between two places.
    pub fn within(&mut self, a: (f64, usize), b: (f64, usize), place: usize) {
        if place + 1 >= self.places.len() || self.watch.passed.len() >= MOST {
            return;
        }
        let apart = b.0 - a.0;
        let Some((joint, from, to)) = self.suspect(a.1, b.1, apart) else { return };
        // Where it would be zero if it fell and rose at one rate.
        let part = if from + to > 0.0 { (from / (from + to)).clamp(0.1, 0.9) } else { 0.5 };
        let time = a.0 + part * apart;
        self.look(time, place);
        let spot = |search: &Self, (t, place): (f64, usize)| (t, search.places[place][joint]);
        let middle = (time, place);
        let near = (spot(self, middle).1 / self.approach.firmest[joint]).max(0.0).sqrt();
        let finest = apart * self.pace < FINEST;
        if near < NEARER * from.max(to) || finest {
            let spots = (spot(self, a), spot(self, middle), spot(self, b));
            if let Some(zero) = self.root(joint, spots.0, spots.1, spots.2) {
                self.found(joint, zero);
            }
        }
        if finest {
            return;
        }
        self.within(a, middle, place + 1);
        self.within(middle, b, place + 1);
    }

    /// The time of a zero near `m`, by the secant: the root of the hold is a number that changes its sign there, of which
    /// only the size is known. Which of the two zeros that two sizes allow is meant, its slope tells.
    fn root(&mut self, joint: usize, a: Spot, m: Spot, b: Spot) -> Option<f64> {
        let root = |(t, hold): Spot| (t, hold.max(0.0).sqrt());
        let place = self.places.len() - 1;
        let (mut last, mut now) = (root(a), root(m));
        let mut slope = (last.1 + root(b).1) / (b.0 - a.0);
        let zero = self.zero(joint);
        let mut failures = 0;
        for _ in 0..LOOKS {
            let apart = (now.0 - last.0).abs();
            let slopes = [last.1 + now.1, (last.1 - now.1).abs()].map(|change| change / apart);
            let between = (slopes[0] / slope).ln().abs() <= (slopes[1] / slope).ln().abs();
            slope = if between { slopes[0] } else { slopes[1] };
            let signed = if between { -now.1 } else { now.1 };
            // A zero at an end of the step may seem to lie behind it.
            let next = (now.0 + (now.0 - last.0) * signed / (last.1 - signed)).clamp(a.0, b.0);
            let vanishes = now.1 * now.1 <= zero;
            if next.is_nan() || next == now.0 {
                return vanishes.then_some(now.0);
            }
            self.look(next, place);
            let there = root((next, self.places[place][joint]));
            if vanishes {
                return Some(if there.1 < now.1 { next } else { now.0 });
            }
            failures += usize::from(there.1 > NEARER * now.1);
            if failures == FAILURES {
                return None;
            }
            (last, now) = (now, there);
        }
        None
    }

    fn found(&mut self, joint: usize, time: f64) {
        let place = self.places.len() - 1;
        self.look(time, place);
        renew(&mut self.watch.there, &self.places[place]);
        let hold = self.places[place][joint];
        self.watch.place(self.mechanism, self.integrator, time);
        let Watch { passed, involved, scout, zero, .. } = &mut *self.watch;
        let near = SAME * zero.sqrt() / self.pace;
        let same = |known: &&mut Passed| {
            let apart = (known.time - time).abs();
            apart <= APART * (1.0 + time.abs())
                || (apart <= near && involved[known.joints.clone()].contains(&joint))
        };
        if let Some(known) = passed.iter_mut().find(same) {
            if hold < known.hold {
                (known.time, known.hold) = (time, hold);
            }
            return;
        }
        let Some((state, scout)) = scout else { return };
        let holds = scout.holds_at(&self.mechanism.system, state);
        let least = holds.iter().fold(f64::INFINITY, |least, hold| least.min(*hold));
        let limit = INVOLVED.max(*zero).max(2.0 * least);
        let first = involved.len();
        involved.extend((0..holds.len()).filter(|joint| holds[*joint] <= limit));
        passed.push(Passed { time, hold, joints: first..involved.len() });
        passed.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
    }
}
