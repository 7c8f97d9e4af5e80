//! The search for dips of pivot products inside a step.

use super::found::{Doubtful, Found};
use super::history::IslandHistory;
use super::passage::{Dip, Examiner, Finding, root};
use super::sample::{REDUNDANT, Sample, any_within, single};
use crate::integrate::Track;
use std::f64::consts::PI;

/// Greatest number of times that a step is halved.
const MAX_DEPTH: usize = 14;
/// Places for pivot products: both ends of a step, one for each division, one for the search for a dip, and one to spare.
pub(super) const SAMPLES: usize = MAX_DEPTH + 4;
/// Distance of an end from a singular configuration, as an angle, rad, below which these bounds are widened, and by how much:
/// many change fastest just there.
const NEAR: f64 = 0.1;
const STEEP: f64 = 2.0;
/// Lower bound of such a distance, as an angle, rad, from which on it is not near.
const FAR: f32 = 0.1005;
/// Root of a pivot product, relative to the largest, below which a dip is looked at, and a joint has its zero at one.
const DEEP: f64 = 0.1;
/// Turn of the rows below which a part of a step is not divided, rad.
const FINEST: f64 = 0.05;
/// Greatest number of probes in the search for one dip.
const MAX_PROBES: usize = 12;
/// Turn of the rows up to which the time of a dip is found, and the same in its distance from zero.
const EXACT: (f64, f64) = (2e-5, 0.02);
/// The same where the distance from zero itself is wanted.
const SHARP: (f64, f64) = (1e-8, 0.05);
/// Root of a pivot product above which the distance of a dip from zero is known well enough.
const KNOWN: f64 = 5e-3;
/// Part of a dip's distance from zero below which the same, found exactly, makes it another one to look at.
const COARSE: f64 = 0.5;
/// Part of the distance of samples within which the vertex of their parabola is uncertain.
const UNCERTAIN: f64 = 0.1;
/// Turn of the rows by which a dip behind the end of a step may still be looked at with it, rad: the next step would start
/// beside it.
const BEHIND: f64 = 2e-3;
/// Turn of the rows within which two dips are one, rad: a joint that has lost its hold has to turn before it does so again.
const SAME: f64 = 0.02;
/// Distance of a singular configuration behind the end of a step, by the ends of the step, in distances that are too near, below which it is
/// looked at from nearer: this part of the step before its end. And by how much more a step ends before it than it must.
const LIKELY: f64 = 2.0;
const BESIDE: f64 = 0.05;
const ROOM: f64 = 0.1;
/// Turn of the rows from the start of a step to a dip below which the step is not shortened any more, rad.
const NEAREST: f64 = 1e-8;

/// Why a step is to be taken again, shorter.
#[derive(Clone, Copy, Debug)]
pub(super) enum Again {
    /// It should not have passed a place as it did.
    Unresolved {
        /// When, s.
        time: f64,
        /// Up to when a dip is the same place, s.
        until: f64,
    },
    /// It ends too near before a singular configuration: the next step passes it well from this time on, s.
    TooNear(f64),
}

/// What a search is given about the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepData {
    pub island: usize,
    pub start: f64,
    pub end: f64,
    /// End of the run, s.
    pub run_end: f64,
    /// How fast rows turn, 1/s.
    pub pace: f64,
    /// Part of a joint's largest pivot product that counts as zero.
    pub zero: f64,
    /// Whether no projection closes the constraints at the ends of steps.
    pub violated: bool,
    /// Whether the step can be taken again, shorter.
    pub may_shorten: bool,
    /// Up to when that has led nowhere, s.
    pub given_up: f64,
    /// Part of the step within which no singular configuration should lie behind its end.
    pub clearance: f64,
}

impl StepData {
    /// Root of a pivot product, as a part of the largest, that counts as zero: in steps that rounding makes very short both ends may be
    /// indistinguishable from it.
    pub(super) fn floor(&self) -> f64 {
        self.zero.sqrt()
    }
}

/// The search for dips of pivot products inside a step.
pub(super) struct Search<'a> {
    pub step: StepData,
    pub track: &'a mut dyn Track,
    pub found: &'a mut Found,
    pub history: &'a mut IslandHistory,
    pub examiner: &'a mut Examiner,
    /// Pivot products at the start and at the end of the step, then those of probes.
    pub samples: &'a mut [Sample],
    /// Times of the dips that were looked at in the step.
    pub examined: &'a mut Vec<f64>,
}

