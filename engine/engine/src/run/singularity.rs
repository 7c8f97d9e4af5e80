//! Singular positions that a run passes, found from the pivots of the factorization — THEORY section 8.
//!
//! The product of a joint's relative pivots in S, its *hold*, is the square of a number that passes through zero at a
//! singular position. The factorizations of the run tell it at the ends of steps. A step is looked at inside if its rows
//! turn so far that one of these numbers may reach zero and come back. Mechanisms without loops have no such step.

mod search;

use crate::integrate::Integrator;
use crate::scene::Stabilization;
use search::Search;
use serde::Serialize;
use std::ops::Range;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::Rank;
use triad_dynamics::constraints::violation;
use triad_dynamics::dynamics::elimination::Elimination;
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::islands::has_loops;

/// What a step must turn to tell how fast holds change, rad.
const TELLING: f64 = 0.005;
/// A joint holds no more at this part of its firmest hold. At a loose tolerance the state is off the singular position by
/// more than rounding: by about so many tolerances.
const ZERO: f64 = 1e-8;
const OFF: f64 = 10.0;
/// How often a step is divided.
const DEEPEST: usize = 8;
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
    /// Fastest change of the roots of holds so far, beside the fastest turning body.
    faster: Vec<f64>,
    /// Pace at the end of the last step.
    pace: f64,
}

impl Approach {
    /// Keeps how fast holds have changed from one place to another, between which rows turn by so much.
    fn note_change(&mut self, from: &[f64], to: &[f64], turned: f64) {
        self.faster.resize(self.firmest.len(), 0.0);
        if turned < TELLING {
            return;
        }
        for (((faster, firmest), from), to) in self.faster.iter_mut().zip(&self.firmest).zip(from).zip(to) {
            let root = |hold: f64| (hold / firmest).max(0.0).sqrt();
            *faster = faster.max((root(*to) - root(*from)).abs() / turned);
        }
    }
}

/// Watches the pivots of a run.
#[derive(Clone, Debug)]
pub struct Watch {
    /// A state and a solver with which pivots are looked at, if the mechanism has loops.
    scout: Option<(State, Elimination)>,
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
        let Mechanism { system, state, elimination, .. } = mechanism;
        let scout = has_loops(&system.model).then(|| {
            elimination.keep_holds();
            let mut scout = elimination.clone();
            scout.set_dependent(&rank.dependent);
            (state.clone(), scout)
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
            self.zero = zero(self.tolerance, violation::relative(&mechanism.system, &mechanism.state));
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
        let fastest = pace.max(approach.pace);
        let mut search = Search {
            watch: self,
            mechanism,
            integrator,
            approach: &approach,
            pace: fastest,
            places: &mut places,
        };
        search.within((start, 0), (end, 1), 2);
        approach.note_change(&places[0], &places[1], (end - start) * fastest);
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
        if let Some((state, scout)) = &mut self.scout {
            renew(holds, scout.holds_at(&mechanism.system, state));
        }
    }

    /// Puts the state of time t within the last step in place, in the scout.
    fn place(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator, t: f64) {
        integrator.write_part(mechanism, t, &mut self.y);
        if let Some((state, _)) = &mut self.scout {
            state.set_time(&mechanism.system, t);
            state.set_positions(&mechanism.system, &self.y[..mechanism.system.coordinates]);
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
