//! Singular positions that a run passes, found from the pivots of the factorization — THEORY section 8.
//!
//! The product of a joint's relative pivots in S, its *hold*, is the square of a number that passes through zero at a
//! singular position. The factorizations of the run tell it at the ends of steps. A step is looked at inside if its rows
//! turn so far that one of these numbers may reach zero and come back. Mechanisms without loops have no such step.

use crate::elimination::Elimination;
use crate::integrate::Integrator;
use crate::lift::Lift;
use crate::mechanism::Mechanism;
use crate::parts::has_loops;
use crate::rank::Rank;
use crate::scene::Stabilization;
use crate::system::System;
use crate::trust;
use serde::Serialize;
use std::ops::Range;

/// How fast the distance from a singular position, as an angle, may change beside the fastest turning body.
const FASTER: f64 = 2.5;
/// A joint holds no more at this part of its firmest hold. At a loose tolerance the state is off the singular position by
/// more than rounding: by about so many tolerances.
const ZERO: f64 = 1e-8;
const OFF: f64 = 10.0;
/// Joints that never hold more firmly are redundant.
const REDUNDANT: f64 = 1e-7;
/// Joints whose hold is below so many zeros at the passage of another have lost it with that one.
const TOGETHER: f64 = 1e3;
/// Joints that are named hold less than this.
const INVOLVED: f64 = 1e-6;
/// Least part of a step that is looked at, rad, and how often one is divided.
const FINEST: f64 = 0.05;
const DEEPEST: usize = 8;
/// Looks in the search for a zero, how much nearer each is to come, and how many may fail to.
const LOOKS: usize = 12;
const NEARER: f64 = 0.5;
const FAILURES: usize = 3;
/// Passages nearer to each other than this part of the time are one.
const APART: f64 = 1e-6;
/// Two at which the same joint loses its hold are one if rows turn less than so many times what cannot be told from zero.
const SAME: f64 = 20.0;
/// Passages for which there is room from the beginning.
const USUAL: usize = 64;
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

/// A step as it concerns singular positions.
#[derive(Clone, Copy, Debug)]
pub struct Stepped<'a> {
    /// The part of the mechanism that took it.
    pub part: usize,
    /// Its start, s.
    pub start: f64,
    /// Its end, s.
    pub end: f64,
    /// How firmly each joint holds at its end, if a factorization there has told it.
    pub holds: Option<&'a [f64]>,
    /// How fast the rows turn at its end, 1/s.
    pub pace: f64,
}

/// How fast a body turns the rows of its joints, 1/s: its angular velocity, or its velocity by the length of the
/// mechanism.
pub fn pace(rate: &Lift, length: f64) -> f64 {
    let turning: f64 = rate.e.iter().map(nalgebra::Vector3::norm_squared).sum();
    (0.5 * turning).sqrt().max(rate.r.norm() / length)
}

/// The largest pace of all bodies in the state y = (q, q̇).
pub fn fastest(system: &System, y: &[f64]) -> f64 {
    let (q, q_dot) = y.split_at(system.coordinates);
    let paces = system.bodies.iter().map(|body| {
        let rate = body.layout.velocity(&body.layout.position(q), q_dot);
        pace(&rate, system.length)
    });
    paces.fold(0.0, f64::max)
}

/// A passage as it is kept, and where its joints stand in the list of all.
#[derive(Clone, Debug)]
struct Passed {
    time: f64,
    /// What is left there of the hold that is lost.
    hold: f64,
    joints: Range<usize>,
}

/// What is known of a part of the mechanism.
#[derive(Clone, Debug, Default)]
struct Approach {
    /// Firmest hold of each joint so far.
    firmest: Vec<f64>,
    /// Holds at the end of the last step.
    holds: Vec<f64>,
    /// Pace at the end of the last step.
    pace: f64,
}

/// A time and the hold of a joint there.
type Spot = (f64, f64);

/// Watches the pivots of a run.
#[derive(Clone, Debug)]
pub struct Watch {
    /// Where pivots are looked at, if the mechanism has loops.
    scout: Option<Elimination>,
    tolerance: f64,
    /// Whether the constraints are held by no projection, and may be open.
    opens: bool,
    /// Part of its firmest hold at which a joint holds no more.
    zero: f64,
    parts: Vec<Approach>,
    passed: Vec<Passed>,
    /// Joints of all passages.
    involved: Vec<usize>,
    y: Vec<f64>,
    /// Holds at places of the last step: its start, its end, and those that were looked at.
    places: Vec<Vec<f64>>,
    /// Holds at the passage that was found last in the step.
    there: Vec<f64>,
    /// Places inside steps that were looked at.
    looks: u64,
}