impl Search<'_> {
    /// Keeps the pivot products at time t.
    fn probe(&mut self, t: f64, place: usize) {
        self.examiner.count += 1;
        self.track.place(t);
        self.samples[place].products.copy_from_slice(self.track.pivot_products());
    }

    /// Keeps what they say of each joint as well.
    fn sample(&mut self, t: f64, place: usize) {
        self.probe(t, place);
        self.samples[place].measure(&self.history.scales, self.step.floor());
    }

    /// Square of the distance of a joint from a singular configuration, relative to its largest.
    fn square(&self, joint: usize, place: usize) -> f64 {
        self.samples[place].products[joint] / self.history.scales.largest[joint]
    }

    /// Whether a dip was looked at that belongs to a time.
    fn is_examined(&self, time: f64) -> bool {
        self.examined.iter().any(|known| (known - time).abs() * self.step.pace <= SAME)
    }

    /// Whether some joint may become dependent between two samples.
    pub(super) fn is_suspicious(&self, a: (f64, usize), b: (f64, usize)) -> bool {
        let turned = single((b.0 - a.0) * self.step.pace);
        let ends = [a, b].map(|end| &*self.samples[end.1].angles);
        any_within(ends, &self.history.rate_bounds, |low, high, rate| {
            low + high <= widest(rate * turned, low, high)
        })
    }

    /// The joint that is most likely to become dependent between two samples; and its distances from that at both: zero there,
    /// π/2 at its largest pivot product, and π where it has just come from a zero that is known.
    fn suspect(&self, a: (f64, usize), b: (f64, usize)) -> Option<(usize, f64, f64)> {
        if !self.is_suspicious(a, b) {
            return None;
        }
        let floor = self.step.floor();
        let turned = (b.0 - a.0) * self.step.pace;
        let known = [a, b].map(|end| self.is_examined(end.0));
        let [from, to] = [a, b].map(|end| &self.samples[end.1]);
        let mut found = None;
        let mut least = 1.0;
        let angles = from.angles.iter().zip(&to.angles);
        for (joint, ((low, high), rate)) in angles.zip(&self.history.rate_bounds).enumerate() {
            let turn = f64::from(*rate) * turned;
            // Most joints are far from it, and farther than the one found so far: exact arcsines cost more than all else here.
            if low + high > single(least * turn) * widest(1.0, *low, *high) {
                continue;
            }
            let part = |end: usize, sample: &Sample| match sample.root(joint, &self.history.scales.largest) {
                root if known[end] && root < DEEP => PI,
                root if root <= floor => 0.0,
                root => libm::asin(root - floor),
            };
            let (from, to) = (part(0, from), part(1, to));
            let steep = if from.min(to) < NEAR { STEEP } else { 1.0 };
            let bound = steep * turn;
            // A comparison that is false for NaN as well.
            if from + to <= least * bound {
                least = (from + to) / bound.max(f64::MIN_POSITIVE);
                found = Some((joint, from, to));
            }
        }
        found
    }

    /// Searches for dips between two times whose samples are given; further ones are kept from `place` on.
    ///
    /// # Errors
    ///
    /// The first place that the step must be shortened for.
    pub(super) fn within(&mut self, a: (f64, usize), b: (f64, usize), place: usize) -> Result<(), Again> {
        if place + 1 >= self.samples.len() || self.found.is_full() {
            return Ok(());
        }
        let Some((joint, from, to)) = self.suspect(a, b) else { return Ok(()) };
        let apart = b.0 - a.0;
        // Where it would be zero if it fell and rose at one rate.
        let part = if from + to > 0.0 { (from / (from + to)).clamp(0.25, 0.75) } else { 0.5 };
        let mut middle = (a.0 + part * apart, place);
        self.sample(middle.0, place);
        let dip = self.dip(joint, a, middle, b);
        if let Some(dip) = dip {
            self.judge(dip)?;
            if dip.time > a.0 && dip.time < b.0 {
                middle.0 = dip.time;
                self.sample(dip.time, place);
            }
        }
        if apart * self.step.pace < FINEST {
            return Ok(());
        }
        self.within(a, middle, place + 1)?;
        self.within(middle, b, place + 1)
    }

    /// The dip of a joint near three samples.
    fn dip(&mut self, joint: usize, a: (f64, usize), m: (f64, usize), b: (f64, usize)) -> Option<Dip> {
        let StepData { start, end, pace, .. } = self.step;
        let points = [a, m, b].map(|(t, place)| (t, self.square(joint, place)));
        // A probe may have met the dip, which then lies on either side of it.
        let beside = FINEST / pace;
        let range = (start.max(a.0 - beside), (end + BEHIND / pace).min(b.0 + beside));
        let (_, least, _) = vertex(&points)?;
        let shallow = (b.0 - a.0) * pace >= FINEST && least > DEEP * DEEP;
        let dip = if shallow { None } else { self.descend(joint, points, range, EXACT) };
        dip.filter(|dip| dip.root < DEEP)
    }

    /// The least distance of a joint from a singular configuration near three points, up to a turn of the rows or a part of that
    /// distance, by the vertex of a parabola: near zero, pivot products are squares of numbers that change at one rate.
    fn descend(
        &mut self,
        joint: usize,
        mut points: [(f64, f64); 3],
        range: (f64, f64),
        exact: (f64, f64),
    ) -> Option<Dip> {
        let (pace, place) = (self.step.pace, self.samples.len() - 1);
        for _ in 0..MAX_PROBES {
            let (mut time, _, curvature) = vertex(&points)?;
            let best =
                points.iter().fold(points[0], |best, point| if point.1 < best.1 { *point } else { best });
            // False for NaN as well.
            if !(time >= range.0 && time <= range.1) {
                time = nearer(&points, best, time)?;
            }
            let (root, slope) = (best.1.max(0.0).sqrt(), curvature.sqrt());
            if (time - best.0).abs() * slope.max(pace) <= exact.0.max(exact.1 * root) {
                return Some(Dip { joint, time, root, slope, pace });
            }
            self.probe(time, place);
            let square = self.square(joint, place);
            let worst = (0..3).fold(0, |worst, k| if points[k].1 > points[worst].1 { k } else { worst });
            let better = square < points[worst].1;
            if !better {
                return None;
            }
            points[worst] = (time, square);
        }
        None
    }

    /// The same dip, exactly enough to tell its distance from none. Where it is not found again, that is zero if the samples so far
    /// leave it open.
    fn sharpened(&mut self, dip: Dip) -> Dip {
        let StepData { start, end, .. } = self.step;
        let beside = (EXACT.0.max(dip.root) / dip.slope).min(FINEST / dip.pace);
        let place = self.samples.len() - 1;
        let points = [-beside, 0.0, beside].map(|apart| {
            self.probe(dip.time + apart, place);
            (dip.time + apart, self.square(dip.joint, place))
        });
        let range = (start.min(dip.time - beside), end.max(dip.time + beside));
        let least = points.iter().fold(f64::INFINITY, |least, point| least.min(point.1)).max(0.0).sqrt();
        let root = if least > KNOWN { least } else { 0.0 };
        self.descend(dip.joint, points, range, SHARP).unwrap_or(Dip { root, ..dip })
    }

    /// Finds out what a dip is, and keeps it if it is a singular configuration.
    fn judge(&mut self, mut dip: Dip) -> Result<(), Again> {
        let StepData { island, start, end, run_end, pace, zero, violated, may_shorten, given_up, .. } =
            self.step;
        let near = SAME / pace;
        if self.is_examined(dip.time) {
            return Ok(());
        }
        self.examined.push(dip.time);
        self.history.note_rate(dip.joint, dip.slope / pace);
        if self.found.is_known(island, dip.time, near) {
            return Ok(());
        }
        let mut finding = self.examiner.examine(self.track, dip, &self.history.scales.largest);
        let mut sharp = dip;
        if let Finding::Unresolved(_) = finding {
            sharp = self.sharpened(dip);
            dip.time = sharp.time;
            if sharp.root > 0.0 && sharp.root < COARSE * dip.root {
                finding = self.examiner.examine(self.track, sharp, &self.history.scales.largest);
            }
        }
        if matches!(finding, Finding::Unresolved(_)) && self.examiner.has_followed(self.track, sharp) {
            finding = Finding::Regular;
        }
        let places = &self.history.constraints;
        match finding {
            Finding::Regular => self.found.settle(dip.time, near),
            Finding::Singular(time) => {
                self.found.settle(dip.time, near);
                if time >= 0.0 && time <= run_end.max(end) && !self.found.is_known(island, time, near) {
                    let joints = self.examiner.involved().map(|joint| places[joint]);
                    self.found.add(island, time, joints);
                }
            }
            // Nothing brings these methods nearer to the singular configuration than the root of their violation.
            Finding::Unresolved(_) if violated => {
                if dip.root * dip.root <= zero {
                    self.found.add(island, dip.time, std::iter::once(places[dip.joint]));
                }
            }
            // The next step will look at it from nearer.
            Finding::Unresolved(_) if dip.time > end => {}
            Finding::Unresolved(apart) => {
                let open = may_shorten && dip.time > given_up && (dip.time - start) * pace > NEAREST;
                let lost = |joint: &usize| *joint == dip.joint || self.loses_hold(*joint, dip);
                let joints = (0..places.len()).filter(lost);
                let joints = joints.map(|joint| places[joint]).collect();
                self.found.doubt(Doubtful { time: dip.time, apart, joints, open }, near);
                if open {
                    return Err(Again::Unresolved { time: dip.time, until: dip.time + near });
                }
            }
        }
        Ok(())
    }

    /// Whether the step ends well before or behind the next singular configuration. Steps that pass one start and end beside it: the
    /// nearer, the more rounding grows on the way, and the shorter the next ones become.
    ///
    /// # Errors
    ///
    /// When it had better end.
    pub(super) fn keeps_clear(&mut self) -> Result<(), Again> {
        let StepData { start, end, run_end, may_shorten, clearance, .. } = self.step;
        let size = end - start;
        if !may_shorten || clearance == 0.0 || end >= run_end {
            return Ok(());
        }
        let likely = self.ahead(0, size) < LIKELY * clearance * size;
        if !likely {
            return Ok(());
        }
        let beside = BESIDE * size;
        self.sample(end - beside, 2);
        let ahead = self.ahead(2, beside);
        if ahead < clearance * size {
            return Err(Again::TooNear(end + ahead - (clearance + ROOM) * size));
        }
        Ok(())
    }

    /// How long after the end of the step a joint may lose its hold, if its angle goes on as since a sample that long before, s.
    fn ahead(&self, place: usize, since: f64) -> f64 {
        let [from, to] = [place, 1].map(|place| &self.samples[place].angles);
        let angles = from.iter().zip(to).filter(|(from, to)| to < from);
        angles.fold(f64::INFINITY, |least, (from, to)| least.min(since * f64::from(to / (from - to))))
    }

    /// Whether a joint is about as near to losing its hold as that of a dip.
    fn loses_hold(&self, joint: usize, dip: Dip) -> bool {
        let products = &self.samples[self.samples.len() - 1].products;
        self.history.scales.largest[joint] > REDUNDANT
            && root(products, &self.history.scales.largest, joint) < DEEP.min(10.0 * dip.root.max(EXACT.0))
    }
}