impl Watch {
    /// For a mechanism whose rank is known.
    pub fn new(mechanism: &mut Mechanism, rank: &Rank) -> Self {
        let Mechanism { system, elimination, .. } = mechanism;
        let scout = has_loops(&system.model).then(|| {
            elimination.keep_holds();
            let mut scout = elimination.clone();
            scout.set_dependent(&rank.dependent);
            scout
        });
        let (numbers, groups) =
            if scout.is_some() { (2 * system.coordinates, system.groups.len()) } else { (0, 0) };
        Self {
            scout,
            tolerance: system.model.settings.tolerance,
            opens: system.model.settings.stabilization != Stabilization::Projection,
            zero: zero(system.model.settings.tolerance, 0.0),
            parts: Vec::new(),
            passed: Vec::with_capacity(USUAL),
            involved: Vec::with_capacity(USUAL * groups),
            y: vec![0.0; numbers],
            places: (0..DEEPEST + 4).map(|_| Vec::with_capacity(groups)).collect(),
            there: Vec::with_capacity(groups),
            looks: 0,
        }
    }

    /// Begins anew.
    pub fn forget(&mut self) {
        self.parts.clear();
        self.passed.clear();
        self.involved.clear();
        self.looks = 0;
    }

    /// What was passed so far.
    pub fn passages(&self, system: &System) -> Vec<Passage> {
        let name = |&joint: &usize| system.groups[joint].name.clone();
        let told = |passed: &Passed| Passage {
            time: passed.time,
            joints: self.involved[passed.joints.clone()].iter().map(name).collect(),
        };
        self.passed.iter().map(told).collect()
    }

    /// How many places inside steps were looked at.
    pub fn looks(&self) -> u64 {
        self.looks
    }

    /// Looks at the step that was taken last.
    pub fn step(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator) {
        if self.scout.is_none() || self.passed.len() >= MOST {
            return;
        }
        if self.opens {
            self.zero = zero(self.tolerance, trust::relative(&mechanism.system, &mechanism.elimination));
        }
        let Some(stepped) = integrator.stepped(mechanism) else { return };
        let Stepped { part, start, end, pace, .. } = stepped;
        if self.parts.len() <= part {
            self.parts.resize(part + 1, Approach::default());
        }
        let mut places = std::mem::take(&mut self.places);
        let mut approach = std::mem::take(&mut self.parts[part]);
        std::mem::swap(&mut approach.holds, &mut places[0]);
        let told = stepped.holds.map(|holds| renew(&mut places[1], holds)).is_some();
        if !told {
            self.look(mechanism, integrator, end, &mut places[1]);
        }
        if approach.firmest.is_empty() {
            self.look(mechanism, integrator, start, &mut places[0]);
            (approach.firmest, approach.pace) = (places[0].clone(), pace);
        }
        for (firmest, hold) in approach.firmest.iter_mut().zip(&places[1]) {
            *firmest = firmest.max(*hold);
        }
        self.there.clear();
        let firmest = &approach.firmest;
        let fastest = pace.max(approach.pace);
        let mut search =
            Search { watch: self, mechanism, integrator, firmest, pace: fastest, places: &mut places };
        search.within((start, 0), (end, 1), (end - start) * fastest, 2);
        std::mem::swap(&mut approach.holds, &mut places[1]);
        approach.pace = pace;
        self.parts[part] = approach;
        self.places = places;
    }

    /// How firmly joints hold at time t within the last step.
    fn look(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator, t: f64, holds: &mut Vec<f64>) {
        self.looks += 1;
        if let Some(found) = integrator.holds_inside(t) {
            return renew(holds, found);
        }
        self.place(mechanism, integrator, t);
        if let Some(scout) = &mut self.scout {
            renew(holds, scout.holds_here(&mechanism.system));
        }
    }

    /// Puts the state of time t within the last step in place, in the scout.
    fn place(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator, t: f64) {
        integrator.write_part(mechanism, t, &mut self.y);
        if let Some(scout) = &mut self.scout {
            scout.set_time(&mechanism.system, t);
            scout.place(&mechanism.system, &self.y[..mechanism.system.coordinates]);
        }
    }
}