/// How far the distances of a joint from a singular configuration, between lower bounds of them at both ends, may come nearer to it and
/// back while rows turn by an angle times its rate.
fn widest(turn: f32, low: f32, high: f32) -> f32 {
    turn * if low < FAR || high < FAR { single(STEEP) } else { 1.0 }
}

/// A time near the best of three points, if that is an end of them, and the vertex of their parabola is too near it to be told
/// from a dip beside it.
fn nearer(points: &[(f64, f64); 3], best: (f64, f64), vertex: f64) -> Option<f64> {
    let others = points.iter().filter(|point| point.0 != best.0);
    let next = others.fold(f64::INFINITY, |next, point| {
        let apart = point.0 - best.0;
        if apart.abs() < next.abs() { apart } else { next }
    });
    let outside = (vertex - best.0) / next;
    (outside < 0.0 && outside > -UNCERTAIN).then_some(best.0 + UNCERTAIN * next)
}

/// The vertex of the parabola through three points: where, its value, and half its second derivative. `None` if it has no
/// least value.
fn vertex(&[a, b, c]: &[(f64, f64); 3]) -> Option<(f64, f64, f64)> {
    let slope = (b.1 - a.1) / (b.0 - a.0);
    let curvature = ((c.1 - a.1) / (c.0 - a.0) - slope) / (c.0 - b.0);
    let time = 0.5 * (a.0 + b.0 - slope / curvature);
    let least = a.1 + (time - a.0) * (slope + curvature * (time - b.0));
    (curvature > 0.0).then_some((time, least, curvature))
}