/// What counts as zero beside the firmest hold. Where rows are open, nothing holds bodies nearer to the singular position
/// than the root of that: there they are of second order.
fn zero(tolerance: f64, open: f64) -> f64 {
    ZERO.max((OFF * tolerance).powi(2)).max(OFF * open)
}

fn renew(target: &mut Vec<f64>, source: &[f64]) {
    target.clear();
    target.extend_from_slice(source);
}

/// The search for zeros of holds inside a step.
struct Search<'a> {
    watch: &'a mut Watch,
    mechanism: &'a mut Mechanism,
    integrator: &'a mut Integrator,
    firmest: &'a [f64],
    /// How fast rows turn, 1/s.
    pace: f64,
    places: &'a mut [Vec<f64>],
}

impl Search<'_> {
    /// Looks at time t, and keeps the holds.
    fn look(&mut self, t: f64, place: usize) {
        self.watch.look(self.mechanism, self.integrator, t, &mut self.places[place]);
    }

    /// What counts as zero for the hold of a joint.
    fn zero(&self, joint: usize) -> f64 {
        self.firmest[joint] * self.watch.zero
    }

    /// The joint that is most likely to lose its hold between two places, between which rows turn by so much; and its
    /// distances from that at both: zero there, π/2 at its firmest hold.
    fn suspect(&self, a: usize, b: usize, turned: f64) -> Option<(usize, f64, f64)> {
        let bound = FASTER * turned;
        // In steps that rounding makes very short both ends may be as near to zero as can be told.
        let floor = self.watch.zero.sqrt();
        let mut least = None;
        let mut sum = bound;
        for (joint, firmest) in self.firmest.iter().enumerate().filter(|(_, firmest)| **firmest > REDUNDANT) {
            let part = |place: usize| {
                let hold = self.places[place].get(joint).copied().unwrap_or(f64::NAN);
                let root = (hold / firmest).clamp(0.0, 1.0).sqrt();
                if root <= floor { 0.0 } else { root - floor }
            };
            let (from, to) = (part(a), part(b));
            // The sine is less than its angle. Comparisons that are false for NaN as well.
            if from + to <= sum {
                let (from, to) = (from.asin(), to.asin());
                let gone =
                    self.watch.there.get(joint).is_some_and(|hold| *hold <= TOGETHER * self.zero(joint));
                if from + to <= sum && !gone {
                    sum = from + to;
                    least = Some((joint, from, to));
                }
            }
        }
        least
    }

    /// Looks for zeros between two places, between which rows turn by so much.
    fn within(&mut self, a: (f64, usize), b: (f64, usize), turned: f64, place: usize) {
        if place + 1 >= self.places.len() || self.watch.passed.len() >= MOST {
            return;
        }
        let Some((joint, from, to)) = self.suspect(a.1, b.1, turned) else { return };
        // Where it would be zero if it fell and rose at one rate.
        let part = if from + to > 0.0 { (from / (from + to)).clamp(0.1, 0.9) } else { 0.5 };
        let time = a.0 + part * (b.0 - a.0);
        self.look(time, place);
        let spot = |search: &Self, (t, place): (f64, usize)| (t, search.places[place][joint]);
        let middle = (time, place);
        let near = (spot(self, middle).1 / self.firmest[joint]).max(0.0).sqrt();
        let finest = turned < FINEST;
        if near < NEARER * from.max(to) || finest {
            let spots = (spot(self, a), spot(self, middle), spot(self, b));
            if let Some(zero) = self.root(joint, spots.0, spots.1, spots.2) {
                self.found(joint, zero);
            }
        }
        if finest {
            return;
        }
        let share = |width: f64| turned * width / (b.0 - a.0);
        self.within(a, middle, share(time - a.0), place + 1);
        self.within(middle, b, share(b.0 - time), place + 1);
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
        let Some(scout) = scout else { return };
        let holds = scout.holds_here(&self.mechanism.system);
        let least = holds.iter().fold(f64::INFINITY, |least, hold| least.min(*hold));
        let limit = INVOLVED.max(*zero).max(2.0 * least);
        let first = involved.len();
        involved.extend((0..holds.len()).filter(|joint| holds[*joint] <= limit));
        passed.push(Passed { time, hold, joints: first..involved.len() });
        passed.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
    }
}
